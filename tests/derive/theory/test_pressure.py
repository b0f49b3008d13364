"""p(x): against principal values, and the integral equation that it solves."""

import mpmath
import pytest
from mpmath import mpf

from tests.derive import integrals
from tests.derive.bodies import BODIES, CASES, VALUES, close, value

ALL = pytest.mark.parametrize(("name", "left", "right"), CASES)
SHARES = ("0.03125", "0.28125", "0.53125", "0.84375")
"""Places across the contact, no kink of any body among them."""


def places(left: float, right: float) -> list[mpf]:
    return [-mpf(left) + mpf(share) * (mpf(left) + right) for share in SHARES]


@ALL
def test_the_pressure_is_the_principal_value(name: str, left: float, right: float) -> None:
    body = BODIES[name]
    for place in places(left, right):
        expected = integrals.pressure(body.slope, place, left, right, body.kinks, VALUES["E_star"])
        found = value(name, "pressure", x=place, a=left, c=right)
        assert close(found, expected, digits=12)


@pytest.mark.slow
@pytest.mark.parametrize("name", BODIES)
def test_the_pressure_deforms_the_half_plane_to_the_body(name: str) -> None:
    """PV int p(s)/(x - s) ds = (pi E*/2)(g'(x) + alpha): what the pressure is there for."""
    (left, right), body = BODIES[name].contacts[0], BODIES[name]
    alpha = value(name, "tilt", a=left, c=right)

    def p(s: mpf) -> mpf:
        return value(name, "pressure", x=s, a=left, c=right)

    for place in places(left, right)[1:3]:
        found = integrals.principal_value(p, place, mpf(left), mpf(right), body.kinks)
        expected = mpmath.pi * VALUES["E_star"] / 2 * (body.slope(place) + alpha)
        assert close(found, expected, digits=9, scale=1)
