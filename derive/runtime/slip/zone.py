r"""The permanent stick zone [-m, n] of a cycle, and how the cycle slips.

Where slip happens in both half-cycles dq = kappa f (p1 + p2).  With kappa = +1 at both edges
(moderate tension) the zone is the contact at the mean load less dQ/(2 f) and the mean tilt less
dsigma/(4 f E*).  With opposite signs (large tension) it is solved for in large.py.  Either is exact
only while both slip zones grow all the way, growth.py.

A cycle is a vector a1, c1, a2, c2, dQ, dsigma, f; everything is for E* = 1.
"""

import math
from typing import Any

import numpy as np

from ..kernels import LAW, LOOP, kernel, matrix, opened, real, results, truth, vector
from .bounded import seen, sense_of
from .growth import (
    PARTS,
    followed,
    grows,
    grows_apart,
    holds_at_the_start,
    leads,
    mirrored,
    slips_at_the_start,
    sticks_all_over,
)
from .large import EXACT, large_slip
from .mixed import turned_round
from .moderate import LOAD, MOMENT, TILT, A, C, closing, patch

NONE, MODERATE, LARGE, MIXED, SLIDING, FULL_STICK, UNSOLVED = (float(code) for code in range(7))
"""Codes of Regime."""

HALVINGS = 52
"""Halvings of an interval: to the last bit of float64."""


@kernel(matrix(LAW, vector, vector))
def ends_of(law: Any, own: Any, cycle: Any) -> Any:
    """Both contacts: a, c, tilt, load, moment."""
    ends = np.empty((2, 5))
    for i in range(2):
        a, c = cycle[2 * i], cycle[2 * i + 1]
        load, moment, tilt, _, _ = law.state(a, c, own)
        ends[i, A], ends[i, C], ends[i, TILT] = a, c, tilt
        ends[i, LOAD], ends[i, MOMENT] = load, moment
    return ends


@kernel(truth(matrix, vector))
def _exists(ends: Any, cycle: Any) -> Any:
    """Whether there is such a cycle."""
    for i in range(2):
        if not (math.isfinite(ends[i, LOAD]) and math.isfinite(ends[i, TILT])):
            return False
    return cycle[6] > 0 and math.isfinite(cycle[5]) and 0 <= cycle[4] < math.inf


@kernel(truth(matrix, vector))
def _slides(ends: Any, cycle: Any) -> Any:
    """Whether nothing sticks."""
    return not cycle[4] < cycle[6] * (ends[0, LOAD] + ends[1, LOAD])


@kernel(results(3)(LAW, vector, matrix, vector))
def _large(law: Any, own: Any, way: Any, cycle: Any) -> Any:
    """Slip to opposite sides, forward at the edge that tension loads more; else MIXED."""
    sense, cycle = sense_of(cycle), seen(cycle)
    way = way if sense > 0 else mirrored(way)
    if slips_at_the_start(way, cycle, -1.0):
        slip = large_slip(law, own, cycle, sense, EXACT)
        m, n = slip.m, slip.n
        if math.isnan(m):
            return m, n, UNSOLVED
        if (
            math.pi * (m + n) * cycle[5] / 8 >= cycle[4]
            and holds_at_the_start(way, cycle, m, n)
            and (way.shape[0] == 2 or grows_apart(law, own, way, cycle, sense, m, n))
        ):
            return (m, n, LARGE) if sense > 0 else (n, m, LARGE)
    return math.nan, math.nan, MIXED


@kernel(results(2)(LAW, vector, matrix, vector))
def _overtaken(law: Any, own: Any, way: Any, cycle: Any) -> Any:
    """m and n where slip reverses for a while at constant loads, but leaves nothing behind.

    Tension a little beyond its threshold turns slip round at one edge, say the right one.  Shear is
    at friction there already, since the last half-cycle ended so; what slips back, dq = 0, reaches
    at once as far as pull = 0, to a + n0 = 8 dQ/(pi dsigma), and sticks again at once as the left
    zone grows.  Slip that then comes in forward as under moderate tension, beyond n0, overtakes it.
    """
    m, n = patch(law, own, way, 0, 1, 1.0, cycle)
    whole = cycle[1] + m if cycle[5] < 0 else cycle[0] + n
    if m <= cycle[0] and n <= cycle[1] and math.pi * abs(cycle[5]) * whole <= 8 * cycle[4]:
        return m, n
    return math.nan, math.nan


@kernel(results(3)(LAW, vector, vector))
def stick_zone(law: Any, own: Any, cycle: Any) -> Any:
    """m, n and the regime; of mixed cycles where forward slip overtakes in the end."""
    ends = ends_of(law, own, cycle)
    if not _exists(ends, cycle):
        return math.nan, math.nan, NONE
    if _slides(ends, cycle):
        return math.nan, math.nan, SLIDING
    way = followed(law, own, ends)
    last = way.shape[0] - 1
    steady = last == 1
    if sticks_all_over(way, cycle):
        m, n = way[0, A], way[0, C]
        for k in range(1, last + 1):
            m, n = min(m, way[k, A]), min(n, way[k, C])
        if m + n > 0:
            return m, n, FULL_STICK
    if slips_at_the_start(way, cycle, 1.0) and (steady or grows(law, own, way, cycle)):
        m, n = patch(law, own, way, 0, last, 1.0, cycle)
        if m + n > 0:
            return m, n, MODERATE
    m, n, regime = _large(law, own, way, cycle)
    if regime != MIXED or not steady:
        return m, n, regime
    m, n = _overtaken(law, own, way, cycle)
    return m, n, MIXED


