"""The contact under given loads.

When an edge of the contact of any convex body moves, the pressure changes by that of a flat punch.
For E* = 1, with mid = (c - a)/2,

    dP = (pi sqrt(h)/4) (K_left da + K_right dc),
    dM = -(pi sqrt(h)/4) (K_left (mid - h/4) da + K_right (mid + h/4) dc),
    d alpha = (K_left da - K_right dc)/sqrt(h).

Newton's method therefore needs no derivatives other than K_N.  Three facts follow: the load grows
with both edges; its centre, -M/P, moves to the right with c and to the left with a; the tilt grows
with a and falls with c.  Any contact that is tried therefore bounds one edge of the one sought:

    load too small, centre too far left or tilt too large:   c is larger
    load too small, centre too far right or tilt too small:  a is larger
    load too large, centre too far right or tilt too small:  c is smaller
    load too large, centre too far left or tilt too large:   a is smaller

Newton's method is kept between these bounds.  `place` is a point that is known to lie in the
contact: the centre of the load if the moment is given, otherwise the point where the tilted body is
level.  Steps are taken in the logarithms of the distances of the edges from the last break inside
them, or from the place.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from .elementary import EPS, LEAST, MOST
from .kernels import kernel

MAX_STEPS = 100
"""Largest number of steps of a search."""

LONGEST_STEP = 4.0
"""Longest step in the logarithm of a distance."""

WORST_RTOL = 1e-9
"""A contact is rejected if its error is above this."""

MAX_LOAD_ROUNDING = 1e-4
"""No contact is returned if rounding of its edges changes the load by more than this fraction."""

MAX_EDGE_ROUNDING = 1e-2
"""No contact is returned if rounding of its place or tilt moves an edge by more than this fraction
of the width."""


class Target(NamedTuple):
    """The target of the search for a contact, for E* = 1.

    load     load to be carried
    place    a point in the contact: the centre of the load unless the tilt is prescribed
    tilt     tilt of the body if it is prescribed
    held     whether the tilt is prescribed
    """

    load: float
    place: float
    tilt: float
    held: bool


# ---------------------------------------------------------------- one contact and its target


@kernel
def _misses(slope: Any, own: Any, target: Any, a: float, c: float, now: Any) -> Any:
    """How far a contact is from its target: two numbers that grow with c.  With a the first one
    grows, and the second one falls.

    The first number is the logarithm of the load over the target load.  The second one belongs to
    the other condition: a distance relative to h/4, or a tilt in a unit that makes it comparable
    with a change in the logarithm of the load.  Where the state is not known, only their signs mean
    anything.  [-a, c] carries at most h/4 times the difference of the slopes at its ends, and
    nothing if the body is straight there; the centre is then that of a slight, even curvature.
    Beyond the body, and where numbers are too large, the steeper end is taken to be too far out.
    """
    load, moment, tilt, _, _ = now
    h, mid = a + c, (c - a) / 2
    first = math.log(load / target.load) if load > 0 else math.inf
    if target.held:
        second = math.pi / 4 * (target.tilt - tilt) * h / load
    else:
        second = 4 * (-moment / load - target.place) / h
    if load > 0 and abs(second) < math.inf:
        return first, second
    left, right = slope(-a, own)[0], slope(np.nextafter(c, -math.inf), own)[0]
    if not load > 0 and h * (right - left) / 4 < target.load:
        return -math.inf, mid - target.place
    return first, left + right


@kernel
def _step(target: Any, a: float, c: float, now: Any, first: float, second: float) -> Any:
    """Newton's step for a and c."""
    load, moment, _, left, right = now
    h, mid = a + c, (c - a) / 2
    force = 4 * load / (math.pi * math.sqrt(h))
    both = -force * first  # K_left da + K_right dc
    odd = -force * second  # K_right dc - K_left da
    if not target.held:
        odd -= 4 * both * (mid + moment / load) / h
    return (both - odd) / 2 / left, (both + odd) / 2 / right


@kernel
def _load_rounding(a: float, c: float, now: Any) -> float:
    """The fraction of the load by which rounding of the edges changes it."""
    load, _, _, left, right = now
    return math.pi / 4 * EPS * math.sqrt(a + c) * (left * abs(a) + right * abs(c)) / load


