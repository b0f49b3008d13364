"""Judge a claim about a limit by how its two sides approach each other.

The expression that tends to the limit, for example c - x, has a gap to it that must vanish.  One
variable moves to a place at which this gap is zero, in steps of four decades and from either side,
while the others keep their values.  Such places are sought over all values that the variable may
take.  If no order is printed, the ratio of left to right must tend to 1.  If an order is printed,
the difference must decrease at least as fast as that power of the gap.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property

import mpmath
import numpy as np
from mpmath import mpf
from sympy import Expr, Symbol, oo

from derive.check.claim import SCALE, SIGNED, Claim, Point, Verdict
from derive.check.draw import in_order, is_allowed, points, zeros
from derive.command.limit import LookAtClock
from derive.proof.balls import Value
from derive.proof.values import Undecided, evaluated

_STEPS = tuple(mpf(10) ** -n for n in (4, 8, 12, 16))
_DIGITS = 60
_BASES = 6
"""Number of points from which the limit is approached."""
_ROWS, _MOST_BASES = 12, 24
"""Number of rows that are wanted, because both sides may be real on one side only; number of points
that are drawn to find so many."""
_GRID = np.logspace(-6, 6.1, 96)
"""Magnitudes over which the places are sought; simple numbers are not among them."""
_MOST_ZEROS = 6
"""Number of places that are examined along one variable."""
_SAME, _NEAR = mpf(10) ** -32, mpf(10) ** -9
"""Distances within which two places are one, after and before they are refined."""
_SLOWEST = 0.05
"""A quantity vanishes if it decreases by a higher power of the distance than this one."""
_SETTLES = 0.1
"""The largest ratio of the last two changes of a quantity that has a finite limit."""
_SHORT = 0.02
"""The amount by which the measured order may fall short of the printed one; less than a logarithm
takes away."""


class Kind(IntEnum):
    """Where a variable moves, in the order of preference.

    If c = kappa*a, c -> a means kappa -> 1 and not a -> 0.
    """

    INSIDE = 0
    """To a value in its declared range, if it has one."""
    OUTSIDE = 1
    """To another value, which is not zero if the variable is positive."""
    EXTREME = 2
    """To infinity, or to zero if the variable is positive."""


@dataclass(frozen=True)
class Row:
    """The points on the way to a limit from one point, each with the gap that is left."""

    points: list[Point]
    gaps: list[Value]


@dataclass(frozen=True)
class Way:
    """One variable that moves to places of one kind, and the points on the way there.

    place: which of these places is meant, if there are several
    """

    variable: Symbol
    kind: Kind
    place: str
    rows: list[Row]


class Approach:
    """The ways in which the expression of a claim tends to its end."""

    def __init__(self, claim: Claim, toward: tuple[Expr, Expr]) -> None:
        self.claim, (self.expr, self.end) = claim, toward
        infinite = self.end in (oo, -oo)
        self.gap = 1 / self.expr if infinite else self.expr - self.end
        self.sign = 0 if not infinite else 1 if self.end == oo else -1
        self.variables = sorted(self.gap.free_symbols, key=in_order)

    def judged(self, sides: tuple[Expr, Expr], look: LookAtClock) -> tuple[Verdict, str]:
        """Return the verdict on two sides in terms of the variables, and the reason for it."""
        results = list[tuple[Way, tuple[Verdict, str]]]()
        for way in self.ways:
            if (found := self._along(way, sides, look)) is not None:
                results.append((way, found))
        if not results:
            why = (
                "too few points were found from which both sides stay real up to the limit: "
                "restrict the variables with `low`, `high` and `require`"
            )
            return Verdict.UNCHECKED, why
        stuck = [each.name for each in self.variables if each not in self._places]
        if stuck and all(way.kind == Kind.EXTREME for way, _ in results):
            why = f"it is not known where {', '.join(stuck)} would have to move"
            return Verdict.UNCHECKED, f"{why}: name the variable that moves, as in x -> 0"
        told = [f"if {self._moves(way)}, {why}" for way, (_, why) in results]
        if len({verdict for _, (verdict, _) in results}) == 1:
            return results[0][1][0], "; ".join(told)
        why = f"`as` does not say which variable moves: {'; '.join(told)}"
        return Verdict.UNCHECKED, f"{why}; name this variable, as in x -> 0"

    def _moves(self, way: Way) -> str:
        """Describe which variable moves where, and which ones stay."""
        ends = {way.place}
        if way.kind != Kind.EXTREME:
            last = [row.points[-1][way.variable] for row in way.rows]
            ends = {mpmath.nstr(each if abs(each) > _NEAR else 0, 6) for each in last}
        where = f" to {ends.pop()}" if len(ends) == 1 else ""
        stay = [s.name for s in sorted(way.rows[0].points[0], key=in_order) if s != way.variable]
        return f"{way.variable} moves{where}" + (f" and {', '.join(stay)} stay" if stay else "")

    # -------------------------------------------------------------- places

    @cached_property
    def _bases(self) -> list[Point]:
        return list(points(self.claim, _MOST_BASES, "limit"))

    @cached_property
    def _places(self) -> dict[Symbol, list[Way]]:
        """The ways of each variable that can move to a place at which the gap vanishes."""
        found = {variable: self._ways(variable) for variable in self.variables}
        return {variable: ways for variable, ways in found.items() if ways}

    @cached_property
    def ways(self) -> list[Way]:
        """The ways of the most preferred kind; a variable that may be negative comes first."""
        if not self._places:
            why = f"no variable of the expression that tends to {self.end} could be moved there"
            raise Undecided(f"{why}: name the variable that moves, as in x -> 0")
        ways = [way for each in self._places.values() for way in each]

        def rank(way: Way) -> tuple[bool, bool, int]:
            is_extreme = way.kind == Kind.EXTREME
            return is_extreme, bool(way.variable.is_positive), way.kind

        best = min(map(rank, ways))
        return [way for way in ways if rank(way) == best]

    def _ways(self, variable: Symbol) -> list[Way]:
        """Return all ways along a variable, with rows from the first suitable points."""
        rows: dict[tuple[Kind, str], list[Row]] = {}
        for number, base in enumerate(self._bases):
            if number >= _BASES and all(len(each) >= _ROWS for each in rows.values()):
                break
            with mpmath.workdps(2 * _DIGITS):
                for kind, place, moves in self._moved(variable, base):
                    if row := self._row(variable, moves, base):
                        rows.setdefault((kind, place), []).append(row)
        return [Way(variable, kind, place, each) for (kind, place), each in rows.items()]

    def _moved(self, variable: Symbol, base: Point) -> Iterator[tuple[Kind, str, list[mpf]]]:
        """Yield the values of a variable on the way to each place where the gap may vanish."""
        span = self.claim.meant.ranges.get(variable, SIGNED)
        ends = [] if span is SIGNED or span is SCALE else [mpf(span.low), mpf(span.high)]
        for number, place in enumerate(self._zeros(variable, base)):
            if any(abs(place - end) <= _SAME * max(1, abs(end)) for end in ends):
                continue  # it is approached from inside the range
            kind = Kind.INSIDE if not ends or ends[0] < place < ends[1] else Kind.OUTSIDE
            size = abs(place) if abs(place) > _SAME else mpf(1)
            for sign in (1, -1):
                yield kind, f"zero {number}", [place + sign * size * step for step in _STEPS]
        for end, sign in zip(ends, (1, -1), strict=False):
            if end != 0 or not variable.is_positive:
                length = ends[1] - ends[0]
                yield Kind.INSIDE, str(end), [end + sign * length * step for step in _STEPS]
        yield Kind.EXTREME, "infinity", [1 / step for step in _STEPS]
        if variable.is_positive:
            yield Kind.EXTREME, "0", [*_STEPS]
        else:
            yield Kind.EXTREME, "-infinity", [-1 / step for step in _STEPS]

    def _zeros(self, variable: Symbol, base: Point) -> list[mpf]:
        """Return the values of a variable at which the gap is zero, or stationary."""
        grid = _GRID if variable.is_positive else np.concatenate([-_GRID[::-1], _GRID])
        found = list[mpf]()
        for expr in (self.gap, self.gap.diff(variable)):
            for zero, _ in zeros(expr, variable, base, grid)[:_MOST_ZEROS]:
                place = _refined(expr, variable, base, mpf(zero))
                if place is not None and all(abs(place - each) > _NEAR for each in found):
                    found.append(place)
        return sorted(found)

    def _row(self, variable: Symbol, values: list[mpf], base: Point) -> Row | None:
        """Return the points on the way, if they are allowed and the gap vanishes along them."""
        way = [{**base, variable: value} for value in values]
        is_wrong = variable.is_positive and any(value <= 0 for value in values)
        if is_wrong or not all(is_allowed(self.claim, point) for point in way):
            return None
        with mpmath.workdps(_DIGITS):
            try:
                gaps = [evaluated(self.gap, point) for point in way]
            except Undecided:
                return None
            if any(mpmath.im(gap) != 0 or gap == 0 or gap * self.sign < 0 for gap in gaps):
                return None
            is_vanishing = _order([abs(step) for step in gaps], list(_STEPS)) > _SLOWEST
            return Row(way, [abs(gap) for gap in gaps]) if is_vanishing else None

    # -------------------------------------------------------------- verdicts

    def _along(
        self, way: Way, sides: tuple[Expr, Expr], look: LookAtClock
    ) -> tuple[Verdict, str] | None:
        """Return the verdict if one variable moves, or None if there are too few points."""
        why, seen = "", 0
        for row in way.rows:
            look()
            with mpmath.workdps(_DIGITS):
                try:
                    both = [[evaluated(side, point) for point in row.points] for side in sides]
                except Undecided:
                    continue
                if any(mpmath.im(value) != 0 for values in both for value in values):
                    continue
                verdict, why = self._of(both[0], both[1], row.gaps)
            if verdict != Verdict.NUMERICAL:
                return verdict, why
            seen += 1
        return (Verdict.NUMERICAL, f"{why}, from {seen} points") if seen >= _BASES else None

    def _of(self, left: list[Value], right: list[Value], gaps: list[Value]) -> tuple[Verdict, str]:
        """Return the verdict for one point from which the limit is approached."""
        if self.claim.meant.order is not None:
            difference = [one - other for one, other in zip(left, right, strict=True)]
            return _by_order(difference, gaps, self.claim.meant.order)
        if 0 in right:
            return Verdict.UNCHECKED, "the right side vanishes on the way to the limit"
        return _by_ratio([one / other for one, other in zip(left, right, strict=True)], gaps)


def _refined(expr: Expr, variable: Symbol, base: Point, zero: mpf) -> mpf | None:
    """Return a zero of an expression to many digits, or None if it has none here."""

    def value(at: Value) -> Value:
        return evaluated(expr, {**base, variable: at})

    try:
        starts = zero, zero + max(abs(zero), mpf(1)) * _NEAR
        place = mpmath.findroot(value, starts, solver="secant", verify=False)
    except (Undecided, ValueError, ZeroDivisionError):
        return None
    return place if isinstance(place, mpf) else None


def _by_order(difference: list[Value], gaps: list[Value], wanted: float) -> tuple[Verdict, str]:
    if difference[-1] == 0:
        return Verdict.NUMERICAL, "the difference of the two sides is zero"
    order = _order(difference, gaps)
    why = f"the difference is of order {mpmath.nstr(order, 3)} (printed: {wanted:g})"
    return (Verdict.NUMERICAL if order >= wanted - _SHORT else Verdict.FAILS), why


def _by_ratio(ratios: list[Value], gaps: list[Value]) -> tuple[Verdict, str]:
    if ratios[-1] == 1:
        return Verdict.NUMERICAL, "the ratio left/right is 1"
    order = _order([ratio - 1 for ratio in ratios], gaps)
    orders = _order(ratios[:-1], gaps[:-1]), _order(ratios, gaps)
    if order > _SLOWEST:
        power = mpmath.nstr(order, 3)
        why = f"the ratio left/right tends to 1 with the power {power} of the distance"
        return Verdict.NUMERICAL, why
    if min(orders) > _SLOWEST or max(orders) < -_SLOWEST:
        limit = "0" if orders[0] > 0 else "infinity"
    elif abs(ratios[-1] - ratios[-2]) <= _SETTLES * abs(ratios[-2] - ratios[-3]):
        limit = mpmath.nstr(ratios[-1], 8)
    else:
        why = "the ratio left/right converges too slowly for its limit to be identified"
        return Verdict.UNCHECKED, why
    return Verdict.FAILS, f"the ratio left/right tends to {limit} and not to 1"


def _order(values: list[Value], gaps: list[Value]) -> mpf:
    """Return the power of the gap by which a quantity decreases in the last step."""
    first, second = map(abs, values[-2:])
    if first == 0:
        return mpf("inf") if second == 0 else mpf("-inf")
    if second == 0:
        return mpf("inf")
    return mpmath.log(first / second) / mpmath.log(abs(gaps[-2] / gaps[-1]))
