"""Moderate tension: closed forms of a cylinder, and the equations of the zone on other bodies."""

import math

import numpy as np
import pytest

from derive.runtime.slip.threshold import each_closing_tension, each_tension_threshold
from derive.runtime.slip.zone import MODERATE, each_stick_zone

from .laws import Case, flat_rounded, hertz, wedge


def solved(loop, case: Case, rows, count=2):
    """What a loop finds, a row of `rows` a case."""
    given = np.atleast_2d(np.array(rows, dtype=float))
    own = np.tile(case.own, (len(given), 1))
    out = np.empty((len(given), count))
    loop(case.law, given, own, out)
    return out


def zone(case, *rows):
    return solved(each_stick_zone, case, rows, 3)


def state(case, a, c):
    function = case.functions.state
    return getattr(function, "py_func", function)(a, c, case.own)


def test_a_cylinder_has_closed_forms():
    a, c, dQ, dsigma, f = 1.1, 0.9, 0.2, 0.13, 0.4
    h, P = a + c, math.pi * (a + c) ** 2 / 16
    stuck, shift = h * math.sqrt(1 - dQ / (2 * f * P)), dsigma / (2 * f)
    ((m, n, regime),) = zone(hertz, (a, c, a, c, dQ, dsigma, f))
    assert regime == MODERATE
    assert m + n == pytest.approx(stuck, rel=1e-13)
    assert n - m == pytest.approx(c - a + shift, rel=1e-12)

    ((lower, upper),) = solved(each_tension_threshold, hertz, (a, c, a, c, dQ, f))
    assert upper == -lower == pytest.approx(8 * dQ / (math.pi * h), rel=1e-15)
    ((lower, upper),) = solved(each_closing_tension, hertz, (a, c, a, c, dQ, f))
    assert upper == -lower == pytest.approx(2 * f * (h - stuck), rel=1e-12)


@pytest.mark.parametrize("case", [wedge, flat_rounded], ids=["wedge", "flat"])
@pytest.mark.parametrize("varying", [False, True])
def test_the_zone_is_the_contact_of_less_load_and_tilt(case, varying):
    a, c, f = 1.3, 1.2, 0.5
    other = (1.31, 1.22) if varying else (a, c)
    first, second = state(case, a, c), state(case, *other)
    dQ = 0.3 * f * first[0]
    dsigma = dQ / 3
    ((m, n, regime),) = zone(case, (a, c, *other, dQ, dsigma, f))
    assert regime == MODERATE
    found = state(case, m, n)
    assert found[0] == pytest.approx((first[0] + second[0] - dQ / f) / 2, rel=1e-12)
    wanted = (first[2] + second[2]) / 2 - dsigma / (4 * f)
    assert found[2] == pytest.approx(wanted, abs=1e-13)


@pytest.mark.parametrize("case", [hertz, wedge, flat_rounded], ids=["hertz", "wedge", "flat"])
def test_closing_tensions_close_a_slip_zone(case):
    a, c, f = 1.3, 1.25, 0.5
    first, second = state(case, a, c), state(case, 1.4, 1.35)
    dQ = 0.4 * f * first[0]
    ((lower, upper),) = solved(each_closing_tension, case, (a, c, 1.4, 1.35, dQ, f))
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


@pytest.mark.parametrize("case", [hertz, wedge, flat_rounded], ids=["hertz", "wedge", "flat"])
def test_tension_is_moderate_between_its_thresholds_and_not_beyond(case):
    first, second, dQ, f = (1.3, 1.25), (1.32, 1.275), 0.1, 0.5
    ((lower, upper),) = solved(each_tension_threshold, case, (*first, *second, dQ, f))
    assert lower < 0 < upper
    for bound in (lower, upper):
        inside, outside = zone(
            case, *((*first, *second, dQ, bound * (1 + by), f) for by in (-1e-9, 1e-9))
        )
        assert inside[2] == MODERATE != outside[2]


def test_no_threshold_where_all_slides():
    sliding = 2 * 0.5 * math.pi / 4  # f (P1 + P2)
    found = solved(each_tension_threshold, hertz, [(1, 1, 1, 1, 1.001 * sliding, 0.5)])
    assert np.isnan(found).all()
    found = solved(each_closing_tension, hertz, [(1, 1, 1, 1, 1.001 * sliding, 0.5)])
    assert np.isnan(found).all()
