"""Stick zones: regimes in order, closed forms of a cylinder, leading orders, mirror images.

The conditions of large tension are integrated by SciPy in test_shear.py and, for all bodies, in
tests/generated/test_stick.py.
"""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import generated.hertz
from generated.runtime.types import Contact, Regime

from .laws import flat_rounded, hertz, state, wedge, zone

NONE, MODERATE, LARGE, MIXED, SLIDING, FULL_STICK, UNSOLVED = list(Regime)[:7]
CYLINDER = {"f": 0.5, "E_star": 1.0, "R": 1.0}

LOAD = math.pi / 4  # of a cylinder whose contact is [-1, 1]


@pytest.mark.parametrize(
    ("cycle", "regime"),
    [
        ((1, 1, 1, 1, 0.1, 0.0, 0.5), MODERATE),
        ((1, 1, 1, 1, 0.1, 0.8, 0.5), LARGE),
        ((1, 1, 1, 1, 0.1, 0.13, 0.5), MIXED),
        ((1, 1, 1, 1, LOAD * (1 - 1e-9), 0.0, 0.5), MODERATE),
        ((1, 1, 1, 1, 1e-6, 0.0, 0.5), MODERATE),
        ((1, 1, 1, 1, 0.0, 1e-6, 0.5), LARGE),
        ((1, 1, 1, 1, LOAD, 0.0, 0.5), SLIDING),
        ((1, 1, 1, 1, 1.01 * LOAD, 5.0, 0.5), SLIDING),
        ((1, 1, 1, 1, 0.0, 0.0, 0.5), FULL_STICK),
        ((1, 1, 1.1, 1.1, 1e-3, 1e-3, 0.5), FULL_STICK),
        ((1, 1, 1, 1, -0.1, 0.0, 0.5), NONE),
        ((1, 1, 1, 1, 0.1, math.inf, 0.5), NONE),
        *(((1, 1, 1, 1, 0.1, 0.0, f), NONE) for f in (0.0, math.nan, -0.5)),
        ((1, 1, 1, 1, math.nan, 0.0, 0.5), NONE),
        ((1, 1, -1, 0.5, 0.1, 0.0, 0.5), NONE),
        # the moment turns an edge ahead of slip
        ((1, 1, 1.2, 0.8, 0.1, 0.0, 0.5), MIXED),
    ],
)
def test_regimes(cycle, regime):
    ((m, n, found),) = zone(hertz, cycle)
    assert found == regime
    known = {FULL_STICK, MODERATE, LARGE}
    assert (np.isfinite(m) and np.isfinite(n)) or regime not in known
    if regime in (NONE, SLIDING):
        assert np.isnan(m) and np.isnan(n)


def test_full_stick_keeps_what_is_always_in_contact():
    ((m, n, _),) = zone(hertz, (1.1, 1.05, 1, 1, 0, 0, 0.5))
    assert (m, n) == (1, 1)


def test_shear_that_grows_with_the_load_sticks_up_to_friction():
    more = math.pi * (1.1**2 - 1) / 4
    below, above = zone(hertz, *((1, 1, 1.1, 1.1, 0.5 * more * k, 0, 0.5) for k in (0.99, 1.01)))
    assert below[2] == FULL_STICK
    assert above[2] == MODERATE


def test_mixed_cycles_are_left_unknown_unless_asked_for():
    here = Contact(1.0, 1.0, 0.0)
    left = generated.hertz.stick_zone(here, here, 0.1, 0.13, **CYLINDER)
    assert left.regime == MIXED and np.isnan(left.m) and np.isnan(left.n)
    asked = generated.hertz.stick_zone(here, here, 0.1, 0.13, mixed=True, **CYLINDER)
    assert asked.regime in (MIXED, UNSOLVED) and np.isfinite(asked.m) == (asked.regime == MIXED)


def test_the_threshold_of_tension_by_hand():
    """8 dQ/(pi h) at constant loads; none where all slides, and none if the contacts differ."""
    here, dQ = Contact(1.1, 0.9, 0.0), 0.2
    lower, upper = generated.hertz.tension_threshold(here, here, dQ, **CYLINDER)
    assert upper == -lower == pytest.approx(4 * dQ / math.pi, rel=1e-15)
    for second, loads in ((here, 1.001 * LOAD), (Contact(1.2, 0.9, 0.0), dQ), (here, -dQ)):
        limits = generated.hertz.tension_threshold(here, second, loads, **CYLINDER)
        assert np.isnan(limits).all()


