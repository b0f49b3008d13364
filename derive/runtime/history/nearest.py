r"""The shear within friction that is nearest to a trial one: the convex problem of a step.

Had all stuck, shear would be `trial`.  Of all q with |q| <= bound and sum w q = Q it is the one
that minimises (q - trial)^T A (q - trial)/2.  With e = q - trial and s = (A e)/w - mu,

    s = 0 between the bounds,    s <= 0 at the upper one,    s >= 0 at the lower one;

E*/2 times the forward slip of the step is -s.  Newton's method on the places of the elements, 0
between the bounds, 1 and -1 at them: unknown are e where it sticks or s where it slips, whichever
are fewer.  With z = A^-1 w the second is

    e = A^-1 (w s) + mu z,    sum w e = Q - sum w trial.

Where all places at once do not settle, the first misplaced element alone is moved, as by Murty.
"""

import math
from typing import Any

import numpy as np

from ..kernels import kernel, matrix, real, vector, whole
from .elements import factored, resolved

ROUNDING = 1e-11
"""What counts as none, over the largest."""

ROUNDS = 30
"""Rounds in which all elements may change their places."""

STICK, SLIP = 1.0, 2.0
"""What the factor in `room` is of, in the row below it."""


@kernel(whole(matrix, vector, real, matrix))
def _factor(A: Any, places: Any, kind: float, room: Any) -> int:
    """Cholesky's factor of the rows and columns of A that stick or slip, into room, unless it is
    there: the places that end a step begin the next one.  Their number, 0 where there is none."""
    count = places.size
    mine = room[count]
    few, same = 0, True
    for i in range(count):
        wanted = kind if (places[i] == 0) == (kind == STICK) else 0.0
        same, mine[i] = same and mine[i] == wanted, wanted
        few += wanted > 0
    if same:
        return few
    row = 0
    for i in range(count):
        if mine[i] > 0:
            column = row
            for j in range(i, count):
                if mine[j] > 0:
                    room[row, column] = A[i, j]
                    column += 1
            row += 1
    if factored(room, few):
        return few
    mine[:] = 0.0
    return 0


@kernel(whole(matrix, vector, vector, vector, vector, vector, matrix))
def _few_stick(A: Any, w: Any, places: Any, e: Any, s: Any, mu: Any, room: Any) -> int:
    """e where it sticks, from e elsewhere; mu[0] holds the force that is asked for, then mu."""
    count = w.size
    chosen = np.empty(count, np.int64)
    few = 0
    for i in range(count):
        if places[i] == 0:
            chosen[few] = i
            few += 1
    by_one, by_rest = np.empty(few), np.zeros(few)
    for k in range(few):
        by_one[k] = w[chosen[k]]
    force = mu[0]
    for j in range(count):
        if places[j] != 0 and e[j] != 0:
            force -= w[j] * e[j]
            for k in range(few):
                by_rest[k] -= A[j, chosen[k]] * e[j]
    if not _factor(A, places, STICK, room):
        return 0
    resolved(room, few, by_one)
    resolved(room, few, by_rest)
    weight = 0.0
    for k in range(few):
        force -= w[chosen[k]] * by_rest[k]
        weight += w[chosen[k]] * by_one[k]
    if not weight > 0:
        return 0
    mu[0] = force / weight
    for k in range(few):
        e[chosen[k]] = by_rest[k] + mu[0] * by_one[k]
    for i in range(count):
        s[i] = 0.0
    for j in range(count):
        if e[j] != 0:
            for i in range(count):
                s[i] += A[j, i] * e[j]
    for i in range(count):
        s[i] = 0.0 if places[i] == 0 else s[i] / w[i] - mu[0]
    return 1


