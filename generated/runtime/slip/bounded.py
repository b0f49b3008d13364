r"""The stick zone between two slip zones in which slip grows in given directions.

Let kappa be the direction of slip on the left, +1 or -1, and lamda that on the right.  The change
in shear is kappa r and lamda r in the slip zones (quadrature.py), and bounded at both ends of the
stick zone.  If both directions are forward, it is f (p_1 + p_2 - 2 p_s), and the stick zone is the
contact, with the pressure p_s, at the mean load less dQ/(2 f) and the mean tilt less dsigma/(4 f).

In general, let h_s = m + n, let y be the distance from the stick zone and u = sqrt(y/(h_s + y)).
The change is bounded at both ends if

    left:   L = kappa int_left r/u dy + lamda int_right r u dy = dQ + pi h_s dsigma/8,
    right:  R = kappa int_left r u dy + lamda int_right r/u dy = dQ - pi h_s dsigma/8.

Let C be the finite part of int r/(y w) dy, w = sqrt(y (h_s + y)), let D = int r/((h_s + y) w) dy,
and let F be the residual of the right condition less that of the left one, divided by h_s.  Then

    d right/dn =  F/2 + h_s (lamda C_right + kappa D_left)/2,    d right/dm =  F/2,
    d left/dm  = -F/2 + h_s (kappa C_left + lamda D_right)/2,    d left/dn  = -F/2.

Newton's method starts from the leading order of both slip zones.  It fails beside kinks, where the
width of the stick zone is then sought in a bracket: a wider stick zone corresponds to a smaller
part of the loads.  No zone between slip in opposite directions is narrower than the width
H = 8 dQ/(pi |dsigma|) at which slip reverses on one side.  If a zone of that width takes less than
the given loads, slip has reversed.

In the stick zone, at distances d and D from this end and the other one, a slip zone of length l
changes the shear traction by

    dq = (sqrt(d D)/pi) int r/(w (y + d)) dy;

for a constant r this is (2 r/pi) arctan sqrt(l D/(d (l + h_s))), so that r at the start of the zone
is subtracted and integrated exactly.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..elementary import EPS
from ..inverse import contact_at_tilt
from ..kernels import kernel, shared
from ..search import between, narrowed
from ..types import Array, Regime
from .cycles import drives, turning_width
from .newton import MAX_STEPS, log_step, moved
from .quadrature import RULES, slip_zone

NEWTON_RTOL = 1e-4
"""Newton's method ends after a step below this: the next one would be its square.  It has failed if
even this fraction of a step does not reduce the error."""

ROUGH_RTOL, RULE_RTOL = 1e-7, 2e-10
"""Slip zones whose relative change from one rule to the next is below this are exact by the finer
rule, which takes one step of about this length.  The first number serves where no singularities are
close to each other, because the error of a rule is then the square of that of the rule before."""

ZONE_RTOL = 1e-9
"""Ends of stick zones that differ by less than this part of the contact width may be equal; no
narrower stick zone is sought."""

MIN_GAP = 0.05
"""Singularities of r that are closer to each other than this part of a slip zone are close."""

NEAREST = 1e-9
"""Finite parts omit nodes that are closer to the stick zone than this part of a slip zone."""


class Slipping(NamedTuple):
    """A half-cycle whose edges slip in given directions.

    kappa, lamda  directions of slip on the left and on the right, +1 or -1
    a, c          edges of the smaller contact, to which slip zones extend
    """

    cycle: Any
    kappa: float
    lamda: float
    a: float
    c: float


@kernel
def slipping(cycle: Any, kappa: float, lamda: float) -> Slipping:
    """A half-cycle with directions of slip."""
    return Slipping(cycle, kappa, lamda, min(cycle.a_1, cycle.a_2), min(cycle.c_1, cycle.c_2))


@kernel
def slipping_in(cycle: Any, regime: float) -> Slipping:
    """A half-cycle of a known regime: both edges slip forward unless its code is that of LARGE."""
    if regime != Regime.LARGE.value:
        return slipping(cycle, 1.0, 1.0)
    kappa = math.copysign(1.0, cycle.dsigma)
    return slipping(cycle, kappa, -kappa)


@shared
def _integrals(zone: Any, stuck: float) -> Any:
    """int r/u, int r u, C and D of the module's docstring over one slip zone."""
    near = far = beyond = 0.0
    first = zone.at_start / math.sqrt(stuck)
    finite = -2 * first / math.sqrt(zone.length)
    for i in range(zone.y.size):
        y, weight = zone.y[i], zone.weight[i]
        from_other_end = stuck + y
        inverse = 1 / (y * from_other_end)
        force = weight * zone.r[i] * math.sqrt(inverse)
        near += force * from_other_end
        far += force * y
        beyond += force * y * inverse
        if y > NEAREST * zone.length:
            inverse *= from_other_end
            finite += (force - weight * first * math.sqrt(inverse)) * inverse
    return near, far, finite, beyond


