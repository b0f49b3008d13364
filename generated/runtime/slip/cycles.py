r"""A half-cycle: its contacts, and the way of the loads from its start to its end.

Everything is for E* = 1.  All loads change in proportion.  At a contact of width h, with mid its
middle, and while a zone of width h_s sticks, the loads drive slip at the ends of that zone by

    drive = dQ + pi h_s dsigma/8 on the left,    dQ - pi h_s dsigma/8 on the right,

and the changes dP and dM move the edges of the contact at rates proportional to

    advance = dP + 4 (dM + mid dP)/h on the left,    dP - 4 (dM + mid dP)/h on the right.
"""

import math
from typing import Any, NamedTuple

from ..elementary import EPS
from ..inverse import contact
from ..kernels import kernel, shared

MAX_EDGE_ROUNDING = 1e-6
"""Largest shift of an edge due to rounding of the tilt, relative to the width."""


class Cycle(NamedTuple):
    """A half-cycle that raises the shear load, and the friction.

    a_1, c_1    the contact [-a_1, c_1] at its start
    a_2, c_2    the contact at its end
    dQ, dsigma  changes in the shear load and in the bulk tension
    f           coefficient of friction
    """

    a_1: float
    c_1: float
    a_2: float
    c_2: float
    dQ: float
    dsigma: float
    f: float


class State(NamedTuple):
    """What carries a contact: load, moment and tilt, and K_N at its edges."""

    load: float
    moment: float
    tilt: float
    K_left: float
    K_right: float


class Ends(NamedTuple):
    """The states of the contacts at the start and at the end of a half-cycle."""

    start: State
    end: State


@kernel
def cycle_of(row: Any) -> Cycle:
    """A half-cycle from a row: a_1, c_1, a_2, c_2, dQ, dsigma, any others, f, E*."""
    f, E_star = row[-2], row[-1]
    return Cycle(row[0], row[1], row[2], row[3], row[4] / E_star, row[5] / E_star, f)


@kernel
def ends_of(law: Any, own: Any, cycle: Any) -> Ends:
    """The states of both contacts."""
    load, moment, tilt, left, right = law.state(cycle.a_1, cycle.c_1, own)
    start = State(load, moment, tilt, left, right)
    if is_steady(cycle):
        return Ends(start, start)
    load, moment, tilt, left, right = law.state(cycle.a_2, cycle.c_2, own)
    return Ends(start, State(load, moment, tilt, left, right))


@kernel
def exists(cycle: Any, ends: Any) -> bool:
    """Whether both contacts exist and the changes in the loads and the friction are valid."""
    return (
        math.isfinite(ends.start.load + ends.start.tilt + ends.end.load + ends.end.tilt)
        and cycle.f > 0
        and 0 <= cycle.dQ < math.inf
        and math.isfinite(cycle.dsigma)
    )


@kernel
def slides(cycle: Any, ends: Any) -> bool:
    """Whether nothing sticks."""
    return not cycle.dQ < cycle.f * (ends.start.load + ends.end.load)


@kernel
def resolved(cycle: Any, ends: Any) -> bool:
    """Whether the tilts determine the edges.

    They do not if a flank makes up nearly all of the contact while a corner carries the load.  At a
    given load the last digit of the tilt moves an edge by about EPS tilt h**2/(2 P).
    """
    shift_1 = EPS * abs(ends.start.tilt) * (cycle.a_1 + cycle.c_1) / ends.start.load
    shift_2 = EPS * abs(ends.end.tilt) * (cycle.a_2 + cycle.c_2) / ends.end.load
    return max(shift_1, shift_2) <= MAX_EDGE_ROUNDING


@kernel
def is_steady(cycle: Any) -> bool:
    """Whether the contact is the same at the start and at the end."""
    return cycle.a_1 == cycle.a_2 and cycle.c_1 == cycle.c_2


@shared
def drives(cycle: Any, stuck: float) -> Any:
    """The drive of slip at both ends of a stick zone of given width."""
    by_tension = math.pi * stuck * cycle.dsigma / 8
    return cycle.dQ + by_tension, cycle.dQ - by_tension


@shared
def turning_width(dQ: float, dsigma: float) -> float:
    """The width of a stick zone at which slip is driven at one end only."""
    return 8 * dQ / (math.pi * abs(dsigma))


@kernel
def advances(ends: Any, a: float, c: float) -> Any:
    """The rates at which the loads advance the left and the right edge of the contact [-a, c]."""
    more, turn = ends.end.load - ends.start.load, ends.end.moment - ends.start.moment
    by_turning = 4 * (turn + (c - a) / 2 * more) / (a + c)
    return more + by_turning, more - by_turning


@kernel
def on_the_way(law: Any, own: Any, ends: Any, part: float) -> Any:
    """a, c and tilt of the contact after a part of the way from the start to the end."""
    first, last = ends.start, ends.end
    load = first.load + part * (last.load - first.load)
    return contact(law, own, load, first.moment + part * (last.moment - first.moment))


@kernel
def narrowest(law: Any, own: Any, cycle: Any, ends: Any) -> Any:
    """The smallest a and the smallest c on the way between both contacts.

    An edge may recede and then advance, for instance under a constant moment.  The right edge is at
    rest where dM + (mid - h/4) dP = 0.  There mid - h/4 = (c - 3 a)/4 changes by -(3/4) da, and da
    has the sign of dP.  An edge therefore turns round at most once, and only from receding to
    advancing.  Its least distance is exact, because it is at rest there.
    """
    least_a, least_c = min(cycle.a_1, cycle.a_2), min(cycle.c_1, cycle.c_2)
    for side in range(2):
        first = advances(ends, cycle.a_1, cycle.c_1)[side]
        last = advances(ends, cycle.a_2, cycle.c_2)[side]
        low, high = 0.0, 1.0
        while first < 0 < last and high - low > math.sqrt(EPS):
            part = (low + high) / 2
            a, c, _ = on_the_way(law, own, ends, part)
            if advances(ends, a, c)[side] < 0:
                low = part
            else:
                high = part
            if side == 0:
                least_a = min(least_a, a)
            else:
                least_c = min(least_c, c)
    return least_a, least_c
