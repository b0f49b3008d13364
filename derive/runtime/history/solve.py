r"""Histories and steady cycles on ever finer meshes, and the estimate of their error.

Each mesh has twice the elements of the one before and is crowded towards the ends of the stick zone
that were found on that one; it is the last where both agree to the tolerance.  What is told is that
of the last.  Its error is put at the difference between the last two, which is more than what the
last is off, and for ends half an element more, since a front is found between two elements.
Friction's work is off by no more than the sum of what the last two differ in from instant to
instant.
"""

import math
from typing import Any

import numpy as np

from ..kernels import LOOP, kernel, matrix, opened, real, results, truth, vector, whole
from ..shared import shared
from .elements import TERMS, influence, inverse_of
from .path import INSTANT, A, C, path
from .steps import (
    BOUND,
    COMPUTED,
    FULL_STICK,
    NONE,
    SLIDING,
    SLIP,
    SLIPPED,
    UNSOLVED,
    at_place,
    mesh_for,
    step,
    sticking,
)

NO_STICK = 10.0
"""One more code of Regime: something slips everywhere in the cycle, though it never slides."""

SAMPLES = 24
"""Places at which shear is compared between two meshes."""

FEATURES = 9
"""a, c, m, n, intervals, regime, work, error and work_error of an instant."""

ZONE = 8
"""m, n, regime, work, rounds, drift, error and work_error of a cycle."""

FEWEST = 64
"""Elements of the first mesh.  A mesh of k times as many takes k times as many steps to an instant
of a cycle, and half of that to one of a history."""

REACH = 3.84
"""How far an edge may move in a step, over the width of the contact, times the elements."""

LAST = 0.05
"""The last step before an instant over the others: what sticks at the instant is what sticks in it,
though a slip zone that shrinks was longer before."""

EACH = 16
"""Elements of a mesh over the places it is crowded towards, at least."""

APART = 3.0
"""Ends that lie closer together count as one when a mesh is crowded towards them, over tol."""

ROUNDS = 40
"""Most rounds of a cycle."""

REPEATED = 1e-4
"""Slip of two rounds that differs by less, over the most, is the same."""

THRESHOLD = 1e-4
"""Slip in a round that is none, over the most; thirty times as much is tried, too."""

RISEN = 4.0
"""Slip over that at a place near the end of the stick zone, where it is led back from."""


@kernel(vector(matrix, vector))
def _pushed(B: Any, w: Any) -> Any:
    """z = A^-1 w."""
    z = np.zeros(w.size)
    for j in range(w.size):
        for i in range(w.size):
            z[i] += B[j, i] * w[j]
    return z


@kernel(real(vector, real, real, real, real))
def _between_elements(ends: Any, m: float, n: float, a: float, c: float) -> float:
    """How far ends may be off since they lie between elements; a slip zone within the element at
    an edge is not seen."""
    off = 0.0
    for side in range(2):
        place, edge = (-m, -a) if side == 0 else (n, c)
        if math.isfinite(place):
            i = min(max(np.searchsorted(ends, place) - 1, 0), ends.size - 2)
            off = max(off, (1.0 if place == edge else 0.5) * (ends[i + 1] - ends[i]))
    return off


@kernel(whole(real))
def _most(tol: float) -> int:
    """Elements of the finest mesh."""
    return 256 if tol >= 1e-3 else 512 if tol >= 1e-4 else 1024


@kernel(vector(vector, real, real, whole))
def _apart(places: Any, size: float, apart: float, most: int) -> Any:
    """At most so many places in their order, of those that lie closer together than `apart` some;
    twice that, and so on, where there are too many."""
    found = np.sort(places[np.isfinite(places)])
    while True:
        kept = 0
        for place in found:
            if kept == 0 or place - found[kept - 1] > apart * size:
                found[kept] = place
                kept += 1
        found = found[:kept].copy()
        if kept <= most:
            return found
        apart *= 2


@shared
def _laid(law: Any, own: Any, rows: Any, count: int, fronts: Any) -> Any:
    """A mesh for a path: its ends, A and its inverse, z, and what the steps write into."""
    ends = mesh_for(law, own, rows, count, fronts)
    A_ = influence(ends)
    B = inverse_of(A_)
    z = _pushed(B, ends[1:] - ends[:-1])
    return ends, A_, B, z, np.zeros((count + 1, count)), np.zeros((5, count))


