"""Newton's method for two slip zones: steps worked out by hand."""

import math

import pytest

from generated.runtime.slip.newton import log_step, moved


def test_a_step_of_two_slip_zones_by_hand():
    """1 + 2 dl = 0 and 1 + 4 dr = 0: dl = -1/2, dr = -1/4.  With l = 1, r = 2 and 4 that stick
    the stick zone grows by 3/4, so that ln(l/4) falls by 1/2 + 3/16, and ln(r/4) by 1/8 + 3/16."""
    by_left, by_right = log_step(1.0, 2.0, (1.0, 2.0, 0.0), (1.0, 0.0, 4.0), 4.0)
    assert (by_left, by_right) == (-0.6875, -0.3125)
    assert all(map(math.isnan, log_step(1.0, 1.0, (1.0, 1.0, 2.0), (1.0, 2.0, 4.0), 1.0)))


def test_slip_zones_that_are_moved_share_the_width_as_before():
    """1 : 4 : 2 with logarithms that grow by ln 2 and ln 3 are 2 : 4 : 6 of the same 7."""
    left, right = moved(7.0, 1.0, 2.0, math.log(2), math.log(3))
    assert (left, right) == pytest.approx((7 / 6, 7 / 2), rel=1e-15)
