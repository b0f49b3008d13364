r"""How slip begins at both ends of a cycle, and whether it goes on all the way.

The conditions of a stick zone are exact only while both slip zones grow all the way from one end of
the cycle to the other.  Let the loads change by dP and dM along the way, at a contact of width h,
and let h_s be the width of the zone that is still stuck; then slip goes on at the edges if

    kappa pull > f lead,    pull = dQ -/+ pi h_s dsigma/8,   lead = dP -/+ 4 h_s (dM + mid dP)/h**2,

the upper sign at the right edge, and as long as the zone ends inside both contacts.  `lead` says
how fast an edge runs ahead.  Shear that has not slipped yet, at friction since the last half-cycle,
must stay within it while the pressure falls: kappa dq > f (p1 - p).  Under moderate tension it
does, since p exceeds the pressure of a contact inside its own; under large tension it is asked.
This is tested at PARTS parts of the way, from both ends, lead included at the start.

On the way shear comes in at a rate of

    (dQ - pi dsigma (x - mid)/4)/(pi sqrt((x + m)(n - x))),    mid the middle of what sticks so far,

which changes its sign at x = mid + 4 dQ/(pi dsigma).  Under large tension that place must lie
between the slip zones to come, which are at friction since the last half-cycle: it does so all the
way if it does at both ends of it.

A way is a matrix with a row for every part of it, the first one and the last one those of both
contacts: a, c, tilt, load, moment.  Steady loads have these two alone.
"""

import math
from typing import Any

import numpy as np

from ..inverse import contact
from ..kernels import LAW, kernel, matrix, real, results, truth, vector, whole
from .bounded import FRICTION, SLIP, change, friction, pressure_at, pulls
from .large import large_slip
from .moderate import LOAD, MOMENT, TILT, A, C, patch
from .quadrature import slip_nodes

PARTS = 8
"""Parts of a half-cycle at which the growth of slip is tested."""

PLACES = 4
"""Places of a slip zone to come at which its shear is compared with friction."""

SLACK = 1e-6
"""What is allowed for rounding, in parts of the friction."""

AGREED = 1e-8
"""What slip zones on the way are known to, in parts of their own."""


@kernel(matrix(LAW, vector, matrix))
def followed(law: Any, own: Any, ends: Any) -> Any:
    """The way between two contacts, loads in proportion; steady loads are left as they are."""
    if ends[0, A] == ends[1, A] and ends[0, C] == ends[1, C]:
        return ends
    way = np.empty((PARTS + 1, 5))
    for i in range(5):
        way[0, i], way[PARTS, i] = ends[0, i], ends[1, i]
    for k in range(1, PARTS):
        part = k / PARTS
        way[k, LOAD] = ends[0, LOAD] + part * (ends[1, LOAD] - ends[0, LOAD])
        way[k, MOMENT] = ends[0, MOMENT] + part * (ends[1, MOMENT] - ends[0, MOMENT])
        way[k, A], way[k, C], way[k, TILT] = contact(law, own, way[k, LOAD], way[k, MOMENT])
    return way


@kernel(results(2)(matrix, real, real, real))
def leads(way: Any, stuck: float, a: float, c: float) -> Any:
    """By how much the loads drive the left and the right edge of the contact [-a, c]."""
    last = way.shape[0] - 1
    more, turn = way[last, LOAD] - way[0, LOAD], way[last, MOMENT] - way[0, MOMENT]
    by_turning = 4 * stuck * (turn + (c - a) / 2 * more) / (a + c) ** 2
    return more + by_turning, more - by_turning


@kernel(truth(matrix, vector, real))
def slips_at_the_start(way: Any, cycle: Any, right: float) -> Any:
    """Whether slip begins at either end of the cycle: forward on the left, of this sense right."""
    for end in (0, way.shape[0] - 1):
        a, c = way[end, A], way[end, C]
        lead_left, lead_right = leads(way, a + c, a, c)
        pull_left, pull_right = pulls(cycle[4], cycle[5], a + c)
        if not (
            pull_left >= cycle[6] * abs(lead_left)
            and right * pull_right >= cycle[6] * abs(lead_right)
        ):
            return False
    return True