@kernel
def _checked(slope: Any, own: Any, target: Any, a: float, c: float, now: Any) -> Any:
    """The error of a contact apart from rounding, and its tilt, which is NaN if not determined.

    Rounding of the edges changes the load; rounding of the given place or tilt moves the edges.
    """
    load, moment, tilt, left, right = now
    h = a + c
    first, second = _misses(slope, own, target, a, c, now)
    exists = LEAST < h < MOST and abs(moment) < math.inf
    if not (exists and 0 < left < math.inf and 0 < right < math.inf):
        return math.inf, math.nan
    edges = _load_rounding(a, c, now)
    given = EPS * (abs(target.tilt) * h / load if target.held else abs(target.place) / h)
    error = max(abs(first) - 16 * edges, (abs(second) - 16 * (edges + given)) / 16, 0.0)
    if edges > MAX_LOAD_ROUNDING or given > MAX_EDGE_ROUNDING:
        tilt = math.nan
    return error, tilt


# ---------------------------------------------------------------- steps between bounds


@kernel
def _reach(edge: float, start: float) -> float:
    """The distance of an edge from `start`, but not less than its rounding."""
    return max(edge - start, EPS * abs(start), LEAST)


@kernel
def _moved(edge: float, by: float, start: float, end: float, low: float, high: float) -> float:
    """The edge after a step in the logarithm of its distance from `start`, kept between bounds.

    A step beyond `start` or `end` ends there, so that the edge can cross a break.  A step beyond a
    bound, or an infinite one, goes half of the way to the bound.
    """
    if edge + by <= start and start > low:
        return start
    distance = _reach(edge, start)
    moved = start + distance * math.exp(min(max(by / distance, -LONGEST_STEP), LONGEST_STEP))
    if moved > end and end < high:
        return end
    if abs(by) < math.inf and low <= moved <= high:
        return moved
    halfway = math.log(_reach(high if by > 0 else low, start) / distance) / 2
    return start + distance * math.exp(min(max(halfway, -LONGEST_STEP), LONGEST_STEP))


@kernel
def _level(slope: Any, own: Any, breaks: Any, alpha: float) -> float:
    """The point where the tilted body is level, g'(x) + alpha = 0; NaN if there is none.

    It is a corner if the tilt lies between the slopes there, and the middle of a flat.
    """
    if not abs(alpha) < math.inf:
        return math.nan
    before, beyond = -MOST, MOST  # the body falls left of `before`, rises from `beyond` on
    for at in breaks:
        if slope(np.nextafter(at, -math.inf), own)[0] + alpha <= 0:
            before = at
        if beyond == MOST and slope(at, own)[0] + alpha >= 0:
            beyond = at
    if before >= beyond:
        return (before + beyond) / 2
    if before < 0 < beyond:
        excess = slope(0.0, own)[0] + alpha
        if excess == 0:
            return 0.0
        if excess < 0:
            before = 0.0
        else:
            beyond = 0.0
    # the root is sought from one end of the interval, to the right or to the left
    side, start, high = (1.0, before, beyond) if before > -MOST else (-1.0, -beyond, -before)
    if high == MOST and side * (slope(side * high, own)[0] + alpha) < 0:
        return math.nan
    low, step = start, math.inf
    x = start + min((high - start) / 2, abs(start) if start != 0 else 1.0)
    for _ in range(MAX_STEPS):
        now, curvature = slope(side * x, own)
        value, rounding = side * (now + alpha), 2 * EPS * max(abs(x), x - start)
        by = -value / curvature if 0 < curvature < math.inf else math.inf
        if value < 0:
            low = x
        else:
            high = x
        if value == 0 or high - low <= rounding:
            break
        if abs(by) <= rounding:  # at the root, or next to a point where the slope is infinite
            beyond = slope(side * (x + math.copysign(4 * rounding, by)), own)[0] + alpha
            if (side * beyond < 0) != (value < 0):
                break
            step = 0.0
        if not abs(by) <= step / 2:
            by = math.inf if value < 0 else -math.inf
        last, x = x, _moved(x, by, start, high, low, high)
        step = abs(x - last)
    return side * x


# ---------------------------------------------------------------- the contact


@kernel
def _first_width(slope: Any, own: Any, target: Any) -> float:
    """The width of the first contact, which is centred at the place, to within a factor of two.

    A contact carries nearly h/4 times the difference of the slopes at its ends: all of it if the
    slope changes at the centre, and pi/4 of it if the slope changes evenly.
    """
    low, high, h = 0.0, MOST, target.load
    for _ in range(MAX_STEPS):
        left, right = slope(target.place - h / 2, own)[0], slope(target.place + h / 2, own)[0]
        if h * (right - left) / 4 < target.load:
            low, by = h, math.inf
        else:
            high, by = h, -math.inf
        h = _moved(h, by, 0.0, high, low, high)
        if high < 4 * low:
            break
    return h


