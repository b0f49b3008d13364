r"""A steady cycle instant by instant: where it slips, and in which direction.

All loads move in proportion, back and forth between two states, at the smallest and at the largest
shear load.  Let `progress` be the fraction of the way from the first state to the second.  Since
the last reversal of the loads, slip has grown as in a half-cycle that ends now, between the contact
at the reversal and the contact now, provided that slip grows throughout the whole half-cycle.  The
regime is therefore that of the whole half-cycle.  Where slip reverses within it (MIXED), only the
states at its ends are returned.

Histories that cannot be solved are refused at all instants: loads out of proportion, a history that
does not return to its first state, |Q| >= f P, and a shear load that the stick zone cannot carry.
The last instant leads straight back to the first.  If this last step is nearly the whole way from
one state to the other, the history is taken for a first loading and not for a cycle.

Under moderate tension a stick zone carries every |Q| < f P.  The shear traction there grows, and
f p_1 + dq = f p_2 + 2 f (p_1 - p_s) is above f p_2, p_s being the pressure of the contact [-m, n],
which is below p_1.  The same holds if nothing slips as both edges advance, because |dq| <= f dp
everywhere.  It does not hold under large tension, where the slip zones slip in opposite directions
and carry little, nor where the moment rocks the contact while Q and sigma are constant.  A steady
cycle on elements tells whether such a zone carries Q.  If it cannot, every point slips in every
cycle, and the bodies ratchet along each other although |Q| < f P.

All loads are divided by E*.  Time lies along the last axis, which constants keep with length one.
"""

from typing import Any, NamedTuple

import numpy as np

from ..arrays import solved
from ..body import Body
from ..cycle import Own, stick_zones
from ..forward import UNIT, each_contact
from ..slip.zone import each_zone_of_regime
from ..types import Array, Contact, Edges, March, Regime

MAX_LAST_STEP = 0.99
"""Largest step from the last instant back to the first, as a part of the way between the states."""

PHASE_RTOL = 1e-6
"""Largest deviation of a load from the way between both states, relative to its change."""

LOAD_RTOL = 1e-12
"""Loads whose relative change is below this are constant."""


class _Way(NamedTuple):
    """How the loads move.

    progress  from 0 to 1; NaN where the loads are out of proportion
    start     the instant at which the half-cycle began that leads to an instant
    returns   whether the loads go on in one direction between reversals
    """

    progress: Array
    start: Array
    returns: Array


def in_phase(body: Body, own: Own, f: Array, loads: Array, mixed: bool) -> tuple[Any, Array, Array]:
    """The states at all instants, and the loads of a cycle between their extremes with its regime,
    for E* = 1.

    f and own have one instant.
    loads: P, M, Q and sigma
    mixed: whether to solve mixed cycles, too
    """
    contact = solved(each_contact, body, {"P": loads[0], "M": loads[1]}, UNIT, own, Contact)
    roundings = _roundings(contact, f, *loads)
    way = _way(loads, roundings)
    low, high = (at(way.progress, axis=-1)[..., None] for at in (np.argmin, np.argmax))
    cycle = np.concatenate([_at(loads, end) for end in (low, high, low)], axis=-1)
    whole = _half_cycle(contact, (low, high), cycle[..., 1:2] - cycle[..., :1], roundings)
    constants = {"f": f, **UNIT}
    m, n, code = stick_zones(body, whole, constants, own, mixed)
    refused, refusal = _refusal(way, loads, contact, f)
    regime: Array = np.where(refused, refusal, code)

    # part of the whole half-cycle up to each instant; of a mixed one only the ends are known
    sense = np.where(_at(way.progress, way.start) == 0, 1, -1)
    rise = sense * (loads - _at(loads, way.start))
    now = np.broadcast_to(np.arange(rise.shape[-1]), way.progress.shape)
    part = _half_cycle(contact, (way.start, now), rise, roundings)
    asked = ~np.isnan(m) & ~refused & (regime != Regime.MIXED)
    part["regime"] = np.where(asked, regime, Regime.NONE)
    ends = (regime == Regime.MIXED) & (way.progress == (1 + sense) / 2)
    found = solved(each_zone_of_regime, body, part, constants, own, Edges)
    zone = np.where(ends, [m, n], found)
    a, c = (np.minimum(edge, _at(edge, way.start)) for edge in contact[:2])
    rounding = LOAD_RTOL * (a + c)
    inside = (zone[0] <= a + rounding) & (zone[1] <= c + rounding)
    exists = (zone[0] + zone[1] > 0) & inside
    large, backward = regime == Regime.LARGE, whole["dsigma"] < 0
    slips = exists & (regime != Regime.FULL_STICK)
    left = np.where(slips, np.where(large & backward, -sense, sense), 0)
    m, n = np.where(exists, zone, np.nan)
    found = np.where(asked & ~exists, Regime.UNSOLVED, regime)
    states = March(contact.a, contact.c, m, n, left, np.where(large, -left, left), found)
    return states, cycle, regime[..., 0]


