"""The permanent stick zone: what stays in contact and never slips in a whole steady cycle.

What tells is the way that was slipped, not |q| = f p, which a node may come back to at rest.
The way rises from the end of the zone like the power 3/2 of the distance, so way^(2/3), drawn to
zero from the second and the third node that slip, puts the end within an element; the first one
carries most of the mesh's error.  Where nothing slips the zone ends with what touches always.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.reference.bounded import Flags
from tests.reference.mesh import Floats

NONE = 1e-9
"""A way, over the longest one, that is none."""


class Zone(NamedTuple):
    """[-m, n]; NaN where all slips."""

    m: float
    n: float


def permanent(x: Floats, way: Floats, always: Zone) -> Zone:
    """The longest run of nodes that never slip inside what touches always."""
    touching = (x > -always.m) & (x < always.n)
    run = _longest(x, touching & (way <= NONE * way.max()))
    if len(run) < 2:
        return Zone(np.nan, np.nan)
    left, right = (_end(x, way, touching, nodes) for nodes in (run[::-1], run))
    return Zone(-left if np.isfinite(left) else always.m, right if np.isfinite(right) else always.n)


def _longest(x: Floats, inside: Flags) -> NDArray[np.intp]:
    nodes = np.flatnonzero(inside)
    runs = np.split(nodes, np.flatnonzero(np.diff(nodes) > 1) + 1)
    return max(runs, key=lambda run: np.ptp(x[run]) if len(run) else -1.0)


def _end(x: Floats, way: Floats, touching: Flags, run: NDArray[np.intp]) -> float:
    """Where the run ends, close to its last node and the next; NaN if it ends with the contact."""
    outward = run[-1] - run[-2]
    sticking, first, second, third = run[-1] + outward * np.arange(4)
    if not touching[first]:
        return np.nan
    near, far = way[second] ** (2 / 3), way[third] ** (2 / 3)
    if not (touching[second] and touching[third] and far > near):
        return float((x[sticking] + x[first]) / 2)
    root = x[second] - near * (x[third] - x[second]) / (far - near)
    return float(np.clip(root, *sorted((x[sticking - outward], x[second]))))
