"""Claim in, finding out: the verdict, computed, with what it rests on.

The order of the questions: do both sides agree at random points?  If they do, is the difference
zero symbolically?  If they do not, does a map of signs that the source excludes elsewhere mend it,
and which change of the printed equation makes it true?  A repaired equation is judged as the
printed one was: the same points, the same steps.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from dataclasses import dataclass, replace
from itertools import islice
from typing import TypeVar

import mpmath
from mpmath import mpf
from mpmath.libmp import to_rational
from sympy import Expr, Integral, Pow, Rational, Symbol, count_ops, exp, sign
from sympy.functions.elementary.hyperbolic import HyperbolicFunction

from derive.limit import LimitReached, LookAtClock, within
from derive.paper.claim import (
    SCALE,
    Bound,
    Claim,
    Convention,
    Meaning,
    Point,
    Range,
    Relation,
    Rounded,
    Verdict,
)
from derive.paper.diagnosis import diagnosis, quotient
from derive.paper.draw import (
    LEAST,
    further,
    has_integral,
    points,
    spread,
    touching,
    variables,
)
from derive.paper.numbers import DIGITS, Pair, apart, both, near, numbers
from derive.paper.repair import KINDS, Edit, edits, plain_edits
from derive.paper.tending import Approach
from derive.paper.values import Care, Undecided, Undefined
from derive.paper.zero import constant, vanishes, vanishes_at

Result = TypeVar("Result")

_SCREENED = 3
"""Points at which a repair is looked at before it is judged in full."""
_MORE_DRAWN = 4
"""How often points are drawn anew where a side was no real number."""
_OFF = 6
"""Points on either side of a bound."""


@dataclass(frozen=True)
class Judged:
    """What is known of two sides.

    verdict  holds, numerical, fails or unchecked
    why      in words
    pairs    both sides at the points looked at
    one_side_real  points at which one side is real; none if the other one is, too, anywhere
    """

    verdict: Verdict
    why: str
    pairs: tuple[Pair, ...] = ()
    one_side_real: int = 0

    @property
    def good(self) -> bool:
        """Whether the two sides agree."""
        return self.verdict in (Verdict.HOLDS, Verdict.NUMERICAL, Verdict.DEFINITION)


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
    stopped     why the search for them came to no end, if it did not
    diagnosis   by what both sides differ, where no repair was found
    """

    claim: Claim
    verdict: Verdict
    judged: Judged
    convention: Convention | None = None
    under: Judged | None = None
    repair: Repair | None = None
    tried: Counter[str] | None = None
    stopped: str = ""
    diagnosis: str = ""

    @property
    def as_expected(self) -> bool:
        """Whether a person has looked at this verdict before; what is right surprises nobody."""
        wanted = self.claim.expected
        return self.verdict == wanted if wanted else self.judged.good


def check(claim: Claim) -> Finding:
    """The verdict of one claim; what stops its judging makes it unchecked, with the reason."""
    if claim.unchecked:
        return Finding(claim, Verdict.UNCHECKED, Judged(Verdict.UNCHECKED, claim.unchecked))
    if claim.defined:
        why = "the file says what its symbols are in these words: nothing is compared"
        return Finding(claim, Verdict.DEFINITION, Judged(Verdict.DEFINITION, why))
    judged, stopped = _attempted(claim, lambda look: judge_as_printed(claim, look))
    if judged is None:
        return Finding(claim, Verdict.UNCHECKED, Judged(Verdict.UNCHECKED, stopped))
    if judged.verdict != Verdict.FAILS:
        return _nowhere_real(claim, judged) or Finding(claim, judged.verdict, judged)
    finding, stopped = _attempted(claim, lambda look: _mended(claim, judged, look))
    finding = finding or Finding(claim, Verdict.FAILS, judged, stopped=stopped)
    if finding.repair is None and finding.convention is None:
        told, _ = _attempted(claim, lambda look: diagnosis(claim))
        return replace(finding, diagnosis=told or "")
    return finding


