r"""Moderate tension in phase at constant normal loads: the exact solution, a stack of reversals.

Let sigma = k Q at all instants, |k| <= 8/(pi h) with h the contact width, and |Q| < f P.  For E* =
1 let [-m, n] be the contact under the load P - D/(2 f) at the tilt alpha - k D/(4 f), and

    F(x; D) = f p(x) - f p(x; m, n),       int F dx = D/2.

In the first loading q = +-F(D) with D = 2 |Q|.  After a reversal q changes by +-2 F(D), where D is
the change in Q since the reversal.  A branch is the loading between two reversals.  When D reaches
that of the branch before, the inner loop is closed: both branches are removed, and the branch
before them continues.  If the branch before is the first loading, q becomes that of a first loading
in the opposite direction.  Thus q is a sum over the reversals whose loops are still open, and each
of them has a smaller D than the one before.

Proof.  In [-m, n] the pressures of both contacts satisfy the equation of the normal contact with
the same g'.  Their difference satisfies (1/pi) PV int 2 F/(x - xi) dxi = k D/4 there, which is the
condition of stick under the change in tension.  In [-m, n] nothing slips, and outside it q has
changed from -+f p to +-f p.  While D grows, the load and the tilt of [-m, n] fall.  The pressure
falls as under a flat punch, by an even function plus an odd one, both over a square root.  The sum
is positive in all of [-m, n] if |k| <= 8/(pi (m + n)), which holds because m + n <= h.  Hence m and
n fall: slip zones grow from the edges, and the slip in them, 2 f times the gap outside [-m, n],
grows in the direction of Q.  F grows everywhere.  Therefore |q| <= f p, because q lies between its
values at the last two reversals.  A branch slips only where the branch before it has slipped,
because its D is smaller, and therefore it starts there from the opposite bound.  When the two D are
equal, the change of the branch cancels that of the branch before.  These are all conditions of the
shear problem, whose solution is unique.

This is return-point memory, after Cattaneo and Mindlin, Jaeger, and Ciavarella.

The slope of the gap outside [-m, n] is

    (w(x)/pi) int_-m^n (g'(x) - g'(s))/((x - s) sqrt((m + s)(n - s))) ds,

w = sqrt((x + m)(x - n)), negative on the left.  This slope follows from g' outside the contact
as the pressure follows from g' inside.
"""

import math
from typing import Any

import numpy as np

from ..inverse import contact, contact_at_tilt
from ..kernels import LAW, LOOP, kernel, matrix, opened, real, vector, whole
from ..slip.shear import change_at
from ..types import FEATURES, FULL_STICK, MODERATE
from .path import SIGMA, M, P, Q

IN_PHASE = 1e-9
"""Largest difference between sigma and k Q, relative to the largest sigma."""

ROUNDING = 1e-12
"""A closed loop is removed only if D exceeds that of the loop by more than this fraction of f P."""

CHANGE, LEFT, RIGHT, WORK, POINTS = range(5)
"""Columns of the stack: D, m, n, frictional work over a whole branch of that D, and from POINTS on
the change in shear and then the slip of the branch at the points."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(14)
_NODES, _WEIGHTS = (1 + _NODES) / 2, _WEIGHTS / 2
"""Gauss's rule on (0, 1)."""

_PLACES, _LENGTHS = np.polynomial.legendre.leggauss(24)
_PLACES, _LENGTHS = (1 + _PLACES) / 2, _LENGTHS / 2
_LENGTHS *= 140 * _PLACES**3 * (1 - _PLACES) ** 3
_PLACES = _PLACES**4 * (35 - 84 * _PLACES + 70 * _PLACES**2 - 20 * _PLACES**3)
"""The same, for a function that has a square root or a logarithm at both ends."""


