r"""Slip zones beside a stick zone: where shear stays bounded at both of its ends.

A cycle is seen so that tension loads the left edge more, dsigma >= 0; else the body is looked at
from behind.  Slip leaves a change of shear r in both slip zones: f (p1 + p2) on the left, kappa f
(p1 + p2) on the right, less what was won there since it stuck again (mixed.py).  Let h_s = m + n
and y be the distance from the stick zone.  The change of shear is bounded at both ends of [-m, n]
if, with u = sqrt(y/(h_s + y)),

    left:   L = int_left r/u dy + int_right r u dy = dQ + pi h_s dsigma/8,
    right:  R = int_left r u dy + int_right r/u dy = dQ - pi h_s dsigma/8.

With C the finite parts of int r/(y w) dy, w = sqrt(y (h_s + y)), D = int r/((h_s + y) w) dy, and F
the difference of what both conditions, right and left, are off by, over h_s, their rates are

    d right/dn =  F/2 + h_s (C_right + D_left)/2,    d right/dm =  F/2,
    d left/dn  = -F/2,                               d left/dm  = -F/2 + h_s (C_left + D_right)/2.

Between, at distances d and D from this end and the other one, a slip zone that is l long causes

    dq = (sqrt(d D)/pi) int r/(w (y + d)) dy;  and of a constant r, (2 r/pi) arctan sqrt(l D/(d (l +
    h_s))), so that this is taken off.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..kernels import LAW, PRESSURE, function, kernel, real, record, results, vector, whole
from .newton import EPS, log_step, moved, narrowed
from .quadrature import slip_nodes
from .tables import TABLE, Table, tabled

SMALL = 1e-9
"""After a step below this, compared with the slip zone, the next one is below rounding,"""

ROUGH = 1e-7
"""or, by the coarsest rule, below what that is good for."""

STEPS = 40
"""Newton's steps at most for one rule; a solution takes two to eight."""

MET = 1e-7
"""Steps end short of a solution, at a break, unless both conditions are off by less."""

LONGEST = 2.0
"""Longest of Newton's steps in the logarithm of a slip zone over the stick zone."""

SHORTEST = 1e-3
"""A step that leads away even if it is cut down to this part is given up."""

LEAST_STUCK = 1e-3
"""No narrower stick zone is sought, in parts of the width at which slip would reverse."""

NEAREST = 1e-9
"""Closer to the stick zone, in parts of a slip zone, finite parts are left to their limit."""

CLOSE = 4 * EPS
"""How well a stick zone of given width is placed, in parts of it."""


class Gain(NamedTuple):
    """Shear won since it stuck again: tabled, and beyond all of r if it rubs there, else none."""

    table: Any
    rubs: float


class Friction(NamedTuple):
    """What leaves r.

    pressure, own  of the body as it is; x there is `sense` times x here
    cycle          a1, c1, a2, c2, dQ, dsigma, f, as seen
    cuts           where r changes its formula
    a, c           how far slip zones go in the smaller contact
    da, dc         how much further in the larger one
    kappa          sense of slip on the right
    left, right    gains
    """

    pressure: Any
    own: Any
    sense: float
    cycle: Any
    cuts: Any
    a: float
    c: float
    da: float
    dc: float
    kappa: float
    left: Any
    right: Any


class Zone(NamedTuple):
    """A slip zone: nodes y, their weights, and r there; its length; r where it begins."""

    y: Any
    weight: Any
    r: Any
    length: float
    at_start: float


class Slip(NamedTuple):
    """A stick zone [-m, n], the lengths of what slips in the smaller contact, and both zones."""

    m: float
    n: float
    d_left: float
    d_right: float
    left: Any
    right: Any


FUNCTION = function(PRESSURE)
GAIN = record(Gain, TABLE, real)
FRICTION = record(
    Friction, FUNCTION, vector, real, vector, vector, real, real, real, real, real, GAIN, GAIN
)
ZONE = record(Zone, vector, vector, vector, real, real)
SLIP = record(Slip, real, real, real, real, ZONE, ZONE)


# ---------------------------------------------------------------- what slip leaves


@kernel(real(vector))
def sense_of(cycle: Any) -> Any:
    """Where a cycle is seen from: -1 from behind."""
    return -1.0 if cycle[5] < 0 else 1.0


@kernel(vector(vector))
def seen(cycle: Any) -> Any:
    """The cycle seen so that dsigma >= 0."""
    if not cycle[5] < 0:
        return cycle
    behind = cycle.copy()
    behind[0], behind[1], behind[2], behind[3] = cycle[1], cycle[0], cycle[3], cycle[2]
    behind[5] = -cycle[5]
    return behind


@kernel(GAIN())
def no_gain() -> Any:
    """Of a place that has slipped all the time."""
    return Gain(Table(-math.inf, -math.inf, 0.0, np.zeros(1)), 0.0)


