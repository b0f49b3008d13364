"""Decide an inequality by intervals: over whole ranges of its variables, and not only at points.

Balls enclose all values of the gap between its sides over a box of the variables.  A box on which
the gap may have either sign is reduced to a face if the gap grows along a variable everywhere on
it, or else divided, and its parts are examined before all other boxes.  What is not real counts as
true, because nothing is said there.
"""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from math import sqrt
from typing import Any

import sympy as sp
from flint import acb, arb
from sympy import Expr, Symbol
from sympy.logic.boolalg import Boolean

from derive.check.claim import Range
from derive.check.zero import is_too_long, vanishes_at
from derive.command.limit import LookAtClock
from derive.proof.balls import Ball, digits, hull
from derive.proof.values import Undecided, program
from derive.reading.relation import Relation

_MOST_BOXES = 1600
"""The largest number of boxes that are examined."""
_DIGITS = 80
_JUMPS = (sp.sign, sp.Heaviside, sp.Piecewise, sp.atan2)
"""Functions with jumps, whose rates of change do not tell how they change."""
_HYPERBOLIC = sp.sinh, sp.cosh, sp.tanh
_POSITIVE = Fraction(1, 10**6), Fraction(10**6)
"""The ends between which a variable without a range is examined."""

Box = dict[Symbol, tuple[Fraction, Fraction]]


@dataclass(frozen=True)
class Decision:
    """What is shown of an inequality.

    is_true  whether it is true; None if this is not shown
    over     the ranges of the variables that matter, over which it is shown
    where    a point at which it is false, or near which nothing is shown
    """

    is_true: bool | None
    over: Mapping[Symbol, Range]
    where: Mapping[Symbol, Fraction] = field(default_factory=dict)


def decide(
    gap: Expr,
    is_strict: bool,
    ranges: Mapping[Symbol, Range],
    conditions: Iterable[Boolean],
    look: LookAtClock,
) -> Decision:
    """Decide whether `gap` is positive, or at least zero, wherever the conditions are met.

    One part of the whole is examined after another, until all are decided, one is false, or there
    are too many.
    """
    given = [each for condition in conditions for each in sp.And.make_args(condition)]
    gap = unsettled(gap, is_strict, ranges, given)
    held = gap.free_symbols.union(*(each.free_symbols for each in given)) if gap != 1 else set()
    over = {symbol: span for symbol, span in ranges.items() if symbol in held}
    if gap == 1 or gap.has(sp.Integral):
        return Decision(gap == 1 or None, over)
    search = _Search(gap, is_strict, given, {symbol: ends(span) for symbol, span in over.items()})
    for _ in range(_MOST_BOXES):
        look()
        with digits(_DIGITS):
            false = search.false_in_next()
        if false is not None:
            return Decision(False, over, false)
        if not search.boxes:
            break
    inside = (_middle(box) for _, box in reversed(search.boxes) if all(search.met(box)))
    near = search.touches or next(inside, {})
    return Decision(None if search.boxes or near else True, over, near)


def gap_of(left: Expr, relation: Relation, right: Expr) -> Expr:
    """Return what is positive where an inequality is true."""
    return right - left if relation in (Relation.BELOW, Relation.AT_MOST) else left - right


def ends(span: Range) -> tuple[Fraction, Fraction]:
    """The ends of a range as they are written, or those between which it is examined."""
    return _POSITIVE if span.powers else (Fraction(str(span.low)), Fraction(str(span.high)))


def unsettled(
    gap: Expr, is_strict: bool, ranges: Mapping[Symbol, Range], given: Sequence[Boolean]
) -> Expr:
    """Return the factors of a gap that neither signs nor conditions show to be positive, or 1."""
    if is_too_long(gap):
        return gap
    in_exponentials = gap.rewrite(_HYPERBOLIC, sp.exp)
    with_zero = {s: sp.Dummy(s.name, nonnegative=True) for s in ranges if ranges[s].low == 0}
    strict = [each for each in given if isinstance(each, sp.Gt | sp.Lt)]
    positive = [(each.gts - each.lts).xreplace(with_zero) for each in strict]
    left = list[Expr]()
    factors = sp.Mul.make_args(sp.factor(sp.together(in_exponentials.xreplace(with_zero))))
    for factor in factors:
        base, power = factor.as_base_exp()
        signed = base if power.is_Integer and power.is_odd else factor  # of the same sign
        shares = [sp.cancel(signed / each) for each in positive] if factor.free_symbols else []
        if any(share.is_negative for share in shares):
            left.append(sp.S.NegativeOne)
        elif not (_is_positive(factor) or any(share.is_positive for share in shares)):
            left.append(factor)
    rest = sp.Mul(*left)
    is_settled = rest.is_positive or (rest.is_nonnegative and not is_strict)
    back = {dummy: symbol for symbol, dummy in with_zero.items()}
    if is_settled:
        return sp.S.One
    return gap if left == [*factors] else rest.xreplace(back)  # sums of squares stay what they are


