"""Small functions that printed formulas call in addition to NumPy's own."""

import numpy as np

from .kernels import shared
from .types import Array

NOTHING = 1e-300
"""Substitute for a distance of zero in a denominator."""

EPS = 2.0**-52
"""Spacing of float64 next to 1."""

LEAST, MOST = 1e-75, 1e75
"""The shortest and the longest length, in metres, whose products stay well within float64."""


@shared
def kink_logarithm(left: Array, right: Array, offset: Array, least: float = 0.0) -> Array:
    """log(1 + (sqrt(left right) + min(left, right))/d); zero where left or right is negative.

    d is the distance |offset| from the kink, but not less than `least`.

    >>> float(kink_logarithm(1.0, 1.0, 2.0))  # log 2
    0.6931471805599453
    """
    between = np.sqrt(left * right) + np.minimum(left, right)
    return np.fmax(np.log1p(between / np.maximum(np.abs(offset), least)), 0.0)
