"""Judge a claim about a limit by how its two sides approach each other.

The expression that tends to the limit, for example c - x, approaches it in steps of four decades,
from either side.  It is solved for one of its variables, which moves with it.  If no order is
printed, the ratio of left to right must tend to 1.  If an order is printed, the difference must
decrease at least as fast as that power of the distance.
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
"""Number of points from which the limit is approached."""
_SLOWEST = 0.05
"""A quantity vanishes if it decreases by a higher power of the distance than this one."""
_STAYS = 1e-3
"""The largest relative change, in the last step, of a quantity that has a finite limit."""
_SHORT = 0.1
"""The amount by which the measured order may fall short of the printed one."""


@dataclass(frozen=True)
class Approach:
    """Both sides in terms of the variables, and the expression with the end that it tends to."""

    claim: Claim
    sides: list[Expr]
    toward: tuple[Expr, Expr]

    def judged(self, look: Callable[[], None]) -> tuple[Verdict, str]:
        """Return the verdict and the reason for it."""
        why, seen = "", 0
        for row in self._rows():
            look()
            verdict, why = self._of(row)
            if verdict != Verdict.NUMERICAL:
                return verdict, why
            seen += 1
        if seen < _BASES:
            why = (
                "too few points were found from which both sides stay real up to the limit: "
                "restrict the variables with low, high and require"
            )
            return Verdict.UNCHECKED, why
        return Verdict.NUMERICAL, f"{why}, from {seen} points"

    def _rows(self) -> Iterator[list[tuple[mpf, Value, Value]]]:
        """Yield the distance and both sides, step by step, for each approach."""
        first, end = self.toward
        distance, seen = Dummy("t", positive=True), False
        for sign in (1, -1):
            if end in (oo, -oo):
                if (end == oo) != (sign == 1):
                    continue
                target: Expr = sign / distance
            else:
                target = end + sign * distance
            moved = self._solved(first, target, distance)
            if moved is None:
                continue
            seen, (variable, value) = True, moved
            for base in points(self.claim, _BASES, "limit"):
                row = list(self._row(base, variable, value, distance))
                if len(row) == len(_DISTANCES):
                    yield row
        if not seen:
            raise Undecided(
                f"the expression that tends to {end} could not be solved for one of its variables"
            )

    def _solved(self, first: Expr, target: Expr, distance: Symbol) -> tuple[Symbol, Expr] | None:
        """Return a variable and its value for which `first` equals the target."""
        own = set(variables(self.claim)) | first.free_symbols
        for variable in sorted(first.free_symbols & own, key=_places_first):
            if first.is_polynomial(variable):
                free = Dummy(variable.name)
                solutions = solve(first.xreplace({variable: free}) - target, free)
                if len(solutions) == 1:
                    return variable, solutions[0]
        return None

    def _row(
        self, base: Point, variable: Symbol, value: Expr, distance: Symbol
    ) -> Iterator[tuple[mpf, Value, Value]]:
        with mpmath.workdps(_DIGITS):
            for size in _DISTANCES:
                try:
                    where = evaluated(value, {**base, distance: size})
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
                return Verdict.UNCHECKED, "the right side vanishes on the way to the limit"
            ratios = [left / right for _, left, right in row]
            gaps = [(size, abs(r - 1)) for (size, _, _), r in zip(row, ratios, strict=True)]
            if gaps[-1][1] == 0:
                return Verdict.NUMERICAL, "the ratio left/right is 1"
            order = _order(gaps)
            if order > _SLOWEST:
                shown = mpmath.nstr(order, 3)
                why = f"the ratio left/right tends to 1 with the power {shown} of the distance"
                return Verdict.NUMERICAL, why
            own = _order([(size, abs(r)) for (size, _, _), r in zip(row, ratios, strict=True)])
            if abs(own) > _SLOWEST:
                limit = "0" if own > 0 else "infinity"
                return Verdict.FAILS, f"the ratio left/right tends to {limit} and not to 1"
            if abs(ratios[-1] - ratios[-2]) <= _STAYS * abs(ratios[-1]):
                shown = mpmath.nstr(ratios[-1], 8)
                return Verdict.FAILS, f"the ratio left/right tends to {shown} and not to 1"
            why = "the ratio left/right converges too slowly for its limit to be identified"
            return Verdict.UNCHECKED, why

    def _by_order(self, row: list[tuple[mpf, Value, Value]], wanted: float) -> tuple[Verdict, str]:
        gaps = [(size, abs(left - right)) for size, left, right in row]
        if gaps[-1][1] == 0:
            return Verdict.NUMERICAL, "the difference of both sides is zero"
        order = _order(gaps)
        why = f"the difference is of order {mpmath.nstr(order, 3)} (printed: {wanted:g})"
        return (Verdict.NUMERICAL if order >= wanted - _SHORT else Verdict.FAILS), why


def _places_first(symbol: Symbol) -> tuple[bool, tuple[str, str]]:
    return bool(symbol.is_positive), in_order(symbol)


def _order(gaps: list[tuple[mpf, mpf]]) -> mpf:
    """Return the power of the distance by which a gap decreases in the last step."""
    (one, first), (other, second) = gaps[-2:]
    if first == 0:
        return mpf("inf") if second == 0 else mpf("-inf")
    return mpmath.log(first / second) / mpmath.log(one / other)
