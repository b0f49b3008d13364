"""Find where an expression may kink, jump, be infinite or change its branch.

A switch of an expression is another expression at whose zeros this may happen.

switches    the switches of an expression
places      the switches along one variable, and where a peak may be
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from sympy import (
    Expr,
    Integral,
    Mul,
    Pow,
    Symbol,
    atan2,
    cosh,
    exp,
)
from sympy.core.relational import Relational

from derive.reading.words import FUNCTIONS

_SWITCHES = {each.of_sympy: each.switches for each in FUNCTIONS.values()}


@dataclass(frozen=True)
class Switch:
    """An expression at whose zeros another expression may not be smooth.

    kind  kink    a modulus, a sign or a condition: smooth on either side
          branch  a power, a logarithm or an inverse function: may be infinite there
          peak    a slope, along one variable: smooth, but with rapid changes
    """

    of: Expr
    kind: str


def switches(expr: Expr) -> Iterator[Switch]:
    """Yield every switch of an expression outside the integrals in it."""
    if isinstance(expr, Integral):
        return
    for kind, inner in _own(expr):
        for factor in Mul.make_args(inner):
            if factor.free_symbols:
                base = factor.base if isinstance(factor, Pow) else factor
                yield Switch(base, kind)
    for arg in expr.args:
        yield from switches(arg)


def _own(expr: Expr) -> Iterator[tuple[str, Expr]]:
    """Yield the switches of the outermost operation only."""
    if isinstance(expr, Pow):
        if not expr.exp.is_Integer or expr.exp < 0:
            yield "branch", expr.base
    elif isinstance(expr, atan2):
        yield "kink", expr.args[0]
    elif isinstance(expr, Relational):
        yield "kink", expr.lhs - expr.rhs
    elif expr.func in _SWITCHES:
        yield from _SWITCHES[expr.func](*expr.args)


# ------------------------------------------------------------------ zeros along one variable


@cache
def places(expr: Expr, variable: Symbol) -> tuple[Switch, ...]:
    """Return where along a variable an integrand may not be smooth, or may peak.

    It may peak where an exponent or a divisor is stationary: smooth, but with rapid changes.
    """
    found = {switch for switch in switches(expr) if switch.of.has(variable)}
    for inner in peaked(expr):
        slope = inner.diff(variable)
        if inner.is_polynomial(variable) and slope.has(variable):
            found.add(Switch(slope, "peak"))
    return tuple(sorted(found, key=str))


def peaked(expr: Expr) -> Iterator[Expr]:
    """Yield the exponents and the divisors of an expression."""
    for node in expr.atoms(Pow, exp, cosh):
        if isinstance(node, Pow):
            if not node.exp.is_nonnegative:
                yield node.base
            if node.exp.free_symbols:
                yield node.exp
        else:
            yield node.args[0]
