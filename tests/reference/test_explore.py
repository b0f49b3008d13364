"""Cycles without a known solution: conclusions from the loads alone, compared with the solver."""

import numpy as np
import pytest

from tests.reference.conditions import LARGE, MODERATE, Premise, starts_within
from tests.reference.explore import (
    Kind,
    Point,
    at_constant_loads,
    cycle,
    explored,
    threshold,
)
from tests.reference.solver import reference

COUNTS, STEPS = (12, 24, 48), (8, 12, 16)


@pytest.mark.slow
@pytest.mark.enough("M0-*")
@pytest.mark.parametrize(
    ("M", "part", "why"),
    [
        ((-0.01, 0.01), 1.2, Premise.SHRINKS),  # slip reverses on the right
        ((-0.2, 0.2), 5.0, Premise.BEYOND),  # the pressure falls faster than the shear traction
        ((-0.1, 0.3), 5.0, Premise.SHRINKS),
    ],
)
def test_where_the_premise_fails_the_conditions_do(
    M: tuple[float, float], part: float, why: Premise
) -> None:
    point = explored(cycle(part * threshold(), M), COUNTS, STEPS)
    assert why in (point.large.there, point.large.back)
    assert point.off(point.large.zone) > 2 * point.estimate


@pytest.mark.enough("1.08-*")
@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.enough("point1-*")
@pytest.mark.parametrize(
    ("point", "kind"),
    [
        (Point(0.5, 0.0, 0.3), Kind.STICKS),
        (Point(1.2, 0.0, 0.1), Kind.AHEAD),
        (Point(1.0, 0.0, 0.0, 0.005), Kind.OPEN),
    ],
)
def test_where_there_is_no_zone_the_solver_tells_the_kind(point: Point, kind: Kind) -> None:
    found = explored(point.cycle, (8, 16, 24), (4, 6, 8))
    assert found.kind is kind
    assert np.isnan(found.best.zone.m) and np.isnan(found.smallest.m)


def test_a_half_cycle_starts_within_friction() -> None:
    # constant normal loads: dq' = (dQ - (pi/4) dsigma s)/(pi w) must have the sign of kappa from n
    # to c, and be positive from -m to -a.  With a = c = 1 this concerns the signs of K_T at the
    # edges, and the sign at the inner end of the region that has yet to slip
    half = cycle(0.9 * threshold()).half_cycle
    assert starts_within(half, MODERATE, half.exact(MODERATE))
    half = cycle(2 * threshold()).half_cycle
    zone = half.exact(LARGE)
    assert starts_within(half, LARGE, zone)
    root = 4 * half.dQ / (np.pi * half.dsigma)
    assert not starts_within(half, LARGE, zone._replace(n=root * 0.99))
    assert starts_within(half, LARGE, zone._replace(n=root * 1.01))


def test_pressure_that_falls_faster_than_shear_is_seen_at_the_start() -> None:
    # M from -0.1 to 0.3: the premise fails within a strip that contains none of the eight points
    half = Point(7.0, 0.1, 0.4).cycle.half_cycle
    ways = [(way, way.exact(LARGE)) for way in (half, half.back())]
    assert not all(starts_within(way, LARGE, zone) for way, zone in ways)
