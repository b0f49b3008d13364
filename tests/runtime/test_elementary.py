"""Small functions that printed formulas call, by hand."""

import math

import pytest

from generated.runtime.elementary import kink_logarithm


@pytest.mark.parametrize(
    ("left", "right", "offset", "wanted"),
    [
        (4.0, 1.0, 3.0, 2.0),  # (sqrt(4) + 1)/3 = 1
        (1.0, 4.0, -3.0, 2.0),
        (0.0, 2.0, 1.0, 1.0),
        (-1.0, 2.0, 1.0, 1.0),
    ],
)
@pytest.mark.filterwarnings("ignore:invalid value")
def test_the_logarithm_of_a_kink(left, right, offset, wanted):
    """log(1 + (sqrt(l r) + min(l, r))/d), and nothing where one of both is negative."""
    assert kink_logarithm(left, right, offset) == pytest.approx(math.log(wanted), rel=1e-15)


def test_at_the_kink_the_least_distance_counts():
    assert kink_logarithm(1.0, 1.0, 0.0, 2.0) == pytest.approx(math.log(2), rel=1e-15)
