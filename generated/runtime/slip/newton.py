"""Newton's method for two slip zones.

The unknowns are the logarithms of their lengths divided by the width of the stick zone between
them, so that all three stay positive.
"""

import math
from typing import Any

from ..kernels import shared

MAX_STEPS = 40
"""Largest number of steps; four to six are common."""


@shared
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


@shared
def moved(width: float, left: float, right: float, by_left: float, by_right: float) -> Any:
    """Slip zones in a contact of given width after a step of log_step."""
    stuck = width - left - right
    left, right = left * math.exp(by_left), right * math.exp(by_right)
    shrink = width / (stuck + left + right)
    return left * shrink, right * shrink