@kernel(LOOP)
def each_stick_zone(law: Any, given: Any, own: Any, out: Any) -> None:
    """given: a1, c1, a2, c2, dQ, dsigma, f, mixed; out: m, n, regime."""
    law = opened(law)
    for i in range(given.shape[0]):
        cycle, body = given[i], own[i]
        m, n, regime = stick_zone(law, body, cycle)
        steady = cycle[0] == cycle[2] and cycle[1] == cycle[3]
        if regime == MIXED and math.isnan(m) and steady and cycle[7] > 0:
            m, n = turned_round(law, body, ends_of(law, body, cycle), cycle)
            regime = UNSOLVED if math.isnan(m) else MIXED
        out[i, 0], out[i, 1], out[i, 2] = m, n, regime


# ---------------------------------------------------------------- thresholds


@kernel(vector(vector))
def _without_tension(given: Any) -> Any:
    """A cycle from a1, c1, a2, c2, dQ, f."""
    cycle = np.empty(7)
    for i in range(5):
        cycle[i] = given[i]
    cycle[5], cycle[6] = 0.0, given[5]
    return cycle


@kernel(results(2)(matrix, vector))
def _tensions_at_the_start(ends: Any, cycle: Any) -> Any:
    """Between which changes of tension both edges begin to slip forward."""
    lower, upper = -math.inf, math.inf
    for i in range(2):
        h = ends[i, A] + ends[i, C]
        left, right = leads(ends, h, ends[i, A], ends[i, C])
        lower = max(lower, -8 * (cycle[4] - cycle[6] * abs(left)) / (math.pi * h))
        upper = min(upper, 8 * (cycle[4] - cycle[6] * abs(right)) / (math.pi * h))
    return lower, upper


@kernel(real(LAW, vector, matrix, vector, real, real))
def _cut_down(law: Any, own: Any, way: Any, tried: Any, good: float, bound: float) -> Any:
    """The tension next to a bound up to which moderate slip goes on; it does so under `good`."""
    tried[5] = bound
    if grows(law, own, way, tried):
        return bound
    bad = bound
    for _ in range(HALVINGS):
        tried[5] = (good + bad) / 2
        if tried[5] in (good, bad):
            break
        if grows(law, own, way, tried):
            good = tried[5]
        else:
            bad = tried[5]
    return good


@kernel(results(2)(LAW, vector, matrix, vector, real, real))
def _narrowed(law: Any, own: Any, way: Any, cycle: Any, lower: float, upper: float) -> Any:
    """The interval of tensions cut down to where moderate slip goes on to the end.

    A tension that is inside is looked for first, from the middle on, then each bound by halving.
    """
    tried = cycle.copy()
    for k in range(2 * PARTS - 1):
        away = (k + 1) // 2 * (1 if k % 2 else -1)
        inside = (lower + upper) / 2 + away * (upper - lower) / (2 * PARTS)
        tried[5] = inside
        if grows(law, own, way, tried):
            lower = _cut_down(law, own, way, tried, inside, lower)
            return lower, _cut_down(law, own, way, tried, inside, upper)
    return math.nan, math.nan


@kernel(LOOP)
def each_tension_threshold(law: Any, given: Any, own: Any, out: Any) -> None:
    """The changes of tension between which the moderate solution is exact.

    given: a1, c1, a2, c2, dQ, f; out: lower, upper.
    """
    law = opened(law)
    for i in range(given.shape[0]):
        cycle, body = _without_tension(given[i]), own[i]
        ends = ends_of(law, body, cycle)
        lower = upper = math.nan
        if _exists(ends, cycle) and not _slides(ends, cycle):
            lower, upper = _tensions_at_the_start(ends, cycle)
        if not lower <= upper:
            lower = upper = math.nan
        elif cycle[0] != cycle[2] or cycle[1] != cycle[3]:
            way = followed(law, body, ends)
            lower, upper = _narrowed(law, body, way, cycle, lower, upper)
        out[i, 0], out[i, 1] = lower, upper


@kernel(LOOP)
def each_closing_tension(law: Any, given: Any, own: Any, out: Any) -> None:
    """given: a1, c1, a2, c2, dQ, f; out: lower, upper."""
    law = opened(law)
    for i in range(given.shape[0]):
        cycle = _without_tension(given[i])
        ends = ends_of(law, own[i], cycle)
        out[i, 0] = out[i, 1] = math.nan
        if _exists(ends, cycle):
            out[i, 0] = closing(law, own[i], ends, cycle, -1.0)
            out[i, 1] = closing(law, own[i], ends, cycle, 1.0)
