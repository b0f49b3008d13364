"""Shear traction under Coulomb friction."""

from collections.abc import Sequence

import numpy as np
import pytest

from tests.reference.bounded import NoSolution
from tests.reference.cases import HERTZ, HERTZ_LOAD, WEDGE, Known
from tests.reference.conditions import LARGE
from tests.reference.kernel import Surface
from tests.reference.loads import State
from tests.reference.mesh import Floats, graded
from tests.reference.solver import Case, Level, level, reference

F = 0.5
SURFACE = Surface(graded([-1.05, -1, -0.8, 0.8, 1, 1.05], 16))

VARYING = Known("", WEDGE, LARGE, 0.15, 1.0, (1, 1), (0.1, 0.2)).case


def hertz(dQ: float, dsigma: float, f: float = F, mean: float = 0.0) -> Level:
    """The cycle of a cylinder with half-width 1; loads are relative to the load at that width."""
    states = (
        State(HERTZ_LOAD, 0, (mean + sign * dQ / 2) * HERTZ_LOAD, sign * dsigma / 2)
        for sign in (-1, 1)
    )
    return level(Case(HERTZ.body, f, *states), SURFACE, 3)


# ------------------------------------------------------------------ signs


def test_full_stick_has_the_known_singular_change() -> None:
    # dq = (dQ/pi - (dsigma/4) x)/sqrt(1 - x^2): the friction bound is reached only at the edges
    found = hertz(0.2, 0.3, f=500.0)
    change = found.cycle.there.q - found.cycle.back.q
    inner = np.abs(found.x) < 0.9
    x = found.x[inner]
    exact = (0.2 * HERTZ_LOAD / np.pi - 0.3 / 4 * x) / np.sqrt(1 - x**2)
    np.testing.assert_allclose(change[inner], exact, atol=2e-3)


# ------------------------------------------------------------------ every step


@pytest.fixture(scope="module")
def varying() -> Level:
    return reference(VARYING, (8, 12, 16), (4, 4, 4)).finest


def ends(found: Level) -> Sequence[tuple[Floats, Floats, float]]:
    """q, f p and Q at both ends of the half-cycle."""
    p1, p2 = found.contacts[0].p, found.contacts[-1].p
    there, back = found.cycle.there, found.cycle.back
    return (there.q, F * p2, VARYING.second.Q), (back.q, F * p1, VARYING.first.Q)


def test_shear_is_in_equilibrium_and_within_friction(varying: Level) -> None:
    for q, bound, Q in ends(varying):
        assert Surface(varying.x).force @ q == pytest.approx(Q, rel=1e-10)
        assert np.all(np.abs(q) <= bound * (1 + 1e-10))


def test_a_steady_cycle_closes(varying: Level) -> None:
    there, back = varying.cycle.there, varying.cycle.back
    touching = np.all([contact.p > 0 for contact in varying.contacts], axis=0)
    net = (there.slip + back.slip)[touching]
    assert np.abs(net).max() < 1e-6 * there.way.max()
    assert not there.way[np.all([contact.p == 0 for contact in varying.contacts], axis=0)].any()


def test_slip_is_against_friction(varying: Level) -> None:
    halves = varying.cycle.there, varying.cycle.back
    for half, (q, bound, _) in zip(halves, ends(varying), strict=True):
        slides = (np.abs(q) >= bound * (1 - 1e-10)) & (bound > 0)
        assert np.all(half.slip[slides] * q[slides] <= 1e-15)


# ------------------------------------------------------------------ traps


def test_an_element_that_comes_back_to_friction_at_rest_has_not_slipped() -> None:
    # high mean shear load: the small cycle slips only where a sqrt(1 - dQ/(2 f P)) < |x|, but all
    # points that slipped in the first rise, a sqrt(1 - Q/(f P)) < |x|, are at q = f p at maximum Q
    dQ, mean = 0.1, 0.25
    small, wide = np.sqrt(1 - dQ / (2 * F)), np.sqrt(1 - (mean + dQ / 2) / F)
    surface = Surface(graded([-1.05, -1, -small, -wide, wide, small, 1, 1.05], 24))
    states = (State(HERTZ_LOAD, 0, (mean + s * dQ / 2) * HERTZ_LOAD) for s in (1, -1))
    found = level(Case(HERTZ.body, F, *states), surface, 3)
    at_rest = (np.abs(found.x) > wide + 0.01) & (np.abs(found.x) < small - 0.01)
    q, p = found.cycle.back.q, found.contacts[0].p
    np.testing.assert_allclose(q[at_rest], F * p[at_rest], rtol=1e-9)
    assert found.zone == pytest.approx((small, small), abs=1e-3)


def test_sliding_is_refused() -> None:
    with pytest.raises(NoSolution, match="slides"):
        hertz(1.01, 0.0)
