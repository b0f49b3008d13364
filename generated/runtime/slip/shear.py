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

A cycle is a vector a1, c1, a2, c2, dQ, dsigma, f; everything is for E* = 1.
"""

import math
from typing import Any

import numpy as np

from ..elementary import EPS
from ..kernels import kernel, loop, opened
from ..types import FULL_STICK, LARGE, MIXED, MODERATE
from .bounded import beside, change, friction, oriented, sense_of

LEVEL = 2
"""Level of the quadrature, sufficient however close a kink is to the stick zone."""

BESIDE = 1e-20
"""Least distance between a point in the stick zone and a corner, relative to the zone's width; a
rounding of the corner's place if that is larger."""

ROUNDED = 1e-9
"""Ends of two stick zones that differ by less than this fraction of the contact width may be
equal."""


# ---------------------------------------------------------------- the change in shear


@kernel
def _alike(cycle: Any) -> Any:
    """Whether the contact is the same at both ends of the half-cycle."""
    return cycle[0] == cycle[2] and cycle[1] == cycle[3]


@kernel
def _beside_corner(law: Any, own: Any, x: float, m: float, n: float) -> Any:
    """x, moved inward off a corner in the stick zone: p is infinite at the corner, dq is not."""
    for corner in law.breaks(own):
        away = max(BESIDE * (m + n), EPS * abs(corner))
        if abs(x - corner) < away:
            x = corner + (away if corner < (n - m) / 2 else -away)
    return x


@kernel
def pressures(law: Any, own: Any, cycle: Any, x: float) -> Any:
    """p1 + p2; infinite at a corner."""
    p = law.pressure(x, cycle[0], cycle[1], own)
    return 2 * p if _alike(cycle) else p + law.pressure(x, cycle[2], cycle[3], own)


@kernel
def change_at(law: Any, own: Any, cycle: Any, m: float, n: float, regime: float, x: float) -> Any:
    """dq at x; zero outside both contacts, NaN where the stick zone is not known."""
    if math.isnan(x):
        return math.nan
    if regime == FULL_STICK and _alike(cycle):
        return 0.0
    if regime not in (MODERATE, LARGE, MIXED) or not m + n < math.inf:
        return math.nan
    f = cycle[6]
    if x <= -m or x >= n:
        on_left = x < (n - m) / 2
        forward = regime != LARGE or on_left != (cycle[5] < 0)
        return (f if forward else -f) * pressures(law, own, cycle, x)
    if regime == LARGE:
        sense, cycle = sense_of(cycle), oriented(cycle)
        of = friction(law, own, cycle, sense, -1.0, math.nan)
        m, n = (m, n) if sense > 0 else (n, m)
        return change(beside(of, m, n, of.a - m, of.c - n, LEVEL), sense * x)
    x = _beside_corner(law, own, x, m, n)
    return f * (pressures(law, own, cycle, x) - 2 * law.pressure(x, m, n, own))


@kernel
def _cycle(row: Any) -> Any:
    """A cycle from x, a1, c1, a2, c2, dQ, dsigma, m, n, regime, f, E*."""
    cycle = row[1:8].copy()
    cycle[4], cycle[5], cycle[6] = row[5] / row[11], row[6] / row[11], row[10]
    return cycle


@loop
def each_shear_change(law: Any, given: Any, own: Any, out: Any) -> None:
    """x, a1, c1, a2, c2, dQ, dsigma, m, n, regime, f, E* -> dq."""
    law = opened(law)
    for i in range(given.shape[0]):
        m, n, regime, E_star = given[i, 7], given[i, 8], given[i, 9], given[i, 11]
        cycle = _cycle(given[i])
        out[i, 0] = E_star * change_at(law, own[i], cycle, m, n, regime, given[i, 0])


# ---------------------------------------------------------------- the shear traction itself


@kernel
def _turns_between(cycle: Any, zone: Any, a: float, c: float) -> Any:
    """Whether the rate of shear, while [-a, c] sticks, changes sign within a stick zone."""
    turn = (c - a) / 2 + 4 * cycle[4] / (math.pi * cycle[5])
    margin = ROUNDED * (cycle[0] + cycle[1])
    return -zone[0] - margin < turn < zone[1] + margin


