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

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ._arrays import LEAST, MOST, at_rows, flattened
from ._nested import SMALL, SMALLEST, beside, edges
from ._roots import CLOSEST, STEPS, Array, Rows, around, increasing_root
from ._state import State

NEAR = 1.0
"""A load whose logarithm is off by less is met by Newton's step, any other by scaling."""

LONGEST = 2.0
"""Longest of Newton's steps in the logarithm of a distance to an edge."""

CLOSE = 1e-5
"""From between rungs, after a step below this the state shows the rest, whose square is below
rounding,"""

QUICK = 6
"""or after so many steps it is given up;"""

CLEAR = 1e-3
"""so it is where a kink lies closer to an edge, in parts of the width."""

EXACT = 1e-13
"""A contact whose load is off by less, but for the rounding of its edges, is found;"""

ACCEPTED = 1e-9
"""one that is off by more, when every way to it has been tried, is none."""

ROUNDED = 4
"""The last step counts if its square leaves no more than so many units in the last place of the
edge and of the load explain; none is due if it is no longer itself.  It tells nothing of what lies
beyond a kink."""

ROUGHEST = 1e-4
"""Where the rounding of the edges moves the load by more, no contact is given."""

UNSURE = 1e-2
"""Nor is one where the rounding of a tilt moves an edge by more, in parts of the width."""

FINEST = 2.0**-20
"""Where a smaller part of a step leads no nearer, Newton's method has lost its way;"""

NARROWED = 0.1
"""so has scaling, between widths whose logarithms differ by less: a kink lies between them."""

MANY = 600
"""So many elements that differ in the load alone are worth a ladder of loads,"""

RUNGS = 32
"""with one rung for so many of them."""

_DOUBTFUL = 70.0
"""A load or a place farther from the body's size than this, a logarithm, may be out of reach."""

_EPS = 2.0**-52


class Solution(NamedTuple):
    """The contact [-a, c] and its tilt."""

    a: Array
    c: Array
    alpha: Array


StateOf = Callable[..., State]


def contact_under(
    load: Array,
    moment: Array,
    size: Array,
    state: StateOf,
    breaks: Sequence[Array] = (),
    /,
    **constants: Array,
) -> Solution:
    """The contact under loads and moments, for E* = 1.

    size: any length of the body's order, to start from.
    state: what a contact [-a, c] carries, from a, c and the constants.
    breaks: places where the body's curve changes, from left to right.
    """
    return _solved(load, -moment / load, size, state, breaks, constants, _ByMoment, ())


def contact_at(
    load: Array,
    tilt: Array,
    place: Array,
    size: Array,
    state: StateOf,
    breaks: Sequence[Array] = (),
    /,
    **constants: Array,
) -> Solution:
    """The contact under loads at tilts; `place` is where the body so tilted is level."""
    return _solved(load, place, size, state, breaks, constants, _ByTilt, (tilt,))


def _linear(goal: Any, now: State, h: Array, mid: Array, need: Array) -> tuple[Array, Array]:
    """K_left da and K_right dc of the step that meets the second condition, and the load."""
    even, odd = 4 * now.load / (np.pi * np.sqrt(h)) * need, goal.odd(now, h, mid, need)
    return (even - odd) / 2, (even + odd) / 2


def _by_shares(goal: Any, now: State, h: Array, mid: Array, need: Array) -> tuple[Array, Array]:
    """The same by logarithms, for a moment.

    What an edge's step adds to the load has its centre at mid - h/4 or mid + h/4.  Between these
    two the load is shared, and it is the logarithms of both shares that are met.
    """
    centre, asked = (4 * (v - mid) / h for v in (-now.moment / now.load, goal.place))
    force = 2 * now.load / (np.pi * np.sqrt(h))
    left, right = (
        force * (1 + side * centre) * (need + np.log((1 + side * asked) / (1 + side * centre)))
        for side in (-1, 1)
    )
    return left, right


