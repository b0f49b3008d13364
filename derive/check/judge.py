"""Compare two sides with given meanings: at points, near a limit or a bound, and by exact steps."""

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice

import mpmath
from mpmath import mpf
from mpmath.libmp import to_rational
from sympy import Integral, Rational

from derive.check.claim import Claim, Point, Range, Rounded, Verdict
from derive.check.diagnosis import quotient, telling
from derive.check.draw import LEAST, further, points, ranges_of, spread, unseen, variables
from derive.check.intervals import Decision, decide, ends, gap_of
from derive.check.sides import Pair, Sides
from derive.check.tending import Approach
from derive.check.zero import constant, vanishes, vanishes_at
from derive.command.limit import LimitReached, LookAtClock
from derive.proof.values import Undecided, Undefined
from derive.proof.verdict import DIGITS
from derive.reading.relation import Relation

_MORE_DRAWN = 4
"""Number of times that more points are drawn if a side was not a real number."""
_OFF = 6
"""Number of points on either side of a bound."""
_TOUCHING = 1e-10
"""Two sides touch if their gap is at most this fraction of the gaps at all other points."""
_FEW = 2
"""An inequality of so many variables is true only if intervals show it."""
_EXACT = 300
"""Digits of a point at which an inequality is false, which are more than any working digits."""


@dataclass(frozen=True)
class Judged:
    """The result of comparing two sides.

    verdict        holds, numerical, by definition, fails or unchecked
    why            the reason in words
    pairs          both sides at the points that were examined
    one_side_real  the number of points if exactly one side was real at each of them, else 0
    """

    verdict: Verdict
    why: str
    pairs: tuple[Pair, ...] = ()
    one_side_real: int = 0

    @property
    def good(self) -> bool:
        """Whether the two sides agree."""
        return self.verdict in (Verdict.HOLDS, Verdict.NUMERICAL, Verdict.DEFINITION)


def no_clock() -> None:
    """Do nothing, because there is no time limit."""


def judge_as_printed(claim: Claim, look: LookAtClock = no_clock) -> Judged:
    """Judge the printed sides with the claim's own meanings; printed constants may be rounded."""
    sides, rounded = Sides.printed(claim), claim.meant.rounded
    judged = judge(sides, look)
    if judged.verdict == Verdict.FAILS and rounded is not None and claim.meant.toward is None:
        return _to_the_digits(sides, rounded) or judged
    return judged


def judge(sides: Sides, look: LookAtClock = no_clock, approach: Approach | None = None) -> Judged:
    """Judge two sides at all points and, if they agree, symbolically.

    approach: how a claim about a limit approaches it, if this is known
    """
    judging = Judging(sides, look, approach)
    try:
        return judging.limit() or judging.whole()
    except Undecided as error:
        return Judged(Verdict.UNCHECKED, str(error), tuple(judging.found))


def _to_the_digits(sides: Sides, rounded: Rounded) -> Judged | None:
    """Return a result if the exact constant rounds to the printed one, or else None."""
    cases = sides.claim.meant.cases  # of which each may have another constant
    if cases:
        judging = Judging(sides, no_clock)
        judging.found += sides.pairs(points(sides.claim))
        ratios = [pair.ratio for pair in judging.found if pair.right != 0]
        where = judging.where()
    else:
        ratio = quotient(sides)
        ratios = [ratio.constant] if ratio is not None and ratio.powers == 1 else []
        where = f"at {_points(ratio.count)}" if ratio else ""
    printed, half = (mpf(each.p) / each.q for each in (rounded.value, rounded.half))
    true = [printed * each**rounded.power for each in ratios if each != 0]
    if len(true) < max(1, len(cases)) or any(abs(each - printed) > half for each in true):
        return None
    rounding = f"{mpmath.nstr(printed, 8)} stands for {mpmath.nstr(true[0], 12)}"
    return Judged(Verdict.NUMERICAL, f"true with rounding {where}: {rounding}")


