"""The way between two contacts and what drives its edges: cylinders, by hand.

Regimes, which follow, are those of test_zone.py and of tests/generated/test_stick.py.
"""

import math

import numpy as np
import pytest

from generated.runtime.kernels import loop, opened
from generated.runtime.slip import growth

from .laws import hertz, plain, solved, state

F = 0.5


@loop
def _each_way(law, given, own, out):
    """given: both contacts as rows of a way; out: the way, row by row."""
    law = opened(law)
    for i in range(given.shape[0]):
        way = growth.load_path(law, own[i], given[i].copy().reshape((2, 5)))
        for k in range(way.shape[0]):
            for j in range(5):
                out[i, 5 * k + j] = way[k, j]


def contacts(case, *edges):
    """Contacts [-a, c] as rows of a way."""
    rows = []
    for a, c in edges:
        load, moment, tilt, *_ = state(case, a, c)
        rows.append([a, c, tilt, load, moment])
    return np.array(rows)


def way(case, first, second):
    """The way between two contacts [-a, c]."""
    count = 2 if first == second else growth.PARTS + 1
    (found,) = solved(_each_way, case, [contacts(case, first, second).ravel()], 5 * count)
    return found.reshape(-1, 5)


def test_a_way_holds_the_contacts_of_loads_in_proportion():
    """A cylinder whose load grows by 0.21 of itself: widths go like its root; steady loads stay."""
    found = way(hertz, (1.0, 1.0), (1.1, 1.1))
    part = np.arange(growth.PARTS + 1) / growth.PARTS
    assert found[:, 0] == pytest.approx(np.sqrt(1 + 0.21 * part), rel=1e-12)
    assert found[:, 1] == pytest.approx(found[:, 0], rel=1e-12)
    still = contacts(hertz, (1.0, 1.0), (1.0, 1.0))
    assert way(hertz, (1.0, 1.0), (1.0, 1.0)).tolist() == still.tolist()


def test_what_drives_both_edges_by_hand():
    """dP +- 4 h_s (dM + mid dP)/h**2.  A cylinder from [-1, 1] to [-1.1, 0.9]: dP = 0 and
    dM = P/10 = pi/40, and h_s = h = 2 leaves +-2 dM."""
    left, right = plain(growth.advances)(way(hertz, (1.0, 1.0), (1.1, 0.9)), 2.0, 1.0, 1.0)
    assert (left, right) == pytest.approx((math.pi / 20, -math.pi / 20), rel=1e-12)
    grown = plain(growth.advances)(way(hertz, (1.0, 1.0), (1.1, 1.1)), 2.0, 1.0, 1.0)
    assert grown == pytest.approx((0.21 * math.pi / 4,) * 2, rel=1e-12)
