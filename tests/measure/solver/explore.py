"""Cases without a known solution: loads around the threshold, and varying moment.

All cycles are those of the upright wedge g = phi |x|, with E* = phi = 1, P = 1, f = 1/2 and
dQ = 0.3 f P.
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
"""Tensions at constant normal loads, relative to the threshold in the paper."""

MEANS = (0.0, 0.1)
RANGES = (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
TENSIONS = (0.5, 1.2, 1.5, 2.0, 3.0, 5.0, 7.0)
"""The map of varying moment: mean and range of M relative to P^2/(E* phi), and tensions relative to
the threshold."""

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
"""The map around the threshold: ranges of P with mean 1 and of M with mean 0, and tensions."""

COUNTS, STEPS = (16, 32, 64), (8, 16, 32)
"""Elements between breaks, and load steps per half-cycle."""


def threshold(dQ: float = DQ, f: float = F) -> float:
    """The threshold in the paper: n in moderate tension is c = 1 (upright wedge, P = E* = phi = 1).

    At load P' and tilt alpha = phi (1 - 2 theta/pi) the wedge reaches c = P' tan(theta/2); with
    P' = 1 - dQ/(2 f), alpha = -dsigma/(4 f):  dsigma = 4 f ((4/pi) arctan(1/P') - 1).
    """
    return float(4 * f * (4 / np.pi * np.arctan(1 / (1 - dQ / (2 * f))) - 1))


def cycle(
    dsigma: float, M: tuple[float, float] = (0.0, 0.0), P: tuple[float, float] = (1.0, 1.0)
) -> Known:
    """One of the cycles; the direction of slip on the right is not known yet."""
    return Known("", WEDGE, LARGE, DQ, dsigma, P, M, F)


class Point(NamedTuple):
    """One cycle of a map: tension over threshold, mean and range of M, range of P with mean 1."""

    tension: float
    mean: float
    span: float
    load: float = 0.0

    @property
    def cycle(self) -> Known:
        """The cycle with all its loads."""
        M = self.mean - self.span / 2, self.mean + self.span / 2
        return cycle(self.tension * threshold(), M, (1 - self.load / 2, 1 + self.load / 2))


VARYING_MOMENT = [Point(part, mean, span) for mean in MEANS for span in RANGES for part in TENSIONS]
AROUND = [Point(part, 0.0, span, load) for load, span in LOAD_RANGES for part in NEAR]
"""The cycles of both maps."""


def narrowest(dsigma: float) -> float:
    """Width of a stick zone at whose right end q stays bounded: dQ/pi = (dsigma/4) width/2."""
    return 8 * DQ / (np.pi * dsigma)


class Verdict(NamedTuple):
    """The conditions in one regime: their zone, and the premise in both half-cycles."""

    kappa: int
    zone: Zone
    there: Premise
    back: Premise

    @property
    def holds(self) -> bool:
        """Whether the premise holds in both half-cycles."""
        return self.there is self.back is Premise.HOLDS


def verdict(half: HalfCycle, kappa: int) -> Verdict:
    """The verdict on one regime, from the loads alone."""
    zone = half.exact(kappa)
    return Verdict(kappa, zone, premise(half, kappa, zone), premise(half.back(), kappa, zone))


class Kind(Enum):
    """The kind of a cycle, from the loads or, if they do not determine it, from the solver."""

    HOLDS = "holds"
    SHRINKS = "a slip zone shrinks"
    BEYOND = "shear beyond friction"
    AHEAD = "an edge runs ahead"
    STICKS = "sticks"
    OPEN = "no zone"


@dataclass(frozen=True)
class Explored:
    """One cycle: the result of the solver, and the conditions of both regimes.

    always     the zone that is always in contact
    smallest   the smallest m and n of partial half-cycles in the better regime
    constant   the exact zone for P and M that are constant at their means
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
        """The regime whose premise holds, otherwise one that has a zone."""
        return better(self.moderate, self.large)

    @property
    def kind(self) -> Kind:
        """The kind from the premise or, if there is no zone, from the ends of the solver's zone."""
        said = {self.best.there, self.best.back}
        if Premise.NO_ZONE in said:
            ends = np.abs(np.subtract(self.zone, self.always)) <= self.error
            return Kind.STICKS if ends.all() else Kind.AHEAD if ends.any() else Kind.OPEN
        if Premise.BEYOND in said:
            return Kind.BEYOND
        return Kind.SHRINKS if Premise.SHRINKS in said else Kind.HOLDS

    def off(self, zone: Zone) -> float:
        """The difference between a zone and the solver's zone, at the worse end."""
        return float(np.abs(np.subtract(zone, self.zone)).max())

    @property
    def estimate(self) -> float:
        """The solver's estimate of its own error, at the worse end."""
        return max(self.error)