class Judging:
    """Compares two sides.

    found      the values of both sides so far
    left_out   number of points without a value
    unreal     both sides where they differ and one is not real; this is no counter-example
    """

    def __init__(self, sides: Sides, look: LookAtClock, approach: Approach | None = None) -> None:
        self.sides, self.claim, self.look, self.approach = sides, sides.claim, look, approach
        self.found, self.unreal, self.left_out = list[Pair](), list[Pair](), 0

    def limit(self) -> Judged | None:
        """Judge whether the ratio tends to 1, or whether the difference has the printed order."""
        if self.claim.meant.toward is None:
            return None
        approach = self.approach or Approach(self.claim)
        return self._judged(*approach.judged(self.sides, self.look))

    def whole(self) -> Judged:
        """Return the verdict by the first of these questions that decides; raises Undecided."""
        return (
            self._false_at(self._first_points(), Undefined)
            or self._at_too_few_points()
            or self._false_at(further(self.claim, self.sides.in_variables), Undecided)
            or self._by_intervals()
            or self._not_shown_at_points()
            or self._wrong_off_the_bound()
            or self._by_exact_steps()
        )

    # -------------------------------------------------------------- at points

    def _first_points(self) -> Iterator[Point]:
        """Yield points of moderate size, and more of them if both sides were real at some only."""
        yield from points(self.claim)
        if self.found and (self.unreal or self.left_out) and not self.claim.meant.cases:
            for n in range(_MORE_DRAWN):
                for point in points(self.claim, seed=f"more{n or ''}"):
                    if len(self.found) < LEAST:
                        yield point

    def _false_at(self, where: Iterable[Point], excused: type[Undecided]) -> Judged | None:
        """Compare both sides at points; those without a value are left out if it is excused."""
        for point in where:
            try:
                if self._is_true_at(point) is False:
                    return self._judged(Verdict.FAILS, _example(self.found[-1]))
            except excused:
                self.left_out += 1
        return None

    def is_true(self, point: Point) -> bool | None:
        """Whether the claim is true at a point; None if this is not known."""
        try:
            return self._is_true_at(point)
        except Undecided:
            return None

    def _is_true_at(self, point: Point) -> bool | None:
        """Whether the claim is true at a point; None if a side is not real there."""
        self.look()
        pair, meant = self.sides.pair(point), self.claim.meant
        if not all(pair.are_real) and not pair.agree:
            self.unreal.append(pair)
            return None
        if meant.is_inequality and meant.relation.is_strict and pair.agree:
            exact = {symbol: _exactly(value) for symbol, value in point.items()}
            if not self._proof and not vanishes_at(self.sides.difference, exact):
                raise Undecided("the available digits do not show which side is larger")
        self.found.append(pair)
        return _is_met(meant.relation, pair) if meant.is_inequality else pair.agree

    def _at_too_few_points(self) -> Judged | None:
        claim, few = self.claim, len(self.found)
        if few >= (LEAST if variables(claim) else 1):
            return None
        is_single = bool(claim.meant.cases) or not variables(claim)
        if not few:
            sides = zip(("left", "right"), self.sides.in_variables, strict=True)
            infinite = [name for name, side in sides if side.is_infinite]
            if infinite or is_single:
                why = f"the {infinite[0]} side is infinite" if infinite else ""
                return self._unchecked(why or "a side is not a real number")
        if is_single:
            is_number = any(side.is_Rational and side != 0 for side in self.sides.in_variables)
            if is_number or self._proof:
                return None
            remedy = f"leave out `cases`, give {LEAST} of them, or write one side as a number"
            return self._unchecked(f"true {self.where()}, which shows no general formula", remedy)
        told = [f"both sides are real numbers at only {_points(few)}"]
        if self.unreal:
            told.append(f"one side is not real at {_points(len(self.unreal))}{self._not_real()}")
        if self.left_out:
            told.append(f"there is no value at {_points(self.left_out)}")
        if claim.meant.conditions:
            told.append(f"the points must satisfy {' and '.join(map(str, claim.meant.conditions))}")
        remedy = "restrict the variables with `low`, `high` and `require`"
        is_alone = not few and all(any(pair.are_real) for pair in self.unreal)
        alone = len(self.unreal) if is_alone else 0
        return replace(self._unchecked(", ".join(told), remedy), one_side_real=alone)

    # -------------------------------------------------------------- inequalities and bounds

    def _not_shown_at_points(self) -> Judged | None:
        """Judge nothing if the points do not show all of the sides, unless a proof exists."""
        why = unseen(self.claim, self.sides.in_variables, [pair.point for pair in self.found])
        if not why or self._proof:
            return None
        return self._unchecked(why, "give its variables other ranges")

    def _by_intervals(self) -> Judged | None:
        """Judge an inequality over the whole ranges of its variables."""
        meant, ranges = self.claim.meant, ranges_of(self.claim)
        if not meant.is_inequality or (all(pair.agree for pair in self.found) and self._proof):
            return None
        true = self._judged(Verdict.NUMERICAL, f"true {self.where()}")
        if meant.cases or not ranges:
            return true
        left, right = self.sides.in_variables
        gap, found = gap_of(left, meant.relation, right), Decision(None, ranges)
        with suppress(LimitReached):
            found = decide(gap, meant.relation.is_strict, ranges, meant.conditions, self.look)
        if found.is_true:
            spans = " and ".join(f"{s} from {_span(span)}" for s, span in found.over.items())
            why = f"true for all {spans or 'values'} at which both sides are real"
            if not any(span.powers for span in found.over.values()):
                return self._judged(Verdict.HOLDS, why)
            return self._not_shown_at_points() or self._judged(Verdict.NUMERICAL, why)
        with mpmath.workdps(_EXACT):
            place = {s: mpf(at.numerator) / at.denominator for s, at in found.where.items()}
        at = [self.found[0].point | place] if found.is_true is False else []
        if failed := self._false_at(at, Undecided):
            return failed
        if len(ranges) > _FEW and not self._touches(place):
            return self._not_shown_at_points() or true
        where = ", ".join(f"{s} = {mpmath.nstr(value, 6)}" for s, value in place.items())
        why = f"true {self.where()}, but intervals do not show it everywhere"
        why += where and f", such as near {where}"
        remedy = "restrict the variables with `low` and `high`, or write <= if the sides touch"
        if gap.has(Integral):
            remedy = "write the closed form of the integral"
        return self._unchecked(why, remedy)

    def _touches(self, place: Point) -> bool:
        """Whether the sides of a strict inequality are equal, or nearly, at one point."""
        close = _TOUCHING * min(pair.gap for pair in self.found)
        near = self.sides.pairs([self.found[0].point | place] if place else [])
        return self.claim.meant.relation.is_strict and any(pair.gap < close for pair in near)

    def _wrong_off_the_bound(self) -> Judged | None:
        """Judge the printed relation on both sides of the state in which a bound is reached."""
        cases = zip(self.claim.meant.reached or (), (True, False), strict=False)
        for entries, met in cases:
            off = replace(self.sides, meaning={**self.sides.meaning, **entries}, known={})
            for point in islice(points(self.claim), _OFF):
                self.look()
                pair = off.pair(point)
                if _is_met(self.claim.meant.relation, pair) != met:
                    what = "false inside" if met else "true beyond"
                    return self._judged(Verdict.FAILS, f"{what} the bound: {_example(pair)}")
        return None

    # -------------------------------------------------------------- exact steps

    @cached_property
    def _proof(self) -> str | None:
        """How both sides were shown to be equal everywhere; None if the time did not suffice."""
        try:
            return vanishes(self.sides.difference, ranges_of(self.claim))
        except LimitReached:
            return None

    def _by_exact_steps(self) -> Judged:
        worst = min(min(pair.digits, pair.known) for pair in self.found)
        agree = f"the two sides agree to {min(worst, 2 * DIGITS)} digits {self.where()}"
        if self.claim.meant.reached is not None:
            agree += f"; the relation is right at {_OFF} points on either side of the bound"
        if self._proof:
            return self._judged(Verdict.HOLDS, f"{self._proof}; {agree}")
        if self._proof is None:
            agree += f"; no proof was found within {self.claim.seconds:g} s"
        elif (other := constant(self.sides.difference)) is not None:
            return self._judged(Verdict.FAILS, f"left minus right is {other}")
        return self._judged(Verdict.NUMERICAL, agree)

    # -------------------------------------------------------------- in words

    def where(self) -> str:
        """Describe the number of points that were examined and the ranges that they cover."""
        count = len(self.found)
        if not variables(self.claim):
            return "without any variables"
        if self.claim.meant.cases:
            return f"in {count} prescribed {'case' if count == 1 else 'cases'} alone"
        told = [spread([pair.point for pair in self.found])]
        if self.left_out:
            told.append(f"no value at {self.left_out} more points")
        if self.unreal:
            unreal = f"one side is not real at {len(self.unreal)} more points"
            told.append(unreal + self._not_real())
        return f"at {_points(count)} ({'; '.join(told)})"

    def _not_real(self) -> str:
        """Tell a comparison that shows where a side is not real, if there is one."""
        unreal, real = ([pair.point for pair in each] for each in (self.unreal, self.found))
        told = telling(self.claim, unreal, real)
        return f", wherever {told}" if told else ""

    def _judged(self, verdict: Verdict, why: str) -> Judged:
        return Judged(verdict, why, tuple(self.found))

    def _unchecked(self, why: str, remedy: str = "") -> Judged:
        return self._judged(Verdict.UNCHECKED, f"{why}: {remedy}" if remedy else why)


