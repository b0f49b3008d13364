"""Compute the verdict on a claim, with the evidence for it.

The questions are asked in this order.  Do the two sides agree at random points?  If so, is their
difference zero symbolically?  If not, does a sign convention that the source excludes elsewhere
make the claim true, and which change of the printed equation makes it true?  A corrected equation
is judged like the printed one, at the same points and by the same steps.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import nullcontext
from dataclasses import dataclass, replace
from itertools import chain, islice
from typing import Any, TypeVar

import mpmath
from mpmath import mpf
from mpmath.libmp import to_rational
from sympy import Expr, Integral, Pow, Rational, S, Symbol, count_ops, exp, pi, sign
from sympy.functions.elementary.hyperbolic import HyperbolicFunction

from derive.check.claim import (
    SCALE,
    Bound,
    Claim,
    Convention,
    Meaning,
    Point,
    Range,
    Rounded,
    Verdict,
)
from derive.check.diagnosis import diagnosis, quotient, simple, where_true
from derive.check.draw import (
    LEAST,
    further,
    has_integral,
    points,
    spread,
    touching,
    variables,
)
from derive.check.numbers import Pair, both, near, numbers
from derive.check.repair import KINDS, WHOLE, Edit, edits, in_words, plain_edits, regrouped
from derive.check.tending import Approach
from derive.check.zero import constant, vanishes, vanishes_at
from derive.command.limit import LimitReached, LookAtClock, within
from derive.proof.values import Undecided, Undefined, evaluated
from derive.proof.verdict import DIGITS
from derive.reading.relation import Relation

Result = TypeVar("Result")

_SCREENED = 3
"""Number of points at which a correction is screened before it is judged in full."""
_DRAWN = 16
"""Number of points from which those points are chosen."""
_MORE_DRAWN = 4
"""Number of times that more points are drawn if a side was not a real number."""
_OFF = 6
"""Number of points on either side of a bound."""


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


@dataclass(frozen=True)
class Repair:
    """A true equation that corrects the printed one.

    also: other changes that passed the screening, in words.
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

    judged      the result for the equation as printed
    convention  the sign convention under which the claim holds, if there is one
    under       the result for the same equation under that convention
    repair      the corrected equation, if one was found
    tried       the number of corrections of each kind that were tried
    stopped     the reason why the search for a correction was not completed, if any
    diagnosis   how the two sides differ, if no correction was found
    partly      where the claim is true, if it is true at some points and false at others
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
    partly: str = ""

    @property
    def as_expected(self) -> bool:
        """Whether the verdict equals the expected one; without one, whether the claim is true."""
        wanted = self.claim.expected.verdict
        return self.verdict == wanted if wanted else self.judged.good


def check(claim: Claim) -> Finding:
    """Return the verdict on one claim; if the work is interrupted, it is `unchecked`."""
    if claim.unchecked:
        return Finding(claim, Verdict.UNCHECKED, Judged(Verdict.UNCHECKED, claim.unchecked))
    if claim.meant.defined:
        why = "the file defines its symbols by this very equation, so nothing is compared"
        return Finding(claim, Verdict.DEFINITION, Judged(Verdict.DEFINITION, why))
    judged, stopped = _attempted(claim, lambda look: judge_as_printed(claim, look))
    if judged is None:
        return Finding(claim, Verdict.UNCHECKED, Judged(Verdict.UNCHECKED, stopped))
    if judged.verdict != Verdict.FAILS:
        return _nowhere_real(claim, judged) or Finding(claim, judged.verdict, judged)
    finding, stopped = _attempted(claim, lambda look: _mended(claim, judged, look))
    finding = finding or Finding(claim, Verdict.FAILS, judged, stopped=stopped)
    partly, _ = _attempted(claim, lambda look: _partly(claim, look))
    finding = replace(finding, partly=partly or "")
    if finding.repair is None and finding.convention is None:
        difference, _ = _attempted(claim, lambda look: diagnosis(claim))
        return replace(finding, diagnosis=difference or "")
    return finding


