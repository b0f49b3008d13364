"""Judge a claim about a limit by how its two sides approach each other.

The expression that tends to the limit, for example c - x, has a gap to it that must vanish.  One
variable moves to a place at which this gap is zero, in three steps and from either side, while the
others keep their values.  Such places are sought over all values that the variable may take.  If no
order is printed, the ratio of left to right must tend to 1.  If an order is printed, the difference
over that power of the gap must stay bounded.

The number of decades of the distance doubles with each step.  A quantity that is bounded then grows
by smaller and smaller factors, one that is not by equal or larger ones.  The steps go so far that
only a number of extreme size could still change the result; with such a number there is no verdict.
"""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from math import ceil

import mpmath
from mpmath import mpf
from sympy import Expr, Function, Integral, Piecewise, Symbol, oo

from derive.check.claim import SCALE, SIGNED, Claim, Point, Verdict
from derive.check.draw import in_order, is_allowed, points, zeros
from derive.check.sides import Sides, has_extremes
from derive.command.limit import LookAtClock
from derive.proof.balls import FUNCTIONS, Value
from derive.proof.values import Undecided, evaluated

_DECADES, _WITH_INTEGRALS = (64, 128, 256), (4, 8, 16)
"""Decades of the distances from a limit, and the same for sides with integrals or other functions
that take long."""
_DIGITS = 60
"""Digits that are left of the quantities, beside those that cancel on the way."""
_BASES = 6
"""Number of points from which the limit is approached."""
_ROWS, _MOST_BASES = 12, 24
"""Number of rows that are wanted, because both sides may be real on one side only; number of points
that are drawn to find so many."""
_NEAREST, _FARTHEST = mpf(10) ** -6, mpf(10) ** 6
"""Magnitudes between which the places are sought."""
_MOST_ZEROS = 6
"""Number of places that are examined along one variable."""
_SAME, _NEAR = mpf(10) ** -32, mpf(10) ** -9
"""Distances within which two places are one, after and before they are refined."""
_SLOWEST = 0.05
"""A quantity vanishes if it decreases by a higher power of the distance than this one."""
_SETTLES = 0.1
"""The largest ratio of the last two changes of a quantity that has a finite limit."""
_BOUNDED, _UNBOUNDED = 0.75, 0.93
"""The largest ratio of the last two growths of a bounded quantity, and the least of one that is
not bounded.  It is 1/2 for a limit that is approached as 1/log, and 1 for the growth of log."""
_FIRST = (Verdict.FAILS, Verdict.UNCHECKED, Verdict.NUMERICAL)
"""The order in which the verdicts from both sides of a limit count."""
_CLOSE = 1e-6
"""A limit nearer to 1 is told by its difference from 1."""
_NOISE = mpf(10) ** -40
"""Relative changes below this one are due to rounding."""


@dataclass(frozen=True)
class Row:
    """The points on the way to a limit from one point, each with the gap that is left."""

    points: list[Point]
    gaps: list[Value]


@dataclass(frozen=True)
class Way:
    """One variable that moves to a place, and the points on the way there from several points.

    place       which of its places is meant
    is_extreme  whether the place is infinity, or zero for a positive variable
    """

    variable: Symbol
    place: str
    is_extreme: bool
    rows: list[Row]

    @property
    def preference(self) -> tuple[bool, bool]:
        """A sort key: if c = kappa*a, c -> a means kappa -> 1 and not a -> 0."""
        return self.is_extreme, bool(self.variable.is_positive)

    def __str__(self) -> str:
        """Which variable moves where, and which ones stay."""
        ends = {self.place}
        if not self.is_extreme:
            last = [row.points[-1][self.variable] for row in self.rows]
            ends = {mpmath.nstr(each if abs(each) > _NEAR else 0, 6) for each in last}
        where = f" to {ends.pop()}" if len(ends) == 1 else ""
        stay = [s.name for s in sorted(self.rows[0].points[0], key=in_order) if s != self.variable]
        return f"{self.variable} moves{where}" + (f" and {', '.join(stay)} stay" if stay else "")


