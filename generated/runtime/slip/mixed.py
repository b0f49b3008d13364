r"""Slip that reverses within a half-cycle at constant normal loads: the exact stick zone.

Tension loads the left edge more, dsigma > 0; otherwise the mirror image is considered.  While [-m,
n] sticks and the loads change in proportion, its right end is driven by dQ - pi dsigma (m + n)/8,
which vanishes at a width m + n = H = 8 dQ/(pi dsigma).  Between the moderate and the large regime a
half-cycle has three phases:

1. With slip as in large tension both ends recede until m + n = H, where n reaches its minimum.
2. The right edge sticks again, from n outward.  The new end is not loaded, so that m + n = H holds:

       dq/dlambda = (dsigma/4) sqrt((H - t)/t),    t = x + m,

   where lambda is the completed part of the half-cycle.  The rate at which m falls, Lambda =
   -dlambda/dm, follows from friction at -m, which is Abel's equation:

       (dsigma/4) int_m^m1 sqrt((H - t)/t) Lambda(mu) dmu = 2 f p(-m) - dq1(-m),    t = mu - m,

   with m1 and dq1 from the end of phase 1.  Where m passes a kink of the body, p contains d log d,
   d being the distance from the kink.  Lambda has a square root before the kink and none beyond it,
   and is therefore stored leg by leg.
3. All of the right edge sticks, m + c = H, and from then on it slips as in moderate tension.

Each half-cycle starts from the end of the other one, with the sign of shear reversed.  In phase 1
the reversed slip on the right therefore leaves 2 f p less the gain, the shear gained since the
point stuck again; the gain is 2 f p where phase 3 brought the point to the friction
limit.  The gain is found by iteration, in tables of more and more terms, until m and n converge.

The shear traction must not be driven further where it has been at the friction limit since the last
half-cycle: on the left, and on the right where nothing was gained.  In phase 1 its rate changes
sign at mid + H/2, where mid is the middle of the current stick zone.  This point is n when the
phase ends, and lies in neither of these regions when the phase begins.

In phases 1 and 3 slip grows as bounded.py describes; in phase 3 the gain is subtracted.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..kernels import kernel, loop, opened
from ..search import between, narrowed
from ..types import MIXED, UNSOLVED
from .bounded import (
    Friction,
    Gain,
    change,
    friction,
    friction_limits,
    no_gain,
    oriented,
    placed,
    remaining_friction,
    sense_of,
    share,
    solved,
    turning_width,
)
from .moderate import patch
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
from .zone import ends_of, over_modulus, stick_zone

TERMS = (16, 24, 36, 54)
"""Numbers of terms of the tables, in turn."""

LEVEL = 2
"""Level of the quadrature of slip zones."""

AGREED = 1e-7
"""If zones by two tables agree to within this, relative to the contact width, the finer one is
exact."""

ROUNDS = 20
"""Largest number of iterations; three to five are common."""

REST = 1e-9
"""Change of m and n between iterations that counts as zero, relative to the contact width."""

SLACK = 1e-6
"""Allowance for rounding, relative to friction."""

STRETCHES = (1 / 64, 1 / 16, 1 / 4, 1.0)
"""Lengths of the tables of phase 2, relative to the distance to its end."""

NEAR = 1e-4
"""Distance, over H, at which the square roots at the edges are measured for a first guess."""

STEPS = 80
"""Largest number of steps to find the end of phase 2."""

STRIP = 1e-4
"""Width of the strip beyond the moderate zone in which the moderate solution stands in for tables
that fail, as (a + n - H)/(a + c).  It is off by less than the square of this."""

CROWDED, CROWDED_WEIGHTS = double_exponential(2.0**-4)
"""The quadrature of the gain, which has square roots and near singularities at both ends."""


class Receded(NamedTuple):
    """Phase 2, in legs between the breaks that m passes, with m and lambda at its end.

    tops     m at the start of each leg
    spans    length of the table of each leg
    rates    Lambda of each leg as a series in s, mu = top - span sin(pi s/2)**2, one row per leg
    m, part  m and lambda at the end
    s        end of the last leg
    stretch  number of the stretch that the last table spans, four per leg
    """

    tops: Any
    spans: Any
    rates: Any
    m: float
    part: float
    s: float
    stretch: int


class State(NamedTuple):
    """The state that a half-cycle passes on to the next: its zone, the gain, and first guesses.

    m, n         the permanent stick zone; NaN unless the half-cycle has these phases
    gain         the gain on the right
    left, right  slip zones of phase 3
    stretch      stretch at which the tables of phase 2 start
    """

    m: float
    n: float
    gain: Any
    left: float
    right: float
    stretch: int


@kernel
def _with_gains(of: Any, part: float, a: float, kappa: float, left: Any, right: Any) -> Any:
    """Friction for a part of the loads, with slip zones on the left up to a, and gains."""
    cycle, cuts = of.cycle.copy(), np.empty(of.cuts.size + 4)
    cycle[4], cycle[5] = part * cycle[4], part * cycle[5]
    cuts[0], cuts[1] = left.table.start, left.table.end
    cuts[2], cuts[3] = right.table.start, right.table.end
    for i in range(of.cuts.size):
        cuts[4 + i] = of.cuts[i]
    return Friction(
        of.pressure, of.own, of.sense, cycle, cuts, a, of.c, 0.0, 0.0, kappa, left, right
    )


# ---------------------------------------------------------------- Abel's equation


@kernel
def _eliminated(rows: Any) -> Any:
    """The solution of linear equations by Gaussian elimination; the right-hand side comes last."""
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
    solution = np.empty(count)
    for k in range(count - 1, -1, -1):
        solution[k] = rows[k, count]
        for j in range(k + 1, count):
            solution[k] -= rows[k, j] * solution[j]
        solution[k] /= rows[k, k]
    return solution


@kernel
def abel(width: float, right: Any) -> Any:
    """The series Lambda(s) whose integrals at the points s are `right`.

    int_0^(pi/2) sqrt(width - (v sin(phi))**2) cos(phi) Lambda dphi = right,   v = sin(pi s/2),
    with Lambda taken at v cos(phi) in place of v
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


