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
from itertools import product
from typing import TypeAlias

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

Row: TypeAlias = list[tuple[Value, Value]]
"""Both sides at all distances from a limit."""


@dataclass(frozen=True)
class Approach:
    """Both sides in terms of the variables, and the expression with the end that it tends to."""

    claim: Claim
    sides: tuple[Expr, Expr]
    toward: tuple[Expr, Expr]

    def judged(self, look: LookAtClock) -> tuple[Verdict, str]:
        """Return the verdict and the reason for it."""
        movers = _movers(*self.toward).items()
        tried = {variable: self._along(variable, moves, look) for variable, moves in movers}
        results = {variable: result for variable, result in tried.items() if result is not None}
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

    def _along(
        self, variable: Symbol, moves: list[Expr], look: LookAtClock
    ) -> tuple[Verdict, str] | None:
        """Return the verdict if one variable moves, or None if there are too few points."""
        why, seen = "", 0
        for row in self._rows(variable, moves):
            look()
            verdict, why = self._of(row)
            if verdict != Verdict.NUMERICAL:
                return verdict, why
            seen += 1
        return (Verdict.NUMERICAL, f"{why}, from {seen} points") if seen >= _BASES else None

    def _rows(self, variable: Symbol, moves: list[Expr]) -> Iterator[Row]:
        """Yield both sides on the way to the limit, for all points from which they stay real."""
        for value, base in product(moves, points(self.claim, _BASES, "limit")):
            with mpmath.workdps(_DIGITS):
                try:
                    row = [self._at(variable, value, base, size) for size in _DISTANCES]
                except Undecided:
                    continue
            yield row

    def _at(self, variable: Symbol, value: Expr, base: Point, size: mpf) -> tuple[Value, Value]:
        """Return both sides at a distance; raises Undecided if they are not real there."""
        where = evaluated(value, {**base, _DISTANCE: size})
        point = {**base, variable: where}
        if mpmath.im(where) != 0 or (variable.is_positive and not where > 0):
            raise Undecided(f"{variable} is not in its range")
        span, end = self.claim.meant.ranges.get(variable), value.subs(_DISTANCE, 0)
        if span is not None and not (span.powers or end.has(oo, zoo, nan)):
            # a limit at an end of a range has one side
            ends = [abs(evaluated(end, base) - each) for each in (span.low, span.high)]
            if min(ends) <= _AT_END and not span.low <= where <= span.high:
                raise Undecided(f"{variable} is not in its range")
        left, right = (evaluated(side, point) for side in self.sides)
        if mpmath.im(left) != 0 or mpmath.im(right) != 0 or not is_allowed(self.claim, point):
            raise Undecided("a side is not real")
        return left, right

    def _of(self, row: Row) -> tuple[Verdict, str]:
        """Return the verdict for one point from which the limit is approached."""
        with mpmath.workdps(_DIGITS):
            if self.claim.meant.order is not None:
                return _by_order([left - right for left, right in row], self.claim.meant.order)
            if any(right == 0 for _, right in row):
                return Verdict.UNCHECKED, "the right side vanishes on the way to the limit"
            return _by_ratio([left / right for left, right in row])


def _by_order(gaps: list[Value], wanted: float) -> tuple[Verdict, str]:
    if gaps[-1] == 0:
        return Verdict.NUMERICAL, "the difference of the two sides is zero"
    order = _order(gaps)
    why = f"the difference is of order {mpmath.nstr(order, 3)} (printed: {wanted:g})"
    return (Verdict.NUMERICAL if order >= wanted - _SHORT else Verdict.FAILS), why


def _by_ratio(ratios: list[Value]) -> tuple[Verdict, str]:
    if ratios[-1] == 1:
        return Verdict.NUMERICAL, "the ratio left/right is 1"
    order, own = _order([ratio - 1 for ratio in ratios]), _order(ratios)
    if order > _SLOWEST:
        power = mpmath.nstr(order, 3)
        why = f"the ratio left/right tends to 1 with the power {power} of the distance"
        return Verdict.NUMERICAL, why
    if abs(own) > _SLOWEST:
        limit = "0" if own > 0 else "infinity"
    elif abs(ratios[-1] - ratios[-2]) <= _STAYS * abs(ratios[-1]):
        limit = mpmath.nstr(ratios[-1], 8)
    else:
        why = "the ratio left/right converges too slowly for its limit to be identified"
        return Verdict.UNCHECKED, why
    return Verdict.FAILS, f"the ratio left/right tends to {limit} and not to 1"


def _order(gaps: list[Value]) -> mpf:
    """Return the power of the distance by which a quantity decreases in the last step."""
    first, second = map(abs, gaps[-2:])
    if first == 0:
        return mpf("inf") if second == 0 else mpf("-inf")
    if second == 0:
        return mpf("inf")
    return mpmath.log(first / second) / mpmath.log(_DISTANCES[-2] / _DISTANCES[-1])


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
    solved = {
        variable: [value for target in targets for value in _solved(first, variable, target)]
        for variable in sorted(first.free_symbols, key=in_order)
    }
    found = {variable: moves for variable, moves in solved.items() if moves}
    if not found:
        raise Undecided(
            f"the expression that tends to {end} could not be solved for one of its variables"
        )
    signed = {v: moves for v, moves in found.items() if not v.is_positive}
    staying = {v: moves for v, moves in (signed or found).items() if _stays_finite(v, moves)}
    return staying or signed or found


def _solved(first: Expr, variable: Symbol, target: Expr) -> list[Expr]:
    """Return the value of a variable for which `first` equals the target, if there is one."""
    if not first.is_polynomial(variable):
        return []
    free = Dummy(variable.name)
    solutions = solve(first.xreplace({variable: free}) - target, free)
    return solutions if len(solutions) == 1 else []


def _stays_finite(variable: Symbol, moves: list[Expr]) -> bool:
    """Whether a variable keeps a value, other than zero for a positive one, at the limit."""
    ends = [value.subs(_DISTANCE, 0) for value in moves]
    return all(not end.has(oo, zoo, nan) and (end != 0 or not variable.is_positive) for end in ends)
