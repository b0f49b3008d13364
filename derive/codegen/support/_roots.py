"""Roots of increasing functions, one of each element, inside brackets that never open again."""

from collections.abc import Callable
from typing import Any

import numpy as np

Array = Any
Rows = Any
"""Indices of the elements that are still worked on."""

STEPS = 100
"""Steps after which an element is given up, as NaN; five to ten are common."""

ROUNDING = 1e-9
"""A step below this part of the place that does not halve the step before shows rounding."""

CLOSEST = 1e-6
"""So close to its end, in parts of the place, a function is not searched for a root."""

_EPS = 2.0**-52

Excess = Callable[[Array, Rows], tuple[Array, Array]]
"""Value and rate of an increasing function, at places of some rows."""


def around(excess: Excess, start: Array) -> tuple[Array, Array]:
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


def increasing_root(
    excess: Excess,
    low: Array,
    high: Array,
    first: Array | None = None,
    *,
    unit: float = 0.0,
    broken: Array | None = None,
) -> Array:
    """The root of each row between low and high; NaN where there is none.

    Newton's step is taken where it stays between and at most halves the step before, else the
    middle; a small step that does not halve the one before is rounding, and the last.

    first: where to look first, if that lies between.
    unit: what places are rounded to parts of, where they are smaller themselves.
    broken: whether no number belongs to `high`.  Where that stays so of ever closer places, it is
        there that the function ends, and it has no root.
    """
    found = np.full(low.shape, np.nan)
    rows = np.flatnonzero(np.isfinite(low + high))
    low, high = low[rows], high[rows]
    ends = np.full(rows.shape, False) if broken is None else broken[rows]
    x, before = (low + high) / 2, high - low
    if first is not None:
        first = first[rows]
        x = np.where((first > low) & (first < high), first, x)
    for _ in range(STEPS):
        if not rows.size:
            break
        value, rate = excess(x, rows)
        number = np.isfinite(value)
        low, high = np.where(value < 0, x, low), np.where(value < 0, high, x)
        ends = np.where(value < 0, ends, ~number)
        step, size = -value / rate, np.maximum(np.abs(x), unit)
        halved = np.abs(step) < before / 2
        met = (value == 0) | (np.abs(step) <= 2 * _EPS * size)
        met |= ~halved & (np.abs(step) < ROUNDING * size) & (before < ROUNDING * size)
        inside = (x + step > low) & (x + step < high)
        following = np.where(inside & halved, x + step, (low + high) / 2)
        following = np.where(met, x, following)
        before = np.abs(following - x)
        ended = ends & (high - low < CLOSEST * size)
        done = met | (before <= 2 * _EPS * size) | ended
        found[rows[done]], on = np.where(number & ~ended, following, np.nan)[done], ~done
        rows, x, before, low, high, ends = (
            v[on] for v in (rows, following, before, low, high, ends)
        )
    return found
