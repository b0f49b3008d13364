"""Elements on the interface: mesh, values and means by hand; test_history.py tests the rest."""

import math

import numpy as np
import pytest

from generated import hertz
from generated.runtime.history import elements as of

ENDS = np.concatenate([np.linspace(-1, 0.5, 25), np.linspace(0.5, 1, 33)[1:]])
HERTZ = hertz._BODY, {"R": 1.0}
ONE = np.ones(1)


def test_elements_are_as_wide_as_they_are_far_from_the_points():
    """Width over (distance + a constant) is the same everywhere."""
    points = np.array([-1.0, 0.2, 3.0])
    ends = of.mesh(points, np.empty(0), 400)
    middles = (ends[1:] + ends[:-1]) / 2
    distance = np.min(abs(middles[:, None] - points), axis=1)
    ratio = np.diff(ends) / (distance + of.CLOSEST * 4)
    assert (ends[0], ends[-1], ends.size) == (-1, 3, 401)
    assert np.median(ratio) == pytest.approx(ratio, rel=0.03)


def test_an_element_ends_at_every_fixed_point():
    fixed = np.array([0.26, 0.8, 0.8 + 1e-9, 2.0])
    ends = of.mesh(np.array([0.0, 1.0]), fixed, 8)
    assert {0.26, 0.8} <= {*ends} and ends[-1] == 1 and np.all(np.diff(ends) > 1e-3)


def test_values_beside_a_jump_know_nothing_of_it():
    """Straight lines on both sides of 0.5, where an element ends."""
    mesh = of.elements_of(ENDS)
    values = np.where(mesh.middles < 0.5, 1 + mesh.middles, 3.0)
    x = np.array([-1.0, -0.5, 0.5 - 1e-9, 0.5 + 1e-9, 1.0])
    assert of.value_at(mesh, values, x) == pytest.approx([0.0, 0.5, 1.5, 3.0, 3.0])


def test_mean_pressures_of_a_cylinder():
    """p = sqrt(1 - x**2)/2: int p dx = (x sqrt(1 - x**2) + asin x)/4."""
    ends = np.linspace(-1.2, 1.2, 61)
    x = np.clip(ends, -1, 1)
    wanted = np.diff(x * np.sqrt(1 - x**2) + np.arcsin(x)) / 4 / np.diff(ends)
    (found,) = of.mean_pressures(*HERTZ, ends, ONE, ONE, ONE * math.pi / 4)
    assert found == pytest.approx(wanted, abs=2e-4)
    assert np.sum(found * np.diff(ends)) == pytest.approx(math.pi / 4, rel=1e-14)