@dataclass(frozen=True)
class _Step:
    """Newton's step from a contact [-a, c].

    by_a, by_c: how far the edges move.
    short: the logarithm by which the load is short; off: how far the second condition is.
    """

    a: Array
    c: Array
    now: State
    by_a: Array
    by_c: Array
    short: Array
    off: Array

    @classmethod
    def of(cls, load: Array, goal: Any, a: Array, c: Array, now: State) -> "_Step":
        """To what carries the load and meets the condition."""
        h, mid = a + c, (c - a) / 2
        short = np.log(load / now.load)
        left, right = _linear(goal, now, h, mid, short)
        off = goal.off(now, h, mid, load)
        return cls(a, c, now, left / now.left, right / now.right, short, off)

    def taken(self) -> tuple[Array, Array, Array]:
        """a, c and the tilt after it."""
        turned = self.now.left * self.by_a - self.now.right * self.by_c
        tilt = self.now.tilt + turned / np.sqrt(self.a + self.c)
        return self.a + self.by_a, self.c + self.by_c, tilt

    def edges(self, kinks: Sequence[Array]) -> Iterator[tuple[Array, Array, Array, Array]]:
        """Of each edge: where it is, how far it moves, K_N, and its distance from what is nearest.

        That is a kink or the other edge.
        """
        for edge, by, K, side in (
            (self.a, self.by_a, self.now.left, -1),
            (self.c, self.by_c, self.now.right, 1),
        ):
            nearest = self.a + self.c
            for kink in kinks:
                nearest = np.minimum(nearest, np.abs(edge - side * kink))
            yield edge, by, K, nearest


@dataclass(frozen=True)
class _ByMoment:
    """The second condition: the load has its centre at `place`.

    steps: ways to it from close by, one after the other.
    """

    place: Array
    steps = (_linear, _by_shares)

    def on(self, rows: Any) -> "_ByMoment":
        """The same for some elements."""
        return _ByMoment(self.place[rows])

    def is_one(self) -> bool:
        """Whether it is the same for all elements, but for rounding."""
        return bool(np.ptp(self.place) <= 4 * _EPS * np.max(np.abs(self.place)))

    def off(self, now: State, h: Array, mid: Array, load: Array) -> Array:
        """How far the state is from it, comparable with a change of the load's logarithm."""
        return 4 * (-now.moment / now.load - self.place) / h

    def rounding(self, h: Array, load: Array) -> Array:
        """By how much rounding of what is asked alone puts a state off."""
        return _EPS * np.abs(self.place) / h

    def beyond(self, now: State, h: Array, mid: Array) -> tuple[Array, Array, Array]:
        """What grows with c and falls with a, and is zero if met; its rates with a and with c."""
        rate = np.pi * np.sqrt(h) / 4
        arms = mid - h / 4 - self.place, mid + h / 4 - self.place
        turning = -now.moment - now.load * self.place
        return turning, rate * now.left * arms[0], rate * now.right * arms[1]

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
    steps = (_linear,)

    def on(self, rows: Any) -> "_ByTilt":
        """The same for some elements."""
        return _ByTilt(self.place[rows], self.tilt[rows])

    def is_one(self) -> bool:
        """Whether it is the same for all elements."""
        return not np.ptp(self.place) and not np.ptp(self.tilt)

    def off(self, now: State, h: Array, mid: Array, load: Array) -> Array:
        """How far the state is from it, comparable with a change of the load's logarithm."""
        return (self.tilt - now.tilt) * h / load

    def rounding(self, h: Array, load: Array) -> Array:
        """By how much rounding of what is asked alone puts a state off."""
        return _EPS * np.abs(self.tilt) * h / load

    def beyond(self, now: State, h: Array, mid: Array) -> tuple[Array, Array, Array]:
        """What grows with c and falls with a, and is zero if met; its rates with a and with c."""
        return self.tilt - now.tilt, -now.left / np.sqrt(h), now.right / np.sqrt(h)

    def odd(self, now: State, h: Array, mid: Array, need: Array) -> Array:
        """K_right dc - K_left da of the step that meets it."""
        return np.sqrt(h) * (now.tilt - self.tilt)


