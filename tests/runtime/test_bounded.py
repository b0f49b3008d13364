"""Both conditions of a stick zone: their integrals by hand, their rates, and a zone put back."""

import math

import numpy as np
import pytest

from generated.runtime.kernels import loop, opened
from generated.runtime.slip import bounded
from generated.runtime.slip.bounded import Slip, Zone
from generated.runtime.slip.quadrature import slip_nodes

from .laws import flat_rounded, hertz, plain, solved, wedge

LEVEL = 2


@loop
def _each_even(law, given, own, out):
    """given: h, the lengths of two zones, and r in them; out: the sums."""
    for i in range(given.shape[0]):
        h, left, right, r_left, r_right = given[i]
        at_left = slip_nodes(np.empty(0), 1.0, 0.0, left, left, LEVEL)
        at_right = slip_nodes(np.empty(0), 1.0, 0.0, right, right, LEVEL)
        one = Zone(at_left[0], at_left[1], np.full(at_left.shape[1], r_left), left, r_left)
        other = Zone(at_right[0], at_right[1], np.full(at_right.shape[1], r_right), right, r_right)
        out[i, 0], out[i, 1], _, _ = bounded.sums(Slip(h / 2, h / 2, left, right, one, other))


@loop
def _each_sums(law, given, own, out):
    """given: a cycle, m and n; out: the sums."""
    law = opened(law)
    for i in range(given.shape[0]):
        of = bounded.friction(law, own[i], given[i, :7].copy(), 1.0, -1.0, math.nan)
        m, n = given[i, 7], given[i, 8]
        slip = bounded.beside(of, m, n, of.a - m, of.c - n, LEVEL)
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = bounded.sums(slip)


def test_both_conditions_by_hand():
    """int sqrt((h + y)/y) dy = w + h t and int sqrt(y/(h + y)) dy = w - h t over a zone that is l
    long, w = sqrt(l (l + h)) and t = arsinh sqrt(l/h)."""
    h, lengths, r = 2.0, (0.5, 0.75), (1.5, -0.25)
    ((L, R),) = solved(_each_even, hertz, [(h, *lengths, *r)])
    near, far = [], []
    for length in lengths:
        w, t = math.sqrt(length * (length + h)), math.asinh(math.sqrt(length / h))
        near.append(w + h * t)
        far.append(w - h * t)
    assert pytest.approx(r[0] * near[0] + r[1] * far[1], rel=1e-13) == L
    assert pytest.approx(r[0] * far[0] + r[1] * near[1], rel=1e-13) == R


CYCLES = [
    (hertz, (1.1, 0.9, 1.12, 0.93, 0.05, 0.35, 0.5), (0.8, 0.6)),
    (wedge, (1.2, 0.7, 1.2, 0.7, 0.1, 0.5, 0.5), (0.9, 0.4)),
    (flat_rounded, (1.8, 1.9, 1.8, 1.9, 0.02, 0.9, 0.6), (1.4, 1.3)),
]
EACH = pytest.mark.parametrize(("case", "cycle", "ends"), CYCLES, ids=["hertz", "wedge", "flat"])


@EACH
def test_rates_are_those_of_differences(case, cycle, ends):
    """As bounded.py states them, to what finite parts that stop short of the stick zone are good
    for: Newton's method asks no more of them."""
    (m, n), step = ends, 1e-5

    def off(m, n):
        ((L, R, *rates),) = solved(_each_sums, case, [(*cycle, m, n)], 4)
        left, right = plain(bounded.drives)(cycle[4], cycle[5], m + n)
        return np.array([L - left, R - right]), rates

    (left, right), (by_m, by_n) = off(m, n)
    F = (right - left) / (m + n)
    of_m = (off(m + step, n)[0] - off(m - step, n)[0]) / (2 * step)
    of_n = (off(m, n + step)[0] - off(m, n - step)[0]) / (2 * step)
    wanted = -F / 2 + by_m / 2, F / 2, -F / 2, F / 2 + by_n / 2
    assert (*of_m, *of_n) == pytest.approx(wanted, abs=5e-5 * abs(of_m[0]))
