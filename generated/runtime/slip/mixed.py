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
point stuck again; the gain is 2 f p where phase 3 brought the point to the friction limit.  The
gain is found by iteration, as series of more and more terms, until m and n no longer change.

The shear traction must not be driven further where it has been at the friction limit since the last
half-cycle: on the left, and on the right where nothing was gained.  In phase 1 its rate changes
sign at mid + H/2, where mid is the middle of the current stick zone.  This point is n when the
phase ends, and lies in neither of these regions when the phase begins.

In phases 1 and 3 slip grows as bounded.py describes, which solves for the slip zones: in phase 1
for those beside a stick zone of the width H, in phase 3 for those in the contact [-m, c], whose
width is H.  All functions of position take arrays.
"""

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebinterpolate, chebpts1, chebval, chebvander

from ..forward import breaks_of, each_pressure
from ..search import between, narrowed
from ..types import Array, Regime
from .bounded import Slipping, change_between, newton, placed
from .cycles import Cycle, turning_width
from .growth import FRICTION_RTOL
from .quadrature import ROUGH, SlipZone, cut_rule, double_exponential
from .zone import each_zone, each_zone_of_regime

TERMS = range(16, 65, 4)
"""Numbers of terms of the series in successive iterations; three to six iterations are common."""

ZONE_RTOL = 1e-7
"""m and n are exact if the last iteration changed them by less than this, relative to the contact
width; most iterations reduce the error by more than a factor of ten."""

MAX_STRIP = 1e-4
"""Width of the strip beyond the moderate zone in which the moderate solution holds, as
(a + n - H)/(a + c).  There n departs from it by about the square of this, and m far less."""

_RULE = double_exponential(1 / 16)

Place = Callable[[Array], Array]
"""A function of position; it takes and returns arrays."""


# ---------------------------------------------------------------- functions of position


def _points(start: float, stop: float, t: Array) -> Array:
    """The points between `start` and `stop` at which a series has the argument t."""
    return start + (stop - start) * np.sin(np.pi / 4 * (t + 1)) ** 2


def _arguments(part: Array) -> Array:
    """The arguments of a series, from -1 to 1, at parts of the way from its start to its stop."""
    return 4 / np.pi * np.arcsin(np.sqrt(np.clip(part, 0.0, 1.0))) - 1


class _Series(NamedTuple):
    """A function of x between `start` and `stop`, which is zero beyond `stop`.

    It is analytic in the square roots of the distances from both: x = start + (stop - start)
    sin(pi (t + 1)/4)**2, with Chebyshev polynomials of t.
    """

    start: float
    stop: float
    terms: Array

    def __call__(self, x: Array) -> Array:
        """The values at points x; that of the start before it."""
        t = _arguments((x - self.start) / (self.stop - self.start))
        return np.where(x < self.stop, chebval(t, self.terms), 0.0)

    def integral(self, x: float) -> float:
        """The integral from the start to x."""
        length = x - self.start
        return float(length * np.sum(_RULE[1] * self(self.start + length * _RULE[0])))


def _tabulated(values: Place, start: float, stop: float, count: int) -> _Series:
    """A function as a series with `count` terms."""
    terms = chebinterpolate(lambda t: values(_points(start, stop, t)), count - 1)
    return _Series(start, stop, terms)


# ---------------------------------------------------------------- a half-cycle


class _HalfCycle(NamedTuple):
    """A half-cycle with dsigma > 0, or the mirror image of one.

    law    of the body
    own    the body's parameters, in one row
    sense  -1 for a mirror image
    cuts   breaks of the body
    cycle  contact, loads and friction
    H      the width of a stick zone whose right end is not driven
    """

    law: Any
    own: Array
    sense: float
    cuts: Array
    cycle: Cycle
    H: float

    def limit(self, x: Array) -> Array:
        """2 f p; zero at a corner."""
        edges = self.cycle[:2][:: int(self.sense)]
        given, p = np.tile([0.0, *edges, 2 * self.cycle.f], (x.size, 1)), np.empty((x.size, 1))
        given[:, 0] = self.sense * x
        each_pressure(self.law, given, np.repeat(self.own, x.size, axis=0), p)
        return np.where(p < math.inf, p, 0.0)[:, 0]


class _State(NamedTuple):
    """What a half-cycle passes on to the next.

    m, n   the permanent stick zone
    gain   the shear gained beyond n since points stuck again, up to the last of them
    reach  where the slip zone of phase 1 ends: at the edge, or where the gain reaches 2 f p
    """

    m: float
    n: float
    gain: _Series
    reach: float


def _zones(body: Any, of: Slipping, left: float, right: float) -> Any:
    """Slip zones of given lengths, which leave 2 f p less what was gained.

    body: the half-cycle, what was gained on the left and on the right, and where the latter is not
        smooth
    """
    half, gains, cut = body
    zones = []
    for side, start, length, gain in (
        (-1, of.a - left, left, gains[0]),
        (1, of.c - right, right, gains[1]),
    ):
        y, weight = cut_rule(length, side * np.append(half.cuts, cut) - start, ROUGH)
        x = side * (start + np.append(y, 0.0))
        r = half.limit(x) - gain(x)
        zones.append(SlipZone(y, weight, r[:-1], length, r[-1]))
    return zones


# ---------------------------------------------------------------- phase 2


def _gains(of: _HalfCycle, start: float, stop: float, count: int, x: Array) -> Array:
    """The shear gained at points x in a leg, per term of its series for Lambda:
    (dsigma/4) int sqrt((H - t)/t) T_k dmu while they stick, 0 < t < H."""
    x, (q, weight) = x[:, None], _RULE
    low, high = np.maximum(start, x - of.H), np.minimum(stop, x)
    length = np.maximum(high - low, 0.0)
    t = np.maximum(x - stop, 0.0) + length * q
    rest = np.maximum(start + of.H - x, 0.0) + length * q[::-1]  # H - t
    factors = of.cycle.dsigma / 4 * length * weight * np.sqrt(rest / t)
    terms = chebvander(_arguments((low - start + length * q[::-1]) / (stop - start)), count - 1)
    gains: Array = np.einsum("ij,ijk->ik", factors, terms)
    return gains


def _gained(of: _HalfCycle, legs: list[_Series], x: Array) -> Array:
    """The shear gained at points x in all legs."""
    return sum((_gains(of, *leg[:2], leg.terms.size, x) @ leg.terms for leg in legs), 0.0 * x)


def _leg(
    of: _HalfCycle, dq: Place, before: list[_Series], start: float, stop: float, count: int
) -> _Series:
    """Lambda while the left end moves on from x = start to x = stop, given the legs before: Abel's
    equation at the points of a series."""
    x = _points(start, stop, chebpts1(count))
    right = of.limit(x) - dq(x) - _gained(of, before, x)
    return _Series(start, stop, np.linalg.solve(_gains(of, start, stop, count, x), right))


def _phase_2(
    of: _HalfCycle, dq: Place, n: float, part: float, count: int
) -> tuple[list[_Series], float]:
    """The legs until all of the right edge sticks or the half-cycle ends, and lambda then.

    A new leg begins at each break, because Lambda has a square root before it.  No legs if the zone
    that never slips gets narrower than H/16.
    """
    legs, start, sticks_all_right = list[_Series](), n - of.H, of.cycle.c_1 - of.H
    last = min(sticks_all_right, n - of.H / 16)
    while start < last:
        stop = min([last, *of.cuts[(start < of.cuts) & (of.cuts < last)]])
        leg = _leg(of, dq, legs, start, stop, count)
        at_stop = part + leg.integral(stop)
        if at_stop >= 1:
            search = between(start, stop, math.nan, of.H)
            while search.step > 0:
                value = part + leg.integral(search.y) - 1
                search = narrowed(search, value, float(leg(search.y)))
            return [*legs, _leg(of, dq, legs, start, search.y, count)], 1.0
        legs, start, part = [*legs, leg], stop, at_stop
    return (legs, part) if last == sticks_all_right else ([], part)


# ---------------------------------------------------------------- all phases


def _half_cycle(of: _HalfCycle, begun: _State, count: int) -> _State | None:
    """The state at the end of a half-cycle, by series with `count` terms; None if it does not have
    three phases, or two."""
    a, c = of.cycle.a_1, of.cycle.c_1
    opens = Slipping(of.cycle, 1.0, -1.0, a, begun.reach)
    body: Any = of, (np.zeros_like, begun.gain), begun.gain.stop
    n, part = placed(_zones, body, opens, of.H, begun.n)
    if not 0 < part < 1:
        return None
    zones = _zones(body, opens, a - (of.H - n), begun.reach - n)
    first = partial(change_between, opens, zones, of.H - n, n)
    legs, part = _phase_2(of, first, n, part, count)
    if not legs or min(np.min(leg(_points(*leg[:2], chebpts1(count)))) for leg in legs) < 0:
        return None
    m = -legs[-1].stop
    gain = _tabulated(partial(_gained, of, legs), n, min(of.H - m, c), count)
    if part == 1:
        return _State(m, n, gain, c)

    def held(x: Array) -> Array:
        x = np.maximum(x, -m)
        return _gained(of, legs, x) + first(x)

    rest = of.cycle._replace(dQ=(1 - part) * of.cycle.dQ, dsigma=(1 - part) * of.cycle.dsigma)
    closes, body = Slipping(rest, 1.0, 1.0, m, c), (of, (held, gain), n)
    before = np.array([m - begun.m, c - begun.gain.stop])
    left, right = newton(_zones, body, closes, *np.where(before > 1e-9 * of.H, before, of.H / 12))
    zones, end, m = _zones(body, closes, left, right), c - right, m - left
    if not m + n >= 0:
        return None
    change = partial(change_between, closes, zones, m, end)
    start = n if n < end else 2 * end - c  # not sound, but the next iteration may be
    return _State(m, n, _tabulated(lambda x: gain(x) + change(x), start, end, count), end)


def _is_sound(of: _HalfCycle, state: _State, count: int) -> bool:
    """Whether the shear traction stays within the friction limit where points stick again, and is
    not driven further where it is at that limit."""
    c, end = of.cycle.c_1, state.gain.stop
    if not state.n < end <= c:
        return False
    turns = (c - of.cycle.a_1) / 2 + of.H / 2
    last = c if state.reach == end else end
    x = _points(state.n, end, chebpts1(count))  # where the series is exact
    limit, gain = of.limit(x), state.gain(x)
    excess = np.max(np.maximum(gain - limit, -gain))
    return bool(-state.m <= turns <= last and excess <= FRICTION_RTOL * np.max(limit))


def _by_phases(of: _HalfCycle, m: float, n: float) -> tuple[float, float]:
    """m and n of a half-cycle; NaN unless it has the phases and the iteration converges.

    m, n: a first guess
    """
    last = _State(m, n, _Series(-m, n, np.zeros(1)), of.cycle.c_1)
    small = ZONE_RTOL * (of.cycle.a_1 + of.cycle.c_1)
    for count in TERMS:
        state = _half_cycle(of, last, count)
        if state is None:
            break
        if max(abs(state.m - last.m), abs(state.n - last.n)) <= small:
            return (state.m, state.n) if _is_sound(of, state, count) else (math.nan, math.nan)
        last = state
    return math.nan, math.nan


def _mixed_zone(law: Any, row: Array, own: Array) -> tuple[float, float]:
    """m and n of a cycle of constant loads in which slip reverses; NaN if they are not found.

    row: a_1, c_1, a_2, c_2, dQ, dsigma, f, E*
    """
    a, c, _, _, dQ, dsigma, f, E_star = row
    dQ, dsigma = dQ / E_star, dsigma / E_star
    if not (dQ > 0 and dsigma != 0):
        return math.nan, math.nan
    sense, H, moderate = math.copysign(1.0, dsigma), turning_width(dQ, dsigma), np.empty((1, 2))
    given = np.array([[a, c, a, c, dQ, dsigma, Regime.MODERATE, f, 1.0]])
    each_zone_of_regime(law, given, own, moderate)
    (a, c), (m, n) = (pair[:: int(sense)] for pair in ((a, c), moderate[0]))
    if not 0 < a + n - H <= MAX_STRIP * (a + c):
        cycle, cuts = Cycle(a, c, a, c, dQ, abs(dsigma), f), sense * breaks_of(law, own[0])
        m, n = _by_phases(_HalfCycle(law, own, sense, cuts, cycle, H), m, n)
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
