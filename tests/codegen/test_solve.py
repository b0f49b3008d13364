"""The solver behind the inverses: against closed inverses, over 24 decades of load."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from derive.codegen.support._solve import contact_at, contact_under, level
from derive.codegen.support._state import State
from generated import hertz, wedge

R, PHI = 1.5, 0.375
COUNT = 20_000

StateOf = Callable[..., State]


def hertz_state(a: Any, c: Any, *, R: Any) -> State:
    """P = pi h^2/16R, M = -P mid, alpha = -mid/R, K = sqrt(h)/2R, by hand."""
    h, mid = a + c, (c - a) / 2
    load = np.where(h > 0, np.pi * h**2 / (16 * R), np.nan)
    return State(load, -load * mid, -mid / R, np.sqrt(h) / (2 * R), np.sqrt(h) / (2 * R))


def wedge_state(a: Any, c: Any, *, phi: Any) -> State:
    """P = phi sqrt(ac), M = P (a - c)/4, alpha and K as in the paper, around the apex."""
    load = np.where((a > 0) & (c > 0), phi * np.sqrt(a * c), np.nan)
    scale = 2 * phi / (np.pi * np.sqrt(a * c * (a + c)))
    alpha = 2 * phi / np.pi * np.arctan((a - c) / (2 * np.sqrt(a * c)))
    return State(load, load * (a - c) / 4, alpha, scale * c, scale * a)


def decades(rng: np.random.Generator, low: float, high: float) -> np.ndarray:
    return 10.0 ** rng.uniform(low, high, COUNT)


@pytest.fixture(autouse=True)
def quiet() -> Any:
    """What does not exist is NaN; `elementwise` silences the warnings of the product."""
    with np.errstate(all="ignore"):
        yield


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize(
    ("state", "closed", "constants"),
    [(hertz_state, hertz.contact, {"R": R}), (wedge_state, wedge.contact, {"phi": PHI})],
    ids=["hertz", "wedge"],
)
def test_it_finds_what_the_closed_inverse_gives(
    state: StateOf, closed: Callable[..., Any], constants: dict[str, float], size: float
) -> None:
    """Over 24 decades of load, from a first size that is far too small, right or far too large."""
    rng = np.random.default_rng(1)
    load = decades(rng, -12, 12)
    wanted = closed(load, E_star=1.0, **constants)
    moment = load * wanted.a * rng.choice([-1, 1], COUNT) * decades(rng, -6, 2)
    wanted = closed(load, moment, E_star=1.0, **constants)
    found = contact_under(load, moment, size, state, **constants)
    width = wanted.a + wanted.c
    reach = np.maximum(width, np.abs(wanted.a))
    assert np.all(np.abs(found.a - wanted.a) <= 1e-13 * reach)
    assert np.all(np.abs(found.c - wanted.c) <= 1e-13 * reach)
    turn = width / R if "R" in constants else PHI  # a tilt that moves the edges by their distance
    assert np.all(np.abs(found.alpha - wanted.alpha) <= 1e-12 * (np.abs(wanted.alpha) + turn))


@pytest.mark.parametrize("kind", ["hertz", "wedge"])
def test_it_finds_the_contact_at_a_tilt(kind: str) -> None:
    rng = np.random.default_rng(2)
    load = decades(rng, -12, 12)
    if kind == "hertz":
        alpha = rng.choice([-1, 1], COUNT) * decades(rng, -9, 1)
        wanted = hertz.contact_at_tilt(load, alpha, E_star=1.0, R=R)
        found = contact_at(load, alpha, -alpha * R, 1.0, hertz_state, R=R)
    else:
        alpha = PHI * rng.uniform(-0.99, 0.99, COUNT)  # closer, the tilt itself is ill-conditioned
        wanted = wedge.contact_at_tilt(load, alpha, E_star=1.0, phi=PHI)
        found = contact_at(load, alpha, 0.0, 1.0, wedge_state, phi=PHI)
    reach = np.maximum(np.abs(wanted.a), np.abs(wanted.c))
    assert np.all(np.abs(found.a - wanted.a) <= 1e-12 * reach)
    assert np.all(np.abs(found.c - wanted.c) <= 1e-12 * reach)


@given(
    st.floats(1e-12, 1e12),
    st.floats(-5, 5),
    st.floats(0.01, 100),
)
def test_scaling_of_lengths_and_loads(load: float, arm: float, by: float) -> None:
    """On a wedge all lengths are proportional to P."""
    with np.errstate(all="ignore"):
        first = contact_under(load, load**2 * arm, 1.0, wedge_state, phi=PHI)
        second = contact_under(by * load, by**2 * load**2 * arm, 1.0, wedge_state, phi=PHI)
    assert_allclose([second.a, second.c], [by * first.a, by * first.c], rtol=1e-11)


def test_what_is_asked_may_not_exist() -> None:
    load = np.array([1.0, 0.0, -1.0, np.nan, np.inf, 1.0, 1.0])
    moment = np.array([0.0, 0.0, 0.0, 0.0, 0.0, np.nan, np.inf])
    found = contact_under(load, moment, 1.0, hertz_state, R=R)
    assert np.isnan(found.a).tolist() == [False] + 6 * [True]


@pytest.mark.slow
def test_neighbours_do_not_matter() -> None:
    """Every element alone gives the same bits as among hard ones and impossible ones."""
    rng = np.random.default_rng(3)
    load, moment = 10.0 ** rng.uniform(-9, 9, 40), rng.normal(size=40)
    load[::7] = -1.0
    together = contact_under(load, moment, 1.0, wedge_state, phi=PHI)
    for i, (P, M) in enumerate(zip(load, moment, strict=True)):
        alone = contact_under(P, M, 1.0, wedge_state, phi=PHI)
        assert_allclose(alone, [v[i] for v in together], rtol=1e-14)


def test_everything_broadcasts() -> None:
    load, moment, radius = np.ones((3, 1, 1)), np.zeros((4, 1)), np.array([1.0, 4.0])
    found = contact_under(load, moment, radius, hertz_state, R=radius)
    assert found.a.shape == found.c.shape == found.alpha.shape == (3, 4, 2)
    # P = pi (2a)^2/16R
    assert_allclose(found.a[0, 0], np.sqrt(4 * radius / np.pi), rtol=1e-14)


class Counted:
    """A state, and for how many contacts it was asked."""

    def __init__(self, state: StateOf) -> None:
        self.state, self.asked = state, 0

    def __call__(self, a: Any, c: Any, **constants: Any) -> State:
        self.asked += np.size(a)
        return self.state(a, c, **constants)


def test_the_state_is_asked_for_few_contacts() -> None:
    """However far the loads are apart."""
    counted = Counted(hertz_state)
    rng = np.random.default_rng(4)
    load = decades(rng, -12, 12)
    contact_under(load, rng.uniform(-1, 1, COUNT) * load, 1.0, counted, R=R)
    assert counted.asked <= 5 * COUNT


@pytest.mark.parametrize(("arm", "most"), [(0.0, 3), (0.25, 12), (-2.0, 12)])
def test_loads_that_differ_in_nothing_else_start_close_by(arm: float, most: int) -> None:
    """One step from between the rungs of a ladder, and the state that shows it was enough.

    With an arm, a contact under a small load is narrow and far off its apex; there all goes on as
    without the ladder.
    """
    counted = Counted(wedge_state)
    load = decades(np.random.default_rng(4), -6, 6)
    load[::100] = np.where(np.arange(COUNT // 100) % 2, np.nan, -1.0)
    found = contact_under(load, arm * load, 1.0, counted, phi=PHI)
    wanted = wedge.contact(load, arm * load, E_star=1.0, phi=PHI)
    reach = np.maximum(wanted.a, wanted.c)
    assert_allclose(found.a / reach, wanted.a / reach, atol=1e-13)
    assert_allclose(found.c / reach, wanted.c / reach, atol=1e-13)
    assert_allclose(found.alpha, wanted.alpha, atol=1e-12 * PHI)
    assert counted.asked <= most * COUNT


@pytest.mark.parametrize("alpha", [0.0, 0.9 * PHI])
def test_loads_at_one_tilt_start_close_by_too(alpha: float) -> None:
    counted = Counted(wedge_state)
    load = decades(np.random.default_rng(4), -6, 6)
    found = contact_at(load, alpha, 0.0, 1.0, counted, phi=PHI)
    wanted = wedge.contact_at_tilt(load, alpha, E_star=1.0, phi=PHI)
    assert_allclose([found.a, found.c], [wanted.a, wanted.c], rtol=1e-12)
    assert counted.asked <= 3 * COUNT


def test_many_times_the_same_load() -> None:
    found = contact_under(np.full(COUNT, 2.0), 0.5, 1.0, wedge_state, phi=PHI)
    wanted = wedge.contact(2.0, 0.5, E_star=1.0, phi=PHI)
    for field, value in zip(found, wanted, strict=True):
        assert_allclose(field, value, rtol=1e-14)


# ------------------------------------------------------------------ where the body is level


def quartic_slope(x: Any, *, C: Any) -> tuple[Any, Any]:
    return 4 * x**3 / C, 12 * x**2 / C


def corner_slope(x: Any, *, b: Any) -> tuple[Any, Any]:
    """|x - b| + x^2/2."""
    return np.sign(x - b) + x, np.ones_like(x)


def test_level_of_a_quartic() -> None:
    """4 x^3/C = -alpha."""
    rng = np.random.default_rng(5)
    alpha = rng.choice([-1, 1], COUNT) * decades(rng, -20, 20)
    found = level(quartic_slope, alpha, 1.0, C=2.0)
    assert_allclose(found, -np.cbrt(alpha / 2), rtol=1e-14)


def test_level_of_a_body_whose_parameters_are_named_as_its_arguments() -> None:
    def of(x: Any, *, slope: Any, size: Any) -> tuple[Any, Any]:
        return slope * x / size, slope / size

    assert level(of, -1.0, 4.0, slope=0.5, size=4.0) == pytest.approx(8.0, rel=1e-12)


def test_level_of_a_corner() -> None:
    """g' jumps from b - 1 to b + 1 at b = 2: level at the corner for -3 <= alpha <= -1."""
    alpha = np.array([-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 5.0])
    found = level(corner_slope, alpha, 1.0, (2.0,), b=2.0)
    assert_allclose(found, [3.0, 2.0, 2.0, 2.0, 1.0, 0.0, -4.0], atol=1e-300)


def test_level_is_nowhere_beyond_the_slopes() -> None:
    def slope(x: Any) -> tuple[Any, Any]:
        return np.tanh(x), 1 / np.cosh(x) ** 2

    found = level(slope, np.array([-1.5, -0.5, 0.0, 0.5, 1.5]), 1.0)
    assert np.isnan(found).tolist() == [True, False, False, False, True]
    assert_allclose(found[1:4], [np.arctanh(0.5), 0.0, -np.arctanh(0.5)], rtol=1e-14)
