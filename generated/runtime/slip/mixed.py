r"""Slip that reverses within a half-cycle at constant normal loads: the exact stick zone.

Tension loads the left edge more, dsigma > 0; otherwise the mirror image is considered.  While [-m,
n] sticks and the loads change in proportion, its right end is driven by dQ - pi dsigma (m + n)/8,
which vanishes at a width m + n = H = 8 dQ/(pi dsigma).  Between the moderate and the large regime a
half-cycle has three phases:

1. With slip as in large tension both ends recede until m + n = H, where n reaches its minimum.
2. The right edge sticks again, from n outward.  The new end is not loaded, so that m + n = H holds:

       dq/dlambda = (dsigma/4) sqrt((H - t)/t),    t = x + m,

   where lambda is the completed part of the half-cycle.  The rate at which m falls, Lambda =
   -dlambda/dm, follows from friction at -m, which is Abel's equation:

       (dsigma/4) int_m^m1 sqrt((H - t)/t) Lambda(mu) dmu = 2 f p(-m) - dq1(-m),    t = mu - m,

   with m1 and dq1 from the end of phase 1.  Where m passes a kink of the body, p contains d log d,
   d being the distance from the kink.  Lambda has a square root before the kink and none beyond it,
   and is therefore stored leg by leg.
3. All of the right edge sticks, m + c = H, and from then on it slips as in moderate tension.

Each half-cycle starts from the end of the other one, with the sign of shear reversed.  In phase 1
the reversed slip on the right therefore leaves 2 f p less the gain, the shear gained since the
point stuck again; the gain is 2 f p where phase 3 brought the point to the friction
limit.  The gain is found by iteration, as series of more and more terms, until m and n no longer
change.

The shear traction must not be driven further where it has been at the friction limit since the last
half-cycle: on the left, and on the right where nothing was gained.  In phase 1 its rate changes
sign at mid + H/2, where mid is the middle of the current stick zone.  This point is n when the
phase ends, and lies in neither of these regions when the phase begins.

In phases 1 and 3 slip grows as bounded.py describes, with the integrals L and R and dq; in phase 3
the gain is subtracted.  All functions of position take arrays.
"""

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import Chebyshev, chebpts1, chebvander
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq, root

from ..forward import breaks_of, each_pressure
from ..types import Array, Regime
from .cycles import turning_width
from .growth import FRICTION_RTOL
from .quadrature import SlipZone, double_exponential
from .zone import each_zone, each_zone_of_regime

TERMS = range(16, 65, 4)
"""Numbers of terms of the series in successive iterations; three to six iterations are common."""

ZONE_RTOL = 1e-7
"""m and n are exact if the last iteration changed them by less than this, relative to the contact
width; most iterations reduce the error by more than a factor of ten."""

MAX_STRIP = 1e-4
"""Width of the strip beyond the moderate zone in which the moderate solution holds, as
(a + n - H)/(a + c).  There n departs from it by about the square of this, and m far less."""

_RULE = double_exponential(1 / 6)
_GAUSS = np.array(leggauss(64)) / 2 + [[0.5], [0.0]]

Place = Callable[[Array], Array]
"""A function of position; it takes and returns arrays."""


# ---------------------------------------------------------------- slip that grows


def _change_by(zone: SlipZone, near: Array, far: Array) -> Array:
    """dq due to r in a slip zone (bounded.py), at given distances from this end of the stick zone
    and the other one."""
    y, stuck = zone.y, near + far
    singular = np.sqrt(y * (y + stuck[:, None])) * (y + near[:, None])
    total = np.sum(zone.weight * (zone.r - zone.at_start) / singular, axis=1)
    angle = np.arctan2(np.sqrt(zone.length * far), np.sqrt(near * (zone.length + stuck)))
    return (np.sqrt(near * far) * total + 2 * zone.at_start * angle) / math.pi


class _Slip(NamedTuple):
    """Slip beside [-m, n]: forward on the left, and in the direction lamda on the right."""

    m: float
    n: float
    lamda: float
    left: SlipZone
    right: SlipZone

    def integrals(self) -> Array:
        """L and R."""
        total = np.zeros(2)
        for zone, kappa, way in ((self.left, 1.0, 1), (self.right, self.lamda, -1)):
            u = np.sqrt(zone.y / (self.m + self.n + zone.y))
            total += kappa * np.sum(zone.weight * zone.r * [1 / u, u], axis=1)[::way]
        return total

    def change(self, x: Array) -> Array:
        """dq at x; if rounding puts x outside the stick zone, dq at its end."""
        from_left, from_right = np.maximum(x + self.m, 0.0), np.maximum(self.n - x, 0.0)
        by_right = _change_by(self.right, from_right, from_left)
        return _change_by(self.left, from_left, from_right) + self.lamda * by_right


