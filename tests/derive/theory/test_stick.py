"""Full stick: the two conditions it must meet, its edges, and the sense of its signs."""

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mpf
from sympy import Symbol, limit, pi, simplify, sqrt

from derive.symbols import a, c, dQ, dsigma, h, mid, s, x
from derive.theory.edges import Edge
from derive.theory.stick import K_T, full_stick_change
from tests.derive.bodies import BODIES, close, sheet, value
from tests.derive.integrals import over_contact, root

A, B = Symbol("A", positive=True), Symbol("B", positive=True)
CONTACTS = [(2.0, 1.0), (0.75, 3.0), (-1.0, 2.5), (1.5, 1.5)]
LOADS = [(0.5, 0.0), (0.0, 0.75), (0.5, -1.25)]


def change(place: mpf, left: float, right: float, load: float, tension: float) -> mpf:
    return value("hertz", "full_stick_change", x=place, a=left, c=right, dQ=load, dsigma=tension)


@pytest.mark.parametrize(("left", "right"), CONTACTS)
@pytest.mark.parametrize(("load", "tension"), LOADS)
def test_its_force_is_the_change_of_the_shear_load(
    left: float, right: float, load: float, tension: float
) -> None:
    total = over_contact(
        lambda t: change(t, left, right, load, tension) * root(t, mpf(left), mpf(right)),
        left,
        right,
    )
    assert close(total, mpf(load), scale=1)


@pytest.mark.parametrize(("left", "right"), CONTACTS)
@pytest.mark.parametrize(("load", "tension"), LOADS)
def test_its_strain_is_the_change_of_the_tension(
    left: float, right: float, load: float, tension: float
) -> None:
    """(1/pi) PV int dq(s)/(x - s) ds = dsigma/4, and PV int ds/(w (x - s)) = 0 inside."""

    def numerator(t: mpf) -> mpf:
        return change(t, left, right, load, tension) * root(t, mpf(left), mpf(right))

    for share in ("0.1875", "0.59375", "0.84375"):
        place = -mpf(left) + mpf(share) * (mpf(left) + right)
        here = numerator(place)
        regular = over_contact(
            lambda t, here=here, place=place: (numerator(t) - here) / (place - t),
            left,
            right,
            (place,),
        )
        assert close(regular / mpmath.pi, mpf(tension) / 4, digits=15, scale=1)


@pytest.mark.parametrize("edge", Edge, ids=lambda e: e.name.lower())
def test_K_T_is_sympys_own_limit(edge: Edge) -> None:
    dq = full_stick_change().subs(x, edge.position + edge.inward * s).subs({a: A, c: B})
    expected = limit(dq * sqrt(s), s, 0, "+")
    assert simplify(K_T(edge).subs({a: A, c: B}) - expected) == 0


def test_K_T_by_hand() -> None:
    """x - mid = -h/2 at the left edge and +h/2 at the right one, the other root is sqrt(h)."""
    for edge, sense in ((Edge.LEFT, 1), (Edge.RIGHT, -1)):
        expected = (dQ / mpmath.pi + sense * dsigma * h / 8) / sqrt(h)
        assert abs((K_T(edge) - expected).subs({a: 2, c: 1, dQ: 3, dsigma: 5}).evalf()) < 1e-14


_load = st.floats(0.01, 10)
_edge = st.floats(0.125, 8)


@given(_edge, _edge, _load, _load)
def test_shear_and_tension_together_load_the_left_edge_more(
    left: float, right: float, load: float, tension: float
) -> None:
    both = {"a": left, "c": right, "dQ": load, "dsigma": tension}
    assert value("hertz", "K_T_left", **both) > abs(value("hertz", "K_T_right", **both))
    against = both | {"dsigma": -tension}
    assert value("hertz", "K_T_right", **against) > abs(value("hertz", "K_T_left", **against))


@given(_edge, _edge, _load, st.floats(-10, 10))
def test_it_is_linear_in_the_loads_and_mirrors(
    left: float, right: float, load: float, tension: float
) -> None:
    place = -mpf(left) + mpf("0.3125") * (mpf(left) + right)
    whole = change(place, left, right, load, tension)
    parts = change(place, left, right, load, 0.0) + change(place, left, right, 0.0, tension)
    assert close(whole, parts, scale=1)
    assert close(whole, change(-place, right, left, load, -tension), scale=1)


@given(_edge, _edge, _load, st.floats(-10, 10))
def test_the_edges_have_one_sign_while_the_tension_is_moderate(
    left: float, right: float, load: float, tension: float
) -> None:
    """|dsigma| < 8 dQ/(pi h)."""
    limit_of = 8 * load / (mpmath.pi * (left + right))
    ends = {"a": left, "c": right, "dQ": load, "dsigma": tension}
    product = value("hertz", "K_T_left", **ends) * value("hertz", "K_T_right", **ends)
    if abs(abs(tension) - limit_of) > 1e-9:
        assert (product > 0) == (abs(tension) < limit_of)


@pytest.mark.slow
def test_it_does_not_hang_on_the_body() -> None:
    for name in BODIES:
        assert sheet(name)["full_stick_change"].expr == full_stick_change()
        for edge in Edge:
            assert sheet(name)[f"K_T_{edge.name.lower()}"].expr == K_T(edge)


def test_without_tension_it_is_a_flat_punch() -> None:
    """dQ / (pi w): smallest in the middle, 2 dQ / (pi h)."""
    middle = full_stick_change().subs({dsigma: 0, x: mid}).subs({a: A, c: B})
    assert simplify(middle - 2 * dQ / (pi * (A + B))) == 0
