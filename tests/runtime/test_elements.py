"""Elements on the interface: mesh, influence, and means, by hand."""

import math

import numpy as np
import pytest

from generated.runtime.history import elements as of
from generated.runtime.history.elements import TERMS, influence, inverse_of
from generated.runtime.kernels import LOOP, kernel, opened

from .laws import hertz, solved, wedge

ENDS = np.concatenate([np.linspace(-1, 0.5, 25), np.linspace(0.5, 1, 33)[1:]])
WIDTHS = np.diff(ENDS)


@kernel(LOOP)
def _each_mean(law, given, own, out):
    """given: a, c, the load, and the ends of elements; out: mean pressures."""
    law = opened(law)
    for i in range(given.shape[0]):
        a, c, load = given[i, 0], given[i, 1], given[i, 2]
        series = np.empty(TERMS)
        of.expand(law, own[i], a, c, series)
        of.mean_pressures(law, own[i], series, given[i, 3:].copy(), a, c, load, out[i])


@kernel(LOOP)
def _each_pressure(law, given, own, out):
    """given: a, c, then places; out: whether the pressure has a series there, then pressures."""
    law = opened(law)
    for i in range(given.shape[0]):
        a, c, series = given[i, 0], given[i, 1], np.empty(TERMS)
        out[i, 0] = of.expand(law, own[i], a, c, series)
        for k in range(2, given.shape[1]):
            out[i, k - 1] = of.pressure_at(law, own[i], series, given[i, k], a, c)


# ---------------------------------------------------------------- mesh


def test_elements_are_even_or_crowd_at_both_ends_and_end_at_every_break():
    """x = (1 - cos(pi i/n))/2 of the way."""
    breaks, i = np.empty(0), np.arange(9)
    even = of.mesh(np.array([[of.EVEN, -1.0, 3.0, 8.0]]), -1.0, 3.0, breaks, 8)
    assert even == pytest.approx(np.linspace(-1, 3, 9), abs=1e-10)
    crowded = of.mesh(np.array([[of.COSINE, -1.0, 3.0, 8.0]]), -1.0, 3.0, breaks, 8)
    assert crowded == pytest.approx(1 - 2 * np.cos(np.pi * i / 8), abs=1e-10)
    ends = of.mesh(np.array([[of.EVEN, 0.0, 1.0, 8.0]]), 0.0, 1.0, np.array([0.26, 0.8, 2.0]), 8)
    assert {0.26, 0.8} <= {*ends} and ends[-1] == 1 and np.all(np.diff(ends) > 0)


# ---------------------------------------------------------------- influence


def test_all_elements_together_are_one():
    """-(1/pi) int int ln(|x - s|/(2 L)) ds dx = L**2 (3/2 + ln 2)/pi, however it is cut."""
    whole = 4 * (1.5 + math.log(2)) / math.pi
    assert influence(np.array([-1.0, 1.0])) == pytest.approx(whole, rel=1e-14)
    A = influence(ENDS)
    assert A.sum() == pytest.approx(whole, rel=1e-9)
    assert np.array_equal(A, A.T) and np.all(np.linalg.eigvalsh(A) > 0)
    assert inverse_of(A) @ A == pytest.approx(np.eye(WIDTHS.size), abs=1e-9)
    assert not np.any(inverse_of(np.array([[1.0, 2.0], [2.0, 1.0]])))  # none


def test_the_shear_of_a_rigid_shift():
    """q = 1/(pi sqrt(1 - x**2)) displaces [-1, 1] evenly, -(1/pi) ln(1/(2 L)) - ... by
    (ln 2 + ln 4)/pi, since -(1/pi) int ln|x - s| q(s) ds = ln(2)/pi."""
    ends = -np.cos(np.linspace(0, np.pi, 201))
    q = np.diff(np.arcsin(ends)) / np.pi / np.diff(ends)
    shift = influence(ends) @ q / np.diff(ends)
    assert shift == pytest.approx(np.full(200, math.log(8) / math.pi), rel=2e-3)


# ---------------------------------------------------------------- what acts on elements


def test_mean_pressures_of_a_cylinder():
    """p = sqrt(1 - x**2)/2: int p dx = (x sqrt(1 - x**2) + asin x)/4."""
    ends = np.linspace(-1.2, 1.2, 61)
    x = np.clip(ends, -1, 1)
    wanted = np.diff(x * np.sqrt(1 - x**2) + np.arcsin(x)) / 4 / np.diff(ends)
    (found,) = solved(_each_mean, hertz, [[1.0, 1.0, math.pi / 4, *ends]], 60)
    assert found == pytest.approx(wanted, abs=2e-4)
    assert np.sum(found * np.diff(ends)) == pytest.approx(math.pi / 4, rel=1e-14)


def test_mean_pressures_carry_the_load_at_a_corner_too():
    ends = np.linspace(-1, 2, 40)
    (found,) = solved(_each_mean, wedge, [[0.5, 1.5, 0.7, *ends]], 39)
    assert np.sum(found * np.diff(ends)) == pytest.approx(0.7, rel=1e-14)
    outside = (ends[1:] <= -0.5) | (ends[:-1] >= 1.5)
    assert np.all(found[outside] == 0) and np.all(found[~outside] > 0)


def test_pressure_of_a_series_and_beside_a_corner():
    """A cylinder: sqrt(1 - x**2)/2; a wedge: arcosh(1/|x|)/pi, where no series converges."""
    x = np.array([-1.5, -1.0, -0.999, -0.3, 0.2, 0.999999, 1.0, 1.1])
    root = np.sqrt(np.maximum(1 - x**2, 0))
    (found,) = solved(_each_pressure, hertz, [[1.0, 1.0, *x]], 9)
    assert found[0] == 1 and found[1:] == pytest.approx(root / 2, rel=1e-9)
    (found,) = solved(_each_pressure, wedge, [[1.0, 1.0, *x]], 9)
    assert found[0] == 0
    assert found[1:] == pytest.approx(np.arccosh(np.maximum(1 / abs(x), 1)) / np.pi, rel=1e-9)


@pytest.mark.parametrize(
    ("before", "now"), [((1, 1), (1, 1)), ((0.5, 0.5), (0.9, 0.8)), ((0.9, 0.8), (0.5, 0.5))]
)
def test_full_stick(before, now):
    """dq = (dQ/pi - dsigma x/4)/sqrt(1 - x**2) in a contact that stays: means from its integral; it
    carries the shear load while edges move, too."""
    q, ends = np.zeros(WIDTHS.size), (np.array(before, float), np.array(now, float))
    of.add_full_stick(ENDS, *ends, 0.3, 0.2, q)
    assert np.sum(q * WIDTHS) == pytest.approx(0.3, rel=1e-9)
    if before == now:
        wanted = np.diff(0.3 / np.pi * np.arcsin(ENDS) + 0.2 / 4 * np.sqrt(1 - ENDS**2)) / WIDTHS
        assert q == pytest.approx(wanted, rel=1e-12)
    else:
        assert not np.any(q[(ENDS[1:] < -0.9) | (ENDS[:-1] > 0.8)])
