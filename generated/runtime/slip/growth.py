r"""How slip begins at both ends of a cycle, and whether it grows throughout.

The conditions of a stick zone are exact only while both slip zones grow all the way from one end of
the cycle to the other.  Let the loads change by dP and dM along the path, at a contact of width h,
and let h_s be the width of the zone that still sticks.  Slip grows at the edges if

    kappa drive > f advance,   drive = dQ -/+ pi h_s dsigma/8,
    advance = dP -/+ 4 h_s (dM + mid dP)/h**2,

with the upper sign at the right edge, as long as the zone ends inside both contacts.  `advance`
measures how fast an edge advances.  At points that have not slipped yet, but have been at the
friction limit since the last half-cycle, the shear traction must stay within the falling friction
limit: kappa dq > f (p1 - p).  Under moderate tension it does, since p exceeds the pressure of a
contact inside its own; under large tension it is tested.  The test is made at PARTS points of the
path, from both ends, and with `advance` at the start.

Along the path the shear traction grows at the rate

    (dQ - pi dsigma (x - mid)/4)/(pi sqrt((x + m)(n - x))),

where mid is the middle of the current stick zone.  This rate changes its sign at
x = mid + 4 dQ/(pi dsigma).  Under large tension that point must lie between the final slip zones,
which have been at the friction limit since the last half-cycle.  It lies there all along the path
if it does at both ends of the path.

A path is a matrix with a row for each of its points; the first and the last row are the two
contacts of the cycle.  The columns are a, c, tilt, load, moment.  Under constant loads the path has
only these two rows.
"""

import math
from typing import Any

import numpy as np

from ..inverse import contact
from ..kernels import kernel
from .bounded import change, drives, friction, pressure_at
from .large import large_slip
from .moderate import LOAD, MOMENT, TILT, A, C, patch
from .quadrature import slip_nodes

PARTS = 8
"""Number of parts into which a half-cycle is divided to test the growth of slip."""

PLACES = 4
"""Number of points in a future slip zone at which the shear is compared with friction."""

SLACK = 1e-6
"""Allowance for rounding, relative to friction."""

TURNED = 1e-9
"""The part of the path to which the place is sought where an edge turns round."""

AGREED = 1e-8
"""Accuracy of the slip zones along the path, relative to their length."""


@kernel
def _on_the_way(law: Any, own: Any, ends: Any, part: float) -> Any:
    """The contact after a part of the path between two contacts, with loads in proportion."""
    point, last = np.empty(5), ends.shape[0] - 1
    for i in (LOAD, MOMENT):
        point[i] = ends[0, i] + part * (ends[last, i] - ends[0, i])
    point[A], point[C], point[TILT] = contact(law, own, point[LOAD], point[MOMENT])
    return point


@kernel
def load_path(law: Any, own: Any, ends: Any) -> Any:
    """The path between two contacts, with loads in proportion; just these two if they are equal."""
    if ends[0, A] == ends[1, A] and ends[0, C] == ends[1, C]:
        return ends
    path = np.empty((PARTS + 1, 5))
    for i in range(5):
        path[0, i], path[PARTS, i] = ends[0, i], ends[1, i]
    for k in range(1, PARTS):
        point = _on_the_way(law, own, ends, k / PARTS)
        for i in range(5):
            path[k, i] = point[i]
    return path


@kernel
def advances(path: Any, stuck: float, a: float, c: float) -> Any:
    """The rates at which the loads advance the left and the right edge of the contact [-a, c]."""
    last = path.shape[0] - 1
    more, turn = path[last, LOAD] - path[0, LOAD], path[last, MOMENT] - path[0, MOMENT]
    by_turning = 4 * stuck * (turn + (c - a) / 2 * more) / (a + c) ** 2
    return more + by_turning, more - by_turning


