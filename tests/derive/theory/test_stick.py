"""Full stick: the two conditions it must meet, its edges, and the sense of its signs."""

import mpmath
import pytest
from mpmath import mpf
from sympy import sqrt

from derive.symbols import a, c, dQ, dsigma, h
from derive.theory.edges import Edge
from derive.theory.stick import K_T
from tests.derive.bodies import close, value
from tests.derive.integrals import over_contact, root

CONTACTS = [(2.0, 1.0), (0.75, 3.0), (-1.0, 2.5), (1.5, 1.5)]
LOADS = [(0.5, 0.0), (0.0, 0.75), (0.5, -1.25)]


def change(place: mpf, left: float, right: float, load: float, tension: float) -> mpf:
    return value("hertz", "full_stick_change", x=place, a=left, c=right, dQ=load, dsigma=tension)


@pytest.mark.parametrize(("left", "right"), CONTACTS)
@pytest.mark.parametrize(("load", "tension"), LOADS)
def test_its_force_and_its_strain_are_the_changes_of_the_loads(
    left: float, right: float, load: float, tension: float
) -> None:
    """int dq ds = dQ; (1/pi) PV int dq(s)/(x - s) ds = dsigma/4, as PV int ds/(w (x - s)) = 0."""

    def numerator(t: mpf) -> mpf:
        return change(t, left, right, load, tension) * root(t, mpf(left), mpf(right))

    assert close(over_contact(numerator, left, right), mpf(load), scale=1)
    for share in ("0.1875", "0.59375", "0.84375"):
        place = -mpf(left) + mpf(share) * (mpf(left) + right)
        here = numerator(place)
        regular = over_contact(
            lambda t, here=here, place=place: (numerator(t) - here) / (place - t),
            *(left, right, (place,)),
        )
        assert close(regular / mpmath.pi, mpf(tension) / 4, digits=15, scale=1)


def test_K_T_by_hand() -> None:
    """x - mid = -h/2 at the left edge and +h/2 at the right one, the other root is sqrt(h)."""
    for edge, sense in ((Edge.LEFT, 1), (Edge.RIGHT, -1)):
        expected = (dQ / mpmath.pi + sense * dsigma * h / 8) / sqrt(h)
        assert abs((K_T(edge) - expected).subs({a: 2, c: 1, dQ: 3, dsigma: 5}).evalf()) < 1e-14
