"""Two sides of a claim, and their values at points in digits that are certain.

If too few digits of a side are certain, its value is unknown, which is not the same as zero.  Two
sides agree if they share all digits of their values, except the last ones.
"""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import mpmath
from flint import arb
from mpmath import mpf
from sympy import Expr, Integral, Symbol

from derive.check.claim import Claim, Meaning, Point
from derive.proof.balls import Value, digits
from derive.proof.values import Defined, Undecided, evaluated, program
from derive.proof.verdict import DIGITS, shared_digits

_WORKING, _WITH_INTEGRALS = 114, 36
"""Certain digits of each side, and the same for sides with integrals."""
_LAST = 3
"""Two sides that agree may share fewer digits than are certain, by at most this number."""
_MODERATE = 30
"""Parts of a vanishing sum may be as large as 10**30 and as small as 10**-30."""
_QUICK = 16
"""Working digits for the first comparison of candidates."""
_CLOSE = arb(10) ** -7
_SMALL = arb(10) ** -2
"""Candidates may be equal if they differ by less than the first, relative to their size or to the
second."""


@dataclass(frozen=True)
class Pair:
    """The values of both sides at one point, and the number of their certain digits."""

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
        """Whether the two sides agree to all certain digits."""
        return self.digits >= self.known - _LAST

    @property
    def are_real(self) -> tuple[bool, bool]:
        """Whether the left and the right side are real numbers."""
        return mpmath.im(self.left) == 0, mpmath.im(self.right) == 0

    @property
    def ratio(self) -> Value:
        """The ratio of left to right side."""
        return self.left / self.right

    @property
    def gap(self) -> mpf:
        """The size of the difference."""
        return abs(self.left - self.right)


@dataclass(frozen=True)
class Sides:
    """Two sides of a claim, with the meanings of their symbols.

    known: values of the symbols at points, which sides with the same meanings may share
    """

    claim: Claim
    left: Expr
    right: Expr
    meaning: Meaning
    known: dict[tuple[tuple[Symbol, mpf], ...], Defined] = field(default_factory=dict)

    @classmethod
    def printed(cls, claim: Claim) -> "Sides":
        """The sides to compare for a claim as it is printed."""
        return cls(claim, *claim.meant.compared, claim.meant.meaning)

    def put(self, left: Expr, right: Expr) -> "Sides":
        """The sides to compare if these are printed instead."""
        sides = self.claim.meant.sides(left, right)
        return Sides(self.claim, *sides, self.meaning, self.known)

    @cached_property
    def in_variables(self) -> tuple[Expr, Expr]:
        """Both sides in terms of the variables."""
        table = dict(self.meaning)
        return self.left.xreplace(table), self.right.xreplace(table)

    @property
    def difference(self) -> Expr:
        """Left minus right side in terms of the variables."""
        left, right = self.in_variables
        return left - right

    @cached_property
    def _at_points(self) -> tuple[Expr, Expr]:
        """Both sides as they are evaluated: integrals are first expressed in the variables."""
        sides = self.left, self.right
        return self.in_variables if any(side.has(Integral) for side in sides) else sides

    def _values(self, point: Point) -> Defined:
        """The values of the variables, and of the source's symbols, at a point."""
        return self.known.setdefault((*point.items(),), Defined(point, self.meaning))

    def pair(self, point: Point) -> Pair:
        """Both sides at a point; raises Undecided."""
        held = self._values(point)
        integrals = any(side.has(Integral) for side in self.in_variables)
        with mpmath.workdps(_WITH_INTEGRALS if integrals else _WORKING):
            left, right = (evaluated(side, held) for side in self._at_points)
            for value, side in zip((left, right), self.in_variables, strict=True):
                if value == 0 and has_extremes(side, point) and not program(side)(point).is_zero():
                    raise Undecided("a part is so large or small that a side may not be zero")
            return Pair(left, right, point, mpmath.mp.dps)

    def pairs(self, where: Iterable[Point]) -> Iterator[Pair]:
        """Both sides at those points where they are known and real."""
        for point in where:
            with suppress(Undecided):
                if all((pair := self.pair(point)).are_real):
                    yield pair

    def may_agree(self, point: Point) -> bool:
        """Whether both sides may be equal at a point, judged by a few digits."""
        with mpmath.workdps(_QUICK), digits(2 * _QUICK):
            held = self._values(point)
            first, second = (program(side)(held) for side in self._at_points)
            scale = abs(first).upper().max(abs(second).upper()).max(_SMALL)
            return bool(abs(first - second).lower() < scale * _CLOSE)


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
