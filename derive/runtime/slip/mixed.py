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

   m1 and dq1 those at the end of phase 1.
3. All of the right edge sticks, m + c = H, and from now on it slips as in moderate tension.

Each half-cycle ends as the other one began, with the sign of shear turned.  So what slips back on
the right in phase 1 is 2 f p less the gain, the shear won since it stuck again: 2 f p where phase 3
brought it to friction.  The gain is found by iteration, in tables of more and more terms until m
and n stay.

Shear must not be driven on where it is at friction since the last half-cycle: on the left, and on
the right where nothing was won.  In phase 1 its rate changes its sign at mid + H/2, mid the middle
of what sticks so far: at n when the phase ends, and nowhere there when it begins.

In phases 1 and 3 slip leaves a change of shear r in both slip zones.  With h_s = m + n and y the
distances from the stick zone it obeys

    left:   int_left r/u dy + int_right r u dy = dQ + pi dsigma h_s/8,    u = sqrt(y/(h_s + y)),
    right:  int_left r u dy + int_right r/u dy = dQ - pi dsigma h_s/8

and inside dq = (1/pi) sqrt((x + m)(n - x)) int r/(sqrt(y (h_s + y)) d) dy, d the distance from x.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..kernels import COMPILED, LAW, PRESSURE, kernel, matrix, real, results, truth, vector, whole
from .large import large_slip
from .moderate import patch
from .tables import (
    GAUSS,
    GAUSS_WEIGHTS,
    TABLE,
    Table,
    abel,
    chebyshev_place,
    record,
    root,
    series_of,
    summed,
    table_place,
    tabled,
)

if COMPILED:
    from numba import types

TERMS = (16, 24, 36, 54)
"""Terms of the tables, one after the other."""

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

NARROWEST = 1e-3
"""The narrowest stick zone in phase 3, in parts of H."""

NEAREST = 1e-9
"""Closer to the stick zone, in parts of a slip zone, finite parts are left to their limit."""

STEPS = 40
"""Newton's steps at most."""

LONGEST, SHORTEST = 2.0, 1e-3
"""The longest of Newton's steps for both slip zones, in the logarithm of one over the stick zone;
and how far it is cut down, at most, where it leads away."""

SMALL = 1e-10
"""After a step below this the next one is below rounding."""

STRIP, BESIDE = 2e-3, 4e-3
"""How far past its end the moderate zone is led on where tables fail, and whence, over a + c."""

EPS = 2.0**-52


def _double_exponential(step: float, reach: float) -> Any:
    """Nodes q = 1/(1 + exp(-pi sinh t)) and weights on (0, 1): they crowd towards both ends."""
    count = round(reach / step)
    t = step * np.arange(-count, count + 1)
    q, rest = (1 / (1 + np.exp(sign * math.pi * np.sinh(t))) for sign in (-1, 1))
    return q, step * math.pi * np.cosh(t) * q * rest


NODES, WEIGHTS = _double_exponential(1 / 16, 4.0)
"""The quadrature of slip zones: next to breaks and ends all kinds of roots and logarithms occur."""


class Cycle(NamedTuple):
    """A half-cycle seen so that dsigma > 0.

    pressure, own, at_a, at_c  of the body as it is; x there is `sense` times x here
    width                      H
    middle                     a place that sticks all the time
    """

    pressure: Any
    own: Any
    breaks: Any
    at_a: float
    at_c: float
    sense: float
    a: float
    c: float
    dQ: float
    dsigma: float
    f: float
    width: float
    middle: float


class Slip(NamedTuple):
    """A stick zone, and what slips beside it: rows of y, its weight, and r there."""

    m: float
    n: float
    left: Any
    right: Any


class Receded(NamedTuple):
    """Phase 2: Lambda as a series in v, mu = m_1 - span v**2; m, the part and v at its end.

    stretch: number of the stretch that the table spans.
    """

    m_1: float
    span: float
    rates: Any
    m: float
    part: float
    v: float
    stretch: int


class Gain(NamedTuple):
    """Shear won since it stuck again: tabled, and beyond 2 f p if it rubs there, else nothing."""

    table: Any
    rubs: float


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