@kernel(whole(matrix, vector, vector, vector, vector, vector, vector, matrix))
def _few_slip(B: Any, z: Any, w: Any, places: Any, e: Any, s: Any, mu: Any, room: Any) -> int:
    """The same from w s where it slips; B is the inverse of A."""
    count = w.size
    chosen = np.empty(count, np.int64)
    few = 0
    for i in range(count):
        if places[i] != 0:
            chosen[few] = i
            few += 1
    by_one, by_rest = np.empty(few), np.empty(few)
    for k in range(few):
        by_one[k], by_rest[k] = z[chosen[k]], e[chosen[k]]
    if few > 0 and not _factor(B, places, SLIP, room):
        return 0
    resolved(room, few, by_one)
    resolved(room, few, by_rest)
    force, weight = mu[0], 0.0
    for i in range(count):
        weight += w[i] * z[i]
        s[i] = 0.0
    for k in range(few):
        force -= z[chosen[k]] * by_rest[k]
        weight -= z[chosen[k]] * by_one[k]
    if not weight > 0:
        return 0
    mu[0] = force / weight
    for i in range(count):
        if places[i] == 0:
            e[i] = mu[0] * z[i]
    for k in range(few):
        j = chosen[k]
        slipped = by_rest[k] - mu[0] * by_one[k]
        s[j] = slipped / w[j]
        for i in range(count):
            if places[i] == 0:
                e[i] += B[j, i] * slipped
    return 1


@kernel(whole(matrix, vector, vector, vector, real, vector))
def _released(A: Any, w: Any, trial: Any, bound: Any, needed: float, places: Any) -> int:
    """Let the element stick that is the first to do so if all slip and the force is not yet met."""
    count, chosen, best = w.size, -1, math.inf
    for i in range(count):
        needed -= w[i] * (places[i] * bound[i] - trial[i])
    sense = math.copysign(1.0, needed)
    for i in range(count):
        if bound[i] > 0 and places[i] == -sense:
            u = 0.0
            for j in range(count):
                u += A[i, j] * (places[j] * bound[j] - trial[j])
            if sense * u / w[i] < best:
                chosen, best = i, sense * u / w[i]
    if chosen < 0:
        return 0
    places[chosen] = 0.0
    return 1


STEP: Any = whole(
    *(matrix, matrix, vector, vector, vector, vector, vector, vector, vector, vector, matrix)
)


@kernel(STEP)
def nearest(
    A: Any,
    B: Any,
    z: Any,
    w: Any,
    trial: Any,
    bound: Any,
    given: Any,
    places: Any,
    q: Any,
    s: Any,
    room: Any,
) -> int:
    """q, s and the places, which hold a guess; given[0] is Q.  0 where it is not found.

    room: a matrix with one row more than A, zero at first and left alone between calls.
    """
    count = w.size
    largest, needed = 0.0, given[0]
    e, mu, old = np.empty(count), np.empty(1), np.empty(count)
    slides = True
    for i in range(count):
        slides = slides and (places[i] != 0 or bound[i] == 0)
    for i in range(count):
        largest = max(largest, bound[i])
        needed -= w[i] * trial[i]
        if bound[i] == 0:
            places[i] = 1.0
        elif slides:
            places[i] = 0.0
    for turn in range(ROUNDS + 10 * count):
        sticking = 0
        for i in range(count):
            sticking += places[i] == 0
            e[i] = 0.0 if places[i] == 0 else places[i] * bound[i] - trial[i]
        if sticking == 0:
            return 0
        mu[0] = needed
        if sticking <= count / 2:
            found = _few_stick(A, w, places, e, s, mu, room)
        else:
            found = _few_slip(B, z, w, places, e, s, mu, room)
        if not found:
            return 0
        against = 0.0
        for i in range(count):
            against = max(against, abs(s[i]))
        wrong, left = 0, 0
        for i in range(count):
            old[i] = places[i]
            q[i] = trial[i] + e[i] if places[i] == 0 else places[i] * bound[i]
            move = places[i]
            if places[i] == 0 and abs(q[i]) > bound[i] + ROUNDING * largest:
                move = math.copysign(1.0, q[i])
            elif bound[i] > 0 and places[i] * s[i] > ROUNDING * against:
                move = 0.0
            if move != places[i] and (turn < ROUNDS or wrong == 0):
                places[i] = move
            wrong += move != old[i]
            left += places[i] == 0
        if wrong == 0:
            return 1
        if left == 0 and not _released(A, w, trial, bound, needed, places):
            return 0
    return 0
