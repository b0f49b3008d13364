"""Principal values and integrals to infinity, which SymPy does not have."""

from functools import reduce
from typing import Any

from sympy import (
    Derivative,
    Expr,
    Function,
    Integral,
    Limit,
    Min,
    Mul,
    Symbol,
    degree,
    denom,
    oo,
    solve,
    together,
)
from sympy.printing.latex import LatexPrinter

from derive.command.errors import BadFormula

FROM_POLE = "_from_pole"
"""Suffix of the variable of a folded principal value, whose upper end must be positive."""


class NoPole(BadFormula):
    """A principal value whose integrand does not have exactly one recognisable pole."""


class _Improper(Function):
    integrates = True
    mark = ""

    def _latex(self, printer: LatexPrinter) -> str:
        return f"{self.mark}{printer._print(as_integral(self))}"


class PrincipalValue(_Improper):
    """The principal value of an integral along a symbol between two ends; see `proper`."""

    nargs = 4
    mark = r"\mathrm{PV}\!"


class ToInfinity(_Improper):
    """An integral along a symbol from a lower end to infinity."""

    nargs = 3


IMPROPER = (PrincipalValue, ToInfinity)


def ordinary(expr: Expr) -> Expr:
    """Write principal values and integrals to infinity as integrals, for units and symbols."""
    return expr.replace(lambda node: isinstance(node, IMPROPER), as_integral)


def as_integral(node: Expr) -> Integral:
    """The same as an integral of SymPy."""
    if isinstance(node, Integral):
        return node
    inside, along, low, *high = node.args
    return Integral(inside, (along, low, *(high or [oo])))


def typed(expr: Any) -> Any:
    """Write integrals, limits and derivatives as the calls that a user types."""
    kinds = Integral, Limit, Derivative, *IMPROPER
    return expr.replace(lambda node: isinstance(node, kinds), _call)


def _call(node: Expr) -> Expr:
    if isinstance(node, Limit):
        return Function("limit")(*node.args[:3])
    if isinstance(node, Derivative):
        ((along, times),) = node.variable_count
        return Function("diff")(node.expr, along, *([times] if times != 1 else []))
    over, name = as_integral(node), "pv" if isinstance(node, PrincipalValue) else "integral"
    return reduce(
        lambda inside, limits: Function(name)(inside, *limits), over.limits, over.function
    )


def proper(expr: Any) -> Any:
    """Rewrite all integrals without poles and with finite ends; raises NoPole."""
    return expr.replace(lambda n: isinstance(n, IMPROPER), _proper)


def _proper(node: Expr) -> Expr:
    """Write an integral to infinity from 0 to 1, and fold a principal value about its pole."""
    inside, along, low, *high = node.args
    if isinstance(node, ToInfinity):
        moved = low + along / (1 - along)
        return Integral(inside.subs(along, moved) / (1 - along) ** 2, (along, 0, 1))
    poles = set[Expr]()
    for factor in Mul.make_args(denom(together(inside))):
        if factor.is_polynomial(along) and factor.has(along) and degree(factor, along) == 1:
            poles |= set(solve(factor, along))
    if len(poles) != 1:
        why = "the integrand does not have exactly one recognisable pole"
        text = str(inside)
        remedy = "write its denominator with one factor such as s - x"
        raise NoPole("a principal value", text, 0, why, remedy)
    (pole,), (high,) = poles, high
    distance = Symbol(along.name + FROM_POLE, real=True)
    reach = Min(pole - low, high - pole)  # the nearer end
    both = inside.subs(along, pole + distance) + inside.subs(along, pole - distance)
    around = Integral(together(both), (distance, 0, reach))
    left = Integral(inside, (along, low, pole - reach))
    return around + left + Integral(inside, (along, pole + reach, high))
