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
limit.  The gain is found by iteration, as series of more and more terms, until m and n converge.

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
from scipy.optimize import brentq, root

from ..arrays import solved
from ..body import Body
from ..elementary import EPS
from ..forward import UNIT, breaks_of, each_pressure
from ..types import Array, Edges, Regime, StickZone
from .cycles import turning_width
from .quadrature import double_exponential
from .zone import each_zone_of_regime

TERMS = (16, 24, 36, 54)
"""Numbers of terms of the series, in turn."""

ZONE_RTOL = 1e-7
"""If zones by two numbers of terms agree to within this, relative to the contact width, the finer
one is exact."""

MAX_ROUNDS = 20
"""Largest number of iterations of the gain; three to five are common."""

ROUND_RTOL = 1e-9
"""Change of m and n between iterations that counts as zero, relative to the contact width."""

FRICTION_RTOL = 1e-6
"""Allowance for rounding, relative to friction."""

MAX_STRIP = 1e-4
"""Width of the strip beyond the moderate zone in which the moderate solution stands in for series
that fail, as (a + n - H)/(a + c).  It is off by less than the square of this."""

_NODES, _WEIGHTS = double_exponential(1 / 12)
_ANGLES, _GAUSS = ((1 + v) / 2 for v in np.polynomial.legendre.leggauss(64))
_GAUSS -= 0.5  # rule on (0, 1)

Place = Callable[[Array], Array]
"""A function of position; it takes and returns arrays."""


class _HalfCycle(NamedTuple):
    """A half-cycle with dsigma > 0.

    limit  2 f p as a function of position; zero at a corner
    cuts   breaks of the body
    H      the width of a stick zone whose right end is not driven
    """

    limit: Place
    cuts: Array
    a: float
    c: float
    dQ: float
    dsigma: float
    H: float


class _Zone(NamedTuple):
    """A slip zone: its nodes y, their weights, the shear left by slip there and at its start."""

    y: Array
    weight: Array
    r: Array
    at_start: float
    length: float


class _Gain:
    """The shear gained since points began to stick again, as a series between `start` and `end`.

    near = 0: analytic in the square roots of the distances from both ends
    near > 0: analytic in sqrt(y) and sqrt(y + near), y = x - start
    rubs:     whether points beyond `end` are at the friction limit, where the gain is 2 f p;
              otherwise nothing was gained there
    """

    def __init__(
        self,
        gained: Place,
        start: float,
        end: float,
        count: int,
        near: float = 0.0,
        rubs: bool = False,
    ) -> None:
        self.start, self.end, self.near, self.rubs = start, end, near, rubs
        if near > 0:
            self._reach = np.arcsinh(np.sqrt((end - start) / near))
        values = lambda s: gained(self._place(s))  # noqa: E731
        self._series = Chebyshev.interpolate(values, count - 1, domain=(0, 1))

    def _place(self, s: Array) -> Array:
        if self.near > 0:
            return self.start + self.near * np.sinh(self._reach * s) ** 2
        return self.start + (self.end - self.start) * np.sin(np.pi / 2 * s) ** 2

    def __call__(self, x: Array) -> Array:
        """The gain at x up to `end`; before `start`, that at `start`."""
        y = np.clip(x - self.start, 0.0, self.end - self.start)
        if self.near > 0:
            return self._series(np.arcsinh(np.sqrt(y / self.near)) / self._reach)
        return self._series(2 / np.pi * np.arcsin(np.sqrt(y / (self.end - self.start))))


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
        at = s * _ANGLES
        rates = np.sin(np.pi * at) * self.rate(at)
        return float(np.pi / 2 * self.span * s * np.sum(_GAUSS * rates))


class _State(NamedTuple):
    """What a half-cycle passes on to the next.

    m, n         the permanent stick zone; NaN unless the half-cycle has these phases
    gain         the gain on the right; None if there is none
    left, right  slip zones of phase 3, a first guess for the next one
    """

    m: float = math.nan
    n: float = math.nan
    gain: _Gain | None = None
    left: float = 0.0
    right: float = 0.0


# ---------------------------------------------------------------- slip that grows


def _remaining(limit: Place, gain: _Gain | None, x: Array) -> Array:
    """2 f p less the gain."""
    whole = limit(x)
    if gain is None:
        return whole
    return np.where(x < gain.end, whole - gain(x), 0.0 if gain.rubs else whole)


