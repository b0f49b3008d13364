"""The change of shear over a half-cycle, the slip range, and the shear itself.

Every stick zone is found here: in closed form for a cylinder under moderate tension, else by
scipy from the two conditions of large tension, integrated by QUADPACK.
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import root

from generated.runtime.slip import shear
from generated.runtime.types import StickZone
from tests.runtime.laws import flat_rounded, hertz, solved, wedge

NONE, MODERATE, LARGE, MIXED, SLIDING, FULL_STICK, UNSOLVED = range(7)
f = 0.5


def asked(x, cycle, zone):
    """Rows of the loops, one for each place."""
    x = np.atleast_1d(x)
    *cycle, friction = cycle
    rows = np.tile([*cycle, *zone, 0.0, friction, 1.0], (x.size, 1))
    rows[:, 9] = x
    return rows


def change(case, x, cycle, zone):
    return solved(shear.each_shear_change, case, asked(x, cycle, zone), 1)[:, 0]


def slip(case, x, cycle, zone):
    return solved(shear.each_slip_range, case, asked(x, cycle, zone), 1)[:, 0]


def pressures(case, cycle, x):
    a1, c1, a2, c2 = cycle[:4]
    of = case.functions.pressure
    with np.errstate(invalid="ignore"):
        return of(x, a1, c1, case.own) + of(x, a2, c2, case.own)


def cuts(side, case, cycle, end):
    """Distances from the stick zone at which the pressures in a slip zone are not smooth."""
    reach = cycle[0:3:2] if side < 0 else cycle[1:4:2]
    ends = [*reach, *(side * x for x in case.functions.breaks(case.own))]
    return [0.0, *sorted({e - end for e in ends if 0 < e - end <= max(reach) - end})]


def over(side, case, cycle, end, weight):
    """int (p1 + p2) weight(y)/sqrt(y) dy over a slip zone, y its distance from the stick zone."""

    def of(root):
        y = root * root
        return 2 * pressures(case, cycle, side * (end + y)) * weight(y)

    roots = np.sqrt(cuts(side, case, cycle, end))
    exact = {"epsabs": 1e-14, "epsrel": 1e-13, "limit": 400}
    return sum(quad(of, *part, **exact)[0] for part in pairwise(roots))


def large_zone(case, cycle, guess):
    """m and n from the conditions that dq is bounded at both ends."""
    dQ, dsigma = cycle[4:6]
    kappa = math.copysign(f, dsigma)

    def missing(ends):
        (m, n), h = ends, ends[0] + ends[1]
        ends = ((-1, m), (1, n))
        near = [over(s, case, cycle, e, lambda y: math.sqrt(h + y)) for s, e in ends]
        far = [over(s, case, cycle, e, lambda y: y / math.sqrt(h + y)) for s, e in ends]
        pull = math.pi * h * dsigma / 8
        return kappa * (near[0] - far[1]) - dQ - pull, kappa * (far[0] - near[1]) - dQ + pull

    found = root(missing, guess, tol=1e-14).x
    assert np.max(np.abs(missing(found))) < 1e-12
    return *found, LARGE


def moderate_zone(cycle):
    """A cylinder's: the contact at the mean load less dQ/(2 f), the mean tilt less dsigma/(4 f)."""
    a1, c1, a2, c2, dQ, dsigma, _ = cycle
    load = math.pi / 32 * ((a1 + c1) ** 2 + (a2 + c2) ** 2) - dQ / (2 * f)
    mid = (c1 - a1 + c2 - a2) / 4 + dsigma / (4 * f)
    return math.sqrt(4 * load / math.pi) - mid, math.sqrt(4 * load / math.pi) + mid, MODERATE


CYCLES = {
    "cylinder, moderate": (hertz, (1.2, 1.0, 1.2, 1.0, 0.3, 0.1, f), None),
    "cylinder, moderate, varying": (hertz, (1.2, 1.0, 1.15, 1.05, 0.3, -0.1, f), None),
    "cylinder, large": (hertz, (1.2, 1.0, 1.2, 1.0, 0.3, 0.8, f), (0.8, 0.9)),
    "wedge, large": (wedge, (1.3, 0.9, 1.3, 0.9, 0.2, -0.5, f), (1.2, 0.7)),
    "wedge, large, varying": (wedge, (1.3, 0.9, 1.26, 0.93, 0.2, 0.6, f), (1.0, 0.8)),
    "flat, large": (flat_rounded, (1.6, 2.0, 1.6, 2.0, 0.2, 0.4, f), (1.4, 1.8)),
    "flat, kinks in slip zones": (flat_rounded, (1.38, 1.17, 1.38, 1.17, 0.07, 0.2, f), (0.8, 0.8)),
}


