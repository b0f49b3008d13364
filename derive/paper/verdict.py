"""Claim in, finding out: the verdict, computed, with what it rests on.

The order of the questions: do both sides agree at random points?  If they do, is the difference
zero symbolically?  If they do not, does a map of signs that the source excludes elsewhere mend it,
and which change of the printed equation makes it true?  A repaired equation is judged as the
printed one was: the same points, the same steps.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

import mpmath
from sympy import Expr, Integral, Symbol, count_ops

from derive.paper.claim import SCALE, Claim, Convention, Meaning, Point, Relation, Verdict
from derive.paper.numbers import (
    DIGITS,
    LEAST,
    Pair,
    Undecided,
    apart,
    both,
    near,
    numbers,
    points,
    variables,
)
from derive.paper.repair import KINDS, Edit, edits, plain_edits
from derive.paper.zero import vanishes

_SCREENED = 3
"""Points at which a repair is looked at before it is judged in full."""


@dataclass(frozen=True)
class Judged:
    """What is known of two sides.

    verdict  holds, numerical, fails or unchecked
    why      in words
    pairs    both sides at the points looked at
    """

    verdict: Verdict
    why: str
    pairs: tuple[Pair, ...] = ()

    @property
    def good(self) -> bool:
        """Whether the two sides agree."""
        return self.verdict in (Verdict.HOLDS, Verdict.NUMERICAL)


@dataclass(frozen=True)
class Repair:
    """An equation that is true in the printed one's place.

    also: other changes that make it true, in words.
    """

    left: Expr
    right: Expr
    kind: str
    what: str
    judged: Judged
    relation: Relation = Relation.EQUAL
    also: tuple[str, ...] = ()


@dataclass(frozen=True)
class Finding:
    """A claim with its verdict.

    judged      the printed equation as it stands
    convention  the map of signs under which it holds, if there is one
    under       the same equation judged under that map
    repair      the corrected equation, if one was found
    tried       how many repairs of each kind were looked at
    """

    claim: Claim
    verdict: Verdict
    judged: Judged
    convention: Convention | None = None
    under: Judged | None = None
    repair: Repair | None = None
    tried: Counter[str] | None = None

    @property
    def as_expected(self) -> bool:
        """Whether a person has looked at this verdict before; what is right surprises nobody."""
        wanted = self.claim.expected
        return self.verdict == wanted if wanted else self.judged.good


def check(claim: Claim) -> Finding:
    """The verdict of one claim."""
    if claim.unchecked:
        return Finding(claim, Verdict.UNCHECKED, Judged(Verdict.UNCHECKED, claim.unchecked))
    judged = judge(claim, claim.left, claim.right, claim.meaning)
    if judged.verdict != Verdict.FAILS:
        return Finding(claim, judged.verdict, judged)
    repair, tried = repaired(claim)
    for convention in claim.conventions:
        under = judge(claim, claim.left, claim.right, {**claim.meaning, **convention.meaning})
        if under.good:
            verdict = Verdict.CONVENTION
            return Finding(claim, verdict, judged, convention, under, repair, tried)
    return Finding(claim, Verdict.FAILS, judged, None, None, repair, tried)


def judge(claim: Claim, left: Expr, right: Expr, meaning: Meaning) -> Judged:
    """Two sides under a meaning, at all points and, if they agree there, symbolically."""
    left, right = claim.sides(left, right)
    found: list[Pair] = []
    try:
        for point in points(claim):
            pair = _at(claim, left, right, meaning, point, first=not found)
            found.append(pair)
            if not _stands(claim, pair):
                return Judged(Verdict.FAILS, _example(claim, pair), tuple(found))
    except Undecided as error:
        return Judged(Verdict.UNCHECKED, str(error), tuple(found))
    if len(found) < LEAST:
        return Judged(Verdict.UNCHECKED, f"only {len(found)} points were drawn", tuple(found))
    if claim.is_inequality and not all(pair.agree for pair in found):
        return Judged(Verdict.NUMERICAL, f"true at {len(found)} points", tuple(found))
    return _proven(claim, left, right, meaning, tuple(found))


def _proven(
    claim: Claim, left: Expr, right: Expr, meaning: Meaning, found: tuple[Pair, ...]
) -> Judged:
    worst = min(pair.digits for pair in found)
    agree = f"both sides agree to {min(worst, 2 * DIGITS)} digits at {len(found)} points"
    how = "" if claim.samples else _vanishing(claim, (left - right).xreplace(dict(meaning)))
    if how:
        return Judged(Verdict.HOLDS, f"{how}; {agree}", found)
    return Judged(Verdict.NUMERICAL, agree, found)


def _vanishing(claim: Claim, difference: Expr) -> str:
    places = {symbol: claim.ranges.get(symbol, SCALE).place for symbol in variables(claim)}
    return vanishes(difference, places)


def _at(claim: Claim, left: Expr, right: Expr, meaning: Meaning, point: Point, first: bool) -> Pair:
    """Both sides at one point; a printed integral is written in our symbols first."""
    if left.has(Integral) or right.has(Integral):
        left, right = left.xreplace(dict(meaning)), right.xreplace(dict(meaning))

    def value() -> Point:
        return numbers(claim, meaning, point)

    return (first and apart(left, right, value, point)) or both(left, right, value, point)


def _stands(claim: Claim, pair: Pair) -> bool:
    if not claim.is_inequality:
        return pair.agree
    if pair.agree:
        return not claim.relation.is_strict
    difference = pair.left - pair.right
    if mpmath.im(difference) != 0:
        raise Undecided("complex numbers are neither above nor below each other")
    below = claim.relation in (Relation.BELOW, Relation.AT_MOST)
    return bool(mpmath.re(difference) < 0) == below


def _example(claim: Claim, pair: Pair) -> str:
    where = ", ".join(f"{symbol} = {mpmath.nstr(v, 6)}" for symbol, v in pair.point.items())
    left, right = mpmath.nstr(pair.left, 12), mpmath.nstr(pair.right, 12)
    return f"left {left}, right {right}" + (f" at {where}" if where else "")


# ------------------------------------------------------------------ what it should have been


def repaired(claim: Claim) -> tuple[Repair | None, Counter[str]]:
    """The plainest change that makes the claim true, and what was tried.

    One change at a time; where none does, two, a sign or a swap before any other.
    """
    if claim.is_inequality:
        return _other_relation(claim)
    tried: Counter[str] = Counter()
    screened = _Screen(claim)
    for candidates in (_single(claim), _double(claim)):
        fitting = []
        for left, right, edit in candidates:
            tried[edit.kind] += 1
            if screened.fits(left, right):
                fitting.append((left, right, edit))
        fitting.sort(key=_plainness)
        for left, right, edit in fitting:
            judged = judge(claim, left, right, claim.meaning)
            if judged.good:
                also = tuple(f"{e.kind} {e.what}" for _, _, e in fitting if e != edit)
                relation = claim.relation
                return Repair(left, right, edit.kind, edit.what, judged, relation, also), tried
    return None, tried


def _other_relation(claim: Claim) -> tuple[Repair | None, Counter[str]]:
    """Whether the sides of an inequality are equal, or the other way round."""
    tried: Counter[str] = Counter()
    for relation in (Relation.EQUAL, claim.relation.turned):
        tried["relation"] += 1
        judged = judge(replace(claim, relation=relation), claim.left, claim.right, claim.meaning)
        if judged.good:
            what = f"{relation} for {claim.relation}"
            return Repair(claim.left, claim.right, "relation", what, judged, relation), tried
    return None, tried


Candidate = tuple[Expr, Expr, Edit]


def _plainness(candidate: Candidate) -> tuple[int, int, str]:
    left, right, edit = candidate
    kind = edit.kind.split(" and ")[0]
    return int(count_ops(left) + count_ops(right)), KINDS.index(kind), edit.what


def _single(claim: Claim) -> Iterator[Candidate]:
    for edit in edits(claim.right, claim.swaps):
        yield claim.left, edit.expr, edit
    if not isinstance(claim.left, Symbol):
        for edit in edits(claim.left, claim.swaps):
            yield edit.expr, claim.right, edit


def _double(claim: Claim) -> Iterator[Candidate]:
    """Two changes, one of them a sign or a swap of the whole equation's symbols."""
    firsts = [e for e in plain_edits(claim.right, claim.swaps) if e.kind in ("sign", "swap")]
    for first in firsts[:_FIRSTS]:
        for second in plain_edits(first.expr, claim.swaps):
            what = f"{first.what}; {second.what}"
            edit = Edit(f"{first.kind} and {second.kind}", what, second.expr)
            yield claim.left, second.expr, edit


