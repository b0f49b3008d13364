"""Elements on the interface: mesh, influence, and means, by hand."""

import math

import numpy as np
import pytest

from generated import catenary, hertz, wedge
from generated.runtime.history import elements as of

ENDS = np.concatenate([np.linspace(-1, 0.5, 25), np.linspace(0.5, 1, 33)[1:]])
WIDTHS = np.diff(ENDS)
HERTZ, WEDGE = (hertz._BODY, {"R": 1.0}), (wedge._BODY, {"phi": 1.0})
ONE = np.ones(1)


# ---------------------------------------------------------------- mesh


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


# ---------------------------------------------------------------- influence


def test_all_elements_together_are_one():
    """-(1/pi) int int ln(|x - s|/(2 L)) ds dx = L**2 (3/2 + ln 2)/pi, however it is cut."""
    mesh = of.elements_of(ENDS)
    A = mesh.influence
    assert A.sum() == pytest.approx(4 * (1.5 + math.log(2)) / math.pi, rel=1e-9)
    assert pytest.approx(A.T, abs=1e-15) == A and np.all(np.linalg.eigvalsh(A) > 0)


def test_slip_changes_no_load_and_a_shift_no_shear():
    """K w = 0; the rise carries 1 and displaces all elements alike; A K = 1 - w rise."""
    mesh = of.elements_of(ENDS)
    scale = np.max(abs(mesh.stiffness)) * np.max(WIDTHS)
    assert abs(mesh.stiffness @ WIDTHS).max() < 1e-9 * scale
    assert mesh.rise @ WIDTHS == pytest.approx(1, rel=1e-12)
    shift = mesh.influence @ mesh.rise / WIDTHS
    assert shift == pytest.approx(np.full(WIDTHS.size, shift[0]), rel=1e-9)
    identity = mesh.influence @ mesh.stiffness + np.outer(WIDTHS, mesh.rise)
    assert identity == pytest.approx(np.eye(WIDTHS.size), abs=1e-9)


def test_the_shear_of_a_rigid_shift():
    """q = 1/(pi sqrt(1 - x**2)) displaces [-1, 1] evenly, by (ln 2 + ln 4)/pi."""
    ends = -np.cos(np.linspace(0, np.pi, 201))
    q = np.diff(np.arcsin(ends)) / np.pi / np.diff(ends)
    shift = of.elements_of(ends).influence @ q / np.diff(ends)
    assert shift == pytest.approx(np.full(200, math.log(8) / math.pi), rel=2e-3)


def test_values_beside_a_jump_know_nothing_of_it():
    """Straight lines on both sides of 0.5, where an element ends."""
    mesh = of.elements_of(ENDS)
    values = np.where(mesh.middles < 0.5, 1 + mesh.middles, 3.0)
    x = np.array([-1.0, -0.5, 0.5 - 1e-9, 0.5 + 1e-9, 1.0])
    assert of.value_at(mesh, values, x) == pytest.approx([0.0, 0.5, 1.5, 3.0, 3.0])


# ---------------------------------------------------------------- what acts on elements


def test_mean_pressures_of_a_cylinder():
    """p = sqrt(1 - x**2)/2: int p dx = (x sqrt(1 - x**2) + asin x)/4."""
    ends = np.linspace(-1.2, 1.2, 61)
    x = np.clip(ends, -1, 1)
    wanted = np.diff(x * np.sqrt(1 - x**2) + np.arcsin(x)) / 4 / np.diff(ends)
    (found,) = of.mean_pressures(*HERTZ, ends, ONE, ONE, ONE * math.pi / 4)
    assert found == pytest.approx(wanted, abs=2e-4)
    assert np.sum(found * np.diff(ends)) == pytest.approx(math.pi / 4, rel=1e-14)


def test_mean_pressures_carry_the_load_at_a_corner_too():
    ends = np.linspace(-1, 2, 40)
    (found,) = of.mean_pressures(*WEDGE, ends, 0.5 * ONE, 1.5 * ONE, 0.7 * ONE)
    assert np.sum(found * np.diff(ends)) == pytest.approx(0.7, rel=1e-14)
    outside = (ends[1:] <= -0.5) | (ends[:-1] >= 1.5)
    assert np.all(found[outside] == 0) and np.all(found[~outside] > 0)


def test_pressures_at_points():
    """A cylinder: sqrt(1 - x**2)/2; a wedge: arcosh(1/|x|)/pi; a body without a formula."""
    x = np.array([-1.5, -1.0, -0.999, -0.3, 0.2, 0.999999, 1.0, 1.1])
    (found,) = of.pressures(*HERTZ, x, ONE, ONE)
    assert found == pytest.approx(np.sqrt(np.maximum(1 - x**2, 0)) / 2, rel=1e-9)
    (found,) = of.pressures(*WEDGE, x, ONE, ONE)
    assert found == pytest.approx(np.arccosh(np.maximum(1 / abs(x), 1)) / np.pi, rel=1e-9)
    (found,) = of.pressures(catenary._BODY, {"R": 1.0, "b": 1.0}, x, ONE, ONE)
    wanted = catenary.pressure(x, 1.0, 1.0, E_star=1.0, R=1.0, b=1.0)
    assert found == pytest.approx(wanted, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(
    ("before", "now"), [((1, 1), (1, 1)), ((0.5, 0.5), (0.9, 0.8)), ((0.9, 0.8), (0.5, 0.5))]
)
def test_full_stick(before, now):
    """dq = (dQ/pi - dsigma x/4)/sqrt(1 - x**2) in a contact that stays: means from its integral; it
    carries the shear load while edges move, too."""
    a, c = np.transpose([before, now]).astype(float)
    (q,) = of.full_stick(ENDS, a, c, np.array([0.1, 0.4]), np.array([0.0, 0.2]))
    assert np.sum(q * WIDTHS) == pytest.approx(0.3, rel=1e-9)
    if before == now:
        wanted = np.diff(0.3 / np.pi * np.arcsin(ENDS) + 0.2 / 4 * np.sqrt(1 - ENDS**2)) / WIDTHS
        assert q == pytest.approx(wanted, rel=1e-12)
    else:
        assert not np.any(q[(ENDS[1:] < -0.9) | (ENDS[:-1] > 0.8)])
