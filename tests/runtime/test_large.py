"""Large tension: the two conditions of the zone by SciPy's quadrature, limits, symmetry."""

import math
from itertools import pairwise

import pytest
from scipy.integrate import quad

from generated.runtime.slip.zone import LARGE

from .laws import flat_rounded, hertz, wedge
from .test_moderate import state, zone


def pressure(case, x, a, c):
    return case.functions.pressure(x, a, c, case.own)


def conditions(case, cycle, m, n):
    """int r/w dxi + pi dsigma/4 and int r xi/w dxi - dQ - pi dsigma (m - n)/8, theory.md."""
    a1, c1, a2, c2, dQ, dsigma, f = cycle
    kinks = (0.0,) if case is wedge else (-1.0, 1.0) if case is flat_rounded else ()
    strain, force = math.pi * dsigma / 4, -dQ - math.pi * dsigma * (m - n) / 8
    for side, start, ends in ((-1, m, (a1, a2)), (1, n, (c1, c2))):
        kappa = -side * math.copysign(1, dsigma)
        cuts = sorted({start, *ends, *(side * k for k in kinks if start < side * k < max(ends))})
        for low, high in pairwise(cuts):

            def r_over_w(angle, low=low, high=high, side=side, kappa=kappa, start=start):
                y = low + (high - low) * math.sin(angle) ** 2
                x = side * y
                p = pressure(case, x, a1, c1) + pressure(case, x, a2, c2)
                w = side * math.sqrt((y - start) * (y + m + n - start))
                return kappa * f * p / w * (high - low) * math.sin(2 * angle)

            def moment(angle, low=low, high=high, side=side, of=r_over_w):
                return of(angle) * side * (low + (high - low) * math.sin(angle) ** 2)

            limits = {"epsabs": 1e-14, "epsrel": 1e-12, "limit": 400}
            strain += quad(r_over_w, 0, math.pi / 2, **limits)[0]
            force += quad(moment, 0, math.pi / 2, **limits)[0]
    return strain / (math.pi * abs(dsigma) / 4), force / (math.pi * abs(dsigma) / 4)


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


@pytest.mark.parametrize("name", CYCLES)
def test_both_conditions_are_met(name):
    case, cycle = CYCLES[name]
    ((m, n, regime),) = zone(case, cycle)
    assert regime == LARGE
    off = conditions(case, cycle, m, n)
    assert max(map(abs, off)) < 2e-10 * (m + n)
    moved = conditions(case, cycle, m - 1e-6, n + 1e-6)
    assert max(map(abs, moved)) > 1e-7  # it is these that tell the place


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


def test_friction_and_shear_loads_twice_as_large():
    once, twice = zone(wedge, *((1.2, 0.7) * 2 + (0.1 * k, -0.5 * k, 0.5 * k) for k in (1, 2)))
    assert twice == pytest.approx(once, rel=1e-12) and twice[2] == LARGE
