r"""Slip that turns round inside a half-cycle of constant normal loads: the exact stick zone.

Tension loads the left edge more, dsigma > 0; else the body is seen from behind.  While [-m, n]
sticks and the loads go on in proportion, its right end is driven by dQ - pi dsigma (m + n)/8, which
vanishes at a width m + n = H = 8 dQ/(pi dsigma).  Between the moderate and the large regime a
half-cycle has three phases:

1. Slip as in large tension makes both ends recede until m + n = H: n is as small as it gets.
2. The right edge sticks again, from n outward.  Its new end is not loaded, so that m + n = H stays:

       dq/dlambda = (dsigma/4) sqrt((H - t)/t),    t = x + m,

   lambda the part of the half-cycle.  How fast m falls, Lambda = -dlambda/dm, follows from friction
   at -m, which is Abel's equation:

       (dsigma/4) int_m^m1 sqrt((H - t)/t) Lambda(mu) dmu = 2 f p(-m) - dq1(-m),    t = mu - m,

   m1 and dq1 those at the end of phase 1.  Where m passes a kink of the body, p has d log d, d the
   distance from it: Lambda has a root before the kink and none behind, and is kept leg by leg.
3. All of the right edge sticks, m + c = H, and from now on it slips as in moderate tension.

Each half-cycle ends as the other one began, with the sign of shear turned.  So what slips back on
the right in phase 1 is 2 f p less the gain, the shear won since it stuck again: 2 f p where phase 3
brought it to friction.  The gain is found by iteration, in tables of more and more terms until m
and n stay.

Shear must not be driven on where it is at friction since the last half-cycle: on the left, and on
the right where nothing was won.  In phase 1 its rate changes its sign at mid + H/2, mid the middle
of what sticks so far: at n when the phase ends, and nowhere there when it begins.

In phases 1 and 3 slip grows as bounded.py says, in phase 3 with what was won taken off.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..kernels import (
    LAW,
    LOOP,
    kernel,
    matrix,
    opened,
    real,
    record,
    results,
    truth,
    vector,
    whole,
)
from .bounded import (
    FRICTION,
    GAIN,
    SLIP,
    Friction,
    Gain,
    change,
    friction,
    lacking,
    no_gain,
    placed,
    rubbed,
    seen,
    sense_of,
    share,
    solved,
)
from .moderate import patch
from .newton import EPS, narrowed
from .quadrature import double_exponential
from .tables import (
    ANGLES,
    GAUSS,
    GAUSS_WEIGHTS,
    Table,
    chebyshev_place,
    series_of,
    summed,
    table_place,
    tabled,
)
from .zone import MIXED, UNSOLVED, ends_of, stick_zone

TERMS = (16, 24, 36, 54)
"""Terms of the tables, one after the other."""

LEVEL = 2
"""Level of the quadrature of slip zones."""

AGREED = 1e-7
"""Zones by two tables that agree to this, in parts of the contact, are exact by the finer one."""

ROUNDS = 20
"""Rounds of the iteration at most; three to five are common."""

REST = 1e-9
"""Change of m and n from one round to the next that is none, in parts of the contact."""

SLACK = 1e-6
"""What is allowed for rounding, in parts of the friction."""

STRETCHES = (1 / 64, 1 / 16, 1 / 4, 1.0)
"""How far tables of phase 2 reach, in parts of the way to the end of the stick zone's growth."""

NEAR = 1e-4
"""Where roots at the edges are measured to start from, in parts of H."""

STEPS = 80
"""Steps at most to find the end of phase 2."""

STRIP, BESIDE = 2e-3, 4e-3
"""How far past its end the moderate zone is led on where tables fail, and whence, over a + c."""


CROWDED, CROWDED_WEIGHTS = double_exponential(2.0**-4)
"""The quadrature of what was won: roots and what is nearly singular at both ends."""


class Receded(NamedTuple):
    """Phase 2, in legs between the breaks that m passes; its m and part at the end.

    tops     where m is when a leg begins
    spans    how far the table of a leg reaches
    rates    a leg's Lambda as a series in s, mu = top - span sin(pi s/2)**2, a row each
    s        where the last leg ends
    stretch  number of the stretch that the last table spans, four a leg
    """

    tops: Any
    spans: Any
    rates: Any
    m: float
    part: float
    s: float
    stretch: int


