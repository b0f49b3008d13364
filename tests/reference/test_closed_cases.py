"""The stick zone of the solver converges to the exact one, within its estimate of the error."""

import re
from pathlib import Path

import numpy as np
import pytest

from tests.reference.cases import CLOSED, HERTZ, HERTZ_LOAD, Known
from tests.reference.kernel import Surface
from tests.reference.loads import State
from tests.reference.mesh import graded
from tests.reference.solver import Case, level, reference

COUNTS, STEPS = (12, 24, 48), (1, 2, 4)
ALONE = re.compile(r"^(?:from|import) (?!(?:numpy|scipy|pytest|tests\.reference)\b)(\w+)", re.M)
"""An import of anything but these, at the beginning of a line."""


@pytest.mark.slow
@pytest.mark.enough("Hertz, moderate, P and M vary", "tilted wedge, large")
@pytest.mark.parametrize("known", CLOSED, ids=lambda known: known.name)
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


def test_an_element_that_comes_back_to_friction_at_rest_has_not_slipped() -> None:
    # high mean shear load: the small cycle slips only where a sqrt(1 - dQ/(2 f P)) < |x|, but all
    # points that slipped in the first rise, a sqrt(1 - Q/(f P)) < |x|, are at q = f p at maximum Q
    f, dQ, mean = 0.5, 0.1, 0.25
    small, wide = np.sqrt(1 - dQ / (2 * f)), np.sqrt(1 - (mean + dQ / 2) / f)
    surface = Surface(graded([-1.05, -1, -small, -wide, wide, small, 1, 1.05], 12))
    states = (State(HERTZ_LOAD, 0, (mean + s * dQ / 2) * HERTZ_LOAD) for s in (1, -1))
    found = level(Case(HERTZ.body, f, *states), surface, 3)
    at_rest = (np.abs(found.x) > wide + 0.01) & (np.abs(found.x) < small - 0.01)
    q, p = found.cycle.back.q, found.contacts[0].p
    np.testing.assert_allclose(q[at_rest], f * p[at_rest], rtol=1e-9)
    assert found.zone == pytest.approx((small, small), abs=1e-3)


def test_nothing_of_the_package_that_is_checked_is_imported() -> None:
    for path in Path(__file__).parent.glob("*.py"):
        others = set(ALONE.findall(path.read_text(encoding="utf-8")))
        assert others <= {"re", "collections", "dataclasses", "enum", "functools", "itertools",
                          "pathlib", "typing"}, path.name  # fmt: skip
