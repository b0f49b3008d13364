r"""Slip zones by series in their length divided by the width of the stick zone.

At a distance s from an edge p = K s**(1/2) + L s**(3/2) + N s**(5/2) + ...  Let h_s be the width of
the stick zone and e = d/h_s.  In the conditions for a bounded change in shear
(derive/theory/slip.py), a slip zone of length d contributes

    near = int_0^d p sqrt((h_s + d - s)/(d - s)) ds
         = pi sqrt(h_s) d (K (1/2 + e/16 - e**2/128) + L d (3/8 + e/32) + N d**2 5/16 + ...)
    far  = int_0^d p sqrt((d - s)/(h_s + d - s)) ds
         = pi d**2/sqrt(h_s) (K (1/8 - e/32) + L d/16 + ...)

at its own end of the stick zone and at the other end.  Let kappa = +1 or -1 be the direction of
slip at an edge.  With sums over the contacts at both ends of the half-cycle, the conditions are

    left    sum f (kappa_left near_left + kappa_right far_right) = dQ + pi h_s dsigma/8
    right   sum f (kappa_right near_right + kappa_left far_left) = dQ - pi h_s dsigma/8.

Order n keeps powers of d up to n.  Orders 2 and 3 are solved without further approximation.  The
first order takes the width of the contact as that of the stick zone: d = |K_T|/(f K) + da/2.
"""

import math
from typing import Any, NamedTuple

from ..kernels import LAW, LOOP, Law, kernel, opened, real, record, results, vector, whole
from ..types import Array
from .newton import log_step, moved

NEAR = ((1 / 2, 1 / 16, -1 / 128), (3 / 8, 1 / 32, 0.0), (5 / 16, 0.0, 0.0))
"""binomial(1/2, j) B(i + 3/2, j + 1/2)/pi, the factor of C_i d**(i + j + 1) h_s**(1/2 - j), C = K,
L, N."""

FAR = ((1 / 8, -1 / 32, 0.0), (1 / 16, 0.0, 0.0), (0.0, 0.0, 0.0))
"""binomial(-1/2, j) B(i + 3/2, j + 3/2)/pi, the factor of C_i d**(i + j + 2) h_s**(-1/2 - j)."""

STEPS = 40
"""Largest number of Newton steps; four to six are common."""

LONGEST = 1.0
"""Longest Newton step, in the logarithm of a slip zone over the stick zone."""

LEAST = 1e-14
"""Shortest initial slip zone, relative to the longer one or to the growth of the contact."""

SMALL = 1e-9
"""Newton's method ends after a step below this: the next one would be its square."""

ROUNDING = 64 * 2.0**-52
"""Rounding of a slip zone, relative to the longer one or to the growth of the contact."""


class Series(NamedTuple):
    """One half-cycle: loads/E*, and p = K s**(1/2) + L s**(3/2) + N s**(5/2) at each edge.

    h            width of the intersection of the two contacts
    left, right  K, L, N at the edges of the contact now; left_2, right_2 at the other end
    da, dc       how much further out the edges are now than at the other end
    kappa_left   direction of slip at the left edge, times f; kappa_right at the right one
    """

    h: Array
    dQ: Array
    dsigma: Array
    kappa_left: Array
    kappa_right: Array
    da: Array
    dc: Array
    left: Array
    right: Array
    left_2: Array
    right_2: Array


TERMS: Any = results(3)
SERIES: Any = record(Series, *(real,) * 7, *(TERMS,) * 4)


@kernel(TERMS(TERMS, real, real, whole, whole))
def _integral(pressure: Any, d: Array, stuck: Array, order: Array, shift: Array) -> Any:
    """near (shift 0) or far (shift 1), truncated; its derivatives with respect to d and h_s."""
    table = NEAR if shift == 0 else FAR
    value = by_d = by_stuck = 0.0
    for i in range(order - shift):
        for j in range(order - shift - i):
            rises, falls = i + j + shift, 0.5 - j - shift
            term = math.pi * table[i][j] * pressure[i] * math.sqrt(stuck) * d**rises
            term /= stuck ** (j + shift)
            value += term * d
            by_d += (rises + 1) * term
            by_stuck += falls * term * d / stuck
    return value, by_d, by_stuck


@kernel(TERMS(TERMS, TERMS, real, real, real, whole, whole))
def _sum(
    now: Any, then: Any, d: Array, gain: Array, stuck: Array, order: Array, shift: Array
) -> Any:
    """near or far of p_1 + p_2, where d is the slip zone in the contact that extends less far."""
    one = _integral(now, d + max(gain, 0.0), stuck, order, shift)
    two = _integral(then, d + max(-gain, 0.0), stuck, order, shift)
    return one[0] + two[0], one[1] + two[1], one[2] + two[2]


@kernel(results(2)(SERIES, real, real, whole))
def _step(of: Any, left: Array, right: Array, order: Array) -> Any:
    """The Newton step in the logarithms of both slip zones over the stick zone."""
    stuck, by_tension = of.h - left - right, math.pi * of.dsigma / 8
    near_left = _sum(of.left, of.left_2, left, of.da, stuck, order, 0)
    far_left = _sum(of.left, of.left_2, left, of.da, stuck, order, 1)
    near_right = _sum(of.right, of.right_2, right, of.dc, stuck, order, 0)
    far_right = _sum(of.right, of.right_2, right, of.dc, stuck, order, 1)
    # residuals of the conditions, and their derivatives with respect to h_s = h - left - right
    off_left, off_right = -of.dQ - by_tension * stuck, -of.dQ + by_tension * stuck
    off_left += of.kappa_left * near_left[0] + of.kappa_right * far_right[0]
    off_right += of.kappa_right * near_right[0] + of.kappa_left * far_left[0]
    widens_left = of.kappa_left * near_left[2] + of.kappa_right * far_right[2] - by_tension
    widens_right = of.kappa_right * near_right[2] + of.kappa_left * far_left[2] + by_tension
    at_left = (
        off_left,
        of.kappa_left * near_left[1] - widens_left,
        of.kappa_right * far_right[1] - widens_left,
    )
    at_right = (
        off_right,
        of.kappa_left * far_left[1] - widens_right,
        of.kappa_right * near_right[1] - widens_right,
    )
    return log_step(left, right, at_left, at_right, stuck)