@kernel(real(matrix, real))
def _tension(loads: Any, f: float) -> float:
    """k; NaN if the normal loads vary, sigma is not k Q, or the contact slides at an instant."""
    most, largest, k = 0.0, 0.0, 0.0
    for j in range(loads.shape[1]):
        for i in range(4):
            if not math.isfinite(loads[i, j]):
                return math.nan
        if loads[P, j] != loads[P, 0] or loads[M, j] != loads[M, 0]:
            return math.nan
        largest = max(largest, abs(loads[SIGMA, j]))
        if abs(loads[Q, j]) > most:
            most, k = abs(loads[Q, j]), loads[SIGMA, j] / loads[Q, j]
    if not most < f * loads[P, 0] * (1 - ROUNDING):
        return math.nan
    for j in range(loads.shape[1]):
        if abs(loads[SIGMA, j] - k * loads[Q, j]) > IN_PHASE * largest:
            return math.nan
    return k


@kernel(real(vector, real, real))
def _next_break(breaks: Any, low: float, high: float) -> float:
    """The first break between `low` and `high`, or `high` if there is none."""
    for x in breaks:
        if low < x < high:
            high = x
    return high


@kernel(real(LAW, vector, vector, real, real, real))
def _gap_slope(law: Any, own: Any, breaks: Any, m: float, n: float, x: float) -> float:
    """The slope of the gap at a point x outside [-m, n]."""
    half, mid, here, total = (m + n) / 2, (n - m) / 2, law.slope(x, own)[0], 0.0
    low = -m
    while low < n:
        high = _next_break(breaks, low, n)
        start = math.acos(min(max((high - mid) / half, -1.0), 1.0))
        width = math.acos(min(max((low - mid) / half, -1.0), 1.0)) - start
        for i in range(_NODES.size):
            s = mid + half * math.cos(start + width * _NODES[i])
            total += width * _WEIGHTS[i] * (here - law.slope(s, own)[0]) / (x - s)
        low = high
    return math.sqrt((x + m) * (x - n)) / math.pi * total


@kernel(real(LAW, vector, vector, real, real, real))
def gap(law: Any, own: Any, breaks: Any, m: float, n: float, x: float) -> float:
    """The gap at x outside the contact [-m, n]; zero inside it."""
    if -m <= x <= n:
        return 0.0
    total, low = 0.0, n if x > n else x
    end = x if x > n else -m
    while low < end:
        high = _next_break(breaks, low, end)
        for i in range(_NODES.size):
            # next to the contact the slope is like the square root of the distance
            t, rest = _NODES[i], 1 - _NODES[i]
            node = low + (high - low) * (t * t if x > n else 1 - rest * rest)
            weight = 2 * (high - low) * _WEIGHTS[i] * (t if x > n else rest)
            total += weight * _gap_slope(law, own, breaks, m, n, node)
        low = high
    return total


@kernel(real(LAW, vector, vector, real, real))
def _dissipated(law: Any, own: Any, cycle: Any, m: float, n: float) -> float:
    """Frictional work of a branch, int f p slip dx."""
    total, breaks = 0.0, law.breaks(own)
    for side in range(2):
        low, end = (-cycle[0], -m) if side == 0 else (n, cycle[1])
        while low < end:
            high = _next_break(breaks, low, end)
            for i in range(_PLACES.size):
                # the pressure is like a square root at an edge, and like a logarithm at a corner
                x = low + (high - low) * _PLACES[i]
                p = law.pressure(x, cycle[0], cycle[1], own)
                if 0 < p < math.inf:
                    total += (high - low) * _LENGTHS[i] * p * gap(law, own, breaks, m, n, x)
            low = high
    return 2 * cycle[6] ** 2 * total


