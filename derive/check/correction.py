"""Search for the simplest change of a false equation that makes it true.

The changes come in batches.  Those that agree at a few points are judged like the printed equation,
the plainest first, until one of them is true.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice, product
from typing import Any

import mpmath
from sympy import Expr, Symbol, Tuple, count_ops, sign

from derive.check.claim import Basis, Claim, Point, Verdict
from derive.check.diagnosis import quotient, simple
from derive.check.draw import has_integral, points, variables
from derive.check.judge import Judged, Sides, judge, no_clock
from derive.check.numbers import near
from derive.check.repair import KINDS, WHOLE, Names, edits, swappable
from derive.check.tending import Approach
from derive.command.limit import LookAtClock
from derive.proof.values import Undecided, evaluated
from derive.reading.relation import Relation
from derive.reading.units import Dimension, Units, parse_unit

_SCREENED = 3
"""Number of points at which a correction is screened before it is judged in full."""
_DRAWN = 16
"""Number of points from which those points are chosen."""
_LARGEST = 2
"""The largest power in a factor that may be lost."""
_FIRSTS = 12
"""The largest number of first changes that are combined with a second one."""


@dataclass(frozen=True)
class Repair:
    """An equation that differs from the printed one by a change.

    change  the kind of the change, and what was changed
    judged  the evidence that it is true, once it has been judged
    on_left whether the left side was changed
    also    other changes that passed the screening, in words
    """

    left: Expr
    right: Expr
    relation: Relation
    kind: str
    change: str
    judged: Judged
    on_left: bool = False
    also: tuple[str, ...] = ()

    @property
    def plainness(self) -> tuple[int, int, bool, str]:
        """A sort key: the plainest equation comes first, and the right side before the left one."""
        length = count_ops(self.left) + count_ops(self.right)
        return length, KINDS.index(self.kind), self.on_left, self.change

    def is_identity(self) -> bool:
        """Whether the sides are the same expression, as p and sqrt(p**2) are for positive p."""
        held = self.left.free_symbols | self.right.free_symbols
        table = {s: Symbol(s.name, positive=True) for s in held if s.is_real is None}
        return bool(self.left.xreplace(table) == self.right.xreplace(table))


_NOT_YET = Judged(Verdict.UNCHECKED, "")


def repaired(claim: Claim, look: LookAtClock = no_clock) -> tuple[Repair | None, int]:
    """Return the simplest change that makes the claim true, and the number of changes tried."""
    tried, screen = 0, _Screen(claim, look)
    for batch in _batches(claim):
        fitting = []
        for each in batch:
            look()
            tried += 1
            if claim.meant.is_inequality or (not each.is_identity() and screen.fits(each)):
                fitting.append(each)
        if claim.meant.toward is not None:
            fitting = [*_outstanding(fitting)]
        for each in sorted(fitting, key=lambda one: one.plainness):
            of_its_relation = claim.changed(relation=each.relation)
            judged = judge(of_its_relation, each.left, each.right, claim.meant.meaning, look)
            # the sign of a square is 1, except at one point
            is_doubtful = Tuple(each.left, each.right).has(sign) and not has_integral(claim)
            if judged.verdict == Verdict.HOLDS or (judged.good and not is_doubtful):
                others = {(one.left, one.right): one.change for one in fitting}
                del others[each.left, each.right]  # changes that lead to the same equation
                return replace(each, judged=judged, also=tuple(others.values())), tried
    return None, tried


def _outstanding(fitting: Sequence[Repair]) -> Sequence[Repair]:
    """Return the changes that lead to the only equation of their kind, if there is one.

    Near a limit, a term that does not matter there may be changed in many ways, or left out.
    """
    side = [each for each in fitting if not each.on_left] or fitting
    kinds = [KINDS.index(each.kind) for each in side]
    if KINDS.index("term") not in kinds:
        side = [each for each in side if KINDS.index(each.kind) == min(kinds)]
    return side if len({(each.left, each.right) for each in side}) == 1 else []


# ------------------------------------------------------------------ candidates


def _batches(claim: Claim) -> Iterator[Iterable[Repair]]:
    """Yield changes of which the simplest true one is chosen, batch by batch.

    An inequality may be an equation, or the opposite inequality.  For an equation, single changes
    come first, and then the factor by which the sides differ.  If none of them is sufficient, pairs
    of changes are tried.  If each trial is slow, changes of a whole side are tried first, and then
    single changes, kind by kind; near a limit, they are compared with each other.
    """
    if claim.meant.is_inequality:
        for relation in (Relation.EQUAL, claim.meant.relation.turned):
            change = f"relation {relation} for {claim.meant.relation}"
            if claim.meant.left != claim.meant.right:
                sides = claim.meant.left, claim.meant.right
                yield [Repair(*sides, relation, "relation", change, _NOT_YET)]
        return
    single = _single(claim)
    near_limit = claim.meant.toward is not None
    if has_integral(claim) or near_limit:
        every = list(single)
        first = [each for each in every if each.change.endswith(WHOLE) or each.kind == "limit"]
        yield [*first, *_names_lost(claim)] if near_limit else first
        in_part = [each for each in every if each not in first]
        if near_limit:
            yield in_part
            return
        yield _scaled(claim)
        for kind in KINDS:
            yield (each for each in in_part if each.kind == kind)
    else:
        yield single
        yield _scaled(claim)
    yield _double(claim)


def _changed(claim: Claim, left: Expr, right: Expr, kind: str, what: str) -> Repair:
    on_left = left != claim.meant.left
    return Repair(left, right, claim.meant.relation, kind, f"{kind} {what}", _NOT_YET, on_left)


def swaps_on_right(claim: Claim) -> tuple[Symbol, ...]:
    """Return the names that may be swapped on the right side, which does not define the left one.

    If a = c, the equations a = a and a = (a + c)/2 are true, but correct nothing.
    """
    keep = claim.meant.right.has(claim.meant.left)
    return tuple(name for name in claim.meant.swaps if keep or name != claim.meant.left)


def _units_of(claim: Claim) -> dict[Symbol, Dimension]:
    return {symbol: parse_unit(unit) for symbol, unit in claim.meant.unit_of.items()}


def _names(claim: Claim, swaps: tuple[Symbol, ...], other: Expr) -> Names:
    """Return the names for changes of one side, of which the other side stays."""
    known = _units_of(claim)
    units = {symbol: unit for symbol, unit in known.items() if symbol != other}
    return swappable(swaps, units, partial(_fit, known, other) if claim.units else None)


def _fit(known: Mapping[Symbol, Dimension], left: Expr, right: Expr) -> bool:
    """Whether the units of an equation fit, as far as they are known."""
    return not Units(known).mismatch(left, right)


def _single(claim: Claim) -> Iterator[Repair]:
    left, right = claim.meant.left, claim.meant.right
    for edit in edits(right, _names(claim, swaps_on_right(claim), left)):
        yield _changed(claim, left, edit.expr, edit.kind, edit.what)
    if not isinstance(left, Symbol):
        for edit in edits(left, _names(claim, claim.meant.swaps, right)):
            yield _changed(claim, edit.expr, right, edit.kind, edit.what)


def _scaled(claim: Claim) -> Iterator[Repair]:
    """Yield the equation with the factor by which its sides differ, if it is simple."""
    if claim.meant.through is not None or not variables(claim):
        return
    ratio = quotient(claim)
    constant = simple(ratio.constant) if ratio is not None else None
    if ratio is None or constant is None:
        return
    if ratio.powers == 1 or (constant == 1 and _may_be_lost(claim, ratio.powers)):
        factor = constant * ratio.powers
        changed = factor * claim.meant.right
        yield _changed(claim, claim.meant.left, changed, "factor", f"{factor} on {WHOLE}")


def _names_lost(claim: Claim) -> Iterator[Repair]:
    """Yield the equation with a variable that stays as another factor, if one may be lost."""
    moves = Tuple(*(claim.meant.toward or ())).free_symbols
    for name, power in product(variables(claim), (1, -1)):
        if name not in moves and _may_be_lost(claim, name**power):
            changed = name**power * claim.meant.right
            what = f"{name**power} on {WHOLE}"
            yield _changed(claim, claim.meant.left, changed, "factor", what)


def _may_be_lost(claim: Claim, powers: Expr) -> bool:
    """Whether a product of powers may be a factor that is lost.

    It is a power of one name, or of a bracket with printed names.  The units must need it, or the
    formulas of the body, because any definition can be made true by a name that it does not have.
    """
    sizes = {abs(power) for power in powers.as_powers_dict().values()}
    is_one = len(powers.free_symbols) == 1 or powers.free_symbols <= claim.meant.right.free_symbols
    is_needed = bool(claim.units) or claim.meant.basis == Basis.BODY
    return is_needed and is_one and len(sizes) == 1 and max(sizes) <= _LARGEST


def _double(claim: Claim) -> Iterator[Repair]:
    """Yield pairs of changes of the right side, of which the first is a sign or a swap."""
    names = _names(claim, swaps_on_right(claim), claim.meant.left)
    firsts = (e for e in edits(claim.meant.right, names, plain=True) if e.kind in ("sign", "swap"))
    for first in islice(firsts, _FIRSTS):
        for second in edits(first.expr, names, plain=True):
            what = f"{first.what} and {second.kind} {second.what}"
            yield _changed(claim, claim.meant.left, second.expr, first.kind, what)


# ------------------------------------------------------------------ screening


class _Screen:
    """Tests candidates at a few points; the values that they share are computed only once."""

    def __init__(self, claim: Claim, look: LookAtClock) -> None:
        self.claim, self.look, self.units = claim, look, _units_of(claim)
        toward = claim.meant.toward
        self.approach = None if toward is None else Approach(claim, toward)
        self.known: dict[tuple[object, ...], Mapping[Symbol, Any]] = {}
        drawn = list(points(claim, _DRAWN, "screen"))
        if not claim.meant.cases and claim.meant.toward is None:  # where both sides are real
            sides = self._sides(claim.meant.left, claim.meant.right).in_variables
            real = list(islice((each for each in drawn if _are_real(sides, each)), _SCREENED))
            drawn = real if len(real) == _SCREENED else drawn[:_SCREENED]
        self.points = drawn

    def _sides(self, left: Expr, right: Expr) -> Sides:
        return Sides(
            self.claim, *self.claim.meant.sides(left, right), self.claim.meant.meaning, self.known
        )

    def fits(self, candidate: Repair) -> bool:
        """Whether a candidate agrees at the points, or near the limit of a claim that has one."""
        sides = self._sides(candidate.left, candidate.right)
        try:
            if self.approach is not None:
                found, _ = self.approach.judged(sides.in_variables, self.look)
                is_true = found == Verdict.NUMERICAL
                return is_true and _fit(self.units, candidate.left, candidate.right)
            return all(
                near(*sides.at_points, sides.numbers(point)) and sides.pair(point).agree
                for point in self.points
            )
        except Undecided:
            return False


def _are_real(sides: Iterable[Expr], point: Point) -> bool:
    try:
        return all(mpmath.im(evaluated(side, point)) == 0 for side in sides)
    except Undecided:
        return False
