"""Meshes, and the displacements due to tractions on them."""

import numpy as np
import pytest
from scipy.integrate import quad

from tests.reference.kernel import FAR, Surface, ramp
from tests.reference.mesh import graded


@pytest.mark.parametrize("z", [-50.0, -FAR - 0.1, -2.0, 0.0, 0.3, 1.0, FAR - 0.1, FAR + 0.1, 100.0])
def test_displacement_by_a_ramp(z: float) -> None:
    by_hand, _ = quad(lambda u: (1 - u) * np.log(abs(z - u)), 0, 1, points=[min(max(z, 0), 1)])
    assert ramp(np.array([z]))[0] == pytest.approx(by_hand, rel=1e-13)


def test_resultants_of_a_straight_traction_are_exact() -> None:
    # int_{-1}^{2} (1 + x) dx = 9/2, int (1 + x) x dx = 9/2
    surface = Surface(graded([-1, 0.5, 2], 5))
    assert surface.force @ (1 + surface.x) == pytest.approx(4.5, rel=1e-14)
    assert surface.moment @ (1 + surface.x) == pytest.approx(4.5, rel=1e-14)


def test_displacement_by_a_half_ellipse_is_a_parabola_to_second_order() -> None:
    # PV int sqrt(1 - xi^2)/(x - xi) dxi = pi x, hence u(x) = u(0) - x^2/2
    errors = []
    for count in (16, 32, 64):
        surface = Surface(graded([-1, 0, 1], count))
        x = surface.x
        u = surface.influence @ np.sqrt(1 - x**2)
        errors.append(np.abs(u - u[count] + x**2 / 2).max())
    assert errors[-1] < 1e-3
    assert np.log2(errors[0] / errors[-1]) / 2 == pytest.approx(2, abs=0.2)
