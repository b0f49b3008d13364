"""Show by exact steps that an expression is continuous; without such a proof it is not assumed.

Each variable takes the values that the claim allows: between two bounds, or all positive numbers.
"""

from collections.abc import Mapping

from sympy import Dummy, Expr, Poly, PolynomialError, Rational, Symbol, fraction, together

from derive.check.claim import SCALE, Range
from derive.proof.kinks import switches

_MOST_TERMS = 500
"""The largest number of terms in a polynomial whose signs are examined."""


def is_continuous(expr: Expr, ranges: Mapping[Symbol, Range]) -> bool:
    """Whether every switch of the expression is proven to be nonzero throughout the ranges."""
    return all(_has_one_sign(switch.of, ranges) for switch in switches(expr))


def _has_one_sign(expr: Expr, ranges: Mapping[Symbol, Range]) -> bool:
    """Whether an expression is shown to have no zero."""
    if expr.is_positive or expr.is_negative:
        return True
    over_positive = expr.xreplace({s: _from_positive(s, ranges.get(s)) for s in expr.free_symbols})
    return all(map(_of_one_sign, fraction(together(over_positive))))


def _from_positive(symbol: Symbol, span: Range | None) -> Expr:
    """Express the variable in terms of one that takes all positive values, where possible."""
    free = Dummy(symbol.name, positive=True)
    if span is None or span == SCALE or span.powers:
        return free if symbol.is_positive else symbol
    low, high = (Rational(str(end)) for end in (span.low, span.high))
    return (low + high * free) / (1 + free)


def _of_one_sign(expr: Expr) -> bool:
    """Whether all coefficients of a polynomial in positive variables have one sign."""
    if expr.is_positive or expr.is_negative:
        return True
    held = sorted(expr.free_symbols, key=str)
    if not held or not all(symbol.is_positive for symbol in held):
        return False
    try:
        coefficients = Poly(expr, *held).coeffs()
    except PolynomialError:
        return False
    few = len(coefficients) <= _MOST_TERMS
    signs = {c.is_positive for c in coefficients} | {not c.is_negative for c in coefficients}
    return few and len(signs) == 1 and None not in signs