@kernel
def _slips_within(cycle: Any, zone: Any, other: Any, other_zone: Any) -> Any:
    """Whether one half-cycle slips only where another one slips, and in the corresponding
    direction.

    No point that slipped before may be driven further either.  Under moderate tension the rate of
    shear has the same sign everywhere.  A zone is given by m, n and its regime.
    """
    m, n, regime = zone
    if regime == FULL_STICK:
        return True
    margin = ROUNDED * (cycle[0] + cycle[1])
    if regime != other_zone[2] or not (m > other_zone[0] - margin and n > other_zone[1] - margin):
        return False
    if regime == MODERATE:
        return True
    return (
        regime == LARGE
        and (cycle[5] < 0) == (other[5] < 0)
        and _turns_between(cycle, other_zone, cycle[0], cycle[1])
        and _turns_between(cycle, other_zone, m, n)
    )


@kernel
def shear_at(
    law: Any, own: Any, rise: Any, rise_zone: Any, fall: Any, fall_zone: Any, x: float
) -> Any:
    """q at x after half of the change `rise` from zero, less the change `fall`.

    Both are cycles of one contact, given with m, n and the regime.  NaN if one of the stick zones
    is not known, or if slip does not grow throughout.
    """
    known = rise_zone[2] in (MODERATE, LARGE, FULL_STICK) and fall[4] <= rise[4]
    if not (known and _slips_within(fall, fall_zone, rise, rise_zone)):
        return math.nan
    m, n, regime = rise_zone
    q = change_at(law, own, rise, m, n, regime, x) / 2
    m, n, regime = fall_zone
    return q - change_at(law, own, fall, m, n, regime, x)


@loop
def each_shear(law: Any, given: Any, own: Any, out: Any) -> None:
    """x, a, c, Q, sigma, dQ, dsigma, both stick zones as m, n, regime, f, E* -> q.

    The rise is the half-cycle of 2 Q and 2 sigma, the fall that of dQ and dsigma.
    """
    law = opened(law)
    rise, fall = np.empty(7), np.empty(7)
    for i in range(given.shape[0]):
        row = given[i]
        for cycle in (rise, fall):
            cycle[0] = cycle[2] = row[1]
            cycle[1] = cycle[3] = row[2]
            cycle[6] = row[13]
        E_star = row[14]
        rise[4], rise[5] = 2 * row[3] / E_star, 2 * row[4] / E_star
        fall[4], fall[5] = row[5] / E_star, row[6] / E_star
        rise_zone, fall_zone = (row[7], row[8], row[9]), (row[10], row[11], row[12])
        out[i, 0] = E_star * shear_at(law, own[i], rise, rise_zone, fall, fall_zone, row[0])


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
def slip_at(law: Any, own: Any, cycle: Any, m: float, n: float, regime: float, x: float) -> Any:
    """Slip range at x; NaN outside either contact, and where slip reverses."""
    if not (regime > 0 and -min(cycle[0], cycle[2]) <= x <= min(cycle[1], cycle[3])):
        return math.nan
    if -m <= x <= n:
        return 0.0
    if regime not in (MODERATE, LARGE):
        return math.nan
    sense, cycle = sense_of(cycle), oriented(cycle)
    x, m, n = (x, m, n) if sense > 0 else (-x, n, m)
    of = friction(law, own, cycle, sense, 1.0 if regime == MODERATE else -1.0, x)
    there = x - n if x > n else -m - x
    slip = beside(of, m, n, of.a - m, of.c - n, LEVEL)
    total = _slipped(slip.left, m + n, there, x < -m) + _slipped(slip.right, m + n, there, x > n)
    return 2 / math.pi * abs(total)


@loop
def each_slip_range(law: Any, given: Any, own: Any, out: Any) -> None:
    """x, a1, c1, a2, c2, dQ, dsigma, m, n, regime, f, E* -> slip."""
    law = opened(law)
    for i in range(given.shape[0]):
        m, n, regime = given[i, 7], given[i, 8], given[i, 9]
        out[i, 0] = slip_at(law, own[i], _cycle(given[i]), m, n, regime, given[i, 0])
