"""Slip zones of an edge: by hand, against each body's own, and against the exact ones."""

import importlib
import re
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from derive.library import library
from generated import edge, hertz, wedge
from generated.edge import OtherEdge, Pressure, slip_zone
from generated.runtime.types import Contact

F = 0.5


def law_of(body: Any) -> tuple[dict[str, float], float, float, float]:
    """The constants, the contact and the shear of a body's own examples."""
    a, c, *law = re.search(r"load\((.*?)\):", body.load.__doc__)[1].split(", ")
    constants = {name: float(value) for name, value in (text.split("=") for text in law)}
    return constants, float(a), float(c), body.load(float(a), float(c), **constants) / 8


def pressures(body: Any, law: dict[str, float], a: float, c: float) -> tuple[Pressure, Pressure]:
    """Both coefficients at each edge."""
    K, L = body.K_N(a, c, **law), body.L_N(a, c, **law)
    return Pressure(K.left, L.left), Pressure(K.right, L.right)


# dsigma over that at which K_T vanishes at the right edge, and the moves of both edges
CASES = [
    (0.0, 0.0, 0.0),
    (0.3, 0.0, 0.0),
    (2.5, 0.0, 0.0),
    (0.0, 0.004, -0.002),
    (2.5, 0.004, 0.001),
]


@pytest.mark.enough("hertz-*", "wedge-*", "flat_sloped-*", "power-*", "unequal_wedge-*")
@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("name", library())
def test_with_both_edges_it_is_the_bodys_own(name: str, order: int) -> None:
    body = importlib.import_module(f"generated.{name}")
    law, a, c, dQ = law_of(body)
    for part, da, dc in CASES:
        dsigma = part * 8 * dQ / np.pi / (a + c)
        own = body.slip_zones(a, c, dQ, dsigma, f=F, da=da, dc=dc, order=order, **law)
        K_T = body.K_T(a, c, dQ, dsigma)
        now, then = pressures(body, law, a, c), pressures(body, law, a - da, c - dc)
        others = [
            OtherEdge(p.K_N, K, p.L_N, p.N_N, move, before)
            for p, K, move, before in zip(now, K_T, (da, dc), then, strict=True)
        ]
        for side, (d, move) in enumerate(zip(own, (da, dc), strict=True)):
            found = slip_zone(
                *(now[side].K_N, K_T[side]),
                f=F,
                **{"L_N": now[side].L_N, "h": a + c, "da": move, "order": order},
                then=then[side],
                other=others[1 - side],
            )
            assert_allclose(found.d, d, rtol=4e-15)
            error = body.slip_error(a, c, dQ, dsigma, f=F, da=da, dc=dc, order=1, **law)
            assert_allclose(found.error, error[side], rtol=1e-6, atol=1e-14 * d)


def test_first_order_by_hand() -> None:
    """0.01/(0.5*0.3125) = 0.064; half of what the edge gains is added, half taken off."""
    assert_allclose(slip_zone(0.3125, [0.01, -0.01], f=0.5).d, 0.064, rtol=1e-15)
    found = slip_zone(0.3125, 0.01, f=0.5, da=[0.004, -0.002])
    assert_allclose(found.d, [0.066, 0.063], rtol=1e-14)
    assert np.all(np.isnan(found.error))


def test_second_order_by_hand() -> None:
    """f = 1/2, K_N = 2, L_N = 4, L_T = 1: d - d/2 + (3/2) d**2 = K_T; d = 1/2 for K_T = 5/8.

    With h = 1 there is d**2/8 more on the right: 1/4 + 3/8 - 1/32 = 19/32.  At order 1 d = K_T.
    """
    alone = slip_zone(2.0, 5 / 8, f=0.5, L_N=4.0, L_T=1.0)
    assert_allclose(alone.d, 0.5, rtol=1e-14)
    assert_allclose(alone.error, 1 / 8, rtol=1e-14)
    assert_allclose(slip_zone(2.0, -5 / 8, f=0.5, L_N=4.0, L_T=-1.0).d, 0.5, rtol=1e-14)
    assert_allclose(slip_zone(2.0, 19 / 32, f=0.5, L_N=4.0, L_T=1.0, h=1.0).d, 0.5, rtol=1e-14)


def test_third_order_by_hand() -> None:
    """N_N = 16, N_T = 8 more: (5/8)(1/2)(16)/8 = 5/8 more to hold, (3/8) 8/4 = 3/4 less."""
    whole = dict(L_N=4.0, L_T=1.0, N_N=16.0, N_T=8.0)
    found = slip_zone(2.0, 5 / 8 + 5 / 8 - 3 / 4, f=0.5, **whole)
    assert_allclose(found.d, 0.5, rtol=1e-13)


def test_an_edge_that_moves_by_hand() -> None:
    """K_N(b) = 2 + (3/2) 4 b: 2.6 of the edge that reaches 1/10 less far.

    With d = 1/2 and 2/5 in it, f = 1/2, L_T = 1: (1/2)(2/4 + 3*4/32) + (1/2)(2.6/5 + 3*4*0.16/8)
    = 0.8175 = K_T + 1/4.
    """
    found = slip_zone(2.0, 0.8175 - 0.25, f=0.5, L_N=4.0, L_T=1.0, da=0.1)
    assert_allclose(found.d, 0.5, rtol=1e-13)
    given = slip_zone(2.0, 0.5675, f=0.5, L_N=4.0, L_T=1.0, da=0.1, then=Pressure(2.6, 4.0))
    assert_allclose(given.d, 0.5, rtol=1e-13)