class _HalfCycle(NamedTuple):
    """A half-cycle with dsigma > 0, or the mirror image of one.

    law    of the body
    own    the body's parameters, in one row
    sense  -1 for a mirror image
    a, c   edges of the contact, or of its mirror image
    cuts   breaks of the body
    H      the width of a stick zone whose right end is not driven
    """

    law: Any
    own: Array
    f: float
    sense: float
    a: float
    c: float
    dQ: float
    dsigma: float
    cuts: Array
    H: float

    def limit(self, x: Array) -> Array:
        """2 f p; zero at a corner."""
        given, p = np.ones((x.size, 4)), np.empty((x.size, 1))
        given[:, 0] = self.sense * x
        given[:, 1:3] = (self.a, self.c) if self.sense > 0 else (self.c, self.a)
        each_pressure(self.law, given, np.repeat(self.own, x.size, axis=0), p)
        return np.where(p < math.inf, 2 * self.f * p, 0.0)[:, 0]

    def slip(
        self, m: float, n: float, edge: float, lamda: float, rest: tuple[Place, Place], cut: float
    ) -> _Slip:
        """The slip from -m to the edge on the left, and from n to c.

        rest  the shear that slip leaves on the left and on the right, 2 f p less what was gained
        cut   where that on the right is not smooth
        """
        zones = []
        for side, start, length, left in ((-1, m, edge - m, rest[0]), (1, n, self.c - n, rest[1])):
            cuts = side * np.append(self.cuts, cut) - start
            ends = np.unique([0.0, *cuts[(cuts > 0) & (cuts < length)], length])
            widths = np.diff(ends)[:, None]
            y = np.append(ends[:-1, None] + widths * _RULE[0], 0.0)
            r = left(side * (start + y))
            zones.append(SlipZone(y[:-1], np.ravel(widths * _RULE[1]), r[:-1], length, r[-1]))
        return _Slip(m, n, lamda, *zones)


class _Leg(NamedTuple):
    """A part of phase 2, in which m falls from `top` by `span` sin(pi s/2)**2, s from 0 to `end`.

    rate  Lambda as a series in s
    """

    top: float
    span: float
    rate: Chebyshev
    end: float = 1.0

    @property
    def bottom(self) -> float:
        """m at the end."""
        return float(self.top - self.span * np.sin(np.pi / 2 * self.end) ** 2)

    def elapsed(self, s: float) -> float:
        """The part of the half-cycle up to s: span int_0^s (pi/2) sin(pi s) Lambda ds."""
        at = s * _GAUSS[0]
        rates = np.sin(np.pi * at) * self.rate(at)
        return float(np.pi / 2 * self.span * s * np.sum(_GAUSS[1] * rates))


class _State(NamedTuple):
    """What a half-cycle passes on to the next.

    m, n   the permanent stick zone
    end    points from n to `end` have stuck again
    rubs   whether points beyond `end` are at the friction limit, where 2 f p was gained; otherwise
           nothing was gained there
    rest   2 f p less the shear gained since points began to stick again
    """

    m: float
    n: float
    end: float
    rubs: bool
    rest: Place


# ---------------------------------------------------------------- the three phases


def _phase_1(of: _HalfCycle, begun: _State) -> tuple[float, _Slip]:
    """lambda and the slip when m + n = H; the search begins next to the last n.

    lambda is NaN if no such zone is found.
    """

    def slip(n: float) -> _Slip:
        return of.slip(of.H - n, n, of.a, -1.0, (of.limit, begun.rest), begun.end)

    def off(n: float) -> float:
        return float(slip(n).integrals()[1])

    least, most, near = of.H - of.a + 1e-12 * of.H, of.c - 1e-12 * of.H, 1e-3 * of.H
    for low, high in ((max(least, begun.n - near), min(most, begun.n + near)), (least, most)):
        if off(low) < 0 < off(high):
            found = slip(brentq(off, low, high, xtol=1e-12 * of.H))
            return found.integrals()[0] / (2 * of.dQ), found
    return math.nan, slip(least)


