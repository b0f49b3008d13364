"""Bodies whose integrals have no closed form: the library's, and one with a corner and a flat.

Their laws are held against quadrature of slopes that are typed here by hand.
"""

import math

import mpmath as mp
import numpy as np
import pytest

from generated import catenary, circular_arc, hyperbola, power
from generated.runtime import pieces
from generated.runtime.kernels import BREAKS, PRESSURE, SERIES, SLOPE, STATE, Law, kernel
from generated.runtime.pieces import BESIDE_BREAK, curve_of

# ---------------------------------------------------------------- corner, flat and quartic


@kernel(BESIDE_BREAK)
def _kinked(piece, side, t, own):
    """phi |x| + max(0, x - b)**4/(4 R**3)."""
    phi, R = own[0], own[2]
    if piece < 2:
        return (phi if piece == 1 else -phi), 0.0, 0.0
    return phi + t**3 / R**3, 3 * t**2 / R**3, 6 * t**2 / R**3


@kernel(BREAKS)
def _kinked_breaks(own):
    return np.array([0.0, own[1]])


@kernel(BREAKS)
def _kinked_corners(own):
    return np.array([2 * own[0], 0.0])


@kernel(PRESSURE)
def _kinked_pressure(x, a, c, own):
    return pieces.pressure(curve_of(_kinked, _kinked_breaks, _kinked_corners), x, a, c, own)


@kernel(STATE)
def _kinked_state(a, c, own):
    return pieces.state(curve_of(_kinked, _kinked_breaks, _kinked_corners), a, c, own)


@kernel(SLOPE)
def _kinked_slope(x, own):
    return pieces.slope(curve_of(_kinked, _kinked_breaks, _kinked_corners), x, own)


@kernel(SERIES)
def _kinked_series(a, c, own):
    return pieces.series(curve_of(_kinked, _kinked_breaks, _kinked_corners), a, c, own)


# ---------------------------------------------------------------- the defining integrals of g'


class Body:
    """A law, its parameters, and the body's slope and curvature for mpmath."""

    def __init__(self, law, own, slope, curvature, breaks=(0.0,), corners=(0.0,)):
        self.law, self.own = law, np.array(own)
        self.slope, self.curvature = slope, curvature
        self.breaks, self.corners = breaks, corners

    def integral(self, f, a, c, *cuts):
        """int f(s)/w ds over the contact, in the angle."""
        mid, half = (c - a) / 2, (a + c) / 2
        inside = [(mp.mpf(x) - mid) / half for x in (*self.breaks, *cuts)]
        angles = sorted({mp.acos(z) for z in inside if -1 < z < 1} | {mp.mpf(0), mp.pi})
        return mp.quad(lambda angle: f(mid + half * mp.cos(angle)), angles)

    def state(self, a, c):
        a, c = mp.mpf(a), mp.mpf(c)
        h, mid = a + c, (c - a) / 2
        alpha = -self.integral(self.slope, a, c) / mp.pi
        first = self.integral(lambda s: (self.slope(s) + alpha) * s, a, c)
        second = self.integral(lambda s: (self.slope(s) + alpha) * s * s, a, c)
        left = self.integral(lambda s: self.curvature(s) * (c - s), a, c)
        right = self.integral(lambda s: self.curvature(s) * (a + s), a, c)
        for x, jump in zip(self.breaks, self.corners, strict=True):
            if -a < x < c:
                ratio = mp.sqrt((a + x) / (c - x))
                left, right = left + jump / ratio, right + jump * ratio
        root = mp.pi * mp.sqrt(h)
        return first / 2, -(second - mid * first) / 2, alpha, left / root, right / root

    def pressure(self, x, a, c):
        """(w(x)/(2 pi)) int (g'(s) - g'(x))/((s - x) w(s)) ds."""
        x, a, c = mp.mpf(x), mp.mpf(a), mp.mpf(c)
        here = self.slope(x)
        total = self.integral(lambda s: (self.slope(s) - here) / (s - x) if s != x else 0, a, c, x)
        return mp.sqrt((a + x) * (c - x)) * total / (2 * mp.pi)


def law_of(module):
    """Its private functions."""
    return Law(*(getattr(module, f"_{name}") for name in Law._fields))


