r"""Slip zones next to a stick zone at both ends of which the shear traction stays bounded.

All cycles have dsigma >= 0, so that tension loads the left edge more; for dsigma < 0 the mirror
image, x -> -x, is considered.  Slip leaves a change in shear r in both slip zones: on the left r =
f (p1 + p2), and on the right r = kappa f (p1 + p2) minus the shear gained there since that zone
last stuck (mixed.py).  Let h_s = m + n and let y be the distance from the stick zone.  With u =
sqrt(y/(h_s + y)), the change in shear is bounded at both ends of [-m, n] if

    left:   L = int_left r/u dy + int_right r u dy = dQ + pi h_s dsigma/8,
    right:  R = int_left r u dy + int_right r/u dy = dQ - pi h_s dsigma/8.

Let C be the finite part of int r/(y w) dy, w = sqrt(y (h_s + y)), let D = int r/((h_s + y) w) dy,
and let F be the residual of the right condition less that of the left one, divided by h_s.  The
rates of the residuals are

    d right/dn =  F/2 + h_s (C_right + D_left)/2,    d right/dm =  F/2,
    d left/dn  = -F/2,                               d left/dm  = -F/2 + h_s (C_left + D_right)/2.

In the stick zone, at distances d and D from this end and the other one, a slip zone of length l
causes

    dq = (sqrt(d D)/pi) int r/(w (y + d)) dy;

for a constant r this is (2 r/pi) arctan sqrt(l D/(d (l + h_s))), so that r at the start of the zone
is subtracted and integrated exactly.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..elementary import EPS
from ..kernels import kernel
from ..search import between, narrowed
from .newton import log_step, moved
from .quadrature import slip_nodes
from .tables import Table, tabled

SMALL = 1e-9
"""Newton's method ends after a step below this, relative to the slip zone, because the next step is
below rounding."""

ROUGH = 1e-7
"""The same for the coarsest rule, whose own error is larger."""

STEPS = 40
"""Largest number of Newton steps for one rule; a solution takes two to eight."""

MET = 1e-7
"""Largest residual of a solution, relative to the drive: at a break, steps may also become small
without reaching a solution."""

LONGEST = 2.0
"""Longest Newton step in the logarithm of a slip zone over the stick zone."""

SHORTEST = 1e-3
"""The method is given up if even this fraction of a step leads away from the solution."""

LEAST_STUCK = 1e-3
"""Narrowest stick zone that is sought, relative to the width at which slip would reverse."""

NEAREST = 1e-9
"""Finite parts omit nodes that are closer to the stick zone than this fraction of a slip zone."""


class Gain(NamedTuple):
    """Shear traction gained since a point began to stick again.

    table  the gain as a function of position
    rubs   1 if the points beyond the table are at the friction limit, where the gain is r; else 0
    """

    table: Any
    rubs: float


class Friction(NamedTuple):
    """The data that determine r, the traction left by slip.

    pressure, own  of the body itself; x there is `sense` times x here
    sense          1, or -1 for the mirror image
    cycle          a1, c1, a2, c2, dQ, dsigma, f, as returned by `oriented`
    cuts           points where r changes its formula
    a, c           edges of the smaller contact, to which slip zones extend
    da, dc         how much further out the edges of the larger contact are
    kappa          direction of slip on the right
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
    """A slip zone: its nodes y, their weights, r at the nodes, its length, and r at its start."""

    y: Any
    weight: Any
    r: Any
    length: float
    at_start: float


class Slip(NamedTuple):
    """A stick zone [-m, n], the lengths of slip in the smaller contact, and both slip zones."""

    m: float
    n: float
    d_left: float
    d_right: float
    left: Any
    right: Any


# ---------------------------------------------------------------- the traction left by slip


@kernel
def sense_of(cycle: Any) -> Any:
    """1, or -1 if `oriented` returns the mirror image of a cycle."""
    return -1.0 if cycle[5] < 0 else 1.0


@kernel
def oriented(cycle: Any) -> Any:
    """The cycle or, if dsigma < 0, its mirror image, in which dsigma > 0."""
    if not cycle[5] < 0:
        return cycle
    mirrored = cycle.copy()
    mirrored[0], mirrored[1], mirrored[2], mirrored[3] = cycle[1], cycle[0], cycle[3], cycle[2]
    mirrored[5] = -cycle[5]
    return mirrored


@kernel
def no_gain() -> Any:
    """The gain where points have slipped all the time."""
    return Gain(Table(-math.inf, -math.inf, 0.0, np.zeros(1)), 0.0)