@shared
def both_zones(body: Any, of: Any, left: float, right: float) -> Any:
    """Slip zones on both sides.

    body: its law, its parameters, and the number of the quadrature rule
    left, right: their lengths in the smaller contact
    """
    law, own, rule = body
    on_left = slip_zone(law, own, of.cycle, -1.0, left, math.nan, rule)
    return on_left, slip_zone(law, own, of.cycle, 1.0, right, math.nan, rule)


@shared
def _sums(zones: Any, body: Any, of: Any, left: float, right: float) -> Any:
    """L and R of slip zones, and twice dL/dm and dR/dn without the terms in F."""
    stuck = of.a + of.c - left - right
    on_left, on_right = zones(body, of, left, right)
    near_left, far_left, C_left, D_left = _integrals(on_left, stuck)
    near_right, far_right, C_right, D_right = _integrals(on_right, stuck)
    return (
        of.kappa * near_left + of.lamda * far_right,
        of.kappa * far_left + of.lamda * near_right,
        stuck * (of.kappa * C_left + of.lamda * D_right),
        stuck * (of.lamda * C_right + of.kappa * D_left),
    )


@kernel
def _first_guess(of: Any, ends: Any) -> Any:
    """Slip zones K_T/(f K_N), reduced so that they leave a stick zone between them."""
    width, start, end = of.a + of.c, ends.start, ends.end
    drive_left, drive_right = drives(of.cycle, width)
    scale = math.pi * math.sqrt(width) * of.cycle.f / 2
    left = max(abs(drive_left) / (scale * (start.K_left + end.K_left)), EPS * width)
    right = max(abs(drive_right) / (scale * (start.K_right + end.K_right)), EPS * width)
    shrink = width / (width + left + right)
    return left * shrink, right * shrink


@shared
def newton(zones: Any, body: Any, of: Any, left: float, right: float) -> Any:
    """Slip zones by Newton's method from a guess; NaN if it does not find any.

    zones, body: a function that makes slip zones, and its first argument
    """
    width, best, part, by_left, by_right = of.a + of.c, math.inf, 1.0, 0.0, 0.0
    for _ in range(MAX_STEPS):
        next_left, next_right = moved(width, left, right, part * by_left, part * by_right)
        stuck = width - next_left - next_right
        error = math.inf
        if stuck > 0:  # rounding may leave nothing between long slip zones
            L, R, by_m, by_n = _sums(zones, body, of, next_left, next_right)
            drive_left, drive_right = drives(of.cycle, stuck)
            off_left, off_right = L - drive_left, R - drive_right
            error = off_left * off_left + off_right * off_right
        if not error < best:
            part /= 4
            if part < NEWTON_RTOL or best == math.inf:
                break
            continue
        left, right, best = next_left, next_right, error
        skew = (off_right - off_left) / (2 * stuck)
        at_left, at_right = (off_left, skew - by_m / 2, skew), (off_right, -skew, -skew - by_n / 2)
        by_left, by_right = log_step(left, right, at_left, at_right, stuck)
        rounding = 16 * EPS * width
        left_found = abs(by_left) < NEWTON_RTOL + rounding / min(left, stuck)
        if left_found and abs(by_right) < NEWTON_RTOL + rounding / min(right, stuck):
            return moved(width, left, right, by_left, by_right)
        part = 1 / max(1.0, abs(by_left), abs(by_right))  # a ratio changes by a factor of e at most
    return math.nan, math.nan


@shared
def placed(zones: Any, body: Any, of: Any, stuck: float, n: float) -> Any:
    """The right end of a stick zone of given width as the loads grow in proportion, and the part of
    the loads that it takes.

    Both conditions require L and R in the ratio of the drives; the deviation from this ratio grows
    with n.  Slip must be driven in opposite directions, or not at all on one side.
    n: the first guess; zones, body: as in `newton`.
    """
    search = between(stuck - of.a, of.c, n, 2 * stuck)
    drive_left, drive_right = drives(of.cycle, stuck)
    for _ in range(2 * MAX_STEPS):
        n = search.y
        L, R, by_m, by_n = _sums(zones, body, of, of.a - stuck + n, of.c - n)
        value, rate = drive_left * R - drive_right * L, (drive_left * by_n + drive_right * by_m) / 2
        search = narrowed(search, value, rate)
        if search.step == 0:
            return n, 4 * (L - R) / (math.pi * stuck * of.cycle.dsigma)
    return math.nan, math.nan


