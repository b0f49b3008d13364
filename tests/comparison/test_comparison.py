"""The exact stick zones are those of the independent solver, within its own estimate."""

import numpy as np
import pytest

from generated.runtime.types import Regime
from tests.comparison.cases import EVERY, PAPER, Compared, F
from tests.comparison.table import markdown, row

EACH = pytest.mark.parametrize("case", EVERY, ids=lambda case: case.name)


@pytest.mark.enough("[!c]*", "cylinder*")
@pytest.mark.slow
@EACH
def test_the_regime_is_that_of_its_name(case: Compared) -> None:
    first, second = case.contacts
    zone = case.module.stick_zone(first, second, *case.changes, f=F, **case.law)
    known = {"large": Regime.LARGE, "turns round": Regime.MIXED}
    named = [regime for words, regime in known.items() if words in case.name]
    assert zone.regime == (named or [Regime.MODERATE])[0]
    assert np.isnan(zone.m) == ("turns round" in case.name)


@pytest.mark.enough("5.2*", "5.3 large*", "5.5*", "two radii, slip*", "hyperbola*")
@pytest.mark.slow
@EACH
def test_solver_and_exact_conditions_agree(case: Compared) -> None:
    found = row(case, (12, 24, 48), (4, 8, 16))
    off = np.abs(np.subtract(found.solver, found.exact))
    assert np.all(off <= found.error)
    fine = 1e-2 if "turns round" in case.name else 1e-3  # there one zone is a few elements long
    assert np.all(np.array(found.error) < fine)


@pytest.mark.slow
def test_what_the_paper_prints_for_a_tilted_wedge_is_off() -> None:
    """Its K_T is that of a symmetric contact; the right one is exact there, d = K_T/(f K_N)."""
    (tilted,) = (case for case in PAPER if "5.4" in case.name)
    found = row(tilted, (8, 12, 16), (4, 4, 4))
    assert np.allclose(found.first, found.exact, rtol=1e-12)
    assert np.all(np.abs(np.divide(found.printed, found.exact) - 1) > 0.15)
    assert "5.4 tilted | left" in markdown([found])
