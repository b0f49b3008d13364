"""Values to 30 digits that are known to be right.

Every value is computed twice, the second time with more digits; digits that both share are digits
of the value.  Where cancellation leaves too few of them the number of working digits is raised, and
if that does not help the value is unknown, which is not the same as zero.  Two sides agree if they
share all digits that are known of both: a difference that stays as the digits grow is one.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import mpmath
from mpmath import mpf
from sympy import Add, Expr, Integral, Symbol

from derive.paper.claim import Meaning, Point
from derive.paper.draw import in_order
from derive.paper.quadrature import Value
from derive.paper.quick import Unknown, approximately
from derive.paper.values import Care, Undecided, Undefined, evaluated, integrand

DIGITS = 30
"""Digits to which both sides must agree."""
_WORKING = (36, 44, 80)
"""Working digits, tried in this order."""
_MORE = (160, 240)
"""Those after them, where no integral is to be computed."""
_SHARPEST = 200
"""Working digits that decide whether a gap beyond them is noise."""
_SHARP = (80, 120)
"""Working digits at which two sides that agree are compared once more, without integrals."""
_ALL = 10**6
"""Digits that a number shares with itself."""
_LAST = 3
"""Digits by which two sides may share less than is known of either."""
_NOISE = 12
"""Digits by which what is left of a sum that vanishes may exceed its last digit."""
_MODERATE = 30
"""Digits before or after the point that a part of a sum may have which is taken to vanish."""
_COARSE = (16, 24)
_FEW = 4
"""Digits: two sides that share no more of them differ."""
_QUICK = 16
"""Digits by which candidates are told apart at first."""

Numbers = Callable[[Care], Point]
"""What the symbols of two sides are, at the working precision."""


@dataclass(frozen=True)
class Pair:
    """Both sides at one point, and how many digits are known of both."""

    left: Value
    right: Value
    point: Point
    known: int = DIGITS

    @property
    def digits(self) -> int:
        """Digits in which both agree."""
        return agreement(self.left, self.right)

    @property
    def agree(self) -> bool:
        """Whether they agree to as many digits as are asked for, and to all that are known."""
        return self.digits >= max(DIGITS, min(self.known, _ALL) - _LAST)


def agreement(first: Value, second: Value) -> int:
    """Digits that two numbers share; two zeros share all of them."""
    size = max(abs(first), abs(second))
    gap = abs(first - second)
    if gap == 0:
        return _ALL
    return max(0, int(-mpmath.log10(gap / size)))


class _Numbers(dict[Symbol, mpf]):
    """Numbers for our symbols, and for the source's once they are asked for."""

    def __init__(self, known: Point, meaning: Meaning, care: Care) -> None:
        super().__init__(known)
        self._known, self.meaning, self._care = known, meaning, care

    def __missing__(self, symbol: Symbol) -> Value:
        if symbol not in self.meaning:
            raise Undecided(f"nothing says what {symbol} is")
        self[symbol] = evaluated(self.meaning[symbol], self._known, self._care)
        return self[symbol]


def numbers(meaning: Meaning, point: Point, care: Care = Care.TWICE) -> Point:
    """Numbers for our symbols and for the source's at one point."""
    return _Numbers(_Numbers(point, {}, care), meaning, care)


def _sides(
    left: Expr, right: Expr, value: Numbers, working: int, care: Care = Care.TWICE
) -> tuple[Value, Value]:
    """Both sides, and what they are made of, with so many digits."""
    with mpmath.workdps(working):
        known = value(care)
        return evaluated(left, known, care), evaluated(right, known, care)


def apart(left: Expr, right: Expr, value: Numbers, point: Point) -> Pair | None:
    """Both sides where a few digits, that do not change with more of them, tell them apart.

    Each integral in them has been computed by two rules that agree.
    """
    found = []
    for working in _COARSE:
        found.append(_sides(left, right, value, working))
        if not all(mpmath.isfinite(number) for number in found[-1]) or agreement(*found[-1]) > _FEW:
            return None
    if any(map(_may_be_lost, (left, right), found[-1])):
        return None
    stable = all(agreement(*values) > 2 * _FEW for values in zip(*found, strict=True))
    return Pair(*found[-1], point) if stable else None


def both(left: Expr, right: Expr, value: Numbers, point: Point, integrals: bool = False) -> Pair:
    """Both sides with digits that are known to be right; raises Undecided.

    integrals: whether one is in the sides, or in what their symbols stand for.
    """
    integrals = integrals or left.has(Integral) or right.has(Integral)
    pair = _computed(left, right, value, point, _WORKING if integrals else _WORKING + _MORE)
    if integrals:
        _demand_grown(pair)
        if _FEW < pair.digits < DIGITS:
            _demand_same_anew(left, right, value, pair)
        return pair
    return _sharpened(left, right, value, pair) if pair.agree or pair.digits > _FEW else pair


def _computed(
    left: Expr, right: Expr, value: Numbers, point: Point, steps: tuple[int, ...]
) -> Pair:
    sides, found = (left, right), list[tuple[Value, Value]]()
    for working in steps:
        found.append(_sides(left, right, value, working))
        if not all(mpmath.isfinite(number) for number in found[-1]):
            raise Undefined("no finite number")
        if found[1:] and all(map(_is_known, sides, *found[-2:])):
            return Pair(*found[-1], point, _shared(*found[-2:]))
    left_found, right_found = zip(*found, strict=True)
    values = (
        _settled(left, left_found, steps, value),
        _settled(right, right_found, steps, value),
    )
    return Pair(*values, point)


