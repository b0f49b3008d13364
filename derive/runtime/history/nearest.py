r"""The shear traction within the friction limits that is nearest to a trial: the convex problem of
a load step.

`trial` is the shear traction that the step would give under full stick.  The solution minimises
(q - trial)^T A (q - trial)/2 over all q with |q| <= bound and sum w q = Q.  With e = q - trial and
s = (A e)/w - mu,

    s = 0 between the bounds,    s <= 0 at the upper one,    s >= 0 at the lower one;

E*/2 times the forward slip of the step is -s.  The method is Newton's, applied to the status of the
elements: 0 between the bounds, 1 at the upper and -1 at the lower bound.  The unknowns are e at the
elements that stick, or s at those that slip, whichever are fewer.  With z = A^-1 w, the equations
for s are

    e = A^-1 (w s) + mu z,    sum w e = Q - sum w trial.

If the iteration in which all elements change their status at once does not converge, only the first
element with a wrong status is changed in each further iteration, as in Murty's method.
"""

import math
from typing import Any

import numpy as np

from ..kernels import kernel, matrix, real, vector, whole
from .elements import factored, resolved

ROUNDING = 1e-11
"""A value below this fraction of the largest counts as zero."""

ITERATIONS = 30
"""Iterations in which all elements may change their status at once."""

STICK, SLIP = 1.0, 2.0
"""Marks in the last row of `room`: whether its factor is that of sticking or slipping elements."""


@kernel(whole(matrix, vector, real, matrix))
def _factor(A: Any, status: Any, kind: float, room: Any) -> int:
    """Write the Cholesky factor of the rows and columns of A that stick, or slip, into `room`.

    The factor is kept if `room` already holds it, since a step begins with the last status of the
    step before.  Returns the number of these rows, or 0 if there is no factor.
    """
    count = status.size
    marks = room[count]
    few, same = 0, True
    for i in range(count):
        wanted = kind if (status[i] == 0) == (kind == STICK) else 0.0
        same, marks[i] = same and marks[i] == wanted, wanted
        few += wanted > 0
    if same:
        return few
    row = 0
    for i in range(count):
        if marks[i] > 0:
            column = row
            for j in range(i, count):
                if marks[j] > 0:
                    room[row, column] = A[i, j]
                    column += 1
            row += 1
    if factored(room, few):
        return few
    marks[:] = 0.0
    return 0


@kernel(whole(matrix, vector, vector, vector, vector, vector, matrix))
def _few_stick(A: Any, w: Any, status: Any, e: Any, s: Any, mu: Any, room: Any) -> int:
    """Solve for e at the elements that stick, given e elsewhere, and for s and mu.

    mu[0] holds the required force at first, and mu at the end.  Returns 0 if there is no solution.
    """
    count = w.size
    chosen = np.empty(count, np.int64)
    few = 0
    for i in range(count):
        if status[i] == 0:
            chosen[few] = i
            few += 1
    by_one, by_rest = np.empty(few), np.zeros(few)
    for k in range(few):
        by_one[k] = w[chosen[k]]
    force = mu[0]
    for j in range(count):
        if status[j] != 0 and e[j] != 0:
            force -= w[j] * e[j]
            for k in range(few):
                by_rest[k] -= A[j, chosen[k]] * e[j]
    if not _factor(A, status, STICK, room):
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
        s[i] = 0.0 if status[i] == 0 else s[i] / w[i] - mu[0]
    return 1


@kernel(whole(matrix, vector, vector, vector, vector, vector, vector, matrix))
def _few_slip(B: Any, z: Any, w: Any, status: Any, e: Any, s: Any, mu: Any, room: Any) -> int:
    """Solve the same equations for s at the elements that slip; B is the inverse of A."""
    count = w.size
    chosen = np.empty(count, np.int64)
    few = 0
    for i in range(count):
        if status[i] != 0:
            chosen[few] = i
            few += 1
    by_one, by_rest = np.empty(few), np.empty(few)
    for k in range(few):
        by_one[k], by_rest[k] = z[chosen[k]], e[chosen[k]]
    if few > 0 and not _factor(B, status, SLIP, room):
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
        if status[i] == 0:
            e[i] = mu[0] * z[i]
    for k in range(few):
        j = chosen[k]
        slipped = by_rest[k] - mu[0] * by_one[k]
        s[j] = slipped / w[j]
        for i in range(count):
            if status[i] == 0:
                e[i] += B[j, i] * slipped
    return 1


@kernel(whole(matrix, vector, vector, vector, real, vector))
def _release_one(A: Any, w: Any, trial: Any, bound: Any, needed: float, status: Any) -> int:
    """When all elements slip and do not carry the force, let one stick: the first that would.

    Returns 0 if there is no such element.
    """
    count, chosen, best = w.size, -1, math.inf
    for i in range(count):
        needed -= w[i] * (status[i] * bound[i] - trial[i])
    sign = math.copysign(1.0, needed)
    for i in range(count):
        if bound[i] > 0 and status[i] == -sign:
            u = 0.0
            for j in range(count):
                u += A[i, j] * (status[j] * bound[j] - trial[j])
            if sign * u / w[i] < best:
                chosen, best = i, sign * u / w[i]
    if chosen < 0:
        return 0
    status[chosen] = 0.0
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
    status: Any,
    q: Any,
    s: Any,
    room: Any,
) -> int:
    """Solve for q, s and the status, which holds a guess.  Returns 0 if no solution is found.

    given: its first element is Q.
    room: workspace, a matrix with one row more than A; zero before the first call, kept afterwards.
    """
    count = w.size
    largest, needed = 0.0, given[0]
    e, mu, old = np.empty(count), np.empty(1), np.empty(count)
    sliding = True
    for i in range(count):
        sliding = sliding and (status[i] != 0 or bound[i] == 0)
    for i in range(count):
        largest = max(largest, bound[i])
        needed -= w[i] * trial[i]
        if bound[i] == 0:
            status[i] = 1.0
        elif sliding:
            status[i] = 0.0
    for iteration in range(ITERATIONS + 10 * count):
        sticking = 0
        for i in range(count):
            sticking += status[i] == 0
            e[i] = 0.0 if status[i] == 0 else status[i] * bound[i] - trial[i]
        if sticking == 0:
            return 0
        mu[0] = needed
        if sticking <= count / 2:
            solved = _few_stick(A, w, status, e, s, mu, room)
        else:
            solved = _few_slip(B, z, w, status, e, s, mu, room)
        if not solved:
            return 0
        largest_s = 0.0
        for i in range(count):
            largest_s = max(largest_s, abs(s[i]))
        wrong, still_sticking = 0, 0
        for i in range(count):
            old[i] = status[i]
            q[i] = trial[i] + e[i] if status[i] == 0 else status[i] * bound[i]
            new = status[i]
            if status[i] == 0 and abs(q[i]) > bound[i] + ROUNDING * largest:
                new = math.copysign(1.0, q[i])
            elif bound[i] > 0 and status[i] * s[i] > ROUNDING * largest_s:
                new = 0.0
            if new != status[i] and (iteration < ITERATIONS or wrong == 0):
                status[i] = new
            wrong += new != old[i]
            still_sticking += status[i] == 0
        if wrong == 0:
            return 1
        if still_sticking == 0 and not _release_one(A, w, trial, bound, needed, status):
            return 0
    return 0