FUNCTION = types.FunctionType(PRESSURE) if COMPILED else PRESSURE
CYCLE = record(Cycle, FUNCTION, vector, vector, *[real] * 10)
SLIP = record(Slip, real, real, matrix, matrix)
RECEDED = record(Receded, real, real, vector, real, real, real, whole)
GAIN = record(Gain, TABLE, real)
STATE = record(State, real, real, GAIN, real, real, whole)


@kernel(real(CYCLE, real))
def _twice(cycle: Any, x: float) -> float:
    """2 f p; nothing at a corner, where it is infinite."""
    p = cycle.pressure(cycle.sense * x, cycle.at_a, cycle.at_c, cycle.own)
    return 2 * cycle.f * p if p < math.inf else 0.0


@kernel(real(CYCLE, GAIN, real))
def _lacking(cycle: Any, gain: Any, x: float) -> float:
    """2 f p less a gain."""
    twice = _twice(cycle, x)
    if x < gain.table.end:
        return twice - tabled(gain.table, x)
    return 0.0 if gain.rubs > 0 else twice


# ---------------------------------------------------------------- slip zones


@kernel(real(real, real, real))
def _next_cut(cut: float, low: float, high: float) -> float:
    """The cut if it lies between, else `high`."""
    return cut if low < cut < high else high


@kernel(matrix(CYCLE, GAIN, real, real, real, real))
def _slip_zone(cycle: Any, gain: Any, side: float, start: float, end: float, kappa: float) -> Any:
    """Rows of y, weight and r = kappa (2 f p - gain) at x = side (start + y), as far as `end`."""
    zone = np.empty(((len(cycle.breaks) + 3) * len(NODES), 3))
    count, low, length = 0, 0.0, end - start
    while low < length:
        high = _next_cut(side * gain.table.start - start, low, length)
        high = _next_cut(side * gain.table.end - start, low, high)
        for place in cycle.breaks:
            high = _next_cut(side * place - start, low, high)
        for i in range(len(NODES)):
            y = low + (high - low) * NODES[i]
            zone[count, 0], zone[count, 1] = y, (high - low) * WEIGHTS[i]
            zone[count, 2] = kappa * _lacking(cycle, gain, side * (start + y))
            count += 1
        low = high
    return zone[:count]


@kernel(results(4)(matrix, real))
def _integrals(zone: Any, stuck: float) -> Any:
    """Integrals over a slip zone.

    near    int r sqrt((h_s + y)/y) dy
    far     int r sqrt(y/(h_s + y)) dy
    along   finite part of int r/(y**(3/2) (h_s + y)**(1/2)) dy
    across  int r/(y**(1/2) (h_s + y)**(3/2)) dy
    """
    near = far = along = across = 0.0
    if len(zone) == 0:
        return near, far, along, across
    length, at_start = zone[-1, 0], zone[0, 2] / math.sqrt(stuck)
    along = -2 * at_start / math.sqrt(length)
    for i in range(len(zone)):
        y, weight, r = zone[i, 0], zone[i, 1], zone[i, 2]
        beyond = stuck + y
        force = weight * r / math.sqrt(y * beyond)
        near += force * beyond
        far += force * y
        across += force / beyond
        if y > NEAREST * length:
            along += (force - weight * at_start / math.sqrt(y)) / y
    return near, far, along, across


@kernel(real(SLIP, real))
def _change(slip: Any, x: float) -> float:
    """dq at x in the stick zone."""
    total, stuck = 0.0, slip.m + slip.n
    for zone, away in ((slip.left, x + slip.m), (slip.right, slip.n - x)):
        for i in range(len(zone)):
            y, weight, r = zone[i, 0], zone[i, 1], zone[i, 2]
            total += weight * r / (math.sqrt(y * (stuck + y)) * (y + away))
    return root((x + slip.m) * (slip.n - x)) / math.pi * total


@kernel(results(3)(real, real, real, real, real))
def _narrowed(x: float, value: float, rate: float, low: float, high: float) -> Any:
    """The bracket of an increasing function's root with x taken in, and where to look next."""
    if value < 0:
        low = x
    else:
        high = x
    following = x - value / rate if rate > 0 else math.inf
    return low, high, (following if low < following < high else (low + high) / 2)


