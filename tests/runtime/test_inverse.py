"""The contact from loads: closed forms, put back, what cannot be, and the fallback alone."""

import math

import numpy as np
import pytest

from generated.runtime import inverse
from generated.runtime.body import Body
from generated.runtime.forward import each_contact, each_contact_at_tilt
from generated.runtime.kernels import Law, loop, opened
from tests.runtime.laws import Case, flat_rounded, hertz, solved, wedge

# ---------------------------------------------------------------- a cylinder cut off at x = -1, 1


def _cut_state(a, c, own):
    h = a + c
    if not h > 0:
        return math.nan, math.nan, math.nan, math.nan, math.nan
    if a > 1 or c > 1:
        return math.inf, math.nan, math.nan, math.inf, math.inf
    load, K = math.pi * h * h / 16, math.sqrt(h) / 2
    return load, load * (a - c) / 2, (a - c) / 2, K, K


cut = Case(Body(__name__, *hertz.functions._replace(state=_cut_state)[:5]), np.ones(1))


@loop
def _each_level(law, given, own, out):
    law = opened(law)
    for i in range(given.shape[0]):
        out[i, 0] = inverse.level(law, own[i], given[i, 0])


def contact(case, P, second, loop=each_contact):
    return solved(loop, case, np.stack(np.broadcast_arrays(P, second, 1.0), axis=1), 3).T


def at_tilt(case, P, alpha):
    return contact(case, P, alpha, each_contact_at_tilt)[:2]


def level(case, *tilts):
    return solved(_each_level, case, np.array(tilts)[:, None], 1)[:, 0]


def spread(low, high, count=200, seed=0):
    """Numbers of either sign, evenly spread in their logarithm."""
    random = np.random.default_rng(seed)
    return 10 ** random.uniform(low, high, count) * random.choice([-1, 1], count)


# ---------------------------------------------------------------- closed forms


