"""Moderate tension of a cylinder in closed form; others: tests/generated/test_stick.py."""

import math

import pytest

from generated.runtime.types import MODERATE

from .laws import hertz, zone


def test_a_cylinder_has_closed_forms():
    a, c, dQ, dsigma, f = 1.1, 0.9, 0.2, 0.13, 0.4
    h, P = a + c, math.pi * (a + c) ** 2 / 16
    stuck, shift = h * math.sqrt(1 - dQ / (2 * f * P)), dsigma / (2 * f)
    ((m, n, regime),) = zone(hertz, (a, c, a, c, dQ, dsigma, f))
    assert regime == MODERATE
    assert m + n == pytest.approx(stuck, rel=1e-13)
    assert n - m == pytest.approx(c - a + shift, rel=1e-12)
