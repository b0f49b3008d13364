"""The contact of elements that Newton's method around one point has lost.

An edge just beyond a kink is known by its distance from the kink: measured from a point inside,
that distance is rounded off.  `beside` takes Newton's steps in the logarithms of these distances.

`edges` finds the contact edge by edge.  For every left edge there is one right edge that meets the
second condition, moment or tilt; and on the contacts so found the load grows with the left edge.
So one root inside the other, each in a bracket, finds every contact.  The kinks between which an
edge lies are found first.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ._arrays import LEAST, MOST
from ._roots import Array, Excess, Rows, increasing_root
from ._state import State

STEPS, LONGEST = 30, 8.0
"""Most steps beside kinks, and the longest of them, a logarithm."""

SMALL, SMALLEST = 1e-6, 1e-9
"""After a step below SMALLEST the next one, its square, is below rounding; one below SMALL that
does not get smaller shows rounding itself."""

_EPS = 2.0**-52

Step = Callable[..., tuple[Array, Array]]
"""K_left da and K_right dc of a step, from the second condition, what a contact carries, its width
and middle, and the logarithm by which its load is short."""


def beside(
    step: Step,
    load: Array,
    goal: Any,
    _: Array,
    state: Callable[[Array, Array, Rows], State],
    rows: Rows,
    breaks: Sequence[Array],
    a: Array,
    c: Array,
) -> tuple[Array, Array]:
    """a and c by Newton's method in distances from kinks; from a and c, which are close."""
    behind = [-at for at in breaks]
    a, c, on = a.copy(), c.copy(), np.flatnonzero(np.isfinite(a + c))
    last = np.full(a.shape, np.inf)
    for _ in range(STEPS):
        if not on.size:
            break
        edge, wanted = (a[on], c[on]), goal.on(on)
        left = edge[0] - _last(edge[0], -wanted.place, [at[on] for at in behind])
        right = edge[1] - _last(edge[1], wanted.place, [at[on] for at in breaks])
        now, h = state(*edge, rows[on]), edge[0] + edge[1]
        forces = step(wanted, now, h, (edge[1] - edge[0]) / 2, np.log(load[on] / now.load))
        by_left = np.clip(forces[0] / (now.left * left), -LONGEST, LONGEST)
        by_right = np.clip(forces[1] / (now.right * right), -LONGEST, LONGEST)
        moves = np.isfinite(by_left + by_right)
        a[on] += np.where(moves, left * np.expm1(by_left), 0.0)
        c[on] += np.where(moves, right * np.expm1(by_right), 0.0)
        near = [
            _nearest(at, beyond, [kink[on] for kink in kinks])
            for at, beyond, kinks in zip(edge, (left, right), (behind, breaks), strict=True)
        ]
        length = np.maximum(np.abs(by_left) * left / near[0], np.abs(by_right) * right / near[1])
        rounding = 2 * _EPS * np.maximum(np.abs(edge[0]) / near[0], np.abs(edge[1]) / near[1])
        going = (length > SMALL) | ((length > SMALLEST) & (length < last[on] / 2))
        last[on] = length
        on = on[moves & going & (length > rounding)]
    return a, c


def _last(edge: Array, inner: Array, kinks: Sequence[Array]) -> Array:
    """The last kink before an edge, or the point inside where none lies between."""
    for kink in kinks:
        inner = np.where(kink < edge, np.maximum(inner, kink), inner)
    return inner


def _nearest(edge: Array, distance: Array, kinks: Sequence[Array]) -> Array:
    """How far an edge is from what is nearest: a kink on either side, or its `distance`."""
    for kink in kinks:
        away = np.abs(edge - kink)
        distance = np.where(away > 0, np.minimum(distance, away), distance)
    return distance


