"""The root of an increasing function of one number: Newton's method kept between two bounds.

One use of it is the point where a tilted body is level.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from .elementary import EPS, LEAST, MOST
from .kernels import kernel

MAX_STEPS = 100
"""Largest number of steps of a search."""

CLOSEST = 1e-9
"""A root is not sought closer to a bound at which the function is infinite."""


class Search(NamedTuple):
    """A search for the root of an increasing function of y.

    low, high  bounds of the root
    top        the function at `high`; infinite if it is not known, or if it is infinite there
    guess      where the search began
    y, step    the next point, and its distance from the last one; step is 0 at the root
    unit       size of y: the root is found to a rounding of y, but of `unit` if that is larger
    """

    low: float
    high: float
    top: float
    guess: float
    y: float
    step: float
    unit: float


@kernel
def between(low: float, high: float, guess: float, unit: float) -> Search:
    """A search between bounds; it begins in the middle if the guess does not lie between them."""
    if not low < guess < high:
        guess = (low + high) / 2
    return Search(low, high, 0.0, guess, guess, high - low, unit)


@kernel
def by_distance(start: float, far: float, top: float, guess: float) -> Search:
    """A search for the logarithm of a distance from `start`, at most `far`, where the function
    equals `top`."""
    low = math.log(max(EPS * abs(start), LEAST))
    high = max(math.log(min(far, MOST)), low)
    y = min(max(math.log(max(guess, LEAST)), low), high)
    return Search(low, high, top, y, y, 16.0, 1.0)


@kernel
def narrowed(search: Any, value: float, rate: float) -> Search:
    """The search after the function has been evaluated at y.

    value, rate: the function and its derivative with respect to y; rate is 0 if it is not known.

    Newton's step is taken if it stays between the bounds and is at most half of the last step.
    Otherwise the next step doubles the distance from the guess, but goes at most half of the way
    to the bound.
    """
    low, high, top, guess, y, step, unit = search
    if value < 0:
        low, room = y, (high - y) / 2
    else:
        high, top, room = y, value, (low - y) / 2
    rounding = 2 * EPS * max(abs(y), unit)
    by = -value / rate if rate > 0 else math.inf
    if abs(by) <= rounding:
        return Search(low, high, 0.0, guess, y, 0.0, unit)
    if not (low < y + by < high and abs(by) <= step / 2):
        by = math.copysign(min(max(abs(y - guess), 2 * unit), abs(room)), room)
    done = abs(by) <= rounding or (top == math.inf and high - low < CLOSEST)
    return Search(low, high, top, guess, y + by, 0.0 if done else abs(by), unit)


@kernel
def level(law: Any, own: Any, alpha: float) -> float:
    """The point where the tilted body is level, g'(x) + alpha = 0; NaN if there is none.

    It is a corner if the tilt lies between the slopes there, and the middle of a flat.
    """
    if not abs(alpha) < math.inf:
        return math.nan
    before, beyond = -math.inf, math.inf  # the body falls left of `before`, rises from `beyond` on
    for at in law.breaks(own):
        if law.slope(np.nextafter(at, -math.inf), own)[0] + alpha <= 0:
            before = at
        if beyond == math.inf and law.slope(at, own)[0] + alpha >= 0:
            beyond = at
    if before >= beyond:
        return (before + beyond) / 2
    if before < 0 < beyond:
        excess = law.slope(0.0, own)[0] + alpha
        if excess == 0:
            return 0.0
        if excess < 0:
            before = 0.0
        else:
            beyond = 0.0
    # search for the distance from one end of the interval, to the right or to the left
    side, start, end = (1.0, before, beyond) if before > -math.inf else (-1.0, beyond, before)
    far = side * (end - start)
    guess = min(far / 2, abs(start) if start != 0 else 1.0)
    search = by_distance(start, far, math.inf if far == math.inf else 0.0, guess)
    for _ in range(MAX_STEPS):
        away = math.exp(search.y)
        slope, curvature = law.slope(start + side * away, own)
        search = narrowed(search, side * (slope + alpha), curvature * away)
        if search.step == 0:
            break
    return start + side * math.exp(search.y) if search.top < math.inf else math.nan
