r"""The loads and contacts of a history; between two instants all loads vary linearly.

Rows of a path hold P, M, Q, sigma, a, c, and the number of the instant, or -1 between instants.
Steps are so short that no edge moves farther than `reach` times the widest contact, and a step ends
wherever |Q| reaches f P or falls below it.  The contact before a loss of contact is small.  So is
the first one after it, or it is that of a flat body under a small load.  If there is neither,
because the contact approaches from a great distance, its shear traction is not known, and Q in the
first row is NaN.
"""

import math
from typing import Any

import numpy as np

from ..inverse import contact
from ..kernels import LAW, kernel, matrix, real, truth, vector, whole

P, M, Q, SIGMA, A, C, INSTANT = range(7)
"""Columns of a path."""

SMALL = 0.02
"""Width of the last contact before a loss and of the first after it, relative to that at the
previous and the next instant."""

UNLOADED = 1e-4
"""A flat body begins with a wide contact, under less than this fraction of the load at the next
instant."""


@kernel(whole(LAW, vector, vector))
def _touch(law: Any, own: Any, row: Any) -> int:
    """Write the contact under the loads of a row into it; return 0 if there is no contact."""
    row[A], row[C] = math.nan, math.nan
    if row[P] > 0 and math.isfinite(row[M]):
        row[A], row[C], _ = contact(law, own, row[P], row[M])
    return 1 if row[A] + row[C] > 0 else 0


@kernel(whole(LAW, vector, matrix, whole, real, vector))
def _between(law: Any, own: Any, instants: Any, k: int, t: float, row: Any) -> int:
    """Write the row at fraction t of the step to instant k; return 0 if there is no contact.

    instants: the rows of the instants.
    """
    row[:] = instants[k]
    if t == 1:
        return 1 if row[A] + row[C] > 0 else 0
    for i in range(4):
        row[i] = instants[k - 1, i] + t * (instants[k, i] - instants[k - 1, i])
    row[INSTANT] = -1
    if instants[k - 1, P] == instants[k, P] and instants[k - 1, M] == instants[k, M]:
        return 1 if row[A] + row[C] > 0 else 0
    return _touch(law, own, row)


@kernel(vector(matrix, whole, real))
def _sliding_limits(loads: Any, k: int, f: float) -> Any:
    """Fractions of the step to instant k at which |Q| = f P; 2 if there is none."""
    limits = np.full(2, 2.0)
    for i in range(2):
        sign = 1.0 if i == 0 else -1.0
        start = sign * loads[Q, k - 1] - f * loads[P, k - 1]
        end = sign * loads[Q, k] - f * loads[P, k]
        if start * end < 0:
            limits[i] = start / (start - end)
    return limits


@kernel(matrix(LAW, vector, matrix, real, real, whole, real))
def path(law: Any, own: Any, loads: Any, f: float, reach: float, least: int, short: float) -> Any:
    """The rows of the path; the first one is the contact at the first instant without shear.

    least: smallest number of steps between two instants.
    short: length of the last step before an instant relative to the others; 0 for equal steps.
    """
    number = loads.shape[1]
    instants, parts = np.empty((number, 7)), np.ones(number, np.int64)
    most, widest = least + 1, 0.0
    for k in range(number):
        instants[k, :4], instants[k, INSTANT] = loads[:, k], k
        if _touch(law, own, instants[k]):
            widest = max(widest, instants[k, A] + instants[k, C])
    for k in range(number):
        if k > 0 and widest > 0:
            here, there = instants[k - 1], instants[k]
            moved = max(abs(there[A] - here[A]), abs(there[C] - here[C])) / widest
            if math.isfinite(moved):
                parts[k] = max(least, math.ceil(min(moved / reach, 1e5)))
            elif math.isfinite(there[A]) or math.isfinite(here[A]):
                parts[k] = math.ceil(1 / reach)
        most += parts[k] + 4
    rows = np.empty((most, 7))
    count = 0
    for k in range(least + 1):
        rows[count] = instants[0]
        for i in (Q, SIGMA):
            rows[count, i] = loads[i, 0] * (k / least)
        rows[count, INSTANT] = 0 if k == least else -1
        count += 1
    for k in range(1, number):
        start, stop, power = 0.0, 1.0, 1.0
        if math.isnan(instants[k - 1, A]) and math.isfinite(instants[k, A]):
            # find, by bisection, the first contact that is neither too small nor far away
            high, power, w = 1.0, 2.0, instants[k, A] + instants[k, C]
            for _ in range(50):
                t = (start + high) / 2
                if (
                    _between(law, own, instants, k, t, rows[count])
                    and rows[count, A] + rows[count, C] > SMALL * w
                    and rows[count, A] < instants[k, A] + widest
                    and rows[count, C] < instants[k, C] + widest
                ):
                    high = t
                else:
                    start = t
            start = high
            _between(law, own, instants, k, start, rows[count])
            small = rows[count, A] + rows[count, C] < 2 * SMALL * w
            if not (small or rows[count, P] < UNLOADED * instants[k, P]):
                rows[count, Q] = math.nan
            count += 1
        elif math.isnan(instants[k, A]) and math.isfinite(instants[k - 1, A]):
            # find, by bisection, the last contact that is not too small
            high, power, w = 1.0, 2.0, instants[k - 1, A] + instants[k - 1, C]
            stop = 0.0
            for _ in range(50):
                t = (stop + high) / 2
                _between(law, own, instants, k, t, rows[count])
                if rows[count, A] + rows[count, C] > SMALL * w:
                    stop = t
                else:
                    high = t
        limits = _sliding_limits(loads, k, f)
        last = start
        for j in range(1, parts[k] + 2):
            if j == parts[k] and short == 0:
                continue
            fraction = j / parts[k] if j < parts[k] else 1 - short / parts[k]
            if j > parts[k]:
                t = 1.0
            elif stop < 1:
                t = stop * (1 - (1 - fraction) ** power)
            else:
                t = start + (1 - start) * fraction**power
            for limit in (min(limits[0], limits[1]), max(limits[0], limits[1])):
                if last < limit < t:
                    _between(law, own, instants, k, limit, rows[count])
                    count += 1
            _between(law, own, instants, k, t, rows[count])
            count += 1
            last = t
    return rows[:count]


@kernel(vector(matrix, truth))
def notable_edges(rows: Any, resting: bool) -> Any:
    """Where edges of the contact rest, or else where they turn or end.

    Slip has jumps where edges rest, and kinks where they turn.
    """
    points, count = np.empty(2 * rows.shape[0]), 0
    for k in range(1, rows.shape[0]):
        last, row, following = rows[k - 1], rows[k], rows[min(k + 1, rows.shape[0] - 1)]
        for i in (A, C):
            rests = row[i] == last[i]
            turns = not rests and (row[i] - last[i]) * (following[i] - row[i]) <= 0
            if rests if resting else turns:
                points[count] = -row[i] if i == A else row[i]
                count += 1
    return points[:count]
