"""A steady cycle instant by instant: where it slips, and which way.

All loads move in phase, there and back between two states: at the least shear and at the greatest.
Since the last of these, slip has grown as in a half-cycle that ends now.
"""

import numpy as np

from ._arrays import Array, Flat
from ._slip import slip_zones_of
from ._stick import Law, stick_zone_of
from ._types import Contact, March, Regime

IN_PHASE = 1e-6
"""Loads that are off the way between both states by more, in parts of their change, are refused."""

ROUNDING = 1e-12
"""Loads that change by less, in parts of themselves, are constant."""


@np.errstate(all="ignore")
def march_of(
    law: Law,
    P: Array,
    M: Array,
    Q: Array,
    sigma: Array,
    *,
    f: Array,
    E_star: Array,
    order: int,
    **own: Array,
) -> March:
    """Instants of one cycle along the last axis.

    order: 0 for the exact conditions, else the order of the series.
    """
    given = Flat({"P": P, "M": M, "Q": Q, "sigma": sigma}, {"E_star": E_star, **own}, {"f": f})
    if not given.shape:
        raise ValueError("the loads of a cycle are arrays, its instants along the last axis")
    loads = np.stack([v.reshape(given.shape) for v in given.values[:4]])
    friction = given.values[4].reshape(given.shape)
    constants = {n: v.reshape(given.shape) if v.ndim else v for n, v in given.constants.items()}
    start, forward, in_phase = _phases(loads)
    contact = law.contact(*loads[:2], **constants)
    begun = Contact(*(np.take_along_axis(v, start, axis=-1) for v in contact))
    sense = np.where(forward, 1, -1)
    dQ, dsigma = (sense * (v - np.take_along_axis(v, start, axis=-1)) for v in loads[2:])
    given_now = {"f": friction, **constants}
    if order:
        zones = slip_zones_of(
            law,
            *(contact.a, contact.c, dQ, dsigma),
            da=contact.a - begun.a,
            dc=contact.c - begun.c,
            order=order,
            **given_now,
        )
        m, n = contact.a - zones.left, contact.c - zones.right
        opposite = np.abs(np.pi * (contact.a + contact.c) * dsigma / 8) > dQ
        known = np.isfinite(m) & np.isfinite(n)
        regime = np.where(known, np.where(opposite, Regime.LARGE, Regime.MODERATE), Regime.NONE)
    else:
        m, n, regime = stick_zone_of(law, begun, contact, dQ, dsigma, **given_now)
    m, n = np.where(in_phase, m, np.nan), np.where(in_phase, n, np.nan)
    regime = np.where(in_phase, regime, Regime.NONE)
    slips = (regime == Regime.MODERATE) | (regime == Regime.LARGE)
    back = np.where((regime == Regime.LARGE) & (dsigma < 0), -1, 1)
    forth = np.where(regime == Regime.LARGE, -back, 1)
    left, right = np.where(slips, sense * back, 0), np.where(slips, sense * forth, 0)
    return March(contact.a, contact.c, m, n, left, right, regime)


def _phases(loads: Array) -> tuple[Array, Array, Array]:
    """When the half-cycle of each instant began, whether it raises Q, and which are in phase.

    The first load that changes, of Q, sigma, P and M, says how far the others must have come.
    """
    P, M, Q, sigma = loads
    changes = [np.ptp(v, axis=-1, keepdims=True) > 0 for v in (Q, sigma, P)]
    measure = np.select(changes, [Q, sigma, P], M)
    low: Array = np.argmin(measure, axis=-1, keepdims=True)
    high: Array = np.argmax(measure, axis=-1, keepdims=True)
    instants = np.arange(measure.shape[-1])
    since_low, since_high = (instants - low) % instants.size, (instants - high) % instants.size
    forward = (since_low > 0) & ((since_low < since_high) | (since_high == 0))
    first, last = (np.take_along_axis(loads, np.stack([i] * 4), axis=-1) for i in (low, high))
    least, most = (np.take_along_axis(measure, i, axis=-1) for i in (low, high))
    with np.errstate(all="ignore"):
        part = np.where(most > least, (measure - least) / (most - least), 0.0)
    off = np.abs(loads - (first + part * (last - first)))
    allowed = IN_PHASE * np.abs(last - first) + ROUNDING * np.abs(first)
    return np.where(forward, low, high), forward, np.all(off <= allowed, axis=0)
