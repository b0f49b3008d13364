"""Newton's method kept within bounds: for one unknown in a bracket, and for two slip zones.

Two slip zones are sought by the logarithms of their lengths over the width of the stick zone
between them, so that all three stay positive.
"""

import math
from typing import Any

from ..kernels import kernel, real, results

EPS = 2.0**-52


@kernel(results(4)(results(4), real, real, real))
def narrowed(bracket: Any, value: float, rate: float, least: float) -> Any:
    """The bracket of an increasing function's root after one more step.

    A bracket is low, high, where to look next, and the length of the step there, high - low at
    first.  Newton's step is taken where it stays inside and at most halves the step before, else
    the middle.  A step shorter than `least` is made so long, to see whether it passes the root.
    """
    low, high, x, before = bracket
    if value < 0:
        low = x
    else:
        high = x
    step = -value / rate if rate > 0 else math.inf
    if abs(step) < least:
        step = math.copysign(least, -value)
    if not (low < x + step < high and abs(step) < before / 2):
        step = (low + high) / 2 - x
    return low, high, x + step, abs(step)


@kernel(results(2)(real, real, results(3), results(3), real))
def log_step(left: float, right: float, one: Any, other: Any, stuck: float) -> Any:
    """Newton's step of the logarithms of both slip zones over the stick zone.

    one, other: what two conditions are off by, and the rates of that with `left` and with `right`.
    """
    off, by_left, by_right = one
    other_off, other_by_left, other_by_right = other
    determinant = by_left * other_by_right - by_right * other_by_left
    if determinant == 0:
        return math.nan, math.nan
    left_grows = (by_right * other_off - other_by_right * off) / determinant
    right_grows = (other_by_left * off - by_left * other_off) / determinant
    narrows = (left_grows + right_grows) / stuck
    return left_grows / left + narrows, right_grows / right + narrows


@kernel(results(2)(real, real, real, real, real))
def moved(width: float, left: float, right: float, by_left: float, by_right: float) -> Any:
    """Slip zones in a contact of this width whose logarithms over the stick zone have grown."""
    stuck = width - left - right
    left, right = left * math.exp(by_left), right * math.exp(by_right)
    shrink = width / (stuck + left + right)
    return left * shrink, right * shrink