def _zone(side: float, start: float, edge: float, cuts: Array, r: Place) -> _Zone:
    """The slip zone from `start` to `edge`, both counted outward, where slip leaves the shear r."""
    length, inner = edge - start, np.sort(side * cuts - start)
    ends = np.concatenate([[0.0], inner[(inner > 0) & (inner < length)], [length]])
    parts = np.diff(ends)[:, None]
    y, weight = (ends[:-1, None] + parts * _NODES).ravel(), (parts * _WEIGHTS).ravel()
    values = r(side * (start + np.append(y, 0.0)))
    return _Zone(y, weight, values[:-1], values[-1], length)


def _cuts(of: _HalfCycle, *gains: _Gain | None) -> Array:
    """The points at which slip zones are cut: breaks of the body and ends of gains."""
    ends = [end for gain in gains if gain for end in (gain.start, gain.end)]
    return np.concatenate([of.cuts, ends])


def _sums(left: _Zone, right: _Zone, stuck: float) -> tuple[float, float]:
    """L and R."""
    roots = [np.sqrt((stuck + zone.y) / zone.y) for zone in (left, right)]
    forces = left.weight * left.r, right.weight * right.r
    L = np.sum(forces[0] * roots[0]) + np.sum(forces[1] / roots[1])
    return L, np.sum(forces[0] / roots[0]) + np.sum(forces[1] * roots[1])


def _change(left: _Zone, right: _Zone, m: float, n: float, x: Array) -> Array:
    """dq at x in the stick zone."""
    total, stuck = np.zeros(np.shape(x)), m + n
    for zone, near, far in ((left, x + m, n - x), (right, n - x, x + m)):
        near, far = np.maximum(near, 0.0), np.maximum(far, 0.0)
        singular = np.sqrt(zone.y * (zone.y + stuck)) * (zone.y + near[..., None])
        total += np.sqrt(near * far) * np.sum(zone.weight * (zone.r - zone.at_start) / singular, -1)
        angle = np.arctan2(np.sqrt(zone.length * far), np.sqrt(near * (zone.length + stuck)))
        total += 2 * zone.at_start * angle
    return total / np.pi


# ---------------------------------------------------------------- the three phases


def _phase_1(of: _HalfCycle, begun: _State) -> tuple[float, float, float, Place]:
    """m, n, lambda and dq when m + n = H; the search begins next to the last n."""
    gain, cuts = begun.gain, _cuts(of, begun.gain)

    def zones(n: float) -> tuple[_Zone, _Zone]:
        left = _zone(-1.0, of.H - n, of.a, cuts, of.limit)
        return left, _zone(1.0, n, of.c, cuts, lambda x: -_remaining(of.limit, gain, x))

    def off(n: float) -> float:
        return _sums(*zones(n), of.H)[1]

    least, most = of.H - of.a + 1e-12 * of.H, of.c - 1e-12 * of.H
    low, high, span = least, most, 1e-6 * of.H
    while begun.n < math.inf and span < of.H:
        low, high, span = max(least, begun.n - span), min(most, begun.n + span), 8 * span
        if off(low) < 0 < off(high):
            break
    if not off(low) < 0 < off(high):
        return math.nan, math.nan, math.nan, of.limit
    n = brentq(off, low, high, xtol=1e-14 * of.H, rtol=1e-14)
    found = zones(n)
    part = _sums(*found, of.H)[0] / (2 * of.dQ)
    return of.H - n, n, part, partial(_change, *found, of.H - n, n)


def _gained(of: _HalfCycle, legs: list[_Leg], x: Array) -> Array:
    """(dsigma/4) int sqrt((H - x - mu)/(x + mu)) Lambda dmu over the legs, while x sticks."""
    x, total = np.asarray(x)[..., None], np.zeros(np.shape(x))
    for leg in legs:
        distance = of.H - x - leg.top
        top = np.minimum(0.0, distance)
        length = np.maximum(leg.top + top - leg.bottom, 0.0)
        below_top = length * _NODES[::-1]
        s = 2 / np.pi * np.arcsin(np.sqrt(np.clip((below_top - top) / leg.span, 0.0, 1.0)))
        above, below = below_top + (distance - top), x + leg.bottom + length * _NODES
        root_ = np.sqrt(np.where(length > 0, above / below, 0.0))
        total += np.sum(length * _WEIGHTS * leg.rate(s) * root_, axis=-1)
    return of.dsigma / 4 * total