def _solved(
    load: Array,
    place: Array,
    size: Array,
    state: StateOf,
    breaks: Sequence[Array],
    constants: dict[str, Array],
    condition: Any,
    also: tuple[Array, ...],
) -> Solution:
    """Broadcast, solve along one dimension, and give the result the broadcast shape."""
    flat, constants, shape = flattened((load, place, size, *also, *breaks), constants)
    load, place, size, *rest = flat
    goal, cuts = condition(place, *rest[: len(also)]), rest[len(also) :]

    def of(a: Array, c: Array, rows: Any) -> State:
        return state(a, c, **at_rows(rows, constants))

    given = (load > 0) & (load < np.inf) & _within_reach(load, goal.place, size, of)
    best = _Found.none(load.size)
    rows, narrowed = np.flatnonzero(given), NARROWED if cuts else 0.0
    varies = any(map(np.ndim, constants.values()))
    if rows.size > MANY and not varies and not np.ptp(size[rows]) and goal.on(rows).is_one():
        best.put(*_between_rungs(load, goal, size, of, rows, cuts, narrowed))
        rows = np.flatnonzero(given & ~best.met)
    if rows.size:
        half = size[rows] / 2
        over = _over_a_kink(goal.place, cuts)
        edge_a, edge_c = _newton(load, goal, (half, half), of, rows, narrowed, over=over)
        best.put(rows, _judged(load, goal, edge_a[rows], edge_c[rows], of, rows, cuts))
    searched = np.full(load.shape, False)
    ways: list[Callable[..., tuple[Array, Array]]] = [
        *(partial(beside, s) for s in goal.steps),
        edges,
        partial(beside, goal.steps[0]),
    ]
    for nearer in ways:
        rows = np.flatnonzero(given & ~best.told & (~best.done | searched))
        if not rows.size:
            break
        behind, start = [v[rows] for v in cuts], (best.a[rows], best.c[rows])
        found = nearer(load[rows], goal.on(rows), size[rows], of, rows, behind, *start)
        judged = _judged(load, goal, *found, of, rows, cuts)
        nearer_still, alike = ~(judged.off > best.off[rows]), judged.done == best.done[rows]
        closer = judged.met & np.where(alike, nearer_still, judged.done)
        better = closer | judged.carries & ~best.met[rows]
        best.put(rows[better], judged.on(better))
        searched[rows] = nearer is edges
    return Solution(*(np.where(best.met, v, np.nan).reshape(shape)[()] for v in best[:3]))


def _over_a_kink(place: Array, cuts: Sequence[Array]) -> Array:
    """How wide a contact around the place reaches well over the nearest kink.

    Far out on a straight flank no narrower one carries anything.
    """
    distances = [np.abs(cut - place) for cut in cuts]
    return 4 * np.min(distances, axis=0) if distances else 0.0 * place


def _within_reach(load: Array, place: Array, size: Array, state: Callable[..., State]) -> Array:
    """Whether a contact may carry the load within the lengths that count; asked where in doubt."""
    within = np.abs(place) < MOST * ROUGHEST / _EPS
    far = np.abs(np.log(load / size)) > _DOUBTFUL
    rows = np.flatnonzero(within & (far | (np.abs(place) > size * np.exp(_DOUBTFUL))))
    if rows.size:
        at, asked = place[rows], load[rows]
        narrowest, widest = (state(r - at, r + at, rows).load for r in (LEAST, 0.49 * MOST))
        within[rows] = ~(narrowest > asked) & ~(widest < asked)
    return within