def _is_positive(factor: Expr) -> bool:
    """Whether a factor is positive wherever it has a real value."""
    base, power = factor.as_base_exp()
    is_over_even = power.is_Integer and power.is_even and power.is_negative and base.is_real
    return bool(factor.is_positive or is_over_even)


class _Search:
    """The boxes of one inequality that are not decided yet, and where its sides touch."""

    def __init__(
        self, gap: Expr, is_strict: bool, conditions: Sequence[Boolean], whole: Box
    ) -> None:
        self.gap, self.is_strict, self.conditions = gap, is_strict, conditions
        self.rates = {} if gap.has(*_JUMPS) else {symbol: gap.diff(symbol) for symbol in whole}
        self.touches = dict[Symbol, Fraction]()
        self.boxes = [(0, whole)]

    def met(self, box: Box) -> list[bool | None]:
        """Whether each condition is met on a box; None if it is not met everywhere."""
        balls = {symbol: hull(*map(_exact, span)) for symbol, span in box.items()}
        return [_over(each, balls) for each in self.conditions]

    def false_in_next(self) -> dict[Symbol, Fraction] | None:
        """Decide, reduce or divide the next box; return its middle if the inequality is false."""
        depth, box = self.boxes.pop()
        balls, middle = {s: hull(*map(_exact, of)) for s, of in box.items()}, _middle(box)
        met = self.met(box)
        if False in met:
            return None
        value = _over(self.gap, balls)
        if self._is_met(value):
            return None
        at_middle = {symbol: _exact(place) for symbol, place in middle.items()}
        here = value_at(self.gap, at_middle)
        is_inside = all(_over(each, at_middle) for each in self.conditions)
        if is_inside and here < 0:
            return middle
        slopes = {symbol: _over(rate, balls) for symbol, rate in self.rates.items()}
        known = [here, *slopes.values()]
        if slopes and all(isinstance(v, arb) and v.is_finite() for v in known):
            change = sum((slopes[s] * (balls[s] - at_middle[s]) for s in box), start=arb(0))
            if self._is_met(here + change):
                return None
            reduced = {s: _face(box[s], slopes[s]) for s in box}
            if reduced != box and all(met):
                self.boxes.append((depth, reduced))
                return None
        self._divide(box, middle, depth)
        return None

    def _divide(self, box: Box, middle: dict[Symbol, Fraction], depth: int) -> None:
        """Divide a box along the variables in turn; a single point must be exactly zero."""
        wide = [symbol for symbol, (low, high) in box.items() if low < high]
        if not wide:
            exact = {s: sp.Rational(at.numerator, at.denominator) for s, at in middle.items()}
            if self.is_strict or not vanishes_at(self.gap, exact):
                self.touches = middle
            return
        along = wide[depth % len(wide)]
        low, high = box[along]
        for part in ((low, middle[along]), (middle[along], high)):
            self.boxes.append((depth + 1, {**box, along: part}))

    def _is_met(self, value: Ball) -> bool:
        """Whether all real values of an enclosure are as wanted."""
        real = value if isinstance(value, arb) else value.real
        is_never_real = isinstance(value, acb) and not value.imag.contains(0)
        return bool(real > 0 or (real >= 0 and not self.is_strict)) or is_never_real


def _middle(box: Box) -> dict[Symbol, Fraction]:
    """The point at which a box is divided: by proportion if an end is many times the other."""
    return {
        s: Fraction(sqrt(low * high)) if 0 < 4 * low < high else (low + high) / 2
        for s, (low, high) in box.items()
    }


def _face(span: tuple[Fraction, Fraction], slope: arb) -> tuple[Fraction, Fraction]:
    """The end at which a quantity is lowest, or the whole if its slope has no sign."""
    low, high = span
    return (low, low) if slope > 0 else (high, high) if slope < 0 else span


def _over(expr: sp.Basic, box: Mapping[Symbol, Ball]) -> Any:
    """All values over a box: a ball, or for a condition True, False or None (either)."""
    return program(expr, boxes=True)(box)


def value_at(expr: Expr, point: Mapping[Symbol, Any]) -> arb:
    """The value at one point; NaN if it is not a real number."""
    with suppress(Undecided):
        if isinstance(found := program(expr)(point), arb):
            return found
    return arb("nan")


def _exact(number: Fraction) -> arb:
    return arb(number.numerator) / number.denominator
