"""Next to an edge: against the exact fields of a cylinder, in the limit of small slip zones."""

from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import hertz
from generated.edge import peak, reach, slip_range, slip_zone, tractions, work

F, LAW = 0.5, {"E_star": 1.25, "R": 4.0}
S = np.array([0.2, 0.5, 0.9, 1.1, 2.0, 4.0])
"""Distances from the edge over the slip zone."""


class Case(NamedTuple):
    here: Any
    dQ: float
    d: float
    given: dict[str, Any]


def case(part: float) -> Case:
    """A cylinder under shear that swings by a part of 2 f P; the left edge's coefficients."""
    here = hertz.contact(1.0, 0.0, **LAW)
    dQ = 2 * F * part
    zone = hertz.stick_zone(here, here, dQ, 0.0, f=F, **LAW)
    args = here.a, here.c, dQ, 0.0
    given = {
        "K_N": hertz.K_N(*args[:2], **LAW).left,
        "K_T": hertz.K_T(*args).left,
        "f": F,
        "L_N": hertz.L_N(*args[:2], **LAW).left,
        "L_T": hertz.L_T(*args).left,
    }
    return Case(here, dQ, float(here.a - zone.m), given)


def falls(off: Any, power: float) -> None:
    """An eighth of the shear: 8**-power of the error."""
    assert np.all(np.abs(off(0.04)) > 0)
    found = np.log(np.max(np.abs(off(0.04))) / np.max(np.abs(off(0.005)))) / np.log(8)
    assert found > power - 0.15


@pytest.mark.parametrize("order", [1, 2])
def test_tractions_come_to_the_exact_ones(order: int) -> None:
    def off(part: float) -> Any:
        of = case(part)
        s = S * of.d
        x = s - of.here.a
        found = tractions(s, **of.given, order=order)
        change = hertz.shear_change(x, of.here, of.here, of.dQ, 0.0, f=F, **LAW)
        shear = hertz.shear(x, of.here, of.dQ / 2, 0.0, f=F, **LAW)
        p = hertz.pressure(x, of.here.a, of.here.c, **LAW)
        return [found.dq / change - 1, found.q / shear - 1, found.p / p - 1]

    falls(off, 1)


def test_every_instant_comes_to_the_exact_one() -> None:
    def off(part: float) -> Any:
        of = case(part)
        s = S * of.d
        x = s - of.here.a
        found = []
        for mean in (0.0, 0.4, -0.4):
            top = (0.5 + mean) * of.dQ
            for share, back in ((0.3, True), (1.0, True)):
                exact = hertz.shear(x, of.here, top, 0.0, dQ=share * of.dQ, f=F, **LAW)
                if mean < 0:  # it came from nothing to the lowest load: mirrored
                    back, bottom = not back, (mean - 0.5) * of.dQ
                    exact = -hertz.shear(x, of.here, -bottom, 0.0, dQ=share * of.dQ, f=F, **LAW)
                at = tractions(s, **of.given, share=share, back=back, mean=mean * of.given["K_T"])
                found.append((at.q - exact) / np.max(np.abs(exact)))
        return found

    falls(off, 1)


def test_slip_and_work_come_to_the_exact_ones() -> None:
    nodes, weights = np.polynomial.legendre.leggauss(40)

    def off(part: float) -> Any:
        of = case(part)
        s = (nodes + 1) / 2 * of.d
        x = s - of.here.a
        exact = hertz.slip_range(x, of.here, of.here, of.dQ, 0.0, f=F, **LAW)
        done = F * hertz.pressure(x, of.here.a, of.here.c, **LAW) * exact
        whole = 2 * np.sum(weights / 2 * of.d * done)
        slip = slip_range(s, **of.given, E_star=LAW["E_star"])
        return [(slip - exact) / exact[0], np.full(40, work(**of.given, E_star=1.25) / whole - 1)]

    falls(off, 1)


