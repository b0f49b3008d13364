"""The steady cycle on finer and finer meshes, and how far off it still is.

Each mesh is graded to the edges of the contacts, to the body's kinks, and to the ends of the stick
zone that the mesh before it found.  Several meshes of one fineness bring these places to rest, so
that the error that is left falls about with the square of the fineness.
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
"""Mesh beyond the contacts, over their width."""

PASSES = 4
"""Meshes of one fineness: each brings breaks about five times closer to where they rest."""


@dataclass(frozen=True)
class Case:
    """A body, its coefficient of friction, and the two states between which the loads go."""

    body: Body
    f: float
    first: State
    second: State


class Level(NamedTuple):
    """What one mesh gives: contacts and shear are those of its nodes."""

    x: Floats
    contacts: Sequence[Contact]
    cycle: Cycle
    zone: Zone


class Reference(NamedTuple):
    """The stick zone of the finest mesh, the estimate of its error, and the zones before it."""

    zone: Zone
    error: Zone
    zones: Sequence[Zone]
    finest: Level


def reference(
    case: Case, counts: Sequence[int] = (16, 32, 64), steps: Sequence[int] = (4, 8, 16)
) -> Reference:
    """Levels of so many elements between two breaks, and so many load steps a half-cycle."""
    found = list(levels(case, counts, steps))
    zones = [level.zone for level in found]
    return Reference(zones[-1], estimate(zones, counts), zones, found[-1])


def estimate(zones: Sequence[Zone], counts: Sequence[int]) -> Zone:
    """Three times what second order makes of the last two changes, of whichever it is more.

    Where the counts double that is the last change, or a quarter of the one before.

    >>> estimate([Zone(1.0, 1.0), Zone(1.5, 1.25), Zone(1.5625, 1.5)], [8, 16, 32])
    Zone(m=0.125, n=0.25)
    """
    left = 1.0 / np.square(counts)
    changes = np.abs(np.diff(zones, axis=0))[-2:] / -np.diff(left)[-2:, None]
    return Zone(*map(float, 3 * left[-1] * changes.max(axis=0)))


def levels(case: Case, counts: Sequence[int], steps: Sequence[int]) -> Iterator[Level]:
    """The last of the passes for each count."""
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
    """The edges at both ends of the half-cycle and at their farthest, and the zone's ends."""
    lefts = [contact.left for contact in found.contacts]
    rights = [contact.right for contact in found.contacts]
    m, n = found.zone
    places = [lefts[0], lefts[-1], min(lefts), max(lefts), rights[0], rights[-1], min(rights)]
    return [place for place in (*places, max(rights), -m, n) if np.isfinite(place)]