@kernel(truth(matrix, vector))
def sticks_all_over(way: Any, cycle: Any) -> Any:
    """Whether there is no slip at all.

    An edge that turns back on the way, lead = 0, could not bear any shear there.  Rates of shear
    and of pressure are lines over w between those of the edges.  If the pressure rises, or falls,
    at both, friction at the edges is friction all over; else there is a place where it rests while
    shear goes on, and the edges tell nothing, unless there is no shear.
    """
    dQ, dsigma, f = cycle[4], cycle[5], cycle[6]
    if dQ == 0 and dsigma == 0:
        return True
    if way.shape[0] == 2:
        return False
    first_left, first_right = leads(way, way[0, A] + way[0, C], way[0, A], way[0, C])
    for k in range(way.shape[0]):
        a, c = way[k, A], way[k, C]
        left, right = leads(way, a + c, a, c)
        pull_left, pull_right = pulls(dQ, dsigma, a + c)
        if not (
            (left * right >= 0 or pull_left == pull_right == 0)
            and abs(pull_left) <= f * abs(left)
            and abs(pull_right) <= f * abs(right)
            and left * first_left >= 0
            and right * first_right >= 0
        ):
            return False
    return True


# ---------------------------------------------------------------- moderate tension


@kernel(truth(LAW, vector, matrix, vector))
def grows(law: Any, own: Any, way: Any, cycle: Any) -> Any:
    """Whether moderate slip goes on at every part of the way, from both ends."""
    last = way.shape[0] - 1
    for sense in (1, -1):
        end = 0 if sense > 0 else last
        for k in range(1, last + 1):
            there = k if sense > 0 else last - k
            a, c = way[there, A], way[there, C]
            m, n = patch(law, own, way, end, there, k / last, cycle)
            left, right = leads(way, m + n, a, c)
            pull_left, pull_right = pulls(cycle[4], cycle[5], m + n)
            if not (
                m <= min(a, way[end, A])
                and n <= min(c, way[end, C])
                and pull_left >= sense * cycle[6] * left
                and pull_right >= sense * cycle[6] * right
            ):
                return False
    return True


# ---------------------------------------------------------------- large tension, dsigma >= 0


@kernel(matrix(matrix))
def mirrored(way: Any) -> Any:
    """The same way seen from behind."""
    behind = way.copy()
    for k in range(way.shape[0]):
        behind[k, A], behind[k, C] = way[k, C], way[k, A]
        behind[k, TILT], behind[k, MOMENT] = -way[k, TILT], -way[k, MOMENT]
    return behind


@kernel(truth(matrix, vector, real, real))
def holds_at_the_start(way: Any, cycle: Any, m: float, n: float) -> Any:
    """Whether shear that has not slipped yet stays within friction, from either end.

    Shear in full stick and pressure both change as a line over w; so it holds all over a slip zone
    to come if it does at its inner end, -m or n, and slip begins at its edge.
    """
    for sense in (1, -1):
        end = 0 if sense > 0 else way.shape[0] - 1
        a, c = way[end, A], way[end, C]
        left, right = leads(way, a + c, a, c)
        for side in (-1, 1):
            x = -m if side < 0 else n
            shear = cycle[4] - math.pi * cycle[5] * (x - (c - a) / 2) / 4
            pressure = (left * (c - x) + right * (a + x)) / (a + c)
            if not -side * shear >= -sense * cycle[6] * pressure:
                return False
    return True


