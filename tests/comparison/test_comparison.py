"""The exact stick zones agree with the independent solver, within its estimate of its error."""

import numpy as np
import pytest

from generated.runtime.types import Regime
from tests.comparison.cases import EVERY, PAPER, Compared, F
from tests.comparison.table import markdown, row


@pytest.mark.enough("5.2*", "5.3 large*", "two radii, slip*")
@pytest.mark.slow
@pytest.mark.parametrize("case", EVERY, ids=lambda case: case.name)
def test_solver_and_exact_conditions_agree(case: Compared) -> None:
    """In the regime that is part of the cycle's name."""
    zone = case.module.stick_zone(*case.contacts, *case.changes, f=F, **case.law)
    known = {"large": Regime.LARGE, "reverses": Regime.MIXED}
    named = [regime for words, regime in known.items() if words in case.name]
    assert zone.regime == (named or [Regime.MODERATE])[0]
    assert np.isnan(zone.m) == ("reverses" in case.name)
    result = row(case, (12, 24, 48), (4, 8, 16))
    difference = np.abs(np.subtract(result.solver, result.exact))
    assert np.all(difference <= result.error)
    # if slip reverses, one slip zone is only a few elements long
    limit = 1e-2 if "reverses" in case.name else 1e-3
    assert np.all(np.array(result.error) < limit)


@pytest.mark.slow
def test_the_printed_slip_zone_of_a_tilted_wedge_is_wrong() -> None:
    """The paper uses K_T of a symmetric contact; with the correct K_T, d = K_T/(f K_N) is exact."""
    (tilted,) = (case for case in PAPER if "5.4" in case.name)
    result = row(tilted, (8, 12, 16), (4, 4, 4))
    assert np.allclose(result.first, result.exact, rtol=1e-12)
    assert np.all(np.abs(np.divide(result.printed, result.exact) - 1) > 0.15)
    assert "5.4 tilted | left" in markdown([result])