@kernel
def friction(law: Any, own: Any, cycle: Any, sense: float, kappa: float, also: float) -> Any:
    """The friction of a cycle with dsigma >= 0.

    also: one more point at which integrals are split.
    """
    a, c = min(cycle[0], cycle[2]), min(cycle[1], cycle[3])
    da, dc = max(cycle[0], cycle[2]) - a, max(cycle[1], cycle[3]) - c
    breaks, nothing = law.breaks(own), no_gain()
    cuts = np.full(breaks.size + 1, also)
    for i in range(breaks.size):
        cuts[i] = sense * breaks[i]
    return Friction(law.pressure, own, sense, cycle, cuts, a, c, da, dc, kappa, nothing, nothing)


@kernel
def pressure_at(of: Any, end: int, x: float) -> Any:
    """p in the first (end = 0) or second (end = 2) contact; a corner's infinite p counts as 0."""
    a, c = of.cycle[end], of.cycle[end + 1]
    p = of.pressure(x, a, c, of.own) if of.sense > 0 else of.pressure(-x, c, a, of.own)
    return p if p < math.inf else 0.0


@kernel
def friction_limits(of: Any, places: Any) -> Any:
    """f (p1 + p2) at the given points; the infinite pressure of a corner counts as zero."""
    pressure, own, sense = of.pressure, of.own, of.sense
    alike = of.cycle[0] == of.cycle[2] and of.cycle[1] == of.cycle[3]
    limits, f = np.zeros(places.size), of.cycle[6] * (2 if alike else 1)
    for end in range(0, 2 if alike else 4, 2):
        a, c = of.cycle[end], of.cycle[end + 1]
        if sense < 0:
            a, c = c, a
        for i in range(places.size):
            p = pressure(sense * places[i], a, c, own)
            if p < math.inf:
                limits[i] += f * p
    return limits


@kernel
def remaining_friction(of: Any, gain: Any, places: Any) -> Any:
    """f (p1 + p2) less a gain, at the given points."""
    remaining, end = friction_limits(of, places), gain.table.end
    if end == -math.inf:
        return remaining
    for i in range(places.size):
        if places[i] < end:
            remaining[i] -= tabled(gain.table, places[i])
        elif gain.rubs > 0:
            remaining[i] = 0.0
    return remaining


@kernel
def slip_zone(of: Any, side: float, start: float, slip: float, level: int) -> Any:
    """The slip zone on one side, from m or n outward, with length `slip` in the smaller contact."""
    beyond, kappa, gain = of.da, 1.0, of.left
    if side > 0:
        beyond, kappa, gain = of.dc, of.kappa, of.right
    nodes = slip_nodes(of.cuts, side, start, slip, slip + beyond, level)
    count = nodes.shape[1]
    places = np.full(count + 1, side * start)
    for i in range(count):
        places[i] = side * (start + nodes[0, i])
    r = kappa * remaining_friction(of, gain, places)
    return Zone(nodes[0], nodes[1], r[:-1], slip + beyond, r[-1])


@kernel
def beside(of: Any, m: float, n: float, left: float, right: float, level: int) -> Any:
    """The slip zones beside [-m, n], with lengths left = a - m and right = c - n."""
    at_left = slip_zone(of, -1.0, m, left, level)
    return Slip(m, n, left, right, at_left, slip_zone(of, 1.0, n, right, level))


@kernel
def unknown(why: float) -> Any:
    """NaN if slip zones are not found, -inf if there are none of the kind sought."""
    nothing = np.empty(0)
    zone = Zone(nothing, nothing, nothing, 0.0, 0.0)
    return Slip(why, why, -why, -why, zone, zone)


@kernel
def change_by_zone(zone: Any, near: float, far: float) -> Any:
    """dq due to one slip zone, at given distances from this end of the stick zone and the other."""
    if not zone.length > 0:
        return 0.0
    total, stuck, length = 0.0, near + far, zone.length
    for i in range(zone.y.size):
        y = zone.y[i]
        singular = math.sqrt(y * (y + stuck)) * (y + near)
        total += zone.weight[i] * (zone.r[i] - zone.at_start) / singular
    angle = math.atan2(math.sqrt(length * far), math.sqrt(near * (length + stuck)))
    return (math.sqrt(near * far) * total + 2 * zone.at_start * angle) / math.pi


@kernel
def change(slip: Any, x: float) -> Any:
    """dq at x in the stick zone; if rounding puts x outside the stick zone, dq at its end."""
    from_left, from_right = max(x + slip.m, 0.0), max(slip.n - x, 0.0)
    return change_by_zone(slip.left, from_left, from_right) + change_by_zone(
        slip.right, from_right, from_left
    )


# ---------------------------------------------------------------- both conditions


