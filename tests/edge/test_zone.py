"""Slip zones of an edge: by hand, against those of a body, and what is refused."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import wedge
from generated.edge import reach, slip_zone

SECOND = {"L_N": 4.0, "L_T": 1.0}
F = 0.5

# With f = 1/2.  Order 1: 0.01/(0.5*0.3125) = 0.064, half of what the edge gains is added.
# Order 2, K_N = 2, L_N = 4, L_T = 1: d - d/2 + (3/2) d**2 = K_T, so d = 1/2 for 5/8; h = 1 puts
# d**2/8 more on the right.  An edge that moves by 1/10 had K_N = 2 + (3/2) 4/10 = 2.6 and 2/5 of
# slip: (1/2)(2/4 + 3*4/32) + (1/2)(2.6/5 + 3*4*0.16/8) = 0.8175 = K_T + 1/4.
# One that moves by half of a slip zone of 2, with K_N = 1 and L_N = 4/3, had K_N = 3:
# (1/2)(2/2 + (4/3) 3*4/8) + (1/2)(3/2 + (4/3) 3/8) = 5/2 = K_T.
BY_HAND = [
    (0.3125, 0.01, {}, 0.064, np.nan),
    (0.3125, -0.01, {}, 0.064, np.nan),
    (0.3125, 0.01, {"da": 0.004}, 0.066, np.nan),
    (0.3125, 0.01, {"da": -0.002}, 0.063, np.nan),
    (2.0, 5 / 8, SECOND, 0.5, 1 / 8),
    (2.0, 5 / 8, SECOND | {"order": 1}, 5 / 8, 1 / 8),
    (2.0, -5 / 8, {"L_N": 4.0, "L_T": -1.0}, 0.5, 1 / 8),
    (2.0, 19 / 32, SECOND | {"h": 1.0}, 0.5, 3 / 32),
    (2.0, 0.8175 - 0.25, SECOND | {"da": 0.1}, 0.5, 0.5675 + 0.05 - 0.5),
    (1.0, 2.5, {"L_N": 4 / 3, "L_T": 0.0, "da": 1.0}, 2.0, 3.5),
    (1.0, 0.0, {}, 0.0, np.nan),
    (1.0, 0.0, {"L_N": 1.0, "L_T": 0.0}, 0.0, 0.0),
]


@pytest.mark.parametrize(("K_N", "K_T", "given", "d", "error"), BY_HAND)
def test_by_hand(K_N: float, K_T: float, given: Any, d: float, error: float) -> None:
    assert_allclose(slip_zone(K_N, K_T, f=F, **given), (d, error), rtol=1e-13, atol=1e-15)


# ways to give what is beside K_N, K_T and f; the power of d that the error falls with
WAYS = [({"order": 1}, 1), ({}, 1), ({"h": 2.5}, 1), ({"h": 2.5, "other": True}, 2)]


@pytest.mark.parametrize("tension", [0.0, 0.5])
@pytest.mark.parametrize(("given", "power"), WAYS)
def test_it_comes_to_the_bodys_own(given: dict[str, Any], power: int, tension: float) -> None:
    """An eighth of the loads; with the other edge as in docs/edge.md to one order more."""
    law, a, c, off = {"E_star": 1.25, "phi": 0.25}, 1.5, 1.0, []
    K, L = wedge.K_N(a, c, **law), wedge.L_N(a, c, **law)
    for dQ in (0.02, 0.0025):
        dsigma = tension * 8 * dQ / np.pi / (a + c)
        K_T, L_T = wedge.K_T(a, c, dQ, dsigma), wedge.L_T(a, c, dQ, dsigma)
        d = wedge.slip_zones(a, c, dQ, dsigma, f=F, order=2, **law).left
        by_other = 0.0
        if "other" in given:
            by_other = K_T.right * slip_zone(K.right, K_T.right, f=F).d / 4 / (a + c)
        known = {k: v for k, v in given.items() if k != "other"} | {"L_N": L.left, "L_T": L_T.left}
        off.append(abs(slip_zone(K.left, K_T.left + by_other, f=F, **known).d / d - 1))
    assert np.log(off[0] / off[1]) / np.log(8) > power - 0.15


def test_where_there_is_none() -> None:
    assert np.all(np.isnan(slip_zone([-1.0, 1.0, 1.0], [0.01, 0.01, np.nan], f=[F, -F, F]).d))
    assert np.isnan(slip_zone(1.0, 0.01, f=F, da=0.5).d)  # the edge runs ahead of slip
    assert np.isnan(slip_zone(1.0, 0.01, f=F, L_N=-30.0, L_T=0.0).d)  # friction never holds
    found = slip_zone(np.ones((3, 1)), 0.01, f=[F, 0.6], L_N=0.1, L_T=0.0)
    assert found.d.shape == found.error.shape == (3, 2)


@pytest.mark.parametrize(
    ("K_N", "given", "words"),
    [
        (1.0, {"order": 2}, "order 2 needs L_N and L_T"),
        (1.0, {"L_N": 4.0}, "give both, or neither"),
        (1.0, {"L_T": 1.0, "order": 1}, "give both, or neither"),
        (1.0, {"order": 9}, "order must be 1 or 2; got 9"),
        (1.0, SECOND | {"order": 3}, "order must be 1 or 2"),
        (1.0, {"order": 1.5}, "whole number"),
        (None, {}, "K_N must be a real number"),
    ],
)
def test_what_is_refused(K_N: Any, given: Any, words: str) -> None:
    kind = TypeError if "number" in words else ValueError
    with pytest.raises(kind, match=words):
        slip_zone(K_N, 0.01, f=F, **given)


def test_reach_by_hand() -> None:
    assert_allclose(reach(2.0, 1.0, L_N=-4.0, L_T=1.0), 0.5, rtol=1e-15)
    assert_allclose(reach(2.0, 1.0, h=0.25, L_N=-4.0), 0.25, rtol=1e-15)
    assert np.isnan(reach(2.0, 1.0))