def _nowhere_real(claim: Claim, judged: Judged) -> Finding | None:
    """A claim with a side that is real nowhere, and the other everywhere, if a change mends it."""
    if judged.verdict != Verdict.UNCHECKED or not judged.one_side_real:
        return None
    finding, _ = _attempted(claim, lambda look: _mended(claim, judged, look))
    if finding is None or (finding.repair is None and finding.convention is None):
        return None
    why = f"one side is real at all {judged.one_side_real} points drawn, the other at none"
    return replace(finding, judged=Judged(Verdict.FAILS, why))


def _no_clock() -> None:
    """Looks at no clock: there is no limit."""


def _attempted(claim: Claim, work: Callable[[LookAtClock], Result]) -> tuple[Result | None, str]:
    """What comes of work within the claim's time, or why nothing does."""
    try:
        with within(claim.seconds) if claim.seconds is not None else nullcontext(_no_clock) as look:
            return work(look), ""
    except LimitReached:
        return None, f"not done within {claim.seconds:g} s"
    except RecursionError:
        return None, "stopped: an expression is nested too deep"
    except Exception as error:  # SymPy's own, for one claim among many
        return None, f"stopped by {type(error).__name__}: {error}"


def judge_as_printed(claim: Claim, look: LookAtClock = _no_clock) -> Judged:
    """The printed sides under the claim's own meaning; constants to the digits printed."""
    judged = judge(claim, claim.left, claim.right, claim.meaning, look)
    if judged.verdict == Verdict.FAILS and claim.rounded is not None and claim.toward is None:
        return _to_the_digits(claim, claim.rounded) or judged
    return judged


def _mended(claim: Claim, judged: Judged, look: LookAtClock) -> Finding:
    """A claim that fails, with its repair and the map of signs that makes it true."""
    repair, tried = repaired(claim, look)
    for convention in claim.conventions:
        meaning = {**claim.meaning, **convention.meaning}
        under = judge(claim, claim.left, claim.right, meaning, look)
        if under.good:
            verdict = Verdict.CONVENTION
            return Finding(claim, verdict, judged, convention, under, repair, tried)
    return Finding(claim, Verdict.FAILS, judged, None, None, repair, tried)


def judge(
    claim: Claim, left: Expr, right: Expr, meaning: Meaning, look: LookAtClock = _no_clock
) -> Judged:
    """Two sides under a meaning, at all points and, if they agree there, symbolically."""
    left, right = claim.sides(left, right)
    judging = _Judging(claim, left, right, meaning, look)
    try:
        return judging.whole() if claim.toward is None else judging.limit(claim.toward)
    except Undecided as error:
        return Judged(Verdict.UNCHECKED, str(error), tuple(judging.found))


def _to_the_digits(claim: Claim, rounded: Rounded) -> Judged | None:
    """What holds if the constant is one that rounds to the printed one; None if it does not."""
    ratio = quotient(claim)
    if ratio is None or mpmath.im(ratio.constant) != 0 or ratio.powers or ratio.constant <= 0:
        return None
    printed = mpf(rounded.value.p) / rounded.value.q
    true = printed * ratio.constant**rounded.power
    if abs(true - printed) > mpf(rounded.half.p) / rounded.half.q:
        return None
    told = f"{mpmath.nstr(printed, 8)} is {mpmath.nstr(true, 12)} at {ratio.count} points"
    return Judged(Verdict.NUMERICAL, f"true to the digits printed: {told}")