class State(NamedTuple):
    """What a half-cycle leaves to the next: its zone, the gain, and where to start from.

    m, n         the permanent stick zone; NaN where the phases are not these
    left, right  slip zones of phase 3
    """

    m: float
    n: float
    gain: Any
    left: float
    right: float
    stretch: int


RECEDED = record(Receded, vector, vector, matrix, real, real, real, whole)
STATE = record(State, real, real, GAIN, real, real, whole)


@kernel(FRICTION(FRICTION, real, real, real, GAIN, GAIN))
def _with_gains(of: Any, part: float, a: float, kappa: float, left: Any, right: Any) -> Any:
    """Of a part of the loads, slip zones on the left as far as a, and gains."""
    cycle, cuts = of.cycle.copy(), np.empty(of.cuts.size + 4)
    cycle[4], cycle[5] = part * cycle[4], part * cycle[5]
    cuts[0], cuts[1] = left.table.start, left.table.end
    cuts[2], cuts[3] = right.table.start, right.table.end
    for i in range(of.cuts.size):
        cuts[4 + i] = of.cuts[i]
    return Friction(
        of.pressure, of.own, of.sense, cycle, cuts, a, of.c, 0.0, 0.0, kappa, left, right
    )


@kernel(real(FRICTION))
def _width(of: Any) -> float:
    """H."""
    return float(8 * of.cycle[4] / (math.pi * of.cycle[5]))


# ---------------------------------------------------------------- Abel's equation


@kernel(vector(matrix))
def _eliminated(rows: Any) -> Any:
    """The solution of linear equations, by Gauss's elimination; their right sides come last."""
    count = len(rows)
    for k in range(count):
        pivot = k
        for i in range(k + 1, count):
            if abs(rows[i, k]) > abs(rows[pivot, k]):
                pivot = i
        if not abs(rows[pivot, k]) > 0:
            return np.full(count, math.nan)
        for j in range(k, count + 1):
            rows[k, j], rows[pivot, j] = rows[pivot, j], rows[k, j]
        for i in range(k + 1, count):
            factor = rows[i, k] / rows[k, k]
            for j in range(k, count + 1):
                rows[i, j] -= factor * rows[k, j]
    found = np.empty(count)
    for k in range(count - 1, -1, -1):
        found[k] = rows[k, count]
        for j in range(k + 1, count):
            found[k] -= rows[k, j] * found[j]
        found[k] /= rows[k, k]
    return found


@kernel(vector(real, vector))
def abel(width: float, right: Any) -> Any:
    """The series Lambda(s) whose integrals at the places s are `right`.

    int_0^(pi/2) sqrt(width - (v sin(phi))**2) cos(phi) Lambda dphi = right,   v = sin(pi s/2),
    Lambda where v is v cos(phi)
    """
    count = len(right)
    rows = np.zeros((count, count + 1))
    for i in range(count):
        v = math.sin(math.pi / 2 * chebyshev_place(i, count))
        for j in range(ANGLES):
            phi = math.pi / 2 * GAUSS[j]
            far = math.sqrt(max(width - (v * math.sin(phi)) ** 2, 0.0)) * math.cos(phi)
            t = 4 / math.pi * math.asin(v * math.cos(phi)) - 1
            term = math.pi / 2 * GAUSS_WEIGHTS[j] * far
            last = t * term
            for k in range(count):
                rows[i, k] += term
                term, last = 2 * t * term - last, term
        rows[i, count] = right[i]
    return _eliminated(rows)


# ---------------------------------------------------------------- the three phases


@kernel(real(vector, real, real))
def _gone(rates: Any, span: float, s: float) -> float:
    """The part of the half-cycle since a leg began:  span int_0^s (pi/2) sin(pi s) Lambda ds."""
    part = 0.0
    for i in range(len(GAUSS)):
        part += GAUSS_WEIGHTS[i] * math.sin(math.pi * s * GAUSS[i]) * summed(rates, s * GAUSS[i])
    return math.pi / 2 * span * s * part