@kernel
def _elapsed(rates: Any, span: float, s: float) -> float:
    """The part of the half-cycle since a leg began:  span int_0^s (pi/2) sin(pi s) Lambda ds."""
    part = 0.0
    for i in range(len(GAUSS)):
        part += GAUSS_WEIGHTS[i] * math.sin(math.pi * s * GAUSS[i]) * summed(rates, s * GAUSS[i])
    return math.pi / 2 * span * s * part


@kernel
def _gained(of: Any, receded: Any, x: float) -> float:
    """(dsigma/4) int sqrt((H - x - mu)/(x + mu)) Lambda dmu over mu > m, while x sticks."""
    total, legs = 0.0, len(receded.tops)
    for leg in range(legs):
        bottom = receded.tops[leg + 1] if leg < legs - 1 else receded.m
        distance = turning_width(of.cycle) - x - receded.tops[leg]
        top = min(0.0, distance)
        length = receded.tops[leg] + top - bottom
        if length > 0:
            rates, span = receded.rates[leg], receded.spans[leg]
            for i in range(len(CROWDED)):
                below_top = length * CROWDED[len(CROWDED) - 1 - i]
                s = 2 / math.pi * math.asin(math.sqrt(min((below_top - top) / span, 1.0)))
                above, below = below_top + (distance - top), (x + bottom) + length * CROWDED[i]
                weight = length * CROWDED_WEIGHTS[i]
                total += weight * summed(rates, s) * math.sqrt(above / below)
    return float(of.cycle[5] / 4 * total)


@kernel
def _rates(of: Any, grown: Any, before: Any, span: float, count: int) -> Any:
    """Lambda on the next leg, down to m - span, given the legs before it."""
    s = np.array([chebyshev_place(i, count) for i in range(count)])
    places = span * np.sin(math.pi / 2 * s) ** 2 - before.m
    right = friction_limits(of, places)
    for i in range(count):
        right[i] -= change(grown, places[i]) + _gained(of, before, places[i])
        right[i] *= 2 / (of.cycle[5] * span * math.sin(math.pi / 2 * s[i]))
    return abel(turning_width(of.cycle) / span, right)


@kernel
def _next_break(of: Any, m: float, least: float) -> float:
    """The next break that m passes as it falls; `least` if there is none."""
    next_break = least
    for place in of.cuts:
        if next_break < -place < m:
            next_break = -place
    return next_break