class _Judging:
    """Two sides under one meaning, point by point.

    found     what was found so far
    equal     whether both sides are shown to be equal everywhere; None if nobody has asked
    left_out  points at which no number came out
    unreal    points at which a side is not real, and the sides differ: no counter-example
    one_sided  those of them at which the other side is
    """

    def __init__(
        self, claim: Claim, left: Expr, right: Expr, meaning: Meaning, look: LookAtClock
    ) -> None:
        self.claim, self.left, self.right, self.meaning = claim, left, right, meaning
        self.look = look
        self.found: list[Pair] = []
        self.left_out, self.unreal, self.one_sided = 0, 0, 0
        self.equal: bool | None = None
        self.integrals = has_integral(claim)

    def whole(self) -> Judged:
        """The verdict; raises Undecided."""
        for point in self._first_points():
            try:
                stands = self._stands_at(self._pair(point))
            except Undefined:
                self.left_out += 1
                continue
            if not stands:
                return self._fails()
        if len(self.found) < LEAST and variables(self.claim) and not self.claim.cases:
            judged = self._judged(Verdict.UNCHECKED, self._too_few())
            alone = self.one_sided if not self.found and self.one_sided == self.unreal else 0
            return replace(judged, one_side_real=alone)
        if not self.found:
            return self._judged(Verdict.UNCHECKED, "a side is no real number")
        for point in further(self.claim, self._in_ours()):
            try:
                stands = self._stands_at(self._pair(point))
            except Undecided:
                self.left_out += 1
                continue
            if not stands:
                return self._fails()
        if self.claim.is_inequality and self.claim.relation.is_strict:
            for point, beside in touching(self.claim, self._in_ours()):
                pair, *others = (self._pair(each) for each in (point, *beside))
                if all(_gap(pair) < _gap(other) for other in others):
                    why = f"the sides touch, or nearly so: {_example(pair)}"
                    return self._judged(Verdict.UNCHECKED, why)
        if self.claim.is_inequality and not all(pair.agree for pair in self.found):
            return self._judged(Verdict.NUMERICAL, f"true {self._where()}")
        if self.claim.reached is not None:
            wrong = self._off_the_bound(self.claim.reached)
            if wrong:
                return self._judged(Verdict.FAILS, wrong)
        return self._proven()

    def _too_few(self) -> str:
        """Why no more points could be looked at."""
        told = [f"both sides are real numbers at {len(self.found)} points only"]
        if self.unreal:
            told.append(f"one is not real at {self.unreal}")
        if self.left_out:
            told.append(f"no number comes out at {self.left_out}")
        if self.claim.conditions:
            listed = " and ".join(map(str, self.claim.conditions))
            told.append(f"points were asked for where {listed}")
        return f"{', '.join(told)}: say where the variables are, by low, high and require"

    def _first_points(self) -> Iterator[Point]:
        """Points of a moderate size; more of them where a side was no real number."""
        yield from points(self.claim)
        if (self.unreal or self.left_out) and not self.claim.cases:
            for n in range(_MORE_DRAWN):
                for point in points(self.claim, seed=f"more{n or ''}"):
                    if len(self.found) < LEAST:
                        yield point

    def limit(self, toward: tuple[Expr, Expr]) -> Judged:
        """Whether left over right tends to 1, or their difference is of the order printed."""
        table = dict(self.meaning)
        sides = [side.xreplace(table) for side in (self.left, self.right)]
        approaching = Approach(self.claim, sides, toward)
        verdict, why = approaching.judged(self.look)
        return self._judged(Verdict(verdict), why)

    def _pair(self, point: Point, meaning: Meaning | None = None) -> Pair:
        """Both sides at one point; a printed integral is written in our symbols first."""
        self.look()
        meaning = self.meaning if meaning is None else meaning
        left, right = self.left, self.right
        if left.has(Integral) or right.has(Integral):
            left, right = left.xreplace(dict(meaning)), right.xreplace(dict(meaning))

        def value(care: Care) -> Point:
            return numbers(meaning, point, care)

        pair = apart(left, right, value, point) if not self.found else None
        return pair or both(left, right, value, point, self.integrals)

    def _stands_at(self, pair: Pair) -> bool:
        relation = self.claim.relation
        if self.claim.is_inequality and mpmath.im(pair.left - pair.right) != 0:
            self.unreal += 1
            return True
        if not self.claim.is_inequality:
            if not pair.agree and (mpmath.im(pair.left) != 0 or mpmath.im(pair.right) != 0):
                self.unreal += 1
                self.one_sided += (mpmath.im(pair.left) == 0) != (mpmath.im(pair.right) == 0)
                return True
            self.found.append(pair)
            return pair.agree
        if relation.is_strict and pair.agree and not self._are_equal_at(pair.point):
            raise Undecided("which side is the larger is beyond all digits")
        self.found.append(pair)
        return _is_met(relation, pair)

    def _are_equal_at(self, point: Point) -> bool:
        """Whether both sides are shown to be equal: at one point, or everywhere."""
        left, right = self._in_ours()
        if self.equal is None:
            self.equal = bool(vanishes(left - right, _ranges(self.claim)))
        exact = {symbol: _exactly(value) for symbol, value in point.items()}
        return self.equal or vanishes_at(left - right, exact)

    def _off_the_bound(self, bound: Bound) -> str:
        """Where the printed relation says something else than it should, if anywhere."""
        relation = self.claim.relation
        for entries, met, word in ((bound.allowed, True, "false"), (bound.beyond, False, "true")):
            meaning = {**self.meaning, **entries}
            for point in islice(points(self.claim), _OFF):
                pair = self._pair(point, meaning)
                if _is_met(relation, pair) != met:
                    side = "inside" if met else "beyond"
                    return f"{word} {side} the bound: {_example(pair)}"
        return ""

    def _in_ours(self) -> list[Expr]:
        table = dict(self.meaning)
        return [side.xreplace(table) for side in (self.left, self.right)]

    def _proven(self) -> Judged:
        worst = min(min(pair.digits, pair.known) for pair in self.found)
        agree = f"both sides agree to {min(worst, 2 * DIGITS)} digits {self._where()}"
        if self.claim.reached is not None:
            agree += f"; off the bound the relation is right on both sides at {_OFF} points each"
        left, right = self._in_ours()
        try:
            how = vanishes(left - right, _ranges(self.claim))
            apart_by = None if how else constant(left - right)
        except LimitReached:
            why = f"{agree}; no proof within {self.claim.seconds:g} s"
            return self._judged(Verdict.NUMERICAL, why)
        if how:
            return self._judged(Verdict.HOLDS, f"{how}; {agree}")
        if apart_by is not None:
            return self._judged(Verdict.FAILS, f"left less right is {apart_by}")
        return self._judged(Verdict.NUMERICAL, agree)

    def _where(self) -> str:
        """How many points were looked at, and from where to where they reach."""
        count = len(self.found)
        if not variables(self.claim):
            return "as they stand, without a variable"
        told = spread([pair.point for pair in self.found])
        if self.claim.cases:
            return f"in {count} {'case' if count == 1 else 'cases'}"
        left_out = f"; no number at {self.left_out} more" if self.left_out else ""
        left_out += f"; a side is not real at {self.unreal} more" if self.unreal else ""
        return f"at {count} points" + (f" ({told}{left_out})" if told else "")

    def _fails(self) -> Judged:
        return self._judged(Verdict.FAILS, _example(self.found[-1]))

    def _judged(self, verdict: Verdict, why: str) -> Judged:
        return Judged(verdict, why, tuple(self.found))