@kernel(real(FRICTION, RECEDED, real))
def _won(of: Any, receded: Any, x: float) -> float:
    """(dsigma/4) int sqrt((H - x - mu)/(x + mu)) Lambda dmu over mu > m, while x sticks."""
    total, legs = 0.0, len(receded.tops)
    for leg in range(legs):
        last = receded.tops[leg + 1] if leg < legs - 1 else receded.m
        room = _width(of) - x - receded.tops[leg]
        top = min(0.0, room)
        length = receded.tops[leg] + top - last
        if length > 0:
            rates, span = receded.rates[leg], receded.spans[leg]
            for i in range(len(CROWDED)):
                below_top = length * CROWDED[len(CROWDED) - 1 - i]
                s = 2 / math.pi * math.asin(math.sqrt(min((below_top - top) / span, 1.0)))
                above, below = below_top + (room - top), (x + last) + length * CROWDED[i]
                weight = length * CROWDED_WEIGHTS[i]
                total += weight * summed(rates, s) * math.sqrt(above / below)
    return float(of.cycle[5] / 4 * total)


@kernel(vector(FRICTION, SLIP, RECEDED, real, whole))
def _rates(of: Any, grown: Any, before: Any, span: float, count: int) -> Any:
    """Lambda on the leg behind those before, down to m - span."""
    s = np.array([chebyshev_place(i, count) for i in range(count)])
    places = span * np.sin(math.pi / 2 * s) ** 2 - before.m
    right = rubbed(of, places)
    for i in range(count):
        right[i] -= change(grown, places[i]) + _won(of, before, places[i])
        right[i] *= 2 / (of.cycle[5] * span * math.sin(math.pi / 2 * s[i]))
    return abel(_width(of) / span, right)


@kernel(real(FRICTION, real, real))
def _next_break(of: Any, m: float, least: float) -> float:
    """Where m passes a break next, falling; `least` where it does not."""
    found = least
    for place in of.cuts:
        if found < -place < m:
            found = -place
    return found


@kernel(RECEDED(RECEDED, real, vector, real, whole))
def _with_leg(before: Any, span: float, rates: Any, part: float, stretch: int) -> Any:
    """One more leg, which begins where the last one ends, as far as its table reaches."""
    legs = len(before.tops)
    tops, spans = np.full(legs + 1, before.m), np.full(legs + 1, span)
    series = np.empty((legs + 1, len(rates)))
    tops[:legs], spans[:legs], series[:legs] = before.tops, before.spans, before.rates
    series[legs] = rates
    return Receded(tops, spans, series, before.m - span, part, 1.0, stretch)


@kernel(RECEDED(RECEDED, real, real, real))
def _ending(receded: Any, m: float, part: float, s: float) -> Any:
    """The same with another end."""
    return Receded(receded.tops, receded.spans, receded.rates, m, part, s, receded.stretch)


@kernel(RECEDED(RECEDED, real))
def _cut_off(receded: Any, part: float) -> Any:
    """Ended in its last leg, with the half-cycle; part: what was gone before that leg."""
    top, span, rates = receded.tops[-1], receded.spans[-1], receded.rates[-1]
    bracket = (0.0, 1.0, 1.0, 1.0)
    for _ in range(STEPS if receded.part < math.inf else 0):
        s = bracket[2]
        excess = part + _gone(rates, span, s) - 1
        rate = math.pi / 2 * span * math.sin(math.pi * s) * summed(rates, s)
        bracket = narrowed(bracket, excess, rate, 4 * EPS)
        if bracket[1] - bracket[0] <= 8 * EPS:
            return _ending(receded, top - span * math.sin(math.pi / 2 * s) ** 2, 1.0, s)
    return _ending(receded, math.nan, 1.0, math.nan)


@kernel(RECEDED(FRICTION, SLIP, real, real, whole, whole))
def _recede(of: Any, grown: Any, middle: float, part: float, stretch: int, count: int) -> Any:
    """Phase 2, until all of the right edge sticks or the half-cycle ends.

    How far m falls is not known beforehand: tables reach further and further.  At a break begins
    another leg, as Lambda has a root before it.
    """
    sticks_all_right, nowhere = _width(of) - of.c, np.empty(0)
    least, legs = max(sticks_all_right, -middle), 0
    receded = Receded(nowhere, nowhere, np.empty((0, count)), grown.m, part, math.nan, 0)
    while receded.m > least:
        before, full = receded, receded.m - _next_break(of, receded.m, least)
        for i in range(max(min(stretch - 4 * legs, 3), 0), len(STRETCHES)):
            span = STRETCHES[i] * full
            rates = _rates(of, grown, before, span, count)
            gone = before.part + _gone(rates, span, 1.0)
            receded = _with_leg(before, span, rates, gone, 4 * legs + i)
            if not gone < 1:
                return _cut_off(receded, before.part)
        legs += 1
    return receded if sticks_all_right >= -middle else _ending(receded, math.nan, 1.0, math.nan)


