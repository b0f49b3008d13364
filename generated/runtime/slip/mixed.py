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
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import Chebyshev, chebpts1, chebvander
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq, root

from ..arrays import solved
from ..body import Body
from ..cycle import Own, pressure
from ..forward import UNIT, breaks_of
from ..kernels import kernel, loop, opened, shared
from ..types import Array, Edges, Regime, StickZone
from .bounded import change_between, integrals, slipping
from .cycles import Cycle, turning_width
from .growth import FRICTION_RTOL
from .quadrature import ROUGH, SlipZone, cut_rule, double_exponential, limit
from .zone import each_zone_of_regime

TERMS = range(16, 65, 4)
"""Numbers of terms of the series in successive iterations; three to six iterations are common."""

ZONE_RTOL = 1e-7
"""m and n are exact if the last iteration changed them by less than this, relative to the contact
width; most iterations reduce the error by more than a factor of ten."""

MAX_STRIP = 1e-4
"""Width of the strip beyond the moderate zone in which the moderate solution stands in for series
that fail, as (a + n - H)/(a + c).  It is off by less than the square of this."""

NO_GAIN = np.array([0.0, -math.inf, 0.0, 0.0, 0.0])

_RULE = double_exponential(1 / 6)
_GAUSS = np.array(leggauss(64)) / 2 + [[0.5], [0.0]]

Place = Callable[[Array], Array]
"""A function of position; it takes and returns arrays."""


# ---------------------------------------------------------------- slip that grows


def _gain(
    gained: Place, start: float, end: float, count: int, near: float = 0.0, rubs: bool = False
) -> Array:
    """The shear gained since points began to stick again, as a series between `start` and `end`.

    It is a row of start, end, near, rubs and the coefficients of the series.

    near = 0: analytic in the square roots of the distances from both ends
    near > 0: analytic in sqrt(y) and sqrt(y + near), y = x - start
    rubs:     whether points beyond `end` are at the friction limit, where the gain is 2 f p;
              otherwise nothing was gained there
    """

    def values(s: Array) -> Array:
        if near > 0:
            return gained(
                start + near * np.sinh(np.arcsinh(np.sqrt((end - start) / near)) * s) ** 2
            )
        return gained(start + (end - start) * np.sin(np.pi / 2 * s) ** 2)

    series = Chebyshev.interpolate(values, count - 1, domain=(0, 1))
    return np.array([start, end, near, rubs, *series.coef])


@shared
def _gain_at(gain: Array, x: Array) -> Array:
    """The gain at x up to its end; before its start, that at the start."""
    length, near = gain[1] - gain[0], gain[2]
    y = np.minimum(np.maximum(x - gain[0], 0.0), length)
    if near > 0:
        s = np.arcsinh(np.sqrt(y / near)) / np.arcsinh(np.sqrt(length / near))
    else:
        s = 2 / np.pi * np.arcsin(np.sqrt(y / length))
    t, last = 4 * s - 2, 0 * s
    before = last
    for k in range(gain.size - 1, 4, -1):
        last, before = t * last - before + gain[k], last
    return t / 2 * last - before + gain[4]


@kernel
def _zone(law: Any, own: Any, row: Any, side: float, gain: Any) -> SlipZone:
    """The slip zone on one side, where slip leaves 2 f p less the gain."""
    f, sense, a, c, m, n, edge, _ = row
    start, length = (m, edge - m) if side < 0 else (n, c - n)
    cuts = np.append(sense * law.breaks(own), gain[:2]) * side - start
    y, weight = cut_rule(length, cuts, ROUGH)
    a, c = (a, c) if sense > 0 else (c, a)
    cycle, r = Cycle(a, c, a, c, 0.0, 0.0, f), np.empty(y.size + 1)
    for i in range(r.size):
        x = side * (start + (y[i] if i < y.size else 0.0))
        r[i] = limit(law, own, cycle, sense * x)
        if x < gain[1]:
            r[i] -= _gain_at(gain, x)
        elif gain[3] > 0:
            r[i] = 0.0
    return SlipZone(y, weight, r[:-1], length, r[-1])


