"""The root of an increasing function of one number: Newton's method kept between two bounds."""

import math
from typing import Any, NamedTuple

from .elementary import EPS
from .kernels import shared


class Search(NamedTuple):
    """A search for the root of an increasing function of y.

    low, high  bounds of the root
    guess      where the search began
    y, step    the next point, and its distance from the last one; step is 0 at the root
    unit       size of y: the root is found to a rounding of y, but of `unit` if that is larger
    """

    low: float
    high: float
    guess: float
    y: float
    step: float
    unit: float


@shared
def between(low: float, high: float, guess: float, unit: float) -> Search:
    """A search between bounds; it begins in the middle if the guess does not lie between them."""
    if not low < guess < high:
        guess = (low + high) / 2
    return Search(low, high, guess, guess, high - low, unit)


@shared
def narrowed(search: Any, value: float, rate: float) -> Search:
    """The search after the function has been evaluated at y.

    value, rate: the function and its derivative with respect to y; rate is 0 if it is not known.

    Newton's step is taken if it stays between the bounds and is at most half of the last step.
    Otherwise the next step doubles the distance from the guess, but goes at most half of the way
    to the bound.
    """
    low, high, guess, y, step, unit = search
    if value < 0:
        low, room = y, (high - y) / 2
    else:
        high, room = y, (low - y) / 2
    rounding = 2 * EPS * max(abs(y), unit)
    by = -value / rate if rate > 0 else math.inf
    if abs(by) <= rounding:
        return Search(low, high, guess, y, 0.0, unit)
    if not (low < y + by < high and abs(by) <= step / 2):
        by = math.copysign(min(max(abs(y - guess), 2 * unit), abs(room)), room)
    return Search(low, high, guess, y + by, abs(by) if abs(by) > rounding else 0.0, unit)