@kernel(GAIN(FRICTION, RECEDED, SLIP, real, real, real, whole))
def _won_from(
    of: Any, receded: Any, grown: Any, start: float, end: float, near: float, count: int
) -> Any:
    """The gain of phase 2; near > 0: on the left, where shear of phase 1 is added."""
    values = np.empty(count)
    for i in range(count):
        x = table_place(start, end, near, i, count)
        values[i] = _won(of, receded, x)
        if near > 0:
            values[i] += change(grown, x)
    return Gain(Table(start, end, near, series_of(values)), 0.0)


@kernel(SLIP(FRICTION, real, real))
def _regrown(of: Any, left: float, right: float) -> Any:
    """Slip zones of phase 3: from those of the last half-cycle, else from a first guess.

    That takes roots for what friction lacks at both edges.  At its start the left edge is driven by
    2 dQ and the right one not at all; later by what the stick zone has lost in width.
    """
    if left > 0:
        slip = solved(of, left, right, LEVEL)
        if slip.d_left > 0:
            return slip
    H, near = _width(of), NEAR * _width(of)
    scale = math.pi / 2 * math.sqrt(H / near)
    at_left = scale * lacking(of, of.left, np.array([near - of.a]))[0]
    at_right = scale * lacking(of, of.right, np.array([of.c - near]))[0]
    left, right = H / 4, H / 4
    if at_left > 0:
        left = min(2 * of.cycle[4] / at_left, left)
    growth = math.pi * of.cycle[5] / 8
    if at_right > growth:
        right = min(max(growth * left / (at_right - growth), 1e-9 * H), right)
    return solved(of, left, right, LEVEL)


@kernel(STATE(FRICTION, real, STATE, whole))
def _half_cycle(of: Any, middle: float, begun: Any, count: int) -> Any:
    """The zone and the gain that a half-cycle ends with, by tables of so many terms."""
    nothing = State(math.nan, math.nan, begun.gain, math.nan, math.nan, 0)
    c, H = of.c, _width(of)
    of = _with_gains(of, 1.0, of.a, -1.0, no_gain(), begun.gain)
    grown = placed(of, H, begun.n, LEVEL)
    n_1, part = grown.n, share(of, grown)
    if not (0 < part < 1 and -grown.m < middle < n_1 and grown.m <= of.a):
        return nothing
    receded = _recede(of, grown, middle, part, begun.stretch, count)
    if not receded.m < grown.m:
        return nothing
    for leg in range(len(receded.tops)):
        end = receded.s if leg == len(receded.tops) - 1 else 1.0
        for i in range(count):
            if not summed(receded.rates[leg], end * chebyshev_place(i, count)) >= 0:
                return nothing
    m, n, left, right = receded.m, H - receded.m, 0.0, 0.0
    won_right = _won_from(of, receded, grown, n_1, min(n, c), 0.0, count)
    if not receded.part < 1:
        return State(m, n_1, won_right, left, right, receded.stretch)

    middle_right = (middle + n_1) / 2
    won_left = _won_from(of, receded, grown, -m, middle_right, grown.m - m, count)
    of = _with_gains(of, 1 - receded.part, m, 1.0, won_left, won_right)
    slip = _regrown(of, begun.left, begun.right)
    left, right = slip.d_left, slip.d_right
    if not (left < m + middle_right and left - m < middle < c - right):
        return nothing
    n = slip.n
    start = n_1 if n > n_1 else 2 * n - c
    values = np.empty(count)
    for i in range(count):
        x = table_place(start, n, 0.0, i, count)
        values[i] = tabled(won_right.table, x) + change(slip, x)
    gain = Gain(Table(start, n, 0.0, series_of(values)), 1.0)
    return State(slip.m, n_1, gain, left, right, receded.stretch)


