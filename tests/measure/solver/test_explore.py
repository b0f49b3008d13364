"""Cycles without a known solution: conclusions from the loads alone, compared with the solver."""

import numpy as np
import pytest

from tests.measure.solver.explore import (
    Kind,
    Point,
    at_constant_loads,
    cycle,
    explored,
    narrowest,
    threshold,
    window,
)
from tests.reference.conditions import LARGE, MODERATE, Premise
from tests.reference.mixed import NotInWindow, turning
from tests.reference.solver import reference

pytestmark = pytest.mark.slow


@pytest.mark.enough("*SHRINKS")
@pytest.mark.parametrize(
    ("point", "kind"),
    [
        (Point(1.2, 0.0, 0.02), Kind.SHRINKS),  # slip reverses on the right
        (Point(5.0, 0.0, 0.4), Kind.BEYOND),  # the pressure falls faster than the shear traction
        (Point(0.5, 0.0, 0.3), Kind.STICKS),
        (Point(1.2, 0.0, 0.1), Kind.AHEAD),
        (Point(1.0, 0.0, 0.0, 0.005), Kind.OPEN),
    ],
    ids=lambda value: value.name if isinstance(value, Kind) else "",
)
def test_where_the_premise_fails_the_conditions_do(point: Point, kind: Kind) -> None:
    found = explored(point.cycle, (12, 24, 48), (8, 12, 16))
    assert found.kind is kind
    if kind in (Kind.SHRINKS, Kind.BEYOND):
        assert found.off(found.large.zone) > 2 * found.estimate
        return
    assert Premise.NO_ZONE in (found.best.there, found.best.back)
    assert np.isnan(found.best.zone.m) and np.isnan(found.smallest.m)


@pytest.mark.enough("1.08-*")
@pytest.mark.parametrize(
    ("part", "regime"),
    [(0.931, "moderate"), (0.94, "turns round"), (1.08, "turns round"), (1.1, "large")],
)
def test_the_regime_at_constant_loads(part: float, regime: str) -> None:
    known = cycle(part * threshold())
    decided, zone = at_constant_loads(known.half_cycle)
    assert decided == regime
    found = reference(known.case, (12, 24, 48), (8, 8, 16))
    assert np.all(np.abs(np.subtract(found.zone, zone)) <= found.error)


@pytest.mark.parametrize(
    ("kappa", "inside", "outside"), [(MODERATE, 0.933, 0.931), (LARGE, 1.091, 1.092)]
)
def test_at_its_ends_the_window_meets_the_other_regimes(
    kappa: int, inside: float, outside: float
) -> None:
    """a + n = 8 dQ/(pi dsigma) with a = 1 at one end, m + n at the other."""

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
