"""Whether slip begins at both ends of a cycle and goes on: cylinders, by hand."""

import math

import numpy as np
import pytest

from generated.runtime.kernels import LOOP, kernel, opened
from generated.runtime.slip import growth

from .laws import hertz, wedge
from .test_moderate import solved, state, zone

F = 0.5


@kernel(LOOP)
def _each_way(law, given, own, out):
    """given: both contacts as rows of a way; out: the way, row by row."""
    law = opened(law)
    for i in range(given.shape[0]):
        way = growth.load_path(law, own[i], given[i].copy().reshape((2, 5)))
        for k in range(way.shape[0]):
            for j in range(5):
                out[i, 5 * k + j] = way[k, j]


@kernel(LOOP)
def _each_large(law, given, own, out):
    """given: a cycle of tension that is not negative, m and n, both contacts as rows of a way."""
    law = opened(law)
    for i in range(given.shape[0]):
        way = growth.load_path(law, own[i], given[i, 9:].copy().reshape((2, 5)))
        m, n = given[i, 7], given[i, 8]
        grows = growth.grows_apart(law, own[i], way, given[i, :7].copy(), 1.0, m, n)
        out[i, 0] = 1.0 if grows else 0.0


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


def cycle(first, second, dQ, dsigma):
    return np.array([*first, *second, dQ, dsigma, F])


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
    left, right = growth.advances(way(hertz, (1.0, 1.0), (1.1, 0.9)), 2.0, 1.0, 1.0)
    assert (left, right) == pytest.approx((math.pi / 20, -math.pi / 20), rel=1e-12)
    grown = growth.advances(way(hertz, (1.0, 1.0), (1.1, 1.1)), 2.0, 1.0, 1.0)
    assert grown == pytest.approx((0.21 * math.pi / 4,) * 2, rel=1e-12)


@pytest.mark.parametrize(("part", "slips"), [(0.99, False), (1.01, True)])
def test_slip_begins_where_shear_outgrows_friction(part, slips):
    """dQ beside f dP, both edges growing alike."""
    first, second = (1.0, 1.0), (1.1, 1.1)
    on_the_way = way(hertz, first, second)
    loads = cycle(first, second, part * F * 0.21 * math.pi / 4, 0.0)
    assert growth.slips_at_the_start(on_the_way, loads, 1.0) == slips
    assert growth.sticks_all_over(on_the_way, loads) != slips


def test_an_edge_that_turns_tells_nothing_of_what_is_between():
    first, second = (1.0, 1.0), (1.1, 0.9)
    on_the_way = way(hertz, first, second)
    assert growth.sticks_all_over(on_the_way, cycle(first, second, 0.0, 0.0))
    assert not growth.sticks_all_over(on_the_way, cycle(first, second, 1e-6, 0.0))


@pytest.mark.parametrize("by", [0.9, 1.1])
def test_moderate_slip_goes_on_up_to_the_threshold(by):
    """8 dQ/(pi h) at constant loads."""
    ends, dQ = (1.0, 1.0), 0.1
    loads = cycle(ends, ends, dQ, by * 4 * dQ / math.pi)
    on_the_way = way(wedge, ends, ends)
    assert growth.slips_at_the_start(on_the_way, loads, 1.0) == (by < 1)
    assert growth.slips_at_the_start(on_the_way, loads, -1.0) == (by > 1)


def test_large_slip_goes_on_and_so_it_does_seen_from_behind():
    first, second = (1.1, 0.9), (1.11, 0.92)
    loads = cycle(first, second, 0.05, 0.35)
    ((m, n, _),) = zone(hertz, loads)
    on_the_way = way(hertz, first, second)
    assert growth.holds_at_the_start(on_the_way, loads, m, n)
    rows = contacts(hertz, first, second).ravel()
    zones = (m, n), (1.105, n)  # which ends outside of the first contact
    found = solved(_each_large, hertz, [[*loads, *ends, *rows] for ends in zones], 1)
    assert found.ravel().tolist() == [1, 0]
    behind = growth.mirrored(on_the_way)
    assert behind[:, [1, 0, 3]].tolist() == on_the_way[:, [0, 1, 3]].tolist()
    assert behind[:, [2, 4]].tolist() == (-on_the_way[:, [2, 4]]).tolist()