def exact(tension: float, dQ: Any) -> Any:
    """The tilted wedge at constant loads: slip zones, and the left edge's coefficients."""
    law = dict(E_star=1.25, phi=0.25)
    a, c = 1.5, 1.0
    dsigma = tension * 8 * dQ / np.pi / (a + c)
    here = Contact(a, c, wedge.tilt(a, c, phi=0.25))
    zone = wedge.stick_zone(here, here, dQ, dsigma, f=F, **law)
    K_T, L_T = wedge.K_T(a, c, dQ, dsigma), wedge.L_T(a, c, dQ, dsigma)
    given = dict(L_N=wedge.L_N(a, c, **law).left, L_T=L_T.left)
    return a - zone.m, wedge.K_N(a, c, **law).left, K_T.left, given


def test_what_an_edge_alone_leaves_out_by_hand() -> None:
    """A cylinder: exactly d = d_1 + d_1**2/h + ... with d_1 of the first order (tests/generated).

    L_N = -K/(2 h) and L_T = K_T/(2 h) make 3/8 + 1/4 of that term, the width 1/8; 1/4 are the
    other edge's."""
    law, d_1 = {"E_star": 1.0, "R": 1.0}, 1e-4  # h = 2: K_N = sqrt(2)/2
    dQ = d_1 * np.pi * F * 2 / 2
    K_N, K_T = hertz.K_N(1, 1, **law).left, hertz.K_T(1, 1, dQ, 0.0).left
    given = dict(L_N=hertz.L_N(1, 1, **law).left, L_T=hertz.L_T(1, 1, dQ, 0.0).left)
    more = [{"order": 1}, {}, {"h": 2.0}]
    found = [slip_zone(K_N, K_T, f=F, **given, **one).d / d_1 - 1 for one in more]
    assert_allclose(np.array(found) / (d_1 / 2), [0, 5 / 8, 3 / 4], atol=1e-3)


def test_the_error_falls_as_the_slip_zone_does() -> None:
    """An eighth of the loads: an eighth of the error in parts of d, at order 1 and 2 alone."""
    of = [exact(0.5, load) for load in (0.02, 0.0025)]
    for order in (1, 2):
        parts = [
            abs(slip_zone(K_N, K_T, f=F, order=order, **given).d / d - 1)
            for d, K_N, K_T, given in of
        ]
        assert 6 < parts[0] / parts[1] < 10


def test_the_other_edge_from_what_it_gains_where_before_is_not_given() -> None:
    """An eighth of all changes: the coefficients before follow to the second order."""
    law, errors = {"E_star": 1.25, "R": 4.0}, []
    for by in (1 / 8, 1 / 64):
        a, c, da, dc = 1.5, 1.0, 0.1 * by, 0.05 * by
        dQ = 0.3 * F * hertz.load(a, c, **law) * by
        exact_d = hertz.slip_zones(a, c, dQ, 0.0, f=F, da=da, dc=dc, order=2, **law).left
        K_T = hertz.K_T(a, c, dQ, 0.0)
        now = pressures(hertz, law, a, c)
        found = slip_zone(
            *(now[0].K_N, K_T.left),
            f=F,
            **{"L_N": now[0].L_N, "h": a + c, "da": da},
            other=OtherEdge(now[1].K_N, K_T.right, now[1].L_N, da=dc),
        )
        errors.append(abs(found.d - exact_d))
    assert errors[0] < 1e-5
    assert errors[0] / errors[1] > 8**2.7


def test_where_there_is_none() -> None:
    assert np.all(np.isnan(slip_zone([-1.0, 1.0, 1.0], [0.01, 0.01, np.nan], f=[0.5, -0.5, 0.5]).d))
    assert np.isnan(slip_zone(1.0, 0.01, f=0.5, da=0.5).d)  # the edge runs ahead of slip
    assert np.isnan(slip_zone(1.0, 0.01, f=0.5, L_N=-30.0, L_T=0.0).d)  # friction never holds
    assert slip_zone(1.0, 0.0, f=0.5).d == slip_zone(1.0, 0.0, f=0.5, L_N=1.0, L_T=0.0).d == 0
    found = slip_zone(np.ones((3, 1)), 0.01, f=[0.5, 0.6], L_N=0.1, L_T=0.0)
    assert found.d.shape == found.error.shape == (3, 2)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"order": 2}, "order 2 needs L_N and L_T"),
        ({"order": 9}, "order must be 1 with the coefficients given; got 9"),
        ({"L_N": 1.0, "L_T": 1.0, "N_N": 1.0, "N_T": 1.0, "h": 1.0, "order": 3}, "1 to 2"),
        ({"order": 1.5}, "whole number"),
        ({"other": OtherEdge(1.0, 1.0)}, "give h, too"),
        ({"other": OtherEdge(1.0, 1.0), "h": 1.0, "L_T": 1.0}, "follow from h and K_T"),
    ],
)
def test_what_is_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(TypeError if words == "whole number" else ValueError, match=words):
        slip_zone(1.0, 0.01, f=0.5, **given)


def test_what_is_published_is_there() -> None:
    assert set(edge.__all__) <= set(dir(edge))
