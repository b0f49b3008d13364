"""Next to an edge: against the exact fields of a cylinder, in the limit of small slip zones."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import hertz
from generated.edge import Edge, slip_range, slip_zone, tractions

F, LAW = 0.5, {"E_star": 1.25, "R": 4.0}
S = np.array([0.2, 0.5, 0.9, 1.1, 2.0, 4.0])
"""Distances from the edge over the slip zone."""

MOVING = Edge(K_N=2.0, K_T=0.2, L_N=0.7, L_T=0.3, da=0.05)
ZONE = slip_zone(2.0, 0.2, f=F, L_N=0.7, L_T=0.3, da=0.05).d


def test_far_from_an_edge_on_its_way_the_change_is_that_of_full_stick() -> None:
    """Half of the change at half of the way, when the edge is da/2 further in."""
    s = np.array([1e3, 4e3])
    off = tractions(s, MOVING, f=F, share=0.5).dq - (0.2 / np.sqrt(s) + 0.3 * np.sqrt(s)) / 2
    assert np.all(np.abs(off) < 1 / s**1.5)  # the next term of the series


def of_tractions(here: Any, dQ: float, s: Any, edge: Edge) -> Any:
    x = s - here.a
    found = tractions(s, edge, f=F)
    change = hertz.shear_change(x, here, here, dQ, 0.0, f=F, **LAW)
    shear = hertz.shear(x, here, dQ / 2, 0.0, f=F, **LAW)
    p = hertz.pressure(x, here.a, here.c, **LAW)
    return [found.dq / change - 1, found.q / shear - 1, found.p / p - 1]


def of_every_instant(here: Any, dQ: float, s: Any, edge: Edge) -> Any:
    x, off = s - here.a, []
    for mean in (0.0, 0.4, -0.4):
        top = (0.5 + mean) * dQ
        for share in (1.3, 2.0):
            exact = hertz.shear(x, here, top, 0.0, dQ=(share - 1) * dQ, f=F, **LAW)
            if mean < 0:  # it came from nothing to the lowest load: mirrored
                share, bottom = share - 1, (mean - 0.5) * dQ
                exact = -hertz.shear(x, here, -bottom, 0.0, dQ=share * dQ, f=F, **LAW)
            at = tractions(s, edge, f=F, share=share, mean=mean * edge.K_T)
            off.append((at.q - exact) / np.max(np.abs(exact)))
    return off


def of_slip(here: Any, dQ: float, s: Any, edge: Edge) -> Any:
    s = s[:3]
    exact = hertz.slip_range(s - here.a, here, here, dQ, 0.0, f=F, **LAW)
    return slip_range(s, edge, f=F, E_star=LAW["E_star"]) / exact - 1


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("of", [of_tractions, of_every_instant, of_slip])
def test_it_comes_to_the_exact_field(of: Callable[..., Any], order: int) -> None:
    """An eighth of the shear: an eighth of the error, relative to the slip zone."""
    here, off = hertz.contact(1.0, 0.0, **LAW), []
    K, L = hertz.K_N(here.a, here.c, **LAW), hertz.L_N(here.a, here.c, **LAW)
    for dQ in (0.04, 0.005):
        zone = hertz.stick_zone(here, here, dQ, 0.0, f=F, **LAW)
        shear = here.a, here.c, dQ, 0.0
        edge = Edge(K.left, hertz.K_T(*shear).left)
        if order == 2:
            edge = edge._replace(L_N=L.left, L_T=hertz.L_T(*shear).left)
        found = np.abs(of(here, dQ, S * (here.a - zone.m), edge))
        assert np.all(found > 0)
        off.append(np.max(found))
    assert np.log(off[0] / off[1]) / np.log(8) > 0.85


@pytest.mark.parametrize(("da", "L_T"), [(0.05, 0.3), (0.3, 1.8)])
def test_a_moving_edge_keeps_its_change_of_shear_bounded_and_meets_full_stick(
    da: float, L_T: float
) -> None:
    """Far from the edge dq is full stick's to s**(-3/2); at the stick zone it is continuous.  The
    second edge comes a third of the way to the stick zone, where L_T drives slip the most."""
    edge = MOVING._replace(da=da, L_T=L_T)
    zone = slip_zone(2.0, 0.2, f=F, L_N=0.7, L_T=L_T, da=da).d
    assert zone > da
    inside, outside = tractions(zone * (1 + np.array([-1e-12, 1e-12])), edge, f=F).dq
    assert_allclose(inside, outside, rtol=1e-5)
    s = np.array([1e3, 4e3]) * zone
    left = tractions(s, edge, f=F).dq * np.sqrt(s) - (0.2 + L_T * s)
    assert_allclose(left[0] / left[1], 4.0, rtol=0.05)


def test_where_an_edge_moves_shear_is_known_where_it_slips_alone() -> None:
    found = tractions([0.5 * ZONE, 2 * ZONE], MOVING, f=F)
    assert_allclose(found.q[0], 0.5 * found.p[0], rtol=1e-15)
    assert np.isnan(found.q[1]) and np.isfinite(found.dq[1])
    assert np.isnan(slip_range(0.02, MOVING, f=F, E_star=1.0))
    assert np.all(np.isnan(tractions(0.02, MOVING, f=F, share=[-0.1, 2.1, np.nan]).dq))


@pytest.mark.parametrize("of", [tractions, partial(slip_range, E_star=1.0)])
def test_what_is_refused(of: Callable[..., Any]) -> None:
    with pytest.raises(ValueError, match="give both, or neither"):
        of(0.1, Edge(2.0, 0.2, L_T=0.3), f=F)
    with pytest.raises(TypeError, match="edge must be an Edge; got 2"):
        of(0.1, 2.0, f=F)