@kernel
def _piece(edge: float, inner: float, breaks: Any, side: float) -> Any:
    """The last break inside an edge, or the point `inner`, and the next break beyond the edge.

    Positions are counted outward: c with side 1, a with side -1.
    """
    start, end = inner, MOST
    for at in breaks:
        if start < side * at < edge:
            start = side * at
        if edge < side * at < end:
            end = side * at
    return start, end


@kernel
def _last(edge: float, by: float, rounding: float, reach: float, breaks: Any, side: float) -> float:
    """An edge after the last step, which is nothing but rounding; NaN if there are more to come.

    The next step is the square of this one, relative to the distance over which K_N changes: to the
    closest break on either side, where the curvature may be infinite, but at most `reach`.  An edge
    at a break stays there, because K_N may jump.

    rounding: how far rounding of the load moves this edge.
    """
    room = reach
    for at in breaks:
        room = min(room, abs(side * at - edge))
    if not abs(by) <= math.sqrt(EPS) * room + rounding:
        return math.nan
    return edge + by if abs(by) < room else edge


@kernel
def _found(state: Any, slope: Any, own: Any, breaks: Any, target: Any) -> Any:
    """The contact by Newton's method between bounds, or the closest one that it reached.

    Newton's step is taken if the last step has at least halved the error.  Otherwise the edge whose
    bound is new goes half of the way to its other bound.
    """
    low_a, high_a, low_c, high_c = -target.place, MOST, target.place, MOST
    h, error = _first_width(slope, own, target), math.inf
    a, c = low_a + h / 2, low_c + h / 2
    for _ in range(MAX_STEPS):
        now = state(a, c, own)
        first, second = _misses(slope, own, target, a, c, now)
        by_a, by_c = _step(target, a, c, now, first, second)
        from_a, to_a = _piece(a, -target.place, breaks, -1.0)
        from_c, to_c = _piece(c, target.place, breaks, 1.0)
        reach_a, reach_c = _reach(a, from_a), _reach(c, from_c)
        length = max(abs(by_a) / reach_a, abs(by_c) / reach_c)
        error, last = math.hypot(first, second), error
        rounding = 4 * (EPS + _load_rounding(a, c, now))
        if error < math.sqrt(EPS) + rounding:
            load, _, _, left, right = now
            give = rounding * load / math.sqrt(a + c)
            last_a = _last(a, by_a, give / left, reach_a, breaks, -1.0)
            last_c = _last(c, by_c, give / right, reach_c, breaks, 1.0)
            if last_a + last_c < math.inf:
                return last_a, last_c
        outward, on_right = first < 0, (first < 0) == (second < 0)
        if on_right and outward:
            low_c = c
        elif on_right:
            high_c = c
        elif outward:
            low_a = a
        else:
            high_a = a
        if not (length < math.inf and error <= last / 2):
            by = math.inf if outward else -math.inf
            by_a, by_c = (0.0, by) if on_right else (by, 0.0)
        a = _moved(a, by_a, from_a, to_a, low_a, high_a)
        c = _moved(c, by_c, from_c, to_c, low_c, high_c)
    return a, c


def solve(
    state: Any, slope: Any, breaks: Any, own: Any, load: float, given: float, held: bool
) -> Any:
    """The edges a, c and the tilt under a load; NaN if there is no contact.

    Part of every `Law`, so that numba compiles it once and not again in each kernel that calls it.

    state, slope, breaks  those of the law
    given                 the centre of the load; the tilt if `held`
    """
    points = breaks(own)
    place, tilt = (_level(slope, own, points, given), given) if held else (given, 0.0)
    if 0 < load < math.inf and abs(place) < MOST:
        target = Target(load, place, tilt, held)
        a, c = _found(state, slope, own, points, target)
        error, tilt = _checked(slope, own, target, a, c, state(a, c, own))
        if error < WORST_RTOL and abs(tilt) < math.inf:
            return a, c, tilt
    return math.nan, math.nan, math.nan


@kernel
def contact(law: Any, own: Any, P: float, M: float) -> Any:
    """The edges a, c and the tilt under a load and a moment; NaN if there is no contact."""
    if not 0 < P < math.inf:
        return math.nan, math.nan, math.nan
    return law.solve(law.state, law.slope, law.breaks, own, P, -M / P, False)


@kernel
def contact_at_tilt(law: Any, own: Any, P: float, alpha: float) -> Any:
    """The edges a, c under a load at a given tilt; NaN if there is no contact."""
    a, c, _ = law.solve(law.state, law.slope, law.breaks, own, P, alpha, True)
    return a, c