def test_of_a_wedge():
    """P = phi sqrt(a c), M = P (a - c)/4: the nearer edge keeps its digits, too."""
    P, lean = abs(spread(-12, 12)), spread(-9, 6, seed=1)
    root = np.hypot(2 * lean, 1.0)
    far = P * (np.abs(2 * lean) + root)
    a, c, alpha = contact(wedge, P, P * P * lean)
    np.testing.assert_allclose(np.maximum(a, c), far, rtol=1e-14)
    np.testing.assert_allclose(np.minimum(a, c), P * P / far, rtol=1e-12)
    assert np.array_equal(a > c, lean > 0)
    np.testing.assert_allclose(alpha, 2 / math.pi * np.arctan(2 * lean), rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("short_of", [0.5, 1e-3, 1e-6, 1e-9])
def test_of_a_wedge_tilted_nearly_to_its_flank(short_of):
    """alpha = phi (1 - (4/pi) atan sqrt(c/a)); rounding of alpha counts 1/short_of times."""
    quotient = math.tan(math.pi / 4 * short_of)
    a, c = at_tilt(wedge, [1.0, 1e-9, 1e9], 1 - short_of)
    np.testing.assert_allclose(c / [1.0, 1e-9, 1e9], quotient, rtol=1e-15 / short_of + 1e-13)
    np.testing.assert_allclose(a * c, np.square([1.0, 1e-9, 1e9]), rtol=1e-12)


# ---------------------------------------------------------------- put back


def test_a_contact_hangs_on_one_shoulder():
    """A cylinder alone then: centre b + alpha R away."""
    R, b = flat_rounded.own
    P, centre = 0.01, np.array([1.5, -1.5, 40.0])
    a, c, alpha = contact(flat_rounded, P, -P * centre)
    assert np.all((c < -b) | (a < -b))
    np.testing.assert_allclose((c - a) / 2, centre, rtol=1e-12)
    np.testing.assert_allclose(a + c, 4 * math.sqrt(R * P / math.pi), rtol=1e-10)
    np.testing.assert_allclose(alpha, -np.sign(centre) * (np.abs(centre) - b) / R, rtol=1e-12)


def test_edges_lie_just_beyond_kinks():
    """P = (2 sqrt(2)/3) b**2 (a/b - 1)**1.5/R to first order; the test's law loses the rest."""
    P = 2 * math.sqrt(2) / 3 * 1e-5**1.5
    ((a,), (c,), (alpha,)) = contact(flat_rounded, [P], 0.0)
    assert a == pytest.approx(c, abs=1e-13) and alpha == pytest.approx(0.0, abs=1e-12)
    assert a - 1 == pytest.approx(1e-5, rel=1e-5)


# ---------------------------------------------------------------- what cannot be


def test_there_is_no_contact():
    bad = [0.0, -1.0, math.inf, math.nan]
    for case in (hertz, wedge, flat_rounded):
        assert np.all(np.isnan(contact(case, bad, 0.1))) and np.all(np.isnan(at_tilt(case, bad, 0)))
        assert np.all(np.isnan(contact(case, 1.0, [math.inf, math.nan])))
        assert np.all(np.isnan(at_tilt(case, 1.0, [math.inf, math.nan])))
    assert np.all(np.isnan(at_tilt(wedge, 1.0, [1.0, -1.0, 2.0, -1e9])))
    # longer than lengths count; an edge far from the origin is rounded off
    assert np.all(np.isnan(contact(wedge, [1e76, 1e-76], 0.0)))
    assert np.all(np.isnan(contact(hertz, 1.0, [1e14])))


def test_a_body_ends():
    random = np.random.default_rng(0)
    P, centre = 10 ** random.uniform(-6, 0, 300), random.uniform(-1.1, 1.1, 300)
    half = 2 * np.sqrt(P / math.pi)
    fits = half + np.abs(centre) < 1
    assert 100 < fits.sum() < 280
    for a, c in (contact(cut, P, -P * centre)[:2], at_tilt(cut, P, -centre)):
        assert np.array_equal(np.isnan(a), ~fits)
        np.testing.assert_allclose(a[fits], (half - centre)[fits], atol=1e-12)
        np.testing.assert_allclose(c[fits], (half + centre)[fits], atol=1e-12)


def test_level_places():
    assert level(hertz, 0.25, 0.0, -1e9) == pytest.approx([-0.25, 0.0, 1e9], rel=1e-14)
    assert level(flat_rounded, 0.0, 0.5, -7.0) == pytest.approx([0.0, -1.5, 8.0], rel=1e-14)
    assert np.array_equal(level(wedge, 0.0, 0.9, -0.9, 1.0), np.zeros(4))
    assert np.all(np.isnan(level(wedge, 1.1, -3.0, math.nan)))


# ---------------------------------------------------------------- as plain Python


@pytest.fixture
def plain(monkeypatch):
    """The module with its kernels as plain Python; and laws so."""
    for name, value in vars(inverse).copy().items():
        if hasattr(value, "py_func"):
            monkeypatch.setattr(inverse, name, getattr(value, "py_func", value))
    return lambda case: Law(*(getattr(f, "py_func", f) for f in case.functions))


CASES = [
    *((hertz, 1.0, -3.0), (wedge, 1.0, 0.7), (wedge, 1e-9, 1e-3)),
    *((flat_rounded, 0.01, 0.005), (flat_rounded, 0.01, 0.02), (flat_rounded, 20.0, -9.0)),
    *((cut, 0.1, 0.03), (cut, 0.1, 0.09)),
]


def test_from_brackets_alone_it_is_the_same(plain):
    """Newton's steps come last then; where a body is left, there is nothing to start them from."""
    for case, P, M in CASES:
        law, own = plain(case), case.own
        breaks = law.breaks(own)
        by_moment = inverse.Target(P, -M / P, 0.0, False)
        by_tilt = inverse.Target(P, inverse.level(law, own, M), M, True)
        wanted = contact(case, [P], M)[:2, 0], at_tilt(case, [P], M)[:, 0]
        for target, edges in zip((by_moment, by_tilt), wanted, strict=True):
            if not math.isnan(target.place):
                with np.errstate(all="ignore"):  # plain Python, which has no errors in kernels
                    found = inverse._nested(law, own, breaks, target, P)
                    found = inverse._newton(law, own, breaks, target, *found)
                np.testing.assert_allclose(found, edges, rtol=1e-11)
