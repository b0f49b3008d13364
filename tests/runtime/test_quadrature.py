"""Nodes and weights on a slip zone: integrals known by hand, at every level."""

import math

import numpy as np
import pytest

from generated.runtime.slip.quadrature import FINEST, double_exponential, slip_nodes

NO_CUTS = np.empty(0)


def integral(of, cuts=NO_CUTS, side=1.0, start=0.0, slip=1.0, length=1.0, level=0):
    y, weight = slip_nodes(np.asarray(cuts, dtype=float), side, start, slip, length, level)
    return weight @ of(y)


@pytest.mark.parametrize("level", range(FINEST + 1))
def test_roots_at_both_ends_are_smooth(level):
    """int sqrt(y (3 - y)) dy = pi 9/8 and int dy/sqrt(y) = 2 sqrt(3), from 0 to 3."""
    given = {"slip": 3.0, "length": 3.0, "level": level}
    found = integral(lambda y: np.sqrt(np.maximum(y * (3 - y), 0)), **given)
    assert found == pytest.approx(9 * math.pi / 8, rel=1e-13)
    found = integral(lambda y: 1 / np.sqrt(y), **given)
    assert found == pytest.approx(2 * math.sqrt(3), rel=1e-13)


@pytest.mark.parametrize(("level", "off"), [(0, 1e-6), (1, 1e-7), (2, 1e-13), (3, 1e-13)])
@pytest.mark.parametrize(("side", "start"), [(1.0, 0.5), (-1.0, 0.5)])
def test_a_logarithm_at_a_corner_on_either_side(level, off, side, start):
    """int_0^1 ln|y - 1/4| dy = (1/4) ln(1/4) + (3/4) ln(3/4) - 1; the corner is at x = +-3/4."""

    def of(y):
        return np.log(np.maximum(abs(y - 0.25), 1e-300))

    wanted = math.log(0.25) / 4 + 3 * math.log(0.75) / 4 - 1
    found = integral(of, [side * 0.75], side, start, level=level)
    assert found == pytest.approx(wanted, rel=off)


def test_it_is_cut_where_the_smaller_contact_ends():
    """int_0^1 sqrt(max(0, 1/2 - y)) dy = (2/3)/sqrt(8), and so for what begins there."""
    for of in (lambda y: np.maximum(0.5 - y, 0), lambda y: np.maximum(y - 0.5, 0)):
        found = integral(lambda y, of=of: np.sqrt(of(y)), slip=0.5)
        assert found == pytest.approx(2 / 3 / math.sqrt(8), rel=1e-14)


def test_the_double_exponential_rule():
    """int_0^1 ln(q) dq = -1."""
    q, weight = double_exponential(2.0**-5)
    assert weight @ np.log(q) == pytest.approx(-1, rel=1e-14)
