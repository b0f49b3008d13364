r"""Closed loops of P and Q at a constant tilt and a constant bulk tension: the exact stick zone.

Let |Q| < f P at all instants of a closed history.  In the plane of P and Q, draw a straight line of
slope f that touches the loop from above, and one of slope -f that touches it from below.  They meet
at the load

    P_E = -(max(Q - f P) + max(-Q - f P))/(2 f),

and the permanent stick zone is the contact under P_E at the same tilt.  At constant P this is the
moderate stick zone, the contact under P - dQ/(2 f).

Proof.  At a constant tilt the contacts S(L) under the loads L are nested.  When the load grows from
L to L + dL, the pressure grows by that of a flat punch, u(x; L) dL on S(L), which displaces all
points of S(L) by the same amount.  First let sigma = 0, and write

    q = f int_0^P s(L) u(x; L) dL,  |s| <= 1,    so that |q| <= f p,  Q = f int_0^P s dL.

A history changes s as follows.  While P grows and |dQ| <= f dP, the whole contact sticks, and the
added loads have s = dQ/(f dP).  While P falls, s is removed together with the loads that are
removed, and does not change at the loads that remain.  If Q is then larger than f int_0^P s dL, s
becomes 1 from a load L up to P; if Q is smaller, s becomes -1 there.  The value of Q determines L.
This solves the shear problem, whose solution is unique: inside S(L) the change in displacement is
uniform, so that the surfaces stick; outside S(L), q = f p (for s = 1), and the displacement changes
by less under each of the punches, so that the surfaces slip forward.

Let L be the lowest load to which slip extends in the steady cycle, and Q_L = f int_0^L s dL.  Then
|Q - Q_L| <= f (P - L) at all instants.  Slip reaches L with one sign of s, because L is the lowest
load, and later with the other sign, because s would otherwise no longer change.  Equality holds
both times.  Hence -f L + Q_L = max(Q - f P) and -f L - Q_L = max(-Q - f P), so that L = P_E.  One
cycle is enough: at the instant of the first or of the second maximum, the shear carried by the
loads below P_E becomes Q_L, and from then on slip does not extend below P_E.

A constant tension leaves behind a shear traction of its own.  Consider two histories under equal
changes in the loads.  The energy of the difference of their shear tractions does not grow, and in
the steady cycle it is constant.  Then both slip in the same way: neither slips where the tractions
differ, and elsewhere the difference of the tractions does not change, so that the difference of the
slip rates does no work on the change in traction that it causes.

Barber, Davies and Hills (2011) give P_E for convex loops.
"""

import numpy as np

from ..body import Body
from ..cycle import Own, contact, contact_at_tilt
from ..types import Array, Contact
from .nearest import ROUNDING


def stick_zone_of_loop(body: Body, own: Own, f: Array, loads: Array) -> Contact:
    """The contact under P_E; NaN unless M = 0, tilt and sigma are constant, and |Q| < f P.

    E* = 1; f and own have one instant.
    loads: P, M, Q and sigma; time lies along their last axis, which the results lack.
    """
    P, M, Q, sigma = loads
    known = np.all((M == 0) & (sigma == sigma[..., :1]), axis=-1)
    known &= np.all(abs(Q) < f * P * (1 - ROUNDING), axis=-1)
    extremes = np.min(P, axis=-1, keepdims=True), np.max(P, axis=-1, keepdims=True)
    between = np.concatenate([P, sum(extremes) / 2], axis=-1)
    contacts = contact(body, own, np.where(known[..., None], between, np.nan), 0.0, 1.0)
    # the tilt of a flat punch whose load acts at a quarter of its width from its centre
    unit = np.min(P / (contacts.a + contacts.c)[..., :-1], axis=-1)
    known &= np.ptp(contacts.alpha, axis=-1) <= ROUNDING * unit
    largest = [np.max(sign * Q - f * P, axis=-1, keepdims=True) for sign in (1, -1)]
    load = np.where(known[..., None], -sum(largest) / (2 * f), np.nan)
    zone = contact_at_tilt(body, own, load, contacts.alpha[..., -1:], 1.0)
    return Contact(*(value[..., 0] for value in zone))
