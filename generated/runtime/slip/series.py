r"""Slip zones by series in their length divided by the width of the stick zone, to two orders.

At a distance s from an edge p = K s**(1/2) + L s**(3/2) + ...  Let h_s be the width of the stick
zone.  In the conditions for a bounded change in shear (derive/theory/slip.py), a slip zone of
length d contributes

    near = int_0^d p sqrt((h_s + d - s)/(d - s)) ds
         = pi sqrt(h_s) d (K/2 + K d/(16 h_s) + 3 L d/8 + ...)
    far  = int_0^d p sqrt((d - s)/(h_s + d - s)) ds = pi d**2/sqrt(h_s) (K/8 + ...)

at its own end of the stick zone and at the other end.  Let kappa = +1 or -1 be the direction of
slip at an edge.  With sums over the contacts at both ends of the half-cycle, the conditions are

    left    sum f (kappa_left near_left + kappa_right far_right) = dQ + pi h_s dsigma/8
    right   sum f (kappa_right near_right + kappa_left far_left) = dQ - pi h_s dsigma/8.

The second order keeps d and d**2, and is solved without further approximation.  The first order
takes the width of the contact as that of the stick zone: d = |K_T|/(f K) + da/2.
"""

import math
from typing import Any, NamedTuple

from ..elementary import EPS
from ..kernels import kernel, loop, opened
from .cycles import Cycle, drives
from .newton import MAX_STEPS, log_step, moved


class Edge(NamedTuple):
    """One edge in a half-cycle.

    K, L      p = K s**(1/2) + L s**(3/2) in the contact now
    K_2, L_2  the same at the other end of the half-cycle
    kappa     direction of slip, times f
    gain      how much further out the edge is now than at the other end
    drive     pi sqrt(h) K_T, h the width of the contact now
    """

    K: float
    L: float
    K_2: float
    L_2: float
    kappa: float
    gain: float
    drive: float


@kernel
def _contributions(edge: Any, d: float, stuck: float) -> Any:
    """near and far of both contacts, each with its derivatives with respect to d and h_s.

    d: the slip zone in the contact that extends less far.
    """
    root = math.pi * math.sqrt(stuck)
    near = near_by_d = near_by_stuck = far = far_by_d = far_by_stuck = 0.0
    for end in range(2):
        K, L, y = edge.K, edge.L, d + max(edge.gain, 0.0)
        if end == 1:
            K, L, y = edge.K_2, edge.L_2, d + max(-edge.gain, 0.0)
        across = root * K * y / (8 * stuck)
        near += root * y * (K / 2 + 3 * L * y / 8) + across * y / 2
        near_by_d += root * (K / 2 + 3 * L * y / 4) + across
        near_by_stuck += (root * y * (K / 2 + 3 * L * y / 8) - across * y / 2) / (2 * stuck)
        far += across * y
        far_by_d += 2 * across
        far_by_stuck -= across * y / (2 * stuck)
    return (near, near_by_d, near_by_stuck), (far, far_by_d, far_by_stuck)


@kernel
def _step(at_left: Any, at_right: Any, h: float, left: float, right: float) -> Any:
    """The Newton step in the logarithms of both slip zones over the stick zone."""
    stuck = h - left - right
    near, far = _contributions(at_left, left, stuck)
    near_2, far_2 = _contributions(at_right, right, stuck)
    # K_T of both edges give dQ and pi dsigma/8 times the width of the contact
    dQ, by_width = (at_left.drive + at_right.drive) / 2, (at_left.drive - at_right.drive) / 2
    tension = by_width / (h + max(at_left.gain, 0.0) + max(at_right.gain, 0.0))
    kappa, kappa_2 = at_left.kappa, at_right.kappa
    # residuals of the conditions, and their derivatives with respect to h_s = h - left - right
    off = kappa * near[0] + kappa_2 * far_2[0] - dQ - tension * stuck
    off_2 = kappa_2 * near_2[0] + kappa * far[0] - dQ + tension * stuck
    widens = kappa * near[2] + kappa_2 * far_2[2] - tension
    widens_2 = kappa_2 * near_2[2] + kappa * far[2] + tension
    one = off, kappa * near[1] - widens, kappa_2 * far_2[1] - widens
    other = off_2, kappa * far[1] - widens_2, kappa_2 * near_2[1] - widens_2
    return log_step(left, right, one, other, stuck)


