"""The open cases: what the loads alone decide, against the solver."""

import numpy as np
import pytest

from tests.reference.conditions import LARGE, Premise, premise
from tests.reference.explore import at_constant_loads, cycle, explored, threshold
from tests.reference.kernel import Surface
from tests.reference.solver import level, reference

pytestmark = pytest.mark.slow


COUNTS, STEPS = (12, 24, 48), (8, 12, 16)


def slow(*values: object) -> object:
    """A cycle that `make quick` leaves out."""
    return pytest.param(*values, marks=pytest.mark.slow)


@pytest.mark.parametrize(("span", "part"), [(0.05, 2.0), slow(0.2, 3.0), slow(0.3, 5.0)])
def test_where_the_premise_holds_the_conditions_do(span: float, part: float) -> None:
    point = explored(cycle(part * threshold(), (-span / 2, span / 2)), COUNTS, STEPS)
    assert point.large.holds
    assert point.off(point.large.zone) <= point.error < 1e-3


@pytest.mark.parametrize(
    ("M", "part", "why"),
    [
        ((-0.01, 0.01), 1.2, Premise.SHRINKS),  # slip turns round on the right
        slow((-0.2, 0.2), 5.0, Premise.BEYOND),  # pressure falls faster than shear
        slow((-0.1, 0.3), 5.0, Premise.SHRINKS),
    ],
)
def test_where_the_premise_fails_the_conditions_do(
    M: tuple[float, float], part: float, why: Premise
) -> None:
    point = explored(cycle(part * threshold(), M), COUNTS, STEPS)
    assert why in (point.large.there, point.large.back)
    assert point.off(point.large.zone) > 2 * point.error


def test_where_only_one_half_cycle_turns_round_its_smallest_zone_is_exact() -> None:
    point = explored(cycle(3 * threshold(), (0.0, 0.2)), (16, 32, 64), (8, 16, 16))
    assert point.large.shrinks
    assert point.off(point.smallest) <= point.error < point.off(point.large.zone)


def test_zones_that_grow_are_not_enough() -> None:
    # what was at friction goes on slipping while pressure falls; in one step it would not show
    known = cycle(5 * threshold(), (-0.2, 0.2))
    half = known.half_cycle
    zone = half.exact(LARGE)
    parts = [half.partial(part).zone(LARGE, zone) for part in (1.0, 0.8, 0.6)]
    assert parts[0].n < parts[1].n < parts[2].n
    assert premise(half, LARGE, zone) is Premise.BEYOND
    x = reference(known.case, (24, 36, 48), (1, 1, 1)).finest.x
    one, many = (level(known.case, Surface(x), steps).zone for steps in (1, 16))
    assert one == pytest.approx(zone, abs=5e-5)
    assert zone.n - many.n > 2e-4


@pytest.mark.parametrize(
    ("part", "regime"),
    [slow(0.931, "moderate"), slow(0.94, "turns round"), (1.08, "turns round"), slow(1.1, "large")],
)
def test_the_regime_at_constant_loads(part: float, regime: str) -> None:
    known = cycle(part * threshold())
    decided, zone = at_constant_loads(known.half_cycle)
    assert decided == regime
    found = reference(known.case, (16, 32, 64), (8, 8, 16))
    assert np.all(np.abs(np.subtract(found.zone, zone)) <= found.error)
