r"""The permanent stick zone [-m, n] of a cycle, and how the cycle slips.

Where the surfaces slip in both half-cycles, dq = kappa f (p1 + p2).  With kappa = +1 at both edges
(moderate tension) the zone is the contact at the mean load less dQ/(2 f) and the mean tilt less
dsigma/(4 f E*).  With opposite signs (large tension) it is solved for in large.py.  Either solution
is exact only while both slip zones grow throughout, which growth.py tests.

A cycle is a vector a1, c1, a2, c2, dQ, dsigma, f; everything is for E* = 1.
"""

import math
from typing import Any

import numpy as np

from ..elementary import EPS
from ..kernels import kernel, loop, opened
from ..types import FULL_STICK, LARGE, MIXED, MODERATE, NONE, SLIDING, UNSOLVED
from .bounded import drives, oriented, sense_of
from .growth import (
    grows,
    grows_apart,
    holds_at_the_start,
    load_path,
    mirrored,
    narrowest,
    slips_at_the_start,
    sticks_all_over,
)
from .large import EXACT, large_slip
from .moderate import LOAD, MOMENT, TILT, A, C, patch

LEAST_RESOLVED = 1e-6
"""Largest shift of an edge due to rounding of the tilt, relative to the width."""


@kernel
def over_modulus(row: Any) -> Any:
    """A cycle from a1, c1, a2, c2, dQ, dsigma, f, E*."""
    cycle = row[:7].copy()
    cycle[4], cycle[5] = row[4] / row[7], row[5] / row[7]
    return cycle


@kernel
def ends_of(law: Any, own: Any, cycle: Any) -> Any:
    """Both contacts, with columns a, c, tilt, load, moment."""
    ends = np.empty((2, 5))
    for i in range(2):
        a, c = cycle[2 * i], cycle[2 * i + 1]
        load, moment, tilt, _, _ = law.state(a, c, own)
        ends[i, A], ends[i, C], ends[i, TILT] = a, c, tilt
        ends[i, LOAD], ends[i, MOMENT] = load, moment
    return ends


@kernel
def exists(ends: Any, cycle: Any) -> Any:
    """Whether both contacts exist and the changes in the loads and the friction are valid."""
    for i in range(2):
        if not (math.isfinite(ends[i, LOAD]) and math.isfinite(ends[i, TILT])):
            return False
    return cycle[6] > 0 and math.isfinite(cycle[5]) and 0 <= cycle[4] < math.inf


@kernel
def slides(ends: Any, cycle: Any) -> Any:
    """Whether nothing sticks."""
    return not cycle[4] < cycle[6] * (ends[0, LOAD] + ends[1, LOAD])


@kernel
def resolved(ends: Any) -> Any:
    """Whether the tilts determine the edges.

    They do not if a flank makes up nearly all of the contact while a corner carries the load.  At a
    given load the last digit of the tilt moves an edge by about EPS tilt h**2/(2 P).
    """
    for i in range(2):
        width, load = ends[i, A] + ends[i, C], ends[i, LOAD]
        if EPS * abs(ends[i, TILT]) * width > LEAST_RESOLVED * load:
            return False
    return True


@kernel
def _large(law: Any, own: Any, path: Any, cycle: Any) -> Any:
    """Slip in opposite directions, forward at the edge that tension loads more; otherwise MIXED."""
    sense, cycle = sense_of(cycle), oriented(cycle)
    path = path if sense > 0 else mirrored(path)
    if slips_at_the_start(path, cycle, -1.0):
        slip = large_slip(law, own, cycle, sense, EXACT)
        m, n = slip.m, slip.n
        if math.isnan(m):
            return m, n, UNSOLVED
        if (
            drives(cycle[4], cycle[5], m + n)[1] <= 0
            and holds_at_the_start(path, cycle, m, n)
            and (path.shape[0] == 2 or grows_apart(law, own, path, cycle, sense, m, n))
        ):
            return (m, n, LARGE) if sense > 0 else (n, m, LARGE)
    return math.nan, math.nan, MIXED


@kernel
def _overtaken(law: Any, own: Any, path: Any, cycle: Any) -> Any:
    """m and n where slip reverses temporarily at constant loads without a lasting effect.

    Tension a little beyond its threshold reverses slip at one edge, say the right one.  The shear
    there has been at the friction limit since the last half-cycle.  The reversed slip, dq = 0,
    extends at once to the point where the drive vanishes, a + n0 = 8 dQ/(pi dsigma), and sticks
    again as soon as the left zone grows.  Forward slip as under moderate tension then comes in
    beyond n0 and overtakes the reversed slip.
    """
    m, n = patch(law, own, path, 0, 1, 1.0, cycle)
    whole = cycle[1] + m if cycle[5] < 0 else cycle[0] + n
    if m <= cycle[0] and n <= cycle[1] and drives(cycle[4], abs(cycle[5]), whole)[1] >= 0:
        return m, n
    return math.nan, math.nan


@kernel
def stick_zone(law: Any, own: Any, cycle: Any) -> Any:
    """m, n and the regime; for mixed cycles only where forward slip overtakes the reversed slip."""
    ends = ends_of(law, own, cycle)
    if not exists(ends, cycle):
        return math.nan, math.nan, NONE
    if slides(ends, cycle):
        return math.nan, math.nan, SLIDING
    if not resolved(ends):
        return math.nan, math.nan, UNSOLVED
    path = load_path(law, own, ends)
    last = path.shape[0] - 1
    steady = last == 1
    if sticks_all_over(path, cycle):
        m, n = narrowest(law, own, ends)
        if m + n > 0:
            return m, n, FULL_STICK
    if slips_at_the_start(path, cycle, 1.0) and (steady or grows(law, own, path, cycle)):
        m, n = patch(law, own, path, 0, last, 1.0, cycle)
        if m + n > 0:
            return m, n, MODERATE
    m, n, regime = _large(law, own, path, cycle)
    if regime != MIXED or not steady:
        return m, n, regime
    m, n = _overtaken(law, own, path, cycle)
    return m, n, MIXED


@loop
def each_stick_zone(law: Any, given: Any, own: Any, out: Any) -> None:
    """a1, c1, a2, c2, dQ, dsigma, f, E* -> m, n, regime."""
    law = opened(law)
    for i in range(given.shape[0]):
        cycle = over_modulus(given[i])
        out[i, 0], out[i, 1], out[i, 2] = stick_zone(law, own[i], cycle)
