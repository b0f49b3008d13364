"""The regimes of a cycle, in order; mixed cycles."""

import math

import numpy as np
import pytest

from generated.runtime.slip import mixed
from generated.runtime.types import FULL_STICK, LARGE, MIXED, MODERATE, NONE, SLIDING, UNSOLVED

from .laws import hertz, solved, zone

LOAD = math.pi / 4  # of a cylinder whose contact is [-1, 1]


@pytest.mark.parametrize(
    ("cycle", "regime"),
    [
        ((1, 1, 1, 1, 0.1, 0.0, 0.5), MODERATE),
        ((1, 1, 1, 1, 0.1, 0.8, 0.5), LARGE),
        ((1, 1, 1, 1, 0.1, 0.13, 0.5), MIXED),
        ((1, 1, 1, 1, LOAD * (1 - 1e-9), 0.0, 0.5), MODERATE),
        ((1, 1, 1, 1, 1e-6, 0.0, 0.5), MODERATE),
        ((1, 1, 1, 1, 0.0, 1e-6, 0.5), LARGE),
        ((1, 1, 1, 1, LOAD, 0.0, 0.5), SLIDING),
        ((1, 1, 1, 1, 1.01 * LOAD, 5.0, 0.5), SLIDING),
        ((1, 1, 1, 1, 0.0, 0.0, 0.5), FULL_STICK),
        ((1, 1, 1.1, 1.1, 1e-3, 1e-3, 0.5), FULL_STICK),
        ((1, 1, 1, 1, -0.1, 0.0, 0.5), NONE),
        ((1, 1, 1, 1, 0.1, math.inf, 0.5), NONE),
        *(((1, 1, 1, 1, 0.1, 0.0, f), NONE) for f in (0.0, math.nan, -0.5)),
        ((1, 1, 1, 1, math.nan, 0.0, 0.5), NONE),
        ((1, 1, -1, 0.5, 0.1, 0.0, 0.5), NONE),
        # the moment turns an edge ahead of slip
        ((1, 1, 1.2, 0.8, 0.1, 0.0, 0.5), MIXED),
    ],
)
def test_regimes(cycle, regime):
    ((m, n, found),) = zone(hertz, cycle)
    assert found == regime
    known = {FULL_STICK, MODERATE, LARGE}
    assert (np.isfinite(m) and np.isfinite(n)) or regime not in known
    if regime in (NONE, SLIDING):
        assert np.isnan(m) and np.isnan(n)


def test_full_stick_keeps_what_is_always_in_contact():
    ((m, n, _),) = zone(hertz, (1.1, 1.05, 1, 1, 0, 0, 0.5))
    assert (m, n) == (1, 1)


def test_shear_that_grows_with_the_load_sticks_up_to_friction():
    more = math.pi * (1.1**2 - 1) / 4
    below, above = zone(hertz, *((1, 1, 1.1, 1.1, 0.5 * more * k, 0, 0.5) for k in (0.99, 1.01)))
    assert below[2] == FULL_STICK
    assert above[2] == MODERATE


def test_mixed_cycles_are_left_unknown_unless_asked_for():
    rows = [(1, 1, 1, 1, 0.1, 0.13, 0.5)]
    ((m, n, regime),) = zone(hertz, *rows)
    assert regime == MIXED and np.isnan(m) and np.isnan(n)
    ((m, n, regime),) = solved(mixed.each_stick_zone, hertz, [(*row, 1.0) for row in rows], 3)
    assert regime in (MIXED, UNSOLVED) and np.isfinite(m) == (regime == MIXED)
