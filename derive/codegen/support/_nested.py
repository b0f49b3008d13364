"""The contact edge by edge, for elements that Newton's method in both edges at once has lost.

For every left edge there is one right edge that meets the second condition, moment or tilt; and on
the contacts so found the load grows with the left edge.  So one root inside the other, each in a
bracket, finds every contact.  Where an edge lies just beyond a kink its distance from the kink is
what counts: the kink is found first, and the unknown is the logarithm of the distance from it.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ._roots import STEPS, Array, Excess, Rows, increasing_root
from ._state import State

_EPS = 2.0**-52


def edges(
    load: Array,
    goal: Any,
    size: Array,
    state: Callable[[Array, Array, Rows], State],
    rows: Rows,
    breaks: Sequence[Array],
) -> tuple[Array, Array]:
    """a and c of the elements `rows` of a problem; NaN where there is no contact.

    goal: the second condition; its `place` lies in every contact that meets it.
    state: what a contact carries, of some elements of the whole problem.
    breaks: places where the curve changes, of the elements `rows`.
    """
    place = goal.place
    to_left = [np.maximum(place - at, 0.0) for at in reversed(breaks)]
    to_right = [np.maximum(at - place, 0.0) for at in breaks]

    def turning(left: Array, right: Array, picked: Rows) -> tuple[State, Array, Array, Array]:
        wanted = goal.on(picked)
        a, c = left - wanted.place, right + wanted.place
        now = state(a, c, rows[picked])
        value, by_a, by_c = wanted.beyond(now, a + c, (c - a) / 2)
        return now, value, by_a, by_c

    def right_of(left: Array, picked: Rows) -> Array:
        def excess(right: Array, inner: Rows) -> tuple[Array, Array]:
            now, value, _, by_c = turning(left[inner], right, picked[inner])
            bare = ~(now.load > 0)
            return np.where(bare, -1.0, value), np.where(bare, 0.0, by_c)

        return _distance(excess, size[picked], [at[picked] for at in to_right])

    def excess(left: Array, picked: Rows) -> tuple[Array, Array]:
        right = right_of(left, picked)
        now, _, by_a, by_c = turning(left, right, picked)
        h = left + right
        force = np.pi * np.sqrt(h) / 4
        rate = force * (now.left - now.right * by_a / by_c) / now.load
        bare = ~(now.load > 0)
        value = np.where(bare, -1.0, np.log(now.load / load[picked]))
        return value, np.where(bare, 0.0, rate)

    everyone = np.arange(load.size)
    left = _distance(excess, size, to_left)
    right = right_of(left, everyone)
    return left - place, right + place


def _distance(excess: Excess, size: Array, kinks: Sequence[Array]) -> Array:
    """The distance at which `excess` changes its sign from minus; NaN where it never does.

    kinks: distances of kinks, in their order outward; zero for those on the other side.
    """
    everyone = np.arange(size.size)
    start, end = np.zeros(size.size), np.full(size.size, np.inf)
    for kink in kinks:
        at, _ = excess(np.where(kink > 0, kink, size), everyone)
        passed = (kink > 0) & (at < 0)
        short = (kink > 0) & ~(at < 0)
        start = np.where(passed, kink, start)
        end = np.where(short, np.minimum(end, kink), end)
    far = np.where(end < np.inf, end - start, np.maximum(size, start))
    open_ = np.flatnonzero(end == np.inf)
    for _ in range(STEPS):
        at, _ = excess(start[open_] + far[open_], open_)
        open_ = open_[at < 0]
        if not open_.size:
            break
        far[open_] *= 8
    far[open_] = np.nan

    def by_logarithm(y: Array, picked: Rows) -> tuple[Array, Array]:
        beyond = np.exp(y)
        value, rate = excess(start[picked] + beyond, picked)
        return value, rate * beyond

    least = np.maximum(_EPS * start, far * 1e-40)
    return start + np.exp(increasing_root(by_logarithm, np.log(least), np.log(far)))
