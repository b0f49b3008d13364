"""Compute values to 30 digits that are known to be right.

Every value is computed twice, the second time with more working digits.  The digits that both
results share are the known digits.  If cancellation leaves too few of them, the number of working
digits is raised; if that does not help, the value is unknown, which is not the same as zero.  Two
sides agree if they share all known digits.  A difference that persists as the number of digits
grows is a real difference.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import mpmath
from mpmath import mpf
from sympy import Add, Expr, Integral, Piecewise, Symbol

from derive.check.claim import Meaning, Point
from derive.check.draw import in_order, is_met
from derive.check.quadrature import Value
from derive.check.quick import Unknown, approximately
from derive.check.values import Care, Undecided, Undefined, evaluated, integrand

DIGITS = 30
"""Digits to which both sides must agree."""
_WORKING = (36, 44, 80)
"""Working digits, tried in this order."""
_MORE = (160, 240)
"""Further working digits for expressions without integrals."""
_SHARPEST = 200
"""Working digits that decide whether a small gap is rounding noise."""
_SHARP = (80, 120)
"""Working digits at which sides without integrals that agree are compared once more."""
_ALL = 10**6
"""The number of digits that two equal numbers share."""
_LAST = 3
"""Two sides that agree may share fewer digits than are known of them, by at most this number."""
_NOISE = 12
"""The remainder of a vanishing sum may exceed its last digit by this many digits."""
_MODERATE = 30
"""Parts of a vanishing sum may be as large as 10**30 and as small as 10**-30."""
_COARSE = (16, 24)
_FEW = 4
"""Two sides that share at most this many digits differ."""
_QUICK = 16
"""Working digits for the first comparison of candidates."""

Numbers = Callable[[Care], Point]
"""Returns the values of the symbols of two sides at the working precision."""


@dataclass(frozen=True)
class Pair:
    """The values of both sides at one point, and the number of known digits."""

    left: Value
    right: Value
    point: Point
    known: int = DIGITS

    @property
    def digits(self) -> int:
        """The number of digits in which the two sides agree."""
        return agreement(self.left, self.right)

    @property
    def agree(self) -> bool:
        """Whether the two sides agree to the required number of digits and to all known digits."""
        return self.digits >= max(DIGITS, min(self.known, _ALL) - _LAST)


def agreement(first: Value, second: Value) -> int:
    """Return the number of digits that two numbers share; equal numbers share all."""
    size = max(abs(first), abs(second))
    gap = abs(first - second)
    if gap == 0:
        return _ALL
    return max(0, int(-mpmath.log10(gap / size)))


class _Numbers(dict[Symbol, mpf]):
    """Values of the variables, and of the source's symbols as soon as they are needed."""

    def __init__(self, known: Point, meaning: Meaning, care: Care) -> None:
        super().__init__(known)
        self._known, self.meaning, self._care = known, meaning, care

    def __missing__(self, symbol: Symbol) -> Value:
        if symbol not in self.meaning:
            raise Undecided(f"the symbol {symbol} has no meaning")
        self[symbol] = evaluated(self.meaning[symbol], self._known, self._care)
        return self[symbol]


def numbers(meaning: Meaning, point: Point, care: Care = Care.TWICE) -> Point:
    """Return the values of the variables and of the source's symbols at one point."""
    return _Numbers(_Numbers(point, {}, care), meaning, care)


def _sides(
    left: Expr, right: Expr, value: Numbers, working: int, care: Care = Care.TWICE
) -> tuple[Value, Value]:
    """Evaluate both sides with the given number of working digits."""
    with mpmath.workdps(working):
        known = value(care)
        return evaluated(left, known, care), evaluated(right, known, care)


def apart(left: Expr, right: Expr, value: Numbers, point: Point) -> Pair | None:
    """Return both sides if a few stable digits show that they differ, or else None.

    Each integral in them is computed by two rules that must agree.
    """
    results = []
    for working in _COARSE:
        results.append(_sides(left, right, value, working))
        if (
            not all(mpmath.isfinite(number) for number in results[-1])
            or agreement(*results[-1]) > _FEW
        ):
            return None
    if any(map(_may_be_lost, (left, right), results[-1])):
        return None
    stable = all(agreement(*values) > 2 * _FEW for values in zip(*results, strict=True))
    return Pair(*results[-1], point) if stable else None