@kernel(truth(FRICTION, STATE))
def _is_sound(of: Any, state: Any) -> bool:
    """Whether shear stays within friction where it sticks again, and is not driven on elsewhere."""
    table, count, most, off = state.gain.table, len(state.gain.table.terms), 0.0, 0.0
    places = np.array([table_place(state.n, table.end, 0.0, i, count) for i in range(count)])
    twice = rubbed(of, places)
    for i in range(count):
        won = tabled(table, places[i])
        if not abs(won) < math.inf:
            return False
        most, off = max(most, twice[i]), max(off, -won, won - twice[i])
    turns = (of.c - of.a) / 2 + _width(of) / 2
    last = of.c if state.gain.rubs > 0 else table.end
    return state.n < table.end <= of.c and -state.m <= turns <= last and off <= SLACK * most


@kernel(results(2)(LAW, vector, vector, real))
def turning(law: Any, own: Any, cycle: Any, sense: float) -> Any:
    """m and n of a cycle as seen; NaN where the phases are not these, or tables do not agree."""
    a, c = cycle[0], cycle[1]
    if not (cycle[4] > 0 and cycle[5] > 0 and a + c > 0):
        return math.nan, math.nan
    of = friction(law, own, cycle, sense, -1.0, math.nan)
    grown = placed(of, _width(of), math.nan, LEVEL)
    middle = grown.n - (grown.m + grown.n) / 4
    state = State(math.nan, math.nan, no_gain(), math.nan, math.nan, 0)
    for count in TERMS:
        coarser, changed = state, math.inf
        for _ in range(ROUNDS):
            last, state = state, _half_cycle(of, middle, state, count)
            changed = max(abs(state.m - last.m), abs(state.n - last.n))
            if not state.n < math.inf or changed <= REST * (a + c):
                break
        if not (changed <= REST * (a + c) and _is_sound(of, state)):
            break
        if max(abs(state.m - coarser.m), abs(state.n - coarser.n)) <= AGREED * (a + c):
            return state.m, state.n
    return math.nan, math.nan


@kernel(results(3)(LAW, vector, matrix, vector, real))
def _moderate(law: Any, own: Any, ends: Any, cycle: Any, times: float) -> Any:
    """m and n under moderate tension so many times as large, seen so that it is positive.

    And how far a + n is past H, in parts of the contact.
    """
    tried = cycle.copy()
    tried[5] *= times
    m, n = patch(law, own, ends, 0, 1, 1.0, tried)
    a = cycle[0]
    if tried[5] < 0:
        m, n, a = n, m, cycle[1]
    past = a + n - 8 * cycle[4] / (math.pi * abs(tried[5]))
    return m, n, past / (cycle[0] + cycle[1])


@kernel(results(2)(LAW, vector, matrix, vector))
def turned_round(law: Any, own: Any, ends: Any, cycle: Any) -> Any:
    """m and n of a cycle of constant loads in which slip turns round; NaN where they are not found.

    A little past the end of the moderate zone, where tables fail, n parts from the moderate one
    like the square of what a + n is past H, and m far less: by how much is taken from a tension a
    little larger.

    ends, cycle: as in zone.py.
    """
    sense, as_seen = sense_of(cycle), seen(cycle)
    m, n = turning(law, own, as_seen, sense)
    m_0, n_0, past = _moderate(law, own, ends, cycle, 1.0)
    if math.isnan(m) and 0 < past <= STRIP:
        rate = (_moderate(law, own, ends, cycle, 1 + STRIP)[2] - past) / STRIP
        times = 1 + (BESIDE - past) / rate
        m_1, n_1, beyond = _moderate(law, own, ends, cycle, times)
        more = as_seen.copy()
        more[5] *= times
        m, n = turning(law, own, more, sense)
        part = (past / beyond) ** 2
        m, n = m_0 + part * (m - m_1), n_0 + part * (n - n_1)
    return (m, n) if sense > 0 else (n, m)


@kernel(LOOP)
def each_stick_zone(law: Any, given: Any, own: Any, out: Any) -> None:
    """As in zone.py, and the zones of mixed cycles at constant normal loads."""
    law = opened(law)
    for i in range(given.shape[0]):
        cycle, body = given[i], own[i]
        m, n, regime = stick_zone(law, body, cycle)
        steady = cycle[0] == cycle[2] and cycle[1] == cycle[3]
        if regime == MIXED and math.isnan(m) and steady:
            m, n = turned_round(law, body, ends_of(law, body, cycle), cycle)
            regime = UNSOLVED if math.isnan(m) else MIXED
        out[i, 0], out[i, 1], out[i, 2] = m, n, regime