_FIRSTS = 12
"""First changes from which a second is tried."""


class _Screen:
    """Candidates at a few points, where all that they share is computed once."""

    def __init__(self, claim: Claim) -> None:
        self.claim = claim
        self.points = list(points(claim, _SCREENED, "screen"))
        self.known: dict[tuple[int, int], Point] = {}

    def fits(self, left: Expr, right: Expr) -> bool:
        """Whether a candidate agrees at the screen's points."""
        left, right = self.claim.sides(left, right)
        if left.has(Integral) or right.has(Integral):
            table = dict(self.claim.meaning)
            left, right = left.xreplace(table), right.xreplace(table)
        try:
            return all(self._agrees(left, right, n) for n in range(len(self.points)))
        except Undecided:
            return False

    def _agrees(self, left: Expr, right: Expr, n: int) -> bool:
        if not near(left, right, lambda: self._numbers(n)):
            return False
        return both(left, right, lambda: self._numbers(n), self.points[n]).agree

    def _numbers(self, n: int) -> Point:
        key = (n, mpmath.mp.dps)
        if key not in self.known:
            self.known[key] = numbers(self.claim, self.claim.meaning, self.points[n])
        return self.known[key]


def check_all(claims: tuple[Claim, ...]) -> list[Finding]:
    """The verdict of every claim, in their order."""
    return [check(claim) for claim in claims]
