"""Newton's method kept within bounds: for one unknown in a bracket, and for two slip zones.

The unknowns for two slip zones are the logarithms of their lengths divided by the width of the
stick zone between them, so that all three stay positive.
"""

import math
from typing import Any

from ..kernels import kernel, real, results

EPS = 2.0**-52


@kernel(results(4)(results(4), real, real, real))
def narrowed(bracket: Any, value: float, rate: float, least: float) -> Any:
    """The bracket of the root of an increasing function after one more step.

    A bracket is low, high, the next point, and the length of the step to it, which is high - low at
    first.  Newton's step is taken if it stays inside and is at most half of the step before;
    otherwise the bracket is halved.  A step shorter than `least` is lengthened to `least`, to test
    whether it passes the root.
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
    """The Newton step in the logarithms of both slip zones over the stick zone.

    one, other: the residual of each condition, and its derivatives with respect to `left` and
    `right`.
    """
    residual, by_left, by_right = one
    other_residual, other_by_left, other_by_right = other
    determinant = by_left * other_by_right - by_right * other_by_left
    if determinant == 0:
        return math.nan, math.nan
    left_grows = (by_right * other_residual - other_by_right * residual) / determinant
    right_grows = (other_by_left * residual - by_left * other_residual) / determinant
    narrows = (left_grows + right_grows) / stuck
    return left_grows / left + narrows, right_grows / right + narrows


@kernel(results(2)(real, real, real, real, real))
def moved(width: float, left: float, right: float, by_left: float, by_right: float) -> Any:
    """Slip zones in a contact of given width after a step of log_step."""
    stuck = width - left - right
    left, right = left * math.exp(by_left), right * math.exp(by_right)
    shrink = width / (stuck + left + right)
    return left * shrink, right * shrink
