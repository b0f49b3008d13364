"""Bodies of the library beside the limits of what they can be."""

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import circular_arc, flat_sloped, power, wedge_parabola
from generated.runtime.types import Contact, Regime

E = 2.0
R = 1.5


def _id(value: Any) -> str:
    return getattr(value, "__name__", "").split(".")[-1]


@pytest.mark.parametrize("k", [1.001, 1.03, 1.06, 1.064, 1.1])
def test_a_power_law_close_to_a_wedge_is_right_or_nan(k: float) -> None:
    """P = (E*/2) int x g' / sqrt(a**2 - x**2) dx, a beta function where a = c.

    Near k = 1, g'' ~ x**(k - 2) leaves a share x**(k - 1) below any x: 4e-16 at the least float.
    """
    a = 0.75
    beta = math.sqrt(math.pi) / 2 * math.gamma((k + 1) / 2) / math.gamma(k / 2 + 1)
    expected = E * a**k / R ** (k - 1) * beta
    load = float(power.load(a, a, E_star=E, L=R, k=k))
    half_width = float(power.contact(expected, 0.0, E_star=E, L=R, k=k).a)
    for value, right in ((load, expected), (half_width, a)):
        assert math.isnan(value) if k < 1.065 else abs(value / right - 1) < 1e-12


def _load_of_an_arc(a: float) -> float:
    """P = E* R (K - E), complete elliptic integrals of the modulus a / R."""
    squared = (mpmath.mpf(a) / R) ** 2
    return float(E * R * (mpmath.ellipk(squared) - mpmath.ellipe(squared)))


@pytest.mark.parametrize("short", [1e-3, 1e-5, 1e-6, 1e-8])
def test_an_arc_close_to_its_end_is_right_or_nan(short: float) -> None:
    """To 1e-12, or to what the last digit of a changes: a / (R - a) times as much in R - a."""
    a = R * (1 - short)
    expected = _load_of_an_arc(a)
    last_digit = _load_of_an_arc(math.nextafter(a, R)) / expected - 1
    load = float(circular_arc.load(a, a, E_star=E, R=R))
    half_width = float(circular_arc.contact(expected, 0.0, E_star=E, R=R).a)
    assert short < 3e-6 or not (math.isnan(load) or math.isnan(half_width))
    assert math.isnan(load) or abs(load / expected - 1) < max(1e-12, last_digit)
    assert math.isnan(half_width) or abs(half_width / a - 1) < 1e-12


@pytest.mark.parametrize("k", [1.07, 1.3, 2.5, 20.0])
def test_the_second_coefficient_of_a_centred_power_law_by_the_gamma_function(k: float) -> None:
    """r (3 + 2 r**2) = (a + s)**2 (5 a - s)/(a**2 - s**2)**(3/2), of which 5 a**3 + 3 a s**2 over
    that root is even in s; with u = (s/a)**2 the finite part of its integral with
    g'' = (k - 1) s**(k - 2) is half of 5 B((k - 1)/2, -1/2) + 3 B((k + 1)/2, -1/2), a**(k - 1)
    apart, where beta functions go on beyond zero: L_N = (k - 1) a**(k - 1)/(6 pi (2 a)**(3/2))
    times twice that half.  k = 2: B = 0 and -pi, L_N = -1/(4 sqrt(2 a)), as Hertz has it.
    """
    half = 0.75
    with mpmath.workdps(30):
        exponent = mpmath.mpf(k)
        betas = 5 * mpmath.beta((exponent - 1) / 2, -0.5)
        betas += 3 * mpmath.beta((exponent + 1) / 2, -0.5)
        scale = (exponent - 1) * half ** (exponent - 1) / (6 * mpmath.pi * 1.5**1.5)
        wanted = float(scale * betas)
    found = power.L_N(half, half, E_star=1.0, L=1.0, k=k)
    assert_allclose([*found], wanted, rtol=1e-13)


@pytest.mark.parametrize("place", [1.0332621980744286e-07, -1e-4])
def test_the_pressure_of_a_circular_arc_beside_its_lowest_point(place: float) -> None:
    """p = (E*/pi) int g'' L ds with g'' = R**2/(R**2 - s**2)**(3/2), and L = artanh of
    sqrt((c - x)(a + s)/((a + x)(c - s))) for s < x, else of its inverse: by mpmath, in parts that
    crowd towards x.  The body is cut at its lowest point, which leaves a short piece there.
    """
    left, right = 0.6690008998646891, 0.23710362890825895
    with mpmath.workdps(30):
        at = mpmath.mpf(place)

        def integrand(s: Any) -> Any:
            u, v = (right - at) * (left + s), (left + at) * (right - s)
            ratio = mpmath.sqrt(u / v) if s < at else mpmath.sqrt(v / u)
            return 9 / mpmath.sqrt(9 - s**2) ** 3 * mpmath.atanh(ratio)

        near = [mpmath.mpf(10) ** -k for k in range(19)]
        below = [at - (at + left) * step for step in near]
        above = [at + (right - at) * step for step in near]
        wanted = float(mpmath.quad(integrand, below) + mpmath.quad(integrand, above[::-1]))
    found = circular_arc.pressure(place, left, right, E_star=math.pi, R=3.0)
    assert_allclose(found, wanted, rtol=1e-13)


@pytest.mark.parametrize(
    ("body", "own", "corner"),
    [(wedge_parabola, {"phi": 0.01, "R": 0.3}, 0.0), (flat_sloped, {"phi": 0.1, "b": 0.02}, 0.02)],
    ids=_id,
)
def test_a_contact_that_ends_at_a_corner_is_found(body: Any, own: Any, corner: float) -> None:
    """K_N jumps at a corner: the edge stays there, and is not moved beyond it by rounding."""
    c = np.geomspace(1e-4, 100.0, 500)
    c = c[c > corner]
    a = np.full_like(c, corner)
    P, alpha = body.load(a, c, E_star=E, **own), body.tilt(a, c, **own)
    M = body.moment(a, c, E_star=E, **own)
    for found in (
        body.contact(P, M, E_star=E, **own),
        body.contact_at_tilt(P, alpha, E_star=E, **own),
    ):
        assert np.all(np.abs(found.a - a) <= 2e-14 * (a + c))
        assert np.all(np.abs(found.c - c) <= 2e-14 * (a + c))


def test_a_slip_zone_opposite_a_corner_at_the_edge_is_right_or_unsolved() -> None:
    """The left edge is 1e-17 to 1e-4 of the width beyond the corner at -b, where the pressure is so
    large that it hardly slips; the right slip zone is d = K_T/(f K_N), and short."""
    rng, b = np.random.default_rng(5), 0.02
    own = {"phi": 0.1, "b": b}
    h = b * 10 ** rng.uniform(-1, 1, 80)
    a = b + h * 10 ** rng.uniform(-17, -4, 80)
    c = h - a
    dQ = 10 ** rng.uniform(-6, -3, 80) * flat_sloped.load(a, c, E_star=E, **own)
    dsigma = rng.choice([-1, 1], 80) * 10 ** rng.uniform(0.2, 2, 80) * 8 * dQ / (np.pi * h)
    here = Contact(a, c, np.zeros(80))
    found = flat_sloped.stick_zone(here, here, dQ, dsigma, f=0.5, E_star=E, **own)
    first = flat_sloped.slip_zones(a, c, dQ, dsigma, f=0.5, E_star=E, **own).right
    known = (found.regime == Regime.LARGE) & (first < 3e-3 * h)
    assert np.count_nonzero(known) > 12
    assert_allclose((c - found.n)[known], first[known], rtol=0.2, atol=1e-14 * np.max(h))