@kernel
def narrowest(law: Any, own: Any, ends: Any) -> Any:
    """The smallest a and the smallest c on the path between two contacts.

    On the way an edge may recede and then advance, for instance under a constant moment.  The right
    edge is at rest where dM + (mid - h/4) dP = 0.  There mid - h/4 = (c - 3 a)/4 changes by
    -(3/4) da, and da has the sign of dP.  An edge therefore turns round at most once, and only from
    receding to advancing.
    """
    last = ends.shape[0] - 1
    least_a, least_c = min(ends[0, A], ends[last, A]), min(ends[0, C], ends[last, C])
    for side in range(2):
        first = advances(ends, ends[0, A] + ends[0, C], ends[0, A], ends[0, C])[side]
        final = advances(ends, ends[last, A] + ends[last, C], ends[last, A], ends[last, C])[side]
        low, high = 0.0, 1.0
        while first < 0 < final and high - low > TURNED:
            part = (low + high) / 2
            point = _on_the_way(law, own, ends, part)
            a, c = point[A], point[C]
            if advances(ends, a + c, a, c)[side] < 0:
                low = part
            else:
                high = part
            if side == 0:
                least_a = min(least_a, a)
            else:
                least_c = min(least_c, c)
    return least_a, least_c


@kernel
def slips_at_the_start(path: Any, cycle: Any, right: float) -> Any:
    """Whether slip begins at both ends of the cycle, forward at -a, in direction `right` at c."""
    for end in (0, path.shape[0] - 1):
        a, c = path[end, A], path[end, C]
        advance_left, advance_right = advances(path, a + c, a, c)
        drive_left, drive_right = drives(cycle[4], cycle[5], a + c)
        if not (
            drive_left >= cycle[6] * abs(advance_left)
            and right * drive_right >= cycle[6] * abs(advance_right)
        ):
            return False
    return True


@kernel
def sticks_all_over(path: Any, cycle: Any) -> Any:
    """Whether nothing slips at all.

    An edge whose motion reverses along the path, advance = 0, cannot bear any shear at that
    point.  The rates of shear and of pressure, times w, vary linearly between their values at the
    edges.  If the pressure rises at both edges, or falls at both, the friction limit is met
    everywhere if it is met at the edges.  Otherwise the pressure is stationary at some point while
    the shear changes, and the edges decide nothing, unless there is no shear.
    """
    dQ, dsigma, f = cycle[4], cycle[5], cycle[6]
    if dQ == 0 and dsigma == 0:
        return True
    if path.shape[0] == 2:
        return False
    first_left, first_right = advances(path, path[0, A] + path[0, C], path[0, A], path[0, C])
    for k in range(path.shape[0]):
        a, c = path[k, A], path[k, C]
        left, right = advances(path, a + c, a, c)
        drive_left, drive_right = drives(dQ, dsigma, a + c)
        if not (
            (left * right >= 0 or drive_left == drive_right == 0)
            and abs(drive_left) <= f * abs(left)
            and abs(drive_right) <= f * abs(right)
            and left * first_left >= 0
            and right * first_right >= 0
        ):
            return False
    return True


# ---------------------------------------------------------------- moderate tension


@kernel
def grows(law: Any, own: Any, path: Any, cycle: Any) -> Any:
    """Whether moderate slip grows at every point of the path, from both ends."""
    last = path.shape[0] - 1
    for sense in (1, -1):
        end = 0 if sense > 0 else last
        for k in range(1, last + 1):
            point = k if sense > 0 else last - k
            a, c = path[point, A], path[point, C]
            m, n = patch(law, own, path, end, point, k / last, cycle)
            left, right = advances(path, m + n, a, c)
            drive_left, drive_right = drives(cycle[4], cycle[5], m + n)
            if not (
                m <= min(a, path[end, A])
                and n <= min(c, path[end, C])
                and drive_left >= sense * cycle[6] * left
                and drive_right >= sense * cycle[6] * right
            ):
                return False
    return True


# ---------------------------------------------------------------- large tension, dsigma >= 0


@kernel
def mirrored(path: Any) -> Any:
    """The path of the mirror image, x -> -x."""
    behind = path.copy()
    for k in range(path.shape[0]):
        behind[k, A], behind[k, C] = path[k, C], path[k, A]
        behind[k, TILT], behind[k, MOMENT] = -path[k, TILT], -path[k, MOMENT]
    return behind


@kernel
def holds_at_the_start(path: Any, cycle: Any, m: float, n: float) -> Any:
    """Whether the shear traction stays within the friction limit at points that have not slipped
    yet, starting from either end.

    The full-stick change in shear and the change in pressure, each multiplied by w, are linear in
    x. The shear therefore stays within the friction limit all over a future slip zone if it does so
    at the inner end, -m or n, and if slip begins at the edge.
    """
    for sense in (1, -1):
        end = 0 if sense > 0 else path.shape[0] - 1
        a, c = path[end, A], path[end, C]
        left, right = advances(path, a + c, a, c)
        for side in (-1, 1):
            x = -m if side < 0 else n
            shear = cycle[4] - math.pi * cycle[5] * (x - (c - a) / 2) / 4
            pressure = (left * (c - x) + right * (a + x)) / (a + c)
            if not -side * shear >= -sense * cycle[6] * pressure:
                return False
    return True


