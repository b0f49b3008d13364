"""Bodies whose integrals have no closed form: the library's, and one with a corner and a flat.

Their laws are held against quadrature of slopes that are typed here by hand.
"""

import math

import mpmath as mp
import numpy as np
import pytest

from generated import hyperbola, power
from generated.runtime import pieces
from generated.runtime.body import Body as Runtime
from generated.runtime.forward import each_pressure, each_series, each_state
from generated.runtime.kernels import kernel, loop, opened
from generated.runtime.pieces import curve_of
from tests.runtime.laws import Case, solved

# ---------------------------------------------------------------- corner, flat and quartic


@kernel
def _kinked(piece, side, t, own):
    """phi |x| + max(0, x - b)**4/(4 R**3)."""
    phi, R = own[0], own[2]
    if piece < 2:
        return (phi if piece == 1 else -phi), 0.0, 0.0
    return phi + t**3 / R**3, 3 * t**2 / R**3, 6 * t**2 / R**3


@kernel
def _breaks(own):
    return np.array([0.0, own[1]])


@kernel
def _corners(own):
    return np.array([2 * own[0], 0.0])


def _pressure(x, a, c, own):
    return pieces.pressure(curve_of(_kinked, _breaks, _corners), x, a, c, own)


def _state(a, c, own):
    return pieces.state(curve_of(_kinked, _breaks, _corners), a, c, own)


def _slope(x, own):
    return pieces.slope(curve_of(_kinked, _breaks, _corners), x, own)


def _series(a, c, own):
    return pieces.series(curve_of(_kinked, _breaks, _corners), a, c, own)


def _cuts(own):
    return _breaks(own)


_BODY = Runtime(__name__, _pressure, _state, _slope, _series, _cuts)


@loop
def _each_slope(law, given, own, out):
    law = opened(law)
    for i in range(given.shape[0]):
        out[i, 0], out[i, 1] = law.slope(given[i, 0], own[i])


# ---------------------------------------------------------------- the defining integrals of g'


class Body:
    """A case, and the body's slope and curvature for mpmath."""

    def __init__(self, body, own, slope, curvature, breaks=(0.0,), corners=(0.0,)):
        self.case = Case(body, np.array(own))
        self.slope, self.curvature = slope, curvature
        self.breaks, self.corners = breaks, corners

    def integral(self, f, a, c, *cuts):
        """int f(s)/w ds over the contact, in the angle."""
        mid, half = (c - a) / 2, (a + c) / 2
        inside = [(mp.mpf(x) - mid) / half for x in (*self.breaks, *cuts)]
        angles = sorted({mp.acos(z) for z in inside if -1 < z < 1} | {mp.mpf(0), mp.pi})
        return mp.quad(lambda angle: f(mid + half * mp.cos(angle)), angles)

    def found_state(self, a, c):
        return solved(each_state, self.case, [(a, c, 1.0)], 5)[0]

    def found_pressure(self, x, a, c):
        return solved(each_pressure, self.case, [(x, a, c, 1.0)], 1)[0, 0]

    def found_slope(self, x):
        return tuple(solved(_each_slope, self.case, [(x,)])[0])

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


def _of_power(k):
    exact = mp.mpf(k)
    return Body(
        power._BODY,
        [1.0, k],
        lambda s: mp.sign(s) * abs(s) ** (exact - 1),
        lambda s: (exact - 1) * abs(s) ** (exact - 2),
    )


HYPERBOLA = Body(
    hyperbola._BODY,
    [0.5, 0.25],
    lambda s: s / (4 * mp.sqrt(0.25 + s * s)),
    lambda s: 1 / (16 * mp.sqrt(0.25 + s * s) ** 3),
)
KINKED = Body(
    _BODY,
    [0.125, 0.25, 1.0],
    lambda s: mp.sign(s) / 8 + max(0, s - 0.25) ** 3,
    lambda s: 3 * max(0, s - 0.25) ** 2,
    (0.0, 0.25),
    (0.25, 0.0),
)
BODIES = {"power": _of_power(1.5), "hyperbola": HYPERBOLA, "kinked": KINKED}
CONTACTS = {
    "power": [(1.0, 0.5), (1.0, -1e-9)],
    "hyperbola": [(-0.25, 1.0), (20.0, 30.0)],
    "kinked": [(1.0, 0.5), (0.5, 0.25 + 1e-9)],
}
CASES = [(name, *contact) for name, contacts in CONTACTS.items() for contact in contacts]


@pytest.fixture(autouse=True)
def _digits():
    with mp.workdps(40):
        yield


@pytest.mark.parametrize(("name", "a", "c"), CASES)
def test_states_and_pressures_are_the_integrals_that_define_them(name, a, c):
    body, h = BODIES[name], a + c
    found, exact = body.found_state(a, c), body.state(a, c)
    reach = max(abs(a), abs(c))
    steepest = max(abs(body.slope(mp.mpf(x))) for x in (-a, c))
    sizes = exact[0], exact[0] * reach, steepest, exact[3], exact[4]
    for value, true, size in zip(found, exact, sizes, strict=True):
        assert abs(value - true) < 1e-13 * size
    for x in (-a + 1e-6 * h, -a + 0.375 * h, c - 0.125 * h, 1e-7):
        if -a < x < c:
            found, exact = body.found_pressure(x, a, c), body.pressure(x, a, c)
            assert found == pytest.approx(float(exact), rel=1e-12, abs=0)


@pytest.mark.parametrize(("name", "a", "c"), CASES[::2])
def test_L_N_is_what_the_pressure_tends_to_at_an_edge(name, a, c):
    body = BODIES[name]
    K_left, K_right = body.state(a, c)[3:]
    ((L_left, L_right),) = solved(each_series, body.case, [(a, c, 1.0)])
    s = mp.mpf(2) ** -36 * min(1, a + c)
    for L, K, x in ((L_left, K_left, -a + s), (L_right, K_right, c - s)):
        slowly = (body.pressure(x, a, c) / mp.sqrt(s) - K) / s
        assert abs(L - slowly) < 1e-7 * K / min(1, a + c)


def test_slopes_are_those_of_the_piece_on_the_right():
    assert KINKED.found_slope(0.25) == (0.125, 0.0)
    assert KINKED.found_slope(-1e-9) == (-0.125, 0.0)
    assert KINKED.found_slope(0.0) == (0.125, 0.0)
    wanted = HYPERBOLA.slope(mp.mpf(-0.75)), HYPERBOLA.curvature(mp.mpf(-0.75))
    assert HYPERBOLA.found_slope(-0.75) == pytest.approx([float(v) for v in wanted], rel=1e-15)


# ---------------------------------------------------------------- existence


def test_what_is_no_contact_carries_nothing():
    for body, a, c in ((HYPERBOLA, 1.0, -1.0), (KINKED, -0.05, 0.2), (HYPERBOLA, math.nan, 1.0)):
        assert np.all(np.isnan(body.found_state(a, c)))
    assert math.isnan(HYPERBOLA.found_pressure(0.0, 0.0, 0.0))
    assert HYPERBOLA.found_pressure(2.0, 1.0, 1.0) == 0
    assert KINKED.found_pressure(0.0, 1.0, 1.0) == math.inf
    assert 0 < KINKED.found_pressure(1e-300, 1.0, 1.0) < 100


def test_an_edge_on_an_infinite_curvature_has_no_K_N():
    body = BODIES["power"]
    *carried, left, right = body.found_state(0.0, 1.0)
    assert carried == pytest.approx(body.found_state(1e-40, 1.0)[:3], rel=1e-14)
    assert math.isnan(left)
    assert right > 0
