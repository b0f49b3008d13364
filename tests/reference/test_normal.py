"""Contacts from the profile, the load and the moment."""

import numpy as np
import pytest
from scipy.integrate import quad

from tests.reference.bounded import NoSolution
from tests.reference.conditions import wedge
from tests.reference.kernel import Surface
from tests.reference.mesh import Floats, graded
from tests.reference.normal import Body, Contact, press, rough_edges


def pressed(body: Body, P: float, M: float, count: int) -> tuple[Floats, Contact]:
    """The contact on a mesh that has been refined towards the edges several times."""
    left, right = rough_edges(body, P, M)
    for _ in range(5):
        margin = (right - left) / 20
        inner = [k for k in body.kinks if left < k < right]
        x = graded([left - margin, left, *inner, right, right + margin], count)
        contact = press(body, Surface(x), P, M)
        left, right = contact.left, contact.right
    return x, contact


@pytest.mark.parametrize("M", [0.0, 0.1, -0.3])
def test_hertz_to_second_order(M: float) -> None:
    # half-width b under P = pi E* b^2/(4 R), middle at -M/P
    R, E_star, b = 2.0, 3.0, 1.5
    P = np.pi * E_star * b**2 / (4 * R)
    errors = []
    for count in (16, 32, 64):
        x, contact = pressed(Body(lambda x: x**2 / (2 * R), E_star), P, M, count)
        exact = E_star / (2 * R) * np.sqrt(np.maximum(b**2 - (x + M / P) ** 2, 0))
        inner = np.abs(x + M / P) < 0.9 * b
        errors.append(
            max(
                abs(contact.left + M / P + b),
                abs(contact.right + M / P - b),
                np.abs(contact.p - exact)[inner].max(),
                abs(contact.alpha - M / (P * R)),
            )
        )
    assert errors[-1] < 2e-3
    assert np.log2(errors[0] / errors[-1]) / 2 > 1.7


@pytest.mark.parametrize("M", [0.0, 0.15, -0.4])
def test_tilted_wedge(M: float) -> None:
    exact = wedge(1.0, M)
    x, contact = pressed(Body(np.abs, kinks=(0.0,)), 1.0, M, 48)
    assert contact.left == pytest.approx(-exact.a, abs=5e-4)
    assert contact.right == pytest.approx(exact.c, abs=5e-4)
    # alpha = 1 - (2/pi) arccos((a - c)/(a + c)), from int (g' + alpha)/w dx = 0
    lean = 1 - 2 / np.pi * np.arccos((exact.a - exact.c) / (exact.a + exact.c))
    assert contact.alpha == pytest.approx(lean, abs=2e-4)
    inner = (x > -0.9 * exact.a) & (x < 0.9 * exact.c) & (np.abs(x) > 0.2)
    np.testing.assert_allclose(contact.p[inner], exact.p(x[inner]), rtol=2e-3)


def test_unsymmetric_body() -> None:
    # radius 1 on the left and 3 on the right: g'' jumps at 0
    def g(x: Floats) -> Floats:
        return x**2 / np.where(x < 0, 2, 6)

    def slope(x: float) -> float:
        return x if x < 0 else x / 3

    P, M = 1.3, 0.2
    _, contact = pressed(Body(g, 2.0, kinks=(0.0,)), P, M, 48)
    a, c = -contact.left, contact.right
    middle, half = (c - a) / 2, (c + a) / 2

    def moment(k: int) -> float:
        """int s^k (g' + alpha)/w ds, with s = mid + (h/2) cos(t)."""

        def integrand(t: float) -> float:
            s = middle + half * np.cos(t)
            return s**k * (slope(s) + contact.alpha)

        return quad(integrand, 0, np.pi, points=[np.arccos(-middle / half)])[0]

    # I_0 = 0, P = (E*/2) I_1, -M = (E*/2) (I_2 - mid I_1) with E* = 2
    assert moment(0) == pytest.approx(0, abs=3e-4)
    assert moment(1) == pytest.approx(P, rel=1e-3)
    assert moment(2) - middle * moment(1) == pytest.approx(-M, abs=1e-3)


def test_no_load_no_contact() -> None:
    with pytest.raises(NoSolution):
        rough_edges(Body(lambda x: x**2), -1.0, 0.0)