# ---------------------------------------------------------------- the three phases


@kernel(SLIP(CYCLE, GAIN, real))
def _grow(cycle: Any, gain: Any, n: float) -> Any:
    """Phase 1: n from the right condition at m + n = H, where neither load drives the right end.

    n: where to look first.
    """
    H, nothing = cycle.width, Gain(Table(cycle.c, cycle.c, 0.0, np.zeros(1)), 0.0)
    low, high = max(H - cycle.a, -cycle.a), cycle.c
    if not low < n < high:
        n = (low + high) / 2
    for _ in range(2 * STEPS):
        left = _slip_zone(cycle, nothing, -1.0, H - n, cycle.a, 1.0)
        right = _slip_zone(cycle, gain, 1.0, n, cycle.c, -1.0)
        _, far, _, across = _integrals(left, H)
        near, _, along, _ = _integrals(right, H)
        low, high, following = _narrowed(n, far + near, H / 2 * (across + along), low, high)
        if abs(following - n) <= 1e-12 * H or high - low <= 1e-12 * H:
            return Slip(H - n, n, left, right)
        n = following
    return Slip(math.nan, math.nan, left, right)


@kernel(real(vector, real, real))
def _gone(rates: Any, span: float, v: float) -> float:
    """The part of the half-cycle since phase 1:  span int_0^v 2 v Lambda dv."""
    part = 0.0
    for i in range(len(GAUSS)):
        part += GAUSS_WEIGHTS[i] * GAUSS[i] * summed(rates, v * GAUSS[i])
    return 2 * span * v * v * part


@kernel(vector(CYCLE, SLIP, real, whole))
def _rates(cycle: Any, grown: Any, span: float, count: int) -> Any:
    """Lambda down to m_1 - span."""
    right = np.empty(count)
    for i in range(count):
        v = chebyshev_place(i, count)
        x = span * v * v - grown.m
        right[i] = 2 * (_twice(cycle, x) - _change(grown, x)) / (cycle.dsigma * span * v)
    return abel(cycle.width / span, right)


@kernel(RECEDED(CYCLE, SLIP, real, whole, whole))
def _recede(cycle: Any, grown: Any, part: float, stretch: int, count: int) -> Any:
    """Phase 2, until all of the right edge sticks or the half-cycle ends.

    How far m falls is not known beforehand: tables reach further and further.
    """
    H, m_1 = cycle.width, grown.m
    full = m_1 - max(H - cycle.c, -cycle.middle)
    rates, whole_part, span = np.zeros(count), math.nan, full
    while full > 0:
        span = STRETCHES[stretch] * full
        rates = _rates(cycle, grown, span, count)
        whole_part = part + _gone(rates, span, 1.0)
        if not whole_part < 1 or stretch == len(STRETCHES) - 1:
            break
        stretch += 1
    if whole_part < 1 and H - cycle.c >= -cycle.middle:
        return Receded(m_1, span, rates, m_1 - span, whole_part, 1.0, stretch)
    v, low, high = 1.0, 0.0, 1.0
    for _ in range(2 * STEPS if 1 <= whole_part < math.inf else 0):
        excess = part + _gone(rates, span, v) - 1
        rate = 2 * span * v * summed(rates, v)
        low, high, following = _narrowed(v, excess, rate, low, high)
        if abs(following - v) <= 1e-14 * v:
            return Receded(m_1, span, rates, m_1 - span * v * v, 1.0, v, stretch)
        v = following
    return Receded(m_1, span, rates, math.nan, 1.0, math.nan, stretch)


@kernel(real(CYCLE, RECEDED, real))
def _won(cycle: Any, receded: Any, x: float) -> float:
    """(dsigma/4) int sqrt((H - x - mu)/(x + mu)) Lambda dmu over mu > m, while x sticks."""
    room = cycle.width - x - receded.m_1
    top = min(0.0, room)
    length = receded.m_1 + top - receded.m
    if not length > 0:
        return 0.0
    total = 0.0
    for i in range(len(NODES)):
        below_top = length * NODES[len(NODES) - 1 - i]
        rate = summed(receded.rates, min(math.sqrt((below_top - top) / receded.span), 1.0))
        above, below = below_top + (room - top), (x + receded.m) + length * NODES[i]
        total += WEIGHTS[i] * rate * math.sqrt(above / below)
    return cycle.dsigma / 4 * length * total