class _Found(NamedTuple):
    """Contacts, and what is known of each.

    a, c, tilt: after the last step, where there is one.
    off: how far it is from carrying what is asked.
    met: whether it is one.
    told: whether it tells that there is none, where its edges lie so close to a kink that their
        rounding moves the load by ROUGHEST, or where that of what is asked moves them by UNSURE.
    done: whether it is as near as its edges can be numbers at all.
    carries: whether it carries anything.
    """

    a: Array
    c: Array
    tilt: Array
    off: Array
    met: Array
    told: Array
    done: Array
    carries: Array

    @classmethod
    def none(cls, count: int) -> "_Found":
        """Nothing yet of so many."""
        nothing = [np.full(count, np.nan) for _ in range(4)]
        return cls(*nothing, *(np.full(count, False) for _ in range(4)))

    def on(self, rows: Any) -> "_Found":
        """The same for some."""
        return _Found(*(value[rows] for value in self))

    def put(self, rows: Rows, found: "_Found") -> None:
        """Take these for the elements `rows`."""
        for whole, value in zip(self, found, strict=True):
            whole[rows] = value


def _judged(
    load: Array,
    goal: Any,
    a: Array,
    c: Array,
    state: Callable[[Array, Array, Rows], State],
    rows: Rows,
    cuts: Sequence[Array],
) -> _Found:
    """What contacts of the elements `rows` are."""
    load, goal, now = load[rows], goal.on(rows), state(a, c, rows)
    step, h = _Step.of(load, goal, a, c, now), a + c
    rounding = np.pi / 4 * _EPS * np.sqrt(h) / now.load
    rounding *= now.left * np.abs(a) + now.right * np.abs(c)
    given = goal.rounding(h, load)
    short = np.abs(step.short)
    rest = np.abs(step.off) - 16 * np.minimum(given, ROUGHEST)
    near = np.maximum(short, rest / 16) < ACCEPTED + 16 * rounding
    clear = (rounding < ROUGHEST) & (given < UNSURE)
    done = (short < EXACT + 2 * rounding) & (rest < EXACT + 8 * rounding)
    steps, rests, force = done.copy(), done.copy(), load / np.sqrt(h)
    for edge, by, K, nearest in step.edges([cut[rows] for cut in cuts]):
        rounded = ROUNDED * (np.spacing(np.abs(edge)) + _EPS * force / K)
        own = 2 * np.abs(by) <= nearest  # on this side of a kink
        rests &= own & (np.abs(by) <= rounded + ROUNDED * given * force / K)
        steps &= own & (by**2 < rounded * nearest)
    off, done = np.maximum(short, rest), steps | rests
    moved = zip(step.taken(), (a, c, now.tilt), strict=True)
    a, c, tilt = (np.where(steps, after, before) for after, before in moved)
    return _Found(a, c, tilt, off, near & clear, near & ~clear, done, now.load > 0)


class _Widths(NamedTuple):
    """Contact widths between which the load is met, while it is far off.

    narrow, wide: too narrow and too wide, as far as known.
    gap: how far apart they were when last looked at, a logarithm.
    ends: whether no load belongs to the wide one, beyond the body's end.
    over: what to try at least where nothing is carried.
    """

    narrow: Array
    wide: Array
    gap: Array
    ends: Array
    over: Array

    @classmethod
    def unknown(cls, over: Array) -> "_Widths":
        """Nothing is known of so many."""
        far = np.full(over.size, np.inf)
        return cls(np.zeros(over.size), far, far, np.full(over.size, False), over)

    def beside(self, h: Array, need: Array, scaling: Array) -> "_Widths":
        """With what a width h tells whose load is off by the factor exp(need)."""
        more = np.isnan(need) | (need > 0)
        narrow = np.where(scaling & more, np.maximum(self.narrow, h), self.narrow)
        wide = np.where(scaling & ~more, np.minimum(self.wide, h), self.wide)
        ends = np.where(scaling & ~more, need == -np.inf, self.ends)
        return self._replace(narrow=narrow, wide=wide, ends=ends)

    def next(self, h: Array, step: Array) -> tuple[Array, "_Widths"]:
        """The width to try: h exp(step), or one between where that leaves or hardly closes in."""
        narrow, wide, gap, _, over = self
        by_step = h * np.exp(np.clip(step, -40, 40))
        wider = np.where(np.isnan(step), np.maximum(8 * h, over), 8 * h)
        between = np.where(wide < np.inf, np.sqrt(np.maximum(narrow, h / 64) * wide), wider)
        closer = np.log(wide / narrow)
        inside = (by_step > narrow) & (by_step < wide) & ~(closer > gap / 2)
        return np.where(inside, by_step, between), self._replace(gap=closer)