@kernel
def _bracketed(body: Any, of: Any) -> Any:
    """Slip zones by the width of the stick zone, and whether slip reverses on one side."""
    width = of.a + of.c
    stuck = max(turning_width(of.cycle.dQ, of.cycle.dsigma), ZONE_RTOL * width)
    if not stuck < width:
        return math.nan, math.nan, True
    n, part = placed(both_zones, body, of, stuck, math.nan)
    last, excess = stuck, 1 - part
    if excess > 0:
        return math.nan, math.nan, True
    search = between(stuck, width, math.nan, 2 * width)
    for _ in range(2 * MAX_STEPS):
        before, stuck = excess, search.y
        n, part = placed(both_zones, body, of, stuck, n)
        excess = 1 - part
        search = narrowed(search, excess, (excess - before) / (stuck - last))
        if search.step == 0:
            if abs(excess) < NEWTON_RTOL:
                return of.a - stuck + n, of.c - n, False
            break  # an edge is so close to a corner that rounding hides its slip zone
        last = stuck
    return math.nan, math.nan, False


@kernel
def _is_clear(law: Any, own: Any, cycle: Any, side: float, start: float) -> bool:
    """Whether the singularities of r in and beside a slip zone are not close to each other: breaks
    of the body, the edges of both contacts, and the start of the zone."""
    edge_1, edge_2 = (cycle.c_1, cycle.c_2) if side > 0 else (cycle.a_1, cycle.a_2)
    length, breaks = max(edge_1, edge_2) - start, law.breaks(own)
    gap = MIN_GAP * length
    for at in breaks:
        y = side * at - start
        if -gap < y < length + gap:
            if min(abs(y), abs(edge_1 - start - y), abs(edge_2 - start - y)) < gap:
                return False
            for other in breaks:
                if 0 < abs(other - at) < gap:
                    return False
    return True


@kernel
def _zone_between(law: Any, own: Any, of: Any, ends: Any, rtol: float) -> Any:
    """m and n between slip in opposite directions.

    The regime is LARGE, or UNSOLVED if they are not found, or MIXED if slip has reversed.
    rtol: the change from one rule to the next that is accepted where singularities are close.
    """
    rounding = 16 * EPS * (of.a + of.c)
    left, right = _first_guess(of, ends)
    for rule in range(RULES):
        last_left, last_right, reverses = left, right, False
        left, right = newton(both_zones, (law, own, rule), of, left, right)
        if not of.a + of.c - left - right > turning_width(of.cycle.dQ, of.cycle.dsigma):
            left, right, reverses = _bracketed((law, own, rule), of)
        if reverses:
            return math.nan, math.nan, Regime.MIXED
        m, n = of.a - left, of.c - right
        change_left = (abs(left - last_left) - rounding) / left
        change = max(change_left, (abs(right - last_right) - rounding) / right)
        if rule > 0 and change <= ROUGH_RTOL:
            clear = _is_clear(law, own, of.cycle, -1.0, m) and _is_clear(law, own, of.cycle, 1.0, n)
            if clear or change <= rtol:
                return m, n, Regime.LARGE
    return math.nan, math.nan, Regime.UNSOLVED


@kernel
def moderate_zone(law: Any, own: Any, cycle: Any, ends: Any) -> Any:
    """m and n between slip forward at both edges, and the regime; MIXED if nothing sticks."""
    load = (ends.start.load + ends.end.load - cycle.dQ / cycle.f) / 2
    tilt = (ends.start.tilt + ends.end.tilt - cycle.dsigma / (2 * cycle.f)) / 2
    m, n = contact_at_tilt(law, own, load, tilt)
    return m, n, Regime.MODERATE if m + n > 0 else Regime.MIXED


@kernel
def zone_of(law: Any, own: Any, of: Any, ends: Any, rtol: float) -> Any:
    """m and n while slip grows in given directions, and the regime, as in `_zone_between`."""
    if of.kappa == of.lamda:
        return moderate_zone(law, own, of.cycle, ends)
    return _zone_between(law, own, of, ends, rtol)


# ---------------------------------------------------------------- the shear in the stick zone


@shared
def _change_by(zone: Any, near: Array, far: Array) -> Array:
    """dq due to r in a slip zone, at given distances from this end of the stick zone and the other
    one."""
    total, stuck = 0.0 * near, near + far
    for i in range(zone.y.size):
        y = zone.y[i]
        singular = np.sqrt(y * (y + stuck)) * (y + near)
        total += zone.weight[i] * (zone.r[i] - zone.at_start) / singular
    angle = np.arctan2(np.sqrt(zone.length * far), np.sqrt(near * (zone.length + stuck)))
    return (np.sqrt(near * far) * total + 2 * zone.at_start * angle) / math.pi


@shared
def change_between(of: Any, zones: Any, m: float, n: float, x: Array) -> Array:
    """dq at x between two slip zones; where rounding puts x outside the stick zone, dq at its
    end."""
    from_left, from_right = np.maximum(x + m, 0.0), np.maximum(n - x, 0.0)
    by_left = _change_by(zones[0], from_left, from_right)
    return of.kappa * by_left + of.lamda * _change_by(zones[1], from_right, from_left)