def _of_power(k):
    exact = mp.mpf(k)
    return Body(
        law_of(power),
        [1.0, k],
        lambda s: mp.sign(s) * abs(s) ** (exact - 1),
        lambda s: (exact - 1) * abs(s) ** (exact - 2),
    )


HYPERBOLA = Body(
    law_of(hyperbola),
    [0.5, 0.25],
    lambda s: s / (4 * mp.sqrt(0.25 + s * s)),
    lambda s: 1 / (16 * mp.sqrt(0.25 + s * s) ** 3),
)
KINKED = Body(
    Law(_kinked_pressure, _kinked_state, _kinked_slope, _kinked_series, _kinked_breaks),
    [0.125, 0.25, 1.0],
    lambda s: mp.sign(s) / 8 + max(0, s - 0.25) ** 3,
    lambda s: 3 * max(0, s - 0.25) ** 2,
    (0.0, 0.25),
    (0.25, 0.0),
)
BODIES = {"power": _of_power(1.5), "hyperbola": HYPERBOLA, "kinked": KINKED}
CONTACTS = {
    "power": [(1.0, 0.5), (-0.25, 1.0), (1.0, 2e-9), (1.0, -1e-9)],
    "hyperbola": [(1.0, 0.5), (-0.25, 1.0), (20.0, 30.0), (0.01, 0.02)],
    "kinked": [(1.0, 0.5), (0.125, 2.0), (0.5, 0.25 + 1e-9), (1e-9, 1.0)],
}
CASES = [(name, *contact) for name, contacts in CONTACTS.items() for contact in contacts]


@pytest.fixture(autouse=True)
def _digits():
    with mp.workdps(40):
        yield


@pytest.mark.parametrize(("name", "a", "c"), CASES)
def test_states_and_pressures_are_the_integrals_that_define_them(name, a, c):
    body, h = BODIES[name], a + c
    found, exact = body.law.state(a, c, body.own), body.state(a, c)
    reach = max(abs(a), abs(c))
    steepest = max(abs(body.slope(mp.mpf(x))) for x in (-a, c))
    sizes = exact[0], exact[0] * reach, steepest, exact[3], exact[4]
    for value, true, size in zip(found, exact, sizes, strict=True):
        assert abs(value - true) < 1e-13 * size
    for x in (-a + 1e-6 * h, -a + 0.375 * h, c - 0.125 * h, 1e-7):
        if -a < x < c:
            found, exact = body.law.pressure(x, a, c, body.own), body.pressure(x, a, c)
            assert found == pytest.approx(float(exact), rel=1e-12, abs=0)


@pytest.mark.parametrize(("name", "a", "c"), CASES[:2] + CASES[4:6] + CASES[8:10])
def test_L_N_is_what_the_pressure_tends_to_at_an_edge(name, a, c):
    body = BODIES[name]
    K_left, K_right = body.state(a, c)[3:]
    L_left, L_right, *_ = body.law.series(a, c, body.own)
    s = mp.mpf(2) ** -36 * min(1, a + c)
    for L, K, x in ((L_left, K_left, -a + s), (L_right, K_right, c - s)):
        slowly = (body.pressure(x, a, c) / mp.sqrt(s) - K) / s
        assert abs(L - slowly) < 1e-7 * K / min(1, a + c)


@pytest.mark.parametrize(("name", "a", "c"), CASES[:2] + CASES[4:6])
def test_three_terms_leave_the_fourth_at_an_edge(name, a, c):
    """p/sqrt(s) - K - L s - N s**2 falls with s**3: by 64 for a quarter of s."""
    body = BODIES[name]
    K = body.state(a, c)[3:]
    L_left, L_right, N_left, N_right = body.law.series(a, c, body.own)
    left_terms, right_terms = (K[0], L_left, N_left), (K[1], L_right, N_right)
    for edge, inward, terms in ((-a, 1, left_terms), (c, -1, right_terms)):
        left = []
        for s in (mp.mpf(2) ** -7, mp.mpf(2) ** -9):
            p = body.pressure(edge + inward * s, a, c)
            left.append(p / mp.sqrt(s) - sum(t * s**k for k, t in enumerate(terms)))
        assert 40 < abs(left[0] / left[1]) < 100