@kernel
def _second_order(at_left: Any, at_right: Any, h: float, left: float, right: float) -> Any:
    """Both conditions solved by Newton's method, from zones of the first order.

    h: width of the intersection of the two contacts, in which the slip zones are measured.
    """
    longest = max(left, right, abs(at_left.gain), abs(at_right.gain))
    if longest == 0:
        return 0.0, 0.0
    left, right = max(left, 1e-14 * longest), max(right, 1e-14 * longest)
    shrink = h / (h + left + right)
    left, right = shrink * left, shrink * right
    for _ in range(MAX_STEPS):
        if not (h - left - right > 0 and left > 0 and right > 0):
            break
        by_left, by_right = _step(at_left, at_right, h, left, right)
        length = max(abs(by_left), abs(by_right))
        if not length < math.inf:
            break
        part = min(1.0, 1.0 / length) if length > 0 else 1.0
        left, right = moved(h, left, right, part * by_left, part * by_right)
        rounding = 64 * EPS * max(left, right, abs(at_left.gain), abs(at_right.gain))
        # the next step would be the square of this one
        if length * min(left, right) <= max(math.sqrt(EPS) * min(left, right), rounding):
            return left, right
    return math.nan, math.nan


@kernel
def _zones(at_left: Any, at_right: Any, h: float, order: int) -> Any:
    """Slip zones to an order in a contact of width h.

    NaN unless slip occurs at both edges of both contacts and part of the contact sticks.  If no
    part sticks to the first order, the series is of no use at the second.
    """
    gain, gain_2 = max(at_left.gain, 0.0), max(at_right.gain, 0.0)
    # in the smaller contact: |K_T|/(f K_N) less half of the movement of the edge
    scale = math.pi * math.sqrt(h)
    left = at_left.drive / (scale * at_left.kappa * at_left.K) - abs(at_left.gain) / 2
    right = at_right.drive / (scale * at_right.kappa * at_right.K) - abs(at_right.gain) / 2
    if order > 1 and left + right + gain + gain_2 < h:
        left, right = _second_order(at_left, at_right, h - gain - gain_2, left, right)
    left, right = left + gain, right + gain_2
    if left >= gain and right >= gain_2 and left + right < h:
        return left, right
    return math.nan, math.nan


@loop
def each_slip_zones(law: Any, given: Any, own: Any, out: Any) -> None:
    """a, c, dQ, dsigma, da, dc, f, E* -> slip zones to the first and to the second order.

    The other contact of the half-cycle is [-(a - da), c - dc].
    """
    law = opened(law)
    for i in range(given.shape[0]):
        row, body = given[i], own[i]
        a, c, da, dc, f = row[0], row[1], row[4], row[5], row[6]
        cycle = Cycle(a, c, a - da, c - dc, row[2] / row[7], row[3] / row[7], f)
        dQ, dsigma, h = cycle.dQ, cycle.dsigma, a + c
        load, _, _, K, K_right = law.state(a, c, body)
        load_2, _, _, K_2, K_right_2 = law.state(cycle.a_2, cycle.c_2, body)
        out[i, :] = math.nan
        if not (0 <= dQ < f * (load + load_2) and math.isfinite(dsigma) and K > 0 and K_right > 0):
            continue
        L, L_right = law.series(a, c, body)
        L_2, L_right_2 = law.series(cycle.a_2, cycle.c_2, body)
        drive, drive_2 = drives(cycle, h)
        kappa, kappa_2 = -f if drive < 0 else f, -f if drive_2 < 0 else f
        at_left = Edge(K, L, K_2, L_2, kappa, da, drive)
        at_right = Edge(K_right, L_right, K_right_2, L_right_2, kappa_2, dc, drive_2)
        out[i, 0], out[i, 1] = _zones(at_left, at_right, h, 1)
        out[i, 2], out[i, 3] = _zones(at_left, at_right, h, 2)
