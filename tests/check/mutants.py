"""True claims broken in many ways: a sign, a factor, an exponent, a swapped symbol, a lost term."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice

from sympy import Expr, count_ops, pi

from derive.check.claim import Claim, Verdict
from derive.check.correction import swaps_on_right
from derive.check.draw import has_integral
from derive.check.judge import Judged, judge
from derive.check.repair import Edit, Names, edits
from derive.check.sides import Sides

FEWEST = 5
"""Ways in which a claim is broken at least."""
_OF_A_KIND = {"sign": 2, "factor": 2, "exponent": 3, "swap": 3, "term": 2}
_OF_AN_INTEGRAL = {"sign": 1, "factor": 2, "exponent": 1, "swap": 1, "term": 1}


@dataclass(frozen=True)
class Mutant:
    """A claim with one side changed."""

    claim: Claim
    kind: str
    what: str

    @property
    def judged(self) -> Judged:
        """What the checker says of it; none of the claim's conventions is tried."""
        return judge(Sides.printed(self.claim))


def mutants(claim: Claim) -> Iterator[Mutant]:
    """A few of every kind, from the right-hand side, and the left where it is no symbol."""
    some = list(_chosen(claim, _OF_AN_INTEGRAL)) if has_integral(claim) else []
    yield from some if len(some) >= FEWEST else _chosen(claim, _OF_A_KIND)


def _chosen(claim: Claim, wanted: Mapping[str, int]) -> Iterator[Mutant]:
    for kind, most in wanted.items():
        yield from islice(_of_kind(claim, kind), most)


def _of_kind(claim: Claim, kind: str) -> Iterator[Mutant]:
    for edit in _wanted(claim.meant.right, claim, kind):
        yield Mutant(claim.changed(right=edit.expr), kind, edit.what)
    if count_ops(claim.meant.left) > 0 and claim.meant.through is None:
        for edit in _wanted(claim.meant.left, claim, kind):
            yield Mutant(claim.changed(left=edit.expr), kind, edit.what)


def _wanted(expr: Expr, claim: Claim, kind: str) -> Iterator[Edit]:
    swaps = claim.meant.swaps if expr != claim.meant.right else swaps_on_right(claim)
    for edit in edits(expr, Names(swaps)):
        if edit.kind != kind:
            continue
        if kind == "factor" and not edit.what.startswith(("2 on", f"{pi} on", "1/2 on")):
            continue
        if kind == "term" and not edit.what.startswith("without"):
            continue
        yield edit


def survives(mutant: Mutant) -> bool:
    """Whether the checker takes a broken claim for a true one."""
    return mutant.judged.verdict in (Verdict.HOLDS, Verdict.NUMERICAL)
