"""Large tension: the two conditions of the zone by SciPy's quadrature, limits, symmetry."""

import math

import pytest

from generated.runtime.types import LARGE

from .laws import flat_rounded, hertz, state, wedge, zone

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
