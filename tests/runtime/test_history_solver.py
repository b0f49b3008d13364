"""The solver of load histories: by the independent solver, exact zones, finer meshes, and work."""

from itertools import product

import numpy as np
import pytest

from generated.runtime.history import refine
from tests.measure.accuracy.histories import (
    CASES,
    CLOSED,
    TURNED,
    F,
    compared,
    covered,
    random_loads,
    settled,
    turning_points,
    works,
)

pytestmark = pytest.mark.slow


# ---------------------------------------------------------------- the independent solver


@pytest.mark.enough("flat_rounded-*")
@pytest.mark.parametrize(
    ("body", "varies", "smooth"),
    [("wedge", True, True), ("flat_rounded", False, False)],
)
def test_a_random_history_is_that_of_the_independent_solver(body, varies, smooth):
    loads = random_loads(CASES[body], np.random.default_rng(12), 6, varies, smooth)
    found = compared(CASES[body], loads, count=40, steps=10)
    assert found.answered and len(found.ends) >= 6
    assert np.mean(found.shear) < 3e-3
    ends, stated = np.array(found.ends), np.array(found.stated)
    assert np.mean(ends < 5e-3) > 0.9 and np.mean(ends <= stated) > 0.9


# ---------------------------------------------------------------- exact zones


@pytest.mark.parametrize("one", CLOSED[:8], ids=map(str, range(8)))
def test_turning_points_and_steady_cycles_come_to_the_exact_zone(one):
    for off, ratio in (turning_points(one, 1e-3), settled(one, 1e-3)):
        assert off < 3e-3 and ratio > 1


@pytest.mark.enough("turning_points-1-*", "settled-5-0.0001")
@pytest.mark.parametrize(
    ("found", "at", "tol"),
    [
        *((turning_points, at, 1e-5) for at in (1, 2, 5)),
        *product([settled], (1, 5, 8), (1e-3, 1e-4, 1e-5)),
    ],
)
def test_and_closer_when_asked(found, at, tol):
    """Large tension; moderate tension at varying loads; both together."""
    off, ratio = found(CLOSED[at], tol)
    assert off < tol and ratio > 1


def test_the_work_of_a_cycle_counts_what_slips_outside_the_smallest_contact():
    """A loop of P and Q whose zone is exact: what slips does so in contacts of 0.869 to 1.116.

    Against the work of the loads; 1e-2 of it is for its sums over time and place.
    """
    case, t = CASES["hertz"], np.arange(9) * np.pi / 4
    P = case.load * (1 + 0.24455 * np.cos(t) - 0.01563 * np.sin(t))
    Q = 0.00399 + 0.06699 * np.cos(t) - 0.01692 * np.sin(t)
    truth = works(case, (P, 0 * P, Q, 0 * P), 2).by_shear
    found = case.module.steady_cycle(P, 0, Q, 0, tol=1e-5, **case.constants)
    assert found.error == 0 and abs(found.work / truth - 1) < 0.03


@pytest.mark.enough("steady_cycle")
@pytest.mark.parametrize("function", ["history", "steady_cycle"])
def test_the_stated_errors_cover_the_true_ones(function):
    """In at least 95 of 100 instants, or all of a few cycles; the truth is that of finer meshes."""
    off, stated = np.transpose(covered(function, 5, 4e-3, 1e-3))
    assert np.mean(off <= stated + 1e-15) >= 0.95


# ---------------------------------------------------------------- energy


@pytest.mark.enough("wedge")
@pytest.mark.parametrize("body", TURNED)
def test_friction_takes_what_the_loads_give(body):
    """Within 2 %, of which 1e-3 is for the sums over time and place of the loads' work."""
    told = works(CASES[body], TURNED[body], 1)
    assert abs(told.friction - told.by_shear) < 0.02 * told.by_shear
    steady = CASES[body].module.steady_cycle(*TURNED[body], **CASES[body].constants)
    assert abs(steady.work - told.by_shear) < 0.02 * told.by_shear


@pytest.mark.parametrize(("dQ", "dsigma"), [(0.1, -0.9), (0.3, 0.1), (0.01, 1.5)])
def test_the_slip_range_of_a_steady_cycle_is_that_of_the_exact_zones(dQ, dsigma):
    case, P, M = CASES["flat_rounded"], 1.0, -0.05
    here = case.module.contact(P, M, E_star=1.0, **case.own)
    x = -here.a + np.linspace(0.02, 0.98, 31) * (here.a + here.c)
    part = np.array([0.5, 1.5, 1.2, 0.7])
    found = case.module.steady_cycle(P, M, dQ * part, dsigma * part, x=x, **case.constants)
    exact = case.module.slip_range(x, here, here, dQ, dsigma, **case.constants)
    assert np.max(abs(found.slip_range - exact)) <= 1e-12 * np.max(exact)
    rows = np.array(np.broadcast_arrays(P, M, dQ * part, dsigma * part))[:, [0, 1, 2, 3, 0]]
    on_mesh = refine.steady_cycle(case.module._BODY, case.own, F, rows, x, 1e-2).slip_range
    assert np.max(abs(on_mesh - exact)) <= 0.02 * np.max(exact)
