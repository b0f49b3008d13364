"""Numbers that carry a bound on their error, and functions of such numbers, by python-flint.

In:  mpmath's numbers.
Out: balls: a midpoint and a radius, real for as long as a value is real, else complex.

Every function below rounds outwards: the true value lies inside the ball.  A ball whose radius is
unbounded counts as not a number.
"""

import operator
from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import reduce
from typing import Any, TypeAlias

import mpmath
import sympy
from flint import acb, arb, ctx
from mpmath import mpc, mpf
from mpmath.libmp import from_man_exp

Ball: TypeAlias = arb | acb
Value: TypeAlias = mpf | mpc
Function: TypeAlias = Callable[[Ball], Ball]
Operation: TypeAlias = Callable[..., Any]

_BITS = 3.3219280948873626
"""Bits per digit."""
_LONGEST = 64
"""Integer powers up to this one are products, so that they have a value around zero, too."""


def digits(count: int) -> AbstractContextManager[None]:
    """Use balls with this many digits in a `with` block."""
    return ctx.workprec(int(count * _BITS) + 5)


def ball(value: Value | Ball) -> Ball:
    """The exact ball of a number of mpmath."""
    if isinstance(value, arb | acb):
        return value
    return acb(arb(value.real), arb(value.imag)) if isinstance(value, mpc) else arb(value)


def number(value: Ball | int) -> Value:
    """The exact midpoint of a ball; NaN if it has none, and real if it may be."""
    if isinstance(value, acb):
        if not value.imag.contains(0):
            return mpc(number(value.real), number(value.imag))
        value = value.real
    value = arb(value)
    if not value.is_finite():
        return mpf("nan")
    mantissa, exponent = value.mid().man_exp()
    return mpmath.mp.make_mpf(from_man_exp(int(mantissa), int(exponent)))


def known_digits(value: Ball) -> int:
    """The number of digits of a ball that are certain; none if it may be zero."""
    return max(0, int(value.rel_accuracy_bits() / _BITS))


def widened(value: Ball, radius: arb) -> Ball:
    """A ball with a larger radius."""
    more = arb(0, radius)
    return value + more if isinstance(value, arb) else value + acb(more, more)


def _real_or_complex(name: str) -> Callable[[Ball], Ball]:
    """A function that leaves the real numbers only where it has no real value."""
    of_real, of_complex = getattr(arb, name), getattr(acb, name)

    def of(value: Ball) -> Ball:
        if isinstance(value, arb):
            found = of_real(value)
            if found.is_finite() or not value.is_finite():
                return found
        found = of_complex(acb(value))
        return found.real if found.imag.is_zero() else found

    return of


_root_of_sign = _real_or_complex("sqrt")


def root(value: Ball) -> Ball:
    """The square root; the part below zero of a ball around zero is due to rounding."""
    if isinstance(value, arb):
        found = value.sqrt()
        if found.is_finite():
            return found
        if value.contains(0):
            return arb(0).union(value.upper().sqrt())
    return _root_of_sign(value)


def root_over(value: Ball) -> Ball:
    """The square roots of all numbers in a ball, of which those below zero have imaginary ones."""
    if isinstance(value, arb) and value.contains(0):
        return acb(*(arb(0).union(each.upper().sqrt()) for each in (value, -value)))
    return root(value)


def hull(one: Ball, other: Ball) -> Ball:
    """A ball that holds two."""
    if isinstance(one, arb) and isinstance(other, arb):
        return one.union(other)
    return acb(one).union(acb(other))


def power(base: Ball, exponent: Ball) -> Ball:
    """base**exponent, likewise."""
    if isinstance(base, arb) and isinstance(exponent, arb):
        if base.contains(0) and exponent > 0:
            return arb(0) if base.is_zero() else arb(0).union(base.upper() ** exponent)
        if base < 0:
            return acb(base) ** exponent
    return base**exponent


def product(exponent: int) -> Operation:
    """The function base**exponent, as a product, which has a value around zero, too."""
    if exponent < 0:
        below = product(-exponent)
        return lambda base: 1 / below(base)
    if exponent == 1:
        return lambda base: base
    if exponent > _LONGEST:
        return lambda base: base**exponent
    return lambda base: reduce(operator.mul, [base] * exponent)


def power_over(exponent: int) -> Operation:
    """The function base**exponent, whose value holds the powers of all numbers in a ball."""
    of_rounded = product(exponent)

    def of(base: Ball) -> Ball:
        if not isinstance(base, arb):
            return of_rounded(base)
        size = abs(base) if exponent % 2 == 0 else base
        least = size.lower().max(arb(0)) if exponent % 2 == 0 else size.lower()
        found = hull(least ** abs(exponent), size.upper() ** abs(exponent))
        return found if exponent > 0 else 1 / found

    return of


def _sign(value: Ball) -> Ball:
    return value.sgn()


Truth: TypeAlias = bool | None
"""Of a condition on balls; None if it may be either."""


def _compared(met: Operation, missed: Operation) -> Callable[[Ball, Ball], Truth]:
    """A condition on two balls, by two relations, each of which is only true if it is certain."""

    def condition(one: Ball, other: Ball) -> Truth:
        gap = one - other
        if isinstance(gap, acb):
            gap = _ordered(gap)
        return True if met(gap, 0) else False if missed(gap, 0) else None

    return condition


def _not(condition: Truth) -> Truth:
    return None if condition is None else not condition


def _any(decisive: bool) -> Callable[..., Truth]:
    """Whether a condition among several decides all: a true one for Or, a false one for And."""

    def condition(*parts: Truth) -> Truth:
        return decisive if decisive in parts else None if None in parts else not decisive

    return condition


FUNCTIONS: dict[type, Callable[..., Any]] = {
    **{
        getattr(sympy, name): _real_or_complex(name)
        for name in (
            *("exp", "log", "sin", "cos", "tan", "asin", "acos", "atan"),
            *("sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "gamma"),
        )
    },
    sympy.Abs: abs,
    sympy.sign: _sign,
    sympy.Heaviside: lambda value, _: (1 + _sign(value)) / 2,
    sympy.atan2: lambda y, along: arb.atan2(_ordered(y), _ordered(along)),
    sympy.Max: lambda *values: reduce(arb.max, map(_ordered, values)),
    sympy.Min: lambda *values: reduce(arb.min, map(_ordered, values)),
    sympy.elliptic_k: lambda m: _real(acb(m).elliptic_k()),
    sympy.elliptic_e: lambda m: _real(acb(m).elliptic_e()),
    sympy.elliptic_pi: lambda n, m: _real(acb.elliptic_pi(acb(n), acb(m))),
    sympy.And: _any(False),
    sympy.Or: _any(True),
    sympy.ITE: lambda condition, *both: None if condition is None else both[not condition],
    sympy.Not: _not,
    sympy.StrictLessThan: _compared(operator.lt, operator.ge),
    sympy.LessThan: _compared(operator.le, operator.gt),
    sympy.StrictGreaterThan: _compared(operator.gt, operator.le),
    sympy.GreaterThan: _compared(operator.ge, operator.lt),
    sympy.Equality: _compared(operator.eq, operator.ne),
    sympy.Unequality: _compared(operator.ne, operator.eq),
}
"""What SymPy's functions are for balls."""


def _ordered(value: Ball) -> arb:
    """A real ball; NaN for a number that is not real."""
    return value if isinstance(value, arb) else value.real if value.imag.contains(0) else arb("nan")


def _real(value: acb) -> Ball:
    return value.real if value.imag.is_zero() else value
