"""The loads and contacts on the way from instant to instant."""

import math

import numpy as np
import pytest

from generated.runtime.history import path as paths
from generated.runtime.kernels import LOOP, kernel, opened

from .laws import hertz, solved, wedge

F, REACH = 0.5, 0.1
MOST = 400
P, M, Q, SIGMA, A, C, INSTANT = range(7)


@kernel(LOOP)
def _each_path(law, given, own, out):
    """given: the fewest steps, the last one over the others, and loads; out: how many rows, and
    they."""
    law = opened(law)
    for i in range(given.shape[0]):
        loads = given[i, 2:].copy().reshape((4, (given.shape[1] - 2) // 4))
        rows = paths.path(law, own[i], loads, F, REACH, int(given[i, 0]), given[i, 1])
        out[i, 0] = rows.shape[0]
        for k in range(rows.shape[0]):
            for j in range(7):
                out[i, 1 + 7 * k + j] = rows[k, j]


def path(case, *loads, least=1, short=0.0):
    loads = np.ravel(np.broadcast_arrays(*np.atleast_1d(*loads)))
    (found,) = solved(_each_path, case, [[least, short, *loads]], 1 + 7 * MOST)
    return found[1 : 1 + 7 * int(found[0])].reshape(-1, 7)


def test_between_instants_loads_go_straight():
    """The shear rises at the first instant from none; rows in between are of none."""
    rows = path(hertz, 0.5, 0.1, [0.1, 0.2, -0.1], 0.0, least=2)
    assert rows[0, Q] == 0 and rows[rows[:, INSTANT] >= 0, Q].tolist() == [0.1, 0.2, -0.1]
    assert rows[rows[:, INSTANT] >= 0, INSTANT].tolist() == [0, 1, 2]
    assert np.all(rows[:, P] == 0.5)
    half = 2 * math.sqrt(0.5 / math.pi)
    assert rows[:, A] == pytest.approx(half + 0.2, rel=1e-12)
    assert rows[:, C] == pytest.approx(half - 0.2, rel=1e-12)


def test_no_edge_moves_far_in_a_step():
    rows = path(wedge, [1.0, 2.0, 0.5], [0.0, 0.3, 0.0], 0.1, 0.0)
    widest = np.max(rows[:, A] + rows[:, C])
    assert np.max(abs(np.diff(rows[:, [A, C]], axis=0))) < 1.5 * REACH * widest
    assert rows[:, [A, C]].prod(axis=1) == pytest.approx(rows[:, P] ** 2, rel=1e-12)


def test_a_step_ends_where_shear_comes_to_friction_or_leaves_it():
    """f P = 1/4, at a half of the way up and at 5/8 of the way down."""
    rows = path(hertz, 0.5, 0.0, [0.0, 0.5, 0.1], 0.0)
    assert np.count_nonzero(abs(rows[:, Q] - 0.25) < 1e-15) == 2


@pytest.mark.parametrize("short", [0.05, 0.5])
def test_the_last_step_may_be_short(short):
    rows = path(hertz, 0.5, 0.0, [0.0, 0.2], 0.0, least=2, short=short)
    steps = np.diff(rows[-4:, Q])
    assert steps[-1] / steps[0] == pytest.approx(short, rel=1e-9)


def test_a_contact_that_comes_back_begins_small():
    rows = path(hertz, [1.0, -1.0, 1.0], 0.0, 0.0, 0.0)
    back = np.flatnonzero(np.isfinite(rows[:, A]))
    first = back[np.flatnonzero(np.diff(back) > 1)[0] + 1]
    width = rows[first, A] + rows[first, C]
    assert width < 2 * paths.SMALL * (rows[-1, A] + rows[-1, C])
    assert np.isfinite(rows[first, Q])


def test_one_that_rolls_in_from_afar_has_a_shear_that_is_not_known():
    """P stays away from nothing while M comes back from where there is no contact."""
    rows = path(hertz, 1.0, [0.0, math.nan, 0.0], 0.0, 0.0)
    assert np.any(np.isnan(rows[:, A])) or np.any(np.isnan(rows[:, Q]))
