"""Compute the verdict on a claim, with the evidence for it.

The questions are asked in this order.  Do the two sides agree at random points?  If so, is their
difference zero symbolically?  If not, does a sign convention that the source excludes elsewhere
make the claim true, and which change of the printed equation makes it true?  A corrected equation
is judged like the printed one, at the same points and by the same steps.
"""

from collections.abc import Callable, Iterable
from contextlib import nullcontext
from dataclasses import dataclass, replace
from typing import TypeVar

from derive.check.basis import basis, is_empty
from derive.check.claim import Basis, Claim, Verdict
from derive.check.correction import Repair, repaired
from derive.check.diagnosis import diagnosis, where_true
from derive.check.judge import Judged, Judging, judge, judge_as_printed, no_clock
from derive.check.schema import Reinterpretation
from derive.check.sides import Sides
from derive.command.limit import LimitReached, LookAtClock, within

Result = TypeVar("Result")


@dataclass(frozen=True)
class Finding:
    """A claim with what was found about it.

    judged      the result for the equation as printed
    convention  the sign convention under which the claim holds, if there is one
    under       the result for the same equation under that convention
    repair      the corrected equation, if one was found
    tried       the number of corrections that were tried
    stopped     the reason why the search for a correction was not completed, if any
    diagnosis   how the two sides differ, if no correction was found
    partly      where the claim is true, if it is true at some points and false at others
    basis       what the verdict rests on; None if the claim is unchecked
    given       the findings of the claims that are taken as true
    alone       with such claims: the result by the meanings of the file, if it is known
    """

    claim: Claim
    judged: Judged
    convention: Reinterpretation | None = None
    under: Judged | None = None
    repair: Repair | None = None
    tried: int = 0
    stopped: str = ""
    diagnosis: str = ""
    partly: str = ""
    basis: Basis | None = None
    given: tuple["Finding", ...] = ()
    alone: Judged | None = None

    @property
    def unsound(self) -> Verdict | None:
        """The verdict on a claim taken as true that is not shown to be true, if there is one."""
        found = [each.unsound if each.judged.good else each.verdict for each in self.given]
        return min(filter(None, found), key=lambda each: each != Verdict.FAILS, default=None)

    @property
    def _is_true_alone(self) -> bool:
        return self.alone is not None and self.alone.good

    @property
    def error_enters_at(self) -> tuple[Claim, ...]:
        """The first wrong claims in the derivation of this one, as far as they are known.

        There are none if the claim is true without those given.  A claim that does not follow is
        itself wrong if it is false without those given, or if all of them are true.
        """
        is_wrong = self.judged.verdict == Verdict.FAILS
        if not self.given:
            return (self.claim,) if is_wrong else ()
        if self.judged.good if self._is_true_alone else self.verdict == Verdict.UNCHECKED:
            return ()
        found = [claim for each in self.given for claim in each.error_enters_at]
        if is_wrong and (self.alone or not self.unsound):
            found.append(self.claim)
        return tuple({claim.entry.label: claim for claim in found}.values())

    @property
    def step(self) -> str:
        """Whether a claim follows from those given and where the error enters, if there is one."""
        at, is_wrong = self.error_enters_at, self.judged.verdict == Verdict.FAILS
        if not self.given or not (at or is_wrong or (self.alone and not self._is_true_alone)):
            return ""
        follows = "it follows" if self.judged.good else "it does not follow"
        told = [f"{follows} from {', '.join(each.claim.name for each in self.given)} as printed"]
        names = ["at this claim" if claim is self.claim else f"at {claim.name}" for claim in at]
        where = f"the error enters {' and '.join(names)}"
        told.append(where if at else "it is not known where the error enters")
        if is_wrong and at and self.claim not in at:
            told.append("it is not known whether this claim is wrong, too")
        return "; ".join(told)

    @property
    def rests_on(self) -> str:
        """What the verdict rests on, in words; empty if the claim is unchecked."""
        if self.basis is None:
            return ""
        told = []
        for each in self.given:
            its = f", rests on {each.rests_on}" if each.given else ""
            told.append(f"{each.claim.name} ({each.verdict}{its})")
        return " ".join(filter(None, [self.basis, ", ".join(told)]))

    @property
    def ground(self) -> str:
        """What the verdict rests on, in a word, with the verdict on what was given if not true."""
        if self.basis is None:
            return "-"
        return f"{self.basis.word} ({self.unsound})" if self.unsound else self.basis.word

    @property
    def verdict(self) -> Verdict:
        """The verdict on the claim."""
        return Verdict.CONVENTION if self.convention else self.judged.verdict

    @property
    def as_expected(self) -> bool:
        """Whether the verdict equals the expected one; without one, whether the claim is true."""
        wanted = self.claim.entry.expected
        return self.verdict == wanted if wanted else self.judged.good