@pytest.fixture(scope="module", params=CYCLES)
def known(request):
    """A body, a cycle, its stick zone."""
    case, cycle, guess = CYCLES[request.param]
    return case, cycle, moderate_zone(cycle) if guess is None else large_zone(case, cycle, guess)


def places(case, cycle, zone, *cuts, count=150):
    """Places and weights, by Gauss's rule in an angle where dq keeps its formula."""
    m, n, _ = zone
    ends = [-cycle[0], -cycle[2], -m, n, cycle[1], cycle[3]]
    kinks = case.functions.breaks(case.own)
    ends = sorted({*ends, *(k for k in (*kinks, *cuts) if min(ends) < k < max(ends))})
    place, weight = np.polynomial.legendre.leggauss(count)
    angle = math.pi / 4 * (place + 1)
    low, width = np.array(ends[:-1])[:, None], np.diff(ends)[:, None]
    x = low + width * np.sin(angle) ** 2
    return x.ravel(), (math.pi / 4 * width * np.sin(2 * angle) * weight).ravel()


def test_the_change_carries_the_shear_load(known):
    case, cycle, zone = known
    x, weight = places(case, cycle, zone)
    assert weight @ change(case, x, cycle, zone) == pytest.approx(cycle[4], rel=1e-7)


def strain(case, cycle, zone, x):
    """(1/pi) PV int dq/(x - xi) dxi - dsigma/4."""
    xi, weight = places(case, cycle, zone, x)
    here = change(case, x, cycle, zone)[0]
    there = change(case, xi, cycle, zone)
    left, right = max(cycle[0], cycle[2]), max(cycle[1], cycle[3])
    total = weight @ ((there - here) / (x - xi)) + here * math.log((x + left) / (right - x))
    return total / math.pi - cycle[5] / 4


def test_what_sticks_is_strained_by_tension_alone(known):
    case, cycle, zone = known
    for part in (0.03, 0.31, 0.87):
        x = -zone[0] + part * (zone[0] + zone[1])
        assert strain(case, cycle, zone, x) == pytest.approx(0, abs=2e-6 * abs(cycle[5]))


@pytest.mark.parametrize("side", (-1, 1))
@pytest.mark.parametrize("part", (0.23, 0.8))
def test_the_slip_range_is_the_integral_of_the_strain(known, side, part):
    case, cycle, zone = known
    end, reach = (zone[1], min(cycle[1], cycle[3])) if side > 0 else (zone[0], min(cycle[0:3:2]))
    x, step = side * (end + part * (reach - end)), 1e-3 * (reach - end)
    slips = slip(case, x + step * np.array([-2, -1, 1, 2]), cycle, zone)
    rate = (slips[0] - 8 * slips[1] + 8 * slips[2] - slips[3]) / (12 * step)
    assert side * rate == pytest.approx(2 * abs(strain(case, cycle, zone, x)), rel=3e-5)


def test_slip_grows_outward_from_the_stick_zone(known):
    case, cycle, zone = known
    for side, end, reach in ((-1, zone[0], min(cycle[0:3:2])), (1, zone[1], min(cycle[1:4:2]))):
        x = side * (end + (reach - end) * np.linspace(0, 1, 30) ** 2)
        x[[0, -1]] = side * end, side * reach
        found = slip(case, x, cycle, zone)
        assert found[0] == 0
        assert np.all(np.diff(found) > 0)
        assert np.isnan(slip(case, side * (reach + 1e-9), cycle, zone)[0])
    assert np.all(slip(case, np.linspace(-zone[0], zone[1], 5), cycle, zone) == 0)


@pytest.mark.parametrize("away", (1e-13, 1e-6, 0.2))
@pytest.mark.parametrize("side", (-1, 1))
def test_the_change_is_exact_close_to_a_slip_zone(known, side, away):
    case, cycle, zone = known
    m, n, regime = zone
    if regime != LARGE:
        pytest.skip("a difference of pressures")
    end = {-1: m, 1: n}
    x = side * (end[side] - away)
    away, h = end[side] - side * x, m + n  # as rounded
    across = h - away

    # y = away sinh(u)**2 leaves nothing singular
    ends = [math.asinh(math.sqrt(y / away)) for y in cuts(side, case, cycle, end[side])]

    def of(u):
        y = away * math.sinh(u) ** 2
        return pressures(case, cycle, side * (end[side] + y)) / (math.sqrt(h + y) * math.cosh(u))

    exact = {"epsabs": 1e-13, "epsrel": 1e-12, "limit": 400}
    beside = sum(quad(of, *part, **exact)[0] for part in pairwise(ends))
    beside *= 2 * math.sqrt(across)
    beyond = over(-side, case, cycle, end[-side], lambda y: 1 / (math.sqrt(h + y) * (y + across)))
    beyond *= math.sqrt(away * across)
    kappa = math.copysign(f, cycle[5]) * -side
    wanted = kappa * (beside - beyond) / math.pi
    scale = f * case.functions.pressure(0.1, *cycle[:2], case.own)
    assert change(case, x, cycle, zone)[0] == pytest.approx(wanted, abs=1e-11 * scale)


