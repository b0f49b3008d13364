"""The search for a root: steps worked out by hand, and roots of functions that mislead Newton."""

import math

import pytest

from generated.runtime import search as of
from tests.runtime.laws import plain

between, by_distance, narrowed = map(plain, (of.between, of.by_distance, of.narrowed))


def steps(search, *values):
    """The points of a search whose function has these values and rates there."""
    points = [search.y]
    for value, rate in values:
        search = narrowed(search, value, rate)
        points.append(search.y)
    return points


def test_steps_by_hand():
    """From y = 1 with value 2 and rate 8 to 3/4; with rate 1 the step would leave the bounds."""
    search = between(0.0, 2.0, 1.0, 2.0)
    assert steps(search, (2.0, 8.0)) == [1.0, 0.75]
    assert steps(search, (2.0, 1.0)) == [1.0, 0.5]
    # a step is at most half of the one before: -1/4, then 1/8 at most, else half way to the bound
    assert steps(search, (2.0, 8.0), (-1.0, 8.0)) == [1.0, 0.75, 0.875]
    assert steps(search, (2.0, 8.0), (-1.0, 5.0)) == [1.0, 0.75, 0.875]


def test_steps_double_where_no_bound_is_near():
    """From 1 the logarithm goes up by 2, 2, 4, 8: as long as nothing is known above."""
    search = by_distance(0.0, math.inf, math.inf, 1.0)
    assert steps(search, *[(-1.0, 0.0)] * 4) == [0.0, 2.0, 4.0, 8.0, 16.0]


@pytest.mark.parametrize("guess", [1e-9, 0.3, 0.9])
@pytest.mark.parametrize("exponent", [1.0, 9.0, 1 / 9])
def test_a_root_is_found_to_a_rounding(guess, exponent):
    """y**k = 2**-k, and the same without a rate."""
    for known in (1.0, 0.0):
        search = between(0.0, 1.0, guess, 1.0)
        for _ in range(100):
            rate = known * exponent * search.y ** (exponent - 1)
            search = narrowed(search, search.y**exponent - 0.5**exponent, rate)
            if search.step == 0:
                break
        assert search.step == 0
        assert search.y == pytest.approx(0.5, abs=1e-15)
