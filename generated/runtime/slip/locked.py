r"""Whether the stick zone can carry the shear load of the cycle.

The stick zone follows from the changes in the loads, dQ and dsigma.  It is permanent only if there
is a shear traction q_1 at the first end of the half-cycle that carries Q there and never exceeds
the friction limit.  Let dq be the change in a half-cycle up to some instant, p the pressure at that
instant, and dq_12 the change over the whole half-cycle.  On the way there, and on the way back,

    -f p <= q_1 + dq <= f p,    -f p <= q_1 + dq_12 - dq <= f p.

Then Q lies between the integrals of the largest lower and the smallest upper of these limits.  In a
slip zone both are equal, and q_1 is -f p_1 or f p_1.  If Q lies outside, every point slips in every
cycle, and the bodies ratchet along each other although |Q| < f P.

Under large tension at a high mean shear load this happens, because the slip zones slip in opposite
directions and carry little.  In parts of the stick zone dq falls before it rises, or the reverse,
so that instants between the ends count as well.  If nothing slips under the changes in the loads,
it happens only if the moment rocks the contact and Q and sigma are constant: dq = 0.  If both edges
advance, |dq| <= f dp everywhere, so that |Q| < f P is enough.  Under moderate tension dq grows
everywhere, and f p_1 + dq = f p_2 + 2 f (p_1 - p_s) is above f p_2, p_s being the pressure of the
contact [-m, n], which is below p_1: every Q < f P_2 can be carried.  The same holds if forward slip
overtakes reversed slip, because it ends in the moderate solution.  Other zones between reversed
slip carry less; the elements of a steady cycle tell whether they can carry Q.
"""

from typing import Any

import numpy as np

from ..arrays import solved
from ..body import Body
from ..forward import UNIT, each_contact, each_pressure
from ..types import Array, Contact, Edges, Regime
from .growth import PARTS
from .shear import each_shear_change
from .zone import each_zone_of_regime

POINTS = 200
"""Number of points at which the limits are integrated."""

LIMIT_RTOL = 1e-3
"""Allowance for the error of the integrals, relative to f P."""


def carries(
    body: Body, own: dict[str, Any], f: Any, first: Array, last: Array, regime: int
) -> bool:
    """Whether the stick zone of a half-cycle of a regime can carry the shear load.

    first, last: P, M, Q and sigma at its ends, divided by E*; Q does not fall.
    """
    rise = last - first
    stays = regime == Regime.FULL_STICK and rise[2] == rise[3] == 0
    if regime != Regime.LARGE and not stays:
        return True
    part = np.linspace(0.0, 1.0, PARTS + 1)[:, None]
    P, M = (first[k] + part * rise[k] for k in range(2))
    path = solved(each_contact, body, {"P": P, "M": M}, UNIT, own, Contact)
    angle = np.pi * (np.arange(POINTS) + 0.5) / POINTS
    left, right = (max(edges[0, 0], edges[-1, 0]) for edges in path[:2])
    x = -left + (left + right) * np.sin(angle / 2) ** 2
    weight = np.pi / POINTS * (left + right) / 2 * np.sin(angle)
    given = {"x": x, "a": path.a, "c": path.c}
    limit = f * solved(each_pressure, body, given, UNIT, own)
    there = back = np.zeros_like(limit)
    if not stays:
        there = _changes(body, own, f, path, rise, x)
        back = there
        if np.ptp(P) or np.ptp(M):
            back = _changes(body, own, f, Contact(*(v[::-1] for v in path)), rise, x)
    since = np.concatenate([there, there[-1] - back])
    limits = np.concatenate([limit, limit[::-1]])
    known = np.isfinite(limits + since)  # the pressure is infinite at a corner
    lower = np.max(np.where(known, -limits - since, -np.inf), axis=0)
    upper = np.min(np.where(known, limits - since, np.inf), axis=0)
    limited = np.isfinite(lower)
    lowest, highest = (np.sum((weight * v)[limited]) for v in (lower, upper))
    rough = LIMIT_RTOL * f * min(first[0], last[0])
    return bool(lowest - rough <= first[2] <= highest + rough)


def _changes(
    body: Body, own: dict[str, Any], f: Any, path: Contact, rise: Array, x: Array
) -> Array:
    """dq under large tension from the first contact of a path to each one, at places x."""
    part = np.linspace(0.0, 1.0, PARTS + 1)[1:, None]
    cycle = {"a_1": path.a[0], "c_1": path.c[0], "a_2": path.a[1:], "c_2": path.c[1:]}
    cycle |= {"dQ": part * rise[2], "dsigma": part * rise[3]}
    regime = {"regime": Regime.LARGE}
    zone = solved(each_zone_of_regime, body, cycle | regime, {"f": f, **UNIT}, own, Edges)
    given = cycle | {"m": zone.left, "n": zone.right} | regime | {"x": x}
    dq = solved(each_shear_change, body, given, {"f": f, **UNIT}, own)
    return np.concatenate([np.zeros((1, x.size)), dq])