@loop
def each_change(
    law: Any, given: Any, left: Any, right: Any, points: Any, own: Any, out: Any
) -> None:
    """f, sense, a, c, m, n, edge on the left, lamda -> L, R, then dq at points that stick."""
    law, row = opened(law), given[0]
    f, _, a, c, m, n, _, lamda = row
    at_left = _zone(law, own[0], row, -1.0, left[0])
    at_right = _zone(law, own[0], row, 1.0, right[0])
    near, far, _, _ = integrals(at_left, m + n)
    near_2, far_2, _, _ = integrals(at_right, m + n)
    out[0, 0], out[0, 1] = near + lamda * far_2, far + lamda * near_2
    of = slipping(Cycle(a, c, a, c, 0.0, 0.0, f), 1.0, lamda)
    for i in range(points.shape[1]):
        out[0, i + 2] = change_between(of, at_left, at_right, m, n, points[0, i])


class _HalfCycle(NamedTuple):
    """A half-cycle with dsigma > 0, or the mirror image of one.

    a, c   edges of the contact, or of its mirror image, which has sense -1
    cuts   breaks of the body
    H      the width of a stick zone whose right end is not driven
    """

    body: Body
    own: Own
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
        a, c = (self.a, self.c) if self.sense > 0 else (self.c, self.a)
        p = pressure(self.body, self.own, self.sense * x, a, c, 1.0)
        return np.where(p < math.inf, 2 * self.f * p, 0.0)

    def slipped(self, zone: tuple[float, ...], gains: tuple[Array, Array], x: Array) -> Array:
        """L and R of the slip zones from -m to an edge and from n to c, then dq at x.

        zone: m, n, the edge on the left, and lamda
        """
        own, row = np.array([[*self.own.values()]]), np.array([[*self[2:6], *zone]])
        points, tables = np.reshape(x, (1, -1)), [gain[None] for gain in gains]
        out = np.empty((1, 2 + points.size))
        each_change(self.body.law, row, *tables, points, own, out)  # type: ignore[call-arg]
        return out[0]


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

    m, n         the permanent stick zone; NaN unless the half-cycle has these phases
    gain         the gain on the right
    ratios       slip zones of phase 3 over the stick zone, a first guess for the next one
    """

    m: float = math.nan
    n: float = math.nan
    gain: Array = NO_GAIN
    ratios: tuple[float, float] = (0.0, 0.0)


# ---------------------------------------------------------------- the three phases


def _phase_1(of: _HalfCycle, begun: _State) -> tuple[float, float, float, Place]:
    """m, n, lambda and dq when m + n = H; the search begins next to the last n."""
    gains = NO_GAIN, begun.gain

    def off(n: float) -> Any:
        return of.slipped((of.H - n, n, of.a, -1.0), gains, ())[1]

    least, most, near = of.H - of.a + 1e-12 * of.H, of.c - 1e-12 * of.H, 1e-3 * of.H
    for low, high in ((max(least, begun.n - near), min(most, begun.n + near)), (least, most)):
        if off(low) < 0 < off(high):
            break
    else:
        return math.nan, math.nan, math.nan, of.limit
    n = brentq(off, low, high, xtol=1e-12 * of.H)
    zone = of.H - n, n, of.a, -1.0
    part = of.slipped(zone, gains, ())[0] / (2 * of.dQ)
    return of.H - n, n, part, lambda x: of.slipped(zone, gains, x)[2:]


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


def _phase_2(
    of: _HalfCycle, dq: Place, m: float, part: float, middle: float, count: int
) -> tuple[list[_Leg], float]:
    """The legs until all of the right edge sticks or the half-cycle ends, and lambda then.

    A new leg begins at each break, because Lambda has a square root before it.  No legs if m passes
    `middle`.
    """
    sticks_all_right, legs = of.H - of.c, list[_Leg]()
    least = max(sticks_all_right, -middle)
    while m > least:
        bottom = max([least, *(-at for at in of.cuts if least < -at < m)])
        leg = _next_leg(of, dq, legs, m, m - bottom, count)
        at_end = part + leg.elapsed(1.0)
        if at_end >= 1:
            end = brentq(lambda s, leg, part: part + leg.elapsed(s) - 1, 0.0, 1.0, (leg, part))
            return [*legs, leg._replace(end=end)], 1.0
        legs, m, part = [*legs, leg], leg.bottom, at_end
    whole = sticks_all_right >= -middle and part < 1
    return (legs, part) if whole else ([], math.nan)


def _phase_3(
    of: _HalfCycle, m: float, part: float, gains: tuple[Array, Array], begun: _State
) -> tuple[float, float, Place]:
    """The slip zones in the contact [-m, c], whose width is H, and dq.

    The unknowns are the logarithms of the ratios of both slip zones to the stick zone.  The first
    guess takes the remaining friction at both edges as square roots.  At the start of phase 3 the
    left edge is driven by 2 dQ and the right one not at all; later the right one is driven in
    proportion to the loss of width of the stick zone.
    """
    dQ, growth = part * of.dQ, np.pi * part * of.dsigma / 8
    first, least = begun.ratios, 1e-9
    if not first[0] > 0:
        x = np.array([1e-4 * of.H - m, of.c - 1e-4 * of.H])
        rest = 50 * np.pi * (of.limit(x) - [_gain_at(*v) for v in zip(gains, x, strict=True)])
        left = min(2 * dQ / of.H / max(rest[0], least * dQ / of.H), 0.25)
        first = left, min(max(growth * left / max(rest[1] - growth, least * growth), least), 0.25)

    def lengths(logarithms: Array) -> Array:
        ratios = np.exp(logarithms)
        return of.H * ratios / (1 + np.sum(ratios))

    def off(logarithms: Array) -> Array:
        left, right = lengths(logarithms)
        stuck = of.H - left - right
        L, R = of.slipped((m - left, of.c - right, m, 1.0), gains, ())
        return np.array([L - dQ - stuck * growth, R - dQ + stuck * growth]) / dQ

    for method in ("hybr", "lm"):
        found = root(off, np.log(first), method=method, tol=1e-12)
        if np.max(np.abs(found.fun)) < 1e-9:
            break
    else:
        return math.nan, math.nan, of.limit
    left, right = lengths(found.x)
    zone = m - left, of.c - right, m, 1.0
    return left, right, lambda x: of.slipped(zone, gains, x)[2:]


def _half_cycle(of: _HalfCycle, middle: float, begun: _State, count: int) -> _State:
    """The zone and the gain at the end of a half-cycle, by series with `count` terms."""
    nothing, s = _State(gain=begun.gain), (chebpts1(count) + 1) / 2
    m_1, n_1, part, dq_1 = _phase_1(of, begun)
    if not (0 < part < 1 and -m_1 < middle < n_1 and m_1 <= of.a):
        return nothing
    legs, part = _phase_2(of, dq_1, m_1, part, middle, count)
    if not legs or min(np.min(leg.rate(leg.end * s)) for leg in legs) < 0:
        return nothing
    m, gained = legs[-1].bottom, partial(_gained, of, legs)
    gain = _gain(gained, n_1, min(of.H - m, of.c), count)
    if part == 1:
        return _State(m, n_1, gain)

    middle_right = (middle + n_1) / 2
    gain_left = _gain(lambda x: gained(x) + dq_1(x), -m, middle_right, count, near=m_1 - m)
    left, right, dq_3 = _phase_3(of, m, 1 - part, (gain_left, gain), begun)
    n = of.c - right
    if not (left < m + middle_right and left - m < middle < n):
        return nothing
    start = n_1 if n > n_1 else 2 * n - of.c
    at_end = _gain(lambda x: _gain_at(gain, x) + dq_3(x), start, n, count, rubs=True)
    stuck = of.H - left - right
    return _State(m - left, n_1, at_end, (left / stuck, right / stuck))


def _is_sound(of: _HalfCycle, state: _State, count: int) -> bool:
    """Whether the shear traction stays within the friction limit where points stick again, and is
    not driven further where it is at that limit."""
    end, _, rubs = state.gain[1:4]
    if not state.n < end <= of.c:
        return False
    turns = (of.c - of.a) / 2 + of.H / 2
    last = of.c if rubs else end
    at_points = np.sin(np.pi / 4 * (chebpts1(count) + 1)) ** 2  # where the series is exact
    x = state.n + (end - state.n) * at_points
    limit, gained = of.limit(x), _gain_at(state.gain, x)
    excess = np.max(np.maximum(-gained, gained - limit))
    return bool(-state.m <= turns <= last and excess <= FRICTION_RTOL * np.max(limit))


def _by_phases(of: _HalfCycle) -> tuple[float, float]:
    """m and n of a half-cycle; NaN unless it has the phases and the iteration converges."""
    state = _State()
    m_1, n_1, _, _ = _phase_1(of, state)
    middle = n_1 - (m_1 + n_1) / 4
    for count in TERMS:
        last, state = state, _half_cycle(of, middle, state, count)
        if max(abs(state.m - last.m), abs(state.n - last.n)) <= ZONE_RTOL * (of.a + of.c):
            return (state.m, state.n) if _is_sound(of, state, count) else (math.nan, math.nan)
    return math.nan, math.nan


def _mixed_zone(
    body: Body, own: Own, a: float, c: float, dQ: float, dsigma: float, f: float
) -> tuple[float, float]:
    """m and n of a cycle of constant loads in which slip reverses; NaN if they are not found.

    Just beyond the end of the moderate zone, series may fail.  There n departs from the moderate
    solution as the square of (a + n - H)/(a + c), and m departs far less.
    """
    if not (dQ > 0 and dsigma != 0):
        return math.nan, math.nan
    sense, H = math.copysign(1.0, dsigma), turning_width(dQ, dsigma)
    near, far = (a, c) if sense > 0 else (c, a)
    cuts, loads = sense * breaks_of(body, own), (dQ, abs(dsigma))
    of = _HalfCycle(body, own, f, sense, near, far, *loads, cuts, H)
    m, n = _by_phases(of)
    if math.isnan(m):
        cycle = {"a_1": a, "c_1": c, "a_2": a, "c_2": c, "dQ": dQ, "dsigma": dsigma}
        cycle["regime"] = Regime.MODERATE
        found = solved(each_zone_of_regime, body, cycle, {"f": f, **UNIT}, own, Edges)
        if 0 < near + found[sense > 0] - H <= MAX_STRIP * (a + c):
            return found
    return (m, n) if sense > 0 else (n, m)


def with_mixed(
    body: Body, names: Iterable[str], numbers: dict[str, Any], zone: StickZone
) -> StickZone:
    """Stick zones, and those of mixed cycles at constant normal loads that are not known yet.

    names: names of the body's parameters
    numbers: the arguments of stick_zone, by name
    """
    m, n, regime = map(np.array, zone)
    full = {name: np.broadcast_to(value, m.shape) for name, value in numbers.items()}
    for case in map(tuple, np.argwhere((regime == Regime.MIXED) & np.isnan(m))):
        here = {name: value[case] for name, value in full.items()}
        own = {name: here.pop(name) for name in names}
        a, c, a_2, c_2, dQ, dsigma, f, E_star = here.values()
        if a == a_2 and c == c_2:
            with np.errstate(all="ignore"):
                m[case], n[case] = _mixed_zone(body, own, a, c, dQ / E_star, dsigma / E_star, f)
            regime[case] = Regime.UNSOLVED if math.isnan(m[case]) else Regime.MIXED
    return StickZone(m[()], n[()], regime[()])