@kernel(results(2)(SERIES, real, real, whole))
def _solved(of: Any, left: Array, right: Array, order: Array) -> Any:
    """Solve both conditions, truncated after an order, by Newton's method from first-order zones.

    The unknowns are log(d/h_s), so that the slip zones stay positive and leave a stick zone.  The
    slip zones are those in the contact that extends less far; NaN if the steps do not converge.
    """
    if of.dQ == 0 and of.dsigma == 0 and of.da == 0 and of.dc == 0:
        return 0.0, 0.0
    if not of.h > 0:
        return math.nan, math.nan
    longest = max(left, right, abs(of.da), abs(of.dc))
    left, right = max(left, LEAST * longest), max(right, LEAST * longest)
    shrink = of.h / (of.h + left + right)
    left, right = shrink * left, shrink * right
    for _ in range(STEPS):
        stuck = of.h - left - right
        if not (stuck > 0 and left > 0 and right > 0):
            break
        by_left, by_right = _step(of, left, right, order)
        length = max(abs(by_left), abs(by_right))
        if not length < math.inf:
            break
        part = 1.0 if length < LONGEST else LONGEST / length
        left, right = moved(of.h, left, right, part * by_left, part * by_right)
        longest = max(left, right, abs(of.da), abs(of.dc))
        if length * min(left, right) <= max(SMALL * min(left, right), ROUNDING * longest):
            return left, right
    return math.nan, math.nan


@kernel(results(2)(SERIES, real, real, real, real, whole))
def beside_edges(
    of: Any, f: Array, h: Array, drive_left: Array, drive_right: Array, order: Array
) -> Any:
    """Slip zones to an order in a contact of width h; a drive is pi sqrt(h) K_T.

    NaN unless slip occurs at both edges of both contacts and part of the contact sticks.  If no
    part sticks to the first order, the series is of no use at higher orders.
    """
    gain_left, gain_right = max(of.da, 0.0), max(of.dc, 0.0)
    # in the smaller contact: |K_T|/(f K_N) less half of the movement of the edge
    scale = math.pi * math.sqrt(h) * f
    left = abs(drive_left) / (scale * of.left[0]) - abs(of.da) / 2
    right = abs(drive_right) / (scale * of.right[0]) - abs(of.dc) / 2
    if order > 1 and left + right + gain_left + gain_right < h:
        left, right = _solved(of, left, right, order)
    left, right = left + gain_left, right + gain_right
    if left >= gain_left and right >= gain_right and left + right < h:
        return left, right
    return math.nan, math.nan


@kernel(results(2)(LAW, vector, real, real, real, real, real, real, real, whole))
def slip_zones(
    law: Law,
    own: Array,
    a: Array,
    c: Array,
    dQ: Array,
    dsigma: Array,
    f: Array,
    da: Array,
    dc: Array,
    order: Array,
) -> Any:
    """Slip zones to an order, seen from the contact [-a, c]; the other is [-(a - da), c - dc].

    NaN unless slip occurs at both edges of both contacts and part of the contact sticks.
    """
    load, _, _, K_left, K_right = law.state(a, c, own)
    load_2, _, _, K_left_2, K_right_2 = law.state(a - da, c - dc, own)
    exists = 0 <= dQ < f * (load + load_2) and math.isfinite(dsigma)
    if not (exists and K_left > 0 and K_right > 0):
        return math.nan, math.nan
    L_left, L_right, N_left, N_right = law.series(a, c, own)
    L_left_2, L_right_2, N_left_2, N_right_2 = law.series(a - da, c - dc, own)
    h = a + c
    drive_left, drive_right = dQ + math.pi * h * dsigma / 8, dQ - math.pi * h * dsigma / 8
    of = Series(
        h - max(da, 0.0) - max(dc, 0.0),
        dQ,
        dsigma,
        -f if drive_left < 0 else f,
        -f if drive_right < 0 else f,
        da,
        dc,
        (K_left, L_left, N_left),
        (K_right, L_right, N_right),
        (K_left_2, L_left_2, N_left_2),
        (K_right_2, L_right_2, N_right_2),
    )
    return beside_edges(of, f, h, drive_left, drive_right, order)


@kernel(LOOP)
def each_slip_zones(law: Any, given: Array, own: Array, out: Array) -> None:
    """Slip zones and their change by the next order; rows a, c, dQ, dsigma, f, da, dc, order."""
    law = opened(law)
    for i in range(given.shape[0]):
        a, c, dQ, dsigma, f, da, dc = given[i, :7]
        order = int(given[i, 7])
        left, right = slip_zones(law, own[i], a, c, dQ, dsigma, f, da, dc, order)
        next_left = next_right = math.nan
        if order < 3:
            next_left, next_right = slip_zones(law, own[i], a, c, dQ, dsigma, f, da, dc, order + 1)
        out[i, 0], out[i, 1] = left, right
        out[i, 2], out[i, 3] = abs(next_left - left), abs(next_right - right)