# ---------------------------------------------------------------- moderate tension


def test_a_cylinder_has_closed_forms():
    a, c, dQ, dsigma, f = 1.1, 0.9, 0.2, 0.13, 0.4
    h, P = a + c, math.pi * (a + c) ** 2 / 16
    stuck, shift = h * math.sqrt(1 - dQ / (2 * f * P)), dsigma / (2 * f)
    ((m, n, regime),) = zone(hertz, (a, c, a, c, dQ, dsigma, f))
    assert regime == MODERATE
    assert m + n == pytest.approx(stuck, rel=1e-13)
    assert n - m == pytest.approx(c - a + shift, rel=1e-12)


# ---------------------------------------------------------------- large tension

CYCLES = {
    "cylinder": (hertz, (1.1, 0.9, 1.1, 0.9, 0.1, 0.5, 0.5)),
    "wedge": (wedge, (1.2, 0.7, 1.2, 0.7, 0.1, -0.5, 0.5)),
    "wedge, slip next to the apex": (wedge, (52, 28.5, 52, 28.5, 2.7313, -0.30868, 0.059819)),
    "flat, slip beyond its kinks": (flat_rounded, (1.8, 1.9, 1.8, 1.9, 0.02, -1.4, 0.6)),
    "cylinder under varying loads": (hertz, (1.1, 0.9, 1.12, 0.93, 0.05, 0.35, 0.5)),
    "wedge under varying loads": (wedge, (1.1, 0.9, 1.09, 0.89, 0.05, -0.35, 0.5)),
    "flat under varying loads": (flat_rounded, (1.8, 1.7, 1.81, 1.71, 0.1, 0.4, 0.5)),
    "strip between two contacts": (wedge, (1.1, 0.9, 1.1 + 1e-7, 0.9 + 1e-7, 0.05, 0.35, 0.5)),
}


@pytest.mark.parametrize("case", [hertz, wedge, flat_rounded], ids=["hertz", "wedge", "flat"])
def test_slip_zones_that_vanish_have_their_leading_order(case):
    a, c, f = 1.3, 1.2, 0.5
    _, _, _, K_left, K_right = state(case, a, c)
    h, tension = a + c, 1e-6
    dQ = math.pi * h * tension / 80
    ((m, n, regime),) = zone(case, (a, c, a, c, dQ, tension, f))
    assert regime == LARGE
    pull = math.pi * h * tension / 8
    left, right = ((pull + s * dQ) / (math.pi * math.sqrt(h)) / f for s in (1, -1))
    assert a - m == pytest.approx(left / K_left, rel=1e-5)
    assert c - n == pytest.approx(right / K_right, rel=1e-5)


def test_slip_zones_too_small_for_their_edges_are_zero():
    ((m, n, regime),) = zone(hertz, (1, 1, 1, 1, 1e-25, 1e-22, 0.5))
    assert regime == LARGE
    assert m == pytest.approx(1, abs=1e-15) and n == pytest.approx(1, abs=1e-15)


@pytest.mark.parametrize("name", CYCLES)
def test_mirrored_and_run_backwards_it_is_the_same(name):
    case, (a1, c1, a2, c2, *loads, dsigma, f) = CYCLES[name]
    rows = (a1, c1, a2, c2, *loads, dsigma, f), (c1, a1, c2, a2, *loads, -dsigma, f)
    here, mirrored, backwards = zone(case, *rows, (a2, c2, a1, c1, *loads, dsigma, f))
    assert mirrored[1::-1] == pytest.approx(here[:2], rel=1e-12)
    assert backwards == pytest.approx(here, rel=1e-12)


@pytest.mark.parametrize("tension", [0.0106, -0.0106])
def test_an_edge_a_hair_beyond_a_kink_does_not_matter(tension):
    """The stick zone of [-b - d, c] tends to that of [-b, c] as d vanishes.  Singularities of the
    pressure are close to each other there."""
    rows = [(1 + d, 1.3, 1 + d, 1.3, 0.0048, tension, 0.3) for d in (1e-14, 1e-12, 1e-11)]
    zones = zone(flat_rounded, *rows)
    assert np.all(zones[:, 2] == LARGE)
    assert_allclose(zones[1:, :2], np.broadcast_to(zones[0, :2], (2, 2)), rtol=0, atol=1e-10)