@kernel(GAIN(CYCLE, RECEDED, SLIP, real, real, real, whole))
def _won_from(
    cycle: Any, receded: Any, grown: Any, start: float, end: float, near: float, count: int
) -> Any:
    """The gain of phase 2; near > 0: on the left, where shear of phase 1 is added."""
    values = np.empty(count)
    for i in range(count):
        x = table_place(start, end, near, i, count)
        values[i] = _won(cycle, receded, x)
        if near > 0:
            values[i] += _change(grown, x)
    return Gain(Table(start, end, near, series_of(values)), 0.0)


@kernel(results(2)(real, real, real, real, real))
def _moved(width: float, left: float, right: float, by_left: float, by_right: float) -> Any:
    """Slip zones whose logarithms over the stick zone have grown."""
    stuck = width - left - right
    over_left, over_right = left / stuck * math.exp(by_left), right / stuck * math.exp(by_right)
    whole = 1 + over_left + over_right
    return width * over_left / whole, width * over_right / whole


@kernel(SLIP(CYCLE, GAIN, GAIN, real, real))
def _beside(cycle: Any, won_left: Any, won_right: Any, left: float, right: float) -> Any:
    """The slip of phase 3 with slip zones of these lengths."""
    a, c = -won_left.table.start, cycle.c
    m, n = a - left, c - right
    return Slip(
        m,
        n,
        _slip_zone(cycle, won_left, -1.0, m, a, 1.0),
        _slip_zone(cycle, won_right, 1.0, n, c, 1.0),
    )


@kernel(results(3)(SLIP, real, real, real, real))
def _step(slip: Any, dQ: float, dsigma: float, left: float, right: float) -> Any:
    """Newton's step of the logarithms of both slip zones over the stick zone, and the miss."""
    stuck = slip.m + slip.n
    near_l, far_l, along_l, across_l = _integrals(slip.left, stuck)
    near_r, far_r, along_r, across_r = _integrals(slip.right, stuck)
    by_tension = math.pi * stuck * dsigma / 8
    off_left = near_l + far_r - dQ - by_tension
    off_right = far_l + near_r - dQ + by_tension
    skew = (off_right - off_left) / (2 * stuck)
    right_n = skew + stuck * (across_l + along_r) / 2
    left_m = -skew + stuck * (along_l + across_r) / 2
    determinant = right_n * left_m + skew * skew
    if determinant == 0:
        return math.nan, math.nan, math.inf
    left_grows = (off_left * right_n + skew * off_right) / determinant
    right_grows = (off_right * left_m - skew * off_left) / determinant
    rate = (left_grows + right_grows) / stuck
    return left_grows / left + rate, right_grows / right + rate, off_left**2 + off_right**2


@kernel(results(2)(CYCLE, GAIN, GAIN, real, real, real))
def _by_newton(
    cycle: Any, won_left: Any, won_right: Any, rest: float, left: float, right: float
) -> Any:
    """Slip zones of phase 3 for this part of the loads, from a guess; NaN if they are not found."""
    width = cycle.c - won_left.table.start
    dQ, dsigma = rest * cycle.dQ, rest * cycle.dsigma
    to_left, to_right, part, best = 0.0, 0.0, 1.0, math.inf
    for _ in range(STEPS):
        now_left, now_right = _moved(width, left, right, part * to_left, part * to_right)
        stuck = width - now_left - now_right
        if not (now_left > 0 and now_right > 0 and stuck > NARROWEST * width):
            break
        slip = _beside(cycle, won_left, won_right, now_left, now_right)
        by_left, by_right, miss = _step(slip, dQ, dsigma, now_left, now_right)
        if miss < best:
            left, right, best, part = now_left, now_right, miss, 1.0
            longest = max(abs(by_left), abs(by_right))
            shrink = LONGEST / max(LONGEST, longest)
            to_left, to_right = by_left * shrink, by_right * shrink
            if longest < max(SMALL, 16 * EPS * width / min(left, right, stuck)):
                return _moved(width, left, right, to_left, to_right)
        else:
            part /= 4
        if not (best < math.inf and part > SHORTEST):
            break
    return math.nan, math.nan


