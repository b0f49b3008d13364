r"""Slip that turns round inside a half-cycle of constant normal loads: the exact stick zone.

Tension loads the left edge more, dsigma > 0.  While [-m, n] sticks and the loads go on in
proportion, its right end is driven by dQ - pi dsigma (m + n)/8, which vanishes at a width
m + n = H = 8 dQ/(pi dsigma).  Between the moderate and the large regime a half-cycle has three
phases:

1. Slip as in large tension makes both ends recede until m + n = H: n is as small as it gets.
2. The right edge sticks again, from n outward.  Its new end is not loaded, so that m + n = H stays:

       dq/dlambda = (dsigma/4) sqrt((H - t)/t),    t = x + m,

   lambda the part of the half-cycle.  How fast m falls, Lambda = -dlambda/dm, follows from friction
   at -m, which is Abel's equation:

       (dsigma/4) int_m^m1 sqrt((H - t)/t) Lambda(mu) dmu = 2 f p(-m) - dq1(-m),    t = mu - m,

   m1 and dq1 those at the end of phase 1.
3. All of the right edge sticks, m + c = H, and from now on it slips as in moderate tension.

Each half-cycle ends as the other one began, with the sign of shear turned.  So what slips back on
the right in phase 1 is 2 f p less the gain, the shear won since it stuck again: 2 f p where phase 3
brought it to friction.  The gain is found by iteration, in tables of more and more terms until m
and n stay.

Shear must not be driven on where it is at friction since the last half-cycle: on the left, and on
the right where nothing was won.  In phase 1 its rate changes its sign at mid + H/2, mid the middle
of what sticks so far, see _stick.py: at n when the phase ends, and nowhere there when it begins.
"""

from collections.abc import Callable
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ._arrays import Array
from ._roots import increasing_root
from ._zones import (
    Pair,
    Task,
    bounded_change,
    by_newton,
    drawn_in,
    integrals,
    rule,
    turning_place,
)

TERMS = (16, 24, 36, 54)
"""Terms of the tables."""

AGREED = 1e-7
"""Zones by two tables that agree to this, in parts of the contact, are exact by the finer one."""

LEVEL = 4
"""Steps of the quadrature are 2**-LEVEL."""

ROUNDS = 20
"""Rounds of the iteration at most; three to five are common."""

REST = 1e-11
"""Change of m and n from one round to the next that is none, in parts of the contact."""

SLACK = 1e-6
"""What is allowed for rounding, in parts of the friction."""

TOGETHER = 100
"""Elements that are solved in one piece."""

ANGLES = 64
"""Nodes of the quadrature in Abel's equation."""

STAIRS = (0.05, 0.2, 0.4, 0.6, 0.8)
"""Parts of the loads by which slip zones that are large are led up to."""

STRETCHES = (1 / 64, 1 / 16, 1 / 4, 1.0)
"""How far tables of phase 2 reach, in parts of the way to the end of the stick zone's growth."""

NEAR = 1e-4
"""Where roots at the edges are measured to start from, in parts of H."""


def turning_zone(task: Task, middle: Array) -> Pair:
    """m and n of cycles between a contact and itself, of tension that loads the left edge more.

    middle: a place that sticks all the time.  NaN where slip does not turn round.
    """
    m, n = np.full(task.dQ.shape, np.nan), np.full(task.dQ.shape, np.nan)
    for start in range(0, m.size, TOGETHER):
        rows = np.arange(start, min(start + TOGETHER, m.size))
        m[rows], n[rows] = _by_finer_tables(task.on(rows), middle[rows])
    return m, n


def _by_finer_tables(task: Task, middle: Array) -> Pair:
    """Tables of more and more terms, each begun with what the last one gave."""
    found = np.full((2, task.dQ.size), np.nan)
    rows, last, begun = np.arange(task.dQ.size), found, None
    for count in TERMS:
        cycle = _Turning(task.on(rows), middle[rows], count)
        steady = cycle.steady(begun)
        now = np.stack(steady.zone)
        agreed = np.max(np.abs(now - last), axis=0) <= AGREED * cycle.task.width
        found[:, rows[agreed]] = now[:, agreed]
        on = np.flatnonzero(~agreed & np.isfinite(now).all(axis=0))
        if not on.size:
            break
        rows, last, begun = rows[on], now[:, on], steady.on(on)
    return found[0], found[1]


Change = Callable[[Array, Array, Array], Array]
"""Another pressure from p, at x, of some elements."""


