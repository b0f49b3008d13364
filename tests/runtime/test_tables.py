"""Functions kept as Chebyshev series: polynomials exactly, roots as closely as they converge."""

import math

import numpy as np
import pytest

from generated.runtime.kernels import kernel, real, vector
from generated.runtime.slip.tables import (
    GAUSS,
    GAUSS_WEIGHTS,
    Table,
    chebyshev_place,
    series_of,
    summed,
    table_place,
    tabled,
)


@kernel(real(vector, real, real, real, real))
def _at(terms, start, end, near, x):
    return tabled(Table(start, end, near, terms), x)


def table(of, start, end, near, count=40):
    """The function as its table has it."""
    places = [table_place(start, end, near, i, count) for i in range(count)]
    terms = series_of(np.array([of(x) for x in places]))
    return lambda x: _at(terms, start, end, near, x)


def test_a_cubic_is_four_terms():
    places = [chebyshev_place(i, 4) for i in range(4)]
    terms = series_of(np.array([s**3 - 2 * s for s in places]))
    for s in (0.0, 0.3, 1.0):
        assert summed(terms, s) == pytest.approx(s**3 - 2 * s, abs=1e-14)


def test_places_lie_inside_and_fall():
    """cos of (i + 1/2) pi/8, from (-1, 1) to (0, 1)."""
    places = [chebyshev_place(i, 8) for i in range(8)]
    assert places[0] == pytest.approx((1 + math.cos(math.pi / 16)) / 2, rel=1e-15)
    assert places == sorted(places, reverse=True) and 0 < places[-1] < places[0] < 1


@pytest.mark.parametrize(
    ("near", "of"),
    [
        (0.0, lambda x: math.sqrt(x - 1) + math.sqrt(3 - x)),
        (1e-3, lambda x: math.sqrt(x - 1) + math.sqrt(x - 1 + 1e-3)),
    ],
)
def test_roots_at_the_ends_converge_fast(near, of):
    held = table(of, 1.0, 3.0, near)
    for x in (1.0, 1.0001, 1.7, 2.9999, 3.0):
        assert held(x) == pytest.approx(of(x), abs=1e-11)


def test_gauss_s_rule_is_of_degree_127():
    for power in (0, 1, 127):
        assert GAUSS_WEIGHTS @ GAUSS**power == pytest.approx(1 / (power + 1), rel=1e-13)
