"""Tensions at which slip reverses: the exact stick zone compared with the solver."""

import numpy as np
import pytest

from tests.reference.conditions import LARGE, MODERATE
from tests.reference.explore import cycle, narrowest, threshold, window
from tests.reference.kernel import Surface
from tests.reference.mesh import graded
from tests.reference.mixed import NotInWindow, turning
from tests.reference.solver import level

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("kappa", "inside", "outside"), [(MODERATE, 0.933, 0.931), (LARGE, 1.091, 1.092)]
)
def test_at_its_ends_the_window_meets_the_other_regimes(
    kappa: int, inside: float, outside: float
) -> None:
    # both solutions are equal at a + n = 8 dQ/(pi dsigma), a = 1, and at m + n = 8 dQ/(pi dsigma)
    def beyond(part: float) -> float:
        zone = cycle(part * threshold()).half_cycle.exact(kappa)
        wide = 1 + zone.n if kappa == MODERATE else sum(zone)
        return kappa * (wide - narrowest(part * threshold()))

    assert beyond(outside) < 0 < beyond(inside)
    assert beyond(window()[kappa == LARGE]) == pytest.approx(0, abs=1e-9)
    half = cycle(inside * threshold()).half_cycle
    assert turning(half).zone == pytest.approx(half.exact(kappa), abs=2e-6)
    with pytest.raises(NotInWindow):
        turning(cycle(outside * threshold()).half_cycle)


def test_the_solver_ends_the_half_cycle_as_phase_three_does() -> None:
    # q = f p to the right of n_end, and less from n to n_end, where the surfaces stick again
    known = cycle(threshold())
    exact = turning(known.half_cycle)
    x = graded([-1.05, -1, -exact.zone.m, 0, exact.zone.n, exact.n_end, 1, 1.05], 24)
    found = level(known.case, Surface(x), 16)
    over = found.cycle.there.q / np.maximum(known.f * found.contacts[0].p, 1e-300)
    again = (x > exact.zone.n + 2e-4) & (x < exact.n_end - 2e-4)
    slips = (x > exact.n_end + 2e-4) & (found.contacts[0].p > 0)
    assert np.all(np.abs(over[again]) < 1 - 1e-6)
    np.testing.assert_allclose(over[slips], 1, rtol=1e-9)
