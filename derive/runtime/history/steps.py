r"""Load steps along a path: shear traction, slip, frictional work, and the stick zone.

E* = 1 throughout.  The state is a matrix with one column per element.  Its rows are the shear
traction, the bound f p, the status (0: sticks; 1 and -1: slips forward and backward, or is not in
contact), the forward slip since the start, and the forward slip and the frictional work per length
in the last step.
"""

import math
from typing import Any

import numpy as np

from ..kernels import LAW, kernel, matrix, real, results, truth, vector, whole
from ..types import COMPUTED, NONE, SLIDING, UNSOLVED
from .elements import (
    CENTRED,
    COSINE,
    EVEN,
    add_full_stick,
    expand,
    mean_pressures,
    mesh,
    pressure_at,
)
from .nearest import nearest
from .path import SIGMA, A, C, P, Q

SHEAR, BOUND, STATUS, SLIP, SLIP_OF_STEP, WORK_OF_STEP = range(6)
"""Rows of the state."""

OUTSIDE = 0.1
"""An element of which no larger part is outside the contact counts as in contact."""

KINK, JUMP = 1.0, 2.0
"""What slip does where an edge of the contact turns, and where it rests."""

QUIET, FINE, FLAT = 1e-3, 8.0, 0.03
"""Slip in a step below the fraction QUIET of the largest may be spurious; on meshes of more than
about 250 elements, the limit is (FINE/elements)**2.  Elements that slip so little may take up at
most the fraction FLAT of a slip zone."""

ROUNDING = 1e-12
"""The contact slides if |Q| is below f P by less than this fraction of f P."""


@kernel(vector(LAW, vector, matrix, whole, vector, vector))
def mesh_for(law: Any, own: Any, rows: Any, count: int, stick_ends: Any, edges: Any) -> Any:
    """A mesh for a path: finer where edges move, and refined towards edges, kinks and `stick_ends`.

    stick_ends: points where stick intervals end, as far as they are known.
    edges: points where slip has jumps or kinks; elements end there.
    """
    left = right = -math.inf
    inner_left = inner_right = math.inf
    for i in range(rows.shape[0]):
        if rows[i, A] + rows[i, C] > 0:
            left, right = max(left, rows[i, A]), max(right, rows[i, C])
            inner_left, inner_right = min(inner_left, rows[i, A]), min(inner_right, rows[i, C])
    h, core = left + right, inner_left + inner_right
    breaks = law.breaks(own)
    parts = np.zeros((5 + breaks.size + stick_ends.size, 4))
    parts[0] = np.array([EVEN, -left, right, 0.3 * count])
    parts[1] = np.array([COSINE, -left, right, 0.2 * count])
    parts[2] = parts[1]
    if core > 0.05 * h:
        parts[2] = np.array([COSINE, -inner_left, inner_right, 0.5 * count])
        for k in range(2):
            width = left - inner_left if k == 0 else right - inner_right
            start = -left if k == 0 else inner_right
            parts[3 + k] = np.array([EVEN, start, start + width, 0.7 * count * width / h])
    for k in range(breaks.size + stick_ends.size):
        centre = breaks[k] if k < breaks.size else stick_ends[k - breaks.size]
        share = 0.12 if k < breaks.size else 1.0 / max(stick_ends.size, 4)
        if -left < centre < right:
            reach = 0.1 * h
            parts[5 + k] = np.array([CENTRED, centre - reach, centre + reach, share * count])
    return mesh(parts, -left, right, np.concatenate((breaks, edges)), count)


# ---------------------------------------------------------------- stick zone


@kernel(real(vector, matrix, whole, whole, real))
def _end(x: Any, state: Any, last: int, side: int, edge: float) -> float:
    """The end of a stick interval, near its last element.

    It is extrapolated from the rise of f p - |q|, which grows like the square root of the distance
    from the end.
    """
    following = last + side
    if not 0 <= following < x.size or state[BOUND, following] == 0:
        return edge
    sign = state[STATUS, following]
    near, far = last - 2 * side, last - 4 * side
    end = (x[last] + x[following]) / 2
    if 0 <= far < x.size and state[STATUS, near] == 0 and state[STATUS, far] == 0:
        g = (state[BOUND, near] - sign * state[SHEAR, near]) ** 2
        G = (state[BOUND, far] - sign * state[SHEAR, far]) ** 2
        if g < G:
            end = x[near] + (x[near] - x[far]) * g / (G - g)
    low, high = min(x[last], x[following]), max(x[last], x[following])
    end = min(max(end, low), high)
    return min(end, edge) if side > 0 else max(end, edge)


@kernel(whole(vector, matrix, whole, whole, real, real))
def _inward(x: Any, state: Any, last: int, side: int, edge: float, least: float) -> int:
    """The last element of a stick interval, without outer elements that slip by very little.

    If there are many of these elements, they belong to the interval: the shear traction has
    returned to its earlier extreme there.
    """
    i = last
    while state[STATUS, i] != 0 and state[STATUS, i - side] == state[STATUS, i]:
        i -= side
    if state[STATUS, i] != 0:
        i -= side
    narrow = abs(x[last] - x[i]) <= FLAT * max(abs(edge - x[last]), abs(x[last] - x[last - side]))
    return i if narrow and abs(state[SLIP_OF_STEP, i]) <= least else last


