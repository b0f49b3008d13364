"""Changes in bulk tension at which a cycle is no longer moderate, or one of its slip zones closes.

A row is a1, c1, a2, c2, dQ, f; everything is for E* = 1.
"""

import math
from typing import Any

import numpy as np

from ..kernels import kernel, loop, opened
from ..search import by_distance, narrowed
from .growth import PARTS, advances, grows, load_path
from .moderate import LOAD, TILT, A, C
from .zone import ends_of, exists, resolved, slides

HALVINGS = 52
"""Number of bisections of an interval, enough to reach the last bit of float64."""

STEPS = 100
"""Largest number of steps until a width is found."""


@kernel
def _without_tension(given: Any) -> Any:
    """A cycle without tension from a1, c1, a2, c2, dQ, f, E*."""
    cycle = np.empty(7)
    for i in range(5):
        cycle[i] = given[i]
    cycle[4] /= given[6]
    cycle[5], cycle[6] = 0.0, given[5]
    return cycle


@kernel
def _tensions_at_the_start(ends: Any, cycle: Any) -> Any:
    """The changes in tension between which both edges begin to slip forward."""
    lower, upper = -math.inf, math.inf
    for i in range(2):
        h = ends[i, A] + ends[i, C]
        left, right = advances(ends, h, ends[i, A], ends[i, C])
        lower = max(lower, -8 * (cycle[4] - cycle[6] * abs(left)) / (math.pi * h))
        upper = min(upper, 8 * (cycle[4] - cycle[6] * abs(right)) / (math.pi * h))
    return lower, upper


@kernel
def _cut_down(law: Any, own: Any, path: Any, trial: Any, good: float, bound: float) -> Any:
    """The tension closest to a bound at which moderate slip still grows, as it does at `good`."""
    trial[5] = bound
    if grows(law, own, path, trial):
        return bound
    bad = bound
    for _ in range(HALVINGS):
        trial[5] = (good + bad) / 2
        if trial[5] in (good, bad):
            break
        if grows(law, own, path, trial):
            good = trial[5]
        else:
            bad = trial[5]
    return good


@kernel
def _narrowed(law: Any, own: Any, path: Any, cycle: Any, lower: float, upper: float) -> Any:
    """The interval of tensions reduced to those at which moderate slip grows to the end.

    First a tension inside this interval is sought, from the middle outward.  Then each bound is
    found by bisection.
    """
    trial = cycle.copy()
    for k in range(2 * PARTS - 1):
        offset = (k + 1) // 2 * (1 if k % 2 else -1)
        inside = (lower + upper) / 2 + offset * (upper - lower) / (2 * PARTS)
        trial[5] = inside
        if grows(law, own, path, trial):
            lower = _cut_down(law, own, path, trial, inside, lower)
            return lower, _cut_down(law, own, path, trial, inside, upper)
    return math.nan, math.nan


@kernel
def _keeping(law: Any, own: Any, edge: float, width: float, side: float) -> Any:
    """Load, its derivative with respect to the width, and tilt of a contact whose left or right
    edge is fixed."""
    a, c = (edge, width - edge) if side < 0 else (width - edge, edge)
    load, _, tilt, K_left, K_right = law.state(a, c, own)
    if not load > 0:
        return 0.0, 0.0, math.nan
    return load, math.pi / 4 * math.sqrt(width) * (K_right if side < 0 else K_left), tilt


@kernel
def _width_under(law: Any, own: Any, load: float, edge: float, side: float, width: float) -> Any:
    """Width of the contact under a load with the edge on one side given; NaN if there is none.

    width: the first guess.
    """
    search = by_distance(0.0, math.inf, math.inf, width)
    for _ in range(STEPS):
        width = math.exp(search.y)
        now, rate, _ = _keeping(law, own, edge, width, side)
        search = narrowed(search, now - load, rate * width)
        if search.step == 0:
            return width if search.top < math.inf else math.nan
    return math.nan


@kernel
def _closing(law: Any, own: Any, ends: Any, cycle: Any, side: float) -> Any:
    """The change in tension at which the zone reaches the smaller contact's edge on one side."""
    load = (ends[0, LOAD] + ends[1, LOAD]) / 2 - cycle[4] / (2 * cycle[6])
    if not load > 0:
        return math.nan
    edge = min(ends[0, C], ends[1, C]) if side > 0 else min(ends[0, A], ends[1, A])
    width = max(ends[0, A] + ends[0, C], ends[1, A] + ends[1, C])
    width = _width_under(law, own, load, edge, side, width)
    if not width > 0:
        return math.nan
    now, _, tilt = _keeping(law, own, edge, width, side)
    # next to a kink, rounding error in the position of the other edge changes the tilt: use the
    # missing load to correct it
    tilt += side * 4 * (load - now) / (math.pi * width)
    return 4 * cycle[6] * ((ends[0, TILT] + ends[1, TILT]) / 2 - tilt)


@loop
def each_tension_threshold(law: Any, given: Any, own: Any, out: Any) -> None:
    """The changes in tension between which the moderate solution is exact.

    a1, c1, a2, c2, dQ, f, E* -> lower, upper.
    """
    law = opened(law)
    for i in range(given.shape[0]):
        cycle, body = _without_tension(given[i]), own[i]
        ends = ends_of(law, body, cycle)
        lower = upper = math.nan
        if exists(ends, cycle) and not slides(ends, cycle):
            lower, upper = _tensions_at_the_start(ends, cycle)
        if not lower <= upper:
            lower = upper = math.nan
        elif cycle[0] != cycle[2] or cycle[1] != cycle[3]:
            path = load_path(law, body, ends)
            lower, upper = _narrowed(law, body, path, cycle, lower, upper)
        out[i, 0], out[i, 1] = given[i, 6] * lower, given[i, 6] * upper


@loop
def each_closing_tension(law: Any, given: Any, own: Any, out: Any) -> None:
    """The changes in tension at which one slip zone of the moderate solution closes.

    a1, c1, a2, c2, dQ, f, E* -> lower, upper.
    """
    law = opened(law)
    for i in range(given.shape[0]):
        cycle = _without_tension(given[i])
        ends = ends_of(law, own[i], cycle)
        lower = upper = math.nan
        if exists(ends, cycle) and resolved(ends):
            lower = _closing(law, own[i], ends, cycle, -1.0)
            upper = _closing(law, own[i], ends, cycle, 1.0)
            if lower > upper:  # at any tension the zone is wider than the smaller contact
                lower = upper = math.nan
        out[i, 0], out[i, 1] = given[i, 6] * lower, given[i, 6] * upper
