"""The loads and contacts on the way from instant to instant."""

import math

import numpy as np
import pytest

from generated import hertz, wedge
from generated.runtime.history import path as of

F, REACH = 0.5, 0.1
HERTZ, WEDGE = (hertz._BODY, {"R": 1.0}), (wedge._BODY, {"phi": 1.0})


def path(case, *loads, least=1, short_end=False):
    return of.path(*case, F, np.array(np.broadcast_arrays(*loads)), REACH, least, short_end)


def test_between_instants_loads_go_straight():
    """The shear rises at the first instant from none; a = c = 2 sqrt(P/pi), moved by -2 M/P."""
    way = path(HERTZ, [0.5] * 3, [0.1] * 3, [0.1, 0.2, -0.1], [0.0] * 3, least=2)
    assert way.Q[0] == 0 and way.Q[way.instant >= 0].tolist() == [0.1, 0.2, -0.1]
    assert way.instant[way.instant >= 0].tolist() == [0, 1, 2]
    half = 2 * math.sqrt(0.5 / math.pi)
    assert way.a == pytest.approx(half + 0.2, rel=1e-12) and np.ptp(way.a) == 0
    assert way.c == pytest.approx(half - 0.2, rel=1e-12)


def test_no_edge_moves_far_in_a_step():
    """On a wedge a c = P**2."""
    way = path(WEDGE, [1.0, 2.0, 0.5], [0.0, 0.3, 0.0], [0.1] * 3, [0.0] * 3)
    longest = max(np.max(abs(np.diff(way.a))), np.max(abs(np.diff(way.c))))
    assert longest < 1.5 * REACH * np.max(way.a + way.c)
    assert way.a * way.c == pytest.approx(way.P**2, rel=1e-12)


def test_a_step_ends_where_shear_comes_to_friction_or_leaves_it():
    """f P = 1/4, at a half of the way up and at 5/8 of the way down."""
    way = path(HERTZ, [0.5] * 3, [0.0] * 3, [0.0, 0.5, 0.1], [0.0] * 3)
    assert np.count_nonzero(abs(way.Q - 0.25) < 1e-15) == 2


def test_the_last_step_is_short():
    way = path(HERTZ, [0.5] * 2, [0.0] * 2, [0.0, 0.2], [0.0] * 2, least=2, short_end=True)
    steps = np.diff(way.Q[-4:])
    assert steps[-1] / steps[0] == pytest.approx(0.01, rel=1e-9)


def test_a_contact_that_comes_back_begins_small():
    way = path(HERTZ, [1.0, -1.0, 1.0], [0.0] * 3, [0.0] * 3, [0.0] * 3)
    touching = np.flatnonzero(np.isfinite(way.a))
    first = touching[np.flatnonzero(np.diff(touching) > 1)[0] + 1]
    assert way.a[first] + way.c[first] < 0.04 * (way.a[-1] + way.c[-1])
    assert np.isfinite(way.Q[first])


def test_one_that_rolls_in_from_afar_has_a_shear_that_is_not_known():
    """P = 0 at M = 0.1: the load acts at -M/P, far away."""
    way = path(HERTZ, [1.0, 0.0, 1.0], [0.1] * 3, [0.0] * 3, [0.0] * 3)
    assert np.any(np.isnan(way.a)) and np.any(np.isnan(way.Q))
