"""The steady cycle on successively finer meshes, with an estimate of the error.

Each mesh is refined towards the edges of the contacts, the kinks of the body, and the ends of the
stick zone that were found on the mesh before.  On several meshes of the same fineness these points
converge, so that the remaining error is approximately of second order in the element size.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tests.reference.friction import Cycle, Friction
from tests.reference.kernel import Surface
from tests.reference.loads import State
from tests.reference.mesh import Floats, graded
from tests.reference.normal import Body, Contact, press, rough_edges
from tests.reference.stick import Zone, permanent

MARGIN = 0.05
"""Extent of the mesh beyond the contacts, relative to their width."""

PASSES = 4
"""Meshes of the same fineness; each reduces the error of the breaks by a factor of about five."""


@dataclass(frozen=True)
class Case:
    """A body, a coefficient of friction, and the two states between which the loads vary."""

    body: Body
    f: float
    first: State
    second: State


class Level(NamedTuple):
    """Results on one mesh; pressure and shear traction are values at its nodes."""

    x: Floats
    contacts: Sequence[Contact]
    cycle: Cycle
    zone: Zone


class Reference(NamedTuple):
    """The stick zone on the finest mesh, its estimated error, all zones, and the finest level."""

    zone: Zone
    error: Zone
    zones: Sequence[Zone]
    finest: Level


def reference(
    case: Case, counts: Sequence[int] = (16, 32, 64), steps: Sequence[int] = (4, 8, 16)
) -> Reference:
    """The stick zone from levels with these elements between breaks and steps per half-cycle."""
    found = list(levels(case, counts, steps))
    zones = [level.zone for level in found]
    return Reference(zones[-1], estimate(zones, counts), zones, found[-1])


def estimate(zones: Sequence[Zone], counts: Sequence[int]) -> Zone:
    """Estimate of the error: three times the larger extrapolation of the last two changes.

    The extrapolation assumes second order.  If the counts double, the estimate is the larger of the
    last change and a quarter of the one before.

    >>> estimate([Zone(1.0, 1.0), Zone(1.5, 1.25), Zone(1.5625, 1.5)], [8, 16, 32])
    Zone(m=0.125, n=0.25)
    """
    left = 1.0 / np.square(counts)
    changes = np.abs(np.diff(zones, axis=0))[-2:] / -np.diff(left)[-2:, None]
    return Zone(*map(float, 3 * left[-1] * changes.max(axis=0)))


def levels(case: Case, counts: Sequence[int], steps: Sequence[int]) -> Iterator[Level]:
    """The result of the last pass for each count."""
    breaks = [e for s in (case.first, case.second) for e in rough_edges(case.body, s.P, s.M)]
    for count, number in zip(counts, steps, strict=True):
        for _ in range(PASSES):
            found = level(case, Surface(_mesh(case.body, breaks, count)), number)
            breaks = _breaks(found)
        yield found


def level(case: Case, surface: Surface, steps: int) -> Level:
    """The steady cycle on one mesh."""
    contacts: list[Contact] = []
    for number in range(steps + 1):
        P, M, *_ = case.first.towards(case.second, number / steps)
        guess = contacts[-1].places if contacts else None
        contacts.append(press(case.body, surface, P, M, guess))
    cycle = Friction(surface, case.f, case.first, case.second, contacts).cycle()
    way = cycle.there.way + cycle.back.way
    always = Zone(-max(c.left for c in contacts), min(c.right for c in contacts))
    return Level(surface.x, contacts, cycle, permanent(surface.x, way, always))


def _mesh(body: Body, breaks: Sequence[float], count: int) -> Floats:
    left, right = min(breaks), max(breaks)
    margin = MARGIN * (right - left)
    kinks = (k for k in body.kinks if left < k < right)
    return graded([left - margin, *breaks, *kinks, right + margin], count)


def _breaks(found: Level) -> list[float]:
    """Edges at both ends of the half-cycle and at their extremes, and the ends of the zone."""
    lefts = [contact.left for contact in found.contacts]
    rights = [contact.right for contact in found.contacts]
    m, n = found.zone
    places = [lefts[0], lefts[-1], min(lefts), max(lefts), rights[0], rights[-1], min(rights)]
    return [place for place in (*places, max(rights), -m, n) if np.isfinite(place)]
