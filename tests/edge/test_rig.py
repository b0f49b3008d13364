"""Loads of a rig: by hand, against the exact slip zones of the prototype, and what is refused."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import flat_rounded, hertz, wedge_parabola
from generated.edge import Edge, describe, match
from generated.hertz import Edges, Regime

F = 0.5
STEEL = {"E_star": 115e9}
PADS = {"R": 0.15, "b": 1e-3}
"""Of the prototype, a flat with rounded edges."""

END = flat_rounded.contact(2.6e6, 700.0, **STEEL, **PADS)


def prototype(part: float, moving: bool = False, dsigma: float = 5e7) -> tuple[Any, Any, Any]:
    """Contacts, both edges and exact slip zones of a prototype under a part of its changes."""
    first = END
    if moving:
        first = flat_rounded.contact(2.6e6 * (1 - 0.05 * part), 700.0, **STEEL, **PADS)
    shear = 6e5 * part, dsigma * part
    at = END.a, END.c
    K_N, L_N = (of(*at, **STEEL, **PADS) for of in (flat_rounded.K_N, flat_rounded.L_N))
    K_T, L_T = flat_rounded.K_T(*at, *shear), flat_rounded.L_T(*at, *shear)
    moves = END.a - first.a, END.c - first.c
    edges = Edges(
        *(
            Edge(*(float(v) for v in row), side=side)
            for *row, side in zip(K_N, K_T, moves, L_N, L_T, ("left", "right"), strict=True)
        )
    )
    zone = flat_rounded.stick_zone(first, END, *shear, f=F, **STEEL, **PADS)
    d = Edges(float(END.a - zone.m), float(END.c - zone.n))
    return (first, END), edges, d


def test_a_cylinder_by_hand() -> None:
    """K_N = E* sqrt(h)/(2 R), P = pi E* h**2/(16 R), K_T = dQ/(pi sqrt(h)), E* = R = 1.

    K_N = 1 asks h = 4, P = pi; K_T = 0.1 asks dQ = 0.2 pi; the edge moves by 0.1: h was 3.8.
    """
    rig = match(Edge(1.0, 0.1, da=0.1), hertz, f=F, E_star=1.0, R=1.0)
    assert_allclose((rig.P, rig.M, rig.dQ, rig.dsigma), (np.pi, 0, 0.2 * np.pi, 0), rtol=1e-9)
    assert_allclose((rig.second.a, rig.second.c), (2, 2), rtol=1e-9)
    assert_allclose((rig.dP, rig.dM), (np.pi * (1 - 0.95**2), 0), rtol=1e-9)
    assert rig.met == ("K_N (left)", "K_T (left)", "da (left)") and rig.missed == ()
    assert rig.warning == "" and rig.parameters == {"R": 1.0}


def test_a_free_radius_by_hand() -> None:
    """L_N = -K_N/(2 h): K_N = 1 and L_N = -1/2 ask h = 1, and R = E* sqrt(h)/(2 K_N) = 1/2.

    K_T = L_T = 0.05: force 0.05, pull (0.05 - 0.1)/4; dQ = pi 0.0625, dsigma = -0.1.
    """
    wished = Edge(1.0, 0.05, L_N=-0.5, L_T=0.05)
    rig = match(wished, hertz, f=F, E_star=1.0, free="R")
    assert_allclose(rig.parameters["R"], 0.5, rtol=1e-9)
    assert_allclose((rig.dQ, rig.dsigma), (0.0625 * np.pi, -0.1), rtol=1e-9)
    assert_allclose(rig.next_order.left, 0, atol=1e-9)
    right = match(wished._replace(side="right"), hertz, f=F, E_star=1.0, free="R")
    assert_allclose((right.dQ, right.dsigma), (0.0625 * np.pi, 0.1), rtol=1e-9)
    assert_allclose(right.d.right, rig.d.left, rtol=1e-9)


def test_both_edges_of_the_same_body_give_its_own_loads() -> None:
    (_, end), edges, d = prototype(0.5, moving=True)
    rig = match(edges, flat_rounded, f=F, **STEEL, **PADS)
    assert_allclose((rig.P, rig.M), (2.6e6, 700.0), rtol=1e-6)
    assert_allclose((rig.dQ, rig.dsigma, rig.dP), (3e5, 2.5e7, 0.025 * 2.6e6), rtol=1e-6)
    assert_allclose(rig.dM, 0, atol=1e-3)
    assert_allclose(rig.d, d, rtol=1e-6)
    assert_allclose([e[:5] for e in rig.edges], [e[:5] for e in edges], rtol=1e-6)
    assert_allclose(rig.second, end, rtol=1e-6)
    assert rig.missed == () and len(rig.met) == 10


def test_shear_the_other_way_is_turned() -> None:
    one, other = (match(Edge(1.0, K_T), hertz, f=F, E_star=1.0, R=1.0) for K_T in (0.1, -0.1))
    assert one.dQ == other.dQ > 0 and one.d == other.d
    assert_allclose(other.edges.left.K_T, -0.1, rtol=1e-9)


@pytest.mark.enough("left-True", "right-False")
@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("side", ["left", "right"])
def test_slip_zones_agree_to_the_second_order(side: str, moving: bool) -> None:
    """They differ by d**2: a quarter of it for half of d.  Exact ones on both sides."""
    for free, wishes in (({"R": 0.1}, {"L_N": None, "L_T": None}), ({"free": "R"}, {})):
        lengths, off = [], []
        for part in (0.4, 0.2, 0.1, 0.05):
            _, edges, d = prototype(part, moving)
            wished = getattr(edges, side)._replace(**wishes)
            rig = match(wished, hertz, f=F, **STEEL, **free)
            assert not any("K_" in words or "da" in words for words in rig.missed)
            lengths.append(getattr(d, side))
            off.append(abs(getattr(rig.d, side) - getattr(d, side)))
        slopes = np.diff(np.log(off)) / np.diff(np.log(lengths))
        assert np.all(np.abs(slopes - 2) < 0.25), slopes
        assert abs(slopes[-1] - 2) < 0.1


WHOLE = {"f": F, "E_star": 1.0, "R": 1.0}
FREE = {"f": F, "E_star": 1.0, "free": "R"}
ONE = Edge(1.0, 0.1)


@pytest.mark.parametrize(
    ("edge", "regime", "words"),
    [
        (Edge(1.0, 3.0), Regime.SLIDING, "dQ reaches f (P_1 + P_2): the contact slides"),
        (Edge(1.0, 0.5), Regime.MODERATE, "large part"),
        (Edge(1.0, 0.1), Regime.MODERATE, ""),
        (Edge(1.0, 0.01, da=0.1), Regime.FULL_STICK, "nothing slips"),
    ],
)
def test_what_is_warned_of(edge: Edge, regime: Regime, words: str) -> None:
    """The slip zones of 0.1 and 0.5 are 0.2 and more than 1 of a contact of 4 wide."""
    rig = match(edge, hertz, **WHOLE)
    assert rig.regime == regime and words in rig.warning
    assert (rig.warning == "") == (words == "")
    assert np.isnan(rig.d.left) == (regime == Regime.SLIDING)


def test_a_rig_in_words() -> None:
    """L_N = -1/8; a request counts as met to 1e-8 of it."""
    rig = match(Edge(1.0, 0.1, L_N=-0.125 * (1 + 5e-8), L_T=0.01), hertz, **WHOLE)
    words = describe(rig)
    assert "not met: L_N (left) is -0.125 instead of -0.125" in words
    assert "met: K_N (left), K_T (left), da (left), L_T (left)" in words
    assert "slip zone" in words and "R = 1" in words and " %" in words
    met = match(Edge(1.0, 0.1, L_N=-0.125 * (1 + 2e-9)), hertz, **WHOLE).met
    assert "L_N (left)" in met
    with pytest.raises(TypeError, match="must be a Rig, as returned by match"):
        describe(3.0)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("edge", "body", "given", "words"),
    [
        (Edge(-1.0, 0.1), hertz, WHOLE, "K_N must be one positive finite number"),
        (Edge(1.0, np.nan), hertz, WHOLE, "K_T must be one finite number"),
        (Edge(1.0, np.ones(2)), hertz, WHOLE, "K_T must be one finite number"),
        (Edge(1.0, 0.1, side="top"), hertz, WHOLE, "side must be 'left' or 'right'"),
        (ONE, hertz, WHOLE | {"f": 0.0}, "f must be one positive"),
        (ONE, hertz, WHOLE | {"R": -1.0}, "R must be one positive"),
        (ONE, hertz, WHOLE | {"R": None}, "R must be a real number"),
        (ONE, hertz, WHOLE | {"S": 2.0}, "unexpected keyword argument 'S'"),
        (ONE, hertz, {"f": F, "E_star": 1.0}, "missing .* keyword-only argument: 'R'"),
        (ONE._replace(L_N=1.0), hertz, WHOLE | {"free": "R"}, "give either R or L_N"),
        (Edge(1.0, 0.1, da=3.0), hertz, WHOLE, "M = dM = 0 has .* da = "),
        (Edges(ONE, Edge(2.0, 0.1)), hertz, WHOLE, "K_N = 1.41421 and 1.41421, .* match one"),
        (ONE, hertz, FREE, "give either R or L_N of an edge"),
        (ONE._replace(L_N=0.5), hertz, FREE, "give R in place of L_N"),  # a cylinder's is negative
        (Edge(0.2, 0.1, side="right"), wedge_parabola, WHOLE | {"phi": 1.0}, "with M = dM = 0 has"),
        (ONE, np, WHOLE, "generated body"),
        (1.0, hertz, WHOLE, "edge must be an Edge"),
        ((1.0, 0.1), hertz, WHOLE, "edge must be an Edge"),
        (Edges(1.0, 0.1), hertz, WHOLE, "edge must be an Edge"),
    ],
)
def test_what_is_refused(edge: Any, body: Any, given: dict[str, Any], words: str) -> None:
    with pytest.raises((TypeError, ValueError), match=words):
        match(edge, body, **given)
