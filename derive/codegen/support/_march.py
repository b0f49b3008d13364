"""A steady cycle instant by instant: where it slips, and which way.

All loads move in phase, there and back between two states: at the least shear and at the greatest.
Since the last of these, slip has grown as in a half-cycle that ends now, if all shear was at
friction in the slip zones to come when they turned.  It was not where slip turns round inside the
whole half-cycle: of such a cycle nothing is told but its ends.
"""

from typing import NamedTuple

import numpy as np

from ._arrays import Array, Flat
from ._law import Law
from ._slip import ORDERS, demand_order, slip_zones_of
from ._stick import stick_zone_of
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
    /,
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
    demand_order(order, (0, *ORDERS))
    if not given.shape or given.shape[-1] < 2:
        raise ValueError(
            f"a cycle has two instants or more, along the last axis; got shape {given.shape}"
        )
    loads = np.stack([v.reshape(given.shape) for v in given.values[:4]])
    friction = given.values[4].reshape(given.shape)
    constants = {n: v.reshape(given.shape) if v.ndim else v for n, v in given.constants.items()}
    start, end, forward, in_phase, arrived = _phases(loads)
    contact = law.contact(*loads[:2], **constants)
    begun = Contact(*(np.take_along_axis(v, start, axis=-1) for v in contact))
    sense = np.where(forward, 1, -1)
    dQ, dsigma = (sense * _rise(v, start) for v in loads[2:])
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
        limit = friction * (loads[0] + np.take_along_axis(loads[0], start, axis=-1))
        regime = np.where(dQ >= limit, Regime.SLIDING, regime)
        still = (dQ == 0) & (dsigma == 0) & np.isfinite(contact.a)
        regime = np.where(still, Regime.FULL_STICK, regime)
        m = np.where(still, np.minimum(contact.a, begun.a), m)
        n = np.where(still, np.minimum(contact.c, begun.c), n)
    else:
        m, n, regime = stick_zone_of(law, begun, contact, dQ, dsigma, **given_now)
    ends = [Contact(*(np.take_along_axis(v, i, axis=-1) for v in contact)) for i in (start, end)]
    whole = stick_zone_of(
        law, *ends, *(sense * _between(v, start, end) for v in loads[2:]), **given_now
    )
    turns = np.isin(whole.regime, (Regime.MIXED, Regime.UNSOLVED)) & ~arrived
    regime = np.where(turns, Regime.MIXED, regime)
    known = in_phase & ~turns
    m, n = np.where(known, m, np.nan), np.where(known, n, np.nan)
    regime = np.where(in_phase, regime, Regime.NONE)
    overtaken = (regime == Regime.MIXED) & np.isfinite(m)
    slips = (regime == Regime.MODERATE) | (regime == Regime.LARGE) | overtaken
    back = np.where((regime == Regime.LARGE) & (dsigma < 0), -1, 1)
    forth = np.where(regime == Regime.LARGE, -back, 1)
    left, right = np.where(slips, sense * back, 0), np.where(slips, sense * forth, 0)
    return March(contact.a, contact.c, m, n, left, right, regime)


def _rise(load: Array, start: Array) -> Array:
    """What a load has gained since the half-cycle began; nothing if rounding alone changes it."""
    return _between(load, start, np.broadcast_to(np.arange(load.shape[-1]), load.shape))


def _between(load: Array, start: Array, end: Array) -> Array:
    rise = np.take_along_axis(load, end, axis=-1) - np.take_along_axis(load, start, axis=-1)
    size = np.max(np.abs(load), axis=-1, keepdims=True)
    return np.where(np.abs(rise) <= ROUNDING * size, 0.0, rise)


class _Phases(NamedTuple):
    """Of each instant: when its half-cycle began and ends, and whether that raises Q.

    in_phase  whether all loads are as far on their way
    arrived   whether it is the end of its half-cycle
    """

    start: Array
    end: Array
    forward: Array
    in_phase: Array
    arrived: Array


def _phases(loads: Array) -> _Phases:
    """The half-cycles.

    The first load that changes, of Q, sigma, P and M, says how far the others must have come.  It
    must rise all the way to its greatest value and fall all the way back; while it rests at
    either, the half-cycle that led there is at its end.
    """
    P, M, Q, sigma = loads
    rounding = ROUNDING * np.max(np.abs(loads), axis=-1, keepdims=True)
    spans = np.ptp(loads, axis=-1, keepdims=True) > 2 * rounding
    changes = [spans[2], spans[3], spans[0]]
    measure = np.select(changes, [Q, sigma, P], M)
    allowed = ROUNDING * np.max(np.abs(measure), axis=-1, keepdims=True)
    low, high = (_last_of(sign * measure, allowed) for sign in (1, -1))
    count = measure.shape[-1]
    instants = np.arange(count)
    since_low, since_high = (instants - low) % count, (instants - high) % count
    forward = (since_low > 0) & ((since_low < since_high) | (since_high == 0))
    first, last = (np.take_along_axis(loads, np.stack([i] * 4), axis=-1) for i in (low, high))
    least, most = (np.take_along_axis(measure, i, axis=-1) for i in (low, high))
    part = np.where(most - least > 2 * allowed, (measure - least) / (most - least), 0.0)
    off = np.abs(loads - (first + part * (last - first)))
    on_the_way = np.all(off <= IN_PHASE * np.abs(last - first) + rounding, axis=0)
    step = measure - np.roll(measure, 1, axis=-1)
    turned = np.where(forward, step < -allowed, step > allowed)
    broken = [np.any(turned & way, axis=-1, keepdims=True) for way in (forward, ~forward)]
    broken_here = np.where(forward, *broken)
    start, end = np.where(forward, low, high), np.where(forward, high, low)
    left = np.abs(measure - np.take_along_axis(measure, end, axis=-1))
    return _Phases(start, end, forward, on_the_way & ~broken_here, left <= allowed)


def _last_of(values: Array, allowed: Array) -> Array:
    """The last of the instants at which the values rest at their least."""
    rests = values <= np.min(values, axis=-1, keepdims=True) + allowed
    leaves = rests & ~np.roll(rests, -1, axis=-1)
    return np.argmax(leaves, axis=-1, keepdims=True)
