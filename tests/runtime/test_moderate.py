"""Moderate tension of a cylinder in closed form; others: tests/generated/test_stick.py."""

import math

import numpy as np
import pytest

from generated.runtime.slip.zone import each_stick_zone
from generated.runtime.types import MODERATE

from .laws import Case, hertz


def solved(loop, case: Case, rows, count=2):
    """What a loop finds, a row of `rows` a case."""
    given = np.atleast_2d(np.array(rows, dtype=float))
    own = np.tile(case.own, (len(given), 1))
    out = np.empty((len(given), count))
    loop(case.law, given, own, out)
    return out


def zone(case, *rows):
    return solved(each_stick_zone, case, rows, 3)


def state(case, a, c):
    return case.functions.state(float(a), float(c), case.own)


def test_a_cylinder_has_closed_forms():
    a, c, dQ, dsigma, f = 1.1, 0.9, 0.2, 0.13, 0.4
    h, P = a + c, math.pi * (a + c) ** 2 / 16
    stuck, shift = h * math.sqrt(1 - dQ / (2 * f * P)), dsigma / (2 * f)
    ((m, n, regime),) = zone(hertz, (a, c, a, c, dQ, dsigma, f))
    assert regime == MODERATE
    assert m + n == pytest.approx(stuck, rel=1e-13)
    assert n - m == pytest.approx(c - a + shift, rel=1e-12)