def _shared(before: tuple[Value, Value], now: tuple[Value, Value]) -> int:
    """Digits that are known of both sides."""
    return min(agreement(*values) for values in zip(before, now, strict=True))


def _sharpened(left: Expr, right: Expr, value: Numbers, pair: Pair) -> Pair:
    """The pair with more digits, where they can be had; raises Undecided.

    A small difference that more digits do not show is none to go by.
    """
    if pair.left == 0 or pair.right == 0:
        return pair
    before, now = (_sides(left, right, value, working) for working in _SHARP)
    known = _shared(before, now)
    if known >= DIGITS:
        found = Pair(*now, pair.point, known)
        return _held_against_more(left, right, value, found) if found.agree else found
    if not pair.agree:
        raise Undecided(f"both sides share {pair.digits} digits, and no more are known")
    return pair


def _held_against_more(left: Expr, right: Expr, value: Numbers, pair: Pair) -> Pair:
    """The pair, or one that does not agree: a gap that stays as it is with more digits is one."""
    if pair.digits > _SHARP[1] - _NOISE:
        return pair
    more = _sides(left, right, value, _SHARPEST)
    gaps = pair.left - pair.right, more[0] - more[1]
    if gaps[1] == 0 or agreement(*gaps) <= _FEW:
        return pair
    return Pair(*more, pair.point, _SHARPEST)


def _demand_grown(pair: Pair) -> None:
    if pair.digits >= DIGITS and not pair.agree:
        raise Undecided(
            f"both sides agree to {pair.digits} digits, of {min(pair.known, _WORKING[1])} "
            "that seem to be known of their integrals"
        )


def _demand_same_anew(left: Expr, right: Expr, value: Numbers, pair: Pair) -> None:
    """Nothing, or Undecided where integrals by other cuts differ by as much as the sides do."""
    anew = _sides(left, right, value, _WORKING[1], Care.ANEW)
    if min(map(agreement, (pair.left, pair.right), anew)) < pair.digits + _FEW:
        raise Undecided(f"integrals are not known beyond the {pair.digits} digits of agreement")


def _is_known(side: Expr, before: Value, now: Value) -> bool:
    """Whether enough digits of a side are right."""
    return agreement(before, now) >= DIGITS and not _may_be_lost(side, now)


def _may_be_lost(side: Expr, now: Value) -> bool:
    """Whether a zero may be all that cancellation left of a number."""
    return bool(now == 0) and side.has(Add, Integral, Symbol)


def _settled(side: Expr, found: tuple[Value, ...], steps: tuple[int, ...], value: Numbers) -> Value:
    """The last of the values if it is known, zero if the side vanishes; raises Undecided."""
    if _is_known(side, *found[-2:]):
        return found[-1]
    shrinks = all(abs(v) < mpf(10) ** (_NOISE - d) for v, d in zip(found, steps, strict=True))
    if not shrinks or _is_extreme(side, value):
        raise Undecided(f"cancellation leaves fewer than {DIGITS} digits of {steps[-1]}")
    return mpf(0)


def _is_extreme(side: Expr, value: Numbers) -> bool:
    """Whether a part is so large, or so small, that a number could be lost beside it."""
    less, more = (_sizes(side, value, working) for working in _WORKING[:2])
    floor = mpf(10) ** (_NOISE - _WORKING[0])
    return any(
        size != 0
        and abs(mpmath.log10(size)) > _MODERATE
        and not (size <= floor and agreement(size, again) < _FEW)  # noise, and no number
        for size, again in zip(less, more, strict=True)
    )


def _sizes(side: Expr, value: Numbers, working: int) -> list[mpf]:
    with mpmath.workdps(working):
        numbers = value(Care.TWICE)
        if isinstance(numbers, _Numbers):
            side = side.xreplace(dict(numbers.meaning))
        return list(_parts(side, {s: numbers[s] for s in _free(side)}))


def _free(side: Expr) -> list[Symbol]:
    return sorted(side.free_symbols, key=in_order)


def _parts(side: Expr, numbers: Point) -> Iterator[mpf]:
    """Sizes of an expression and all parts of it; under an integral, at one place inside."""
    yield abs(evaluated(side, numbers))
    if not isinstance(side, Integral):
        for part in side.args:
            yield from _parts(part, numbers)
        return
    variable, low, high = side.limits[-1]
    yield from (*_parts(low, numbers), *_parts(high, numbers))
    ends = evaluated(low, numbers), evaluated(high, numbers)
    place = ends[0] + (ends[1] - ends[0]) * mpf(3) / 8
    yield from _parts(integrand(side), {**numbers, variable: place})


def near(left: Expr, right: Expr, value: Numbers) -> bool:
    """Whether both sides may be equal, by a few digits."""
    with mpmath.workdps(_QUICK):
        numbers = value(Care.QUICK)
        try:
            held = left.free_symbols | right.free_symbols
            plain = {symbol: complex(numbers[symbol]) for symbol in held}
            first, second = approximately(left, plain), approximately(right, plain)
        except Unknown:
            first, second = (evaluated(side, numbers, Care.QUICK) for side in (left, right))
        if not (mpmath.isfinite(first) and mpmath.isfinite(second)):
            return False
        scale = max(abs(first), abs(second), mpf(10) ** -2)
        return bool(abs(first - second) < scale * mpf(10) ** -7)
