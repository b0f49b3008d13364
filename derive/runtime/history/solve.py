r"""Histories and steady cycles on successively finer meshes, and the estimate of their error.

Each mesh has twice as many elements as the one before, and is refined towards the ends of the stick
zone that were found on it.  The refinement stops when two meshes agree to the tolerance, and the
results of the last mesh are returned.  The estimated error is the difference between the last two
meshes, which exceeds the error of the last one.  For m and n half an element is added, because
a stick-slip boundary lies between two elements.  The estimated error of the frictional work is the
sum of the differences between the last two meshes, in a cycle over the elements, in a history over
the instants and times a factor.  A factor also applies to slip, where the largest difference
counts, and to the shear traction of a cycle.
"""

import math
from typing import Any

import numpy as np

from ..inverse import contact
from ..kernels import LAW, LOOP, kernel, matrix, opened, real, results, truth, vector, whole
from ..shared import shared
from ..slip.growth import narrowest
from ..types import COMPUTED, FEATURES, FULL_STICK, NO_STICK, NONE, SLIDING, UNSOLVED, ZONE
from .elements import TERMS, influence, inverse_of
from .path import INSTANT, SIGMA, A, C, M, P, Q, notable_edges, path
from .steps import (
    BOUND,
    JUMP,
    KINK,
    SHEAR,
    SLIP,
    SLIP_OF_STEP,
    WORK_OF_STEP,
    at_point,
    mesh_for,
    step,
    sticking,
    value_at,
)

TOTAL, RANGE, ALWAYS, FIRST_SHEAR, DENSITY = range(5)
"""Rows of the results of a cycle on the elements."""

FEWEST = 64
"""Elements of the first mesh.  On a mesh with k times as many, at least k steps are taken from one
instant to the next, and in a history at least k**2/8."""

REACH = 3.84
"""Largest motion of an edge in a step, relative to the contact width, times the number of
elements."""

LAST = 0.01
"""Length of the last step before an instant relative to the others.  The stick zone of the instant
is that of this step; a slip zone that shrinks is longer in earlier steps."""

EACH = 16
"""Smallest number of elements of a mesh for each point towards which it is refined."""

DISTINCT = 1e-4
"""Edges of resting contacts closer together than this fraction of the width count as one."""

APART = 3.0
"""Stick-slip boundaries closer together than this times `tol` count as one in the refinement."""

CAUTION, WORK = 2.0, 3.0
"""Factors on differences between two meshes, which are small by chance on some; WORK is that on the
work of a history."""

MOST_ROUNDS = 100
"""Largest number of repetitions of a cycle."""

REPEATED = 1e-6
"""A cycle has settled if slip changes by less than this fraction of the largest slip."""

SPURIOUS, THRESHOLD, WIDE = 5e-4, 1e-4, 3e-3
"""Slip in a cycle below the fraction THRESHOLD of the largest counts as zero, or on meshes of fewer
than ENOUGH elements below SPURIOUS.  The fraction WIDE is also tried."""

ENOUGH = 512

NOTICED = 0.01
"""The extrapolated slip is used if it widens the stick zone by more than this fraction of the
width."""

RISEN = 4.0
"""The end of the stick zone is extrapolated from slip at two points.  This is the smallest ratio of
the slip at the outer one to that at the inner one."""


@kernel(vector(matrix, vector))
def _inverse_times(B: Any, w: Any) -> Any:
    """z = A^-1 w; B is the inverse of A."""
    z = np.zeros(w.size)
    for j in range(w.size):
        for i in range(w.size):
            z[i] += B[j, i] * w[j]
    return z


@kernel(real(vector, real, real, real, real))
def _mesh_error(ends: Any, m: float, n: float, a: float, c: float) -> float:
    """Error of m and n because they lie between elements: half an element.

    It is a whole element if m or n is at an edge, because the mesh does not resolve a slip zone
    within the element at the edge.
    """
    error = 0.0
    for side in range(2):
        end, edge = (-m, -a) if side == 0 else (n, c)
        if math.isfinite(end):
            i = min(max(np.searchsorted(ends, end) - 1, 0), ends.size - 2)
            error = max(error, (1.0 if end == edge else 0.5) * (ends[i + 1] - ends[i]))
    return error


