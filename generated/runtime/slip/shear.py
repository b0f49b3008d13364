r"""The change in shear over a half-cycle, and the slip range.

With w(x) = sqrt((x + m)(x - n)), negative on the left, W(x) = sqrt((x + m)(n - x)), and r = kappa f
(p1 + p2) in the slip zones, the bounded solution is

    dq(x) = (W(x)/pi) int_slip r/(w(xi) (xi - x)) dxi              in the stick zone,
    (1/pi) PV int dq/(x - xi) dxi - dsigma/4
          = -(w(x)/pi) PV int_slip r/(w(xi) (xi - x)) dxi          in the slip zones.

Let L be the length of a slip zone, d the distance of x from it, D the distance of x from the other
one, y the distance from the start of the slip zone, and h_s = m + n.  The value of r at the start
of the zone is subtracted from r and integrated exactly, since

    sqrt(d D) int_0^L dy/(sqrt(y (y + h_s)) (y + d)) = 2 arctan sqrt(L D/(d (L + h_s))).

Under moderate tension dq is f (p1 + p2 - 2 p_s), where p_s is the pressure of the patch [-m, n].

The second equation is E*/2 times the rate of slip along x.  Slip is its integral from the stick
zone.  With y and Y the outward distances of x and xi from the stick zone,

    int_0^y sqrt(t (t + h_s))/(Y - t) dt = -sqrt(y (y + h_s)) - (2 Y + h_s) asinh sqrt(y/h_s)
        + sqrt(Y (Y + h_s)) log |(r + s)/(r - s)|,   r = sqrt(Y (y + h_s)),  s = sqrt(y (Y + h_s)).

For Y < -h_s, the other slip zone, r and s take |Y| and |Y + h_s|, and the logarithm changes its
sign.

At constant normal loads the shear traction itself follows from its changes.  In the first loading
from zero, friction in the slip zones is f p, where the change over a half-cycle is 2 f p.  Both
problems obey the same linear equations, so that the first loading to Q and sigma produces half of
the change under 2 Q and 2 sigma.  When the loads then fall, the shear traction changes as in any
half-cycle, provided that reverse slip is confined to points that slipped before, and that no point
that slipped before is driven further.
"""

import math
from typing import Any

import numpy as np

from ..elementary import EPS
from ..kernels import kernel, loop, opened
from ..types import Array, Regime, StickZone
from .bounded import ZONE_RTOL, both_zones, change_between, slipping_in
from .cycles import cycle_of, is_steady
from .quadrature import FINEST, pressures, slip_zone

# ---------------------------------------------------------------- the change in shear


@kernel
def _beside_corner(law: Any, own: Any, x: float, m: float, n: float) -> float:
    """x, moved inward off a corner in the stick zone, by a rounding of the zone's width or of the
    corner's place: p is infinite at the corner, dq is not."""
    for corner in law.breaks(own):
        away = EPS * max(m + n, abs(corner))
        if abs(x - corner) < away:
            x = corner + (away if corner < (n - m) / 2 else -away)
    return x


@kernel
def _change(law: Any, own: Any, row: Any) -> float:
    """dq at a place; zero outside both contacts, NaN where the stick zone is not known."""
    cycle, m, n, regime, x = cycle_of(row), row[6], row[7], row[8], row[9]
    of = slipping_in(cycle, regime)
    if math.isnan(x):
        return math.nan
    if regime == Regime.FULL_STICK.value and is_steady(cycle):
        return 0.0
    known = regime in (Regime.MODERATE.value, Regime.LARGE.value, Regime.MIXED.value)
    if not (known and m + n < math.inf):
        return math.nan
    if x <= -m or x >= n:
        kappa = of.kappa if x < (n - m) / 2 else of.lamda
        return kappa * cycle.f * pressures(law, own, cycle, x)
    if of.kappa == of.lamda:
        x = _beside_corner(law, own, x, m, n)
        return cycle.f * (pressures(law, own, cycle, x) - 2 * law.pressure(x, m, n, own))
    zones = both_zones((law, own, FINEST), of, of.a - m, of.c - n)
    return change_between(of, zones, m, n, x)


@loop
def each_shear_change(law: Any, given: Any, own: Any, out: Any) -> None:
    """a_1, c_1, a_2, c_2, dQ, dsigma, m, n, regime, x, f, E* -> dq."""
    law = opened(law)
    for i in range(given.shape[0]):
        out[i, 0] = given[i, 11] * _change(law, own[i], given[i])


# ---------------------------------------------------------------- the shear traction itself