def both(left: Expr, right: Expr, value: Numbers, point: Point, integrals: bool = False) -> Pair:
    """Return both sides with digits that are known to be right; raises Undecided.

    integrals: whether the meanings of the symbols contain an integral.
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
    sides, results = (left, right), list[tuple[Value, Value]]()
    for working in steps:
        results.append(_sides(left, right, value, working))
        if not all(mpmath.isfinite(number) for number in results[-1]):
            raise Undefined("a side has no finite value")
        if results[1:] and all(map(_is_known, sides, *results[-2:])):
            return Pair(*results[-1], point, _shared(*results[-2:]))
    left_values, right_values = zip(*results, strict=True)
    values = (
        _settled(left, left_values, steps, value),
        _settled(right, right_values, steps, value),
    )
    return Pair(*values, point)


def _shared(before: tuple[Value, Value], now: tuple[Value, Value]) -> int:
    """Return the number of digits that are known of both sides."""
    return min(agreement(*values) for values in zip(before, now, strict=True))


def _sharpened(left: Expr, right: Expr, value: Numbers, pair: Pair) -> Pair:
    """Return the pair with more digits if possible; raises Undecided.

    A small difference counts only if it is confirmed with more digits.
    """
    if pair.left == 0 or pair.right == 0:
        return pair
    before, now = (_sides(left, right, value, working) for working in _SHARP)
    known = _shared(before, now)
    if known >= DIGITS:
        sharper = Pair(*now, pair.point, known)
        return _held_against_more(left, right, value, sharper) if sharper.agree else sharper
    if not pair.agree:
        why = f"the two sides share {pair.digits} digits, and no further digits are known"
        raise Undecided(why)
    return pair


def _held_against_more(left: Expr, right: Expr, value: Numbers, pair: Pair) -> Pair:
    """Return the pair, or one that does not agree if the gap persists with more digits."""
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
            f"the two sides agree to {pair.digits} digits, but their integrals seem to be known to "
            f"{min(pair.known, _WORKING[1])} digits"
        )


def _demand_same_anew(left: Expr, right: Expr, value: Numbers, pair: Pair) -> None:
    """Raise Undecided if other cuts change the integrals by as much as the sides differ."""
    anew = _sides(left, right, value, _WORKING[1], Care.ANEW)
    if min(map(agreement, (pair.left, pair.right), anew)) < pair.digits + _FEW:
        raise Undecided(f"the integrals are not known beyond the {pair.digits} digits of agreement")


def _is_known(side: Expr, before: Value, now: Value) -> bool:
    """Whether enough digits of a side are known to be right."""
    return agreement(before, now) >= DIGITS and not _may_be_lost(side, now)


def _may_be_lost(side: Expr, now: Value) -> bool:
    """Whether a computed zero may be the result of complete cancellation."""
    return bool(now == 0) and side.has(Add, Integral, Symbol)


def _settled(
    side: Expr, values: tuple[Value, ...], steps: tuple[int, ...], value: Numbers
) -> Value:
    """Return the last value if it is known, or zero if the side vanishes; raises Undecided."""
    if _is_known(side, *values[-2:]):
        return values[-1]
    shrinks = all(abs(v) < mpf(10) ** (_NOISE - d) for v, d in zip(values, steps, strict=True))
    if not shrinks or _is_extreme(side, value):
        raise Undecided(f"cancellation leaves fewer than {DIGITS} of {steps[-1]} working digits")
    return mpf(0)


def _is_extreme(side: Expr, value: Numbers) -> bool:
    """Whether a part is so large or so small that rounding could hide another part."""
    less, more = (_sizes(side, value, working) for working in _WORKING[:2])
    floor = mpf(10) ** (_NOISE - _WORKING[0])
    return any(
        size != 0
        and abs(mpmath.log10(size)) > _MODERATE
        and not (size <= floor and agreement(size, again) < _FEW)  # rounding noise
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
    """Yield the sizes of an expression and its parts; an integrand is evaluated at one point."""
    yield abs(evaluated(side, numbers))
    if not isinstance(side, Integral):
        parts = side.args
        if isinstance(side, Piecewise):  # only the branch that is taken here
            parts = tuple(value for value, where in side.args if is_met(where, numbers))[:1]
        for part in parts:
            yield from _parts(part, numbers)
        return
    variable, low, high = side.limits[-1]
    yield from (*_parts(low, numbers), *_parts(high, numbers))
    ends = evaluated(low, numbers), evaluated(high, numbers)
    position = ends[0] + (ends[1] - ends[0]) * mpf(3) / 8
    yield from _parts(integrand(side), {**numbers, variable: position})


def near(left: Expr, right: Expr, value: Numbers) -> bool:
    """Whether both sides may be equal, judged by a few digits."""
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
