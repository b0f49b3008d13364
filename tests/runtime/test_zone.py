"""Stick zones: regimes in order, leading orders, ways back, and what a stick zone can carry."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import flat_rounded, hertz, wedge
from generated.runtime.types import Contact, Regime

NONE, MODERATE, LARGE, MIXED, SLIDING, FULL_STICK, UNSOLVED = list(Regime)[:7]
OWN = {hertz: {"R": 1.0}, wedge: {"phi": 1.0}, flat_rounded: {"R": 1.0, "b": 1.0}}
F = 0.5
LOAD = math.pi / 4
"""Of a cylinder whose contact is [-1, 1]."""


def zone(body, cycle):
    """The stick zone of a_1, c_1, a_2, c_2, dQ, dsigma and f."""
    a_1, c_1, a_2, c_2, dQ, dsigma, f = cycle
    ends = Contact(a_1, c_1, 0.0), Contact(a_2, c_2, 0.0)
    return body.stick_zone(*ends, dQ, dsigma, f=f, E_star=1.0, **OWN[body])


ONE = (1.0, 1.0, 1.0, 1.0)
MORE = math.pi * (1.1**2 - 1) / 8
"""f times what the load gains from [-1, 1] to [-1.1, 1.1]."""


@pytest.mark.parametrize(
    ("cycle", "regime"),
    [
        ((*ONE, 0.1, 0.0, F), MODERATE),
        ((*ONE, 0.1, 0.8, F), LARGE),
        ((*ONE, 0.1, 0.13, F), MIXED),
        ((*ONE, LOAD * (1 - 1e-9), 0.0, F), MODERATE),
        ((*ONE, 1e-6, 0.0, F), MODERATE),
        ((*ONE, 0.0, 1e-6, F), LARGE),
        ((*ONE, 1e-25, 1e-22, F), LARGE),
        ((*ONE, LOAD, 0.0, F), SLIDING),
        ((*ONE, 1.01 * LOAD, 5.0, F), SLIDING),
        ((*ONE, 0.0, 0.0, F), FULL_STICK),
        ((1.0, 1.0, 1.1, 1.1, 1e-3, 1e-3, F), FULL_STICK),
        ((1.0, 1.0, 1.1, 1.1, 0.99 * MORE, 0.0, F), FULL_STICK),
        ((1.0, 1.0, 1.1, 1.1, 1.01 * MORE, 0.0, F), MODERATE),
        ((1.1, 1.05, 1.0, 1.0, 0.0, 0.0, F), FULL_STICK),
        ((*ONE, -0.1, 0.0, F), NONE),
        ((*ONE, 0.1, math.inf, F), NONE),
        *(((*ONE, 0.1, 0.0, f), NONE) for f in (0.0, math.nan, -0.5)),
        ((*ONE, math.nan, 0.0, F), NONE),
        ((1.0, 1.0, -1.0, 0.5, 0.1, 0.0, F), NONE),
        ((1.0, 1.0, 1.2, 0.8, 0.1, 0.0, F), MIXED),  # the moment turns an edge ahead of slip
    ],
)
def test_regimes(cycle, regime):
    m, n, found = zone(hertz, cycle)
    assert found == regime
    assert (np.isfinite(m) and np.isfinite(n)) or regime not in (FULL_STICK, MODERATE, LARGE)
    assert (np.isnan(m) and np.isnan(n)) or regime not in (NONE, SLIDING)
    if max(cycle[4:6]) < 1e-20:  # what is in contact at both ends, to rounding
        assert (m, n) == pytest.approx((1.0, 1.0), abs=1e-15) or regime == NONE


def test_the_threshold_of_tension_by_hand():
    """8 dQ/(pi h) at constant loads; none where all slides, and none if the contacts differ."""
    law, here, dQ = {"f": F, "E_star": 1.0, "R": 1.0}, Contact(1.1, 0.9, 0.0), 0.2
    lower, upper = hertz.tension_threshold(here, here, dQ, **law)
    assert upper == -lower == pytest.approx(4 * dQ / math.pi, rel=1e-15)
    for second, loads in ((here, 1.001 * LOAD), (Contact(1.2, 0.9, 0.0), dQ), (here, -dQ)):
        assert np.isnan(hertz.tension_threshold(here, second, loads, **law)).all()


@pytest.mark.parametrize("tension", [0.0106, -0.0106])
def test_an_edge_a_hair_beyond_a_kink_does_not_matter(tension):
    """The stick zone of [-b - d, c] tends to that of [-b, c] as d vanishes.  Singularities of the
    pressure are close to each other there."""
    rows = [(1 + d, 1.3, 1 + d, 1.3, 0.0048, tension, 0.3) for d in (1e-14, 1e-12, 1e-11)]
    (m, n, regime), *others = (zone(flat_rounded, row) for row in rows)
    assert regime == LARGE
    for other in others:
        assert_allclose(other, (m, n, regime), rtol=0, atol=1e-10)


# ---------------------------------------------------------------- what a stick zone can carry


def rocked(d):
    """From [-1 - d, 1 - d] to [-1 + d, 1 + d], p = sqrt(1 - (x - middle)**2)/2: the least p at
    x > 0 is that of the first contact, so that the highest |Q| is

        2 f int_0^(1 - d) sqrt(1 - (x + d)**2)/2 dx = f (pi/4 - (d sqrt(1 - d**2) + asin d)/2).
    """
    return F * (LOAD - (d * math.sqrt(1 - d * d) + math.asin(d)) / 2)


def pulled(tension):
    """dq is odd: the highest Q is int min(f p, f p - dq) dx = f P - int |dq| dx/2."""
    angle, weight = np.polynomial.legendre.leggauss(400)
    x, here = np.sin(math.pi / 2 * angle), Contact(1.0, 1.0, 0.0)
    dq = hertz.shear_change(x, here, here, 0.0, tension, f=F, E_star=1.0, R=1.0)
    return F * LOAD - np.sum(weight * math.pi / 2 * np.sqrt(1 - x * x) * abs(dq)) / 2


@pytest.mark.parametrize(
    ("d", "tension", "limit", "regime"),
    [(0.4, 0.0, rocked, FULL_STICK), (0.0, 0.3, pulled, LARGE), (0.0, -0.5, pulled, LARGE)],
)
def test_a_cylinder_carries_what_it_carries_by_hand(d, tension, limit, regime):
    """Within 0.2 % of f P of both limits; the integrals are accurate to 0.1 %.  M = -P d on the
    way to a contact that is d further to the right."""
    way, off, highest = np.array([-1.0, 1.0]), 2e-3 * F * LOAD, limit(d or tension)
    assert 0.2 < highest / (F * LOAD) < 0.95
    for sign in (1, -1):
        for Q, sticks in ((highest - off, True), (highest + off, False)):
            found = hertz.steady_cycle(
                LOAD, -LOAD * d * way, sign * Q, tension / 2 * way, f=F, E_star=1.0, R=1.0
            )
            assert found.regime == (regime if sticks else Regime.NO_STICK)
            assert np.isfinite(found.m) == sticks