def _partly(claim: Claim, look: LookAtClock) -> str:
    """Describe where a false claim is true, if it is true at some points; empty if it is not."""
    if claim.meant.toward is not None or claim.meant.reached is not None:
        return ""
    left, right = claim.meant.sides(claim.meant.left, claim.meant.right)
    judging = _Judging(claim, left, right, claim.meant.meaning, look)
    return where_true(claim, judging.is_true)


def _nowhere_real(claim: Claim, judged: Judged) -> Finding | None:
    """Correct a claim with one side that is never real while the other always is, if possible."""
    if judged.verdict != Verdict.UNCHECKED or not judged.one_side_real:
        return None
    finding, _ = _attempted(claim, lambda look: _mended(claim, judged, look))
    if finding is None or (finding.repair is None and finding.convention is None):
        return None
    real = judged.one_side_real
    why = f"one side is real at all {real} points, but the other is real at none of them"
    return replace(finding, judged=Judged(Verdict.FAILS, why))


def _no_clock() -> None:
    """Do nothing, because there is no time limit."""


def _attempted(claim: Claim, work: Callable[[LookAtClock], Result]) -> tuple[Result | None, str]:
    """Return the result of `work` within the claim's time limit, or the reason for its absence."""
    try:
        with within(claim.seconds) if claim.seconds is not None else nullcontext(_no_clock) as look:
            return work(look), ""
    except LimitReached:
        return None, f"not finished within {claim.seconds:g} s"
    except RecursionError:
        return None, "stopped because an expression is nested too deeply"
    except Exception as error:  # an error in SymPy must not stop the other claims
        return None, f"stopped by {type(error).__name__}: {error}"


def judge_as_printed(claim: Claim, look: LookAtClock = _no_clock) -> Judged:
    """Judge the printed sides with the claim's own meanings; printed constants may be rounded."""
    judged = judge(claim, claim.meant.left, claim.meant.right, claim.meant.meaning, look)
    if (
        judged.verdict == Verdict.FAILS
        and claim.meant.rounded is not None
        and claim.meant.toward is None
    ):
        return _to_the_digits(claim, claim.meant.rounded) or judged
    return judged


def _mended(claim: Claim, judged: Judged, look: LookAtClock) -> Finding:
    """Return the finding for a false claim, with a correction and a convention if they exist."""
    repair, tried = repaired(claim, look)
    for convention in claim.meant.conventions:
        meaning = {**claim.meant.meaning, **convention.meaning}
        under = judge(claim, claim.meant.left, claim.meant.right, meaning, look)
        if under.good:
            verdict = Verdict.CONVENTION
            return Finding(claim, verdict, judged, convention, under, repair, tried)
    return Finding(claim, Verdict.FAILS, judged, None, None, repair, tried)


def judge(
    claim: Claim, left: Expr, right: Expr, meaning: Meaning, look: LookAtClock = _no_clock
) -> Judged:
    """Judge two sides with given meanings, at all points and, if they agree, symbolically."""
    left, right = claim.meant.sides(left, right)
    judging = _Judging(claim, left, right, meaning, look)
    try:
        return judging.whole() if claim.meant.toward is None else judging.limit(claim.meant.toward)
    except Undecided as error:
        return Judged(Verdict.UNCHECKED, str(error), tuple(judging.found))


def _to_the_digits(claim: Claim, rounded: Rounded) -> Judged | None:
    """Return a result if the exact constant rounds to the printed one, or else None."""
    ratio = quotient(claim)
    if ratio is None or mpmath.im(ratio.constant) != 0 or ratio.powers or ratio.constant <= 0:
        return None
    printed = mpf(rounded.value.p) / rounded.value.q
    true = printed * ratio.constant**rounded.power
    if abs(true - printed) > mpf(rounded.half.p) / rounded.half.q:
        return None
    rounding = f"{mpmath.nstr(printed, 8)} stands for {mpmath.nstr(true, 12)}"
    return Judged(Verdict.NUMERICAL, f"true with rounding at {ratio.count} points: {rounding}")