@kernel
def _force_rates(
    slip: float, stuck: float, h: float, own_advance: float, other_advance: float
) -> Any:
    """int dp sqrt((stuck + y)/y) dy and int dp sqrt(y/(stuck + y)) dy over one slip zone.

    dp = (own (h - s) + other s)/(pi h sqrt(s (h - s))) as the loads change, where s is the distance
    from the zone's edge, and `own` and `other` are the advances of this edge and the other one.
    """
    nodes = slip_nodes(np.empty(0), 1.0, 0.0, slip, slip, 1)
    near, far = 0.0, 0.0
    for i in range(nodes.shape[1]):
        y = nodes[0, i]
        s, beyond = slip - y, stuck + y
        dp = (own_advance * (h - s) + other_advance * s) / (math.pi * h * math.sqrt(s * (h - s)))
        force = nodes[1, i] * dp / math.sqrt(y * beyond)
        near += force * beyond
        far += force * y
    return near, far


@kernel
def _still_grows(path: Any, cycle: Any, k: int, sense: float, m: float, n: float) -> Any:
    """Whether both slip zones of large tension are growing, at a contact of the path.

    The next change in shear, due to dQ, dsigma and +/- f dp in the slip zones, would be singular at
    the ends of the stick zone.  It extends the slip there if it has the sign of the slip.
    """
    a, c = path[k, A], path[k, C]
    if not (m < a and n < c and m + n > 0):
        return False
    left, right = advances(path, a + c, a, c)
    near_left, far_left = _force_rates(a - m, m + n, a + c, left, right)
    near_right, far_right = _force_rates(c - n, m + n, a + c, right, left)
    drive_left, drive_right = drives(cycle[4], cycle[5], m + n)
    moving = sense * cycle[6]
    at_left = drive_left - moving * (near_left - far_right)
    at_right = drive_right - moving * (far_left - near_right)
    return at_left >= 0 and at_right <= 0


@kernel
def _within_friction(of: Any, partial: Any, m: float, n: float) -> Any:
    """Whether kappa dq > f (p1 - p) at points that will slip later.

    of, partial: the cycle between the first contact and the one on the path, and its stick zone;
    [-m, n]: the final stick zone.
    """
    for side in (-1, 1):
        end, now = (m, partial.m) if side < 0 else (n, partial.n)
        for k in range(PLACES):
            x = side * (end + (k + 0.5) / PLACES * (now - end))
            drop = of.cycle[6] * (pressure_at(of, 0, x) - pressure_at(of, 2, x))
            if not drop > 0 or not -partial.m < x < partial.n:
                continue
            if not -side * change(partial, x) >= drop * (1 - SLACK):
                return False
    return True


@kernel
def grows_apart(law: Any, own: Any, path: Any, cycle: Any, sense: float, m: float, n: float) -> Any:
    """Whether slip of opposite signs grows at every point of the path, from both ends."""
    last = path.shape[0] - 1
    if not (m <= min(path[0, A], path[last, A]) and n <= min(path[0, C], path[last, C])):
        return False
    for direction in (1, -1):
        end = 0 if direction > 0 else last
        before_m, before_n = path[end, A], path[end, C]
        for k in range(1, last):
            point = k if direction > 0 else last - k
            a, c, part = path[point, A], path[point, C], k / last
            partial = cycle.copy()
            partial[0], partial[1], partial[2], partial[3] = path[end, A], path[end, C], a, c
            partial[4], partial[5] = part * cycle[4], part * cycle[5]
            slip = large_slip(law, own, partial, sense, AGREED)
            if not (
                slip.m <= min(before_m, a)
                and slip.n <= min(before_n, c)
                and _still_grows(path, cycle, point, direction, slip.m, slip.n)
                and _within_friction(friction(law, own, partial, sense, -1.0, math.nan), slip, m, n)
            ):
                return False
            before_m, before_n = slip.m, slip.n
        if not (m <= before_m and n <= before_n):
            return False
        if not _still_grows(path, cycle, last - end, direction, m, n):
            return False
    return True