def _next_leg(
    of: _HalfCycle, dq: Place, before: list[_Leg], top: float, span: float, count: int
) -> _Leg:
    """The next leg, given those before it: Abel's equation at Chebyshev points.

    At m = top - span v**2 it is, with Lambda taken at v cos(phi) in place of v,

        int_0^(pi/2) sqrt(H/span - (v sin(phi))**2) cos(phi) Lambda dphi = right.
    """
    v = np.sin(np.pi / 4 * (chebpts1(count) + 1))
    x, phi = span * v**2 - top, np.pi / 2 * _ANGLES
    right = (of.limit(x) - dq(x) - _gained(of, before, x)) * 2 / (of.dsigma * span * v)
    far = np.sqrt(np.maximum(of.H / span - np.outer(v, np.sin(phi)) ** 2, 0.0)) * np.cos(phi)
    t = 4 / np.pi * np.arcsin(np.outer(v, np.cos(phi))) - 1
    matrix = np.einsum("ij,ijk->ik", np.pi / 2 * _GAUSS * far, chebvander(t, count - 1))
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
    of: _HalfCycle, m: float, part: float, gains: tuple[_Gain, _Gain], guess: tuple[float, float]
) -> tuple[float, float, Place]:
    """The slip zones in the contact [-m, c], whose width is H, and dq.

    The first guess takes the remaining friction at both edges as square roots.  At the start of
    phase 3 the left edge is driven by 2 dQ and the right one not at all; later the right one is
    driven in proportion to the loss of width of the stick zone.
    """
    at_left, at_right = (partial(_remaining, of.limit, gain) for gain in gains)
    cuts, dQ, growth = _cuts(of, *gains), part * of.dQ, np.pi * part * of.dsigma / 8
    if not guess[0] > 0:
        near, most = 1e-4 * of.H, of.H / 4
        scale = np.pi / 2 * math.sqrt(of.H / near)
        left = min(2 * dQ / max(scale * float(at_left(near - m)), EPS * dQ), most)
        drive = max(scale * float(at_right(of.c - near)) - growth, EPS * growth)
        guess = left, min(max(growth * left / drive, 1e-9 * of.H), most)

    def zones(left: float, right: float) -> tuple[_Zone, _Zone]:
        at_c = _zone(1.0, of.c - right, of.c, cuts, at_right)
        return _zone(-1.0, m - left, m, cuts, at_left), at_c

    def lengths(logarithms: Array) -> Array:
        """Both slip zones from the logarithms of their ratios to the stick zone."""
        ratios = np.exp(logarithms)
        return of.H * ratios / (1 + np.sum(ratios))

    def off(logarithms: Array) -> Array:
        left, right = lengths(logarithms)
        stuck = of.H - left - right
        L, R = _sums(*zones(left, right), stuck)
        return np.array([L - dQ - stuck * growth, R - dQ + stuck * growth]) / dQ

    first = np.log(np.array(guess) / (of.H - sum(guess)))
    for method in ("hybr", "lm"):
        found = root(off, first, method=method, tol=1e-13)
        if np.max(np.abs(found.fun)) < 1e-9:
            break
    else:
        return math.nan, math.nan, of.limit
    left, right = lengths(found.x)
    return left, right, partial(_change, *zones(left, right), m - left, of.c - right)


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
    gain = _Gain(gained, n_1, min(of.H - m, of.c), count)
    if part == 1:
        return _State(m, n_1, gain)

    middle_right = (middle + n_1) / 2
    gain_left = _Gain(lambda x: gained(x) + dq_1(x), -m, middle_right, count, near=m_1 - m)
    guess = begun.left, begun.right
    left, right, dq_3 = _phase_3(of, m, 1 - part, (gain_left, gain), guess)
    n = of.c - right
    if not (left < m + middle_right and left - m < middle < n):
        return nothing
    start = n_1 if n > n_1 else 2 * n - of.c
    at_end = _Gain(lambda x: gain(x) + dq_3(x), start, n, count, rubs=True)
    return _State(m - left, n_1, at_end, left, right)