class _Judging:
    """Compares two sides with given meanings, point by point.

    found      the values of both sides so far
    equal      whether both sides are shown to be equal everywhere; None before this is tested
    left_out   number of points without a value
    unreal     number of points where the sides differ and one is not real; no counter-examples
    one_sided  number of those points at which the other side is real
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
        """Return the verdict; raises Undecided."""
        for point in self._first_points():
            try:
                is_true = self._is_true_at(self._pair(point))
            except Undefined:
                self.left_out += 1
                continue
            if not is_true:
                return self._fails()
        if len(self.found) < LEAST and variables(self.claim) and not self.claim.meant.cases:
            judged = self._judged(Verdict.UNCHECKED, self._too_few())
            alone = self.one_sided if not self.found and self.one_sided == self.unreal else 0
            return replace(judged, one_side_real=alone)
        if not self.found:
            return self._judged(Verdict.UNCHECKED, "a side is not a real number")
        for point in further(self.claim, self._in_ours()):
            try:
                is_true = self._is_true_at(self._pair(point))
            except Undecided:
                self.left_out += 1
                continue
            if not is_true:
                return self._fails()
        if self.claim.meant.is_inequality and self.claim.meant.relation.is_strict:
            for point, beside in touching(self.claim, self._in_ours()):
                pair, *others = (self._pair(each) for each in (point, *beside))
                if all(_gap(pair) < _gap(other) for other in others):
                    why = f"the sides touch or nearly touch: {_example(pair)}"
                    return self._judged(Verdict.UNCHECKED, why)
        if self.claim.meant.is_inequality and not all(pair.agree for pair in self.found):
            return self._judged(Verdict.NUMERICAL, f"true {self._where()}")
        if self.claim.meant.reached is not None:
            wrong = self._off_the_bound(self.claim.meant.reached)
            if wrong:
                return self._judged(Verdict.FAILS, wrong)
        return self._proven()

    def is_true(self, point: Point) -> bool | None:
        """Whether the claim is true at a point; None if this is not known."""
        seen = self.unreal
        try:
            found = self._is_true_at(self._pair(point))
        except Undecided:
            return None
        return None if self.unreal > seen else found

    def _too_few(self) -> str:
        """Explain why there are too few points."""
        reasons = [f"both sides are real numbers at only {_points(len(self.found))}"]
        if self.unreal:
            reasons.append(f"one side is not real at {_points(self.unreal)}")
        if self.left_out:
            reasons.append(f"there is no value at {_points(self.left_out)}")
        if self.claim.meant.conditions:
            listed = " and ".join(map(str, self.claim.meant.conditions))
            reasons.append(f"the points must satisfy {listed}")
        return f"{', '.join(reasons)}: restrict the variables with `low`, `high` and `require`"

    def _first_points(self) -> Iterator[Point]:
        """Yield points of moderate size, and more of them if a side was not a real number."""
        yield from points(self.claim)
        if (self.unreal or self.left_out) and not self.claim.meant.cases:
            for n in range(_MORE_DRAWN):
                for point in points(self.claim, seed=f"more{n or ''}"):
                    if len(self.found) < LEAST:
                        yield point

    def limit(self, toward: tuple[Expr, Expr]) -> Judged:
        """Judge whether the ratio tends to 1, or whether the difference has the printed order."""
        table = dict(self.meaning)
        sides = [side.xreplace(table) for side in (self.left, self.right)]
        approaching = Approach(self.claim, sides, toward)
        verdict, why = approaching.judged(self.look)
        return self._judged(Verdict(verdict), why)

    def _pair(self, point: Point, meaning: Meaning | None = None) -> Pair:
        """Return both sides at one point; integrals are first expressed in the variables."""
        self.look()
        meaning = self.meaning if meaning is None else meaning
        left, right = self.left, self.right
        if left.has(Integral) or right.has(Integral):
            left, right = left.xreplace(dict(meaning)), right.xreplace(dict(meaning))
        return both(left, right, lambda: numbers(meaning, point), point, self.integrals)

    def _is_true_at(self, pair: Pair) -> bool:
        relation = self.claim.meant.relation
        if self.claim.meant.is_inequality and mpmath.im(pair.left - pair.right) != 0:
            self.unreal += 1
            return True
        if not self.claim.meant.is_inequality:
            if not pair.agree and (mpmath.im(pair.left) != 0 or mpmath.im(pair.right) != 0):
                self.unreal += 1
                self.one_sided += (mpmath.im(pair.left) == 0) != (mpmath.im(pair.right) == 0)
                return True
            self.found.append(pair)
            return pair.agree
        if relation.is_strict and pair.agree and not self._are_equal_at(pair.point):
            raise Undecided("the available digits do not show which side is larger")
        self.found.append(pair)
        return _is_met(relation, pair)

    def _are_equal_at(self, point: Point) -> bool:
        """Whether both sides are shown to be equal at one point or everywhere."""
        left, right = self._in_ours()
        if self.equal is None:
            self.equal = bool(vanishes(left - right, _ranges(self.claim)))
        exact = {symbol: _exactly(value) for symbol, value in point.items()}
        return self.equal or vanishes_at(left - right, exact)

    def _off_the_bound(self, bound: Bound) -> str:
        """Describe where the printed relation is wrong near the bound; empty if it is right."""
        relation = self.claim.meant.relation
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
        agree = f"the two sides agree to {min(worst, 2 * DIGITS)} digits {self._where()}"
        if self.claim.meant.reached is not None:
            agree += f"; the relation is right at {_OFF} points on either side of the bound"
        left, right = self._in_ours()
        try:
            how = vanishes(left - right, _ranges(self.claim))
            apart_by = None if how else constant(left - right)
        except LimitReached:
            why = f"{agree}; no proof was found within {self.claim.seconds:g} s"
            return self._judged(Verdict.NUMERICAL, why)
        if how:
            return self._judged(Verdict.HOLDS, f"{how}; {agree}")
        if apart_by is not None:
            return self._judged(Verdict.FAILS, f"left minus right is {apart_by}")
        return self._judged(Verdict.NUMERICAL, agree)

    def _where(self) -> str:
        """Describe the number of points that were examined and the ranges that they cover."""
        count = len(self.found)
        if not variables(self.claim):
            return "without any variables"
        ranges = spread([pair.point for pair in self.found])
        if self.claim.meant.cases:
            return f"in {count} {'case' if count == 1 else 'cases'}"
        left_out = f"; no value at {self.left_out} more points" if self.left_out else ""
        left_out += f"; one side is not real at {self.unreal} more points" if self.unreal else ""
        return f"at {count} points" + (f" ({ranges}{left_out})" if ranges else "")

    def _fails(self) -> Judged:
        return self._judged(Verdict.FAILS, _example(self.found[-1]))

    def _judged(self, verdict: Verdict, why: str) -> Judged:
        return Judged(verdict, why, tuple(self.found))


def _ranges(claim: Claim) -> dict[Symbol, Range]:
    return {symbol: claim.meant.ranges.get(symbol, SCALE) for symbol in variables(claim)}


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


# ------------------------------------------------------------------ corrections


def repaired(claim: Claim, look: LookAtClock = _no_clock) -> tuple[Repair | None, Counter[str]]:
    """Return the simplest change that makes the claim true, and the numbers of changes tried."""
    if claim.meant.is_inequality:
        return _other_relation(claim, look)
    tried: Counter[str] = Counter()
    if claim.meant.rounded is not None and (
        repair := _to_the_digits_with_a_factor(claim, claim.meant.rounded)
    ):
        return repair, tried
    screened = _Screen(claim, look)
    for candidates in _batches(claim):
        fitting = []
        for left, right, edit in candidates:
            look()
            tried[edit.kind] += 1
            if left != right and screened.fits(left, right) and not _is_same(left, right):
                fitting.append((left, right, edit))
        fitting.sort(key=_plainness)
        for left, right, edit in fitting:
            judged = judge(claim, left, right, claim.meant.meaning, look)
            if is_carried(claim, left, right, judged):
                others = {(one, other): e for one, other, e in fitting}
                del others[left, right]  # changes that lead to the same equation
                also = tuple(in_words(e.kind, e.what) for e in others.values())
                relation = claim.meant.relation
                return Repair(left, right, edit.kind, edit.what, judged, relation, also), tried
    return None, tried


def _is_same(left: Expr, right: Expr) -> bool:
    """Whether the two sides are the same expression, as p and sqrt(p**2) are for positive p."""
    held = left.free_symbols | right.free_symbols
    table = {s: Symbol(s.name, positive=True) for s in held if s.is_real is None}
    return bool(left.xreplace(table) == right.xreplace(table))


def _to_the_digits_with_a_factor(claim: Claim, rounded: Rounded) -> Repair | None:
    """Return a correction with a lost factor, or with another rounded constant, if one is true."""
    ratio = quotient(claim) if variables(claim) else None
    if ratio is None or ratio.powers or mpmath.im(ratio.constant) != 0:
        return None
    true = mpf(rounded.value.p) / rounded.value.q * ratio.constant**rounded.power
    digit = 2 * rounded.half
    other = digit * int(mpmath.nint(true * digit.q / digit.p))
    corrections = [
        (claim.meant.left, factor * claim.meant.right, rounded, f"{factor} on {WHOLE}")
        for factor in _LOST
    ]
    if other > 0:
        larger, new = other / rounded.value, replace(rounded, value=other)
        told = f"{mpf(other.p) / other.q} for {mpf(rounded.value.p) / rounded.value.q}"
        on_left = rounded.power < 0
        sides = (
            (larger * claim.meant.left, claim.meant.right)
            if on_left
            else (claim.meant.left, larger * claim.meant.right)
        )
        corrections.append((*sides, new, told))
    for left, right, number, what in corrections:
        judged = _to_the_digits(claim.changed(left=left, right=right), number)
        if judged is not None and not _is_same(left, right):
            return Repair(left, right, "factor", what, judged, claim.meant.relation)
    return None


_LOST = (S.NegativeOne, S(2), S.Half, pi, 1 / pi)
"""Factors that may have been lost beside a rounded constant."""


def is_carried(claim: Claim, left: Expr, right: Expr, judged: Judged) -> bool:
    """Whether the evidence is sufficient for a corrected equation.

    Agreement in digits may mislead: 1 + tanh(10**6*(v - 5)) is zero to all digits for v < 4.
    Equations with such functions must be proven, and so must those with sign functions, which
    vanish at points that may never be drawn.
    """
    if claim.meant.relation.is_ordered or has_integral(claim) or claim.meant.toward:
        return judged.good
    table = dict(claim.meant.meaning)
    sides = [side.xreplace(table) for side in claim.meant.sides(left, right)]
    if any(map(_may_fade, sides)) or left.has(sign) or right.has(sign):
        return judged.verdict == Verdict.HOLDS
    return judged.good


def _may_fade(expr: Expr) -> bool:
    """Whether a part may be nonzero but too small to appear in any digit."""
    powers = (power.exp for power in expr.atoms(Pow))
    return expr.has(exp, HyperbolicFunction) or any(
        not each.is_number or abs(each) > _STEEP for each in powers
    )


_STEEP = 16
"""Powers with larger exponents may be too small to appear in any digit."""


def _other_relation(claim: Claim, look: LookAtClock) -> tuple[Repair | None, Counter[str]]:
    """Correct an inequality by an equation or by the opposite inequality, if one is true."""
    tried: Counter[str] = Counter()
    relations = (Relation.EQUAL, claim.meant.relation.turned)
    for relation in relations if claim.meant.left != claim.meant.right else ():
        tried["relation"] += 1
        other = claim.changed(relation=relation)
        judged = judge(other, claim.meant.left, claim.meant.right, claim.meant.meaning, look)
        if is_carried(other, claim.meant.left, claim.meant.right, judged):
            what = f"{relation} for {claim.meant.relation}"
            return Repair(
                claim.meant.left, claim.meant.right, "relation", what, judged, relation
            ), tried
    return None, tried


Candidate = tuple[Expr, Expr, Edit]


def _plainness(candidate: Candidate) -> tuple[int, int, str]:
    left, right, edit = candidate
    kind = edit.kind.split(" and ")[0]
    return int(count_ops(left) + count_ops(right)), KINDS.index(kind), edit.what


def _batches(claim: Claim) -> Iterator[Iterable[Candidate]]:
    """Yield changes of which the simplest true one is chosen, batch by batch.

    Single changes come first, and then the constant by which the sides differ.  If none of them is
    sufficient, pairs of changes are tried, of which the first is a sign or a swap.  If each trial
    is slow, single changes are tried kind by kind, beginning with those of a whole side.
    """
    if has_integral(claim) or claim.meant.toward is not None:
        single = list(_single(claim))
        whole = [c for c in single if c[2].what.endswith(WHOLE)]
        yield whole
        yield _scaled(claim)
        for kind in KINDS:
            yield [c for c in single if c[2].kind == kind and c not in whole]
    else:
        yield _single(claim)
        yield _scaled(claim)
    yield _double(claim)


def _single(claim: Claim) -> Iterator[Candidate]:
    seen = set[tuple[Expr, Expr]]()
    for left, right, edit in chain(_changed(claim), _regrouped(claim)):
        if (left, right) not in seen:
            seen.add((left, right))
            yield left, right, edit


def swaps_on_right(claim: Claim) -> tuple[Symbol, ...]:
    """Return the names that may be swapped on the right side, which does not define the left one.

    If a = c, the equations a = a and a = (a + c)/2 are true, but correct nothing.
    """
    if claim.meant.right.has(claim.meant.left):
        return claim.meant.swaps
    return tuple(name for name in claim.meant.swaps if name != claim.meant.left)


def _changed(claim: Claim) -> Iterator[Candidate]:
    units = {} if claim.units else claim.meant.unit_of
    for edit in edits(claim.meant.right, swaps_on_right(claim), units):
        yield claim.meant.left, edit.expr, edit
    if not isinstance(claim.meant.left, Symbol):
        for edit in edits(claim.meant.left, claim.meant.swaps, units):
            yield edit.expr, claim.meant.right, edit


def _regrouped(claim: Claim) -> Iterator[Candidate]:
    """Yield the printed text with another exponent on one bracket or root."""
    if claim.meant.reading is None or claim.meant.through is not None:
        return
    for text, what in regrouped(claim.printed.text):
        sides = claim.meant.reading(text)
        if sides is not None:
            yield *sides, Edit("exponent", what, sides[1])


def _scaled(claim: Claim) -> Iterator[Candidate]:
    """Yield the equation with the constant by which its sides differ, if it is simple."""
    if claim.meant.through is not None or not variables(claim):
        return
    factor: Expr | None
    if claim.meant.toward is not None:
        table = dict(claim.meant.meaning)
        sides = [side.xreplace(table) for side in (claim.meant.left, claim.meant.right)]
        factor = simple(Approach(claim, sides, claim.meant.toward).ratio(), _OF_LIMITS)
    else:
        ratio = quotient(claim)
        factor = ratio.simple_factor if ratio is not None else None
    if factor is not None:
        edit = Edit("factor", f"{factor} on {WHOLE}", factor * claim.meant.right)
        yield claim.meant.left, edit.expr, edit


def _double(claim: Claim) -> Iterator[Candidate]:
    """Yield pairs of changes of the right side, of which the first is a sign or a swap."""
    units = {} if claim.units else claim.meant.unit_of
    firsts = [
        e
        for e in plain_edits(claim.meant.right, swaps_on_right(claim), units)
        if e.kind in _FIRST_KINDS
    ]
    for first in firsts[:_FIRSTS]:
        for second in plain_edits(first.expr, swaps_on_right(claim), units):
            what = f"{first.what}; {second.what}"
            edit = Edit(f"{first.kind} and {second.kind}", what, second.expr)
            yield claim.meant.left, second.expr, edit


_OF_LIMITS = 6
"""Digits to which the limit of a ratio must agree with a simple constant."""
_FIRST_KINDS = ("sign", "swap")
_FIRSTS = 12
"""The largest number of first changes that are combined with a second one."""


def _screening(claim: Claim) -> list[Point]:
    """Return a few points, if possible such that both printed sides are real numbers there."""
    if claim.meant.cases or claim.meant.toward is not None:
        return list(points(claim, _SCREENED, "screen"))
    table = dict(claim.meant.meaning)
    sides = [
        side.xreplace(table) for side in claim.meant.sides(claim.meant.left, claim.meant.right)
    ]
    drawn = list(points(claim, _DRAWN, "screen"))
    real = list(islice((p for p in drawn if _are_real(sides, p)), _SCREENED))
    return real if len(real) == _SCREENED else drawn[:_SCREENED]


def _are_real(sides: list[Expr], point: Point) -> bool:
    try:
        return all(mpmath.im(evaluated(side, point)) == 0 for side in sides)
    except Undecided:
        return False


class _Screen:
    """Tests candidates at a few points; the values that they share are computed only once."""

    def __init__(self, claim: Claim, look: LookAtClock) -> None:
        self.claim, self.look = claim, look
        self.points = _screening(claim)
        self.known: dict[tuple[int, int], Mapping[Symbol, Any]] = {}
        self.integrals = has_integral(claim)

    def fits(self, left: Expr, right: Expr) -> bool:
        """Whether a candidate agrees at the points, or near the limit of a claim that has one."""
        left, right = self.claim.meant.sides(left, right)
        if self.claim.meant.toward is not None:
            table = dict(self.claim.meant.meaning)
            sides = [side.xreplace(table) for side in (left, right)]
            try:
                return Approach(self.claim, sides, self.claim.meant.toward).is_true(self.look)
            except Undecided:
                return False
        if left.has(Integral) or right.has(Integral):
            table = dict(self.claim.meant.meaning)
            left, right = left.xreplace(table), right.xreplace(table)
        try:
            return all(self._agrees(left, right, n) for n in range(len(self.points)))
        except Undecided:
            return False

    def _agrees(self, left: Expr, right: Expr, n: int) -> bool:
        def value() -> Mapping[Symbol, Any]:
            return self._numbers(n)

        if not near(left, right, value):
            return False
        return both(left, right, value, self.points[n], self.integrals).agree

    def _numbers(self, n: int) -> Mapping[Symbol, Any]:
        key = (n, mpmath.mp.dps)
        if key not in self.known:
            self.known[key] = numbers(self.claim.meant.meaning, self.points[n])
        return self.known[key]


def check_all(claims: tuple[Claim, ...]) -> list[Finding]:
    """Return the findings for all claims in order."""
    return [check(claim) for claim in claims]


def _exactly(value: mpf) -> Rational:
    """Return the exact value of a binary number as a SymPy rational."""
    above, below = to_rational(value._mpf_)
    return Rational(int(above), int(below))


def _points(count: int) -> str:
    """The number of points, in words."""
    return f"{count} point{'' if count == 1 else 's'}"