# ---------------------------------------------------------------------- tables


class _Table(NamedTuple):
    """A function on (start, start + length), analytic in the square roots of both distances.

    A Chebyshev series in s, x = start + length sin(pi s/2)**2: its terms down, elements along.
    """

    start: Array
    length: Array
    terms: Array

    def __call__(self, x: Array) -> Array:
        """At x; outside as at the nearer end."""
        part = np.clip((x - self.start) / self.length, 0.0, 1.0)
        return _summed(self.terms, 2 / np.pi * np.arcsin(np.sqrt(part)))

    @staticmethod
    def places(start: Array, length: Array, count: int) -> Array:
        """Where it is sampled."""
        return start + length * np.sin(np.pi / 2 * _places(count)) ** 2

    @classmethod
    def of(cls, start: Array, length: Array, values: Array) -> "_Table":
        """From values at its places."""
        return cls(start, length, _fit(len(values)) @ values)

    def on(self, rows: Array) -> "_Table":
        """The same for some elements."""
        return _Table(*(v[..., rows] for v in self))


class _Beside(NamedTuple):
    """A function on (start, start + length), analytic in sqrt(y) and sqrt(y + near), y = x - start.

    A Chebyshev series in s, y = near sinh(reach s)**2.
    """

    start: Array
    near: Array
    reach: Array
    terms: Array

    def __call__(self, x: Array) -> Array:
        """At x; outside as at the nearer end."""
        y = np.maximum(x - self.start, 0.0)
        s = np.arcsinh(np.sqrt(y / self.near)) / self.reach
        return _summed(self.terms, np.minimum(s, 1.0))

    @staticmethod
    def places(start: Array, length: Array, near: Array, count: int) -> Array:
        """Where it is sampled."""
        reach = np.arcsinh(np.sqrt(length / near))
        return start + near * np.sinh(reach * _places(count)) ** 2

    @classmethod
    def of(cls, start: Array, length: Array, near: Array, values: Array) -> "_Beside":
        """From values at its places."""
        return cls(start, near, np.arcsinh(np.sqrt(length / near)), _fit(len(values)) @ values)

    def on(self, rows: Array) -> "_Beside":
        """The same for some elements."""
        return _Beside(*(v[..., rows] for v in self))


def _summed(terms: Array, s: Array) -> Array:
    """A Chebyshev series in s, 0 to 1."""
    return chebyshev.chebval(2 * s - 1, terms, tensor=False)


def _places(count: int) -> Array:
    """Where s is sampled, as a column."""
    return (1 + np.cos(np.pi * (np.arange(count)[:, None] + 0.5) / count)) / 2


@cache
def _fit(count: int) -> Array:
    """From values at the places to terms."""
    return np.linalg.inv(chebyshev.chebvander(2 * _places(count)[:, 0] - 1, count - 1))


class _Gain(NamedTuple):
    """Shear won on the right since it stuck again: tabled, then 2 f p if it rubs, else nothing."""

    table: _Table
    rubs: Array

    @property
    def end(self) -> Array:
        """Where the table ends."""
        return self.table.start + self.table.length

    def over(self, x: Array, twice: Array) -> Array:
        """At x, where 2 f p is `twice`."""
        return np.where(x < self.end, self.table(x), np.where(self.rubs, twice, 0.0))

    def on(self, rows: Array) -> "_Gain":
        """The same for some elements."""
        return _Gain(self.table.on(rows), self.rubs[rows])


# ---------------------------------------------------------------------- the three phases


class _Grown(NamedTuple):
    """The end of phase 1: what has slipped, the stick zone, the part of the half-cycle gone."""

    task: Task
    m: Array
    n: Array
    part: Array

    def shear(self, x: Array) -> Array:
        """dq at x in the stick zone."""
        return bounded_change(self.task, self.m, self.n, x, LEVEL)


class _Receded(NamedTuple):
    """Phase 2: Lambda as a series in v, mu = m_1 - span v**2; m, n, the part and v at its end."""

    width: Array
    scale: Array
    m_1: Array
    span: Array
    rates: Array
    m: Array
    n: Array
    part: Array
    v_end: Array

    def gain(self, x: Array) -> Array:
        """(dsigma/4) int sqrt((H - x - mu)/(x + mu)) Lambda dmu over mu > m, while x sticks."""
        q, weight = rule(LEVEL)
        room = self.width - x - self.m_1
        top = np.minimum(0.0, room)  # of mu - m_1
        length = np.maximum(self.m_1 + top - self.m, 0.0)[..., None, :]
        below_top = length * q[::-1]
        fallen = below_top - top[..., None, :]
        rates = _summed(self.rates, np.sqrt(np.clip(fallen / self.span, 0.0, 1.0)))
        above = below_top + (room - top)[..., None, :]
        below = np.maximum(x + self.m, 0.0)[..., None, :] + length * q
        return self.scale * np.sum(weight * length * rates * np.sqrt(above / below), axis=-2)


