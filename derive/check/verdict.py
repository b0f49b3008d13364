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
from derive.check.judge import Judged, Judging, Sides, judge, judge_as_printed, no_clock
from derive.check.schema import Reinterpretation
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

    @property
    def unsound(self) -> Verdict | None:
        """The verdict on a claim taken as true that is not shown to be true, if there is one."""
        found = [each.unsound if each.judged.good else each.verdict for each in self.given]
        return min(filter(None, found), key=lambda each: each != Verdict.FAILS, default=None)

    @property
    def rests_on(self) -> str:
        """What the verdict rests on, in words; empty if the claim is unchecked."""
        told = []
        for each in self.given:
            its = f", rests on {each.rests_on}" if each.given else ""
            told.append(f"{each.claim.name} ({each.verdict}{its})")
        return " ".join(filter(None, [self.basis, ", ".join(told)]))

    @property
    def ground(self) -> str:
        """What the verdict rests on, in a word, with the verdict on what was given if not true."""
        word = self.basis.word if self.basis else "-"
        return f"{word} ({self.unsound})" if self.unsound else word

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
    finding = _checked(claim)
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
    by_label = {each.claim.entry.label: each for each in known}
    given = tuple(by_label.get(each.entry.label) or check(each) for each in claim.meant.given)
    return replace(finding, judged=judged, basis=rests_on, given=given)


def _checked(claim: Claim) -> Finding:
    """Return the verdict on one claim; if the work is interrupted, it is `unchecked`."""
    if claim.unchecked:
        return Finding(claim, Judged(Verdict.UNCHECKED, claim.unchecked))
    found, stopped = _attempted(claim, lambda look: judge_as_printed(claim, look))
    judged = found or Judged(Verdict.UNCHECKED, stopped)
    if judged.verdict == Verdict.FAILS:
        return _explained(_mended(claim, judged))
    if judged.one_side_real:
        real = judged.one_side_real
        why = f"one side is real at all {real} points, but the other is real at none of them"
        finding = _mended(claim, Judged(Verdict.FAILS, why))
        if finding.repair is not None or finding.convention is not None:
            return finding
    return Finding(claim, judged)


def _mended(claim: Claim, judged: Judged) -> Finding:
    """Return the finding for a false claim, with a correction and a convention if they exist."""

    def search(look: LookAtClock) -> Finding:
        repair, tried = repaired(claim, look)
        failed = Finding(claim, judged, repair=repair, tried=tried)
        for convention, changed in claim.meant.conventions:
            meaning = {**claim.meant.meaning, **changed}
            under = judge(claim, claim.meant.left, claim.meant.right, meaning, look)
            if under.good:
                return replace(failed, convention=convention, under=under)
        return failed

    finding, stopped = _attempted(claim, search)
    return finding or Finding(claim, judged, stopped=stopped)


def _explained(finding: Finding) -> Finding:
    """Add where a false claim is true and, if it was not corrected, how its sides differ."""
    claim = finding.claim

    def partly(look: LookAtClock) -> str:
        sides = Sides(claim, *claim.meant.compared, claim.meant.meaning)
        return where_true(claim, Judging(sides, look).is_true)

    if claim.meant.toward is None and claim.meant.reached is None:
        finding = replace(finding, partly=_attempted(claim, partly)[0] or "")
    if finding.repair is None and finding.convention is None:
        difference, _ = _attempted(claim, lambda look: diagnosis(claim))
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
