r"""Step by step along a path: shear, slip, friction's work, and what sticks.

All is for E* = 1.  The state is a matrix, a column an element: shear, bound f p, place (0 where it
sticks, 1 and -1 where it slips forward and back or does not touch), slip forward since the start.
"""

import math
from typing import Any

import numpy as np

from ..kernels import LAW, kernel, matrix, real, results, vector, whole
from .elements import (
    COSINE,
    EVEN,
    PLACE,
    add_full_stick,
    expand,
    mean_pressures,
    mesh,
    pressure_at,
)
from .nearest import nearest
from .path import SIGMA, A, C, P, Q

SHEAR, BOUND, PLACES, SLIP, SLIPPED = range(5)
"""Rows of the state; the last one is the slip of the last step."""

NONE, SLIDING, FULL_STICK, UNSOLVED, COMPUTED = 0.0, 4.0, 5.0, 6.0, 9.0
"""Codes of Regime."""

QUIET, FINE, FLAT = 1e-3, 8.0, 0.03
"""Slip that may be none, over the most in a step, and less on a mesh of more elements than 250; the
part of a slip zone that may slip so little."""

ROUNDING = 1e-12
"""A load that is nearer to sliding slides; a step whose loads change by less is none."""


@kernel(vector(LAW, vector, matrix, whole, vector))
def mesh_for(law: Any, own: Any, rows: Any, count: int, fronts: Any) -> Any:
    """Elements for a path: more of them where edges move, crowded towards edges, kinks and
    `fronts`, the places where stick intervals are known to end."""
    left = right = -math.inf
    inner_left = inner_right = math.inf
    for i in range(rows.shape[0]):
        if rows[i, A] + rows[i, C] > 0:
            left, right = max(left, rows[i, A]), max(right, rows[i, C])
            inner_left, inner_right = min(inner_left, rows[i, A]), min(inner_right, rows[i, C])
    h, core = left + right, inner_left + inner_right
    breaks = law.breaks(own)
    parts = np.zeros((5 + breaks.size + fronts.size, 4))
    parts[0] = np.array([EVEN, -left, right, 0.3 * count])
    parts[1] = np.array([COSINE, -left, right, 0.2 * count])
    parts[2] = parts[1]
    if core > 0.05 * h:
        parts[2] = np.array([COSINE, -inner_left, inner_right, 0.5 * count])
        for k in range(2):
            way = left - inner_left if k == 0 else right - inner_right
            start = -left if k == 0 else inner_right
            parts[3 + k] = np.array([EVEN, start, start + way, 0.7 * count * way / h])
    for k in range(breaks.size + fronts.size):
        place = breaks[k] if k < breaks.size else fronts[k - breaks.size]
        share = 0.12 if k < breaks.size else 1.0 / max(fronts.size, 4)
        if -left < place < right:
            reach = 0.1 * h
            parts[5 + k] = np.array([PLACE, place - reach, place + reach, share * count])
    return mesh(parts, -left, right, breaks, count)


# ---------------------------------------------------------------- what sticks


@kernel(real(vector, matrix, whole, whole, real))
def _end(x: Any, state: Any, last: int, side: int, edge: float) -> float:
    """Where a stick interval ends, close to its last element: f p - |q| rises from there like a
    root."""
    following = last + side
    if not 0 <= following < x.size or state[BOUND, following] == 0:
        return edge
    sense = state[PLACES, following]
    near, far = last - 2 * side, last - 4 * side
    end = (x[last] + x[following]) / 2
    if 0 <= far < x.size and state[PLACES, near] == 0 and state[PLACES, far] == 0:
        g = (state[BOUND, near] - sense * state[SHEAR, near]) ** 2
        G = (state[BOUND, far] - sense * state[SHEAR, far]) ** 2
        if g < G:
            end = x[near] + (x[near] - x[far]) * g / (G - g)
    low, high = min(x[last], x[following]), max(x[last], x[following])
    end = min(max(end, low), high)
    return min(end, edge) if side > 0 else max(end, edge)


@kernel(whole(vector, matrix, whole, whole, real, real))
def _inward(x: Any, state: Any, last: int, side: int, edge: float, least: float) -> int:
    """The last element of a stick interval: behind those that do slip, though by next to nothing,
    unless there are so many that shear has come back to its old extreme there."""
    i = last
    while state[PLACES, i] != 0 and state[PLACES, i - side] == state[PLACES, i]:
        i -= side
    if state[PLACES, i] != 0:
        i -= side
    few = abs(x[last] - x[i]) <= FLAT * max(abs(edge - x[last]), abs(x[last] - x[last - side]))
    return i if few and abs(state[SLIPPED, i]) <= least else last


