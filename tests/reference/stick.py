"""The permanent stick zone, which stays in contact and never slips in the steady cycle.

It is found from the total slip `way`, not from |q| = f p, because a node may return to |q| = f p
without slip.  From the end of the zone, the total slip rises with the power 3/2 of the distance.
The end is therefore located within an element by extrapolating way^(2/3) linearly to zero from the
second and third node that slip; the first one carries most of the error of the mesh.  If nothing
slips on one side, the zone ends where permanent contact ends.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.reference.bounded import Flags
from tests.reference.mesh import Floats

NONE = 1e-9
"""A total slip below this fraction of the largest counts as zero."""


class Zone(NamedTuple):
    """The zone [-m, n]; NaN if all nodes slip."""

    m: float
    n: float


def permanent(x: Floats, way: Floats, always: Zone) -> Zone:
    """The zone from the longest run of nodes that never slip and are always in contact."""
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
    """The end of the zone, near the last node of the run; NaN if it ends with the contact."""
    outward = run[-1] - run[-2]
    sticking, first, second, third = run[-1] + outward * np.arange(4)
    if not touching[first]:
        return np.nan
    near, far = way[second] ** (2 / 3), way[third] ** (2 / 3)
    if not (touching[second] and touching[third] and far > near):
        return float((x[sticking] + x[first]) / 2)
    root = x[second] - near * (x[third] - x[second]) / (far - near)
    return float(np.clip(root, *sorted((x[sticking - outward], x[second]))))