LARGE_CYCLE = (1.2, 1.0, 1.2, 1.0, 0.3, 0.8, f)
"""Of a cylinder."""


def follows(fall, zones):
    """Whether the shear traction follows from the rise to the loads of LARGE_CYCLE and a fall."""
    a, c, _, _, dQ, dsigma, _ = LARGE_CYCLE
    rise_zone, fall_zone = (StickZone(*zone) for zone in zones)
    return shear.rises_and_falls((a, c), (dQ, dsigma), rise_zone, fall, fall_zone)


def test_no_shear_where_a_cycle_takes_another_way():
    dQ, dsigma = LARGE_CYCLE[4:6]
    fall, nan = (0.75 * dQ, 0.75 * dsigma), math.nan
    whole = large_zone(hertz, LARGE_CYCLE, (0.8, 0.9))
    part = large_zone(hertz, (*LARGE_CYCLE[:4], *fall, f), (0.9, 0.9))
    assert follows(fall, (whole, part))
    for loads, zones in (
        ((1.01 * dQ, dsigma), (whole, whole)),  # more than there is
        ((0.75 * dQ, -0.75 * dsigma), (whole, part)),  # slip in the other sense
        (fall, (part, whole)),  # slip where there was none
        (fall, (whole, (*part[:2], MODERATE))),
        (fall, ((*whole[:2], MODERATE), part)),
        (fall, ((*whole[:2], MIXED), (*part[:2], MIXED))),
        (fall, (whole, (nan, nan, LARGE))),
        (fall, (whole, (nan, nan, UNSOLVED))),
        (fall, ((nan, nan, NONE), part)),
        ((0.75 * dQ, 0.2 * dsigma), (whole, part)),  # slip driven on at one edge
    ):
        assert not follows(loads, zones)


def test_each_regime():
    cycle, zone = LARGE_CYCLE, (0.8, 0.7)
    nan = (math.nan, math.nan)
    for regime in (NONE, SLIDING, UNSOLVED, MIXED, LARGE, MODERATE):
        assert np.isnan(change(hertz, 0.1, cycle, (*nan, regime)))
    for regime in (NONE, SLIDING, UNSOLVED):
        assert np.isnan(change(hertz, 0.1, cycle, (*zone, regime)))
    for x in (0.1, 0.9):
        mixed, moderate = (change(hertz, x, cycle, (*zone, of)) for of in (MIXED, MODERATE))
        assert mixed == moderate
    assert np.isnan(slip(hertz, 0.9, cycle, (*zone, MIXED)))
    assert slip(hertz, 0.1, cycle, (*zone, MIXED)) == 0
    stuck, varying = (1.2, 1.0, FULL_STICK), (1.2, 1.0, 1.3, 1.1, 0.0, 0.0, f)
    assert change(hertz, 0.1, cycle, stuck) == slip(hertz, 0.1, cycle, stuck) == 0
    assert np.isnan(change(hertz, math.nan, cycle, stuck))
    assert np.isnan(change(hertz, 0.1, varying, stuck))
    assert slip(hertz, 0.1, varying, stuck) == 0
    outside = change(hertz, [-2.0, 1.2, math.inf, math.nan], cycle, (*zone, LARGE))
    assert np.array_equal(outside, [0, 0, 0, math.nan], equal_nan=True)


def test_dq_is_finite_at_a_corner_that_sticks():
    """The logarithms of p1, p2 and p_s cancel."""
    cycle, zone = (1.3, 0.9, 1.3, 0.9, 0.2, 0.0, f), (1.0, 0.7, MODERATE)
    found = change(wedge, [-1e-9, 0.0, 1e-9], cycle, zone)
    assert found[1] == pytest.approx(found[0], rel=1e-7)
    assert found[1] == pytest.approx(found[2], rel=1e-7)
