r"""Whether slip grows at both edges all the way from one end of a half-cycle to the other.

The conditions of a stick zone are exact only then.  Let the loads change by dP and dM.  Slip begins
at an edge if

    kappa drive >= f |advance|,

with kappa its direction (cycles.py).  It goes on growing if the next change in shear, due to dQ,
dsigma and the friction of the slip zones, would be singular at the end of the stick zone with the
sign of slip.  That is tested at PARTS points of the way, from both ends, as is whether the zone
ends inside the contact.

At points that have not slipped yet, but have been at the friction limit since the last half-cycle,
the shear traction must stay within the falling friction limit: kappa dq > f (p_1 - p).  If both
edges slip in the same direction it does, since p exceeds the pressure of a contact inside its own;
otherwise it is tested.
"""

import math
from typing import Any

from ..kernels import kernel
from ..types import Regime
from .bounded import ROUGH_RTOL, ZONE_RTOL, both_zones, change_between, slipping, zone_of
from .cycles import Cycle, advances, drives, ends_of, on_the_way
from .quadrature import ROUGH

PARTS = 8
"""Number of parts into which a half-cycle is divided to test the growth of slip."""

PLACES = 4
"""Number of points in a future slip zone at which the shear is compared with friction."""

FRICTION_RTOL = 1e-6
"""Allowance for rounding of the shear, relative to friction."""


@kernel
def sticks_all_over(law: Any, own: Any, cycle: Any, ends: Any) -> bool:
    """Whether nothing slips at all.

    An edge whose motion reverses on the way, advance = 0, cannot bear any shear at that point.  The
    rates of shear and of pressure, times w, vary linearly between their values at the edges.  If
    the pressure rises at both edges, or falls at both, the friction limit is met everywhere if it
    is met at the edges.  Otherwise the pressure is stationary at some point while the shear
    changes, and the edges decide nothing, unless there is no shear.
    """
    if cycle.dQ == 0 and cycle.dsigma == 0:
        return True
    first_left, first_right = advances(ends, cycle.a_1, cycle.c_1)
    for k in range(PARTS + 1):
        a, c = cycle.a_1, cycle.c_1
        if k == PARTS:
            a, c = cycle.a_2, cycle.c_2
        elif k > 0:
            a, c, _ = on_the_way(law, own, ends, k / PARTS)
        left, right = advances(ends, a, c)
        drive_left, drive_right = drives(cycle, a + c)
        if not (
            (left * right >= 0 or drive_left == drive_right == 0)
            and abs(drive_left) <= cycle.f * abs(left)
            and abs(drive_right) <= cycle.f * abs(right)
            and left * first_left >= 0
            and right * first_right >= 0
        ):
            return False
    return True


@kernel
def begins(of: Any, ends: Any) -> bool:
    """Whether slip begins at both edges, seen from both ends of the half-cycle."""
    cycle = of.cycle
    for a, c in ((cycle.a_1, cycle.c_1), (cycle.a_2, cycle.c_2)):
        left, right = advances(ends, a, c)
        drive_left, drive_right = drives(cycle, a + c)
        if not (
            of.kappa * drive_left >= cycle.f * abs(left)
            and of.lamda * drive_right >= cycle.f * abs(right)
        ):
            return False
    return True


@kernel
def holds_at_first(of: Any, ends: Any, m: float, n: float) -> bool:
    """Whether the shear traction stays within the friction limit, as slip begins, at points of the
    slip zones beside [-m, n] that have not slipped yet.

    The full-stick change in shear and the change in pressure, each multiplied by w, are linear in
    x. The shear therefore stays within the friction limit all over a future slip zone if it does so
    at the inner end, -m or n, and if slip begins at the edge.
    """
    cycle = of.cycle
    for a, c, sense in ((cycle.a_1, cycle.c_1, 1.0), (cycle.a_2, cycle.c_2, -1.0)):
        left, right = advances(ends, a, c)
        for x, kappa in ((-m, of.kappa), (n, of.lamda)):
            shear = cycle.dQ - math.pi * cycle.dsigma * (x - (c - a) / 2) / 4
            pressure = (left * (c - x) + right * (a + x)) / (a + c)
            if not kappa * shear >= -sense * cycle.f * pressure:
                return False
    return True


