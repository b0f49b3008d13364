"""Compare the two sides of a claim in digits that are certain.

Each side is a ball that holds its value.  If rounding or cancellation leaves fewer than DIGITS
digits of one, both are computed again with more; if that does not help, the value is unknown, which
is not the same as zero.  Two sides agree if they share all digits that are known of them.  What
differs beyond its bound of error is really different.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import mpmath
from flint import arb
from mpmath import mpf
from sympy import Expr, Integral, Symbol

from derive.check.claim import Meaning, Point
from derive.proof.balls import Ball, Value, digits, known_digits, number
from derive.proof.values import Undecided, enclosed, program
from derive.proof.verdict import DIGITS, EXACT, shared_digits

_WORKING = (120, 240)
"""Working digits, tried in this order."""
_WITH_INTEGRALS = (36, 80)
"""The same for sides with integrals."""
_GUARD = 12
"""Additional digits of the balls, and those by which the bound of a vanishing sum may exceed its
last digit."""
_LAST = 3
"""Two sides that agree may share fewer digits than are known of them, by at most this number."""
_MODERATE = 30
"""Parts of a vanishing sum may be as large as 10**30 and as small as 10**-30."""
_QUICK = 16
"""Working digits for the first comparison of candidates."""
_CLOSE = arb(10) ** -7
_SMALL = arb(10) ** -2
"""Candidates may be equal if they differ by less than the first, relative to their size or to the
second."""

Numbers = Callable[[], Mapping[Symbol, Any]]
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
        return shared_digits(self.left, self.right)

    @property
    def agree(self) -> bool:
        """Whether the two sides agree to the required number of digits and to all known digits."""
        return self.digits >= max(DIGITS, min(self.known, EXACT) - _LAST)


class _Numbers(dict[Symbol, Any]):
    """Values of the variables, and of the source's symbols as soon as they are needed."""

    def __init__(self, known: Mapping[Symbol, Any], meaning: Meaning) -> None:
        super().__init__(known)
        self._known, self.meaning = known, meaning

    def __missing__(self, symbol: Symbol) -> Ball:
        if symbol not in self.meaning:
            raise Undecided(f"the symbol {symbol} has no meaning")
        self[symbol] = program(self.meaning[symbol])(self._known)
        return self[symbol]


def numbers(meaning: Meaning, point: Point) -> Mapping[Symbol, Any]:
    """The values of the variables and of the source's symbols at one point."""
    return _Numbers(_Numbers(point, {}), meaning)


def both(left: Expr, right: Expr, value: Numbers, point: Point, integrals: bool = False) -> Pair:
    """Both sides with digits that are known to be right; raises Undecided.

    integrals: whether the meanings of the symbols contain an integral.
    """
    integrals = integrals or left.has(Integral) or right.has(Integral)
    for working in _WITH_INTEGRALS if integrals else _WORKING:
        with mpmath.workdps(working), digits(working + _GUARD):
            held = value()
            balls = enclosed(left, held), enclosed(right, held)
            one, other = map(number, balls)
            if (balls[0] - balls[1]).contains(0):  # what they differ by is not known
                other = one
            pair = Pair(one, other, point, min(working, *map(known_digits, balls)))
            if pair.known >= DIGITS:
                if integrals and not pair.agree and pair.digits >= DIGITS:
                    raise Undecided(
                        f"the two sides agree to {pair.digits} digits, but their integrals seem to "
                        f"be known to {pair.known} digits"
                    )
                return pair
    with mpmath.workdps(working), digits(working + _GUARD):
        return Pair(_settled(left, balls[0], held), _settled(right, balls[1], held), point)


def _settled(side: Expr, found: Ball, held: Mapping[Symbol, Any]) -> Value:
    """The value if it is known, or zero if the side vanishes; raises Undecided."""
    if known_digits(found) >= DIGITS:
        return number(found)
    working = mpmath.mp.dps
    if found.contains(0) and abs(found).upper() < arb(10) ** (_GUARD - working):
        if isinstance(held, _Numbers):
            side = side.xreplace(dict(held.meaning))
        if not has_extremes(side, held):
            return mpf(0)
    raise Undecided(f"cancellation leaves fewer than {DIGITS} of {working} working digits")


def has_extremes(expr: Expr, held: Mapping[Symbol, Any]) -> bool:
    """Whether a part is extreme, also of an integrand in the middle of its range."""
    if any(map(_is_extreme, program(expr).parts(held))):
        return True
    for over in expr.atoms(Integral):
        if over.free_symbols <= held.keys():
            middle = {symbol: held[symbol] for symbol in over.free_symbols}
            for variable, low, high in reversed(over.limits):
                middle[variable] = (program(low)(middle) + program(high)(middle)) / 2
            if has_extremes(over.function, middle):
                return True
    return False


def _is_extreme(part: Any) -> bool:
    """Whether a part is so large or so small that its rounding could hide another part."""
    if part is None or isinstance(part, bool) or not part.is_finite() or part.contains(0):
        return False
    size = abs(part)
    return not arb(10) ** -_MODERATE < size < arb(10) ** _MODERATE


def near(left: Expr, right: Expr, value: Numbers) -> bool:
    """Whether both sides may be equal, judged by a few digits."""
    with mpmath.workdps(_QUICK), digits(2 * _QUICK):
        held = value()
        first, second = (program(side)(held) for side in (left, right))
        scale = abs(first).upper().max(abs(second).upper()).max(_SMALL)
        return bool(abs(first - second).lower() < scale * _CLOSE)