# ---------------------------------------------------------------- the mean shear load


def is_limited(regime: Array, loads: Array) -> Array:
    """Whether the shear load that the stick zones of cycles carry has a limit below f P."""
    rocks = (regime == Regime.FULL_STICK) & np.all(np.ptp(loads[2:], axis=-1) == 0, axis=0)
    return rocks | (regime == Regime.LARGE) | (regime == Regime.MIXED)


# ---------------------------------------------------------------- how the loads move


def _at(values: Array, instants: Array) -> Array:
    """The values at given instants."""
    instants = np.broadcast_to(instants, (*values.shape[:-1], instants.shape[-1]))
    return np.take_along_axis(values, instants, axis=-1)


def _roundings(contact: Contact, f: Array, P: Array, M: Array, Q: Array, sigma: Array) -> Array:
    """Changes in P, M, Q and sigma that count as zero: a part of their sizes, or of P, P h, f P and
    f P/h if those are larger."""
    h = contact.a + contact.c
    sizes = np.abs([[P, M, Q, sigma], [P, P * h, f * P, f * P / h]])
    return LOAD_RTOL * np.max(sizes, axis=(0, -1))[..., None]


def _way(loads: Array, roundings: Array) -> _Way:
    """How the loads move."""
    by_rank = [2, 3, 0, 1]  # the first of Q, sigma, P and M that changes leads
    changes = np.ptp(loads, axis=-1, keepdims=True)
    leading = np.argmax((changes > 2 * roundings)[by_rank], axis=0)[None]
    lead, rounding = (
        np.take_along_axis(v[by_rank], leading, axis=0)[0] for v in (loads, roundings)
    )
    low, high = (at(lead, axis=-1)[..., None] for at in (np.argmin, np.argmax))
    least, change = _at(lead, low), _at(lead, high) - _at(lead, low)
    moves = change > 2 * rounding
    progress = np.where(moves, (lead - least) / change, 0.0)
    near = np.where(moves, rounding / change, 0.0)
    progress = np.where(progress <= near, 0.0, np.where(progress >= 1 - near, 1.0, progress))
    rise = _at(loads, high) - _at(loads, low)
    deviation = abs(loads - _at(loads, low) - progress * rise)
    within = deviation <= PHASE_RTOL * abs(rise) + 2 * roundings
    progress = np.where(np.all(within, axis=0), progress, np.nan)

    # the last end of the way before each instant, other than that at the instant itself
    count = progress.shape[-1]
    twice = np.concatenate([progress, progress], axis=-1)
    last = [np.where(twice == end, np.arange(2 * count), -1) for end in (0, 1)]
    at_0, at_1 = (np.roll(np.maximum.accumulate(v, axis=-1), 1, axis=-1) for v in last)
    start = np.where(twice == 0, at_1, np.where(twice == 1, at_0, np.maximum(at_0, at_1)))
    start = np.maximum(start[..., count:], 0) % count
    sense = np.where(_at(progress, start) == 0, 1, -1)
    onward = sense * (progress - np.roll(progress, 1, axis=-1)) >= -PHASE_RTOL
    return _Way(progress, start, np.all(onward, axis=-1, keepdims=True))


def _refusal(way: _Way, loads: Array, contact: Contact, f: Array) -> tuple[Array, Array]:
    """Whether histories are refused at all instants, and the regime that says why."""
    valid = (
        np.isfinite(loads).all(axis=0) & (contact.a + contact.c > 0) & np.isfinite(contact.alpha)
    )
    exists = (valid & (f > 0)).all(axis=-1, keepdims=True)
    slides = np.any(abs(loads[2]) >= f * loads[0], axis=-1, keepdims=True)
    jumps = abs(way.progress[..., -1:] - way.progress[..., :1]) > MAX_LAST_STEP
    refusals = {
        Regime.NONE: ~exists,
        Regime.SLIDING: slides,
        Regime.OUT_OF_PHASE: ~way.returns,
        Regime.NOT_CLOSED: jumps,
    }
    refused = np.stack(list(refusals.values()))
    return refused.any(axis=0), np.select(list(refused), list(refusals))


def _half_cycle(
    contact: Contact, ends: tuple[Array, Array], rise: Array, roundings: Array
) -> dict[str, Array]:
    """a_1, c_1, a_2, c_2, dQ and dsigma between instants; roundings of the loads count as zero."""
    edges = [_at(edge, instants) for instants in ends for edge in contact[:2]]
    changes = np.where(abs(rise) <= roundings, 0.0, rise)[2:]
    return dict(zip(("a_1", "c_1", "a_2", "c_2", "dQ", "dsigma"), [*edges, *changes], strict=True))