@kernel(whole(LAW, vector, vector, vector, vector, real, vector))
def _branch(law: Any, own: Any, cycle: Any, normal: Any, points: Any, k: float, row: Any) -> int:
    """Complete a row of the stack from its D; return 0 if there is no zone.

    normal: P and the tilt.
    """
    m, n = cycle[0], cycle[1]
    if row[CHANGE] > 0:
        load, tilt = normal[0] - row[CHANGE] / (2 * cycle[6]), normal[1]
        m, n = contact_at_tilt(law, own, load, tilt - k * row[CHANGE] / (4 * cycle[6]))
        if not m + n > 0:
            return 0
        m, n = min(m, cycle[0]), min(n, cycle[1])
    row[LEFT], row[RIGHT], row[WORK] = m, n, _dissipated(law, own, cycle, m, n)
    breaks = law.breaks(own)
    for i in range(points.size):
        x, slip = points[i], math.nan
        row[POINTS + i] = change_at(law, own, cycle, m, n, MODERATE, x)
        if -cycle[0] <= x <= cycle[1]:
            slip = 2 * cycle[6] * gap(law, own, breaks, m, n, x)
        row[POINTS + points.size + i] = slip
    return 1


@kernel(whole(LAW, vector, real, matrix, vector, vector))
def moderate_history(law: Any, own: Any, f: float, loads: Any, points: Any, out: Any) -> int:
    """Write a history in the form of solve.each_history; return 0 if it is not of this kind.

    Meanwhile out[0] is the completed fraction, times -1.
    """
    instants, asked = loads.shape[1], points.size
    k = _tension(loads, f)
    if math.isnan(k):
        return 0
    a, c, tilt = contact(law, own, loads[P, 0], loads[M, 0])
    if not (a + c > 0 and abs(k) * math.pi * (a + c) <= 8):
        return 0
    values = np.zeros(out.size)
    normal, cycle = np.array([loads[P, 0], tilt]), np.array([a, c, a, c, 0.0, 0.0, f])
    stack, top, sign = np.zeros((instants + 1, POINTS + 2 * asked)), -1, 1.0
    last_Q, work, rounding = 0.0, 0.0, ROUNDING * f * loads[P, 0]
    for j in range(instants):
        out[0] = -j / instants
        left = abs(loads[Q, j] - last_Q)
        if left > 0 or j == 0:
            new_sign = math.copysign(1.0, loads[Q, j] - last_Q)
            if top < 0 or new_sign != sign:
                top += 1
                stack[top] = 0.0
            sign, last_Q = new_sign, loads[Q, j]
            # remove loops that are closed between the two instants
            while top > 0 and left > stack[top - 1, CHANGE] - stack[top, CHANGE] + rounding:
                left -= stack[top - 1, CHANGE] - stack[top, CHANGE]
                work += stack[top - 1, WORK] - stack[top, WORK]
                top -= 2 if top > 1 else 1
            before, scale = stack[top, WORK], 1.0 if top > 0 else 0.5
            stack[top, CHANGE] += left / scale
            if top > 0:
                stack[top, CHANGE] = min(stack[top, CHANGE], stack[top - 1, CHANGE])
            if not _branch(law, own, cycle, normal, points, k, stack[top]):
                return 0
            work += scale * (stack[top, WORK] - before)
        here = values[j * (FEATURES + 2 * asked) : (j + 1) * (FEATURES + 2 * asked)]
        here[0], here[1], here[4], here[6] = a, c, 1.0, work
        here[2], here[3] = stack[top, LEFT], stack[top, RIGHT]
        here[5] = MODERATE if stack[top, CHANGE] > 0 else FULL_STICK
        for b in range(top + 1):
            factor = (sign if (top - b) % 2 == 0 else -sign) * (1.0 if b > 0 else 0.5)
            for i in range(2 * asked):
                here[FEATURES + i] += factor * stack[b, POINTS + i]
    out[:] = values
    return 1


@kernel(LOOP)
def each_history(law: Any, given: Any, own: Any, out: Any) -> None:
    """Exact histories; `given` and `out` as in solve.each_history.

    All results of a history that is not of this kind are NaN.
    """
    law = opened(law)
    for row in range(given.shape[0]):
        asked = int(given[row, 2])
        count = (given.shape[1] - 3 - asked) // 4
        loads = given[row, 3 : 3 + 4 * count].reshape((4, count))
        points = given[row, 3 + 4 * count :]
        if not moderate_history(law, own[row], given[row, 0], loads, points, out[row]):
            out[row] = math.nan
