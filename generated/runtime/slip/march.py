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

The loads are a matrix with rows P, M, Q, sigma, divided by E*, and a column per instant.  The
contacts are a matrix with columns A, C, TILT, LOAD and MOMENT and a row per instant.
"""

import math
from typing import Any

import numpy as np

from ..inverse import contact
from ..kernels import kernel, loop, opened
from ..types import (
    FULL_STICK,
    LARGE,
    MIXED,
    NO_STICK,
    NONE,
    NOT_CLOSED,
    OUT_OF_PHASE,
    SLIDING,
    UNSOLVED,
    Array,
)
from .bounded import oriented, sense_of
from .growth import narrowest
from .large import EXACT, large_slip
from .locked import holds_load
from .moderate import LOAD, MOMENT, TILT, A, C, patch
from .zone import stick_zone

IN_ORDER = -1.0
"""A code for a history without faults."""

P, M, Q, SIGMA = range(4)
"""The rows of the loads."""

BY_RANK = (Q, SIGMA, P, M)
"""The first of these loads that changes determines the progress of the others."""

WHOLE_WAY = 0.99
"""Part of the way between both states from which the step back to the first instant is too long."""

IN_PHASE = 1e-6
"""Largest deviation of a load from the way between both states, relative to its change."""

ROUNDING = 1e-12
"""Loads whose relative change is below this are constant."""

NOWHERE = math.nan, math.nan


# ---------------------------------------------------------------- what the loads do


@kernel
def _contacts(law: Any, own: Array, loads: Array) -> Array:
    """The contact at every instant; NaN if there is none."""
    contacts = np.empty((loads.shape[1], 5))
    for i in range(loads.shape[1]):
        if i > 0 and loads[P, i] == loads[P, i - 1] and loads[M, i] == loads[M, i - 1]:
            contacts[i] = contacts[i - 1]
            continue
        contacts[i, A], contacts[i, C], contacts[i, TILT] = contact(
            law, own, loads[P, i], loads[M, i]
        )
        contacts[i, LOAD], contacts[i, MOMENT] = loads[P, i], loads[M, i]
    return contacts


@kernel
def _roundings(loads: Array, contacts: Array, f: Array) -> Array:
    """Changes in each load that count as zero: a fraction of its size, or of a reference if larger.

    The references for P, M, Q and sigma are P, P h, f P and f P/h.
    """
    sizes = np.zeros(4)
    for i in range(loads.shape[1]):
        h, load = contacts[i, A] + contacts[i, C], abs(loads[P, i])
        for k, size in ((P, load), (M, load * h), (Q, f * load), (SIGMA, f * load / h)):
            sizes[k] = max(sizes[k], abs(loads[k, i]), size)
    for k in range(4):
        sizes[k] *= ROUNDING
    return sizes


@kernel
def _progress(loads: Array, roundings: Array) -> Array:
    """The progress of every instant, from 0 to 1; NaN where the loads are out of proportion."""
    progress = np.zeros(loads.shape[1])
    low = high = 0
    for k in BY_RANK:
        low, high = int(np.argmin(loads[k])), int(np.argmax(loads[k]))
        change = loads[k, high] - loads[k, low]
        if change > 2 * roundings[k]:
            rounding = roundings[k] / change
            for i in range(progress.size):
                fraction = (loads[k, i] - loads[k, low]) / change
                progress[i] = (
                    0.0 if fraction <= rounding else 1.0 if fraction >= 1 - rounding else fraction
                )
            break
    for k in range(4):
        change = loads[k, high] - loads[k, low]
        for i in range(progress.size):
            deviation = abs(loads[k, i] - loads[k, low] - progress[i] * change)
            if not deviation <= IN_PHASE * abs(change) + 2 * roundings[k]:
                progress[i] = math.nan
    return progress


@kernel
def _starts(progress: Array) -> Array:
    """The instant at which each half-cycle began; NaN where the way there or back is not monotonic.

    While the loads are constant at a reversal, the half-cycle that led there has reached its end.
    """
    count, begin = progress.size, 0
    for i in range(count):
        if progress[i] == 0 and progress[(i + 1) % count] > 0:
            begin = i
    starts = np.empty(count)
    turn, rises, reached = begin, True, 0.0
    for k in range(1, count + 1):
        i = (begin + k) % count
        now = progress[i] if rises else 1 - progress[i]
        if reached == 1 and now < 1:
            turn, rises, reached = (i - 1) % count, not rises, 0.0
            now = 1 - now
        starts[i] = turn if now >= reached - IN_PHASE else math.nan
        reached = max(reached, now)
    return starts


@kernel
def _refusal(loads: Array, contacts: Array, f: Array, progress: Array, starts: Array) -> Array:
    """The regime of a history that is refused at all instants, or IN_ORDER."""
    last = progress.size - 1
    slides, jumps = False, abs(progress[last] - progress[0]) > WHOLE_WAY
    out_of_phase = False
    for i in range(progress.size):
        known = f > 0 and contacts[i, C] + contacts[i, A] > 0 and math.isfinite(contacts[i, TILT])
        for k in range(4):
            known = known and math.isfinite(loads[k, i])
        if not known:
            return NONE
        slides = slides or abs(loads[Q, i]) >= f * loads[P, i]
        out_of_phase = out_of_phase or math.isnan(progress[i]) or math.isnan(starts[i])
    if slides:
        return SLIDING
    if out_of_phase:
        return OUT_OF_PHASE
    return NOT_CLOSED if jumps else IN_ORDER


# ---------------------------------------------------------------- stick zones and slip


@kernel
def _half_cycle(
    loads: Array,
    contacts: Array,
    roundings: Array,
    f: Array,
    start: Array,
    end: Array,
    sense: Array,
) -> Array:
    """a1, c1, a2, c2, dQ, dsigma, f between two instants; sense is -1 if the loads go back."""
    cycle = np.empty(7)
    cycle[0], cycle[1] = contacts[start, A], contacts[start, C]
    cycle[2], cycle[3] = contacts[end, A], contacts[end, C]
    for i, k in ((4, Q), (5, SIGMA)):
        rise = sense * (loads[k, end] - loads[k, start])
        cycle[i] = 0.0 if abs(rise) <= roundings[k] else rise
    cycle[6] = f
    return cycle


@kernel
def large_zone(law: Any, own: Any, cycle: Any) -> Any:
    """m and n under large tension of either sign."""
    sense, as_oriented = sense_of(cycle), oriented(cycle)
    slip = large_slip(law, own, as_oriented, sense, EXACT)
    return (slip.m, slip.n) if sense > 0 else (slip.n, slip.m)


@kernel
def _stuck(
    law: Any,
    own: Array,
    contacts: Array,
    cycle: Array,
    start: Array,
    now: Array,
    regime: Array,
) -> Any:
    """m and n of a half-cycle that ends now, if the regime of the whole half-cycle is known."""
    if regime == FULL_STICK:
        ends = np.empty((2, 5))
        ends[0], ends[1] = contacts[start], contacts[now]
        return narrowest(law, own, ends)
    a, c = min(cycle[0], cycle[2]), min(cycle[1], cycle[3])
    if regime == LARGE:
        m, n = large_zone(law, own, cycle)
    else:
        m, n = patch(law, own, contacts, start, now, 1.0, cycle)
    rounding = ROUNDING * (a + c)
    if m + n > 0 and m <= a + rounding and n <= c + rounding:
        return m, n
    return NOWHERE


@kernel
def _begin(found: Array, contacts: Array, regime: Array) -> Array:
    """Fill the rows of instants for which only the contacts and the regime are known."""
    for i in range(found.shape[0]):
        found[i, 0], found[i, 1], found[i, 6] = contacts[i, A], contacts[i, C], regime
        found[i, 2] = found[i, 3] = math.nan
        found[i, 4] = found[i, 5] = 0.0
    return regime


@kernel
def _finish(found: Array, regime: Array, left: Array) -> Array:
    """Fill in directions of slip, and the regime, at an instant whose stick zone was computed."""
    if math.isnan(found[2]):
        found[6] = UNSOLVED
    elif regime != FULL_STICK:
        found[4], found[5] = left, -left if regime == LARGE else left
    return found[6]


@loop
def each_march(law: Any, given: Array, own: Array, out: Array) -> None:
    """given: f, then P, M, Q and sigma at T instants.

    out: a, c, m, n, left, right, regime, T times.
    """
    law = opened(law)
    count = (given.shape[1] - 1) // 4
    for row in range(given.shape[0]):
        f, body = given[row, 0], own[row]
        loads, found = given[row, 1:].reshape((4, count)), out[row].reshape((count, 7))
        contacts = _contacts(law, body, loads)
        roundings = _roundings(loads, contacts, f)
        progress = _progress(loads, roundings)
        starts = _starts(progress)
        regime = _refusal(loads, contacts, f, progress, starts)
        _begin(found, contacts, regime)
        if regime != IN_ORDER:
            continue
        low, high = np.argmin(progress), np.argmax(progress)
        cycle = _half_cycle(loads, contacts, roundings, f, low, high, 1.0)
        m, _, regime = stick_zone(law, body, cycle)
        both = np.empty((2, 5))
        both[0], both[1] = contacts[low], contacts[high]
        if not holds_load(law, body, both, cycle, regime, loads[Q, low]):
            m, regime = math.nan, NO_STICK
        _begin(found, contacts, regime)
        kappa = -1.0 if regime == LARGE and cycle[5] < 0 else 1.0
        for i in range(count):
            start = int(starts[i])
            sense = 1.0 if progress[start] == 0 else -1.0
            # of a mixed cycle at most the ends are known
            ends = progress[i] == (1 + sense) / 2
            if not math.isnan(m) and (regime != MIXED or ends):
                cycle = _half_cycle(loads, contacts, roundings, f, start, i, sense)
                found[i, 2], found[i, 3] = _stuck(law, body, contacts, cycle, start, i, regime)
                _finish(found[i], regime, sense * kappa)
