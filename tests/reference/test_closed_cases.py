"""The stick zone of the solver converges to the exact one, within its estimate of the error."""

import numpy as np
import pytest

from tests.reference.cases import CLOSED, HERTZ_LOAD, Known
from tests.reference.conditions import Premise, premise
from tests.reference.loads import State
from tests.reference.normal import Body
from tests.reference.solver import Case, reference

COUNTS, STEPS = (12, 24, 48), (1, 2, 4)

EACH = pytest.mark.parametrize("known", CLOSED, ids=lambda known: known.name)
SOME = pytest.mark.enough("Hertz, moderate, P and M vary", "tilted wedge, large")


@pytest.mark.slow
@SOME
@EACH
def test_the_error_is_small_of_second_order_and_within_the_estimate(known: Known) -> None:
    found, exact = reference(known.case, COUNTS, STEPS), known.exact
    errors = np.abs(np.subtract(found.zones, exact))
    assert np.all(errors[-1] <= found.error)
    assert max(found.error) < 1e-3
    assert errors[-1].max() < 1e-4
    assert np.log2(errors[0].max() / errors[-1].max()) / 2 > 1.7


def test_steel_in_millimetres() -> None:
    # half-width b = sqrt(4 P R/(pi E*)) = 0.4 mm, n = b sqrt(1 - dQ/(2 f P)) + R dsigma/(4 f E*)
    R, E_star, f, b = 0.02, 1.15e11, 0.6, 4e-4
    P = np.pi * E_star * b**2 / (4 * R)
    dQ, dsigma = 0.4 * P, 1.2e8
    states = (State(P, 0, sign * dQ / 2, sign * dsigma / 2) for sign in (-1, 1))
    found = reference(Case(Body(lambda x: x**2 / (2 * R), E_star), f, *states), COUNTS, STEPS)
    half, shift = b * np.sqrt(1 - dQ / (2 * f * P)), R * dsigma / (4 * f * E_star)
    errors = np.abs(np.subtract(found.zone, (half - shift, half + shift)))
    assert np.all(errors <= found.error)
    assert max(found.error) < 1e-3 * b


@pytest.mark.parametrize("known", [k for k in CLOSED if k.name.startswith("Hertz, moderate")])
def test_moderate_conditions_are_the_contact_at_lower_load_and_other_tilt(known: Known) -> None:
    # load P0 - dQ/(2 f), tilt alpha0 - dsigma/(4 f E*); for R = E* = 1 the middle is at -M/P
    P0 = sum(known.P) / 2
    alpha0 = sum(M / P for M, P in zip(known.M, known.P, strict=True)) / 2
    half = np.sqrt((P0 - known.dQ / (2 * known.f)) / HERTZ_LOAD)
    middle = known.dsigma / (4 * known.f) - alpha0
    assert known.exact == pytest.approx((half - middle, half + middle), rel=1e-8)


@pytest.mark.slow
@SOME
@EACH
def test_slip_grows_all_through_both_half_cycles(known: Known) -> None:
    for half in (known.half_cycle, known.half_cycle.back()):
        assert premise(half, known.kappa, known.exact) is Premise.HOLDS


@pytest.mark.slow
@SOME
@EACH
def test_conditions_of_the_other_regime_do_not_hold(known: Known) -> None:
    other = known.half_cycle.exact(-known.kappa)
    assert premise(known.half_cycle, -known.kappa, other) is not Premise.HOLDS