@kernel
def drives(dQ: float, dsigma: float, stuck: float) -> Any:
    """The drive of slip by shear and tension at both ends of a stick zone of given width."""
    by_tension = math.pi * stuck * dsigma / 8
    return dQ + by_tension, dQ - by_tension


@kernel
def turning_width(cycle: Any) -> float:
    """H = 8 dQ/(pi dsigma), the width of a stick zone whose right end is not driven."""
    return float(8 * cycle[4] / (math.pi * cycle[5]))


@kernel
def _integrals(zone: Any, stuck: float) -> Any:
    """int r/u, int r u, C and D of the module's docstring over one slip zone."""
    near = far = finite = beyond = 0.0
    if not zone.length > 0:
        return near, far, finite, beyond
    at_start = zone.at_start / math.sqrt(stuck)
    finite = -2 * at_start / math.sqrt(zone.length)
    for i in range(zone.y.size):
        y, weight = zone.y[i], zone.weight[i]
        from_other_end = stuck + y
        force = weight * zone.r[i] / math.sqrt(y * from_other_end)
        near += force * from_other_end
        far += force * y
        beyond += force / from_other_end
        if y > NEAREST * zone.length:
            finite += (force - weight * at_start / math.sqrt(y)) / y
    return near, far, finite, beyond


@kernel
def sums(slip: Any) -> Any:
    """L and R, and twice the derivatives dL/dm and dR/dn, without the terms in F."""
    stuck = slip.m + slip.n
    near_left, far_left, C_left, D_left = _integrals(slip.left, stuck)
    near_right, far_right, C_right, D_right = _integrals(slip.right, stuck)
    by_m, by_n = stuck * (C_left + D_right), stuck * (C_right + D_left)
    return near_left + far_right, far_left + near_right, by_m, by_n


@kernel
def _step(of: Any, slip: Any) -> Any:
    """Newton's step in the logarithms of both slip zones over the stick zone; the squared error."""
    stuck = slip.m + slip.n
    L, R, by_m, by_n = sums(slip)
    drive_left, drive_right = drives(of.cycle[4], of.cycle[5], stuck)
    residual_left, residual_right = L - drive_left, R - drive_right
    skew = (residual_right - residual_left) / (2 * stuck)
    left = residual_left, skew - by_m / 2, skew
    right = residual_right, -skew, -skew - by_n / 2
    by_left, by_right = log_step(slip.d_left, slip.d_right, left, right, stuck)
    return by_left, by_right, residual_left * residual_left + residual_right * residual_right


@kernel
def solved(of: Any, left: float, right: float, level: int) -> Any:
    """Slip zones that meet both conditions, from a guess; NaN if Newton's method does not converge.

    If a step leads away from the solution, a quarter of it is tried.  The nodes of the zones are
    those before the last step.
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
        by_left, by_right, error = _step(of, slip)
        length = max(abs(by_left), abs(by_right))
        if error < best and length < math.inf:
            left, right, best, part = now_left, now_right, error, 1.0
            shrink = LONGEST / max(LONGEST, length)
            to_left, to_right = by_left * shrink, by_right * shrink
            rounding = 16 * EPS * width / min(left, right, stuck)
            if length < max(small, rounding):
                if (
                    rounding < small
                    and error > (MET * drives(of.cycle[4], of.cycle[5], stuck)[0]) ** 2
                ):
                    break
                left, right = moved(width, left, right, to_left, to_right)
                return Slip(of.a - left, of.c - right, left, right, slip.left, slip.right)
        else:
            part /= 4
            if part < SHORTEST or best == math.inf:
                break
    return unknown(math.nan)


@kernel
def placed(of: Any, stuck: float, n: float, level: int) -> Any:
    """Slip zones that leave a stick zone of given width as the loads grow in proportion.

    Both conditions require L and R in the ratio of the drives; the deviation from this ratio grows
    monotonically with n.  Slip must be driven in opposite directions, or not at all on the right.
    n: the first guess.
    """
    least, most = stuck - of.a, of.c
    search = between(least, most, n, 2 * stuck)
    drive_left, drive_right = drives(of.cycle[4], of.cycle[5], stuck)
    for _ in range(2 * STEPS):
        n = search.y
        slip = beside(of, stuck - n, n, n - least, most - n, level)
        L, R, by_m, by_n = sums(slip)
        value, rate = drive_left * R - drive_right * L, (drive_left * by_n + drive_right * by_m) / 2
        search = narrowed(search, value, rate)
        if search.step == 0:
            return slip
    return unknown(math.nan)


@kernel
def share(of: Any, slip: Any) -> Any:
    """The fraction of the loads that produces these slip zones."""
    L, R, _, _ = sums(slip)
    return 4 * (L - R) / (math.pi * (slip.m + slip.n) * of.cycle[5])
