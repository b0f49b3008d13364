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
"""

import math
from typing import Any

import numpy as np

from ..body import Body
from ..cycle import Own, contact, contact_at_tilt, pressure
from ..forward import breaks_of
from ..kernels import loop, opened
from ..slip.cycles import Cycle
from ..slip.quadrature import FINEST, ROUGH, slip_zone
from ..slip.shear import slip
from ..types import Array, History, Regime
from .nearest import ROUNDING

IN_PHASE = 1e-9
"""Largest difference between sigma and k Q, relative to the largest sigma."""


@loop
def each_branch(law: Any, given: Any, points: Any, own: Any, out: Any) -> None:
    """a, c, m, n, f -> frictional work, int f p slip dx, then slip at the points."""
    law = opened(law)
    for i in range(given.shape[0]):
        a, c, m, n, f = given[i, 0], given[i, 1], given[i, 2], given[i, 3], given[i, 4]
        cycle, zone, work = Cycle(a, c, a, c, 0.0, 0.0, f), (m, n, Regime.MODERATE.value), 0.0
        for side, start, edge in ((-1.0, m, a), (1.0, n, c)):
            slips = slip_zone(law, own[0], cycle, side, edge - start, math.nan, ROUGH)
            for k in range(slips.y.size):
                x = side * min(start + slips.y[k], edge)
                slipped = slip(law, own[0], cycle, zone, x, ROUGH)
                work += slips.weight[k] * slips.r[k] / 2 * slipped
        out[i, 0] = work
        for k in range(points.shape[1]):
            out[i, 1 + k] = slip(law, own[0], cycle, zone, points[0, k], FINEST)


# ---------------------------------------------------------------- the stack


def _tension(loads: Array, f: float) -> float:
    """k; NaN if the normal loads vary, sigma is not k Q, or the contact slides at an instant."""
    P, M, Q, sigma = loads
    if not (np.all(P[0] == P) and np.all(M[0] == M) and np.all(abs(Q) < f * P[0] * (1 - ROUNDING))):
        return math.nan
    most = np.argmax(abs(Q))
    k = float(sigma[most] / Q[most]) if Q[most] != 0 else 0.0
    in_phase = abs(sigma - k * Q) <= IN_PHASE * np.max(abs(sigma))
    return k if np.all(in_phase) else math.nan


class _Stack:
    """The stack of reversals under the shear loads Q.

    size    D of the last branch at each instant
    open    the branches whose loops are open at each instant, the last one last, as the instants at
            which they had their present D, and the direction of the last one
    work    the work since the instant before, as instants and factors: the sum of the work over
            whole branches of the D at these instants, times the factors
    """

    def __init__(self, Q: Array, rounding: float) -> None:
        """Follow Q; a closed loop is removed only if D exceeds that of the loop by `rounding`."""
        self.size = np.zeros(Q.size + 1)  # the last one is that of a branch that begins
        self.open: list[tuple[list[int], float]] = []
        self.work: list[list[tuple[int, float]]] = []
        stack, sign, last = [-1], 0.0, 0.0
        for j, load in enumerate(Q):
            left, terms = abs(load - last), []
            if left > 0:
                if math.copysign(1.0, load - last) == -sign:
                    stack.append(-1)
                sign, last = math.copysign(1.0, load - last), load
                # remove loops that are closed between the two instants
                while len(stack) > 1 and left > self._missing(stack) + rounding:
                    left -= self._missing(stack)
                    terms += [(stack[-2], 1.0), (stack[-1], -1.0)]
                    del stack[-2 if len(stack) > 2 else -1 :]
            scale = 1.0 if len(stack) > 1 else 0.5
            self.size[j] = self.size[stack[-1]] + left / scale
            if len(stack) > 1:
                self.size[j] = min(self.size[j], self.size[stack[-2]])
            terms += [(j, scale), (stack[-1], -scale)]
            stack[-1] = j
            self.open.append((stack.copy(), sign))
            self.work.append(terms)

    def _missing(self, stack: list[int]) -> float:
        """The change in Q that closes the last loop."""
        return float(self.size[stack[-2]] - self.size[stack[-1]])

    def sums(self, whole: Array) -> Array:
        """Sums over the open branches at each instant of their values, a row each."""
        rows = []
        for stack, sign in self.open:
            factors = sign * (-1.0) ** np.arange(len(stack))[::-1]
            factors[0] /= 2
            rows.append(factors @ whole[stack])
        return np.array(rows)

    def total(self, whole: Array) -> Array:
        """The work up to each instant, from that over whole branches."""
        whole = np.append(whole, 0.0)
        return np.cumsum([sum(factor * whole[i] for i, factor in terms) for terms in self.work])


def exact_history(body: Body, own: Own, f: float, loads: Array, x: Array) -> History | None:
    """The history at the points x for E* = 1; None if it is not of this kind.

    loads: P, M, Q and sigma, one row each.
    """
    k, P = _tension(loads, f), loads[0, 0]
    a, c, tilt = contact(body, own, P, loads[1, 0], 1.0)
    if not (math.isfinite(k) and a + c > 0 and abs(k) * math.pi * (a + c) <= 8):
        return None
    stack = _Stack(loads[2], ROUNDING * f * P)
    D = stack.size[:-1]
    found = contact_at_tilt(body, own, P - D / (2 * f), tilt - k * D / (4 * f), 1.0)
    m: Array = np.where(D > 0, np.minimum(found.a, a), a)
    n: Array = np.where(D > 0, np.minimum(found.c, c), c)
    if not np.all(m + n > 0):
        return None
    full = np.ones(D.size)
    given = np.column_stack([full * a, full * c, m, n, full * f])
    out = np.empty((D.size, 1 + x.size))
    each_branch(body.law, given, x[None].copy(), np.array([[*own.values()]], dtype=float), out)
    # at a corner the pressure is infinite, but its change is not: take it close by
    corner = np.isin(x, breaks_of(body.law, own.values())) & (x > -m[:, None]) & (x < n[:, None])
    places = np.where(corner, x + 1e-12 * (a + c), x)
    before = pressure(body, own, places, a, c, 1.0)
    change = 2 * f * (before - pressure(body, own, places, m[:, None], n[:, None], 1.0))
    regime = np.where(D > 0, Regime.MODERATE, Regime.FULL_STICK)
    whole, exact = np.ones(D.size, dtype=np.int64), np.zeros(D.size)
    zone = a * full, c * full, m, n, whole, regime
    slips, work = stack.sums(out[:, 1:]), stack.total(out[:, 0])
    return History(*zone, stack.sums(change), slips, work, exact)
