r"""The loads and contacts on the way: between two instants all loads go straight.

Rows of a path hold P, M, Q, sigma, a, c, and the instant that is reached there, -1 between
instants.  Steps are so short that no edge moves farther than `reach` times the widest contact, and
there is a step's end wherever |Q| comes to f P or falls from it.  A contact that comes back from
nothing is followed from a small one on; one that does not begin small, but rolls in from afar, has
a shear that is not known: its first row holds NaN.
"""

import math
from typing import Any

import numpy as np

from ..inverse import contact
from ..kernels import LAW, kernel, matrix, real, vector, whole

P, M, Q, SIGMA, A, C, INSTANT = range(7)
"""Columns of a path."""

SMALL = 0.02
"""Width of the first contact of a new one, over that at the next instant."""


@kernel(whole(LAW, vector, vector))
def _touch(law: Any, own: Any, row: Any) -> int:
    """Find the contact under a row's loads."""
    row[A], row[C] = math.nan, math.nan
    if row[P] > 0 and math.isfinite(row[M]):
        row[A], row[C], _ = contact(law, own, row[P], row[M])
    return 1 if row[A] + row[C] > 0 else 0


@kernel(whole(LAW, vector, matrix, whole, real, vector))
def _between(law: Any, own: Any, ends: Any, k: int, t: float, row: Any) -> int:
    """The row a part t of the way from instant k - 1 to k; `ends` are the rows of the instants."""
    row[:] = ends[k]
    if t == 1:
        return 1 if row[A] + row[C] > 0 else 0
    for i in range(4):
        row[i] = ends[k - 1, i] + t * (ends[k, i] - ends[k - 1, i])
    row[INSTANT] = -1
    if ends[k - 1, P] == ends[k, P] and ends[k - 1, M] == ends[k, M]:
        return 1 if row[A] + row[C] > 0 else 0
    return _touch(law, own, row)


@kernel(vector(matrix, whole, real))
def _turns(loads: Any, k: int, f: float) -> Any:
    """Parts of the way to instant k at which |Q| = f P; 2 for none."""
    found = np.full(2, 2.0)
    for i in range(2):
        sign = 1.0 if i == 0 else -1.0
        start = sign * loads[Q, k - 1] - f * loads[P, k - 1]
        end = sign * loads[Q, k] - f * loads[P, k]
        if start * end < 0:
            found[i] = start / (start - end)
    return found


@kernel(matrix(LAW, vector, matrix, real, real, whole, real))
def path(law: Any, own: Any, loads: Any, f: float, reach: float, least: int, short: float) -> Any:
    """The rows; the first one is the contact at the first instant without shear.

    least: steps between two instants at least; short: the last one over the others, 0 for none
    that is shorter.
    """
    instants = loads.shape[1]
    ends, parts = np.empty((instants, 7)), np.ones(instants, np.int64)
    count, widest = least + 1, 0.0
    for k in range(instants):
        ends[k, :4], ends[k, INSTANT] = loads[:, k], k
        if _touch(law, own, ends[k]):
            widest = max(widest, ends[k, A] + ends[k, C])
    for k in range(instants):
        if k > 0 and widest > 0:
            here, there = ends[k - 1], ends[k]
            way = max(abs(there[A] - here[A]), abs(there[C] - here[C])) / widest
            if math.isfinite(way):
                parts[k] = max(least, math.ceil(min(way / reach, 1e5)))
            elif math.isfinite(there[A]):
                parts[k] = math.ceil(1 / reach)
        count += parts[k] + 4
    rows = np.empty((count, 7))
    used = 0
    for k in range(least + 1):
        rows[used] = ends[0]
        for i in (Q, SIGMA):
            rows[used, i] = loads[i, 0] * (k / least)
        rows[used, INSTANT] = 0 if k == least else -1
        used += 1
    for k in range(1, instants):
        start, power = 0.0, 1.0
        if math.isnan(ends[k - 1, A]) and math.isfinite(ends[k, A]):
            # back to the first contact that is neither too small nor far away
            high, power, w = 1.0, 2.0, ends[k, A] + ends[k, C]
            for _ in range(50):
                t = (start + high) / 2
                if (
                    _between(law, own, ends, k, t, rows[used])
                    and rows[used, A] + rows[used, C] > SMALL * w
                    and rows[used, A] < ends[k, A] + widest
                    and rows[used, C] < ends[k, C] + widest
                ):
                    high = t
                else:
                    start = t
            start = high
            _between(law, own, ends, k, start, rows[used])
            if not rows[used, A] + rows[used, C] < 2 * SMALL * w:
                rows[used, Q] = math.nan
            used += 1
        turns = _turns(loads, k, f)
        last = start
        for j in range(1, parts[k] + 2):
            if j == parts[k] and short == 0:
                continue
            part = j / parts[k] if j < parts[k] else 1 - short / parts[k]
            t = 1.0 if j > parts[k] else start + (1 - start) * part**power
            for turn in (min(turns[0], turns[1]), max(turns[0], turns[1])):
                if last < turn < t:
                    _between(law, own, ends, k, turn, rows[used])
                    used += 1
            _between(law, own, ends, k, t, rows[used])
            used += 1
            last = t
    return rows[:used]
