"""From loads to the contact where no closed formula exists.

The edges are sought as their distances from a point that lies in the contact: the centre of the
load, at -M/P, or the place where the tilted body is level.  Both distances are positive, and grow
with the load; so their logarithms are the unknowns.  Every contact of every body changes by

    dP = (pi sqrt(h)/4) (K_left da + K_right dc),
    dM = -(pi sqrt(h)/4) (K_left (mid - h/4) da + K_right (mid + h/4) dc),
    d alpha = (K_left da - K_right dc)/sqrt(h),      all for E* = 1,

so that Newton's method needs no other derivative than the edge coefficients.  While the load is far
off, both distances are scaled alike; the load grows with them, however large or small.

Elements that have converged take no part in the next step: a hard one costs its neighbours nothing.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

Array = Any
Rows = Any
"""Indices of the elements that are still worked on."""

STEPS = 100
"""Steps after which an element is given up, as NaN; five to ten are common."""

NEAR = 1.0
"""A load whose logarithm is off by less is met by Newton's step, any other by scaling."""

LONGEST = 2.0
"""Longest of Newton's steps in the logarithm of a distance to an edge."""

SMALL, SMALLEST = 1e-6, 1e-9
"""After a step below SMALLEST the next one, its square, is below rounding; one below SMALL that
does not get smaller shows rounding itself."""

_EPS = 2.0**-52


class State(NamedTuple):
    """What a contact carries for E* = 1, NaN if it carries nothing, and its edge coefficients."""

    load: Array
    moment: Array
    tilt: Array
    left: Array
    right: Array


class Solution(NamedTuple):
    """The contact [-a, c] and its tilt."""

    a: Array
    c: Array
    alpha: Array


StateOf = Callable[..., State]


def contact_under(
    load: Array, moment: Array, size: Array, state: StateOf, **constants: Array
) -> Solution:
    """The contact under loads and moments, for E* = 1.

    size: any length of the body's order, to start from.
    state: what a contact [-a, c] carries, from a, c and the constants.
    """
    return _solved(load, -moment / load, size, state, constants, _ByMoment, ())


def contact_at(
    load: Array, tilt: Array, place: Array, size: Array, state: StateOf, **constants: Array
) -> Solution:
    """The contact under loads at tilts; `place` is where the body so tilted is level."""
    return _solved(load, place, size, state, constants, _ByTilt, (tilt,))


@dataclass(frozen=True)
class _ByMoment:
    """The second condition: the load has its centre at `place`."""

    place: Array

    def on(self, rows: Any) -> "_ByMoment":
        """The same for some elements."""
        return _ByMoment(self.place[rows])

    def off(self, now: State, h: Array, mid: Array, load: Array) -> Array:
        """How far the state is from it, comparable with a change of the load's logarithm."""
        return 4 * (-now.moment / now.load - self.place) / h

    def odd(self, now: State, h: Array, mid: Array, need: Array) -> Array:
        """K_right dc - K_left da of the step that meets it."""
        centre = -now.moment / now.load
        force = 4 * now.load / (np.pi * np.sqrt(h))
        return 4 * force * (self.place - centre - (mid - centre) * need) / h


@dataclass(frozen=True)
class _ByTilt:
    """The second condition: the tilt; `place` lies in the contact."""

    place: Array
    tilt: Array

    def on(self, rows: Any) -> "_ByTilt":
        """The same for some elements."""
        return _ByTilt(self.place[rows], self.tilt[rows])

    def off(self, now: State, h: Array, mid: Array, load: Array) -> Array:
        """How far the state is from it, comparable with a change of the load's logarithm."""
        return (self.tilt - now.tilt) * h / load

    def odd(self, now: State, h: Array, mid: Array, need: Array) -> Array:
        """K_right dc - K_left da of the step that meets it."""
        return np.sqrt(h) * (now.tilt - self.tilt)


