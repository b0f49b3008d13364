"""Tensions at which a cycle is no longer moderate, and at which a slip zone closes."""

import math

import numpy as np
import pytest

from generated.runtime.slip.threshold import each_closing_tension, each_tension_threshold
from generated.runtime.types import MODERATE

from .laws import flat_rounded, hertz, solved, state, wedge, zone

EACH = pytest.mark.parametrize("case", [hertz, wedge, flat_rounded], ids=["hertz", "wedge", "flat"])


def threshold(case, *cycle):
    return solved(each_tension_threshold, case, [(*cycle, 1.0)])[0]


def closing(case, *cycle):
    return solved(each_closing_tension, case, [(*cycle, 1.0)])[0]


def test_of_a_cylinder_by_hand():
    """8 dQ/(pi h) at constant loads; a zone closes as h falls to h sqrt(1 - dQ/(2 f P)) while one
    edge stays, alpha = (a - c)/2."""
    a, c, dQ, f = 1.1, 0.9, 0.2, 0.4
    stuck = 2 * math.sqrt(1 - dQ / (2 * f * math.pi / 4))
    lower, upper = threshold(hertz, a, c, a, c, dQ, f)
    assert upper == -lower == pytest.approx(4 * dQ / math.pi, rel=1e-15)
    lower, upper = closing(hertz, a, c, a, c, dQ, f)
    assert upper == -lower == pytest.approx(2 * f * (2 - stuck), rel=1e-12)


def test_of_a_wedge_by_hand():
    """P = sqrt(a c) = 1, dQ = 0.3 f P: P - dQ/(2 f) = 0.85 with c = 1 kept is m = 0.85**2, and the
    tilt (2/pi) atan((m - c)/(2 sqrt(m c))) is dsigma/(4 f) below zero; it begins to turn round at
    0.927 of that tension."""
    cycle = (1.0, 1.0, 1.0, 1.0, 0.15, 0.5)
    m = 0.85**2
    tilt = 2 / math.pi * math.atan((m - 1) / (2 * math.sqrt(m)))
    lower, upper = closing(wedge, *cycle)
    assert (lower, upper) == pytest.approx((2 * tilt, -2 * tilt), rel=1e-13)
    assert threshold(wedge, *cycle)[1] / upper == pytest.approx(0.927, abs=5e-4)


@EACH
def test_closing_tensions_close_a_slip_zone(case):
    a, c, f = 1.3, 1.25, 0.5
    first, second = state(case, a, c), state(case, 1.4, 1.35)
    dQ = f * first[0]
    lower, upper = closing(case, a, c, 1.4, 1.35, dQ, f)
    load = (first[0] + second[0] - dQ / f) / 2
    for tension, keeps in ((lower, "a"), (upper, "c")):
        tilt = (first[2] + second[2]) / 2 - tension / (4 * f)
        low, high = 0.0, 2.0  # of the width, by halving: the load grows with it
        for _ in range(60):
            width = (low + high) / 2 * (a + c)
            edges = (a, width - a) if keeps == "a" else (width - c, c)
            now = state(case, *edges)
            low, high = ((low + high) / 2, high) if not now[0] > load else (low, (low + high) / 2)
        assert now[2] == pytest.approx(tilt, abs=1e-12)


@EACH
def test_tension_is_moderate_between_its_thresholds_and_not_beyond(case):
    first, second, dQ, f = (1.3, 1.25), (1.32, 1.275), 0.1, 0.5
    lower, upper = threshold(case, *first, *second, dQ, f)
    assert lower < 0 < upper
    for bound in (lower, upper):
        inside, outside = zone(
            case, *((*first, *second, dQ, bound * (1 + by), f) for by in (-1e-9, 1e-9))
        )
        assert inside[2] == MODERATE != outside[2]


def test_no_tension_closes_a_zone_that_is_wider_than_the_smaller_contact():
    """Without shear the zone carries the mean of both loads, of which P_1 is the smaller."""
    assert np.isnan(closing(wedge, 1.0, 1.0, 1.1, 1.1, 0.0, 0.5)).all()


def test_there_is_none_where_all_slides():
    sliding = (1, 1, 1, 1, 1.001 * 2 * 0.5 * math.pi / 4, 0.5)  # f (P1 + P2)
    assert np.isnan(threshold(hertz, *sliding)).all()
    assert np.isnan(closing(hertz, *sliding)).all()