@kernel
def _with_leg(before: Any, span: float, rates: Any, part: float, stretch: int) -> Any:
    """Append one leg, which begins at the end of the last one and extends over its whole table."""
    legs = len(before.tops)
    tops, spans = np.full(legs + 1, before.m), np.full(legs + 1, span)
    series = np.empty((legs + 1, len(rates)))
    tops[:legs], spans[:legs], series[:legs] = before.tops, before.spans, before.rates
    series[legs] = rates
    return Receded(tops, spans, series, before.m - span, part, 1.0, stretch)


@kernel
def _ending(receded: Any, m: float, part: float, s: float) -> Any:
    """The same legs with another end."""
    return Receded(receded.tops, receded.spans, receded.rates, m, part, s, receded.stretch)


@kernel
def _cut_off(receded: Any, part: float) -> Any:
    """The legs ended in the last one by the end of the half-cycle; part: lambda before that leg."""
    top, span, rates = receded.tops[-1], receded.spans[-1], receded.rates[-1]
    search = between(0.0, 1.0, math.nan, 2.0)
    for _ in range(STEPS if receded.part < math.inf else 0):
        s = search.y
        excess = part + _elapsed(rates, span, s) - 1
        rate = math.pi / 2 * span * math.sin(math.pi * s) * summed(rates, s)
        search = narrowed(search, excess, rate)
        if search.step == 0:
            return _ending(receded, top - span * math.sin(math.pi / 2 * s) ** 2, 1.0, s)
    return _ending(receded, math.nan, 1.0, math.nan)


@kernel
def _recede(of: Any, grown: Any, middle: float, part: float, stretch: int, count: int) -> Any:
    """Phase 2, until all of the right edge sticks or the half-cycle ends.

    The range of m is not known beforehand, so that the tables are extended step by step.  A new leg
    begins at each break, because Lambda has a square root before it.
    """
    sticks_all_right, nowhere = turning_width(of.cycle) - of.c, np.empty(0)
    least, legs = max(sticks_all_right, -middle), 0
    receded = Receded(nowhere, nowhere, np.empty((0, count)), grown.m, part, math.nan, 0)
    while receded.m > least:
        before, full = receded, receded.m - _next_break(of, receded.m, least)
        for i in range(max(min(stretch - 4 * legs, 3), 0), len(STRETCHES)):
            span = STRETCHES[i] * full
            rates = _rates(of, grown, before, span, count)
            elapsed = before.part + _elapsed(rates, span, 1.0)
            receded = _with_leg(before, span, rates, elapsed, 4 * legs + i)
            if not elapsed < 1:
                return _cut_off(receded, before.part)
        legs += 1
    return receded if sticks_all_right >= -middle else _ending(receded, math.nan, 1.0, math.nan)


@kernel
def _gain_of_phase_2(
    of: Any, receded: Any, grown: Any, start: float, end: float, near: float, count: int
) -> Any:
    """The gain of phase 2.  near > 0: the gain on the left, where the shear of phase 1 is added."""
    values = np.empty(count)
    for i in range(count):
        x = table_place(start, end, near, i, count)
        values[i] = _gained(of, receded, x)
        if near > 0:
            values[i] += change(grown, x)
    return Gain(Table(start, end, near, series_of(values)), 0.0)


@kernel
def _regrown(of: Any, left: float, right: float) -> Any:
    """Slip zones of phase 3: from those of the last half-cycle, or else from a first guess.

    The first guess takes the remaining friction at both edges as square roots.  At the start of
    phase 3 the left edge is driven by 2 dQ and the right one not at all; later the right one is
    driven in proportion to the loss of width of the stick zone.
    """
    if left > 0:
        slip = solved(of, left, right, LEVEL)
        if slip.d_left > 0:
            return slip
    H, near = turning_width(of.cycle), NEAR * turning_width(of.cycle)
    scale = math.pi / 2 * math.sqrt(H / near)
    at_left = scale * remaining_friction(of, of.left, np.array([near - of.a]))[0]
    at_right = scale * remaining_friction(of, of.right, np.array([of.c - near]))[0]
    left, right = H / 4, H / 4
    if at_left > 0:
        left = min(2 * of.cycle[4] / at_left, left)
    growth = math.pi * of.cycle[5] / 8
    if at_right > growth:
        right = min(max(growth * left / (at_right - growth), 1e-9 * H), right)
    return solved(of, left, right, LEVEL)


