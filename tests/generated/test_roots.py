"""Roots inside brackets: where they are, where there is none, and how soon that is known."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from generated._roots import increasing_root

Function = Callable[[Any], tuple[Any, Any]]


def root(
    function: Function, low: float, high: float, *, broken: bool = False, unit: float = 0.0
) -> tuple[float, int]:
    """The root, and how many places were looked at for it."""
    asked = []

    def excess(x: Any, _: Any) -> tuple[Any, Any]:
        asked.append(x)
        return function(x)

    with np.errstate(all="ignore"):
        found = increasing_root(
            excess, np.array([low]), np.array([high]), unit=unit, broken=np.array([broken])
        )
    return float(found[0]), len(asked)


@given(st.floats(-5, 5), st.floats(0.1, 3))
def test_the_root_of_a_cubic(at: float, bend: float) -> None:
    """(x - at) + bend (x - at)**3, whose only root is at."""
    found, asked = root(
        lambda x: (x - at + bend * (x - at) ** 3, 1 + 3 * bend * (x - at) ** 2), -9, 9
    )
    assert_allclose(found, at, rtol=1e-15, atol=1e-14)
    assert asked <= 70


def test_a_value_that_never_becomes_zero_for_rounding() -> None:
    """x**2 = 2 has no root among floats: Newton's last step is nothing, and ends it."""
    found, asked = root(lambda x: (x * x - 2, 2 * x), 0, 1000)
    assert_allclose(found, 2**0.5, rtol=3e-16)
    assert asked <= 20


def test_noise_ends_the_search() -> None:
    """Noise of 1e-12 in what grows as exp(x) - 3: the root is as exact as that, and soon found."""
    found, asked = root(lambda x: (np.exp(x) - 3 + 1e-12 * np.sin(1e15 * x), np.exp(x)), -50, 50)
    assert_allclose(found, np.log(3), rtol=1e-11)
    assert asked <= 30


def test_a_function_that_ends_before_it_has_a_root() -> None:
    """-log(1 - x) - 30 is met at 1 - 1e-13; closer than 1e-6 to the end nobody looks."""
    found, asked = root(lambda x: (-np.log(1 - x) - 30, 1 / (1 - x)), 0, 2, broken=True)
    assert np.isnan(found)
    assert asked <= 30


def test_a_root_just_before_the_end_of_a_function() -> None:
    """-log(1 - x) = 11 at x = 1 - exp(-11), 1.7e-5 before the end."""
    found, _ = root(lambda x: (-np.log(1 - x) - 11, 1 / (1 - x)), 0, 2, broken=True)
    assert_allclose(found, 1 - np.exp(-11), rtol=1e-15)


@pytest.mark.parametrize("value", [np.nan, -np.inf, np.inf])
def test_no_numbers_have_no_root(value: float) -> None:
    assert np.isnan(root(lambda x: (0 * x + value, 0 * x + 1), 0, 1)[0])


def test_a_root_at_the_origin_of_logarithms() -> None:
    """exp(x) = 1: the place is rounded to parts of `unit`, not of itself."""
    found, asked = root(lambda x: (np.exp(x) - 1, np.exp(x)), -3, 5, unit=1.0)
    assert abs(found) <= 5e-16
    assert asked <= 15