def test_work_by_hand() -> None:
    """pi f**2 K**2 d**3/(3 E*): f = 1/2, K = 2, E* = pi/3, K_T = 1/2: d = 1/2, 1/8 of 1 over 1."""
    assert_allclose(work(2.0, 0.5, f=0.5, E_star=np.pi / 3), 1 / 8, rtol=1e-14)


def test_work_is_that_of_the_slip_range() -> None:
    given = dict(f=0.5, L_N=0.7, L_T=0.3, N_N=-0.4, N_T=0.2, E_star=1.5)
    friction = {k: v for k, v in given.items() if k != "E_star"}
    d = slip_zone(2.0, 0.2, **friction).d
    # s = d u**2: the root of the pressure becomes a polynomial
    u, weights = np.polynomial.legendre.leggauss(60)
    u, weights = (u + 1) / 2, weights / 2
    s = d * u**2
    p = np.sqrt(s) * (2.0 + 0.7 * s - 0.4 * s**2)
    whole = 2 * np.sum(weights * 2 * d * u * 0.5 * p * slip_range(s, 2.0, 0.2, **given))
    assert_allclose(work(2.0, 0.2, **given), whole, rtol=1e-7)


def test_a_moving_edge_keeps_its_change_of_shear_bounded_and_meets_full_stick() -> None:
    """Far from the edge dq is full stick's to s**(-3/2); at the stick zone it is continuous."""
    given = dict(K_N=2.0, K_T=0.2, f=0.5, L_N=0.7, L_T=0.3, da=0.05)
    d = slip_zone(**given).d
    inside, outside = tractions(d * (1 + np.array([-1e-12, 1e-12])), **given).dq
    assert_allclose(inside, outside, rtol=1e-5)
    s = np.array([1e3, 4e3]) * d
    left = tractions(s, **given).dq * np.sqrt(s) - (0.2 + 0.3 * s)
    assert_allclose(left[0] / left[1], 4.0, rtol=0.05)


def test_where_an_edge_moves_shear_is_known_where_it_slips_alone() -> None:
    d = slip_zone(2.0, 0.2, f=0.5, da=0.05).d
    found = tractions([0.5 * d, 2 * d], 2.0, 0.2, f=0.5, da=0.05)
    assert_allclose(found.q[0], 0.5 * found.p[0], rtol=1e-15)
    assert np.isnan(found.q[1]) and np.isfinite(found.dq[1])
    assert np.isnan(slip_range(0.02, 2.0, 0.2, f=0.5, E_star=1.0, da=0.05))


def test_both_half_cycles_of_a_moving_edge_change_shear_by_the_same() -> None:
    given = dict(K_N=2.0, K_T=0.2, f=0.5, L_N=0.7, L_T=0.3, da=0.05)
    s = np.array([0.1, 0.2, 0.3, 1.0])
    there, back = (tractions(s, **given, back=way).dq for way in (False, True))
    assert_allclose(there, -back, rtol=1e-9)


def test_sense_and_peak() -> None:
    """First load: twice as far under one contact's pressure, d = 2 K/(f K_N) of K = K_T/2 + mean.

    K_N = 2, f = 1/2, K_T = 1/4: d = 1/4, q = f p = sqrt(1/4); with mean 3/8 it is d = 1."""
    assert_allclose(peak(2.0, 0.25, f=0.5), (0.25, 0.5), rtol=1e-14)
    assert_allclose(peak(2.0, 0.25, f=0.5, mean=0.375), (1.0, 1.0), rtol=1e-14)
    there, back = (tractions(0.3, 2.0, K, f=0.5) for K in (0.25, -0.25))
    assert_allclose((there.q, there.dq), (-back.q, -back.dq), rtol=1e-15)


def test_reach_by_hand() -> None:
    assert_allclose(reach(2.0, 1.0, L_N=-4.0, L_T=1.0), 0.5, rtol=1e-15)
    assert_allclose(reach(2.0, 1.0, h=0.25, L_N=-4.0), 0.25, rtol=1e-15)
    assert np.isnan(reach(2.0, 1.0))
