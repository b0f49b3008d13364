"""Functions of a single position, stored as Chebyshev series.

The variable of a series is s, from 0 to 1; its terms follow from the values at the points
`chebyshev_place`.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..kernels import kernel

ANGLES = 64
"""Number of nodes of Gauss's rule."""

_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(ANGLES)
GAUSS, GAUSS_WEIGHTS = (1 + _PLACES) / 2, _WEIGHTS / 2
"""Gauss's rule on (0, 1)."""


class Table(NamedTuple):
    """A function on (start, end).

    near = 0:  a series in s, x = start + (end - start) sin(pi s/2)**2: analytic in the square roots
               of both distances
    near > 0:  x = start + near sinh(reach s)**2: analytic in sqrt(y) and sqrt(y + near),
               y = x - start
    """

    start: float
    end: float
    near: float
    terms: Any


@kernel
def chebyshev_place(i: int, count: int) -> float:
    """Point number i of `count` Chebyshev points."""
    return (1 + math.cos(math.pi * (i + 0.5) / count)) / 2


@kernel
def series_of(values: Any) -> Any:
    """Terms of the series that has these values at its points."""
    count = len(values)
    terms = np.zeros(count)
    for k in range(count):
        for i in range(count):
            terms[k] += values[i] * math.cos(math.pi * k * (i + 0.5) / count)
        terms[k] *= 2 / count
    terms[0] /= 2
    return terms


@kernel
def summed(terms: Any, s: float) -> float:
    """The sum of a series at s."""
    t, current, previous = 4 * s - 2, 0.0, 0.0
    for k in range(len(terms) - 1, 0, -1):
        current, previous = terms[k] + t * current - previous, current
    return float(terms[0] + t / 2 * current - previous)


@kernel
def table_place(start: float, end: float, near: float, i: int, count: int) -> float:
    """Point number i of `count` at which a table is sampled."""
    s = chebyshev_place(i, count)
    if near > 0:
        return start + near * math.sinh(math.asinh(math.sqrt((end - start) / near)) * s) ** 2
    return start + (end - start) * math.sin(math.pi / 2 * s) ** 2


@kernel
def tabled(table: Any, x: float) -> float:
    """The function of a table at x; outside the table, its value at the nearer end."""
    y, length = x - table.start, table.end - table.start
    if y <= 0:
        s = 0.0
    elif y >= length:
        s = 1.0
    elif table.near > 0:
        s = math.asinh(math.sqrt(y / table.near)) / math.asinh(math.sqrt(length / table.near))
    else:
        s = 2 / math.pi * math.asin(math.sqrt(y / length))
    return summed(table.terms, s)