def test_slopes_are_those_of_the_piece_on_the_right():
    assert KINKED.law.slope(0.25, KINKED.own) == (0.125, 0.0)
    assert KINKED.law.slope(-1e-9, KINKED.own) == (-0.125, 0.0)
    assert KINKED.law.slope(0.0, KINKED.own) == (0.125, 0.0)
    slope, curvature = HYPERBOLA.law.slope(-0.75, HYPERBOLA.own)
    assert slope == pytest.approx(float(HYPERBOLA.slope(mp.mpf(-0.75))), rel=1e-15)
    assert curvature == pytest.approx(float(HYPERBOLA.curvature(mp.mpf(-0.75))), rel=1e-15)


# ---------------------------------------------------------------- closed formulas


def test_the_third_power_is_what_a_hand_finds():
    cube = _of_power(3.0)
    # P = (1/2) int 2 |s| sqrt(1 - s**2) ds;  p(0) = (1/(2 pi)) int |s|/sqrt(1 - s**2) ds
    assert cube.law.state(1.0, 1.0, cube.own)[0] == pytest.approx(2 / 3, rel=1e-14)
    assert cube.law.pressure(0.0, 1.0, 1.0, cube.own) == pytest.approx(1 / math.pi, rel=1e-14)


@pytest.mark.parametrize(("a", "c"), [(1.0, 1.0), (2.0, -0.5), (30.0, 20.0)])
def test_loads_of_a_catenary_are_bessel_functions(a, c):
    R, b = 2.0, 0.75
    mid, half = mp.mpf(c - a) / 2, mp.mpf(a + c) / 2
    load = mp.cosh(mid / b) * mp.pi * half * b * mp.besseli(1, half / b) / (2 * R)
    tilt = -b / R * mp.sinh(mid / b) * mp.besseli(0, half / b)
    found = catenary._state(a, c, np.array([R, b]))
    assert found[0] == pytest.approx(float(load), rel=1e-13)
    assert found[2] == pytest.approx(float(tilt), rel=1e-12)


# ---------------------------------------------------------------- symmetry, scale, existence


@pytest.mark.parametrize("size", [1e-70, 1e-9, 1e60])
def test_loads_grow_with_the_size_of_a_body(size):
    (b, phi), law = HYPERBOLA.own, HYPERBOLA.law
    load, moment, tilt, left, right = law.state(1.0, 0.5, np.array([b, phi]))
    found = law.state(size, 0.5 * size, np.array([b * size, phi]))
    grown = load * size, moment * size**2, tilt, left / math.sqrt(size), right / math.sqrt(size)
    assert found == pytest.approx(grown, rel=1e-13)
    pressure = law.pressure(0.1, 1.0, 0.5, np.array([b, phi]))
    found = law.pressure(0.1 * size, size, 0.5 * size, np.array([b * size, phi]))
    assert found == pytest.approx(pressure, rel=1e-13)


def test_what_is_no_contact_carries_nothing():
    for body, a, c in ((HYPERBOLA, 1.0, -1.0), (KINKED, -0.05, 0.2), (HYPERBOLA, math.nan, 1.0)):
        assert all(map(math.isnan, body.law.state(a, c, body.own)))
    assert math.isnan(HYPERBOLA.law.pressure(0.0, 0.0, 0.0, HYPERBOLA.own))
    assert HYPERBOLA.law.pressure(2.0, 1.0, 1.0, HYPERBOLA.own) == 0
    assert KINKED.law.pressure(0.0, 1.0, 1.0, KINKED.own) == math.inf
    assert 0 < KINKED.law.pressure(1e-300, 1.0, 1.0, KINKED.own) < 100


def test_a_contact_beyond_the_curve_has_a_load_without_limit():
    R = np.array([1.0])
    assert circular_arc._state(0.5, 0.75, R)[0] < math.inf
    load, *rest = circular_arc._state(0.5, 1.25, R)
    assert load == math.inf
    assert all(map(math.isnan, rest))


def test_an_edge_on_an_infinite_curvature_has_no_K_N():
    body = BODIES["power"]
    *carried, left, right = body.law.state(0.0, 1.0, body.own)
    assert carried == pytest.approx(body.law.state(1e-40, 1.0, body.own)[:3], rel=1e-14)
    assert math.isnan(left)
    assert right > 0
