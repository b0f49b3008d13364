"""Compare two sides with given meanings: at points, near a limit or a bound, and by exact steps."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice
from typing import Any

import mpmath
from mpmath import mpf
from mpmath.libmp import to_rational
from sympy import Expr, Integral, Rational, Symbol

from derive.check.claim import Claim, Meaning, Point, Range, Rounded, Verdict
from derive.check.diagnosis import quotient, telling
from derive.check.draw import LEAST, further, points, ranges_of, spread, unseen, variables
from derive.check.intervals import Decision, decide, ends, gap_of
from derive.check.numbers import Numbers, Pair, both, numbers
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
    judged = judge(claim, claim.meant.left, claim.meant.right, claim.meant.meaning, look)
    if (
        judged.verdict == Verdict.FAILS
        and claim.meant.rounded is not None
        and claim.meant.toward is None
    ):
        return _to_the_digits(claim, claim.meant.rounded) or judged
    return judged


def judge(
    claim: Claim, left: Expr, right: Expr, meaning: Meaning, look: LookAtClock = no_clock
) -> Judged:
    """Judge two sides with given meanings, at all points and, if they agree, symbolically."""
    judging = Judging(Sides(claim, *claim.meant.sides(left, right), meaning), look)
    try:
        return judging.limit() or judging.whole()
    except Undecided as error:
        return Judged(Verdict.UNCHECKED, str(error), tuple(judging.found))


def _to_the_digits(claim: Claim, rounded: Rounded) -> Judged | None:
    """Return a result if the exact constant rounds to the printed one, or else None."""
    if claim.meant.cases:  # of which each may have another constant
        judging = Judging(Sides(claim, *claim.meant.compared, claim.meant.meaning), no_clock)
        for point in points(claim):
            judging.is_true(point)
        ratios = [pair.left / pair.right for pair in judging.found if pair.right != 0]
        where = judging.where()
    else:
        ratio = quotient(claim)
        ratios = [ratio.constant] if ratio is not None and ratio.powers == 1 else []
        where = f"at {_points(ratio.count)}" if ratio else ""
    printed = mpf(rounded.value.p) / rounded.value.q
    half = mpf(rounded.half.p) / rounded.half.q
    true = [printed * each**rounded.power for each in ratios if each != 0 and not mpmath.im(each)]
    count = len(claim.meant.cases) or 1
    if len(true) < count or any(abs(each - printed) > half for each in true):
        return None
    rounding = f"{mpmath.nstr(printed, 8)} stands for {mpmath.nstr(true[0], 12)}"
    return Judged(Verdict.NUMERICAL, f"true with rounding {where}: {rounding}")


@dataclass
class Sides:
    """Two sides with the meanings of their symbols.

    known: values of the symbols at points, which sides with the same meanings may share
    """

    claim: Claim
    left: Expr
    right: Expr
    meaning: Meaning
    known: dict[tuple[object, ...], Mapping[Symbol, Any]] = field(default_factory=dict)

    @cached_property
    def in_variables(self) -> tuple[Expr, Expr]:
        """Both sides in terms of the variables."""
        table = dict(self.meaning)
        return self.left.xreplace(table), self.right.xreplace(table)

    @cached_property
    def at_points(self) -> tuple[Expr, Expr]:
        """Both sides as they are evaluated: integrals are first expressed in the variables."""
        sides = self.left, self.right
        return self.in_variables if any(side.has(Integral) for side in sides) else sides

    def numbers(self, point: Point) -> Numbers:
        """Return the function that gives the values of the symbols at a point."""

        def value() -> Mapping[Symbol, Any]:
            key = (*point.items(), mpmath.mp.dps)
            if key not in self.known:
                self.known[key] = numbers(self.meaning, point)
            return self.known[key]

        return value

    def pair(self, point: Point) -> Pair:
        """Return both sides at a point."""
        integrals = any(side.has(Integral) for side in self.in_variables)
        return both(*self.at_points, self.numbers(point), point, integrals)


class Judging:
    """Compares two sides.

    found      the values of both sides so far
    left_out   number of points without a value
    unreal     points where the sides differ and one is not real; they are no counter-examples
    one_sided  number of those points at which the other side is real
    """

    def __init__(self, sides: Sides, look: LookAtClock) -> None:
        self.sides, self.claim, self.look = sides, sides.claim, look
        self.found: list[Pair] = []
        self.unreal = list[Point]()
        self.left_out, self.one_sided = 0, 0

    def limit(self) -> Judged | None:
        """Judge whether the ratio tends to 1, or whether the difference has the printed order."""
        if self.claim.meant.toward is None:
            return None
        approach = Approach(self.claim, self.claim.meant.toward)
        return self._judged(*approach.judged(self.sides.in_variables, self.look))

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
        pair = self.sides.pair(point)
        is_real = [mpmath.im(side) == 0 for side in (pair.left, pair.right)]
        relation, ordered = self.claim.meant.relation, self.claim.meant.is_inequality
        if not all(is_real) and not pair.agree:
            self.unreal.append(point)
            self.one_sided += is_real[0] != is_real[1]
            return None
        if ordered and relation.is_strict and pair.agree and not self._are_equal_at(point):
            raise Undecided("the available digits do not show which side is larger")
        self.found.append(pair)
        return _is_met(relation, pair) if ordered else pair.agree

    def _are_equal_at(self, point: Point) -> bool:
        """Whether both sides are shown to be equal at one point or everywhere."""
        exact = {symbol: _exactly(value) for symbol, value in point.items()}
        return bool(self._are_equal) or vanishes_at(self._difference, exact)

    def _at_too_few_points(self) -> Judged | None:
        few, claim = len(self.found), self.claim
        sides = zip(("left", "right"), self.sides.in_variables, strict=True)
        if not few and (infinite := [name for name, side in sides if side.is_infinite]):
            return self._judged(Verdict.UNCHECKED, f"the {infinite[0]} side is infinite")
        if not few and (claim.meant.cases or not variables(claim)):
            return self._judged(Verdict.UNCHECKED, "a side is not a real number")
        if few >= LEAST or not variables(claim):
            return None
        if claim.meant.cases:
            is_number = any(side.is_Rational and side != 0 for side in self.sides.in_variables)
            if is_number or self._is_proven:
                return None
            why = f"true {self.where()}, which shows no general formula"
            remedy = f"leave out `cases`, give {LEAST} of them, or write one side as a number"
            return self._judged(Verdict.UNCHECKED, f"{why}: {remedy}")
        reasons = [f"both sides are real numbers at only {_points(few)}"]
        if self.unreal:
            reasons.append(f"one side is not real at {_points(len(self.unreal))}{self._not_real()}")
        if self.left_out:
            reasons.append(f"there is no value at {_points(self.left_out)}")
        if claim.meant.conditions:
            reasons.append(
                f"the points must satisfy {' and '.join(map(str, claim.meant.conditions))}"
            )
        remedy = "restrict the variables with `low`, `high` and `require`"
        judged = self._judged(Verdict.UNCHECKED, f"{', '.join(reasons)}: {remedy}")
        alone = self.one_sided if not few and self.one_sided == len(self.unreal) else 0
        return replace(judged, one_side_real=alone)

    # -------------------------------------------------------------- inequalities and bounds

    def _not_shown_at_points(self) -> Judged | None:
        """Judge nothing if the points do not show all of the sides, unless a proof exists."""
        why = unseen(self.claim, self.sides.in_variables, [pair.point for pair in self.found])
        if not why or self._is_proven:
            return None
        return self._judged(Verdict.UNCHECKED, f"{why}: give its variables other ranges")

    @property
    def _is_proven(self) -> bool:
        try:
            return bool(self._are_equal)
        except LimitReached:
            return False

    def _by_intervals(self) -> Judged | None:
        """Judge an inequality over the whole ranges of its variables."""
        meant = self.claim.meant
        are_equal = all(pair.agree for pair in self.found) and self._is_proven
        if not meant.is_inequality or are_equal:
            return None
        true = self._judged(Verdict.NUMERICAL, f"true {self.where()}")
        left, right = self.sides.in_variables
        gap, ranges = gap_of(left, meant.relation, right), ranges_of(self.claim)
        if meant.cases or not ranges:
            return true
        found = Decision(None, ranges)
        if not gap.has(Integral):
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
        if found.is_true is False:
            failed = self._false_at([self.found[0].point | place], Undecided)
            if failed is not None:
                return failed
        if len(variables(self.claim)) > _FEW and not self._touches(place):
            return self._not_shown_at_points() or true
        where = ", ".join(f"{s} = {mpmath.nstr(value, 6)}" for s, value in place.items())
        why = f"true {self.where()}, but intervals do not show it everywhere"
        why += where and f", such as near {where}"
        remedy = "restrict the variables with `low` and `high`, or write <= if the sides touch"
        if gap.has(Integral):
            remedy = "write the closed form of the integral"
        return self._judged(Verdict.UNCHECKED, f"{why}: {remedy}")

    def _touches(self, place: Point) -> bool:
        """Whether the sides of a strict inequality are equal, or nearly, at one point."""
        if not self.claim.meant.relation.is_strict or not place:
            return False
        try:
            nearest = _gap(self.sides.pair(self.found[0].point | place))
        except Undecided:
            return False
        return nearest < _TOUCHING * min(map(_gap, self.found))

    def _wrong_off_the_bound(self) -> Judged | None:
        """Judge the printed relation on both sides of the state in which a bound is reached."""
        bound, sides = self.claim.meant.reached, self.sides
        cases = zip(bound, (True, False), strict=True) if bound else ()
        for entries, met in cases:
            off = Sides(self.claim, sides.left, sides.right, {**sides.meaning, **entries})
            for point in islice(points(self.claim), _OFF):
                self.look()
                pair = off.pair(point)
                if _is_met(self.claim.meant.relation, pair) != met:
                    what = "false inside" if met else "true beyond"
                    return self._judged(Verdict.FAILS, f"{what} the bound: {_example(pair)}")
        return None

    # -------------------------------------------------------------- exact steps

    @property
    def _difference(self) -> Expr:
        left, right = self.sides.in_variables
        return left - right

    @cached_property
    def _are_equal(self) -> str:
        """How both sides were shown to be equal everywhere; empty if they were not."""
        return vanishes(self._difference, ranges_of(self.claim))

    def _by_exact_steps(self) -> Judged:
        worst = min(min(pair.digits, pair.known) for pair in self.found)
        agree = f"the two sides agree to {min(worst, 2 * DIGITS)} digits {self.where()}"
        if self.claim.meant.reached is not None:
            agree += f"; the relation is right at {_OFF} points on either side of the bound"
        try:
            if self._are_equal:
                return self._judged(Verdict.HOLDS, f"{self._are_equal}; {agree}")
            other = constant(self._difference)
        except LimitReached:
            why = f"{agree}; no proof was found within {self.claim.seconds:g} s"
            return self._judged(Verdict.NUMERICAL, why)
        if other is not None:
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
        left_out = f"; no value at {self.left_out} more points" if self.left_out else ""
        if self.unreal:
            left_out += f"; one side is not real at {len(self.unreal)} more points"
            left_out += self._not_real()
        return f"at {_points(count)} ({spread([pair.point for pair in self.found])}{left_out})"

    def _not_real(self) -> str:
        """Tell a comparison that shows where a side is not real, if there is one."""
        told = telling(self.claim, self.unreal, [pair.point for pair in self.found])
        return f", wherever {told}" if told else ""

    def _judged(self, verdict: Verdict, why: str) -> Judged:
        return Judged(verdict, why, tuple(self.found))


def _gap(pair: Pair) -> mpf:
    return abs(pair.left - pair.right)


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