def _gained(of: _HalfCycle, legs: list[_Leg], x: Array) -> Array:
    """(dsigma/4) int sqrt((H - x - mu)/(x + mu)) Lambda dmu over the legs, while x sticks."""
    x, total = np.asarray(x)[..., None], np.zeros(np.shape(x))
    for leg in legs:
        distance = of.H - x - leg.top
        top = np.minimum(0.0, distance)
        length = np.maximum(leg.top + top - leg.bottom, 0.0)
        below_top = length * _RULE[0][::-1]
        s = 2 / np.pi * np.arcsin(np.sqrt(np.clip((below_top - top) / leg.span, 0.0, 1.0)))
        above, below = below_top + (distance - top), x + leg.bottom + length * _RULE[0]
        root_ = np.sqrt(np.where(length > 0, above / below, 0.0))
        total += np.sum(length * _RULE[1] * leg.rate(s) * root_, axis=-1)
    return of.dsigma / 4 * total


def _next_leg(
    of: _HalfCycle, dq: Place, before: list[_Leg], top: float, span: float, count: int
) -> _Leg:
    """The next leg, given those before it: Abel's equation at Chebyshev points.

    At m = top - span v**2 it is, with Lambda taken at v cos(phi) in place of v,

        int_0^(pi/2) sqrt(H/span - (v sin(phi))**2) cos(phi) Lambda dphi = right.
    """
    v = np.sin(np.pi / 4 * (chebpts1(count) + 1))
    x, phi = span * v**2 - top, np.pi / 2 * _GAUSS[0]
    right = (of.limit(x) - dq(x) - _gained(of, before, x)) * 2 / (of.dsigma * span * v)
    far = np.sqrt(np.maximum(of.H / span - np.outer(v, np.sin(phi)) ** 2, 0.0)) * np.cos(phi)
    t = 4 / np.pi * np.arcsin(np.outer(v, np.cos(phi))) - 1
    matrix = np.einsum("ij,ijk->ik", np.pi / 2 * _GAUSS[1] * far, chebvander(t, count - 1))
    return _Leg(top, span, Chebyshev(np.linalg.solve(matrix, right), domain=(0, 1)))


def _phase_2(of: _HalfCycle, first: _Slip, part: float, count: int) -> tuple[list[_Leg], float]:
    """The legs until all of the right edge sticks or the half-cycle ends, and lambda then.

    A new leg begins at each break, because Lambda has a square root before it.  No legs if the zone
    that never slips gets narrower than H/16.
    """
    legs, m, sticks_all_right = list[_Leg](), first.m, of.H - of.c
    least = max(sticks_all_right, of.H / 16 - first.n)
    while m > least:
        bottom = max([least, *(-at for at in of.cuts if least < -at < m)])
        leg = _next_leg(of, first.change, legs, m, m - bottom, count)
        at_end = part + leg.elapsed(1.0)
        if at_end >= 1:
            end = brentq(lambda s, leg, part: part + leg.elapsed(s) - 1, 0.0, 1.0, (leg, part))
            return [*legs, leg._replace(end=end)], 1.0
        legs, m, part = [*legs, leg], leg.bottom, at_end
    return (legs, part) if least == sticks_all_right else ([], part)


def _phase_3(
    of: _HalfCycle, m: float, part: float, rest: tuple[Place, Place], cut: float, begun: _State
) -> _Slip | None:
    """The slip in the contact [-m, c], whose width is H.

    The unknowns are the logarithms of the ratios of both slip zones to the stick zone.  At the
    start of phase 3 the left edge is driven by 2 dQ and the right one not at all; later the right
    one is driven in proportion to the loss of width of the stick zone.
    """
    dQ, growth = part * of.dQ, np.pi * part * of.dsigma / 8
    last = np.array([m - begun.m, of.c - begun.end]) / (begun.m + begun.end)

    def slip(logarithms: Array) -> _Slip:
        ratios = np.exp(logarithms)
        left, right = of.H * ratios / (1 + np.sum(ratios))
        return of.slip(m - left, of.c - right, m, 1.0, rest, cut)

    def off(logarithms: Array) -> Array:
        found = slip(logarithms)
        growing = (found.m + found.n) * growth
        return (found.integrals() - dQ - [growing, -growing]) / dQ

    found = root(off, np.log(np.where(last > 1e-9, last, 0.1)), method="lm", tol=1e-12)
    return slip(found.x) if np.max(np.abs(found.fun)) < 1e-9 else None


def _tabulated(values: Place, start: float, end: float, count: int) -> Place:
    """A function as a series, analytic in the square roots of the distances from both ends."""
    length = end - start
    series = Chebyshev.interpolate(
        lambda s: values(start + length * np.sin(np.pi / 2 * s) ** 2), count - 1, domain=(0, 1)
    )
    return lambda x: series(2 / np.pi * np.arcsin(np.sqrt(np.clip((x - start) / length, 0, 1))))


