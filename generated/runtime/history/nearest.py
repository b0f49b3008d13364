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
        i = chosen[k]
        by_one[k] = w[i]
        for j in range(few):
            room[k, j] = A[i, chosen[j]]
    force = mu[0]
    for j in range(count):
        if places[j] != 0 and e[j] != 0:
            force -= w[j] * e[j]
            for k in range(few):
                by_rest[k] -= A[j, chosen[k]] * e[j]
    if not factored(room, few):
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
        i = chosen[k]
        by_one[k], by_rest[k] = z[i], e[i]
        for j in range(few):
            room[k, j] = B[i, chosen[j]]
    if not factored(room, few):
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
    """q, s and the places, which hold a guess; given[0] is Q.  0 where it is not found."""
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
