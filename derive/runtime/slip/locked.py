r"""Whether the stick zone can hold the shear load of the cycle.

The stick zone follows from the changes of the loads, dQ and dsigma.  It is permanent only if there
is a shear traction q1 at the first end of the half-cycle that carries Q there and is within
friction at both ends:

    -f p1 <= q1 <= f p1,    -f p2 <= q1 + dq <= f p2.

Then Q lies between the integrals of the largest lower and the smallest upper of these limits.  In a
slip zone both are equal, and q1 is -f p1 or f p1.  If Q lies outside, every point slips in every
cycle, and the bodies creep along each other although |Q| < f P.

Under large tension at a high mean shear load this happens, as the slip zones slip in opposite
directions and carry little.  If nothing slips under the changes of the loads, it happens only if
the moment rocks the contact and Q and sigma are constant: dq = 0, and the limits hold on the whole
path.  If both edges advance, |dq| <= f dp everywhere, so that |Q| < f P is enough.  Under moderate
tension f p1 + dq = f p2 + 2 f (p1 - p_s) is above f p2, p_s being the pressure of the contact
[-m, n], which is below p1: every Q < f P2 can be carried.
"""

import math
from typing import Any

from ..kernels import LAW, kernel, matrix, real, results, truth, vector
from .bounded import beside, change, friction, oriented, sense_of
from .moderate import LOAD, A, C
from .shear import FULL_STICK, LARGE, LEVEL

POINTS = 200
"""Points at which the limits are integrated."""

ROUGH = 1e-3
"""Accuracy of the integrals over f P."""


@kernel(results(2)(LAW, vector, matrix, vector, real, real, real))
def limits_of_load(
    law: Any, own: Any, path: Any, cycle: Any, m: float, n: float, regime: float
) -> Any:
    """The lowest and the highest Q at the first end of a half-cycle of LARGE or FULL_STICK.

    path  contacts from the first end to the second, as by growth.load_path
    """
    f, last = cycle[6], path.shape[0] - 1
    left, right = path[0, A], path[0, C]
    for k in range(1, last + 1):
        left, right = max(left, path[k, A]), max(right, path[k, C])
    sense, mirrored = sense_of(cycle), oriented(cycle)
    of = friction(law, own, mirrored, sense, -1.0, math.nan)
    inner, outer = (m, n) if sense > 0 else (n, m)
    slip = beside(of, inner, outer, of.a - inner, of.c - outer, LEVEL)
    lowest = highest = 0.0
    for i in range(POINTS):
        angle = math.pi * (i + 0.5) / POINTS
        x = -left + (left + right) * math.sin(angle / 2) ** 2
        weight = math.pi / POINTS * (left + right) / 2 * math.sin(angle)
        first = f * law.pressure(x, path[0, A], path[0, C], own)
        upper, lower = first, -first
        if regime == LARGE:
            second = f * law.pressure(x, path[last, A], path[last, C], own)
            dq = change(slip, sense * x)
            if x <= -m or x >= n:
                forward = (x <= -m) == (sense > 0)
                dq = first + second if forward else -first - second
            upper, lower = min(upper, second - dq), max(lower, -second - dq)
        else:
            for k in range(1, last + 1):
                upper = min(upper, f * law.pressure(x, path[k, A], path[k, C], own))
            lower = -upper
        if upper < math.inf and lower > -math.inf:
            lowest, highest = lowest + weight * lower, highest + weight * upper
    return lowest, highest


@kernel(truth(LAW, vector, matrix, vector, real, real, real, real))
def holds_load(
    law: Any, own: Any, path: Any, cycle: Any, m: float, n: float, regime: float, Q: float
) -> Any:
    """Whether a cycle whose shear load is Q at its first end can stick in [-m, n]."""
    if regime == FULL_STICK and (path.shape[0] == 2 or cycle[4] != 0 or cycle[5] != 0):
        return True
    if regime not in (LARGE, FULL_STICK):
        return True
    lowest, highest = limits_of_load(law, own, path, cycle, m, n, regime)
    rough = ROUGH * cycle[6] * min(path[0, LOAD], path[path.shape[0] - 1, LOAD])
    return lowest - rough <= Q <= highest + rough