@kernel(whole(real))
def _finest(tol: float) -> int:
    """Number of elements of the finest mesh."""
    return 256 if tol >= 1e-3 else 512 if tol >= 1e-4 else 1024


@kernel(vector(vector, real, real, whole))
def _thinned(points: Any, size: float, distance: float, most: int) -> Any:
    """At most `most` of the points, sorted, with gaps of more than `distance` times `size`.

    The distance is doubled as long as there are too many points.
    """
    left = np.sort(points[np.isfinite(points)])
    while True:
        kept = 0
        for x in left:
            if kept == 0 or x - left[kept - 1] > distance * size:
                left[kept] = x
                kept += 1
        left = left[:kept].copy()
        if kept <= most:
            return left
        distance *= 2


@shared
def _discretised(law: Any, own: Any, rows: Any, count: int, stick_ends: Any) -> Any:
    """A mesh for a path: element ends, where slip has jumps or kinks, A, its inverse, z, and two
    arrays for the steps to use.
    """
    widest = np.nanmax(rows[:, A] + rows[:, C])
    rests = _thinned(notable_edges(rows, True), widest, DISTINCT, count // EACH)
    turns = _thinned(notable_edges(rows, False), widest, DISTINCT, count // EACH)
    edges = np.concatenate((rests, turns))
    ends, bends = mesh_for(law, own, rows, count, stick_ends, edges), np.zeros(count + 1)
    for k in range(edges.size):
        i = min(np.searchsorted(ends, edges[k]), count)
        if ends[i] == edges[k]:
            bends[i] = max(bends[i], JUMP if k < rests.size else KINK)
    bends[0] = bends[count] = JUMP
    A_ = influence(ends)
    B = inverse_of(A_)
    z = _inverse_times(B, ends[1:] - ends[:-1])
    return ends, bends, A_, B, z, np.zeros((count + 1, count)), np.zeros((6, count))


@kernel(truth(vector, vector))
def _move(row: Any, last: Any) -> bool:
    """Whether the loads change between two rows of a path."""
    for i in range(4):  # noqa: SIM110 - numba compiles no `any` over a generator
        if row[i] != last[i]:
            return True
    return False


@kernel(real(whole, real, whole))
def _completed(count: int, part: float, finest: int) -> float:
    """The completed fraction of the work on all meshes, when a part of that on one mesh is done."""
    return ((count**2 - FEWEST**2) / 3 + part * count**2) / ((4 * finest**2 - FEWEST**2) / 3)


@shared
def history_on_mesh(
    law: Any,
    own: Any,
    f: float,
    loads: Any,
    points: Any,
    count: int,
    stick_ends: Any,
    finest: int,
    progress: Any,
) -> Any:
    """A history on one mesh: one row per instant.

    A row holds the features, then q and slip at the points.  `error` is only the error of m and n
    due to the mesh, and the other errors are NaN.  Also returns shear traction and slip of the
    elements at each instant, their ends, and where slip has jumps or kinks.

    progress[0] becomes the completed fraction of the work on all meshes, times -1.  A mesh with
    twice as many elements takes four times as long.
    """
    instants, asked = loads.shape[1], points.size
    values = np.full((instants, FEATURES + 2 * asked), math.nan)
    fields, nothing = np.full((instants, 2, count), math.nan), np.empty(0)
    values[:, 5] = NONE
    least = max((count // FEWEST) ** 2 // 8, count // FEWEST)
    rows = path(law, own, loads, f, REACH / count, least, LAST)
    touches, unknown = False, UNSOLVED if np.all(np.isfinite(loads)) else NONE
    for k in range(rows.shape[0]):
        touches = touches or rows[k, A] + rows[k, C] > 0
    if not (touches and f > 0):
        return values, fields, nothing, nothing
    ends, bends, A_, B, z, room, state = _discretised(law, own, rows, count, stick_ends)
    x, series, lost = (ends[1:] + ends[:-1]) / 2, np.empty(TERMS), False
    work, regime, m, n, intervals, error = 0.0, NONE, math.nan, math.nan, 0.0, 0.0
    for k in range(rows.shape[0]):
        progress[0] = -_completed(count, k / rows.shape[0], finest)
        row, last = rows[k], rows[max(k - 1, 0)]
        for i in range(4):
            lost = lost or not math.isfinite(row[i])
        if lost:
            regime = unknown if regime != UNSOLVED else UNSOLVED
        elif (k == 0 or _move(row, last)) and regime != UNSOLVED:
            regime, more = step(law, own, series, f, ends, last, row, A_, B, z, state, room)
            work += more
            m, n, intervals, error = math.nan, math.nan, 0.0, 0.0
            if regime == COMPUTED:
                m, n, intervals, slipping, doubt = sticking(x, state, row[A], row[C], k <= least)
                regime = FULL_STICK if slipping == 0 else COMPUTED
                error = (_mesh_error(ends, m, n, row[A], row[C]) + doubt) / (row[A] + row[C])
        if row[INSTANT] < 0:
            continue
        here = values[int(row[INSTANT])]
        here[5] = regime
        if not lost or unknown == UNSOLVED:
            here[0], here[1] = row[A], row[C]
        if regime in (UNSOLVED, NONE):
            continue
        here[2], here[3], here[4], here[6], here[7] = m, n, intervals, work, error
        for i in range(asked):
            q, slip = at_point(law, own, series, f, ends, x, state, bends, row, points[i])
            here[FEATURES + i] = q
            here[FEATURES + asked + i] = slip if work == work else math.nan
        fields[int(row[INSTANT]), 0] = state[SHEAR]
        if work == work:
            fields[int(row[INSTANT]), 1] = state[SLIP]
    return values, fields, ends, bends


@kernel(real(vector, vector, vector, vector, vector, vector, real, real))
def _largest_difference(
    ends: Any,
    bends: Any,
    values: Any,
    coarse_ends: Any,
    coarse_bends: Any,
    coarse: Any,
    a: float,
    c: float,
) -> float:
    """The largest difference between two meshes in [-a, c], at the middle and the ends of elements.

    values, coarse: values of the elements of each mesh.
    """
    x, coarse_x = (ends[1:] + ends[:-1]) / 2, (coarse_ends[1:] + coarse_ends[:-1]) / 2
    largest = 0.0
    for i in range(x.size):
        if -a < x[i] < c:
            for part in (-0.499999, 0.0, 0.499999):
                point = x[i] + part * (ends[i + 1] - ends[i])
                fine = value_at(ends, x, bends, values, point)
                there = value_at(coarse_ends, coarse_x, coarse_bends, coarse, point)
                largest = max(largest, abs(fine - there))
    return largest


@kernel(real(vector, vector, vector, vector, vector, real, real))
def _mean_difference(
    ends: Any, values: Any, coarse_ends: Any, coarse_bends: Any, coarse: Any, a: float, c: float
) -> float:
    """The mean difference between two meshes in [-a, c]."""
    coarse_x, mean = (coarse_ends[1:] + coarse_ends[:-1]) / 2, 0.0
    for i in range(values.size):
        x = (ends[i] + ends[i + 1]) / 2
        if -a < x < c:
            off = abs(values[i] - value_at(coarse_ends, coarse_x, coarse_bends, coarse, x))
            mean += off * (ends[i + 1] - ends[i]) / (a + c)
    return mean


@kernel(real(vector, vector, vector, vector, real, real))
def _of_shear(ends: Any, q: Any, coarse_ends: Any, coarse_q: Any, a: float, c: float) -> float:
    """The mean difference of shear traction, which has no jumps, between two meshes in [-a, c]."""
    smooth = np.zeros(coarse_ends.size)
    smooth[0] = smooth[-1] = JUMP
    return _mean_difference(ends, q, coarse_ends, smooth, coarse_q, a, c)


@kernel(real(vector, vector))
def _error(fine: Any, coarse: Any) -> float:
    """Estimated error of m and n at one instant from two meshes."""
    h = fine[0] + fine[1]
    if fine[5] != coarse[5] and UNSOLVED in (fine[5], coarse[5]):
        return math.nan
    error = 0.0
    for i in (2, 3):
        difference = abs(fine[i] - coarse[i]) / h
        if math.isnan(fine[i]) != math.isnan(coarse[i]):
            difference = 1.0
        error = max(error, difference if difference == difference else 0.0)
    return error + fine[7]


@kernel(LOOP)
def each_history(law: Any, given: Any, own: Any, out: Any) -> None:
    """Histories with their errors, on as many meshes as each of them needs.

    given: f, tol, the number of points, then P, M, Q and sigma at all instants, then the points.
    out: for each instant its features, then q and slip at the points.
    """
    law = opened(law)
    for row in range(given.shape[0]):
        f, tol, asked = given[row, 0], given[row, 1], int(given[row, 2])
        count = (given.shape[1] - 3 - asked) // 4
        loads = given[row, 3 : 3 + 4 * count].reshape((4, count))
        points = given[row, 3 + 4 * count :]
        elements, met, stick_ends = FEWEST, False, np.empty(0)
        coarse, coarse_fields = np.empty((0, 0)), np.empty((0, 2, 0))
        coarse_ends, coarse_bends = stick_ends, stick_ends
        while True:
            fine, fields, ends, bends = history_on_mesh(
                law, own[row], f, loads, points, elements, stick_ends, _finest(tol), out[row]
            )
            met = ends.size == 0
            if elements > FEWEST and not met:
                met, work_error, fine_work, coarse_work = True, 0.0, 0.0, 0.0
                for k in range(count):
                    here, field, last = fine[k], fields[k], coarse_fields[k]
                    a, c = here[0], here[1]
                    shear = _of_shear(ends, field[0], coarse_ends, last[0], a, c)
                    here[7] = max(_error(here, coarse[k]), shear * (a + c) / (f * loads[0, k]))
                    if not math.isnan(field[1, 0]):
                        here[9] = CAUTION * _largest_difference(
                            ends,
                            bends,
                            field[1],
                            coarse_ends,
                            coarse_bends,
                            last[1],
                            -ends[0],
                            ends[-1],
                        )
                    met = met and (here[7] <= tol or here[5] in (NONE, SLIDING, UNSOLVED))
                    if here[5] != NONE:
                        work_error += abs((here[6] - fine_work) - (coarse[k, 6] - coarse_work))
                        fine_work, coarse_work = here[6], coarse[k, 6]
                        here[8] = WORK * work_error
            if met or elements >= _finest(tol):
                break
            coarse, coarse_fields, elements = fine, fields, 2 * elements
            coarse_ends, coarse_bends = ends, bends
            stick_ends = np.concatenate((-coarse[:, 2], coarse[:, 3]))
            widest = np.nanmax(coarse[:, 0] + coarse[:, 1])
            stick_ends = _thinned(stick_ends, widest, APART * tol, elements // EACH)
        out[row] = fine.ravel()


# ---------------------------------------------------------------- steady cycles


@kernel(vector(vector, vector, vector, vector))
def _extrapolated(ends: Any, total_slip: Any, coarse_ends: Any, coarse_slip: Any) -> Any:
    """The total slip on a mesh, less the amount by which it fell from a mesh of half the elements.

    Where the surfaces stick close to the friction limit, as under a high mean shear load, elements
    slip a little on every mesh, but less as the mesh is refined.
    """
    x, coarse_x = (ends[1:] + ends[:-1]) / 2, (coarse_ends[1:] + coarse_ends[:-1]) / 2
    coarse = np.interp(x, coarse_x, coarse_slip)
    return np.maximum(np.minimum(total_slip, 2 * total_slip - coarse), 0.0)


@kernel(results(2)(vector, vector, vector, real))
def _permanent_zone(ends: Any, always: Any, total_slip: Any, threshold: float) -> Any:
    """m and n of the permanent stick zone, from the total slip of a cycle, forward plus reverse.

    The zone is the longest run of elements that are always in contact and slip by no more than the
    threshold.  Its ends are extrapolated to zero slip, because slip rises from there as the power
    3/2 of the distance.
    """
    x = (ends[1:] + ends[:-1]) / 2
    start, length, low, high = 0, 0.0, -1, -1
    inside = False
    for i in range(x.size):
        if always[i] > 0 and total_slip[i] <= threshold:
            start = start if inside else i
            inside = True
            if ends[i + 1] - ends[start] > length:
                length, low, high = ends[i + 1] - ends[start], start, i
        else:
            inside = False
    if low < 0 or low == high:
        return math.nan, math.nan
    zone = np.empty(2)
    for side in range(2):
        outward, last = (-1, low) if side == 0 else (1, high)
        near, far = last + 2 * outward, last + 3 * outward
        while 0 <= far + outward < x.size and total_slip[far] < RISEN * total_slip[near]:
            far += outward
        zone[side] = ends[last] if side == 0 else ends[last + 1]
        if 0 <= far < x.size and always[near] > 0 and always[far] > 0:
            g, G = total_slip[near] ** (2 / 3), total_slip[far] ** (2 / 3)
            if g < G:
                root = x[near] - (x[far] - x[near]) * g / (G - g)
                inner = (x[low] + x[high]) / 2
                zone[side] = min(max(root, min(inner, x[near])), max(inner, x[near]))
    return -zone[0], zone[1]


@kernel(results(2)(LAW, vector, matrix))
def _smallest(law: Any, own: Any, rows: Any) -> Any:
    """The smallest a and the smallest c of a path."""
    ends, last, a, c = np.zeros((2, 5)), -1, math.inf, math.inf
    for k in range(rows.shape[0]):
        if rows[k, INSTANT] < 0:
            continue
        row = rows[k]
        ends[1] = np.array([row[A], row[C], 0.0, row[P], row[M]])
        if last >= 0:
            smallest_a, smallest_c = narrowest(law, own, ends)
            a, c = min(a, smallest_a), min(c, smallest_c)
        ends[0], last = ends[1], k
    return a, c


@shared
def cycle_on_mesh(
    law: Any, own: Any, f: float, loads: Any, points: Any, count: int, stick_ends: Any
) -> Any:
    """A cycle on one mesh: the results of a cycle, then slip range and initial q at the points.

    m and n are the edges of the smallest contact, and the error of work is only that due to the
    drift; the other errors are NaN.  Also returns the ends of the elements, where slip has jumps or
    kinks, and rows: the total slip and the slip range of the elements in a cycle, 1 for those that
    are always in contact, initial q, and the work per length in a cycle.
    """
    nothing, fields = np.empty(0), np.ones((5, count))
    asked = points.size
    values = np.full(ZONE + 2 * asked, math.nan)
    values[2] = NONE
    least = count // FEWEST
    rows = path(law, own, loads, f, REACH / count, least, 0.0)
    for k in range(rows.shape[0]):
        known = rows[k, A] + rows[k, C] > 0 and f > 0
        if not (known and math.isfinite(rows[k, Q]) and math.isfinite(rows[k, SIGMA])):
            return values, nothing, nothing, fields
    ends, bends, A_, B, z, room, state = _discretised(law, own, rows, count, stick_ends)
    x, series = (ends[1:] + ends[:-1]) / 2, np.empty(TERMS)
    total_slip, slip_range, always = fields[TOTAL], fields[RANGE], fields[ALWAYS]
    before = np.zeros(x.size)
    low, high = np.zeros(x.size), np.zeros(x.size)
    work, drift = 0.0, math.inf
    for round_ in range(MOST_ROUNDS + 1):
        # round 0 applies the loads of the first instant; each later round is one cycle
        start, end = (0, least + 1) if round_ == 0 else (least + 1, rows.shape[0])
        total_slip[:], fields[DENSITY], work = 0.0, 0.0, 0.0
        low[:] = high[:] = state[SLIP]
        for k in range(start, end):
            row, previous = rows[k], rows[max(k - 1, 0)]
            if not (k == 0 or _move(row, previous)):
                continue
            code, more = step(law, own, series, f, ends, previous, row, A_, B, z, state, room)
            if code != COMPUTED:
                values[2] = code
                return values, nothing, nothing, fields
            work += more
            for i in range(x.size):
                total_slip[i] += abs(state[SLIP_OF_STEP, i])
                fields[DENSITY, i] += state[WORK_OF_STEP, i]
                low[i], high[i] = min(low[i], state[SLIP, i]), max(high[i], state[SLIP, i])
                if state[BOUND, i] == 0:
                    always[i] = 0.0
        most = change = 0.0
        for i in range(x.size):
            most, change = max(most, total_slip[i]), max(change, abs(total_slip[i] - before[i]))
            before[i] = total_slip[i]
        drift = change / most if most > 0 else 0.0
        values[4] = round_
        if round_ > 1 and drift <= REPEATED:
            break
    values[3], values[5], values[7] = work, drift, drift * work
    a, c = _smallest(law, own, rows)
    values[0], values[1], values[2] = a, c, COMPUTED
    slip_range[:], fields[FIRST_SHEAR] = high - low, state[SHEAR]
    for i in range(asked):
        q, _ = at_point(law, own, series, f, ends, x, state, bends, rows[-1], points[i])
        values[ZONE + asked + i] = q
        if -a <= points[i] <= c:
            values[ZONE + i] = value_at(ends, x, bends, slip_range, points[i])
    return values, ends, bends, fields


@kernel(whole(vector, vector, vector, vector, real))
def _find_zone(values: Any, ends: Any, always: Any, total_slip: Any, most: float) -> int:
    """Fill in m, n, the regime and the error due to the mesh and the threshold.

    most  the largest slip, to which the threshold is relative
    """
    inner_a, inner_c, values[6] = values[0], values[1], 0.0
    if most == 0 and inner_a + inner_c > 0:
        values[2] = FULL_STICK
        return 1
    threshold = THRESHOLD if ends.size > ENOUGH else SPURIOUS
    m, n = _permanent_zone(ends, always, total_slip, threshold * most)
    values[2] = COMPUTED
    if math.isnan(m):
        values[2], values[6] = NO_STICK, math.nan
    values[0], values[1] = min(m, inner_a), min(n, inner_c)
    if values[2] == COMPUTED:
        wide_m, wide_n = _permanent_zone(ends, always, total_slip, WIDE * most)
        h = inner_a + inner_c
        difference = max(abs(wide_m - m), abs(wide_n - n))
        values[6] = (difference + _mesh_error(ends, m, n, inner_a, inner_c)) / h
    return 1


@kernel(real(vector, vector))
def _apart(one: Any, other: Any) -> float:
    """The larger distance between the ends of two stick zones; NaN if one is not known."""
    left, right = abs(one[0] - other[0]), abs(one[1] - other[1])
    return left if left > right else right


@kernel(whole(vector, vector, vector, vector, vector))
def _choose_zone(fine: Any, direct: Any, less: Any, coarse_direct: Any, coarse_less: Any) -> int:
    """Fill in the zone on a mesh, with its error by comparison with the previous mesh.

    direct  the zone by the slip on this mesh
    less    the zone by the extrapolated slip, which is used if it is clearly wider
    """
    h, shift = less[0] + less[1], _apart(direct, less)
    fine[:7] = direct[:7]
    if less[2] == COMPUTED and (direct[2] == NO_STICK or h - direct[0] - direct[1] > NOTICED * h):
        fine[:7], change = less[:7], _apart(less, coarse_less)
        if math.isnan(change):
            change = h if math.isnan(shift) else shift
        fine[6] = 2 * less[6] + (change + (0.0 if math.isnan(shift) else shift / 10)) / h
    elif direct[2] == COMPUTED:
        fine[6] += (_apart(direct, coarse_direct) + shift) / (direct[0] + direct[1])
        if math.isnan(fine[6]):
            fine[6] = math.inf
    return 1


@kernel(LOOP)
def each_cycle(law: Any, given: Any, own: Any, out: Any) -> None:
    """Steady cycles with their errors, on as many meshes as each of them needs.

    given: as for each_history; the loads of the last instant are those of the first.
    out: the results of a cycle, then slip range and initial q at the points.
    """
    law = opened(law)
    for row in range(given.shape[0]):
        f, tol, asked = given[row, 0], given[row, 1], int(given[row, 2])
        count = (given.shape[1] - 3 - asked) // 4
        loads = given[row, 3 : 3 + 4 * count].reshape((4, count))
        points = given[row, 3 + 4 * count :]
        elements, met, stick_ends = FEWEST, False, np.empty(0)
        coarse_ends, coarse_bends, coarse_fields = stick_ends, stick_ends, np.empty((5, 0))
        coarse = np.full(ZONE + 2 * asked, math.nan)
        coarse_direct, coarse_less = coarse, coarse
        first = contact(law, own[row], loads[0, 0], loads[1, 0])
        while True:
            out[row, 0] = -_completed(elements, 0.0, _finest(tol))
            fine, ends, bends, fields = cycle_on_mesh(
                law, own[row], f, loads, points, elements, stick_ends
            )
            direct, less, a, c = fine.copy(), fine.copy(), fine[0], fine[1]
            slip, always = fields[TOTAL], fields[ALWAYS]
            if fine[2] == COMPUTED:
                _find_zone(direct, ends, always, slip, np.max(slip))
                if coarse_ends.size > 0:
                    smaller = _extrapolated(ends, slip, coarse_ends, coarse_fields[TOTAL])
                    _find_zone(less, ends, always, smaller, np.max(slip))
                    _choose_zone(fine, direct, less, coarse_direct, coarse_less)
                else:
                    fine[:7], less[:2] = direct[:7], math.nan
            if elements > FEWEST:
                met = fine[2] == coarse[2]
                if coarse_ends.size > 0 and ends.size > 0:
                    slip, last = fields[RANGE], coarse_fields[RANGE]
                    largest = _largest_difference(
                        ends, bends, slip, coarse_ends, coarse_bends, last, a, c
                    )
                    work, last = fields[DENSITY], coarse_fields[DENSITY]
                    mean = _mean_difference(
                        ends, work, coarse_ends, coarse_bends, last, -ends[0], ends[-1]
                    )
                    fine[7] += mean * (ends[-1] - ends[0])
                    q, coarse_q = fields[FIRST_SHEAR], coarse_fields[FIRST_SHEAR]
                    fine[8] = CAUTION * largest
                    fine[9] = CAUTION * _of_shear(
                        ends, q, coarse_ends, coarse_q, first[0], first[1]
                    )
                if fine[2] == COMPUTED:
                    met = met and fine[6] <= tol
                elif not met:
                    fine[6] = math.nan
            if met or elements >= _finest(tol):
                break
            coarse, elements = fine, 2 * elements
            coarse_direct, coarse_less = direct, less
            coarse_ends, coarse_bends, coarse_fields = ends, bends, fields
            stick_ends = np.array([-coarse[0], coarse[1]])
            stick_ends = _thinned(stick_ends, coarse[0] + coarse[1], APART * tol, elements // EACH)
        if fine[5] > REPEATED:
            fine[6] = math.inf
        out[row] = fine