@kernel(FRICTION(LAW, vector, vector, real, real, real))
def friction(law: Any, own: Any, cycle: Any, sense: float, kappa: float, also: float) -> Any:
    """Of a cycle as seen.  also: one more place where integrals are cut."""
    a, c = min(cycle[0], cycle[2]), min(cycle[1], cycle[3])
    da, dc = max(cycle[0], cycle[2]) - a, max(cycle[1], cycle[3]) - c
    breaks, nothing = law.breaks(own), no_gain()
    cuts = np.full(breaks.size + 1, also)
    for i in range(breaks.size):
        cuts[i] = sense * breaks[i]
    return Friction(law.pressure, own, sense, cycle, cuts, a, c, da, dc, kappa, nothing, nothing)


@kernel(real(FRICTION, whole, real))
def pressure_at(of: Any, end: int, x: float) -> Any:
    """p at the first contact, end = 0, or the second, 2; zero at a corner, where it is infinite."""
    a, c = of.cycle[end], of.cycle[end + 1]
    p = of.pressure(x, a, c, of.own) if of.sense > 0 else of.pressure(-x, c, a, of.own)
    return p if p < math.inf else 0.0


@kernel(vector(FRICTION, vector))
def rubbed(of: Any, places: Any) -> Any:
    """f (p1 + p2); a corner's infinite pressure counts as none."""
    pressure, own, sense = of.pressure, of.own, of.sense
    alike = of.cycle[0] == of.cycle[2] and of.cycle[1] == of.cycle[3]
    found, f = np.zeros(places.size), of.cycle[6] * (2 if alike else 1)
    for end in range(0, 2 if alike else 4, 2):
        a, c = of.cycle[end], of.cycle[end + 1]
        if sense < 0:
            a, c = c, a
        for i in range(places.size):
            p = pressure(sense * places[i], a, c, own)
            if p < math.inf:
                found[i] += f * p
    return found


@kernel(vector(FRICTION, GAIN, vector))
def lacking(of: Any, gain: Any, places: Any) -> Any:
    """f (p1 + p2) less a gain."""
    found, end = rubbed(of, places), gain.table.end
    if end == -math.inf:
        return found
    for i in range(places.size):
        if places[i] < end:
            found[i] -= tabled(gain.table, places[i])
        elif gain.rubs > 0:
            found[i] = 0.0
    return found


@kernel(ZONE(FRICTION, real, real, real, whole))
def slip_zone(of: Any, side: float, start: float, slip: float, level: int) -> Any:
    """The slip zone on one side, from m or n on, so long in the smaller contact."""
    beyond, kappa, gain = of.da, 1.0, of.left
    if side > 0:
        beyond, kappa, gain = of.dc, of.kappa, of.right
    nodes = slip_nodes(of.cuts, side, start, slip, slip + beyond, level)
    count = nodes.shape[1]
    places = np.full(count + 1, side * start)
    for i in range(count):
        places[i] = side * (start + nodes[0, i])
    r = kappa * lacking(of, gain, places)
    return Zone(nodes[0], nodes[1], r[:-1], slip + beyond, r[-1])


@kernel(SLIP(FRICTION, real, real, real, real, whole))
def beside(of: Any, m: float, n: float, left: float, right: float, level: int) -> Any:
    """The slip zones beside [-m, n]; left, right: their lengths, a - m and c - n."""
    at_left = slip_zone(of, -1.0, m, left, level)
    return Slip(m, n, left, right, at_left, slip_zone(of, 1.0, n, right, level))


@kernel(SLIP(real))
def unknown(why: float) -> Any:
    """NaN where slip zones are not found, -inf where there are none of the kind asked for."""
    nothing = np.empty(0)
    zone = Zone(nothing, nothing, nothing, 0.0, 0.0)
    return Slip(why, why, -why, -why, zone, zone)


@kernel(real(ZONE, real, real))
def felt(zone: Any, away: float, across: float) -> Any:
    """dq by one slip zone at a place in the stick zone, so far from this end and the other one."""
    if not zone.length > 0:
        return 0.0
    total, stuck, length = 0.0, away + across, zone.length
    for i in range(zone.y.size):
        y = zone.y[i]
        singular = math.sqrt(y * (y + stuck)) * (y + away)
        total += zone.weight[i] * (zone.r[i] - zone.at_start) / singular
    angle = math.atan2(math.sqrt(length * across), math.sqrt(away * (length + stuck)))
    return (math.sqrt(away * across) * total + 2 * zone.at_start * angle) / math.pi


@kernel(real(SLIP, real))
def change(slip: Any, x: float) -> Any:
    """dq at x in the stick zone; where rounding puts x past its ends, dq there."""
    from_left, from_right = max(x + slip.m, 0.0), max(slip.n - x, 0.0)
    return felt(slip.left, from_left, from_right) + felt(slip.right, from_right, from_left)


# ---------------------------------------------------------------- both conditions


@kernel(results(2)(real, real, real))
def pulls(dQ: float, dsigma: float, stuck: float) -> Any:
    """By how much shear and tension drive slip at both ends of what is stuck, its width given."""
    by_tension = math.pi * stuck * dsigma / 8
    return dQ + by_tension, dQ - by_tension