@kernel(results(2)(real, real, real, real, real))
def _force_rates(slip: float, stuck: float, h: float, own_lead: float, other_lead: float) -> Any:
    """int dp sqrt((stuck + y)/y) dy and int dp sqrt(y/(stuck + y)) dy over one slip zone.

    dp = (own (h - s) + other s)/(pi h sqrt(s (h - s))) as the loads go on, s the distance from the
    zone's edge; `own` and `other` say how fast this edge and the other one are driven.
    """
    nodes = slip_nodes(np.empty(0), 1.0, 0.0, slip, slip, 1)
    near, far = 0.0, 0.0
    for i in range(nodes.shape[1]):
        y = nodes[0, i]
        s, beyond = slip - y, stuck + y
        dp = (own_lead * (h - s) + other_lead * s) / (math.pi * h * math.sqrt(s * (h - s)))
        force = nodes[1, i] * dp / math.sqrt(y * beyond)
        near += force * beyond
        far += force * y
    return near, far


@kernel(truth(matrix, vector, whole, real, real, real))
def _still_driven(way: Any, cycle: Any, k: int, sense: float, m: float, n: float) -> Any:
    """Whether both slip zones of large tension are growing, at a contact on the way.

    The shear that comes in with the next step, dQ, dsigma and +/- f dp in the slip zones, would
    be singular at the ends of the stick zone; it drives slip on there if it has the slip's sign.
    """
    a, c = way[k, A], way[k, C]
    if not (m < a and n < c and m + n > 0):
        return False
    left, right = leads(way, a + c, a, c)
    near_left, far_left = _force_rates(a - m, m + n, a + c, left, right)
    near_right, far_right = _force_rates(c - n, m + n, a + c, right, left)
    pull_left, pull_right = pulls(cycle[4], cycle[5], m + n)
    moving = sense * cycle[6]
    at_left = pull_left - moving * (near_left - far_right)
    at_right = pull_right - moving * (far_left - near_right)
    return at_left >= 0 and at_right <= 0


@kernel(truth(FRICTION, SLIP, real, real))
def _within_friction(of: Any, so_far: Any, m: float, n: float) -> Any:
    """Whether kappa dq > f (p1 - p) at places where slip is still to come.

    of, so_far: the cycle between the first contact and the one on the way, and its zone;
    [-m, n]: what sticks in the end.
    """
    for side in (-1, 1):
        end, now = (m, so_far.m) if side < 0 else (n, so_far.n)
        for k in range(PLACES):
            x = side * (end + (k + 0.5) / PLACES * (now - end))
            fallen = of.cycle[6] * (pressure_at(of, 0, x) - pressure_at(of, 2, x))
            if not fallen > 0 or not -so_far.m < x < so_far.n:
                continue
            if not -side * change(so_far, x) >= fallen * (1 - SLACK):
                return False
    return True


@kernel(truth(LAW, vector, matrix, vector, real, real, real))
def grows_apart(law: Any, own: Any, way: Any, cycle: Any, sense: float, m: float, n: float) -> Any:
    """Whether slip of opposite signs goes on at every part of the way, from both ends."""
    last = way.shape[0] - 1
    if not (m <= min(way[0, A], way[last, A]) and n <= min(way[0, C], way[last, C])):
        return False
    for direction in (1, -1):
        end = 0 if direction > 0 else last
        before_m, before_n = way[end, A], way[end, C]
        for k in range(1, last):
            there = k if direction > 0 else last - k
            a, c, part = way[there, A], way[there, C], k / last
            so_far = cycle.copy()
            so_far[0], so_far[1], so_far[2], so_far[3] = way[end, A], way[end, C], a, c
            so_far[4], so_far[5] = part * cycle[4], part * cycle[5]
            slip = large_slip(law, own, so_far, sense, AGREED)
            if not (
                slip.m <= min(before_m, a)
                and slip.n <= min(before_n, c)
                and _still_driven(way, cycle, there, direction, slip.m, slip.n)
                and _within_friction(friction(law, own, so_far, sense, -1.0, math.nan), slip, m, n)
            ):
                return False
            before_m, before_n = slip.m, slip.n
        if not (m <= before_m and n <= before_n):
            return False
        if not _still_driven(way, cycle, last - end, direction, m, n):
            return False
    return True