def better(*verdicts: Verdict) -> Verdict:
    """The verdict whose premise holds, otherwise one that has a zone."""
    return max(verdicts, key=lambda v: (v.holds, not np.isnan(v.zone.m)))


def explored(
    known: Known, counts: Sequence[int] = COUNTS, steps: Sequence[int] = STEPS
) -> Explored:
    """One cycle, by the solver and by the conditions."""
    half = known.half_cycle
    found = reference(known.case, counts, steps)
    moderate, large = verdict(half, MODERATE), verdict(half, LARGE)
    best = better(moderate, large)
    least = NOWHERE if np.isnan(best.zone.m) else smallest(half, [best.kappa])
    rounds, constant = found.finest.cycle.rounds, at_mean_loads(half)
    return Explored(found.zone, found.error, rounds, half.always, moderate, large, least, constant)


def at_constant_loads(half: HalfCycle) -> tuple[str, Zone]:
    """The regime and the exact zone of a cycle with dQ, dsigma > 0, from the loads alone.

    It is moderate if a + n <= 8 dQ/(pi dsigma), and large if m + n >= 8 dQ/(pi dsigma).  Otherwise
    slip on the right reverses within the half-cycle ("turns round").
    """
    width = 8 * half.dQ / (np.pi * half.dsigma)
    moderate, large = half.exact(MODERATE), half.exact(LARGE)
    if half.ends[0].a + moderate.n <= width:
        return "moderate", moderate
    if large.m + large.n >= width:
        return "large", large
    return "turns round", turning(half).zone


def at_mean_loads(half: HalfCycle) -> Zone:
    """The exact zone for P and M that are constant at their means; NaN if none is found."""
    P, M = (np.mean([getattr(s, name) for s in (half.first, half.second)]) for name in ("P", "M"))
    still = (s._replace(P=float(P), M=float(M)) for s in (half.first, half.second))
    try:
        return at_constant_loads(HalfCycle(half.patch, half.f, *still))[1]
    except NotInWindow:
        return NOWHERE


def window() -> tuple[float, float]:
    """Tensions, relative to the threshold, between which slip reverses within the half-cycle."""

    def opens(part: float) -> float:
        known = cycle(part * threshold())
        return 1 + known.half_cycle.exact(MODERATE).n - narrowest(known.dsigma)

    def closes(part: float) -> float:
        known = cycle(part * threshold())
        return sum(known.half_cycle.exact(LARGE)) - narrowest(known.dsigma)

    return float(brentq(opens, 0.9, 0.96)), float(brentq(closes, 1.05, 1.12))


def smallest(half: HalfCycle, kappas: Iterable[int] = (MODERATE, LARGE), count: int = 24) -> Zone:
    """The smallest m and n of the zones of partial half-cycles, in both directions.

    They are exact if the premise holds in one half-cycle.  At its end |q| = f p in all of both slip
    zones, so that the other half-cycle starts as the conditions assume, and satisfies them until a
    zone shrinks.
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
