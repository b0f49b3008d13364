"""What contacts carry, case by case: what the law says, NaN where a contact leaves the body."""

import math

import numpy as np
import pytest

from generated.runtime.forward import each_pressure, each_series, each_state
from tests.runtime.laws import hertz, solved, wedge
from tests.runtime.test_inverse import cut


@pytest.mark.parametrize("case", [hertz, wedge], ids=["hertz", "wedge"])
def test_loops_give_what_the_law_gives(case):
    contacts, of = [(1.0, 0.5), (0.25, 2.0)], case.functions
    for found, (a, c) in zip(solved(each_state, case, contacts, 5), contacts, strict=True):
        assert tuple(found) == pytest.approx(of.state(a, c, case.own), rel=1e-15)
    for found, (a, c) in zip(solved(each_series, case, contacts, 4), contacts, strict=True):
        assert tuple(found) == pytest.approx(of.series(a, c, case.own), rel=1e-15)
    rows = [(0.1, *contact) for contact in contacts]
    for found, row in zip(solved(each_pressure, case, rows, 1), rows, strict=True):
        assert found[0] == pytest.approx(of.pressure(*row, case.own), rel=1e-15)


def test_a_cylinder_by_hand():
    """R = E* = 1, a = 3/4, c = 5/4: P = pi h**2/16 = pi/4, M = P (a - c)/2, alpha = (a - c)/2 and
    K_N = sqrt(h)/2."""
    ((load, moment, tilt, left, right),) = solved(each_state, hertz, [(0.75, 1.25)], 5)
    assert (load, moment, tilt) == pytest.approx((math.pi / 4, -math.pi / 16, -0.25), rel=1e-15)
    assert left == right == pytest.approx(math.sqrt(0.5), rel=1e-15)


def test_a_contact_that_leaves_the_body_carries_nothing():
    """A cylinder that ends at x = -1 and 1; the contact beside it is none the worse."""
    inside, outside = solved(each_state, cut, [(0.5, 0.75), (0.5, 1.25)], 5)
    assert np.all(np.isfinite(inside)) and np.all(np.isnan(outside))