@kernel
def _force_rates(slip: float, stuck: float, h: float, here: float, there: float) -> Any:
    """int dp sqrt((stuck + y)/y) dy and int dp sqrt(y/(stuck + y)) dy over one slip zone.

    dp = (here (h - s) + there s)/(pi h sqrt(s (h - s))) as the loads change, where s is the
    distance from the zone's edge, and `here` and `there` are the advances of this edge and the
    other one.  Gauss's rule takes the square roots at both ends of the zone.
    """
    near, far, count = 0.0, 0.0, 16
    for i in range(count):
        y = slip * math.sin(math.pi / 2 * (i + 0.5) / count) ** 2
        s = slip - y
        dp = (here * (h - s) + there * s) / (h * math.sqrt(h - s)) / count
        near += dp * math.sqrt(stuck + y)
        far += dp * y / math.sqrt(stuck + y)
    return near, far


@kernel
def _still_grows(of: Any, ends: Any, sense: float, a: float, c: float, m: float, n: float) -> bool:
    """Whether both slip zones are growing at the contact [-a, c], on the way there or back."""
    if not (m <= a and n <= c and m + n > 0):
        return False
    left, right = advances(ends, a, c)
    near_left, far_left = _force_rates(a - m, m + n, a + c, left, right)
    near_right, far_right = _force_rates(c - n, m + n, a + c, right, left)
    drive_left, drive_right = drives(of.cycle, m + n)
    moving, both = sense * of.cycle.f, of.kappa * of.lamda
    return of.kappa * drive_left >= moving * (
        near_left + both * far_right
    ) and of.lamda * drive_right >= moving * (near_right + both * far_left)


@kernel
def _within_friction(law: Any, own: Any, of: Any, m: float, n: float, zone: Any) -> bool:
    """Whether kappa dq > f (p_1 - p) at points that will slip later.

    of, m, n: a part of the half-cycle, and its stick zone; zone: the final stick zone.
    """
    cycle = of.cycle
    zones = both_zones((law, own, ROUGH), of, of.a - m, of.c - n)
    for k in range(2 * PLACES):
        part = (k // 2 + 0.5) / PLACES
        x, kappa = -zone[0] - part * (m - zone[0]), of.kappa
        if k % 2:
            x, kappa = zone[1] + part * (n - zone[1]), of.lamda
        before = law.pressure(x, cycle.a_1, cycle.c_1, own)
        drop = cycle.f * (before - law.pressure(x, cycle.a_2, cycle.c_2, own))
        if drop > 0:
            shear = kappa * change_between(of, zones, m, n, x)
            if not shear >= drop * (1 - FRICTION_RTOL):
                return False
    return True


@kernel
def _up_to(law: Any, own: Any, cycle: Any, ends: Any, sense: float, part: float) -> Cycle:
    """A part of a half-cycle from its start (sense = 1) or, backward, from its end."""
    a, c, _ = on_the_way(law, own, ends, part if sense > 0 else 1 - part)
    dQ, dsigma = part * cycle.dQ, part * cycle.dsigma
    if sense > 0:
        return Cycle(cycle.a_1, cycle.c_1, a, c, dQ, dsigma, cycle.f)
    return Cycle(cycle.a_2, cycle.c_2, a, c, dQ, dsigma, cycle.f)


@kernel
def grown(law: Any, own: Any, of: Any, ends: Any, m: float, n: float, regime: Any) -> Any:
    """The regime of a half-cycle that ends with the stick zone [-m, n]: the given one if both slip
    zones grow at every point of the way, from both ends, until then; otherwise MIXED.

    UNSOLVED if the stick zone of a part of the half-cycle is not found.
    """
    small = ZONE_RTOL * (of.a + of.c)
    for sense in (1.0, -1.0):
        last_m = last_n = math.inf
        for k in range(1, PARTS + 1):
            now = _up_to(law, own, of.cycle, ends, sense, k / PARTS)
            now_of, now_m, now_n = slipping(now, of.kappa, of.lamda), m, n
            if k < PARTS:
                now_m, now_n, found = zone_of(law, own, now_of, ends_of(law, own, now), ROUGH_RTOL)
                if found == Regime.UNSOLVED:
                    return found
            if not (
                now_m <= min(last_m, now_of.a) + small
                and now_n <= min(last_n, now_of.c) + small
                and _still_grows(of, ends, sense, now.a_2, now.c_2, now_m, now_n)
                and (
                    k == PARTS
                    or of.kappa == of.lamda
                    or _within_friction(law, own, now_of, now_m, now_n, (m, n))
                )
            ):
                return Regime.MIXED
            last_m, last_n = now_m, now_n
    return regime
