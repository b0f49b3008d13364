"""What contacts carry, case by case: what the law says times E*, NaN where a contact leaves the
body."""

import math

import numpy as np
import pytest

from generated.runtime.forward import each_pressure, each_series, each_state
from tests.runtime.laws import hertz, solved, wedge
from tests.runtime.test_inverse import cut

MODULUS = 3.0


@pytest.mark.parametrize("case", [hertz, wedge], ids=["hertz", "wedge"])
def test_loops_give_what_the_law_gives(case):
    law, own = case.functions, case.own
    for a, c in ((1.0, 0.5), (0.25, 2.0)):
        (state,) = solved(each_state, case, [(a, c, MODULUS)], 5)
        scale = np.array([MODULUS, MODULUS, 1.0, MODULUS, MODULUS])  # a tilt is what it is
        np.testing.assert_allclose(state, scale * law.state(a, c, own), rtol=1e-15)
        (series,) = solved(each_series, case, [(a, c, MODULUS)])
        np.testing.assert_allclose(series, MODULUS * np.array(law.series(a, c, own)), rtol=1e-15)
        ((pressure,),) = solved(each_pressure, case, [(0.1, a, c, MODULUS)], 1)
        assert pressure == pytest.approx(MODULUS * law.pressure(0.1, a, c, own), rel=1e-15)


def test_a_cylinder_by_hand():
    """R = E* = 1, a = 3/4, c = 5/4: P = pi h**2/16 = pi/4, M = P (a - c)/2, alpha = (a - c)/2 and
    K_N = sqrt(h)/2."""
    ((load, moment, tilt, left, right),) = solved(each_state, hertz, [(0.75, 1.25, 1.0)], 5)
    assert (load, moment, tilt) == pytest.approx((math.pi / 4, -math.pi / 16, -0.25), rel=1e-15)
    assert left == right == pytest.approx(math.sqrt(0.5), rel=1e-15)


def test_a_contact_that_leaves_the_body_carries_nothing():
    """A cylinder that ends at x = -1 and 1; the contact beside it is none the worse."""
    inside, outside = solved(each_state, cut, [(0.5, 0.75, 1.0), (0.5, 1.25, 1.0)], 5)
    assert np.all(np.isfinite(inside)) and np.all(np.isnan(outside))
