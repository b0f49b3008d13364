r"""Moderate tension in phase at constant normal loads: the exact answer, a stack of reversals.

Let sigma = k Q at all instants, |k| <= 8/(pi h) with h the contact's width, and |Q| < f P.  Let
[-m, n] be the contact under the load P - D/(2 f) at the tilt alpha - k D/(4 f), for E* = 1, and

    F(x; D) = f p(x) - f p(x; m, n),       int F dx = D/2.

From nothing q = +-F(D) with D = 2 |Q|.  Since a reversal q has changed by +-2 F(D), D being the
change of Q since then.  A reversal is forgotten when D comes to that of the branch before it: the
inner loop is closed, and the branch before both goes on; where the branch before it is the first
one, shear is that of a first loading the other way.  So q is a sum over the reversals that are not
closed, and each of them has a smaller D than the one before.

Proof.  Where both contacts hold, their pressures meet the equation of the normal contact with the
same g'.  Their difference leaves (1/pi) PV int 2 F/(x - xi) dxi = k D/4 in [-m, n]: what the
tension asks of shear where it sticks.  There nothing slips, and beside it q has come from -+f p to
+-f p.  While D grows, load and tilt of [-m, n] fall as under a flat punch, by an even pressure plus
an odd one over a root; it is positive all over [-m, n] if |k| <= 8/(pi (m + n)), and m + n <= h.
So m and n fall: slip zones grow from the edges, and slip in them, 2 f times the gap beside [-m, n],
grows with the sense of Q.  F grows everywhere: |q| <= f p, since q lies between its values at the
last two reversals.  A branch slips only where the branch before it has slipped, for its D is
smaller, so that it starts there from the other bound.  When the two are equal, its change takes
back that of the branch before.  These are all conditions of the shear problem, and its solution is
one alone.

That is return-point memory, after Cattaneo and Mindlin, Jaeger, and Ciavarella.

The gap beside [-m, n] opens with the slope

    (w(x)/pi) int_-m^n (g'(x) - g'(s))/((x - s) sqrt((m + s)(n - s))) ds,

w = sqrt((x + m)(x - n)), negative on the left: what g' leaves outside of the contact, as the
pressure is what it leaves inside.
"""

import math
from typing import Any

import numpy as np

from ..inverse import contact, contact_at_tilt
from ..kernels import LAW, LOOP, kernel, matrix, opened, real, vector, whole
from ..slip.shear import change_at
from .path import SIGMA, M, P, Q

MODERATE, FULL_STICK = 1.0, 5.0
"""Codes of Regime."""

FEATURES = 9
"""a, c, m, n, intervals, regime, work, error and work_error of an instant, as of `solve`."""

IN_PHASE = 1e-9
"""How far sigma may be from k Q, over the largest."""

ROUNDING = 1e-12
"""A loop that is closed to this part of f P is not passed."""

CHANGE, LEFT, RIGHT, WORK, PLACES = range(5)
"""Columns of the stack: D, m, n, friction's work over a whole branch of that D, and from PLACES on
its change of shear and then its slip at the places."""

_PLACES, _SHARES = np.polynomial.legendre.leggauss(14)
_PLACES, _SHARES = (1 + _PLACES) / 2, _SHARES / 2
"""Gauss's rule on (0, 1)."""


@kernel(real(matrix, real))
def _tension(loads: Any, f: float) -> float:
    """k; NaN where the normal loads vary, sigma is not k Q, or it slides at an instant."""
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
    """The first break behind `low`, `high` at last."""
    for place in breaks:
        if low < place < high:
            high = place
    return high


@kernel(real(LAW, vector, vector, real, real, real))
def _opening(law: Any, own: Any, breaks: Any, m: float, n: float, x: float) -> float:
    """How steep the gap is at x, outward; x outside of [-m, n]."""
    half, mid, here, total = (m + n) / 2, (n - m) / 2, law.slope(x, own)[0], 0.0
    low = -m
    while low < n:
        high = _next_break(breaks, low, n)
        start = math.acos(min(max((high - mid) / half, -1.0), 1.0))
        width = math.acos(min(max((low - mid) / half, -1.0), 1.0)) - start
        for i in range(_PLACES.size):
            s = mid + half * math.cos(start + width * _PLACES[i])
            total += width * _SHARES[i] * (here - law.slope(s, own)[0]) / (x - s)
        low = high
    return math.sqrt((x + m) * (x - n)) / math.pi * total


@kernel(real(LAW, vector, vector, real, real, real))
def gap(law: Any, own: Any, breaks: Any, m: float, n: float, x: float) -> float:
    """The gap at x beside the contact [-m, n]; zero in it."""
    if -m <= x <= n:
        return 0.0
    total, low = 0.0, n if x > n else x
    end = x if x > n else -m
    while low < end:
        high = _next_break(breaks, low, end)
        for i in range(_PLACES.size):
            # the slope begins like a root at the contact
            t, rest = _PLACES[i], 1 - _PLACES[i]
            at = low + (high - low) * (t * t if x > n else 1 - rest * rest)
            weight = 2 * (high - low) * _SHARES[i] * (t if x > n else rest)
            total += weight * _opening(law, own, breaks, m, n, at)
        low = high
    return total