def edges(
    load: Array,
    goal: Any,
    size: Array,
    state: Callable[[Array, Array, Rows], State],
    rows: Rows,
    breaks: Sequence[Array],
    *_: Array,
) -> tuple[Array, Array]:
    """a and c of the elements `rows` of a problem; NaN where there is no contact.

    goal: the second condition; its `place` lies in every contact that meets it.
    state: what a contact carries, of some elements of the whole problem.
    breaks: places where the curve changes, of the elements `rows`.
    """
    behind = [-at for at in reversed(breaks)]
    to_left, to_right = (np.reshape(v, (-1, load.size)) for v in (behind, breaks))
    guess = np.full(load.shape, np.nan)  # the right edge that belonged to the last left one

    def turning(a: Array, c: Array, picked: Rows) -> tuple[State, Array, Array, Array]:
        now = state(a, c, rows[picked])
        return now, *goal.on(picked).beyond(now, a + c, (c - a) / 2)

    def right_of(a: Array, picked: Rows) -> Array:
        def excess(c: Array, inner: Rows) -> tuple[Array, Array]:
            now, value, _, by_c = turning(a[inner], c, picked[inner])
            bare = ~(now.load > 0)
            return np.where(bare, -1.0, value), np.where(bare, 0.0, by_c)

        start = goal.place[picked]
        found = _edge(excess, start, size[picked], to_right[:, picked], guess[picked])
        guess[picked] = found
        return found

    def excess(a: Array, picked: Rows) -> tuple[Array, Array]:
        c = right_of(a, picked)
        now, _, by_a, by_c = turning(a, c, picked)
        force = np.pi * np.sqrt(a + c) / 4
        rate = force * (now.left - now.right * by_a / by_c) / now.load
        bare = ~(now.load > 0)
        value = np.where(bare, -1.0, np.log(now.load / load[picked]))
        too_far = np.isnan(c)  # as far to the left as this, no right edge meets the condition
        return np.where(too_far, np.nan, value), np.where(bare, 0.0, rate)

    a = _edge(excess, -goal.place, size, to_left)
    return a, right_of(a, np.arange(load.size))


def _edge(
    excess: Excess, inner: Array, size: Array, kinks: Array, guess: Array | None = None
) -> Array:
    """The edge beyond `inner` at which `excess` changes its sign from minus; NaN where none does.

    kinks: places of kinks, one row a kink, in their order outward; some may lie behind.
    guess: where to look first; NaN where nothing is known.
    """
    start, end = _between(excess, inner, kinks)
    far = np.where(end < np.inf, end - start, np.maximum(size, np.abs(start)))
    first = None
    if guess is not None:
        ahead = np.maximum(guess - start, 0.0)
        far = np.where((end == np.inf) & (ahead > 0), 2 * ahead, far)
        first = np.log(ahead)
    broken = np.full(far.shape, False)
    open_, factor = np.flatnonzero(end == np.inf), 8.0
    while open_.size and factor < np.inf:
        at, _ = excess(start[open_] + far[open_], open_)
        broken[open_] = ~np.isfinite(at)
        open_ = open_[at < 0]
        far[open_] *= factor
        factor = factor**2 if factor < MOST else np.inf
    far[open_] = np.nan

    def by_logarithm(y: Array, picked: Rows) -> tuple[Array, Array]:
        beyond = np.exp(y)
        value, rate = excess(start[picked] + beyond, picked)
        return value, rate * beyond

    least = np.maximum(2 * LEAST, far * 1e-40)
    low, high = np.log(np.maximum(_EPS * np.abs(start), least)), np.log(far)
    nearest = by_logarithm(low, np.arange(size.size))[0]
    beside = nearest >= 0
    high = np.where(nearest < 0, high, np.nan)
    y = increasing_root(by_logarithm, low, high, first, unit=1.0, broken=broken)
    return start + np.exp(np.where(beside, low, y))


def _between(excess: Excess, inner: Array, kinks: Array) -> tuple[Array, Array]:
    """The kinks between which `excess` changes its sign; `inner` before the first, or infinity."""
    ahead = kinks > inner
    passed = np.zeros(kinks.shape, bool)
    which, rows = np.nonzero(ahead)
    if rows.size:
        passed[which, rows] = excess(kinks[which, rows], rows)[0] < 0
    start = np.maximum(inner, np.max(np.where(passed, kinks, -np.inf), axis=0, initial=-np.inf))
    end = np.min(np.where(ahead & ~passed, kinks, np.inf), axis=0, initial=np.inf)
    return start, end