def _turns_in(contact: Any, change: Any, zone: StickZone, margin: Array) -> Array:
    """Whether the rate of shear, while a contact sticks, changes sign within a stick zone."""
    (a, c), (dQ, dsigma) = contact, change
    turn = (c - a) / 2 + 4 * dQ / (np.pi * dsigma)
    return (-zone.m - margin < turn) & (turn < zone.n + margin)


def rises_and_falls(
    contact: Any, rise: Any, rise_zone: StickZone, fall: Any, fall_zone: StickZone
) -> Array:
    """Whether shear follows from the change `rise`, by half, and the change `fall` after it.

    The fall must slip only where the rise does, and in the corresponding direction, and must drive
    no point that slipped before further.  Under moderate tension the rate of shear has the same
    sign everywhere.

    contact     its edges a and c
    rise, fall  changes in Q and sigma
    """
    margin = ZONE_RTOL * (contact[0] + contact[1])
    stuck = rise_zone.regime == Regime.FULL_STICK
    moderate, large = (rise_zone.regime == code for code in (Regime.MODERATE, Regime.LARGE))
    slips_less = (fall_zone.m > rise_zone.m - margin) & (fall_zone.n > rise_zone.n - margin)
    follows = (
        ((rise[1] < 0) == (fall[1] < 0))
        & _turns_in(contact, fall, rise_zone, margin)
        & _turns_in((fall_zone.m, fall_zone.n), fall, rise_zone, margin)
    )
    within = slips_less & (fall_zone.regime == rise_zone.regime) & (moderate | (large & follows))
    known = (moderate | large | stuck) & (fall[0] <= rise[0])
    return known & ((fall_zone.regime == Regime.FULL_STICK) | within)


# ---------------------------------------------------------------- slip


@kernel
def _slipped(zone: Any, stuck: float, there: float, here: bool) -> Any:
    """The contribution of r in one slip zone to the slip at a point, divided by 2/pi.

    It is the integral of r/|w| times the integral over t from 0 to y in the module's docstring.

    there  y, the distance of the point from the stick zone
    here   whether the point lies in this slip zone
    """
    root, arc = math.sqrt(there * (there + stuck)), math.asinh(math.sqrt(there / stuck))
    total = 0.0
    for i in range(zone.y.size):
        y = zone.y[i]
        y_far = y + stuck
        if here:
            summed = math.sqrt(y * (there + stuck)) + math.sqrt(there * y_far)
            # nodes crowd towards the point: closer to it than a rounding, the distance is not known
            apart = max(abs(y - there), EPS * there)
            logarithm = -math.log(stuck * apart / (summed * summed))
            smooth = root + (y + y_far) * arc
        else:
            summed = math.sqrt(y_far * (there + stuck)) + math.sqrt(there * y)
            logarithm = math.log(summed * summed / (stuck * (y_far + there)))
            smooth = (y + y_far) * arc - root
        total += zone.weight[i] * zone.r[i] * (logarithm - smooth / math.sqrt(y * y_far))
    return total


@kernel
def slip(law: Any, own: Any, cycle: Any, zone: Any, x: float, rule: int) -> float:
    """Slip range at x; NaN outside either contact, and where slip reverses.

    zone: m, n and the code of the regime
    rule: the number of the quadrature rule
    """
    m, n, regime = zone
    if not (regime > 0 and -min(cycle.a_1, cycle.a_2) <= x <= min(cycle.c_1, cycle.c_2)):
        return math.nan
    if -m <= x <= n:
        return 0.0
    if regime not in (Regime.MODERATE.value, Regime.LARGE.value):
        return math.nan
    of, there = slipping_in(cycle, regime), x - n if x > n else -m - x
    left = slip_zone(law, own, cycle, -1.0, of.a - m, x, rule)
    right = slip_zone(law, own, cycle, 1.0, of.c - n, x, rule)
    total = of.kappa * _slipped(left, m + n, there, x < -m)
    total += of.lamda * _slipped(right, m + n, there, x > n)
    return 2 / math.pi * abs(total)


@loop
def each_slip_range(law: Any, given: Any, own: Any, out: Any) -> None:
    """a_1, c_1, a_2, c_2, dQ, dsigma, m, n, regime, x, f, E* -> slip."""
    law = opened(law)
    for i in range(given.shape[0]):
        zone = given[i, 6], given[i, 7], given[i, 8]
        out[i, 0] = slip(law, own[i], cycle_of(given[i]), zone, given[i, 9], FINEST)