@kernel(real(LAW, vector, vector, real, real))
def _taken(law: Any, own: Any, cycle: Any, m: float, n: float) -> float:
    """int f p slip dx over a branch: what friction takes."""
    total, breaks = 0.0, law.breaks(own)
    for side in range(2):
        low, end = (-cycle[0], -m) if side == 0 else (n, cycle[1])
        while low < end:
            high = _next_break(breaks, low, end)
            for i in range(_PLACES.size):
                # the pressure ends like a root at the edge
                angle = math.pi / 2 * _PLACES[i]
                x = low + (high - low) * math.sin(angle) ** 2
                p = law.pressure(x, cycle[0], cycle[1], own)
                if 0 < p < math.inf:
                    weight = math.pi / 2 * (high - low) * math.sin(2 * angle) * _SHARES[i]
                    total += weight * p * gap(law, own, breaks, m, n, x)
            low = high
    return 2 * cycle[6] ** 2 * total


@kernel(whole(LAW, vector, vector, vector, vector, real, vector))
def _branch(law: Any, own: Any, cycle: Any, normal: Any, places: Any, k: float, row: Any) -> int:
    """Complete a row of the stack from its D; normal: P and the tilt.  0 where there is no zone."""
    m, n = cycle[0], cycle[1]
    if row[CHANGE] > 0:
        load, tilt = normal[0] - row[CHANGE] / (2 * cycle[6]), normal[1]
        m, n = contact_at_tilt(law, own, load, tilt - k * row[CHANGE] / (4 * cycle[6]))
        if not m + n > 0:
            return 0
        m, n = min(m, cycle[0]), min(n, cycle[1])
    row[LEFT], row[RIGHT], row[WORK] = m, n, _taken(law, own, cycle, m, n)
    breaks = law.breaks(own)
    for i in range(places.size):
        x, slip = places[i], math.nan
        row[PLACES + i] = change_at(law, own, cycle, m, n, MODERATE, x)
        if -cycle[0] <= x <= cycle[1]:
            slip = 2 * cycle[6] * gap(law, own, breaks, m, n, x)
        row[PLACES + places.size + i] = slip
    return 1


@kernel(whole(LAW, vector, real, matrix, vector, vector))
def stacked(law: Any, own: Any, f: float, loads: Any, places: Any, out: Any) -> int:
    """A history, written as by solve.each_history; 0 where it is not of this kind."""
    instants, asked = loads.shape[1], places.size
    k = _tension(loads, f)
    if math.isnan(k):
        return 0
    a, c, tilt = contact(law, own, loads[P, 0], loads[M, 0])
    if not (a + c > 0 and abs(k) * math.pi * (a + c) <= 8):
        return 0
    normal, cycle = np.array([loads[P, 0], tilt]), np.array([a, c, a, c, 0.0, 0.0, f])
    stack, top, sense = np.zeros((instants + 1, PLACES + 2 * asked)), -1, 1.0
    at, work, nearly = 0.0, 0.0, ROUNDING * f * loads[P, 0]
    for j in range(instants):
        left = abs(loads[Q, j] - at)
        if left > 0 or j == 0:
            turned = math.copysign(1.0, loads[Q, j] - at)
            if top < 0 or turned != sense:
                top += 1
                stack[top] = 0.0
            sense, at = turned, loads[Q, j]
            # loops that are closed on the way
            while top > 0 and left > stack[top - 1, CHANGE] - stack[top, CHANGE] + nearly:
                left -= stack[top - 1, CHANGE] - stack[top, CHANGE]
                work += stack[top - 1, WORK] - stack[top, WORK]
                top -= 2 if top > 1 else 1
            before, share = stack[top, WORK], 1.0 if top > 0 else 0.5
            stack[top, CHANGE] += left / share
            if top > 0:
                stack[top, CHANGE] = min(stack[top, CHANGE], stack[top - 1, CHANGE])
            if not _branch(law, own, cycle, normal, places, k, stack[top]):
                return 0
            work += share * (stack[top, WORK] - before)
        told = out[j * (FEATURES + 2 * asked) : (j + 1) * (FEATURES + 2 * asked)]
        told[:] = 0.0
        told[0], told[1], told[4], told[6] = a, c, 1.0, work
        told[2], told[3] = stack[top, LEFT], stack[top, RIGHT]
        told[5] = MODERATE if stack[top, CHANGE] > 0 else FULL_STICK
        for b in range(top + 1):
            way = (sense if (top - b) % 2 == 0 else -sense) * (1.0 if b > 0 else 0.5)
            for i in range(2 * asked):
                told[FEATURES + i] += way * stack[b, PLACES + i]
    return 1


@kernel(LOOP)
def each_history(law: Any, given: Any, own: Any, out: Any) -> None:
    """given and out as of solve.each_history; NaN where a history is not of this kind."""
    law = opened(law)
    for row in range(given.shape[0]):
        asked = int(given[row, 2])
        count = (given.shape[1] - 3 - asked) // 4
        loads = given[row, 3 : 3 + 4 * count].reshape((4, count))
        places = given[row, 3 + 4 * count :]
        if not stacked(law, own[row], given[row, 0], loads, places, out[row]):
            out[row] = math.nan
