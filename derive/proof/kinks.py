"""Find where an expression may kink, jump, be infinite or change its branch.

A switch of an expression is another expression at whose zeros this may happen.

switches    the switches of an expression
places      the zeros of the switches along one variable, as functions of all other symbols
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from sympy import (
    Expr,
    Integral,
    Mul,
    Poly,
    Pow,
    Symbol,
    atan2,
    cosh,
    exp,
    fraction,
    resultant,
    tan,
    together,
)
from sympy.core.relational import Relational

from derive.reading.words import FUNCTIONS

_SWITCHES = {each.of_sympy: each.switches for each in FUNCTIONS.values()}
_HIGHEST = 8
"""The highest degree of a polynomial whose roots are computed directly."""
_ROOTS = 2
"""The largest number of square roots that are removed by squaring, one after the other."""


@dataclass(frozen=True)
class Switch:
    """An expression at whose zeros another expression may not be smooth.

    kind  root   a half-integer power: smooth in the square root of the distance
          pole   a negative integer power
          kink   a modulus, a sign or a condition: smooth on either side
          log    anything else
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
        if expr.exp.is_Rational and expr.exp.q == 2:
            yield "root", expr.base
        elif not expr.exp.is_Integer or expr.exp < 0:
            yield ("pole" if expr.exp.is_Integer else "log"), expr.base
    elif isinstance(expr, atan2):
        yield "kink", expr.args[0]
    elif isinstance(expr, Relational):
        yield "kink", expr.lhs - expr.rhs
    elif expr.func in _SWITCHES:
        yield from _SWITCHES[expr.func](*expr.args)


def is_unbounded(expr: Expr, variable: Symbol) -> bool:
    """Whether a power or a tangent of the variable may make the expression infinite."""
    return any(
        (isinstance(n, Pow) and not n.exp.is_nonnegative) or isinstance(n, tan)
        for n in expr.atoms(Pow, tan)
        if n.has(variable)
    )


# ------------------------------------------------------------------ zeros along one variable


@dataclass(frozen=True)
class Place:
    """The zeros of one switch along a variable.

    of            the expression of the switch
    kind          the kind of the switch, or peak: smooth, but with rapid changes
    coefficients  coefficients of polynomials whose zeros include all zeros of the switch; empty
                  if no such polynomials are known
    """

    of: Expr
    kind: str
    coefficients: tuple[tuple[Expr, ...], ...]


@cache
def places(expr: Expr, variable: Symbol) -> tuple[Place, ...]:
    """Return where along a variable an integrand may not be smooth, or may peak."""
    found: dict[tuple[Expr, str], Place] = {}
    for switch in switches(expr):
        if switch.of.has(variable):
            polynomials = _polynomials(switch.of, variable, _ROOTS)
            found[switch.of, switch.kind] = Place(switch.of, switch.kind, polynomials)
    for inner in peaked(expr):
        if inner.has(variable) and inner.is_polynomial(variable):
            slope = inner.diff(variable)
            if slope.has(variable):
                found[inner, "peak"] = Place(slope, "peak", _polynomials(slope, variable, 0))
    return tuple(found[key] for key in sorted(found, key=str))


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


def _polynomials(expr: Expr, variable: Symbol, roots: int) -> tuple[tuple[Expr, ...], ...]:
    """Return coefficients of polynomials whose zeros include those of `expr`."""
    numerator = fraction(together(expr))[0]
    found = []
    for factor in Mul.make_args(numerator):
        base = factor.base if isinstance(factor, Pow) else factor
        if not base.has(variable):
            continue
        if base.is_polynomial(variable):
            coefficients = tuple(Poly(base, variable).all_coeffs())
            if len(coefficients) > _HIGHEST + 1:
                return ()
            found.append(coefficients)
            continue
        inner = _squared(base, variable) if roots else None
        more = _polynomials(inner, variable, roots - 1) if inner is not None else ()
        if not more:
            return ()
        found += more
    return tuple(found)


def _squared(expr: Expr, variable: Symbol) -> Expr | None:
    """Return p**2 - q**2 w for an expression p + q sqrt(w), where w is the first radicand."""
    held = [n for n in expr.atoms(Pow) if n.has(variable) and n.exp.is_Rational and n.exp.q == 2]
    if not held:
        return None
    stand_in = Symbol("root")
    base = min((n.base for n in held), key=str)
    table = {n: stand_in ** (2 * n.exp) for n in held if n.base == base}
    rest = fraction(together(expr.xreplace(table)))[0]
    return resultant(rest, stand_in**2 - base, stand_in) if rest.is_polynomial(stand_in) else None
