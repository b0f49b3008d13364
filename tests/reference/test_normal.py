"""Contacts from the profile, the load and the moment."""

import numpy as np
import pytest

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


def test_no_load_no_contact() -> None:
    with pytest.raises(NoSolution):
        rough_edges(Body(lambda x: x**2), -1.0, 0.0)