def _is_met(relation: Relation, pair: Pair) -> bool:
    """Whether a relation is true for two numbers."""
    if pair.agree:
        return not relation.is_strict
    if not relation.is_ordered:
        return False
    difference = pair.left - pair.right
    if mpmath.im(difference) != 0:
        raise Undecided("complex numbers cannot be ordered")
    below = relation in (Relation.BELOW, Relation.AT_MOST)
    return bool(mpmath.re(difference) < 0) == below


def _example(pair: Pair) -> str:
    where = ", ".join(f"{symbol} = {mpmath.nstr(v, 6)}" for symbol, v in pair.point.items())
    left, right = mpmath.nstr(pair.left, 12), mpmath.nstr(pair.right, 12)
    text = f"left = {left}, right = {right}"
    if left == right:
        text += f", left minus right = {mpmath.nstr(pair.left - pair.right, 3)}"
    return text + (f" at {where}" if where else "")


def _span(span: Range) -> str:
    """The ends of a range in words."""
    return " to ".join(f"{float(end):g}" for end in ends(span))


def _exactly(value: mpf) -> Rational:
    """Return the exact value of a binary number as a SymPy rational."""
    above, below = to_rational(value._mpf_)
    return Rational(int(above), int(below))


def _points(count: int) -> str:
    """The number of points, in words."""
    return f"{count} point{'' if count == 1 else 's'}"
