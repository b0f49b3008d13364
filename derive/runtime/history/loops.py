r"""Closed loops of P and Q at a constant tilt and a constant bulk tension: the exact stick zone.

Let |Q| < f P at all instants of a closed history.  The straight lines of slope f and -f that touch
the loop from below meet at the load

    P_E = -(max(Q - f P) + max(-Q - f P))/(2 f),

and the permanent stick zone is the contact under P_E at the same tilt.  At constant P that is the
moderate stick zone, the contact under P - dQ/(2 f).

Proof.  At a constant tilt the contacts S(L) under the loads L lie one inside the other, and between
two of them the pressure grows by that of a flat punch, u(x; L) dL on S(L), whose displacement is
the same all over S(L).  First let sigma = 0, and write

    q = f int_0^P s(L) u(x; L) dL,  |s| <= 1,    so that |q| <= f p,  Q = f int_0^P s dL.

A history changes s as follows.  While P grows and |dQ| <= f dP, all sticks, and the new loads have
s = dQ/(f dP).  While P falls, the loads that are left take their s with them.  What Q is beyond
that sets s to 1 from some load L up to P, or to -1 if it is below: L follows from Q.  This solves
the shear problem, whose solution is unique: inside S(L) the change of displacement is uniform, so
that it sticks; outside, q = f p, and the displacement changes by less under each of the punches, so
that it slips forward.

Let L be the lowest load to which slip comes down in the steady cycle, and Q_L = f int_0^L s dL.
Then |Q - Q_L| <= f (P - L) at all instants.  Slip comes down to L from one side, else it would not
be the lowest, and then from the other, else s would be the same ever after.  Both times the bound
is reached.  So -f L + Q_L = max(Q - f P) and -f L - Q_L = max(-Q - f P): L = P_E.  One round is
enough: at the instant of the first maximum, or of the second, the shear carried below P_E comes to
Q_L, and from then on no slip comes below P_E.

A constant tension leaves its own shear behind.  Of two histories under equal changes of the loads,
the energy of the difference of their shears does not grow, and in the steady cycle it is constant.
Then they slip alike: where the shears differ, neither slips, and elsewhere their difference rests,
so that the difference of their slip rates does no work on what it causes.

Barber, Davies and Hills (2011) give P_E for convex loops.
"""

import numpy as np

from ..body import Asked
from ..cycle import contact, contact_at_tilt
from ..types import Array, Contact

LEVEL = 1e-10
"""Tilts that differ by less are equal; over that of a flat punch whose load's centre is off by a
quarter of its width."""

ROUNDING = 1e-12
"""A load that is nearer to sliding slides."""


def stick_zone_of_loop(
    asked: Asked, P: Array, M: Array, Q: Array, sigma: Array, *, f: Array, E_star: Array
) -> Contact:
    """The contact under P_E; NaN unless M = 0, tilt and sigma are constant, and nothing slides.

    All arguments have one shape; time lies along the last axis, which the results do not have.
    """
    first = {name: value[..., :1] for name, value in asked.own.items()}
    asked, f, E_star = asked._replace(own=first), f[..., :1], E_star[..., :1]
    ends = np.min(P, axis=-1, keepdims=True), np.max(P, axis=-1, keepdims=True)
    here = contact(asked, np.concatenate([P, sum(ends) / 2], axis=-1), 0.0, E_star=E_star)
    unit = np.min(P / (E_star * (here.a + here.c)[..., :-1]), axis=-1)
    known = np.ptp(here.alpha, axis=-1) <= LEVEL * unit
    known &= np.all((M == 0) & (sigma == sigma[..., :1]), axis=-1)
    known &= np.all(abs(Q) < f * P * (1 - ROUNDING), axis=-1)
    touched = [np.max(way * Q - f * P, axis=-1, keepdims=True) for way in (1, -1)]
    load = np.where(known[..., None], -sum(touched) / (2 * f), np.nan)
    zone = contact_at_tilt(asked, load, here.alpha[..., -1:], E_star=E_star)
    return Contact(*(value[..., 0] for value in zone))
