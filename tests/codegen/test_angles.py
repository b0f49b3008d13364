"""Gauss's rule in the angle, support/_angles.py, against the double exponential rule."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated._angles import AFAR, carried
from generated._profile import Curve, Piece, Profile, Window
from generated._quadrature import pressure_at, state_of
from tests.codegen.kinked import contacts, profile

KINKS = (-0.7, 0.2, 1.1)
"""Where the body below changes its formula."""


def body(power: int) -> Profile:
    """g'' = 1 + sum of (x - k)**power beyond each kink k: convex, and the same from either side."""

    def curve(number: int, s: Any) -> Curve:
        reached = [s - k for k in KINKS[:number]]
        slope = s + sum(r ** (power + 1) / (power + 1) for r in reached)
        curvature = 1 + 0 * s + sum(r**power for r in reached)
        return Curve(slope, curvature, lambda: np.nan)  # nothing here asks for g'''

    return profile(KINKS, (0.0,) * len(KINKS), curve, degree=power)


@pytest.mark.parametrize("power", [0, 1, 3, 5])
def test_both_rules_agree_on_what_a_contact_carries(power: int) -> None:
    a, c = contacts(KINKS, 3)
    with np.errstate(all="ignore"):  # as generated functions call it
        one, other = (state_of(body(power)._replace(degree=d), a, c) for d in (power, None))
    far = np.maximum(np.abs(a), np.abs(c))
    steep = 1 + far ** (power + 1)  # of the order of g' at the edges
    for field, size in zip(
        one._fields, (one.load, far * one.load, steep, one.left, one.right), strict=True
    ):
        assert np.max(np.abs(getattr(one, field) - getattr(other, field)) / size) < 2e-13, field


@pytest.mark.parametrize("power", [0, 1, 3, 5])
def test_both_rules_agree_on_the_pressure(power: int) -> None:
    a, c = contacts(KINKS, 3)
    rng = np.random.default_rng(5)
    x = -a + (a + c) * np.where(
        rng.random(a.size) < 0.3, 10 ** rng.uniform(-9, 0, a.size), rng.random(a.size)
    )
    beside = np.clip(rng.choice(KINKS, a.size) + 10 ** rng.uniform(-12, -1, a.size), -a, c)
    for places in (x, beside):
        one, other = (
            pressure_at(body(power)._replace(degree=d), places, a, c) for d in (power, None)
        )
        assert_allclose(one, other, rtol=1e-12)


def test_the_pressure_does_not_step_where_a_piece_comes_into_sight() -> None:
    """The two ways of integrating a piece seen from outside meet where it is AFAR."""
    a, c = 1.5, 1.7  # the piece from 1.1 on: its angle, and x at AFAR of it before its end
    angle = [np.arctan2(np.sqrt(a + s), np.sqrt(c - s)) for s in (KINKS[2], c)]
    place = (a + c) * np.sin(angle[0] - AFAR * (angle[1] - angle[0])) ** 2 - a
    x = place + 1e-9 * np.array([-3.0, -1.0, 1.0, 3.0])
    p = pressure_at(body(3), x, np.full(4, a), np.full(4, c))
    assert abs(np.diff(p, 3)[0]) < 1e-14 * p[0]


def test_what_a_parabola_carries_by_hand() -> None:
    """g'' = 1 all over [-1, 1]: int w = pi/2, int w/(1 + s) = int w/(1 - s) = pi, by symmetry 0."""
    straight = Profile(lambda: (0.0,), lambda: (0.0,), (_parabola(-1), _parabola(1)), degree=0)
    one = np.ones(1)
    sums = carried(Window(straight, {}, -one, one, 2 * one, ()), 0)
    assert_allclose(np.ravel(sums), [np.pi / 2, np.pi, np.pi, 0, 0], atol=4e-16)


def _parabola(side: int) -> Piece:
    def curve(t: Any) -> Curve:
        return Curve(side * t, 1.0 + 0 * t, lambda: 0 * t)

    return Piece(curve if side > 0 else None, curve if side < 0 else None)