class _Ended(NamedTuple):
    """The end of the half-cycle: what has slipped in phase 3, the stick zone."""

    task: Task
    m: Array
    n: Array


class _Steady(NamedTuple):
    """A cycle that repeats itself: m and n; the gain; how far the left zone grows in phase 3."""

    zone: Pair
    gain: _Gain
    slip: Array

    def on(self, rows: Array) -> "_Steady":
        """The same for some elements."""
        m, n = self.zone
        return _Steady((m[rows], n[rows]), self.gain.on(rows), self.slip[rows])


class _Turning:
    """Some elements, with tables of so many terms."""

    def __init__(self, task: Task, middle: Array, count: int) -> None:
        self.task, self.middle, self.count = task, middle, count
        self.a, self.c = task.a[0], task.c[0]
        self.width = 8 * task.dQ / (np.pi * task.dsigma)

    def steady(self, begun: "_Steady | None") -> "_Steady":
        """The cycle that comes back to its own gain; its zone is NaN if the phases are not these.

        begun: one to start from.
        """
        gain, slip = (begun.gain, begun.slip) if begun else (self._no_gain, None)
        now = np.full((2, self.c.size), np.nan)
        for _ in range(ROUNDS):
            grown = self._grow(gain)
            receded = self._recede(grown)
            ended = self._end(grown, receded, slip)
            gain, slip = self._won(grown, receded, ended), receded.m - ended.m
            last, now = now, np.stack([ended.m, grown.n])
            rests = np.max(np.abs(now - last), axis=0) <= REST * self.task.width
            if np.all(rests | ~np.isfinite(now).all(axis=0)):
                break
        sound = rests & self._sound(grown, receded, ended, gain)
        return _Steady(
            (np.where(sound, now[0], np.nan), np.where(sound, now[1], np.nan)), gain, slip
        )

    @property
    def _no_gain(self) -> _Gain:
        zeros = np.zeros((self.count, self.c.size))
        return _Gain(_Table.of(self.c, np.ones_like(self.c), zeros), np.full(self.c.shape, False))

    def _twice(self, x: Array) -> Array:
        """2 f p."""
        return self.task.f * self.task.sum_of_pressures(x)

    def _with(self, change: Change, cuts: tuple[Array, ...] = (), /, **changes: Array) -> Task:
        """The task with other pressures, in parts of which p is cut off too."""
        own = self.task

        def changed(x: Array, of: int, rows: Array) -> Array:
            return change(own.pressure(x, of, own.rows[rows]), x, rows)

        def kinks(rows: Array) -> tuple[Array, ...]:
            return (*(cut[rows] for cut in cuts), *own.kinks(own.rows[rows]))

        rows = np.arange(own.dQ.size)
        return own._replace(rows=rows, pressure=changed, kinks=kinks, **changes)

    def _grow(self, gain: _Gain) -> _Grown:
        """Phase 1: n from int 2 f p sqrt(y/(H + y)) dy = int (2 f p - gain) sqrt((H + y)/y) dy.

        y are distances from the stick zone, on the left and on the right; the sum of the other two
        such integrals is 2 dQ for the whole half-cycle.
        """
        a, c, H, f = self.a, self.c, self.width, self.task.f

        def slipped(p: Array, x: Array, rows: Array) -> Array:
            right, twice = x > self.middle[rows], 2 * f[rows]
            if not np.any(right):
                return p
            return np.where(right, p - gain.on(rows).over(x, twice * p) / twice, p)

        task = self._with(slipped, (gain.table.start, gain.end))

        def excess(n: Array, rows: Array) -> Pair:
            here, stuck = task.on(rows), H[rows]
            left = integrals(here, -1, a[rows] - (stuck - n), stuck, LEVEL)
            right = integrals(here, 1, c[rows] - n, stuck, LEVEL)
            return left.far - right.near, stuck / 2 * (left.across - right.along)

        n = increasing_root(excess, np.maximum(H - a, -a), c)
        m = H - n
        left = integrals(task, -1, a - m, H, LEVEL)
        right = integrals(task, 1, c - n, H, LEVEL)
        return _Grown(task, m, n, f * (left.near - right.far) / (2 * self.task.dQ))

    def _recede(self, grown: _Grown) -> _Receded:
        """Phase 2, until all of the right edge sticks or the half-cycle ends.

        How far m falls is not known beforehand: tables reach further and further.
        """
        H, terms = self.width, (self.count, self.c.size)
        full = grown.m - np.maximum(H - self.c, -self.middle)
        span, rates, integral = full, np.zeros(terms), np.zeros((terms[0] + 2, terms[1]))
        on = np.full(full.shape, True)
        for part in STRETCHES:
            tried = self._rates(grown, part * full)
            span = np.where(on, part * full, span)
            rates, integral = np.where(on, tried[0], rates), np.where(on, tried[1], integral)
            on &= ~(grown.part + integral.sum(axis=0) >= 1)
            if not np.any(on):
                break
        whole = grown.part + integral.sum(axis=0)
        whole = np.where((whole < 1) & (H - self.c < -self.middle), np.nan, whole)

        def beyond(v: Array, rows: Array) -> Pair:
            part = grown.part[rows] + _summed(integral[:, rows], v)
            return part - 1, 2 * span[rows] * v * _summed(rates[:, rows], v)

        late = np.where(whole > 1, 1.0, np.nan)
        v_end = np.where(whole > 1, increasing_root(beyond, 0 * late, late), 1.0)
        end = grown.m - span * v_end**2
        gone = np.minimum(whole, 1.0)
        return _Receded(H, self.task.dsigma / 4, grown.m, span, rates, end, H - end, gone, v_end)

    def _rates(self, grown: _Grown, span: Array) -> tuple[Array, Array]:
        """Lambda, and the part of the half-cycle gone since phase 1, down to m_1 - span."""
        v = _places(self.count)
        m = grown.m - span * v**2
        missing = self._twice(-m) - grown.shear(-m)
        rates = _abel(self.width / span, 2 * missing / (self.task.dsigma * span * v))
        integral: Array = chebyshev.chebint(span * _times_twice_v(rates), lbnd=-1, scl=0.5)
        return rates, integral

    def _end(self, grown: _Grown, receded: _Receded, slip: Array | None) -> _Ended:
        """Phase 3: as in moderate tension, for what friction still lacks and the rest of the loads.

        slip: about how far the left zone grows in it.
        """
        f, rest = self.task.f, 1 - receded.part
        dQ, dsigma = rest * self.task.dQ, rest * self.task.dsigma
        first_left, first_right = self._first_guess(grown, receded, rest)
        expected: Array = first_left if slip is None else np.where(slip > 0, slip, first_left)
        reach = receded.m + (self.middle + grown.n) / 2
        near = grown.m - receded.m
        x = _Beside.places(-receded.m, reach, near, self.count)
        won_left = _Beside.of(-receded.m, reach, near, receded.gain(x) + grown.shear(x))
        length = self.c - grown.n
        x = _Table.places(grown.n, length, self.count)
        won_right = _Table.of(grown.n, length, receded.gain(x))

        def lacking(p: Array, x: Array, rows: Array) -> Array:
            left = x < self.middle[rows]
            if np.all(left):
                return p - won_left.on(rows)(x) / (2 * f[rows])
            back = won_right.on(rows)(x) / (2 * f[rows]) - p
            return np.where(left, p - won_left.on(rows)(x) / (2 * f[rows]), back)

        a, c = np.stack([receded.m] * 2), np.stack([self.c] * 2)
        task = self._with(lacking, a=a, c=c, dQ=dQ, dsigma=dsigma)
        m, n = receded.m.copy(), receded.n.copy()
        rows = np.flatnonzero(rest > 0)
        if rows.size:
            left, right = _followed(task.on(rows), expected[rows], first_right[rows])
            left = np.where(left < reach[rows], left, np.nan)
            m[rows], n[rows] = receded.m[rows] - left, self.c[rows] - right
        return _Ended(task, m, n)

    def _first_guess(self, grown: _Grown, receded: _Receded, rest: Array) -> Pair:
        """Slip zones of phase 3 from roots that what is lacking has at both edges.

        At its start the left edge is driven by 2 dQ and the right one not at all; later by what
        the stick zone has lost in width.
        """
        H = self.width
        near = NEAR * H
        x = near - receded.m
        lacks = self._twice(x) - receded.gain(x) - grown.shear(x)
        x = self.c - near
        both = lacks, self._twice(x) - receded.gain(x)
        at_left, at_right = (np.pi / 2 * np.sqrt(H / near) * v for v in both)
        left = np.minimum(2 * rest * self.task.dQ / at_left, H / 4)
        growth = np.pi * rest * self.task.dsigma / 8
        right = np.clip(growth * left / (at_right - growth), 1e-9 * H, H / 4)
        return left, right

    def _won(self, grown: _Grown, receded: _Receded, ended: _Ended) -> _Gain:
        """The gain when the half-cycle ends."""
        third, n = receded.part < 1, ended.n
        start = np.where(n > grown.n, grown.n, 2 * n - self.c)
        x = _Table.places(start, n - start, self.count)
        last = bounded_change(ended.task, ended.m, n, x, LEVEL)
        won = receded.gain(x) + np.where(third, last, 0.0)
        return _Gain(_Table.of(start, n - start, won), third)

    def _sound(self, grown: _Grown, receded: _Receded, ended: _Ended, gain: _Gain) -> Array:
        """Whether all three phases go forward, and shear stays within friction where it sticks."""
        places = _places(self.count)
        sound = np.all(_summed(receded.rates, receded.v_end * places) >= 0, axis=0)
        x = _Table.places(grown.n, ended.n - grown.n, self.count)
        won, twice = gain.table(x), self._twice(x)
        slack = SLACK * np.max(twice, axis=0)
        sound &= np.all((won >= -slack) & (won <= twice + slack), axis=0)
        sound &= (grown.part > 0) & (grown.part < 1)
        sound &= (-ended.m < self.middle) & (self.middle < grown.n)
        sound &= (ended.m <= receded.m) & (receded.m <= grown.m) & (grown.m <= self.a)
        turns = turning_place(self.task.dQ, self.task.dsigma, self.a, self.c)
        sound &= (-ended.m <= turns) & (turns <= np.where(gain.rubs, self.c, ended.n))
        return sound & (grown.n < ended.n) & (ended.n <= self.c)


