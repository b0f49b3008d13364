r"""Whether the stick zone can carry the shear load of the cycle.

The stick zone follows from the changes in the loads, dQ and dsigma.  It is permanent only if there
is a shear traction q1 at the first end of the half-cycle that carries Q there and is within the
friction limit at both ends:

    -f p1 <= q1 <= f p1,    -f p2 <= q1 + dq <= f p2.

Then Q lies between the integrals of the largest lower and the smallest upper of these limits.  In a
slip zone both are equal, and q1 is -f p1 or f p1.  If Q lies outside, every point slips in every
cycle, and the bodies ratchet along each other although |Q| < f P.

Under large tension at a high mean shear load this happens, because the slip zones slip in opposite
directions and carry little.  If nothing slips under the changes in the loads, it happens only if
the moment rocks the contact and Q and sigma are constant: dq = 0, and the limits hold on the whole
path.  If both edges advance, |dq| <= f dp everywhere, so that |Q| < f P is enough.  Under moderate
tension f p1 + dq = f p2 + 2 f (p1 - p_s) is above f p2, p_s being the pressure of the contact
[-m, n], which is below p1: every Q < f P2 can be carried.  The same holds if forward slip overtakes
reversed slip, because it ends in the moderate solution.  Other zones between reversed slip carry
less; the elements of a steady cycle tell whether they can carry Q.
"""

import math
from typing import Any

from ..kernels import LAW, kernel, matrix, real, results, truth, vector
from ..types import FULL_STICK, LARGE
from .bounded import beside, change, friction, oriented, sense_of
from .growth import load_path
from .moderate import LOAD, A, C
from .shear import LEVEL

POINTS = 200
"""Points at which the limits are integrated."""

ROUGH = 1e-3
"""Accuracy of the integrals, relative to f P."""


@kernel(results(2)(vector, vector, real))
def _point(first: Any, second: Any, part: float) -> Any:
    """A point of the union of two contacts, and its weight; `part` goes from 0 to 1."""
    left, right = max(first[A], second[A]), max(first[C], second[C])
    angle = math.pi * part
    x = -left + (left + right) * math.sin(angle / 2) ** 2
    return x, math.pi / POINTS * (left + right) / 2 * math.sin(angle)


@kernel(results(2)(LAW, vector, matrix, vector, real, real))
def _limits_under_large_tension(
    law: Any, own: Any, ends: Any, cycle: Any, m: float, n: float
) -> Any:
    """The lowest and the highest Q at the first end."""
    f, sense, lowest, highest = cycle[6], sense_of(cycle), 0.0, 0.0
    of = friction(law, own, oriented(cycle), sense, -1.0, math.nan)
    inner, outer = (m, n) if sense > 0 else (n, m)
    slip = beside(of, inner, outer, of.a - inner, of.c - outer, LEVEL)
    for i in range(POINTS):
        x, weight = _point(ends[0], ends[1], (i + 0.5) / POINTS)
        first = f * law.pressure(x, ends[0, A], ends[0, C], own)
        second = f * law.pressure(x, ends[1, A], ends[1, C], own)
        if not first + second < math.inf:
            continue  # at a corner
        dq = change(slip, sense * x)
        if x <= -m or x >= n:
            dq = first + second if (x <= -m) == (sense > 0) else -first - second
        highest += weight * min(first, second - dq)
        lowest += weight * max(-first, -second - dq)
    return lowest, highest


@kernel(real(LAW, vector, matrix, real))
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


@kernel(truth(LAW, vector, matrix, vector, real, real, real, real))
def holds_load(
    law: Any, own: Any, ends: Any, cycle: Any, m: float, n: float, regime: float, Q: float
) -> Any:
    """Whether a cycle whose shear load is Q at its first end can stick in [-m, n].

    ends  both contacts, as returned by zone.ends_of
    """
    f = cycle[6]
    rough = ROUGH * f * min(ends[0, LOAD], ends[1, LOAD])
    if regime == LARGE:
        lowest, highest = _limits_under_large_tension(law, own, ends, cycle, m, n)
        return lowest - rough <= Q <= highest + rough
    if regime == FULL_STICK and cycle[4] == cycle[5] == 0:
        path = load_path(law, own, ends)
        return abs(Q) <= _limit_at_constant_shear(law, own, path, f) + rough
    return True
