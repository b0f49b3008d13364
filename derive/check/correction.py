"""Search for the simplest change of a false equation that makes it true.

The changes come in batches.  All changes of a batch are judged like the printed equation; the
plainest of those that are true is the correction.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice

from sympy import Expr, Symbol, Tuple, count_ops, sign

from derive.check.claim import Basis, Claim, Verdict
from derive.check.diagnosis import quotient, simple
from derive.check.draw import has_integral, points, variables
from derive.check.judge import Judged, judge, no_clock
from derive.check.repair import KINDS, WHOLE, Names, edits
from derive.check.sides import Sides
from derive.check.tending import Approach
from derive.command.limit import LookAtClock
from derive.proof.values import Undecided
from derive.reading.relation import Relation
from derive.reading.units import Dimension, Units, parse_unit

_DRAWN = 6
"""Number of points among which this point is sought."""
_LARGEST = 2
"""The largest power in a factor that may be lost."""

_NOT_YET = Judged(Verdict.UNCHECKED, "")


@dataclass(frozen=True)
class Repair:
    """An equation that differs from the printed one by a change.

    change  the kind of the change, and what was changed
    judged  the evidence that it is true, once it has been judged
    on_left whether the left side was changed
    also    other changes that may make it true, because they are not shown to be false, in words
    """

    left: Expr
    right: Expr
    relation: Relation
    kind: str
    change: str
    judged: Judged = _NOT_YET
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


def repaired(claim: Claim, look: LookAtClock = no_clock) -> tuple[Repair | None, int]:
    """Return the simplest change that makes the claim true, and the number of changes tried."""
    tried, printed = 0, Sides.printed(claim)
    judged = _judged(printed, look)
    for batch in _batches(printed):
        fitting = []
        for each in batch:
            tried += 1
            if found := judged(each):
                fitting.append(replace(each, judged=found))
        if claim.meant.toward is not None:
            fitting = [*_outstanding(fitting)]
        if true := [each for each in fitting if each.judged.good]:
            best = min(true, key=lambda one: one.plainness)
            also = {(one.left, one.right): one.change for one in fitting}
            del also[best.left, best.right]  # changes that lead to the same equation
            return replace(best, also=tuple(also.values())), tried
    return None, tried


def _judged(printed: Sides, look: LookAtClock) -> Callable[[Repair], Judged | None]:
    """Return what judges a change like the printed equation; it gives None if it may not be true.

    A change is first tried by a few digits at one point, where the printed sides are real.
    """
    claim, known = printed.claim, _units_of(printed.claim)
    is_limit, is_equation = claim.meant.toward is not None, not claim.meant.is_inequality
    approach = Approach(claim) if is_limit else None
    drawn = list(islice(points(claim), _DRAWN if is_equation and not is_limit else 0))
    first = [pair.point for pair in islice(printed.pairs(drawn), 1)] or drawn[:1]

    def judged(each: Repair) -> Judged | None:
        look()
        sides = printed.put(each.left, each.right)
        try:
            if not all(map(sides.may_agree, first)):
                return None
        except Undecided:
            return None
        of_its_relation = replace(sides, claim=claim.changed(relation=each.relation))
        found = judge(of_its_relation, look, approach)
        is_idle = is_equation and each.is_identity()
        is_misfit = is_limit and not _fit(known, each.left, each.right)
        if found.verdict == Verdict.FAILS or is_idle or is_misfit or (is_limit and not found.good):
            return None
        # the sign of a square is 1, except at one point
        is_doubtful = Tuple(each.left, each.right).has(sign) and not has_integral(claim)
        is_shown = found.verdict == Verdict.HOLDS or not is_doubtful
        return found if is_shown else replace(found, verdict=Verdict.UNCHECKED)

    return judged


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


def _batches(printed: Sides) -> Iterator[Iterable[Repair]]:
    """Yield changes of which the simplest true one is chosen, batch by batch.

    An inequality may be an equation, or the opposite inequality.  For an equation, single changes
    come first, and then the factor by which the sides differ.  If each trial is slow, changes of a
    whole side are tried first, and then the others, kind by kind; near a limit, they are compared
    with each other.
    """
    claim = printed.claim
    left, relation, right = claim.meant.left, claim.meant.relation, claim.meant.right
    if claim.meant.is_inequality:
        for other in (Relation.EQUAL, relation.turned) if left != right else ():
            yield [Repair(left, right, other, "relation", f"relation {other} for {relation}")]
        return
    every = list(_single(claim))
    factors = (
        Repair(left, factor * right, relation, "factor", f"factor {factor} on {WHOLE}")
        for factor in _factors(printed)
    )
    if claim.meant.toward is None and not has_integral(claim):
        yield from (every, factors)
        return
    whole = [each for each in every if each.change.endswith(WHOLE) or each.kind == "limit"]
    in_part = [each for each in every if each not in whole]
    if claim.meant.toward is not None:
        yield from ([*whole, *factors], in_part)
    else:
        yield from (whole, factors)
        yield from ((each for each in in_part if each.kind == kind) for kind in KINDS)


def _single(claim: Claim) -> Iterator[Repair]:
    """Yield the changes of the right side, and of the left one if it is not only a symbol."""
    meant, known = claim.meant, _units_of(claim)
    for side, other in ((meant.right, meant.left), (meant.left, meant.right)):
        on_left = side is meant.left
        if on_left and isinstance(side, Symbol):
            return
        swaps = meant.swaps if on_left else swaps_on_right(claim)
        units = {symbol: unit for symbol, unit in known.items() if symbol != other}
        fits = partial(_fit, known, other) if claim.units else None
        for edit in edits(side, Names(swaps, units, fits)):
            sides = (edit.expr, other) if on_left else (other, edit.expr)
            change = f"{edit.kind} {edit.what}"
            yield Repair(*sides, meant.relation, edit.kind, change, on_left=on_left)


def swaps_on_right(claim: Claim) -> tuple[Symbol, ...]:
    """Return the names that may be swapped on the right side, which does not define the left one.

    If a = c, the equations a = a and a = (a + c)/2 are true, but correct nothing.
    """
    keep = claim.meant.right.has(claim.meant.left)
    return tuple(name for name in claim.meant.swaps if keep or name != claim.meant.left)


def _units_of(claim: Claim) -> dict[Symbol, Dimension]:
    return {symbol: parse_unit(unit) for symbol, unit in claim.meant.unit_of.items()}


def _fit(known: Mapping[Symbol, Dimension], left: Expr, right: Expr) -> bool:
    """Whether the units of an equation fit, as far as they are known."""
    return not Units(known).mismatch(left, right)


def _factors(printed: Sides) -> Iterator[Expr]:
    """Yield the ratio of the sides, if it is simple, or near a limit each variable that stays."""
    claim = printed.claim
    if claim.meant.toward is not None:
        moves = Tuple(*claim.meant.toward).free_symbols
        powers = (n**p for n in variables(claim) if n not in moves for p in (1, -1))
        yield from (power for power in powers if _may_be_lost(claim, power))
    elif claim.meant.through is None and variables(claim):
        ratio = quotient(printed)
        constant = simple(ratio.constant) if ratio is not None else None
        if ratio is None or constant is None:
            return
        if ratio.powers == 1 or (constant == 1 and _may_be_lost(claim, ratio.powers)):
            yield constant * ratio.powers


def _may_be_lost(claim: Claim, powers: Expr) -> bool:
    """Whether a product of powers may be a factor that is lost.

    It is a power of one name, or of a bracket with printed names.  The units must need it, or the
    formulas of the body, because any definition can be made true by a name that it does not have.
    """
    sizes = {abs(power) for power in powers.as_powers_dict().values()}
    is_one = len(powers.free_symbols) == 1 or powers.free_symbols <= claim.meant.right.free_symbols
    is_needed = bool(claim.units) or claim.meant.basis == Basis.BODY
    return is_needed and is_one and len(sizes) == 1 and max(sizes) <= _LARGEST
