"""The open cases: constant and varying loads around the threshold, and varying moment.

All on the upright wedge g = phi |x| with E* = phi = 1, P = 1, f = 1/2 and dQ = 0.3 f P.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from tests.reference.cases import WEDGE, Known
from tests.reference.conditions import LARGE, MODERATE, NOWHERE, HalfCycle, Premise, premise
from tests.reference.mixed import NotInWindow, turning
from tests.reference.solver import reference
from tests.reference.stick import Zone

F, DQ = 0.5, 0.15

WINDOW = (
    0.9,
    0.927,
    0.931,
    0.935,
    0.95,
    0.97,
    0.99,
    1.0,
    1.01,
    1.03,
    1.05,
    1.07,
    1.085,
    1.095,
    1.15,
)
"""Tensions at constant loads, over the paper's threshold."""

MEANS = (0.0, 0.1)
RANGES = (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
TENSIONS = (0.5, 1.2, 1.5, 2.0, 3.0, 5.0, 7.0)
"""The map: mean and range of the moment over P^2/(E* phi), tension over the threshold."""

LOAD_RANGES = (
    (-0.02, 0.0),
    (0.0, 0.005),
    (0.0, 0.01),
    (0.0, 0.02),
    (0.005, 0.0),
    (0.01, 0.0),
    (0.02, 0.0),
    (0.02, 0.01),
    (0.1, 0.0),
)
NEAR = (0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2, 1.3)
"""The map around the threshold: ranges of P about 1 and of M about 0, and tensions."""

COUNTS, STEPS = (16, 32, 64), (8, 16, 32)
"""Elements between breaks, load steps a half-cycle."""


def threshold(dQ: float = DQ, f: float = F) -> float:
    """The paper's: where the moderate n of the upright wedge, P = E* = phi = 1, is c = 1.

    At load P' and tilt alpha = phi (1 - 2 theta/pi) the wedge reaches c = P' tan(theta/2); with
    P' = 1 - dQ/(2 f), alpha = -dsigma/(4 f):  dsigma = 4 f ((4/pi) arctan(1/P') - 1).
    """
    return float(4 * f * (4 / np.pi * np.arctan(1 / (1 - dQ / (2 * f))) - 1))


def cycle(
    dsigma: float, M: tuple[float, float] = (0.0, 0.0), P: tuple[float, float] = (1.0, 1.0)
) -> Known:
    """One of the explored cycles; the sense of slip on the right is yet to be found."""
    return Known("", WEDGE, LARGE, DQ, dsigma, P, M, F)


class Point(NamedTuple):
    """One cycle of a map: tension over the threshold, mean and range of M, range of P about 1."""

    tension: float
    mean: float
    span: float
    load: float = 0.0

    @property
    def cycle(self) -> Known:
        """The cycle itself."""
        M = self.mean - self.span / 2, self.mean + self.span / 2
        return cycle(self.tension * threshold(), M, (1 - self.load / 2, 1 + self.load / 2))


VARYING_MOMENT = [Point(part, mean, span) for mean in MEANS for span in RANGES for part in TENSIONS]
AROUND = [Point(part, 0.0, span, load) for load, span in LOAD_RANGES for part in NEAR]
"""Both maps."""


def narrowest(dsigma: float) -> float:
    """The width of a stick zone whose right end is just not loaded: dQ/pi = (dsigma/4) width/2."""
    return 8 * DQ / (np.pi * dsigma)


class Verdict(NamedTuple):
    """The conditions in one regime: their zone, and the premise there and back."""

    kappa: int
    zone: Zone
    there: Premise
    back: Premise

    @property
    def holds(self) -> bool:
        """Whether the premise holds in both half-cycles."""
        return self.there is self.back is Premise.HOLDS

    @property
    def shrinks(self) -> bool:
        """Whether it holds in one of them, and a zone only shrinks in the other."""
        return {self.there, self.back} == {Premise.HOLDS, Premise.SHRINKS}


def verdict(half: HalfCycle, kappa: int) -> Verdict:
    """From the loads alone."""
    zone = half.exact(kappa)
    return Verdict(kappa, zone, premise(half, kappa, zone), premise(half.back(), kappa, zone))


class Kind(Enum):
    """What a cycle is, as far as the loads tell, and where they don't, the solver."""

    HOLDS = "holds"
    SHRINKS = "a slip zone shrinks"
    BEYOND = "shear beyond friction"
    AHEAD = "an edge runs ahead"
    STICKS = "sticks"
    OPEN = "no zone"


@dataclass(frozen=True)
class Explored:
    """One cycle: the solver's answer, and the conditions of both regimes.

    smallest   the smallest ends over partial half-cycles in the better regime
    constant   the exact zone if the mean loads stood still
    """

    zone: Zone
    error: Zone
    rounds: int
    always: Zone
    moderate: Verdict
    large: Verdict
    smallest: Zone
    constant: Zone

    @property
    def best(self) -> Verdict:
        """The regime whose premise holds, or else the one that has a zone."""
        return better(self.moderate, self.large)

    @property
    def kind(self) -> Kind:
        """From the premise; where there is no zone, from where the solver's zone ends."""
        said = {self.best.there, self.best.back}
        if Premise.NO_ZONE in said:
            ends = np.abs(np.subtract(self.zone, self.always)) <= self.error
            return Kind.STICKS if ends.all() else Kind.AHEAD if ends.any() else Kind.OPEN
        if Premise.BEYOND in said:
            return Kind.BEYOND
        return Kind.SHRINKS if Premise.SHRINKS in said else Kind.HOLDS

    def off(self, zone: Zone) -> float:
        """How far a zone is from the solver's, at its worse end."""
        return float(np.abs(np.subtract(zone, self.zone)).max())

    @property
    def estimate(self) -> float:
        """The solver's own of its error, at its worse end."""
        return max(self.error)


def better(*verdicts: Verdict) -> Verdict:
    """The one whose premise holds, or else one that has a zone."""
    return max(verdicts, key=lambda v: (v.holds, not np.isnan(v.zone.m)))


def explored(
    known: Known, counts: Sequence[int] = COUNTS, steps: Sequence[int] = STEPS
) -> Explored:
    """One cycle by the solver and by the conditions."""
    half = known.half_cycle
    found = reference(known.case, counts, steps)
    moderate, large = verdict(half, MODERATE), verdict(half, LARGE)
    best = better(moderate, large)
    least = NOWHERE if np.isnan(best.zone.m) else smallest(half, [best.kappa])
    rounds, constant = found.finest.cycle.rounds, at_mean_loads(half)
    return Explored(found.zone, found.error, rounds, half.always, moderate, large, least, constant)


def at_constant_loads(half: HalfCycle) -> tuple[str, Zone]:
    """The regime of a cycle with dQ, dsigma > 0, and its exact zone: from the loads alone.

    Moderate while a + n <= 8 dQ/(pi dsigma), large from m + n = 8 dQ/(pi dsigma) on.
    """
    width = 8 * half.dQ / (np.pi * half.dsigma)
    moderate, large = half.exact(MODERATE), half.exact(LARGE)
    if half.ends[0].a + moderate.n <= width:
        return "moderate", moderate
    if large.m + large.n >= width:
        return "large", large
    return "turns round", turning(half).zone


def at_mean_loads(half: HalfCycle) -> Zone:
    """The exact zone for constant P and M, the means of both ends; NaN where none is found."""
    P, M = (np.mean([getattr(s, name) for s in (half.first, half.second)]) for name in ("P", "M"))
    still = (s._replace(P=float(P), M=float(M)) for s in (half.first, half.second))
    try:
        return at_constant_loads(HalfCycle(half.patch, half.f, *still))[1]
    except NotInWindow:
        return NOWHERE


def window() -> tuple[float, float]:
    """Tensions over the threshold between which slip turns round."""

    def opens(part: float) -> float:
        known = cycle(part * threshold())
        return 1 + known.half_cycle.exact(MODERATE).n - narrowest(known.dsigma)

    def closes(part: float) -> float:
        known = cycle(part * threshold())
        return sum(known.half_cycle.exact(LARGE)) - narrowest(known.dsigma)

    return float(brentq(opens, 0.9, 0.96)), float(brentq(closes, 1.05, 1.12))


def smallest(half: HalfCycle, kappas: Iterable[int] = (MODERATE, LARGE), count: int = 24) -> Zone:
    """The smallest ends of the zones of partial half-cycles, there and back.

    Exact where one half-cycle has its premise and so leaves all of both slip zones at friction: the
    other one then starts as the conditions assume, and goes with them until a zone shrinks.
    """
    parts = np.sin(np.linspace(np.pi / 2, 0, count, endpoint=False)) ** 2
    zones = [
        way.partial(float(part)).exact(kappa)
        for way in (half, half.back())
        for kappa in kappas
        for part in parts
    ]
    kept = [zone for zone in zones if not np.isnan(zone.m)]
    return Zone(*map(float, np.min(kept, axis=0))) if kept else NOWHERE