def _followed(task: Task, left: Array, right: Array) -> Pair:
    """Slip zones by Newton's method, from a guess, else from those of smaller loads."""
    found_left, found_right = by_newton(task, left, right, LEVEL)
    rows = np.flatnonzero(~np.isfinite(found_left))
    if rows.size:
        here, left, right = task.on(rows), STAIRS[0] * left[rows], STAIRS[0] * right[rows]
        for part, following in pairwise((*STAIRS, 1.0)):
            loads = {"dQ": part * here.dQ, "dsigma": part * here.dsigma}
            left, right = by_newton(here._replace(**loads), left, right, LEVEL)
            left, right = following / part * left, following / part * right
            left, right = drawn_in(here.width, left, right)
        found_left[rows], found_right[rows] = by_newton(here, left, right, LEVEL)
    return found_left, found_right


def _times_twice_v(terms: Array) -> Array:
    """2 v times a series in v: 2 v = 1 + T_1."""
    product = np.zeros((len(terms) + 1, *terms.shape[1:]))
    product[:-1] += terms
    product[1:] += terms / 2
    product[1] += terms[0] / 2
    product[:-2] += terms[1:] / 2
    return product


def _abel(width: Array, right: Array) -> Array:
    """Lambda, as a series, from its integral at the places v.

    int_0^(pi/2) sqrt(width - (v sin(phi))**2) cos(phi) Lambda(v cos(phi)) dphi = right
    """
    count = len(right)
    angle, weight = _quarter()
    v = _places(count)
    basis = chebyshev.chebvander(2 * v * np.cos(angle) - 1, count - 1)
    root = np.sqrt(np.maximum(width[:, None, None] - (v * np.sin(angle)) ** 2, 0.0))
    matrix = np.einsum("epq,pqk->epk", root * np.cos(angle) * weight, basis)
    good = np.isfinite(right).all(axis=0) & np.isfinite(matrix).all(axis=(1, 2))
    matrix = np.where(good[:, None, None], matrix, np.eye(count))
    return np.linalg.solve(matrix, np.where(good, right, np.nan).T[..., None])[..., 0].T


@cache
def _quarter() -> Pair:
    """Nodes and weights of Gauss's rule on (0, pi/2)."""
    nodes, weights = np.polynomial.legendre.leggauss(ANGLES)
    return np.pi / 4 * (1 + nodes), np.pi / 4 * weights
