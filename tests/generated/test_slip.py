"""Series of the slip zones: the first order by hand, and every order against the exact zone."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import hertz, wedge
from generated.runtime.types import Contact, Regime
from tests.measure.benchmarks import series

F, E_STAR = 0.5, 1.25
WEDGE = {"f": F, "E_star": E_STAR, "phi": 0.25}


def load(a: Any, c: Any) -> Any:
    return wedge.load(a, c, E_star=E_STAR, phi=0.25)


def test_first_order_by_hand() -> None:
    """Hertz, a = c = 2, E* = 1.25, R = 4, f = 0.5: K_N = (E*/R) sqrt(2 a)/2 = 0.3125, with p =
    (E*/2R) sqrt(a**2 - x**2).  dQ = pi/100, dsigma = 0.02: K_T = (0.01 +/- 0.02*4/8)/2 = 0.01 and
    0: d = 0.01/(0.5*0.3125) = 0.064 on the left, nothing on the right."""
    given = {"f": F, "E_star": 1.25, "R": 4.0}
    K_N = hertz.K_N(2.0, 2.0, E_star=1.25, R=4.0)
    assert_allclose(K_N, 0.3125, rtol=1e-15)
    d = hertz.slip_zones(2.0, 2.0, np.pi / 100, 0.02, **given)
    assert_allclose(d.left, 0.064, rtol=1e-15)
    assert_allclose(d.right, 0.0, atol=1e-17)


@pytest.mark.parametrize("name", series.BODIES)
def test_errors_fall_with_the_power_of_the_order(name: str) -> None:
    for of in series.measured(name, 0.3 * 0.25 ** np.arange(2, 4)):
        assert_allclose(of.slopes, [1, 2], atol=0.1)


@pytest.mark.parametrize(("tension", "dc"), [(0.5, 0.01), (0.5, -0.01), (2.5, 0.01), (-2.5, 0.01)])
def test_varying_loads_at_every_order(tension: float, dc: float) -> None:
    """Both edges move by a part of what slips; an eighth of all changes: 8**-order of the errors,
    and 8**-1 more for the size of the slip zone."""
    errors = []
    for by in (1 / 8, 1 / 64):
        first = Contact(1.5 * (1 - 0.02 * by), 1.0 * (1 - dc * by), 0.0)
        second = Contact(1.5, 1.0, 0.0)
        shear = 0.3 * F * load(1.5, 1.0) * by
        dsigma = tension * 8 * shear / (np.pi * 2.5)
        zone = wedge.stick_zone(first, second, shear, dsigma, **WEDGE)
        assert zone.regime in (Regime.MODERATE, Regime.LARGE)
        moved = {"da": 1.5 - first.a, "dc": 1.0 - first.c}
        found = [
            wedge.slip_zones(1.5, 1.0, shear, dsigma, **WEDGE, **moved, order=order)
            for order in (1, 2)
        ]
        errors.append([abs(d.left - (1.5 - zone.m)) + abs(d.right - (1 - zone.n)) for d in found])
    powers = np.log(np.array(errors[0]) / errors[1]) / np.log(8)
    assert_allclose(powers, [2, 3], atol=0.25)


def test_what_is_not_known() -> None:
    """What slides, where none slips, and where no part sticks to the first order."""
    zones = [
        wedge.slip_zones(1.5, 1.0, dQ, dsigma, **WEDGE, da=da, order=order)
        for order in (1, 2)
        for dQ, dsigma, da in (
            (2 * F * load(1.5, 1.0), 0.0, 0.0),  # slides
            (-0.1, 0.0, 0.0),
            (np.nan, 0.0, 0.0),
            (0.01, np.inf, 0.0),
            (0.001, 0.0, 0.5),  # the edge runs ahead of slip
            (0.001, 0.0, 3.0),  # no contact there
            (0.01, 30.0, 0.0),
        )
    ]
    assert np.all(np.isnan(zones))
    still = wedge.slip_zones(1.5, 1.0, 0.0, 0.0, **WEDGE, order=2)
    assert np.all(np.array(still) == 0)


def test_both_ends_of_a_half_cycle_see_one_stick_zone() -> None:
    now = wedge.slip_zones(1.5, 1.0, 0.01, 0.002, **WEDGE, da=0.01, dc=0.02, order=2)
    then = wedge.slip_zones(1.49, 0.98, 0.01, 0.002, **WEDGE, da=-0.01, dc=-0.02, order=2)
    assert_allclose((1.5 - now.left, 1.0 - now.right), (1.49 - then.left, 0.98 - then.right))


@pytest.mark.parametrize("share", [1e-4, 1e-3])
def test_the_estimate_of_tiny_slip_zones_by_hand(share: float) -> None:
    """A cylinder: K, L = -K/(2 h), and exactly d = (h/2)(1 - sqrt(1 - q)), q = dQ/(2 f P).

    By the first order d = h q/4; exactly d = h (q/4 + q**2/16 + q**3/32 + ...).  The second order
    adds d**2/h, with d of the first order; what it leaves out is estimated as (d**2/h)**2/d.
    With a = c = 1, E* = 1 and R = pi/2 the load is P = pi E* h**2/(16 R) = 1/2.
    """
    here, law = (1.0, 1.0, F * share, 0.0), {"f": F, "E_star": 1.0, "R": np.pi / 2}
    d = share / 2
    first, second = (hertz.slip_error(*here, **law, order=order) for order in (1, 2))
    assert_allclose(first, d**2 / 2, rtol=1e-14 / d + 4 * d)
    assert_allclose(second, d**3 / 4, rtol=1e-14 / d + 8 * d)