def _is_sound(of: _HalfCycle, state: _State, count: int) -> bool:
    """Whether the shear traction stays within the friction limit where points stick again, and is
    not driven further where it is at that limit."""
    if not (state.gain and state.n < state.gain.end <= of.c):
        return False
    turns = (of.c - of.a) / 2 + of.H / 2
    last = of.c if state.gain.rubs else state.gain.end
    at_points = np.sin(np.pi / 4 * (chebpts1(count) + 1)) ** 2  # where the series is exact
    x = state.n + (state.gain.end - state.n) * at_points
    limit, gained = of.limit(x), state.gain(x)
    excess = np.max(np.maximum(-gained, gained - limit))
    return bool(-state.m <= turns <= last and excess <= FRICTION_RTOL * np.max(limit))


def _by_phases(of: _HalfCycle) -> tuple[float, float]:
    """m and n of a half-cycle; NaN unless it has the phases and the series converge."""
    width, state = of.a + of.c, _State()
    m_1, n_1, _, _ = _phase_1(of, state)
    middle = n_1 - (m_1 + n_1) / 4
    for count in TERMS:
        coarser, changed = state, math.inf
        for _ in range(MAX_ROUNDS):
            last, state = state, _half_cycle(of, middle, state, count)
            changed = max(abs(state.m - last.m), abs(state.n - last.n))
            if not state.n < math.inf or changed <= ROUND_RTOL * width:
                break
        if not (changed <= ROUND_RTOL * width and _is_sound(of, state, count)):
            break
        if max(abs(state.m - coarser.m), abs(state.n - coarser.n)) <= ZONE_RTOL * width:
            return state.m, state.n
    return math.nan, math.nan


def _mixed_zone(
    body: Body,
    own: dict[str, Any],
    a: float,
    c: float,
    dQ: float,
    dsigma: float,
    f: float,
    moderate: list[float],
) -> tuple[float, float]:
    """m and n of a cycle of constant loads in which slip reverses; NaN if they are not found.

    Just beyond the end of the moderate zone, series may fail.  There n departs from the moderate
    solution as the square of (a + n - H)/(a + c), and m departs far less.

    moderate: m and n of the moderate solution
    """
    if not (dQ > 0 and dsigma != 0):
        return math.nan, math.nan
    sense, edges = math.copysign(1.0, dsigma), {"a": a, "c": c}

    def limit(x: Array) -> Array:
        p = solved(each_pressure, body, {"x": sense * x, **edges}, UNIT, own)
        return np.where(p < math.inf, 2 * f * p, 0.0)

    cuts, H = sense * breaks_of(body, own), turning_width(dQ, dsigma)
    if sense < 0:
        a, c, moderate = c, a, moderate[::-1]
    m, n = _by_phases(_HalfCycle(limit, cuts, a, c, dQ, abs(dsigma), H))
    if math.isnan(m) and 0 < a + moderate[1] - H <= MAX_STRIP * (a + c):
        m, n = moderate
    return (m, n) if sense > 0 else (n, m)


def with_mixed(
    body: Body, own: dict[str, Any], cycle: dict[str, Any], f: Array, zone: StickZone
) -> StickZone:
    """Stick zones, and those of mixed cycles at constant normal loads that are not known yet.

    cycle: a_1, c_1, a_2, c_2, dQ and dsigma for E* = 1, by name
    """
    shape = np.shape(zone.m)
    m, n, regime = (np.array(v).ravel() for v in zone)
    values = {**cycle, "f": f, "regime": Regime.MODERATE, **own}
    given = {name: np.broadcast_to(value, shape).ravel() for name, value in values.items()}
    steady = (given["a_1"] == given["a_2"]) & (given["c_1"] == given["c_2"])
    cases = np.flatnonzero((regime == Regime.MIXED) & np.isnan(m) & steady)
    given = {name: value[cases] for name, value in given.items()}
    own = {name: given.pop(name) for name in own}
    constants: dict[str, Any] = {"f": given.pop("f"), **UNIT}
    moderate = solved(each_zone_of_regime, body, given, constants, own, Edges)
    given |= {"f": constants["f"], **moderate._asdict()}
    names = ("a_1", "c_1", "dQ", "dsigma", "f", "left", "right")
    for i, case in enumerate(cases):
        parameters = {name: value[i] for name, value in own.items()}
        a, c, dQ, dsigma, f, *known = (given[name][i] for name in names)
        m[case], n[case] = _mixed_zone(body, parameters, a, c, dQ, dsigma, f, known)
        regime[case] = Regime.UNSOLVED if math.isnan(m[case]) else Regime.MIXED
    return StickZone(*(v.reshape(shape)[()] for v in (m, n, regime)))