@kernel(real(vector, matrix, whole, whole, real))
def _doubtful(x: Any, state: Any, last: int, side: int, edge: float) -> float:
    """Length of the slip next to an edge that a stick interval reaches, if it may be real."""
    following, i = last + side, last
    if 0 <= following < x.size and state[BOUND, following] > 0:
        return 0.0
    while 0 <= i - side < x.size and state[STATUS, i] != 0 and state[BOUND, i] > 0:
        i -= side
    return 0.0 if i == last else abs(edge - (x[i] + x[i + side]) / 2)


@kernel(results(5)(vector, matrix, real, real, truth))
def sticking(x: Any, state: Any, a: float, c: float, fresh: bool) -> Any:
    """m, n, the number of stick intervals and of elements that slip, and an error of m and n.

    The error is the length over which slip at an edge is so small that it may be spurious.

    A single element that sticks counts as an interval only if no interval is longer.

    fresh: whether the loads have only risen from zero, so that all slip is real.
    """
    first, last, intervals, slips, length, single = -1, -1, 0, 0, 0, -1
    quiet, least = 0.0 if fresh else min(QUIET, (FINE / x.size) ** 2), 0.0
    for i in range(x.size):
        least = max(least, quiet * abs(state[SLIP_OF_STEP, i]))
    for i in range(x.size):
        slips += state[BOUND, i] > 0 and state[STATUS, i] != 0
        if state[BOUND, i] == 0 or (state[STATUS, i] != 0 and abs(state[SLIP_OF_STEP, i]) > least):
            length = 0
            continue
        length, single = length + 1, i
        if length == 2:
            intervals += 1
            first = i - 1 if first < 0 else first
        if length >= 2:
            last = i
    if single < 0:
        return math.nan, math.nan, 0.0, float(slips), 0.0
    if first < 0:
        first, last, intervals = single, single, 1
    else:
        first = _inward(x, state, first, -1, -a, least)
        last = _inward(x, state, last, 1, c, least)
    m, n = -_end(x, state, first, -1, -a), _end(x, state, last, 1, c)
    doubt = max(_doubtful(x, state, first, -1, -a), _doubtful(x, state, last, 1, c))
    return m, n, float(intervals), float(slips), doubt


@kernel(real(vector, vector, real))
def interpolated(x: Any, values: Any, point: float) -> float:
    """Values at the midpoints x of the elements, interpolated at a point; constant beyond them."""
    j = min(max(np.searchsorted(x, point) - 1, 0), x.size - 2)
    t = min(max((point - x[j]) / (x[j + 1] - x[j]), 0.0), 1.0)
    return (1 - t) * values[j] + t * values[j + 1]


