r"""Whether the stick zone can carry the shear load of the cycle.

The stick zone follows from the changes in the loads, dQ and dsigma.  It is permanent only if there
is a shear traction q1 at the first end of the half-cycle that carries Q there and never exceeds the
friction limit.  Let dq be the change in a half-cycle up to some instant, p the pressure at that
instant, and dq_12 the change over the whole half-cycle.  On the way there, and on the way back,

    -f p <= q1 + dq <= f p,    -f p <= q1 + dq_12 - dq <= f p.

Then Q lies between the integrals of the largest lower and the smallest upper of these limits.  In a
slip zone both are equal, and q1 is -f p1 or f p1.  If Q lies outside, every point slips in every
cycle, and the bodies ratchet along each other although |Q| < f P.

Under large tension at a high mean shear load this happens, because the slip zones slip in opposite
directions and carry little.  In parts of the stick zone dq falls before it rises, or the reverse,
so that instants between the ends count as well.  If nothing slips under the changes in the loads,
it happens only if the moment rocks the contact and Q and sigma are constant: dq = 0.  If both edges
advance, |dq| <= f dp everywhere, so that |Q| < f P is enough.  Under moderate tension dq grows
everywhere, and f p1 + dq = f p2 + 2 f (p1 - p_s) is above f p2, p_s being the pressure of the
contact [-m, n], which is below p1: every Q < f P2 can be carried.  The same holds if forward slip
overtakes reversed slip, because it ends in the moderate solution.  Other zones between reversed
slip carry less; the elements of a steady cycle tell whether they can carry Q.
"""

import math
from typing import Any

import numpy as np

from ..kernels import kernel
from ..types import FULL_STICK, LARGE
from .bounded import change, oriented, sense_of
from .growth import AGREED, PARTS, load_path
from .large import large_slip
from .moderate import LOAD, A, C
from .shear import pressures

POINTS = 200
"""Points at which the limits are integrated."""

ROUGH = 1e-3
"""Accuracy of the integrals, relative to f P."""


@kernel
def _point(first: Any, second: Any, part: float) -> Any:
    """A point of the union of two contacts, and its weight; `part` goes from 0 to 1."""
    left, right = max(first[A], second[A]), max(first[C], second[C])
    angle = math.pi * part
    x = -left + (left + right) * math.sin(angle / 2) ** 2
    return x, math.pi / POINTS * (left + right) / 2 * math.sin(angle)


@kernel
def _changes(law: Any, own: Any, cycle: Any, places: Any) -> Any:
    """dq at the given points in a cycle under large tension; NaN if its stick zone is not found."""
    sense = sense_of(cycle)
    slip = large_slip(law, own, oriented(cycle), sense, AGREED)
    changes = np.empty(places.size)
    for i in range(places.size):
        x = sense * places[i]
        if not slip.m + slip.n > 0:
            changes[i] = math.nan
        elif -slip.m < x < slip.n:
            changes[i] = change(slip, x)
        else:
            limit = cycle[6] * pressures(law, own, cycle, places[i])
            changes[i] = limit if x <= -slip.m else -limit
    return changes


@kernel
def _limits_under_large_tension(law: Any, own: Any, path: Any, cycle: Any) -> Any:
    """The lowest and the highest Q at the first end."""
    f, last = cycle[6], path.shape[0] - 1
    places, weights = np.empty(POINTS), np.empty(POINTS)
    for i in range(POINTS):
        places[i], weights[i] = _point(path[0], path[last], (i + 0.5) / POINTS)
    lower, upper = np.full(POINTS, -math.inf), np.full(POINTS, math.inf)
    final, partial = _changes(law, own, cycle, places), cycle.copy()
    for k in range(PARTS):
        dq = np.zeros(POINTS)
        for back in range(2):
            # under constant loads all rows of the path are one contact, and both ways are the same
            start, now = (last, max(last - k, 0)) if back else (0, min(k, last))
            if k > 0 and (not back or last > 1):
                partial[0], partial[1] = path[start, A], path[start, C]
                partial[2], partial[3] = path[now, A], path[now, C]
                partial[4], partial[5] = k / PARTS * cycle[4], k / PARTS * cycle[5]
                dq = _changes(law, own, partial, places)
            for i in range(POINTS):
                since = final[i] - dq[i] if back else dq[i]
                limit = f * law.pressure(places[i], path[now, A], path[now, C], own)
                if limit < math.inf and not math.isnan(since):  # infinite at a corner
                    lower[i], upper[i] = max(lower[i], -limit - since), min(upper[i], limit - since)
    lowest = highest = 0.0
    for i in range(POINTS):
        if math.isfinite(lower[i] + upper[i]):
            lowest, highest = lowest + weights[i] * lower[i], highest + weights[i] * upper[i]
    return lowest, highest


@kernel
def _limit_at_constant_shear(law: Any, own: Any, path: Any, f: float) -> float:
    """The highest |Q| that friction can carry at all contacts of a path."""
    last, highest = path.shape[0] - 1, 0.0
    for i in range(POINTS):
        x, weight = _point(path[0], path[last], (i + 0.5) / POINTS)
        least = math.inf
        for k in range(last + 1):
            least = min(least, law.pressure(x, path[k, A], path[k, C], own))
        if least < math.inf:
            highest += weight * f * least
    return highest


@kernel
def holds_load(law: Any, own: Any, ends: Any, cycle: Any, regime: float, Q: float) -> Any:
    """Whether the stick zone of a cycle can carry Q, the shear load at its first end.

    ends  both contacts, as returned by zone.ends_of
    """
    f = cycle[6]
    rough = ROUGH * f * min(ends[0, LOAD], ends[1, LOAD])
    if regime == LARGE:
        path = load_path(law, own, ends)
        lowest, highest = _limits_under_large_tension(law, own, path, cycle)
        return lowest - rough <= Q <= highest + rough
    if regime == FULL_STICK and cycle[4] == cycle[5] == 0:
        path = load_path(law, own, ends)
        return abs(Q) <= _limit_at_constant_shear(law, own, path, f) + rough
    return True