@kernel
def _half_cycle(of: Any, middle: float, begun: Any, count: int) -> Any:
    """The zone and the gain at the end of a half-cycle, by tables with `count` terms."""
    nothing = State(math.nan, math.nan, begun.gain, math.nan, math.nan, 0)
    c, H = of.c, turning_width(of.cycle)
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
    gain_right = _gain_of_phase_2(of, receded, grown, n_1, min(n, c), 0.0, count)
    if not receded.part < 1:
        return State(m, n_1, gain_right, left, right, receded.stretch)

    middle_right = (middle + n_1) / 2
    gain_left = _gain_of_phase_2(of, receded, grown, -m, middle_right, grown.m - m, count)
    of = _with_gains(of, 1 - receded.part, m, 1.0, gain_left, gain_right)
    slip = _regrown(of, begun.left, begun.right)
    left, right = slip.d_left, slip.d_right
    if not (left < m + middle_right and left - m < middle < c - right):
        return nothing
    n = slip.n
    start = n_1 if n > n_1 else 2 * n - c
    values = np.empty(count)
    for i in range(count):
        x = table_place(start, n, 0.0, i, count)
        values[i] = tabled(gain_right.table, x) + change(slip, x)
    gain = Gain(Table(start, n, 0.0, series_of(values)), 1.0)
    return State(slip.m, n_1, gain, left, right, receded.stretch)


@kernel
def _is_sound(of: Any, state: Any) -> bool:
    """Whether the shear traction stays within the friction limit where points stick again, and is
    not driven further where it is at that limit."""
    table, count, most, excess = state.gain.table, len(state.gain.table.terms), 0.0, 0.0
    places = np.array([table_place(state.n, table.end, 0.0, i, count) for i in range(count)])
    twice = friction_limits(of, places)
    for i in range(count):
        gained = tabled(table, places[i])
        if not abs(gained) < math.inf:
            return False
        most, excess = max(most, twice[i]), max(excess, -gained, gained - twice[i])
    turns = (of.c - of.a) / 2 + turning_width(of.cycle) / 2
    last = of.c if state.gain.rubs > 0 else table.end
    return state.n < table.end <= of.c and -state.m <= turns <= last and excess <= SLACK * most


@kernel
def zone_by_phases(law: Any, own: Any, cycle: Any, sense: float) -> Any:
    """m and n of a cycle with dsigma >= 0; NaN unless it has the phases and the tables converge."""
    a, c = cycle[0], cycle[1]
    if not (cycle[4] > 0 and cycle[5] > 0 and a + c > 0):
        return math.nan, math.nan
    of = friction(law, own, cycle, sense, -1.0, math.nan)
    grown = placed(of, turning_width(of.cycle), math.nan, LEVEL)
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


@kernel
def mixed_zone(law: Any, own: Any, ends: Any, cycle: Any) -> Any:
    """m and n of a cycle of constant loads in which slip reverses; NaN if they are not found.

    Just beyond the end of the moderate zone, tables may fail.  There n departs from the moderate
    solution as the square of (a + n - H)/(a + c), and m departs far less.

    ends, cycle: as in zone.py.
    """
    sense, as_oriented = sense_of(cycle), oriented(cycle)
    m, n = zone_by_phases(law, own, as_oriented, sense)
    if math.isnan(m):
        m, n = patch(law, own, ends, 0, 1, 1.0, cycle)
        receding = n if sense > 0 else m
        past = as_oriented[0] + receding - turning_width(as_oriented)
        within = 0 < past <= STRIP * (cycle[0] + cycle[1])
        return (m, n) if within else (math.nan, math.nan)
    return (m, n) if sense > 0 else (n, m)


@loop
def each_stick_zone(law: Any, given: Any, own: Any, out: Any) -> None:
    """As in zone.py, and also the zones of mixed cycles at constant normal loads."""
    law = opened(law)
    for i in range(given.shape[0]):
        cycle, body = over_modulus(given[i]), own[i]
        m, n, regime = stick_zone(law, body, cycle)
        steady = cycle[0] == cycle[2] and cycle[1] == cycle[3]
        if regime == MIXED and math.isnan(m) and steady:
            m, n = mixed_zone(law, body, ends_of(law, body, cycle), cycle)
            regime = UNSOLVED if math.isnan(m) else MIXED
        out[i, 0], out[i, 1], out[i, 2] = m, n, regime
