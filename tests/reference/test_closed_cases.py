"""The stick zone of the solver converges to the exact one, within its estimate of the error."""

import numpy as np
import pytest

from tests.reference.cases import CLOSED, HERTZ_LOAD, Known
from tests.reference.solver import reference

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


@pytest.mark.parametrize("known", [k for k in CLOSED if k.name.startswith("Hertz, moderate")])
def test_moderate_conditions_are_the_contact_at_lower_load_and_other_tilt(known: Known) -> None:
    # load P0 - dQ/(2 f), tilt alpha0 - dsigma/(4 f E*); for R = E* = 1 the middle is at -M/P
    P0 = sum(known.P) / 2
    alpha0 = sum(M / P for M, P in zip(known.M, known.P, strict=True)) / 2
    half = np.sqrt((P0 - known.dQ / (2 * known.f)) / HERTZ_LOAD)
    middle = known.dsigma / (4 * known.f) - alpha0
    assert known.exact == pytest.approx((half - middle, half + middle), rel=1e-8)