@kernel(results(4)(ZONE, real))
def _integrals(zone: Any, stuck: float) -> Any:
    """int r/u, int r u, C and D of the text above over one slip zone."""
    near = far = finite = beyond = 0.0
    if not zone.length > 0:
        return near, far, finite, beyond
    at_start = zone.at_start / math.sqrt(stuck)
    finite = -2 * at_start / math.sqrt(zone.length)
    for i in range(zone.y.size):
        y, weight = zone.y[i], zone.weight[i]
        across = stuck + y
        force = weight * zone.r[i] / math.sqrt(y * across)
        near += force * across
        far += force * y
        beyond += force / across
        if y > NEAREST * zone.length:
            finite += (force - weight * at_start / math.sqrt(y)) / y
    return near, far, finite, beyond


@kernel(results(4)(SLIP))
def sums(slip: Any) -> Any:
    """L and R, and how fast L falls with m and R with n, twice, as far as F does not tell."""
    stuck = slip.m + slip.n
    near_left, far_left, C_left, D_left = _integrals(slip.left, stuck)
    near_right, far_right, C_right, D_right = _integrals(slip.right, stuck)
    by_m, by_n = stuck * (C_left + D_right), stuck * (C_right + D_left)
    return near_left + far_right, far_left + near_right, by_m, by_n


@kernel(results(3)(FRICTION, SLIP))
def _step(of: Any, slip: Any) -> Any:
    """Newton's step in the logarithms of both slip zones over the stick zone, and the miss."""
    stuck = slip.m + slip.n
    L, R, by_m, by_n = sums(slip)
    pull_left, pull_right = pulls(of.cycle[4], of.cycle[5], stuck)
    off_left, off_right = L - pull_left, R - pull_right
    skew = (off_right - off_left) / (2 * stuck)
    left = off_left, skew - by_m / 2, skew
    right = off_right, -skew, -skew - by_n / 2
    by_left, by_right = log_step(slip.d_left, slip.d_right, left, right, stuck)
    return by_left, by_right, off_left * off_left + off_right * off_right


@kernel(SLIP(FRICTION, real, real, whole))
def solved(of: Any, left: float, right: float, level: int) -> Any:
    """Slip zones that meet both conditions, from a guess; NaN where Newton's method does not end.

    If a step leads away from the solution, a quarter of it is tried.  The zones' nodes are those of
    the last step but one.
    """
    width, small = of.a + of.c, ROUGH if level == 0 else SMALL
    least = LEAST_STUCK * 8 * of.cycle[4] / math.pi
    part, best, to_left, to_right = 1.0, math.inf, 0.0, 0.0
    for _ in range(STEPS):
        now_left, now_right = moved(width, left, right, part * to_left, part * to_right)
        stuck = width - now_left - now_right
        if not (now_left > 0 and now_right > 0 and stuck * of.cycle[5] > least):
            break
        slip = beside(of, of.a - now_left, of.c - now_right, now_left, now_right, level)
        by_left, by_right, miss = _step(of, slip)
        length = max(abs(by_left), abs(by_right))
        if miss < best and length < math.inf:
            left, right, best, part = now_left, now_right, miss, 1.0
            shrink = LONGEST / max(LONGEST, length)
            to_left, to_right = by_left * shrink, by_right * shrink
            rounding = 16 * EPS * width / min(left, right, stuck)
            if length < max(small, rounding):
                if (
                    rounding < small
                    and miss > (MET * pulls(of.cycle[4], of.cycle[5], stuck)[0]) ** 2
                ):
                    break
                left, right = moved(width, left, right, to_left, to_right)
                return Slip(of.a - left, of.c - right, left, right, slip.left, slip.right)
        else:
            part /= 4
            if part < SHORTEST or best == math.inf:
                break
    return unknown(math.nan)


@kernel(SLIP(FRICTION, real, real, whole))
def placed(of: Any, stuck: float, n: float, level: int) -> Any:
    """Slip zones that leave a stick zone of this width as the loads go on in proportion.

    Both conditions ask for L and R in the proportion of what drives them; that difference grows
    with n all the way.  Slip must be driven on to opposite sides, or not at all on the right.
    n: where to look first.
    """
    least, most, close = stuck - of.a, of.c, CLOSE * stuck
    if not least < n < most:
        n = (least + most) / 2
    bracket = (least, most, n, most - least)
    pull_left, pull_right = pulls(of.cycle[4], of.cycle[5], stuck)
    for _ in range(2 * STEPS):
        n = bracket[2]
        slip = beside(of, stuck - n, n, n - least, most - n, level)
        L, R, by_m, by_n = sums(slip)
        value, rate = pull_left * R - pull_right * L, (pull_left * by_n + pull_right * by_m) / 2
        bracket = narrowed(bracket, value, rate, close)
        if bracket[1] - bracket[0] <= 2 * close:
            return slip
    return unknown(math.nan)


@kernel(real(FRICTION, SLIP))
def share(of: Any, slip: Any) -> Any:
    """The part of the loads that leaves such slip zones."""
    L, R, _, _ = sums(slip)
    return 4 * (L - R) / (math.pi * (slip.m + slip.n) * of.cycle[5])
