"""Functions of one place, kept as Chebyshev series, and Abel's equation for such a series.

A series is in s, 0 to 1; its terms come from values at the places `chebyshev_place`.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..kernels import COMPILED, kernel, matrix, real, vector, whole

if COMPILED:
    from numba import types

ANGLES = 64
"""Nodes of Gauss's rule."""

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


def record(kind: Callable[..., Any], *fields: Any) -> Any:
    """The type of a NamedTuple of such fields."""
    return types.NamedTuple(fields, kind) if COMPILED else real


TABLE = record(Table, real, real, real, vector)


@kernel(real(real))
def root(x: float) -> float:
    """sqrt(x), or zero of what rounding made negative."""
    return math.sqrt(max(x, 0.0))


@kernel(real(whole, whole))
def chebyshev_place(i: int, count: int) -> float:
    """The place number i of so many."""
    return (1 + math.cos(math.pi * (i + 0.5) / count)) / 2


@kernel(vector(vector))
def series_of(values: Any) -> Any:
    """Terms of the series with these values at its places."""
    count = len(values)
    terms = np.zeros(count)
    for k in range(count):
        for i in range(count):
            terms[k] += values[i] * math.cos(math.pi * k * (i + 0.5) / count)
        terms[k] *= 2 / count
    terms[0] /= 2
    return terms


@kernel(real(vector, real))
def summed(terms: Any, s: float) -> float:
    """A series at s."""
    t, this, last = 4 * s - 2, 0.0, 0.0
    for k in range(len(terms) - 1, 0, -1):
        this, last = terms[k] + t * this - last, this
    return float(terms[0] + t / 2 * this - last)


@kernel(real(real, real, real, whole, whole))
def table_place(start: float, end: float, near: float, i: int, count: int) -> float:
    """Where a table is sampled."""
    s = chebyshev_place(i, count)
    if near > 0:
        return start + near * math.sinh(math.asinh(math.sqrt((end - start) / near)) * s) ** 2
    return start + (end - start) * math.sin(math.pi / 2 * s) ** 2


@kernel(real(TABLE, real))
def tabled(table: Any, x: float) -> float:
    """A table's function at x; outside as at the nearer end."""
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


@kernel(vector(matrix))
def _eliminated(rows: Any) -> Any:
    """The solution of linear equations, by Gauss's elimination; their right sides come last."""
    count = len(rows)
    for k in range(count):
        pivot = k
        for i in range(k + 1, count):
            if abs(rows[i, k]) > abs(rows[pivot, k]):
                pivot = i
        if not abs(rows[pivot, k]) > 0:
            return np.full(count, math.nan)
        for j in range(k, count + 1):
            rows[k, j], rows[pivot, j] = rows[pivot, j], rows[k, j]
        for i in range(k + 1, count):
            factor = rows[i, k] / rows[k, k]
            for j in range(k, count + 1):
                rows[i, j] -= factor * rows[k, j]
    found = np.empty(count)
    for k in range(count - 1, -1, -1):
        found[k] = rows[k, count]
        for j in range(k + 1, count):
            found[k] -= rows[k, j] * found[j]
        found[k] /= rows[k, k]
    return found


@kernel(vector(real, vector))
def abel(width: float, right: Any) -> Any:
    """The series Lambda whose integrals at the places v are `right`.

    int_0^(pi/2) sqrt(width - (v sin(phi))**2) cos(phi) Lambda(v cos(phi)) dphi = right
    """
    count = len(right)
    rows = np.zeros((count, count + 1))
    for i in range(count):
        v = chebyshev_place(i, count)
        for j in range(ANGLES):
            phi = math.pi / 2 * GAUSS[j]
            far = root(width - (v * math.sin(phi)) ** 2) * math.cos(phi)
            t = 2 * v * math.cos(phi) - 1
            term = math.pi / 2 * GAUSS_WEIGHTS[j] * far
            last = t * term
            for k in range(count):
                rows[i, k] += term
                term, last = 2 * t * term - last, term
        rows[i, count] = right[i]
    return _eliminated(rows)