def _half_cycle(of: _HalfCycle, begun: _State, count: int) -> _State | None:
    """The state at the end of a half-cycle, by series with `count` terms; None if it does not have
    these phases."""
    part, first = _phase_1(of, begun)
    if not 0 < part < 1:
        return None
    legs, part = _phase_2(of, first, part, count)
    s = (chebpts1(count) + 1) / 2
    if not legs or min(np.min(leg.rate(leg.end * s)) for leg in legs) < 0:
        return None
    m, n = legs[-1].bottom, first.n
    end = min(of.H - m, of.c)
    gain = _tabulated(partial(_gained, of, legs), n, end, count)

    def right(x: Array) -> Array:
        return of.limit(x) - np.where(x < end, gain(x), 0.0)

    if part == 1:
        return _State(m, n, end, False, right)

    def left(x: Array) -> Array:
        x = np.maximum(x, -m)
        return of.limit(x) - _gained(of, legs, x) - first.change(x)

    third = _phase_3(of, m, 1 - part, (left, right), n, begun)
    if third is None or third.m + n < 0:
        return None
    start = n if n < third.n else 2 * third.n - of.c
    at_end = _tabulated(lambda x: gain(x) + third.change(x), start, third.n, count)

    def rest(x: Array) -> Array:
        return np.where(x < third.n, of.limit(x) - at_end(x), 0.0)

    return _State(third.m, n, third.n, True, rest)


def _is_sound(of: _HalfCycle, state: _State, count: int) -> bool:
    """Whether the shear traction stays within the friction limit where points stick again, and is
    not driven further where it is at that limit."""
    if not state.n < state.end <= of.c:
        return False
    turns = (of.c - of.a) / 2 + of.H / 2
    last = of.c if state.rubs else state.end
    at_points = np.sin(np.pi / 4 * (chebpts1(count) + 1)) ** 2  # where the series is exact
    x = state.n + (state.end - state.n) * at_points
    limit, rest = of.limit(x), state.rest(x)
    excess = np.max(np.maximum(-rest, rest - limit))
    return bool(-state.m <= turns <= last and excess <= FRICTION_RTOL * np.max(limit))


def _by_phases(of: _HalfCycle, m: float, n: float) -> tuple[float, float]:
    """m and n of a half-cycle; NaN unless it has the phases and the iteration converges.

    m, n: a first guess
    """
    last = _State(m, n, n, False, of.limit)
    for count in TERMS:
        state = _half_cycle(of, last, count)
        if state is None:
            break
        if max(abs(state.m - last.m), abs(state.n - last.n)) <= ZONE_RTOL * (of.a + of.c):
            return (state.m, state.n) if _is_sound(of, state, count) else (math.nan, math.nan)
        last = state
    return math.nan, math.nan


def _mixed_zone(law: Any, cycle: Array, own: Array) -> tuple[float, float]:
    """m and n of a cycle of constant loads in which slip reverses; NaN if they are not found.

    cycle: a_1, c_1, a_2, c_2, dQ, dsigma, f, E*
    """
    a, c, _, _, dQ, dsigma, f, E_star = cycle
    dQ, dsigma = dQ / E_star, dsigma / E_star
    if not (dQ > 0 and dsigma != 0):
        return math.nan, math.nan
    sense, H, moderate = math.copysign(1.0, dsigma), turning_width(dQ, dsigma), np.empty((1, 2))
    given = np.array([[a, c, a, c, dQ, dsigma, Regime.MODERATE, f, 1.0]])
    each_zone_of_regime(law, given, own, moderate)
    (a, c), (m, n) = (pair[:: int(sense)] for pair in ((a, c), moderate[0]))
    if not 0 < a + n - H <= MAX_STRIP * (a + c):
        cuts = sense * breaks_of(law, own[0])
        m, n = _by_phases(_HalfCycle(law, own, f, sense, a, c, dQ, abs(dsigma), cuts, H), m, n)
    return (m, n) if sense > 0 else (n, m)


def each_mixed_zone(law: Any, given: Array, own: Array, out: Array) -> None:
    """each_zone, with the zones of mixed cycles at constant normal loads that it does not know."""
    each_zone(law, given, own, out)
    steady = np.all(given[:, :2] == given[:, 2:4], axis=1)
    for i in np.flatnonzero(steady & (out[:, 2] == Regime.MIXED) & np.isnan(out[:, 0])):
        with np.errstate(all="ignore"):
            out[i, :2] = _mixed_zone(law, given[i], own[i, None])
        if math.isnan(out[i, 0]):
            out[i, 2] = Regime.UNSOLVED
