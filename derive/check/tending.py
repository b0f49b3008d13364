"""Judge a claim about a limit by how its two sides approach each other.

The expression that tends to the limit, for example c - x, approaches it in steps of four decades,
from either side.  It is solved for one of its variables, which moves with it while the others keep
their values.  If several variables may move, the verdict must be the same for each of them.  If no
order is printed, the ratio of left to right must tend to 1.  If an order is printed, the difference
must decrease at least as fast as that power of the distance.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import mpmath
from mpmath import mpf
from sympy import Dummy, Expr, Symbol, nan, oo, solve, zoo

from derive.check.claim import Claim, Point, Verdict
from derive.check.draw import in_order, is_allowed, points
from derive.command.limit import LookAtClock
from derive.proof.balls import Value
from derive.proof.values import Undecided, evaluated

_DISTANCES = tuple(mpf(10) ** -n for n in (4, 8, 12, 16))
_DIGITS = 60
_BASES = 6
"""Number of points from which the limit is approached."""
_DISTANCE = Dummy("t", positive=True)
_AT_END = 1e-12
"""A limit this close to an end of a range lies at this end."""
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

    def judged(self, look: LookAtClock) -> tuple[Verdict, str]:
        """Return the verdict and the reason for it."""
        results = dict[Symbol, tuple[Verdict, str]]()
        for variable, moves in _movers(*self.toward).items():
            result = self._along(variable, moves, look)
            if result is not None:
                results[variable] = result
        if not results:
            why = (
                "too few points were found from which both sides stay real up to the limit: "
                "restrict the variables with `low`, `high` and `require`"
            )
            return Verdict.UNCHECKED, why
        if len({verdict for verdict, _ in results.values()}) == 1:
            return next(iter(results.values()))
        each = "; ".join(f"if {name} moves, {why}" for name, (_, why) in results.items())
        why = f"`as` does not say which variable moves: {each}; name this variable, as in x -> 0"
        return Verdict.UNCHECKED, why

    def is_true(self, look: LookAtClock) -> bool:
        """Whether the claim is true, whichever variable moves."""
        found = [
            self._along(variable, moves, look) for variable, moves in _movers(*self.toward).items()
        ]
        return any(found) and all(one is None or one[0] == Verdict.NUMERICAL for one in found)

    def ratio(self) -> Value:
        """Return the ratio of left to right close to the limit, or zero if there is none."""
        for variable, moves in _movers(*self.toward).items():
            for value in moves:
                for base in points(self.claim, _BASES, "limit"):
                    row = list(self._row(base, variable, value))
                    if len(row) == len(_DISTANCES) and row[-1][2] != 0:
                        return row[-1][1] / row[-1][2]
        return mpf(0)

    def _along(
        self, variable: Symbol, moves: list[Expr], look: LookAtClock
    ) -> tuple[Verdict, str] | None:
        """Return the verdict if one variable moves, or None if there are too few points."""
        why, seen = "", 0
        for value in moves:
            for base in points(self.claim, _BASES, "limit"):
                row = list(self._row(base, variable, value))
                if len(row) < len(_DISTANCES):
                    continue
                look()
                verdict, why = self._of(row)
                if verdict != Verdict.NUMERICAL:
                    return verdict, why
                seen += 1
        return (Verdict.NUMERICAL, f"{why}, from {seen} points") if seen >= _BASES else None

    def _row(
        self, base: Point, variable: Symbol, value: Expr
    ) -> Iterator[tuple[mpf, Value, Value]]:
        """Yield the distance and both sides, step by step, as far as they are real."""
        with mpmath.workdps(_DIGITS):
            for size in _DISTANCES:
                try:
                    where = evaluated(value, {**base, _DISTANCE: size})
                    point = {**base, variable: where}
                    if not self._may_be(variable, where, value, base):
                        return
                    if not is_allowed(self.claim, point):
                        return
                    left, right = (evaluated(side, point) for side in self.sides)
                except Undecided:
                    return
                if mpmath.im(left) != 0 or mpmath.im(right) != 0:
                    return
                yield size, left, right

    def _may_be(self, variable: Symbol, where: Value, value: Expr, base: Point) -> bool:
        """Whether a variable may take a value; a limit at an end of its range has one side."""
        if mpmath.im(where) != 0 or (variable.is_positive and not where > 0):
            return False
        span = self.claim.meant.ranges.get(variable)
        at_limit = value.subs(_DISTANCE, 0)
        if span is None or span.powers or at_limit.has(oo, zoo, nan):
            return True
        end = evaluated(at_limit, base)
        if min(abs(end - span.low), abs(end - span.high)) > _AT_END:
            return True
        return bool(span.low <= where <= span.high)

    def _of(self, row: list[tuple[mpf, Value, Value]]) -> tuple[Verdict, str]:
        with mpmath.workdps(_DIGITS):
            if self.claim.meant.order is not None:
                return self._by_order(row, self.claim.meant.order)
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
            return Verdict.NUMERICAL, "the difference of the two sides is zero"
        order = _order(gaps)
        why = f"the difference is of order {mpmath.nstr(order, 3)} (printed: {wanted:g})"
        return (Verdict.NUMERICAL if order >= wanted - _SHORT else Verdict.FAILS), why


@cache
def _movers(first: Expr, end: Expr) -> dict[Symbol, list[Expr]]:
    """Return the variables that may move, with their values at a distance from the limit.

    A variable that may be negative, such as a position, moves rather than a positive one.  A
    positive variable becomes zero or infinite only if no other one can move: if c = kappa*a,
    c -> a means kappa -> 1 and not a -> 0.
    """
    if end in (oo, -oo):
        targets = [(1 if end == oo else -1) / _DISTANCE]
    else:  # the end may depend on the variable that moves
        first, targets = first - end, [_DISTANCE, -_DISTANCE]
    found = dict[Symbol, list[Expr]]()
    for variable in sorted(first.free_symbols, key=in_order):
        solved = [_solved(first, variable, target) for target in targets]
        if moves := [value for value in solved if value is not None]:
            found[variable] = moves
    if not found:
        raise Undecided(
            f"the expression that tends to {end} could not be solved for one of its variables"
        )
    for is_preferred in (_may_be_negative, _stays_finite):
        preferred = {v: moves for v, moves in found.items() if is_preferred(v, moves)}
        found = preferred or found
    return found


def _solved(first: Expr, variable: Symbol, target: Expr) -> Expr | None:
    """Return the value of a variable for which `first` equals the target."""
    if not first.is_polynomial(variable):
        return None
    free = Dummy(variable.name)
    solutions = solve(first.xreplace({variable: free}) - target, free)
    return solutions[0] if len(solutions) == 1 else None


def _may_be_negative(variable: Symbol, moves: list[Expr]) -> bool:
    return not variable.is_positive


def _stays_finite(variable: Symbol, moves: list[Expr]) -> bool:
    """Whether a variable keeps a value, other than zero for a positive one, at the limit."""
    ends = [value.subs(_DISTANCE, 0) for value in moves]
    return all(not end.has(oo, zoo, nan) and (end != 0 or not variable.is_positive) for end in ends)


def _order(gaps: list[tuple[mpf, mpf]]) -> mpf:
    """Return the power of the distance by which a gap decreases in the last step."""
    (one, first), (other, second) = gaps[-2:]
    if first == 0:
        return mpf("inf") if second == 0 else mpf("-inf")
    return mpmath.log(first / second) / mpmath.log(one / other)