@kernel(results(2)(CYCLE, GAIN, GAIN, real, real, real))
def _followed(
    cycle: Any, won_left: Any, won_right: Any, rest: float, left: float, right: float
) -> Any:
    """Slip zones of phase 3: from those of the last half-cycle, else from a first guess.

    That takes roots for what friction lacks at both edges.  At its start the left edge is driven by
    2 dQ and the right one not at all; later by what the stick zone has lost in width.
    """
    if left > 0:
        left, right = _by_newton(cycle, won_left, won_right, rest, left, right)
        if left > 0:
            return left, right
    H, near = cycle.width, NEAR * cycle.width
    scale = math.pi / 2 * math.sqrt(H / near)
    at_left = scale * _lacking(cycle, won_left, won_left.table.start + near)
    at_right = scale * _lacking(cycle, won_right, cycle.c - near)
    if not (at_left > 0 and at_right > 0):
        return math.nan, math.nan
    left, right = min(2 * rest * cycle.dQ / at_left, H / 4), H / 4
    growth = math.pi * rest * cycle.dsigma / 8
    if at_right > growth:
        right = min(max(growth * left / (at_right - growth), 1e-9 * H), H / 4)
    return _by_newton(cycle, won_left, won_right, rest, left, right)


@kernel(STATE(CYCLE, STATE, whole))
def _half_cycle(cycle: Any, begun: Any, count: int) -> Any:
    """The zone and the gain that a half-cycle ends with, by tables of so many terms."""
    nothing = State(math.nan, math.nan, begun.gain, math.nan, math.nan, 0)
    a, c, H, middle = cycle.a, cycle.c, cycle.width, cycle.middle
    grown = _grow(cycle, begun.gain, begun.n)
    n_1 = grown.n
    part = _integrals(grown.left, H)[0] + _integrals(grown.right, H)[1]
    part /= 2 * cycle.dQ
    if not (0 < part < 1 and -grown.m < middle < n_1 and grown.m <= a):
        return nothing
    receded = _recede(cycle, grown, part, begun.stretch, count)
    if not receded.m < grown.m:
        return nothing
    for i in range(count):
        if not summed(receded.rates, receded.v * chebyshev_place(i, count)) >= 0:
            return nothing
    m, n, left, right = receded.m, H - receded.m, 0.0, 0.0
    won_right = _won_from(cycle, receded, grown, n_1, min(n, c), 0.0, count)
    if not receded.part < 1:
        return State(m, n_1, won_right, left, right, receded.stretch)

    rest, middle_right, near = 1 - receded.part, (middle + n_1) / 2, grown.m - m
    won_left = _won_from(cycle, receded, grown, -m, middle_right, near, count)
    left, right = _followed(cycle, won_left, won_right, rest, begun.left, begun.right)
    if not (left < m + middle_right and left - m < middle < c - right):
        return nothing
    slip = _beside(cycle, won_left, won_right, left, right)
    n = slip.n
    start = n_1 if n > n_1 else 2 * n - c
    values = np.empty(count)
    for i in range(count):
        x = table_place(start, n, 0.0, i, count)
        values[i] = tabled(won_right.table, x) + _change(slip, x)
    gain = Gain(Table(start, n, 0.0, series_of(values)), 1.0)
    return State(slip.m, n_1, gain, left, right, receded.stretch)


@kernel(truth(CYCLE, STATE))
def _is_sound(cycle: Any, state: Any) -> bool:
    """Whether shear stays within friction where it sticks again, and is not driven on elsewhere."""
    table, count, most, off = state.gain.table, len(state.gain.table.terms), 0.0, 0.0
    for i in range(count):
        x = table_place(state.n, table.end, 0.0, i, count)
        won, twice = tabled(table, x), _twice(cycle, x)
        if not abs(won) < math.inf:
            return False
        most, off = max(most, twice), max(off, -won, won - twice)
    turns = (cycle.c - cycle.a) / 2 + cycle.width / 2
    last = cycle.c if state.gain.rubs > 0 else table.end
    return state.n < table.end <= cycle.c and -state.m <= turns <= last and off <= SLACK * most


