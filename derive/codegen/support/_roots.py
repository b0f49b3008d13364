"""Roots of increasing functions, one of each element, inside brackets that never open again."""

from collections.abc import Callable
from typing import Any

import numpy as np

Array = Any
Rows = Any
"""Indices of the elements that are still worked on."""

STEPS = 100
"""Steps after which an element is given up, as NaN; five to ten are common."""

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


def increasing_root(excess: Excess, low: Array, high: Array, first: Array | None = None) -> Array:
    """The root of each row between low and high, sought from `first` where that lies between.

    Newton's step is taken where it stays between and at most halves the step before, else the
    middle.
    """
    found = np.full(low.shape, np.nan)
    rows = np.flatnonzero(np.isfinite(low + high))
    low, high = low[rows], high[rows]
    x, before = (low + high) / 2, high - low
    if first is not None:
        first = first[rows]
        x = np.where((first > low) & (first < high), first, x)
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