def _ranges(claim: Claim) -> dict[Symbol, Range]:
    return {symbol: claim.ranges.get(symbol, SCALE) for symbol in variables(claim)}


def _gap(pair: Pair) -> mpf:
    return abs(pair.left - pair.right)


def _is_met(relation: Relation, pair: Pair) -> bool:
    """Whether a relation is true of two numbers."""
    if pair.agree:
        return not relation.is_strict
    if not relation.is_ordered:
        return False
    difference = pair.left - pair.right
    if mpmath.im(difference) != 0:
        raise Undecided("complex numbers are neither above nor below each other")
    below = relation in (Relation.BELOW, Relation.AT_MOST)
    return bool(mpmath.re(difference) < 0) == below


def _example(pair: Pair) -> str:
    where = ", ".join(f"{symbol} = {mpmath.nstr(v, 6)}" for symbol, v in pair.point.items())
    left, right = mpmath.nstr(pair.left, 12), mpmath.nstr(pair.right, 12)
    told = f"left {left}, right {right}"
    if left == right:
        told += f", left less right {mpmath.nstr(pair.left - pair.right, 3)}"
    return told + (f" at {where}" if where else "")


# ------------------------------------------------------------------ what it should have been


def repaired(claim: Claim, look: LookAtClock = _no_clock) -> tuple[Repair | None, Counter[str]]:
    """The plainest change that makes the claim true, and what was tried.

    One change at a time; where none does, two, a sign or a swap before any other.
    """
    if claim.is_inequality:
        return _other_relation(claim, look)
    tried: Counter[str] = Counter()
    screened = _Screen(claim)
    for candidates in (_single(claim), _double(claim)):
        fitting = []
        for left, right, edit in candidates:
            look()
            tried[edit.kind] += 1
            if left != right and screened.fits(left, right):
                fitting.append((left, right, edit))
        fitting.sort(key=_plainness)
        for left, right, edit in fitting:
            judged = judge(claim, left, right, claim.meaning, look)
            if is_carried(claim, left, right, judged):
                also = tuple(f"{e.kind} {e.what}" for _, _, e in fitting if e != edit)
                relation = claim.relation
                return Repair(left, right, edit.kind, edit.what, judged, relation, also), tried
    return None, tried


