"""Small functions that printed formulas call in addition to NumPy's own."""

import numpy as np

from .shared import shared
from .types import Array

TINY = 1e-150
"""Substitute for a distance of zero where a quotient must stay finite."""

EPS = 2.0**-52
"""Spacing of float64 next to 1."""

LEAST, MOST = 1e-75, 1e75
"""The shortest and the longest length, in metres, whose products stay well within float64."""


def where(condition: Array, first: Array, second: Array) -> Array:
    """`first` where the condition holds, else `second`; both may be numbers.

    Kernels use a version for single numbers, defined in kernels.py: numba's own np.where would
    return arrays.

    >>> float(where(1 < 2, 3.0, 4.0))
    3.0
    """
    chosen: Array = np.where(condition, first, second)
    return chosen[()]


@shared
def kink_logarithm(left: Array, right: Array, offset: Array, least: float = 0.0) -> Array:
    """log(1 + (sqrt(left right) + min(left, right))/d); zero where left or right is negative.

    d is the distance |offset| from the kink, but not less than `least`.

    >>> float(kink_logarithm(1.0, 1.0, 2.0))  # log 2
    0.6931471805599453
    """
    between = np.fmax(np.sqrt(left * right) + np.minimum(left, right), 0.0)
    return np.log1p(between / np.maximum(np.abs(offset), least))