@kernel(truth(vector, vector))
def _move(row: Any, last: Any) -> bool:
    """Whether loads change between two rows of a path."""
    for i in range(4):  # noqa: SIM110 - numba compiles no `any` over a generator
        if row[i] != last[i]:
            return True
    return False


@shared
def followed(
    law: Any,
    own: Any,
    f: float,
    loads: Any,
    places: Any,
    count: int,
    fronts: Any,
    finest: int,
    progress: Any,
) -> Any:
    """A history on one mesh: a row an instant of the features, then q and slip at the places and q
    at the samples.  The error is that of a front between two elements, that of work is left out.

    progress[0] becomes the part of all meshes that is done, times -1; a mesh of twice the elements
    takes four times as long.
    """
    instants, asked = loads.shape[1], places.size
    found = np.full((instants, FEATURES + 2 * asked + SAMPLES), math.nan)
    found[:, 5] = NONE
    rows = path(law, own, loads, f, REACH / count, max(count // (2 * FEWEST), 1), LAST)
    known = False
    for k in range(rows.shape[0]):
        known = known or rows[k, A] + rows[k, C] > 0
    if not (known and f > 0):
        return found
    ends, A_, B, z, room, state = _laid(law, own, rows, count, fronts)
    x, series, lost = (ends[1:] + ends[:-1]) / 2, np.empty(TERMS), False
    work, regime, m, n, runs, off = 0.0, NONE, math.nan, math.nan, 0.0, 0.0
    for k in range(rows.shape[0]):
        part = (count**2 - FEWEST**2) / 3 + count**2 * (k / rows.shape[0])
        progress[0] = -part / ((4 * finest**2 - FEWEST**2) / 3)
        row, last = rows[k], rows[max(k - 1, 0)]
        for i in range(4):
            lost = lost or not math.isfinite(row[i])
        if lost:
            regime = NONE if regime != UNSOLVED else UNSOLVED
        elif (k == 0 or _move(row, last)) and regime != UNSOLVED:
            regime, more = step(law, own, series, f, ends, last, row, A_, B, z, state, room)
            work += more
            m, n, runs, off = math.nan, math.nan, 0.0, 0.0
            if regime == COMPUTED:
                m, n, runs, slips = sticking(x, state, row[A], row[C])
                regime = FULL_STICK if slips == 0 else COMPUTED
                off = _between_elements(ends, m, n, row[A], row[C]) / (row[A] + row[C])
        if row[INSTANT] < 0:
            continue
        told = found[int(row[INSTANT])]
        told[5] = regime
        if not lost:
            told[0], told[1] = row[A], row[C]
        if regime in (UNSOLVED, NONE):
            continue
        told[2], told[3], told[4], told[6], told[7] = m, n, runs, work, off
        first = FEATURES + 2 * asked
        for i in range(asked):
            told[FEATURES + i], slip = at_place(law, own, series, f, ends, x, state, row, places[i])
            told[FEATURES + asked + i] = slip if work == work else math.nan
        for i in range(SAMPLES):
            u = 0.5 - 0.5 * math.cos(math.pi * (i + 0.5) / SAMPLES)
            place = -row[A] + u * (row[A] + row[C])
            told[first + i], _ = at_place(law, own, series, f, ends, x, state, row, place)
    return found


@kernel(real(vector, vector, real, whole))
def _error(fine: Any, coarse: Any, mean: float, first: int) -> float:
    """Of one instant; `mean` is f P/h."""
    h = fine[0] + fine[1]
    if fine[5] != coarse[5] and UNSOLVED in (fine[5], coarse[5]):
        return math.nan
    error = 0.0
    for i in (2, 3):
        away = abs(fine[i] - coarse[i]) / h
        if math.isnan(fine[i]) != math.isnan(coarse[i]):
            away = 1.0
        error = max(error, away if away == away else 0.0)
    error += fine[7]
    shear = total = 0.0
    for i in range(SAMPLES):
        weight = math.sin(math.pi * (i + 0.5) / SAMPLES)
        shear += weight * abs(fine[first + i] - coarse[first + i])
        total += weight
    return max(error, shear / total / mean)


@kernel(LOOP)
def each_history(law: Any, given: Any, own: Any, out: Any) -> None:
    """given: f, tol, the number of places, then P, M, Q and sigma at T instants, then the places.

    out: of each instant its features, then q and slip at the places.
    """
    law = opened(law)
    for row in range(given.shape[0]):
        f, tol, asked = given[row, 0], given[row, 1], int(given[row, 2])
        count = (given.shape[1] - 3 - asked) // 4
        loads = given[row, 3 : 3 + 4 * count].reshape((4, count))
        places = given[row, 3 + 4 * count :]
        first, elements, met = FEATURES + 2 * asked, FEWEST, False
        coarse, fronts = np.empty((0, 0)), np.empty(0)
        while True:
            fine = followed(law, own[row], f, loads, places, elements, fronts, _most(tol), out[row])
            if elements > FEWEST:
                met, work_off, done, meant = True, 0.0, 0.0, 0.0
                for k in range(count):
                    told = fine[k]
                    mean = f * loads[0, k] / (told[0] + told[1])
                    told[7] = _error(told, coarse[k], mean, first)
                    met = met and (told[7] <= tol or told[5] in (NONE, SLIDING))
                    if told[5] != NONE:
                        work_off += abs((told[6] - done) - (coarse[k, 6] - meant))
                        done, meant = told[6], coarse[k, 6]
                        told[8] = work_off
            if met or elements >= _most(tol):
                break
            coarse, elements = fine, 2 * elements
            fronts = np.concatenate((-coarse[:, 2], coarse[:, 3]))
            widest = np.nanmax(coarse[:, 0] + coarse[:, 1])
            fronts = _apart(fronts, widest, APART * tol, elements // EACH)
        for k in range(count):
            for i in range(first):
                out[row, k * first + i] = fine[k, i]


# ---------------------------------------------------------------- steady cycles


@kernel(results(2)(vector, vector, vector, vector, real))
def _never_slips(x: Any, ends: Any, always: Any, way: Any, threshold: float) -> Any:
    """m and n of the longest run of elements that always touch and slip by no more, led back to
    where nothing slips: the way that is slipped rises from there with the power 3/2."""
    most, start, length, low, high = 0.0, 0, 0.0, -1, -1
    for i in range(x.size):
        most = max(most, way[i])
    inside = False
    for i in range(x.size):
        if always[i] > 0 and way[i] <= threshold * most:
            start = start if inside else i
            inside = True
            if ends[i + 1] - ends[start] > length:
                length, low, high = ends[i + 1] - ends[start], start, i
        else:
            inside = False
    if low < 0 or low == high:
        return math.nan, math.nan
    found = np.empty(2)
    for side in range(2):
        outward, last = (-1, low) if side == 0 else (1, high)
        near, far = last + 2 * outward, last + 3 * outward
        while 0 <= far + outward < x.size and way[far] < RISEN * way[near]:
            far += outward
        found[side] = ends[last] if side == 0 else ends[last + 1]
        if 0 <= far < x.size and always[near] > 0 and always[far] > 0:
            g, G = way[near] ** (2 / 3), way[far] ** (2 / 3)
            if g < G:
                root = x[near] - (x[far] - x[near]) * g / (G - g)
                inner = (x[low] + x[high]) / 2
                found[side] = min(max(root, min(inner, x[near])), max(inner, x[near]))
    return -found[0], found[1]


@shared
def repeated(law: Any, own: Any, f: float, loads: Any, places: Any, count: int, fronts: Any) -> Any:
    """A cycle on one mesh: m, n, regime, work, rounds, drift, error of a front, that of work by the
    drift; then at the places the range of slip and q at the first instant."""
    asked = places.size
    found = np.full(ZONE + 2 * asked, math.nan)
    found[2] = NONE
    least = count // FEWEST
    rows = path(law, own, loads, f, REACH / count, least, 0.0)
    for k in range(rows.shape[0]):
        if not (rows[k, A] + rows[k, C] > 0 and f > 0):
            return found
    ends, A_, B, z, room, state = _laid(law, own, rows, count, fronts)
    x, series = (ends[1:] + ends[:-1]) / 2, np.empty(TERMS)
    way, before, always = np.zeros(x.size), np.zeros(x.size), np.ones(x.size)
    low, high = np.zeros(x.size), np.zeros(x.size)
    work, drift = 0.0, math.inf
    for turn in range(ROUNDS + 1):
        # the first time the loads rise to the first instant, then they go round
        first, last = (0, least + 1) if turn == 0 else (least + 1, rows.shape[0])
        way[:], work = 0.0, 0.0
        low[:] = high[:] = state[SLIP]
        for k in range(first, last):
            row, gone = rows[k], rows[max(k - 1, 0)]
            if not (k == 0 or _move(row, gone)):
                continue
            code, more = step(law, own, series, f, ends, gone, row, A_, B, z, state, room)
            if code != COMPUTED:
                found[2] = code
                return found
            work += more
            for i in range(x.size):
                way[i] += abs(state[SLIPPED, i])
                low[i], high[i] = min(low[i], state[SLIP, i]), max(high[i], state[SLIP, i])
                if state[BOUND, i] == 0:
                    always[i] = 0.0
        most = change = 0.0
        for i in range(x.size):
            most, change = max(most, way[i]), max(change, abs(way[i] - before[i]))
            before[i] = way[i]
        drift = change / most if most > 0 else 0.0
        found[4] = turn
        if turn > 1 and drift <= REPEATED:
            break
    found[3], found[5], found[7] = work, drift, drift * work
    inner_a = inner_c = math.inf
    for k in range(rows.shape[0]):
        inner_a, inner_c = min(inner_a, rows[k, A]), min(inner_c, rows[k, C])
    slips = False
    for i in range(x.size):
        slips = slips or way[i] > 0
    if not slips and inner_a + inner_c > 0:
        found[0], found[1], found[2], found[6] = inner_a, inner_c, FULL_STICK, 0.0
    else:
        m, n = _never_slips(x, ends, always, way, THRESHOLD)
        found[2] = NO_STICK if math.isnan(m) else COMPUTED
        found[0], found[1], found[6] = min(m, inner_a), min(n, inner_c), 0.0
        if found[2] == COMPUTED:
            wide_m, wide_n = _never_slips(x, ends, always, way, 30 * THRESHOLD)
            h = inner_a + inner_c
            off = max(abs(wide_m - m), abs(wide_n - n))
            found[6] = (off + _between_elements(ends, m, n, inner_a, inner_c)) / h
    for i in range(asked):
        if ends[0] <= places[i] <= ends[x.size]:
            j = np.searchsorted(ends, places[i]) - 1
            j = min(max(j if places[i] > x[j] else j - 1, 0), x.size - 2)
            t = min(max((places[i] - x[j]) / (x[j + 1] - x[j]), 0.0), 1.0)
            found[ZONE + i] = (1 - t) * (high[j] - low[j]) + t * (high[j + 1] - low[j + 1])
        found[ZONE + asked + i], _ = at_place(
            law, own, series, f, ends, x, state, rows[-1], places[i]
        )
    return found


@kernel(LOOP)
def each_cycle(law: Any, given: Any, own: Any, out: Any) -> None:
    """given: as for each_history, the last instant being the first again.

    out: m, n, regime, work, rounds, drift, error, work_error; range of slip and q at the places.
    """
    law = opened(law)
    for row in range(given.shape[0]):
        f, tol, asked = given[row, 0], given[row, 1], int(given[row, 2])
        count = (given.shape[1] - 3 - asked) // 4
        loads = given[row, 3 : 3 + 4 * count].reshape((4, count))
        places = given[row, 3 + 4 * count :]
        elements, met = FEWEST, False
        coarse, fronts = np.empty(0), np.empty(0)
        while True:
            fine = repeated(law, own[row], f, loads, places, elements, fronts)
            if elements > FEWEST:
                met = fine[2] == coarse[2]
                fine[7] += abs(fine[3] - coarse[3])
                if fine[2] == COMPUTED:
                    away = max(abs(fine[0] - coarse[0]), abs(fine[1] - coarse[1]))
                    away /= fine[0] + fine[1]
                    fine[6] += away
                    met = met and fine[6] <= tol
                elif not met:
                    fine[6] = math.nan
            if met or elements >= _most(tol):
                break
            coarse, elements = fine, 2 * elements
            fronts = np.array([-coarse[0], coarse[1]])
            fronts = _apart(fronts, coarse[0] + coarse[1], APART * tol, elements // EACH)
        out[row] = fine
