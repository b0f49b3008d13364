"""Limits on the size of a formula, checked before SymPy expands it."""

from functools import reduce
from math import ceil, comb
from operator import mul

from sympy import Add, Expr, I, Mul, Piecewise, Pow, Rational, nan, oo, zoo

LARGEST = 10**100
"""Upper bound of the magnitude of a constant, and of its reciprocal."""

STEEPEST = 100
"""Upper bound of a number in an exponent."""

MOST_TERMS = 1000
"""Upper bound of the number of terms of an expanded formula."""

_LONGEST = 2 * LARGEST.bit_length()
"""Upper bound of the number of bits in the numerator or denominator of an exact number."""


def fault(expr: Expr) -> str:
    """The reason why `expr` is refused; empty if it is accepted."""
    if expr.has(zoo, nan, oo, -oo):
        return "is not finite"
    if expr.has(I) or expr.is_extended_real is False:
        return "is not real"
    numbers = [int(part) for each in expr.atoms(Rational) for part in (each.p, each.q)]
    if any(part.bit_length() > _LONGEST for part in numbers) or _is_too_large(expr):
        return "contains a nonzero number whose magnitude is above 1e100 or below 1e-100"
    if terms(expr) > MOST_TERMS:
        return f"has powers above {STEEPEST} or more than {MOST_TERMS} terms when expanded"
    return ""


def _is_too_large(expr: Expr) -> bool:
    """Whether a constant is above 1e100, or nonzero and below 1e-100, in magnitude."""
    if not expr.is_number:
        return False
    size = abs(expr.evalf(15))
    return bool(size > LARGEST or (size != 0 and size * LARGEST < 1))


def terms(expr: Expr) -> int:
    """An upper bound of the number of terms of `expr` when expanded.

    >>> from sympy.abc import x, y
    >>> terms((x + y) ** 3 * (1 + x))
    8
    """
    if isinstance(expr, Add):
        return sum(terms(arg) for arg in expr.args)
    if isinstance(expr, Mul):
        return reduce(mul, (terms(arg) for arg in expr.args))
    if isinstance(expr, Pow) and expr.exp.is_Rational:
        of_base, power = terms(expr.base), ceil(abs(expr.exp))
        return comb(of_base + power - 1, power) if power <= STEEPEST else MOST_TERMS + 1
    values = [part.expr for part in expr.args] if isinstance(expr, Piecewise) else expr.args
    return max([1, *map(terms, values)])
