"""A claim about a limit, judged by how its two sides come near each other.

What tends to the end, c - x say, is brought there in steps of four decades, from either side; along
with it goes the one variable that it is solved for.  Without an order printed, left over right must
tend to 1; with one, their difference must fall like that power of the distance, or faster.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import mpmath
from mpmath import mpf
from sympy import Dummy, Expr, Symbol, oo, solve

from derive.paper.claim import Claim, Point, Verdict
from derive.paper.draw import in_order, is_allowed, points, variables
from derive.paper.quadrature import Value
from derive.paper.values import Undecided, evaluated

_DISTANCES = tuple(mpf(10) ** -n for n in (4, 8, 12, 16))
_DIGITS = 60
_BASES = 6
"""Points from which the limit is approached."""
_SLOWEST = 0.05
"""The power of the distance that a vanishing difference must fall by, to be told from one that
stays."""
_STAYS = 1e-3
"""The part of itself by which a number that stays may change in the last step."""
_SHORT = 0.1
"""What the measured order may fall short of the printed one."""


@dataclass(frozen=True)
class Approach:
    """Two sides in ours, and what tends to which end."""

    claim: Claim
    sides: list[Expr]
    toward: tuple[Expr, Expr]

    def judged(self, look: Callable[[], None]) -> tuple[Verdict, str]:
        """The verdict and why."""
        told, seen = "", 0
        for row in self._rows():
            look()
            verdict, told = self._of(row)
            if verdict != Verdict.NUMERICAL:
                return verdict, told
            seen += 1
        if seen < _BASES:
            why = "both sides are real numbers too seldom on the way: say where the variables are"
            return Verdict.UNCHECKED, why
        return Verdict.NUMERICAL, f"{told}, from {seen} points"

    def _rows(self) -> Iterator[list[tuple[mpf, Value, Value]]]:
        """Distance and both sides, step by step."""
        first, end = self.toward
        distance, seen = Dummy("t", positive=True), False
        for sign in (1, -1):
            if end in (oo, -oo):
                if (end == oo) != (sign == 1):
                    continue
                goal: Expr = sign / distance
            else:
                goal = end + sign * distance
            moved = self._solved(first, goal, distance)
            if moved is None:
                continue
            seen, (variable, place) = True, moved
            for base in points(self.claim, _BASES, "limit"):
                row = list(self._row(base, variable, place, distance))
                if len(row) == len(_DISTANCES):
                    yield row
        if not seen:
            raise Undecided(f"what tends to {end} is not solved for one of its variables")

    def _solved(self, first: Expr, goal: Expr, distance: Symbol) -> tuple[Symbol, Expr] | None:
        """A variable and where it is if `first` is at its goal."""
        own = set(variables(self.claim)) | first.free_symbols
        for variable in sorted(first.free_symbols & own, key=_places_first):
            if first.is_polynomial(variable):
                free = Dummy(variable.name)
                found = solve(first.xreplace({variable: free}) - goal, free)
                if len(found) == 1:
                    return variable, found[0]
        return None

    def _row(
        self, base: Point, variable: Symbol, place: Expr, distance: Symbol
    ) -> Iterator[tuple[mpf, Value, Value]]:
        with mpmath.workdps(_DIGITS):
            for size in _DISTANCES:
                try:
                    where = evaluated(place, {**base, distance: size})
                    point = {**base, variable: where}
                    outside = variable.is_positive and not mpmath.re(where) > 0
                    if outside or not is_allowed(self.claim, point):
                        return
                    left, right = (evaluated(side, point) for side in self.sides)
                except Undecided:
                    return
                if mpmath.im(left) != 0 or mpmath.im(right) != 0:
                    return
                yield size, left, right

    def _of(self, row: list[tuple[mpf, Value, Value]]) -> tuple[Verdict, str]:
        with mpmath.workdps(_DIGITS):
            if self.claim.order is not None:
                return self._by_order(row, self.claim.order)
            if any(right == 0 for _, _, right in row):
                return Verdict.UNCHECKED, "the right side vanishes on the way"
            ratios = [left / right for _, left, right in row]
            gaps = [(size, abs(r - 1)) for (size, _, _), r in zip(row, ratios, strict=True)]
            if gaps[-1][1] == 0:
                return Verdict.NUMERICAL, "left over right is 1"
            order = _order(gaps)
            if order > _SLOWEST:
                told = mpmath.nstr(order, 3)
                return Verdict.NUMERICAL, f"left over right differs from 1 by the power {told}"
            own = _order([(size, abs(r)) for (size, _, _), r in zip(row, ratios, strict=True)])
            if abs(own) > _SLOWEST:
                where = "0" if own > 0 else "infinity"
                return Verdict.FAILS, f"left over right tends to {where}, and not to 1"
            if abs(ratios[-1] - ratios[-2]) <= _STAYS * abs(ratios[-1]):
                told = mpmath.nstr(ratios[-1], 8)
                return Verdict.FAILS, f"left over right tends to {told}, and not to 1"
            return Verdict.UNCHECKED, "left over right tends too slowly to tell where to"

    def _by_order(self, row: list[tuple[mpf, Value, Value]], wanted: float) -> tuple[Verdict, str]:
        gaps = [(size, abs(left - right)) for size, left, right in row]
        if gaps[-1][1] == 0:
            return Verdict.NUMERICAL, "nothing is left of the difference"
        order = _order(gaps)
        told = f"the difference is of the order {mpmath.nstr(order, 3)}, {wanted:g} is printed"
        return (Verdict.NUMERICAL if order >= wanted - _SHORT else Verdict.FAILS), told


def _places_first(symbol: Symbol) -> tuple[bool, tuple[str, str]]:
    return bool(symbol.is_positive), in_order(symbol)


def _order(gaps: list[tuple[mpf, mpf]]) -> mpf:
    """The power by which a gap falls with the distance, in the last step."""
    (one, first), (other, second) = gaps[-2:]
    if first == 0:
        return mpf("inf") if second == 0 else mpf("-inf")
    return mpmath.log(first / second) / mpmath.log(one / other)