def _between_rungs(
    load: Array,
    goal: Any,
    size: Array,
    state: Callable[[Array, Array, Rows], State],
    rows: Rows,
    cuts: Sequence[Array],
    narrowed: float,
) -> tuple[Rows, Array]:
    """Which of the elements `rows`, that differ in nothing but the load, have edges and a tilt.

    And these, one row each.
    """
    asked, wanted = load[rows], goal.on(rows)
    start = _from_rungs(asked, wanted, size[rows] / 2, state, narrowed)
    a, c = (v[rows] for v in _newton(load, goal, start, state, rows, narrowed, CLOSE, QUICK))
    step = _Step.of(asked, wanted, a, c, state(a, c, rows))
    plain = (np.abs(step.short) < ACCEPTED) & (np.abs(step.off) < ACCEPTED)
    for _, _, _, nearest in step.edges([cut[rows] for cut in cuts]):
        plain &= nearest > CLEAR * (a + c)
    yes = np.full(a.shape, True)
    found = _Found(*step.taken(), np.zeros(a.size), yes, ~yes, yes, yes)
    return rows[plain], found.on(plain)


def _from_rungs(
    load: Array,
    goal: Any,
    half: Array,
    state: Callable[[Array, Array, Rows], State],
    narrowed: float,
) -> tuple[Array, Array]:
    """Distances to the edges to start from, of elements that differ in nothing but the load.

    Between loads evenly spaced in their logarithm, whose contacts are found, the logarithms of both
    distances are cubics with the rates that they have at these.
    """
    count = load.size // RUNGS
    rungs = np.zeros(count, int)
    goal, start = goal.on(rungs), (half[rungs], half[rungs])
    at, wanted = np.log(load), np.linspace(np.log(load.min()), np.log(load.max()), count)
    a, c = _newton(np.exp(wanted), goal, start, state, np.arange(count), narrowed)
    now = state(a, c, rungs)
    forces = _linear(goal, now, a + c, (c - a) / 2, np.ones(count))
    gap = wanted[1] - wanted[0] or 1.0
    below = np.clip(((at - wanted[0]) / gap).astype(int), 0, count - 2)
    share = (at - wanted[below]) / gap
    found = []
    for distance, force, by in zip(
        (a + goal.place, c - goal.place), forces, (now.left, now.right), strict=True
    ):
        value, rate = np.log(distance), gap * force / (by * distance)
        rise, first, last = np.diff(value)[below], rate[below], rate[below + 1]
        bend = 3 * rise - 2 * first - last + share * (first + last - 2 * rise)
        found.append(np.exp(value[below] + share * (first + share * bend)))
    return found[0], found[1]