class Approach:
    """The ways in which the expression of a claim tends to its end."""

    def __init__(self, claim: Claim) -> None:
        assert claim.meant.toward is not None
        self.claim, (expr, self.end) = claim, claim.meant.toward
        sides = Sides.printed(claim).in_variables
        decades = _DECADES if all(map(_is_quick, (expr, *sides))) else _WITH_INTEGRALS
        self.steps = [mpf(10) ** -each for each in decades]
        self.digits = _DIGITS + ceil(decades[-1] * max(2, (claim.entry.order or 0) + 1))
        self.gap = 1 / expr if self.end in (oo, -oo) else expr - self.end
        self.variables = sorted(self.gap.free_symbols, key=in_order)

    def judged(self, asked: Sides, look: LookAtClock) -> tuple[Verdict, str]:
        """Return the verdict on two sides, and the reason for it; raises Undecided."""
        sides = asked.in_variables
        if any(has_extremes(side, self._bases[0]) for side in sides if self._bases):
            why = "a part is so large or small that it may matter only still nearer to the limit"
            return Verdict.UNCHECKED, why
        if not self._ways:
            why = f"no variable of the expression that tends to {self.end} could be moved there"
            return Verdict.UNCHECKED, f"{why}: name the variable that moves, as in x -> 0"
        best = min(way.preference for way in self._ways)
        ways = [way for way in self._ways if way.preference == best]
        results = [(way, found) for way in ways if (found := self._along(way, sides, look))]
        if not results:
            why = (
                "too few points were found from which both sides stay real up to the limit: "
                "restrict the variables with `low`, `high` and `require`"
            )
            return Verdict.UNCHECKED, why
        moving = {way.variable for way in self._ways}
        stuck = [each.name for each in self.variables if each not in moving]
        if stuck and all(way.is_extreme for way, _ in results):
            why = f"it is not known where {', '.join(stuck)} would have to move"
            return Verdict.UNCHECKED, f"{why}: name the variable that moves, as in x -> 0"
        told = [f"if {way}, {why}" for way, (_, why) in results]
        if len({verdict for _, (verdict, _) in results}) == 1:
            return results[0][1][0], "; ".join(told)
        why = f"`as` does not say which variable moves: {'; '.join(told)}"
        return Verdict.UNCHECKED, f"{why}; name this variable, as in x -> 0"

    # -------------------------------------------------------------- places

    @cached_property
    def _bases(self) -> list[Point]:
        return list(points(self.claim, _MOST_BASES, "limit"))

    @cached_property
    def _ways(self) -> list[Way]:
        """All ways along each variable, with rows from the first suitable points."""
        return [way for variable in self.variables for way in self._ways_of(variable)]

    def _ways_of(self, variable: Symbol) -> list[Way]:
        rows: dict[tuple[str, bool], list[Row]] = {}
        for number, base in enumerate(self._bases):
            if number >= _BASES and all(len(each) >= _ROWS for each in rows.values()):
                break
            with mpmath.workdps(2 * self.digits):
                for place, is_extreme, moves in self._moved(variable, base):
                    if row := self._row(variable, moves, base):
                        rows.setdefault((place, is_extreme), []).append(row)
        return [Way(variable, *key, each) for key, each in rows.items()]

    def _moved(self, variable: Symbol, base: Point) -> Iterator[tuple[str, bool, list[mpf]]]:
        """Yield the values of a variable on the way to each place where the gap may vanish."""
        span = self.claim.meant.ranges.get(variable, SIGNED)
        # the distances differ from point to point, so that what oscillates is seen to do so
        steps = [step * (1 + abs(base[variable])) for step in self.steps]
        ends = [] if span is SIGNED or span is SCALE else [mpf(str(span.low)), mpf(str(span.high))]
        for number, place in enumerate(self._zeros(variable, base)):
            if any(abs(place - end) <= _SAME * max(1, abs(end)) for end in ends):
                continue  # it is approached from inside the range
            size = abs(place) if abs(place) > _SAME else mpf(1)
            low, high = ends or (place, place)
            # a place beyond the range is approached from the side of the range
            for sign in [1] * (place <= high) + [-1] * (place >= low):
                yield f"zero {number}", False, [place + sign * size * step for step in steps]
        for end, sign in zip(ends, (1, -1), strict=False):
            if end != 0 or not variable.is_positive:
                length = ends[1] - ends[0]
                yield str(end), False, [end + sign * length * step for step in steps]
        yield "infinity", True, [1 / step for step in steps]
        if variable.is_positive:
            yield "0", True, steps
        else:
            yield "-infinity", True, [-1 / step for step in steps]

    def _zeros(self, variable: Symbol, base: Point) -> list[mpf]:
        """Return the values of a variable at which the gap is zero, or stationary."""
        ends = (_NEAREST if variable.is_positive else -_FARTHEST), _FARTHEST
        found = list[mpf]()
        for expr in (self.gap, self.gap.diff(variable)):
            places = zeros(expr, variable, base, *ends)[:_MOST_ZEROS]
            found += [p for p in places if all(abs(p - each) > _NEAR for each in found)]
        return sorted(found)

    def _row(self, variable: Symbol, values: list[mpf], base: Point) -> Row | None:
        """Return the points on the way, if they are allowed and the gap vanishes along them."""
        way = [{**base, variable: value} for value in values]
        is_wrong = variable.is_positive and any(value <= 0 for value in values)
        if is_wrong or not all(is_allowed(self.claim, point) for point in way):
            return None
        with mpmath.workdps(self.digits):
            try:
                gaps = [evaluated(self.gap, point) for point in way]
            except Undecided:
                return None
            sign = {oo: 1, -oo: -1}.get(self.end, 0)
            if any(mpmath.im(gap) != 0 or gap == 0 or gap * sign < 0 for gap in gaps):
                return None
            is_vanishing = _order(gaps, self.steps) > _SLOWEST
            return Row(way, [abs(gap) for gap in gaps]) if is_vanishing else None

    # -------------------------------------------------------------- verdicts

    def _along(
        self, way: Way, sides: tuple[Expr, Expr], look: LookAtClock
    ) -> tuple[Verdict, str] | None:
        """Return the verdict if one variable moves, or None if there are too few points."""
        found: dict[bool, list[tuple[Verdict, str]]] = {}
        for row in way.rows:
            look()
            with mpmath.workdps(self.digits), suppress(Undecided):
                left, right = ([evaluated(side, at) for at in row.points] for side in sides)
                if not any(mpmath.im(value) != 0 for value in (*left, *right)):
                    first, last = (row.points[n][way.variable] for n in (0, -1))
                    found.setdefault(bool(first > last), []).append(self._of(left, right, row.gaps))
        count = sum(map(len, found.values()))
        if count < _BASES:
            return None
        verdict, why = min(map(_common, found.values()), key=lambda each: _FIRST.index(each[0]))
        return verdict, f"{why}, from {count} points" if verdict == Verdict.NUMERICAL else why

    def _of(self, left: list[Value], right: list[Value], gaps: list[Value]) -> tuple[Verdict, str]:
        """Return the verdict for one point from which the limit is approached."""
        pairs = list(zip(left, right, strict=True))
        if self.claim.entry.order is not None:
            least = mpf(10) ** (_DIGITS // 2 - self.digits)  # smaller differences are rounding
            change = [one - other for one, other in pairs]
            for n, (one, _) in enumerate(pairs):
                change[n] *= abs(change[n]) > least * abs(one)
            return _by_order(change, gaps, mpf(self.claim.entry.order))
        if 0 in right:
            return Verdict.UNCHECKED, "the right side vanishes on the way to the limit"
        return _by_ratio([one / other for one, other in pairs], gaps)


def _is_quick(expr: Expr) -> bool:
    """Whether an expression has values to hundreds of digits in a short time."""
    known = (*FUNCTIONS, Piecewise)
    return not expr.has(Integral) and all(each.func in known for each in expr.atoms(Function))


def _common(found: list[tuple[Verdict, str]]) -> tuple[Verdict, str]:
    """Return the verdict that all points on one side give."""
    if len({verdict for verdict, _ in found}) == 1:
        return found[0]
    return Verdict.UNCHECKED, "how the two sides approach each other depends on the point"


def _by_order(difference: list[Value], gaps: list[Value], wanted: mpf) -> tuple[Verdict, str]:
    if difference[-1] == 0:
        return Verdict.NUMERICAL, "the difference of the two sides is zero"
    order = mpmath.nstr(_order(difference, gaps), 3)
    why = f"the difference is of order {order} (printed: {float(wanted):g})"
    if 0 in difference:
        return Verdict.UNCHECKED, "the difference of the two sides vanishes on the way to the limit"
    size = [mpmath.log(abs(each / gap**wanted)) for each, gap in zip(difference, gaps, strict=True)]
    before, last = size[1] - size[0], size[2] - size[1]
    if last <= max(_NOISE, _BOUNDED * before):
        return Verdict.NUMERICAL, why
    if before > _NOISE and last >= _UNBOUNDED * before:
        return Verdict.FAILS, f"{why}: over that power of the distance, it grows without bound"
    return Verdict.UNCHECKED, f"{why}, but it is not clear whether it decreases in proportion"


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
    elif abs(ratios[-1] - ratios[-2]) <= max(
        _SETTLES * abs(ratios[-2] - ratios[-3]), _NOISE * abs(ratios[-1])
    ):
        limit = mpmath.nstr(ratios[-1], 8)
        if abs(off := ratios[-1] - 1) < _CLOSE:
            limit = f"1 {'+' if off > 0 else '-'} {mpmath.nstr(abs(off), 3)}"
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