@kernel(results(2)(LAW, vector, real, real, real, real, real, real))
def turning(
    law: Any, own: Any, a: float, c: float, dQ: float, dsigma: float, f: float, middle: float
) -> Any:
    """m and n of a cycle between the contact [-a, c] and itself in which slip turns round.

    middle: a place that sticks all the time.
    NaN where the phases are not these, or tables do not agree.
    """
    if not (dQ > 0 and abs(dsigma) > 0 and a + c > 0 and -a < middle < c):
        return math.nan, math.nan
    width, breaks = 8 * dQ / (math.pi * abs(dsigma)), law.breaks(own)
    cycle = Cycle(law.pressure, own, breaks, a, c, 1.0, a, c, dQ, dsigma, f, width, middle)
    if dsigma < 0:
        cycle = Cycle(law.pressure, own, -breaks, a, c, -1.0, c, a, dQ, -dsigma, f, width, -middle)
    gain = Gain(Table(cycle.c, cycle.c, 0.0, np.zeros(1)), 0.0)
    state = State(math.nan, math.nan, gain, math.nan, math.nan, 0)
    for count in TERMS:
        coarser, changed = state, math.inf
        for _ in range(ROUNDS):
            last, state = state, _half_cycle(cycle, state, count)
            changed = max(abs(state.m - last.m), abs(state.n - last.n))
            if not state.n < math.inf or changed <= REST * (a + c):
                break
        if not (changed <= REST * (a + c) and _is_sound(cycle, state)):
            break
        if max(abs(state.m - coarser.m), abs(state.n - coarser.n)) <= AGREED * (a + c):
            return (state.n, state.m) if dsigma < 0 else (state.m, state.n)
    return math.nan, math.nan


@kernel(real(vector, real, real))
def _past(cycle: Any, m: float, n: float) -> float:
    """How far a + n of the moderate zone is past H, in parts of the contact."""
    a, c, dQ, dsigma = cycle[0], cycle[1], cycle[4], cycle[5]
    whole = c + m if dsigma < 0 else a + n
    return float((whole - 8 * dQ / (math.pi * abs(dsigma))) / (a + c))


@kernel(results(2)(LAW, vector, matrix, vector))
def turned_round(law: Any, own: Any, ends: Any, cycle: Any) -> Any:
    """m and n of a cycle of constant loads in which slip turns round; NaN where they are not found.

    What sticks all the time lies about the middle of the zone of moderate tension, or of large
    tension.  A little past the end of the moderate zone, where tables fail, n parts from the
    moderate one like the square of what a + n is past H, and m far less: by how much is taken from
    a tension a little larger.

    ends, cycle: as in zone.py.
    """
    a, c, dQ, dsigma, f = cycle[0], cycle[1], cycle[4], cycle[5], cycle[6]
    m_0, n_0 = patch(law, own, ends, 0, 1, 1.0, cycle)
    m, n = turning(law, own, a, c, dQ, dsigma, f, (n_0 - m_0) / 2)
    if m < math.inf:
        return m, n
    past, beside = _past(cycle, m_0, n_0), cycle.copy()
    if 0 < past <= STRIP:
        beside[5] = dsigma * (1 + STRIP)
        m_1, n_1 = patch(law, own, ends, 0, 1, 1.0, beside)
        rate = (_past(beside, m_1, n_1) - past) / STRIP
        beside[5] = dsigma * (1 + (BESIDE - past) / rate)
        m_1, n_1 = patch(law, own, ends, 0, 1, 1.0, beside)
        share = (past / _past(beside, m_1, n_1)) ** 2
        m, n = turning(law, own, a, c, dQ, beside[5], f, (n_1 - m_1) / 2)
        return m_0 + share * (m - m_1), n_0 + share * (n - n_1)
    left, right = large_slip(law, own, cycle, AGREED)
    if left < math.inf:
        m, n = turning(law, own, a, c, dQ, dsigma, f, ((c - right) - (a - left)) / 2)
    return m, n