def _newton(
    load: Array,
    goal: Any,
    start: tuple[Array, Array],
    state: Callable[[Array, Array, Rows], State],
    rows: Rows,
    narrowed: float,
    smallest: float = SMALLEST,
    steps: int = STEPS,
    over: Array | float = 0.0,
) -> tuple[Array, Array]:
    """a and c of some elements, NaN of others; as close as it came where no contact was found.

    start: their distances to the edges from which to start.
    smallest: after a step below this it is done; after so many steps it is given up.
    over: the width to try next, of all elements, where the first contact carries nothing.
    A step is taken from `left` and `right` along `to_left` and `to_right`, logarithms.  If it leads
    away from the loads, a quarter of it is tried, and so on.
    """
    a, c = np.full(load.shape, np.nan), np.full(load.shape, np.nan)
    left, right = start
    to_left = to_right = np.zeros(rows.size)
    part = np.ones(rows.size)
    widths = _Widths.unknown(np.broadcast_to(over, load.shape)[rows])
    best = last = np.full(rows.size, np.inf)
    for _ in range(steps):
        if not rows.size:
            break
        asked, wanted = load[rows], goal.on(rows)
        tried_left, tried_right = left * np.exp(part * to_left), right * np.exp(part * to_right)
        now = state(tried_left - wanted.place, tried_right + wanted.place, rows)
        h, mid = tried_left + tried_right, wanted.place + (tried_right - tried_left) / 2

        need = np.log(asked / now.load)
        force_left, force_right = _linear(wanted, now, h, mid, need)
        by_left, by_right = (
            force_left / (now.left * tried_left),
            force_right / (now.right * tried_right),
        )
        length = np.maximum(np.abs(by_left), np.abs(by_right))
        miss = need**2 + wanted.off(now, h, mid, asked) ** 2

        touches = np.isfinite(length) & np.isfinite(miss)
        scaling = (best == np.inf) & ~(touches & (np.abs(need) < NEAR))
        scale, far_off = np.zeros(rows.size), np.any(scaling)
        if far_off:
            pull = np.pi * np.sqrt(h) / 4 * (now.left * tried_left + now.right * tried_right)
            next_h, widths = widths.beside(h, need, scaling).next(h, need * now.load / pull)
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
        met = better & (length < np.maximum(smallest, rounding))
        stuck = scaling
        if far_off:
            stuck = scaling & (widths.gap < np.where(widths.ends, CLOSEST, narrowed))
            left, right = (np.where(stuck, widths.wide / 2, v) for v in (left, right))
        done = met | (~moved & (last < SMALL)) | stuck | (part < FINEST)
        last = np.where(better, length, last)
        if not np.any(done):
            continue
        ended, on = rows[done], ~done
        step_left, step_right = np.where(met, to_left, 0), np.where(met, to_right, 0)
        a[ended] = (left * np.exp(step_left) - wanted.place)[done]
        c[ended] = (right * np.exp(step_right) + wanted.place)[done]
        rows, left, right, to_left, to_right, part, best, last = (
            v[on] for v in (rows, left, right, to_left, to_right, part, best, last)
        )
        widths = _Widths(*(v[on] for v in widths))
    a[rows], c[rows] = left - goal.place[rows], right + goal.place[rows]
    return a, c


def level(
    slope: Callable[..., tuple[Array, Array]],
    tilt: Array,
    size: Array,
    corners: tuple[Array, ...] = (),
    /,
    **constants: Array,
) -> Array:
    """Where the tilted body is level, g'(x) + alpha = 0; NaN where it is nowhere so.

    slope: g'(x) and g''(x), from x and the constants; g' grows with x.
    corners: places where g' jumps.
    """
    (tilt, size, *places), held, shape = flattened((tilt, size, *corners), constants)

    def excess(x: Array, rows: Rows) -> tuple[Array, Array]:
        value, rate = slope(x, **at_rows(rows, held))
        return value + tilt[rows], rate

    everywhere = np.arange(tilt.size)
    found = np.full(tilt.shape, np.nan)
    for x in (0 * size, *places):
        before, _ = excess(np.nextafter(x, -np.inf), everywhere)
        beyond, _ = excess(np.nextafter(x, np.inf), everywhere)
        found = np.where((before <= 0) & (beyond >= 0), x, found)
    side = np.where(excess(0 * size, everywhere)[0] < 0, 1.0, -1.0)
    beside = excess(side * LEAST, everywhere)[0] * side
    found = np.where(np.isnan(found) & (beside > 0), 0.0, found)  # closer than lengths can be
    open_ = np.flatnonzero(np.isnan(found))

    def excess_outward(r: Array, rows: Rows) -> tuple[Array, Array]:
        picked = open_[rows]
        value, rate = excess(side[picked] * r, picked)
        return side[picked] * value, rate

    bracket = around(excess_outward, size[open_])
    found[open_] = side[open_] * increasing_root(excess_outward, *bracket)
    return found.reshape(shape)[()]