def _solved(
    load: Array,
    place: Array,
    size: Array,
    state: StateOf,
    constants: dict[str, Array],
    condition: Any,
    also: tuple[Array, ...],
) -> Solution:
    """Broadcast, solve along one dimension, and give the result the broadcast shape."""
    fixed = {n: v for n, v in constants.items() if not np.ndim(v)}
    varying = [n for n in constants if n not in fixed]
    given = (load, place, size, *also, *(constants[n] for n in varying))
    shape = np.broadcast_shapes(*map(np.shape, given))
    load, place, size, *rest = (np.broadcast_to(v, shape).ravel() for v in given)
    goal = condition(place, *rest[: len(also)])
    arrays = dict(zip(varying, rest[len(also) :], strict=True))

    def of(a: Array, c: Array, rows: Any) -> State:
        return state(a, c, **fixed, **{n: v[rows] for n, v in arrays.items()})

    a, c = _newton(load, goal, size, of)
    alpha = of(a, c, slice(None)).tilt
    return Solution(*(v.reshape(shape)[()] for v in (a, c, alpha)))


def _newton(
    load: Array, goal: Any, size: Array, state: Callable[[Array, Array, Rows], State]
) -> tuple[Array, Array]:
    """a and c; NaN where no contact was found.

    A step is taken from `left` and `right` along `to_left` and `to_right`, logarithms.  If it leads
    away from the loads, a quarter of it is tried, and so on.
    """
    a, c = np.full(load.shape, np.nan), np.full(load.shape, np.nan)
    rows = np.flatnonzero((load > 0) & (load < np.inf) & np.isfinite(goal.place))
    left = right = size[rows] / 2
    to_left = to_right = np.zeros(rows.size)
    part = np.ones(rows.size)
    narrow, wide = np.zeros(rows.size), np.full(rows.size, np.inf)
    best = last = np.full(rows.size, np.inf)
    for _ in range(STEPS):
        if not rows.size:
            break
        asked, wanted = load[rows], goal.on(rows)
        tried_left, tried_right = left * np.exp(part * to_left), right * np.exp(part * to_right)
        now = state(tried_left - wanted.place, tried_right + wanted.place, rows)
        h, mid = tried_left + tried_right, wanted.place + (tried_right - tried_left) / 2

        need = np.log(asked / now.load)
        force = 4 * now.load / (np.pi * np.sqrt(h))
        even, odd = force * need, wanted.odd(now, h, mid, need)
        by_left = (even - odd) / (2 * now.left * tried_left)
        by_right = (even + odd) / (2 * now.right * tried_right)
        length = np.maximum(np.abs(by_left), np.abs(by_right))
        miss = need**2 + wanted.off(now, h, mid, asked) ** 2

        touches = np.isfinite(length) & np.isfinite(miss)
        scaling = (best == np.inf) & ~(touches & (np.abs(need) < NEAR))
        more = ~touches | (need > 0)
        narrow = np.where(scaling & more, np.maximum(narrow, h), narrow)
        wide = np.where(scaling & ~more, np.minimum(wide, h), wide)
        pull = now.left * tried_left + now.right * tried_right
        next_h = h * np.exp(np.clip(need * force / pull, -40, 40))
        between = np.where(wide < np.inf, np.sqrt(np.maximum(narrow, h / 64) * wide), 8 * h)
        next_h = np.where((next_h > narrow) & (next_h < wide), next_h, between)
        scale = np.log(next_h / h)

        better = ~scaling & (miss < best)
        moved = scaling | better
        shrink = np.minimum(1, LONGEST / length)
        left, right = np.where(moved, tried_left, left), np.where(moved, tried_right, right)
        to_left = np.where(scaling, scale, np.where(better, by_left * shrink, to_left))
        to_right = np.where(scaling, scale, np.where(better, by_right * shrink, to_right))
        part = np.where(moved, 1.0, part / 4)
        best = np.where(better, miss, best)

        rounding = 2 * _EPS * (np.abs(wanted.place) + h) / np.minimum(tried_left, tried_right)
        met = better & (length < np.maximum(SMALLEST, rounding))
        done = met | (~moved & (last < SMALL))
        ended, on = rows[done], ~done
        step_left, step_right = np.where(met, to_left, 0), np.where(met, to_right, 0)
        a[ended] = (left * np.exp(step_left) - wanted.place)[done]
        c[ended] = (right * np.exp(step_right) + wanted.place)[done]
        last = np.where(better, length, last)
        rows, left, right, to_left, to_right, part, narrow, wide, best, last = (
            v[on] for v in (rows, left, right, to_left, to_right, part, narrow, wide, best, last)
        )
    return a, c


