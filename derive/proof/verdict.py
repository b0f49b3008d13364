"""The result of a proof: a verdict, the route by which it was reached, and its numbers.

A formula is *proven* if its difference from an independent route is zero symbolically.  It is
*numerical* if both agree to DIGITS digits at POINTS random points that meet the formula's
assumptions, *refuted* if they differ at a point, and *unknown* if too few points could be drawn.
Only formulas with one of the first two verdicts are printed or generated.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import mpmath
from mpmath import mpf

if TYPE_CHECKING:
    from derive.proof.balls import Value

DIGITS = 30
"""Number of digits to which both routes must agree."""
POINTS = 24
"""Number of random points at which they are compared."""
WORKING = 50
"""Working digits of the comparison."""
EXACT = 10**6
"""The number of digits that two equal numbers share."""


class Verdict(StrEnum):
    """The result of the proof of a formula."""

    PROVEN = "proven"
    NUMERICAL = "numerical"
    UNKNOWN = "unknown"
    REFUTED = "refuted"


@dataclass(frozen=True)
class Proof:
    """The proof of a formula.

    route    the comparison that was made, in words
    points   number of random points at which both sides were evaluated (0: symbolic only)
    digits   number of digits to which they agree at the worst of these points
    example  a point at which they differ, for a refuted formula
    """

    verdict: Verdict
    route: str
    points: int = 0
    digits: int = 0
    example: str = ""

    @property
    def holds(self) -> bool:
        """Whether the formula may be printed and generated."""
        return self.verdict in (Verdict.PROVEN, Verdict.NUMERICAL)

    def __str__(self) -> str:
        numbers = f"; {self.digits} digits at {self.points} points" if self.points else ""
        return f"{self.verdict}: {self.route}{numbers}{self.example and '; at ' + self.example}"


@dataclass(frozen=True)
class Comparison:
    """Two values of the same quantity at one point."""

    formula: mpf
    route: mpf
    point: str

    @property
    def digits(self) -> int:
        """Number of digits to which the two values agree."""
        if not (mpmath.isfinite(self.formula) and mpmath.isfinite(self.route)):
            return 0
        return min(WORKING, shared_digits(self.formula, self.route))


def shared_digits(first: "Value", second: "Value") -> int:
    """The number of digits that two numbers share; equal numbers share EXACT."""
    gap = abs(first - second)
    return EXACT if gap == 0 else max(0, int(-mpmath.log10(gap / max(abs(first), abs(second)))))


def numerical_proof(route: str, comparisons: Iterable[Comparison]) -> Proof:
    """The verdict of a numerical comparison; a point with several comparisons counts once."""
    drawn: set[str] = set()
    worst = WORKING
    for comparison in comparisons:
        drawn.add(comparison.point)
        if comparison.digits < DIGITS:
            example = f"{comparison.point}: {mpmath.nstr(comparison.formula, 17)} against "
            example += mpmath.nstr(comparison.route, 17)
            return Proof(Verdict.REFUTED, route, len(drawn), comparison.digits, example)
        worst = min(worst, comparison.digits)
    points = len(drawn)
    if points < POINTS:
        return Proof(Verdict.UNKNOWN, f"{route}: only {points} of {POINTS} points found", points)
    return Proof(Verdict.NUMERICAL, route, points, worst)


def combined(symbolic: Proof | None, numerical: Proof | None) -> Proof:
    """The joint verdict of a symbolic and a numerical route; a refutation by either one decides."""
    known = [proof for proof in (symbolic, numerical) if proof is not None]
    for verdict in (Verdict.REFUTED, Verdict.PROVEN, Verdict.NUMERICAL):
        first = next((proof for proof in known if proof.verdict == verdict), None)
        if first is not None:
            break
    else:
        return Proof(Verdict.UNKNOWN, "; ".join(proof.route for proof in known))
    if first.verdict != Verdict.PROVEN or numerical is None or not numerical.holds:
        return first
    route = f"{first.route}; {numerical.route}"
    return Proof(Verdict.PROVEN, route, numerical.points, numerical.digits)