def check(claim: Claim, known: Iterable[Finding] = ()) -> Finding:
    """Return the verdict on one claim, and what it rests on.

    known: findings for earlier claims, of which some may be taken as true here
    """
    by_label = {each.claim.entry.label: each for each in known}
    given = tuple(
        by_label.get(each.entry.label) or check(each, known) for each in claim.meant.given
    )
    finding = _checked(claim, given)
    if finding.verdict == Verdict.UNCHECKED:
        return finding
    if finding.judged.good and _attempted(claim, lambda look: is_empty(claim, look))[0]:
        why = "the equation in `through` is true whatever its symbol is"
        return Finding(claim, Judged(Verdict.UNCHECKED, why))
    found, _ = _attempted(claim, lambda look: basis(claim, finding.judged, look))
    rests_on, judged = found or claim.meant.basis, finding.judged
    if finding.verdict == Verdict.HOLDS and rests_on == Basis.DEFINITIONS:
        why = f"true by the definitions; {judged.why}"
        judged = replace(judged, verdict=Verdict.DEFINITION, why=why)
    return replace(finding, judged=judged, basis=rests_on)


def _checked(claim: Claim, given: tuple[Finding, ...]) -> Finding:
    """Return the verdict on one claim; if the work is interrupted, it is `unchecked`.

    A claim that does not follow from wrong ones is corrected without them.
    """
    if claim.unchecked:
        return Finding(claim, Judged(Verdict.UNCHECKED, claim.unchecked))
    finding = Finding(claim, _judged(claim), given=given)
    real = finding.judged.one_side_real
    if claim.meant.alone is not None:
        return _step(finding, claim.meant.alone)
    if finding.judged.verdict == Verdict.FAILS:
        return _mended(finding)
    if real:
        why = f"one side is real at all {real} points, but the other is real at none of them"
        mended = _mended(replace(finding, judged=Judged(Verdict.FAILS, why)))
        if mended.repair is not None or mended.convention is not None:
            return mended
    return finding


def _judged(claim: Claim) -> Judged:
    found, stopped = _attempted(claim, lambda look: judge_as_printed(claim, look))
    return found or Judged(Verdict.UNCHECKED, stopped)


def _step(finding: Finding, alone: Claim) -> Finding:
    """Return the finding for a claim with given ones, which is also judged without them.

    A claim that is true without them, but does not follow, is `unchecked`.  If one of those given
    fails, a false claim is corrected without them, and not at all if it cannot be judged so.
    """
    found = _judged(alone)
    if found.verdict != Verdict.UNCHECKED:
        finding = replace(finding, alone=found)
    if finding.verdict != Verdict.FAILS:
        return finding
    if finding._is_true_alone:
        why = "true by the meanings of the file, but not with those that are given"
        return replace(finding, judged=replace(finding.judged, verdict=Verdict.UNCHECKED, why=why))
    if finding.unsound != Verdict.FAILS:
        return _mended(finding)
    if finding.alone is None:
        return finding
    return replace(_mended(replace(finding, claim=alone)), claim=finding.claim)


def _mended(finding: Finding) -> Finding:
    """Add a correction of a false claim, and a convention under which it is true, if they exist.

    Also add where it is true and, if neither was found, how its sides differ.
    """
    claim, sides = finding.claim, Sides.printed(finding.claim)

    def search(look: LookAtClock) -> Finding:
        repair, tried = repaired(claim, look)
        failed = replace(finding, repair=repair, tried=tried)
        for convention, changed in claim.meant.conventions:
            meaning = {**claim.meant.meaning, **changed}
            under = judge(replace(sides, meaning=meaning, known={}), look)
            if under.good:
                return replace(failed, convention=convention, under=under)
        return failed

    found, stopped = _attempted(claim, search)
    finding = found or replace(finding, stopped=stopped)
    if claim.meant.toward is None and claim.meant.reached is None:
        partly, _ = _attempted(claim, lambda look: where_true(claim, Judging(sides, look).is_true))
        finding = replace(finding, partly=partly or "")
    if finding.repair is None and finding.convention is None:
        difference, _ = _attempted(claim, lambda look: diagnosis(sides))
        finding = replace(finding, diagnosis=difference or "")
    return finding


def _attempted(claim: Claim, work: Callable[[LookAtClock], Result]) -> tuple[Result | None, str]:
    """Return the result of `work` within the claim's time limit, or the reason for its absence."""
    try:
        with within(claim.seconds) if claim.seconds is not None else nullcontext(no_clock) as look:
            return work(look), ""
    except LimitReached:
        return None, f"not finished within {claim.seconds:g} s"
    except RecursionError:
        return None, "stopped because an expression is nested too deeply"
    except Exception as error:  # an error in SymPy must not stop the other claims
        return None, f"stopped by an error in the algebra ({type(error).__name__})"
