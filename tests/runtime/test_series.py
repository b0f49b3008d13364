"""Series of the slip zones: theory's second order, both ends of a half-cycle, what is not known.

Values by hand and errors order by order are in tests/generated/test_slip.py.
"""

import math

import numpy as np
import pytest

from generated.runtime.slip.series import each_slip_zones

from .laws import hertz, solved, state, wedge

F = 0.5


def series(case, *rows):
    """Rows of a, c, dQ, dsigma, da, dc to the zones of both orders."""
    return solved(each_slip_zones, case, [(*row, F, 1.0) for row in rows], 4)


def patch(case, load, tilt):
    """The contact under a load at a tilt, in closed form; all parameters 1."""
    if case is hertz:
        h = math.sqrt(16 * load / math.pi)
        return h / 2 + tilt, h / 2 - tilt
    root = math.tan(math.pi / 4 * (1 - tilt))
    return load / root, load * root


@pytest.mark.parametrize("tension", [0.5, 3.0, -3.0])
def test_the_second_order_is_that_of_theory(tension):
    """f K d - (L_T/2) d + (3/4) f L d**2 = K_T + f K d**2/(8 h) + kappa f K' d'**2/(4 h).

    What is left over is of third order: 10**-3 as the loads fall to a tenth.
    """
    a, c = 1.5, 1.0
    h, left_over = a + c, []
    load, _, _, *K = state(wedge, a, c)
    L = wedge.functions.series(a, c, wedge.own)
    for part in (0.02, 0.002):
        dQ = part * F * load
        dsigma = tension * 8 * dQ / (math.pi * h)
        d = series(wedge, [a, c, dQ, dsigma, 0, 0])[0, 2:]
        for i, side in ((0, 1), (1, -1)):
            pull = dQ / math.pi + side * dsigma * h / 8
            sense = math.copysign(1, pull)
            K_T = sense * pull / math.sqrt(h)
            L_T = sense * (pull / (2 * h) - side * dsigma / 4) / math.sqrt(h)
            kappa = -1 if abs(tension) > 1 else 1
            off = F * K[i] * d[i] - L_T / 2 * d[i] + 3 / 4 * F * L[i] * d[i] ** 2 - K_T
            off -= F * K[i] * d[i] ** 2 / (8 * h)
            off -= kappa * F * K[1 - i] * d[1 - i] ** 2 / (4 * h)
            left_over.append(abs(off) / part)
    assert max(left_over[:2]) < 1e-3
    assert all(new < old / 80 for old, new in zip(left_over[:2], left_over[2:], strict=True))


def test_both_ends_of_a_half_cycle_see_one_stick_zone():
    now = series(wedge, [1.5, 1.0, 0.1, 0.02, 0.01, 0.02])[0, 2:]
    then = series(wedge, [1.49, 0.98, 0.1, 0.02, -0.01, -0.02])[0, 2:]
    assert (1.5 - now[0], 1.0 - now[1]) == pytest.approx((1.49 - then[0], 0.98 - then[1]))


def test_what_is_not_known():
    """What slides, where none slips, and where no part sticks to the first order."""
    whole = 2 * F * state(wedge, 1.5, 1.0)[0]
    for dQ, dsigma, da in (
        (whole, 0, 0),  # slides
        (-0.1, 0, 0),
        (math.nan, 0, 0),
        (0.1, math.inf, 0),
        (0.01, 0, 0.5),  # the edge runs ahead of slip
        (0.01, 0, 3.0),  # no contact there
        (0.1, 30, 0),
    ):
        assert np.all(np.isnan(series(wedge, [1.5, 1.0, dQ, dsigma, da, 0]))), (dQ, dsigma, da)


def test_without_any_change_nothing_slips():
    assert np.all(series(wedge, [1.5, 1.0, 0, 0, 0, 0]) == 0)