@kernel(real(vector, vector, vector, vector, real))
def value_at(ends: Any, x: Any, bends: Any, values: Any, point: float) -> float:
    """Values at a point, from its element and a neighbour on the same side of any jump or kink.

    bends: JUMP or KINK at the ends of elements, otherwise 0.  If there is no such neighbour, one
    beyond a kink is taken, and otherwise none.
    """
    k: Any = min(max(np.searchsorted(ends, point) - 1, 0), x.size - 1)
    toward = 1 if point > x[k] else -1
    for most in (0.0, KINK):
        for side in (toward, -toward):
            if bends[k + (side + 1) // 2] <= most:
                slope = (values[k + side] - values[k]) / (x[k + side] - x[k])
                return values[k] + slope * (point - x[k])
    return values[k]


@kernel(results(2)(LAW, vector, vector, real, vector, vector, matrix, vector, vector, real))
def at_point(
    law: Any,
    own: Any,
    series: Any,
    f: float,
    ends: Any,
    x: Any,
    state: Any,
    bends: Any,
    row: Any,
    point: float,
) -> Any:
    """Shear traction and slip at a point; slip is NaN where the bodies are never in contact."""
    if math.isnan(point):
        return math.nan, math.nan
    if not ends[0] <= point <= ends[x.size]:
        return 0.0, math.nan
    slip = value_at(ends, x, bends, state[SLIP], point)
    bound = f * pressure_at(law, own, series, point, row[A], row[C])
    if not bound > 0:
        return 0.0, slip
    i: Any = max(np.searchsorted(ends, point) - 1, 0)
    if state[STATUS, i] != 0 and state[BOUND, i] > 0:
        return state[STATUS, i] * bound, slip
    return min(max(interpolated(x, state[SHEAR], point), -bound), bound), slip


# ---------------------------------------------------------------- steps


@kernel(real(real, vector, vector))
def _part_in_contact(x: float, before: Any, now: Any) -> float:
    """The fraction of a step during which x is in contact.

    before, now: a and c, which vary linearly.
    """
    enters, leaves = not -before[0] < x < before[1], not -now[0] < x < now[1]
    if enters == leaves:
        return 0.0 if enters else 1.0
    outside, inside = (before, now) if enters else (now, before)
    side, at = (0, -x) if x <= -outside[0] else (1, x)
    return (inside[side] - at) / (inside[side] - outside[side])


@kernel(real(vector, vector, vector, vector, vector, vector, vector, matrix))
def _add_slip(
    ends: Any, w: Any, before: Any, now: Any, bound: Any, q: Any, s: Any, state: Any
) -> float:
    """Add the slip of a step to the state, and return the frictional work of the step.

    before, now: a and c; bound, q: their values before the step.

    Where the edge passes, s is not slip, because surfaces apart move too.  Elements slip there like
    the nearest one that is in contact throughout, for the time of their contact.

    The work includes elements that the contact reaches or leaves in this step.  Where an edge
    passes, the mean of f p over the step is not the mean of its values before and after it.  The
    sum of these differences over all elements is zero, because f P varies linearly.
    """
    work, first, last = 0.0, w.size, -1
    for i in range(w.size):
        state[SLIP_OF_STEP, i] = state[WORK_OF_STEP, i] = 0.0
        if state[BOUND, i] > 0 and state[STATUS, i] != 0:
            state[SLIP_OF_STEP, i] = -2 * s[i]
            state[WORK_OF_STEP, i] = (bound[i] + state[BOUND, i]) * abs(s[i])
        elif bound[i] > 0 and state[BOUND, i] == 0:
            state[WORK_OF_STEP, i] = -q[i] * s[i]
        work += w[i] * state[WORK_OF_STEP, i]
        outside = max(-ends[i] - min(before[0], now[0]), ends[i + 1] - min(before[1], now[1]))
        if outside <= OUTSIDE * w[i]:
            first, last = min(first, i), i
    for i in range(w.size):
        if last >= 0 and not first <= i <= last:
            slips = state[BOUND, i] == 0 or state[STATUS, i] != 0
            x = (ends[i] + ends[i + 1]) / 2
            part = _part_in_contact(x, before, now) if slips else 0.0
            state[SLIP_OF_STEP, i] = part * state[SLIP_OF_STEP, first if i < first else last]
        state[SLIP, i] += state[SLIP_OF_STEP, i]
    return work


@kernel(whole(vector, matrix, whole))
def _guess_status(old: Any, state: Any, new_contact: int) -> int:
    """Guess the status of new elements in the contact: that of the last element at the edge.

    In a new contact all elements are assumed to stick.
    """
    status = 0.0
    for k in range(2 * old.size):
        i = k if k < old.size else 2 * old.size - 1 - k
        if old[i] > 0 and not new_contact:
            status = state[STATUS, i]
        elif state[BOUND, i] > 0 and (k >= old.size or status != 0 or new_contact):
            state[STATUS, i] = status
    return 1


@kernel(
    results(2)(
        LAW, vector, vector, real, vector, vector, vector, matrix, matrix, vector, matrix, matrix
    )
)
def step(
    law: Any,
    own: Any,
    series: Any,
    f: float,
    ends: Any,
    before: Any,
    now: Any,
    A_: Any,
    B: Any,
    z: Any,
    state: Any,
    room: Any,
) -> Any:
    """Advance the state by one row of the path; return the regime and the frictional work.

    The work is NaN where slip is not known.

    series: coefficients of the series of the pressure, kept until the contact changes.
    """
    count = ends.size - 1
    w = ends[1:] - ends[:-1]
    if not now[A] + now[C] > 0:
        state[SHEAR], state[BOUND], state[STATUS], state[SLIP_OF_STEP] = 0.0, 0.0, 1.0, 0.0
        return NONE, 0.0
    new_contact = not before[A] + before[C] > 0
    old = state[BOUND].copy()
    if new_contact or before[A] != now[A] or before[C] != now[C] or not old.any():
        expand(law, own, now[A], now[C], series)
        mean_pressures(law, own, series, ends, now[A], now[C], now[P], state[BOUND])
        state[BOUND] *= f
    if abs(now[Q]) >= f * now[P] * (1 - ROUNDING):
        sign = math.copysign(1.0, now[Q])
        for i in range(count):
            state[SHEAR, i], state[STATUS, i] = sign * state[BOUND, i], sign
        return SLIDING, math.nan
    q_before, trial = state[SHEAR].copy(), state[SHEAR].copy()
    s, given = np.empty(count), np.empty(1)
    given[0] = now[Q]
    if new_contact:
        # P and Q have grown from zero in proportion, and every point has stuck since its contact
        trial[:] = state[BOUND] * (now[Q] / (f * now[P]))
    else:
        add_full_stick(
            ends,
            before[A : C + 1],
            now[A : C + 1],
            now[Q] - before[Q],
            now[SIGMA] - before[SIGMA],
            trial,
        )
    _guess_status(old, state, new_contact)
    if not nearest(A_, B, z, w, trial, state[BOUND], given, state[STATUS], state[SHEAR], s, room):
        return UNSOLVED, math.nan
    return COMPUTED, _add_slip(ends, w, before[A : C + 1], now[A : C + 1], old, q_before, s, state)