def level(
    slope: Callable[..., tuple[Array, Array]],
    tilt: Array,
    size: Array,
    corners: tuple[Array, ...] = (),
    **constants: Array,
) -> Array:
    """Where the tilted body is level, g'(x) + alpha = 0; NaN where it is nowhere so.

    slope: g'(x) and g''(x), from x and the constants; g' grows with x.
    corners: places where g' jumps.
    """
    given = (tilt, size, *corners, *constants.values())
    shape = np.broadcast_shapes(*map(np.shape, given))
    tilt, size, *rest = (np.broadcast_to(v, shape).ravel() for v in given)
    places, held = rest[: len(corners)], dict(zip(constants, rest[len(corners) :], strict=True))

    def excess(x: Array, rows: Rows) -> tuple[Array, Array]:
        value, rate = slope(x, **{n: v[rows] for n, v in held.items()})
        return value + tilt[rows], rate

    everywhere = np.arange(tilt.size)
    found = np.full(tilt.shape, np.nan)
    for x in (0 * size, *places):
        before, _ = excess(np.nextafter(x, -np.inf), everywhere)
        beyond, _ = excess(np.nextafter(x, np.inf), everywhere)
        found = np.where((before <= 0) & (beyond >= 0), x, found)
    side = np.where(excess(0 * size, everywhere)[0] < 0, 1.0, -1.0)
    open_ = np.flatnonzero(np.isnan(found))

    def excess_outward(r: Array, rows: Rows) -> tuple[Array, Array]:
        picked = open_[rows]
        value, rate = excess(side[picked] * r, picked)
        return side[picked] * value, rate

    bracket = _around(excess_outward, size[open_])
    found[open_] = side[open_] * _increasing_root(excess_outward, *bracket)
    return found.reshape(shape)[()]


Excess = Callable[[Array, Rows], tuple[Array, Array]]
"""Value and rate of an increasing function, at places of some rows."""


def _around(excess: Excess, start: Array) -> tuple[Array, Array]:
    """A bracket of each row's positive root, a factor of eight wide; NaN where there is none."""
    high = start.copy()
    for factor, sense in ((8.0, 1), (0.125, -1)):
        rows = np.arange(start.size)
        for _ in range(STEPS):
            at = high[rows] if sense > 0 else high[rows] / 8
            rows = rows[excess(at, rows)[0] * sense < 0]
            if not rows.size:
                break
            high[rows] *= factor
        high[rows] = np.nan
    return high / 8, high


def _increasing_root(excess: Excess, low: Array, high: Array) -> Array:
    """The root of each row between low and high.

    Newton's step is taken where it stays between and at most halves the step before, else the
    middle.
    """
    found = np.full(low.shape, np.nan)
    rows = np.flatnonzero(np.isfinite(low + high))
    low, high = low[rows], high[rows]
    x, before = (low + high) / 2, high - low
    for _ in range(STEPS):
        if not rows.size:
            break
        value, rate = excess(x, rows)
        low, high = np.where(value < 0, x, low), np.where(value > 0, x, high)
        step = -value / rate
        good = (x + step > low) & (x + step < high) & (np.abs(step) < before / 2)
        following = np.where(value == 0, x, np.where(good, x + step, (low + high) / 2))
        before = np.abs(following - x)
        done = (before <= 2 * _EPS * np.abs(x)) | (value == 0)
        found[rows[done]], on = following[done], ~done
        rows, x, before, low, high = rows[on], following[on], before[on], low[on], high[on]
    return found