@kernel(results(4)(vector, matrix, real, real))
def sticking(x: Any, state: Any, a: float, c: float) -> Any:
    """m, n, the number of stick intervals, and the number of elements that slip.

    An element that sticks alone is no interval, unless there is no other.
    """
    first, last, runs, slips, length, lone = -1, -1, 0, 0, 0, -1
    quiet, least = min(QUIET, (FINE / x.size) ** 2), 0.0
    for i in range(x.size):
        least = max(least, quiet * abs(state[SLIPPED, i]))
    for i in range(x.size):
        slips += state[BOUND, i] > 0 and state[PLACES, i] != 0
        if state[BOUND, i] == 0 or (state[PLACES, i] != 0 and abs(state[SLIPPED, i]) > least):
            length = 0
            continue
        length, lone = length + 1, i
        if length == 2:
            runs += 1
            first = i - 1 if first < 0 else first
        if length >= 2:
            last = i
    if lone < 0:
        return math.nan, math.nan, 0.0, float(slips)
    if first < 0:
        first, last, runs = lone, lone, 1
    else:
        first = _inward(x, state, first, -1, -a, least)
        last = _inward(x, state, last, 1, c, least)
    m, n = -_end(x, state, first, -1, -a), _end(x, state, last, 1, c)
    return m, n, float(runs), float(slips)


@kernel(results(2)(LAW, vector, vector, real, vector, vector, matrix, vector, real))
def at_place(
    law: Any,
    own: Any,
    series: Any,
    f: float,
    ends: Any,
    x: Any,
    state: Any,
    row: Any,
    place: float,
) -> Any:
    """Shear and slip at a place; slip is NaN where the bodies never touch."""
    if math.isnan(place):
        return math.nan, math.nan
    if not ends[0] <= place <= ends[x.size]:
        return 0.0, math.nan
    i: Any = max(np.searchsorted(ends, place) - 1, 0)
    j = min(max(i if place > x[i] else i - 1, 0), x.size - 2)
    t = (place - x[j]) / (x[j + 1] - x[j])
    t = min(max(t, 0.0), 1.0)
    slip = (1 - t) * state[SLIP, j] + t * state[SLIP, j + 1]
    bound = f * pressure_at(law, own, series, place, row[A], row[C])
    if not bound > 0:
        return 0.0, slip
    if state[PLACES, i] != 0 and state[BOUND, i] > 0:
        return state[PLACES, i] * bound, slip
    q = (1 - t) * state[SHEAR, j] + t * state[SHEAR, j + 1]
    return min(max(q, -bound), bound), slip


# ---------------------------------------------------------------- steps


@kernel(real(vector, vector, vector, vector, matrix))
def _slid(w: Any, bound: Any, q: Any, s: Any, state: Any) -> float:
    """Add the slip of a step to the state, and tell friction's work in it; bound, q: before it.

    What the edge leaves behind counts, too, and so does what it covers while it still is outside:
    the mean of f p over a step is not half the sum of both ends where an edge passes, but over all
    places these differences add up to nothing, since f P goes straight.
    """
    work = 0.0
    for i in range(w.size):
        state[SLIPPED, i] = 0.0
        if state[BOUND, i] > 0 and state[PLACES, i] != 0:
            state[SLIPPED, i] = -2 * s[i]
            state[SLIP, i] += state[SLIPPED, i]
            work += w[i] * (bound[i] + state[BOUND, i]) / 2 * abs(state[SLIPPED, i])
        elif bound[i] > 0 and state[BOUND, i] == 0:
            work -= w[i] * q[i] * s[i]
    return work


@kernel(whole(vector, matrix, whole))
def _guessed(old: Any, state: Any, afresh: int) -> int:
    """Places of what has come into contact: as at the edge before, or sticking all over."""
    place = 0.0
    for k in range(2 * old.size):
        i = k if k < old.size else 2 * old.size - 1 - k
        if old[i] > 0 and not afresh:
            place = state[PLACES, i]
        elif state[BOUND, i] > 0 and (k >= old.size or place != 0 or afresh):
            state[PLACES, i] = place
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
    """One row of the path on: the regime, and friction's work; NaN where slip is not known.

    `series` is that of the pressure, kept until the contact changes.
    """
    count = ends.size - 1
    w = ends[1:] - ends[:-1]
    if not now[A] + now[C] > 0:
        state[SHEAR], state[BOUND], state[PLACES], state[SLIPPED] = 0.0, 0.0, 1.0, 0.0
        return NONE, 0.0
    afresh = not before[A] + before[C] > 0
    old = state[BOUND].copy()
    if afresh or before[A] != now[A] or before[C] != now[C] or not old.any():
        expand(law, own, now[A], now[C], series)
        mean_pressures(law, own, series, ends, now[A], now[C], now[P], state[BOUND])
        state[BOUND] *= f
    if abs(now[Q]) >= f * now[P] * (1 - ROUNDING):
        sense = math.copysign(1.0, now[Q])
        for i in range(count):
            state[SHEAR, i], state[PLACES, i] = sense * state[BOUND, i], sense
        return SLIDING, math.nan
    held, trial = state[SHEAR].copy(), state[SHEAR].copy()
    s, given = np.empty(count), np.empty(1)
    given[0] = now[Q]
    if afresh:
        trial[:] = 0.0
        add_full_stick(ends, now[A : C + 1], now[A : C + 1], now[Q], 0.0, trial)
    else:
        add_full_stick(
            ends,
            before[A : C + 1],
            now[A : C + 1],
            now[Q] - before[Q],
            now[SIGMA] - before[SIGMA],
            trial,
        )
    _guessed(old, state, afresh)
    if not nearest(A_, B, z, w, trial, state[BOUND], given, state[PLACES], state[SHEAR], s, room):
        return UNSOLVED, math.nan
    return COMPUTED, _slid(w, old, held, s, state)
