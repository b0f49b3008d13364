"""Changes in bulk tension at which a cycle is no longer moderate, or one of its slip zones closes."""

import math
from typing import Any

from ..kernels import kernel, loop, opened
from ..search import by_distance, narrowed
from .bounded import slipping, zone_of
from .cycles import Cycle, advances, ends_of, exists, is_steady, resolved, slides
from .growth import grows

INNER_TENSIONS = 15
"""Number of tensions between two bounds at which moderate slip is sought."""

HALVINGS = 52
"""Number of bisections of an interval, enough to reach the last bit of float64."""

MAX_STEPS = 100
"""Largest number of steps until a width is found."""


@kernel
def _under(cycle: Any, dsigma: float) -> Cycle:
    """The cycle with another change in tension."""
    return Cycle(cycle.a_1, cycle.c_1, cycle.a_2, cycle.c_2, cycle.dQ, dsigma, cycle.f)


@kernel
def _without_tension(row: Any) -> Cycle:
    """A cycle from a_1, c_1, a_2, c_2, dQ, f, E*."""
    return Cycle(row[0], row[1], row[2], row[3], row[4] / row[6], 0.0, row[5])


@kernel
def _tensions_at_the_start(cycle: Any, ends: Any) -> Any:
    """The changes in tension between which both edges begin to slip forward."""
    lower, upper = -math.inf, math.inf
    for a, c in ((cycle.a_1, cycle.c_1), (cycle.a_2, cycle.c_2)):
        left, right = advances(ends, a, c)
        unit = 8 / (math.pi * (a + c))
        lower = max(lower, -unit * (cycle.dQ - cycle.f * abs(left)))
        upper = min(upper, unit * (cycle.dQ - cycle.f * abs(right)))
    return lower, upper


@kernel
def _is_moderate(law: Any, own: Any, cycle: Any, ends: Any, dsigma: float) -> bool:
    """Whether forward slip at both edges grows to the end under a change in tension."""
    of = slipping(_under(cycle, dsigma), 1.0, 1.0)
    m, n, _ = zone_of(law, own, of, ends)
    return m + n > 0 and grows(law, own, of, ends, m, n)


@kernel
def _cut_down(law: Any, own: Any, cycle: Any, ends: Any, good: float, bad: float) -> float:
    """The tension closest to `bad` at which slip is still moderate, as it is at `good`."""
    if _is_moderate(law, own, cycle, ends, bad):
        return bad
    for _ in range(HALVINGS):
        middle = (good + bad) / 2
        if middle in (good, bad):
            break
        if _is_moderate(law, own, cycle, ends, middle):
            good = middle
        else:
            bad = middle
    return good


@kernel
def _narrowed(law: Any, own: Any, cycle: Any, ends: Any, lower: float, upper: float) -> Any:
    """The interval of tensions reduced to those at which moderate slip grows to the end.

    First a tension inside this interval is sought, from the middle outward.  Then each bound is
    found by bisection.
    """
    for k in range(INNER_TENSIONS):
        offset = (k + 1) // 2 * (1 if k % 2 else -1)
        inside = (lower + upper) / 2 + offset * (upper - lower) / (INNER_TENSIONS + 1)
        if _is_moderate(law, own, cycle, ends, inside):
            lower = _cut_down(law, own, cycle, ends, inside, lower)
            return lower, _cut_down(law, own, cycle, ends, inside, upper)
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
    for _ in range(MAX_STEPS):
        width = math.exp(search.y)
        now, rate, _ = _keeping(law, own, edge, width, side)
        search = narrowed(search, now - load, rate * width)
        if search.step == 0:
            return width if search.top < math.inf else math.nan
    return math.nan


@kernel
def _closing(law: Any, own: Any, cycle: Any, ends: Any, side: float) -> Any:
    """The change in tension at which the zone reaches the smaller contact's edge on one side."""
    load = (ends.load_1 + ends.load_2) / 2 - cycle.dQ / (2 * cycle.f)
    if not load > 0:
        return math.nan
    edge = min(cycle.c_1, cycle.c_2) if side > 0 else min(cycle.a_1, cycle.a_2)
    width = max(cycle.a_1 + cycle.c_1, cycle.a_2 + cycle.c_2)
    width = _width_under(law, own, load, edge, side, width)
    if not width > 0:
        return math.nan
    now, _, tilt = _keeping(law, own, edge, width, side)
    # next to a kink, rounding error in the position of the other edge changes the tilt: use the
    # missing load to correct it
    tilt += side * 4 * (load - now) / (math.pi * width)
    return 4 * cycle.f * ((ends.tilt_1 + ends.tilt_2) / 2 - tilt)


@loop
def each_tension_threshold(law: Any, given: Any, own: Any, out: Any) -> None:
    """The changes in tension between which the moderate solution is exact.

    a_1, c_1, a_2, c_2, dQ, f, E* -> lower, upper.
    """
    law = opened(law)
    for i in range(given.shape[0]):
        cycle, E_star = _without_tension(given[i]), given[i, 6]
        ends = ends_of(law, own[i], cycle)
        lower = upper = math.nan
        if exists(cycle, ends) and not slides(cycle, ends):
            lower, upper = _tensions_at_the_start(cycle, ends)
        if not lower <= upper:
            lower = upper = math.nan
        elif not is_steady(cycle):
            lower, upper = _narrowed(law, own[i], cycle, ends, lower, upper)
        out[i, 0], out[i, 1] = E_star * lower, E_star * upper


@loop
def each_closing_tension(law: Any, given: Any, own: Any, out: Any) -> None:
    """The changes in tension at which one slip zone of the moderate solution closes.

    a_1, c_1, a_2, c_2, dQ, f, E* -> lower, upper.
    """
    law = opened(law)
    for i in range(given.shape[0]):
        cycle, E_star = _without_tension(given[i]), given[i, 6]
        ends = ends_of(law, own[i], cycle)
        lower = upper = math.nan
        if exists(cycle, ends) and resolved(cycle, ends):
            lower = _closing(law, own[i], cycle, ends, -1.0)
            upper = _closing(law, own[i], cycle, ends, 1.0)
            if lower > upper:  # at any tension the zone is wider than the smaller contact
                lower = upper = math.nan
        out[i, 0], out[i, 1] = E_star * lower, E_star * upper