def is_carried(claim: Claim, left: Expr, right: Expr, judged: Judged) -> bool:
    """Whether a corrected equation rests on more than digits which it may only seem to share.

    1 + tanh(10**6*(v - 5)) is zero to all digits for v < 4: what fades like that must be proven,
    and so must a printed sign, which is zero at a place that no point may meet.
    """
    if claim.relation.is_ordered or has_integral(claim) or claim.toward:
        return judged.good
    table = dict(claim.meaning)
    sides = [side.xreplace(table) for side in claim.sides(left, right)]
    if any(map(_may_fade, sides)) or left.has(sign) or right.has(sign):
        return judged.verdict == Verdict.HOLDS
    return judged.good


def _may_fade(expr: Expr) -> bool:
    """Whether a part may be below all digits and yet not zero."""
    powers = (power.exp for power in expr.atoms(Pow))
    return expr.has(exp, HyperbolicFunction) or any(
        not each.is_number or abs(each) > _STEEP for each in powers
    )


_STEEP = 16
"""Exponents from which on a power may be too small to count."""


def _other_relation(claim: Claim, look: LookAtClock) -> tuple[Repair | None, Counter[str]]:
    """Whether the sides of an inequality are equal, or the other way round."""
    tried: Counter[str] = Counter()
    relations = (Relation.EQUAL, claim.relation.turned)
    for relation in relations if claim.left != claim.right else ():
        tried["relation"] += 1
        other = replace(claim, relation=relation)
        judged = judge(other, claim.left, claim.right, claim.meaning, look)
        if is_carried(other, claim.left, claim.right, judged):
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
        self.known: dict[tuple[int, int, Care], Point] = {}
        self.integrals = has_integral(claim)

    def fits(self, left: Expr, right: Expr) -> bool:
        """Whether a candidate agrees at the screen's points; near its limit, if it has one."""
        if self.claim.toward is not None:
            return judge(self.claim, left, right, self.claim.meaning).good
        left, right = self.claim.sides(left, right)
        if left.has(Integral) or right.has(Integral):
            table = dict(self.claim.meaning)
            left, right = left.xreplace(table), right.xreplace(table)
        try:
            return all(self._agrees(left, right, n) for n in range(len(self.points)))
        except Undecided:
            return False

    def _agrees(self, left: Expr, right: Expr, n: int) -> bool:
        def value(care: Care) -> Point:
            return self._numbers(n, care)

        if not near(left, right, value):
            return False
        return both(left, right, value, self.points[n], self.integrals).agree

    def _numbers(self, n: int, care: Care) -> Point:
        key = (n, mpmath.mp.dps, care)
        if key not in self.known:
            self.known[key] = numbers(self.claim.meaning, self.points[n], care)
        return self.known[key]


def check_all(claims: tuple[Claim, ...]) -> list[Finding]:
    """The verdict of every claim, in their order."""
    return [check(claim) for claim in claims]


def _exactly(value: mpf) -> Rational:
    """A number as the fraction that it is in binary, in SymPy's own integers."""
    above, below = to_rational(value._mpf_)
    return Rational(int(above), int(below))
