"""The program's quadrature: against integrals known by hand, and between kinks."""

from collections.abc import Callable

import mpmath
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Heaviside, Max, Min, Rational, S

from derive import Geometry, derive_sheet, parameter, prove_sheet, x
from derive.proof.points import Point, contacts, numeric
from derive.proof.quadrature import slope_as_given, value_by_quadrature
from derive.symbols import E_star, a, c
from tests.derive import integrals
from tests.derive.bodies import BODIES, CASES, VALUES, R, b, close, geometry


def contact(
    body: Geometry, left: float, right: float, place: mpf | int = 0, **given: float
) -> Callable[[str], mpf]:
    """The values by name of one contact [-a, c] of one body, the pressure at a place x."""
    values = VALUES | given
    point: Point = {q.symbol: mpf(values[q.name]) for q in body.parameters}
    point |= {a: mpf(left), c: mpf(right), E_star: mpf(values["E_star"]), x: mpf(place)}
    return lambda name: numeric(value_by_quadrature(body.g, name))(point)


@pytest.mark.parametrize(("left", "right"), [(2.0, 1.0), (-1.0, 3.0), (3.0, -1.0)])
def test_a_cylinder_by_hand(left: float, right: float) -> None:
    """alpha = (a - c)/2R, P = pi E* h^2/16R, M = -P mid, p = E* w/2R."""
    place = mpf(right - left) / 2 + mpf("0.25")
    here = contact(geometry("hertz"), left, right, place)
    E, radius, width = mpf(VALUES["E_star"]), mpf(VALUES["R"]), mpf(left) + right
    load = mpmath.pi * E * width**2 / (16 * radius)
    assert close(here("tilt"), (mpf(left) - right) / (2 * radius), scale=1)
    assert close(here("load"), load)
    assert close(here("moment"), load * (mpf(left) - right) / 2, scale=load)
    expected = E * mpmath.sqrt((left + place) * (right - place)) / (2 * radius)
    assert close(here("pressure"), expected)
    for side in ("left", "right"):  # sqrt(h - s) = sqrt(h) (1 - s/2h + ...)
        assert close(here(f"K_N_{side}"), E * mpmath.sqrt(width) / (2 * radius))
        assert close(here(f"L_N_{side}"), -E / (4 * radius * mpmath.sqrt(width)))


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_edges_of_a_quartic_by_hand(side: str) -> None:
    """p = (E*/4 b**3) (a**2 + 2 x**2) sqrt(a**2 - x**2) for a = c and g = x**4/(4 b**3).

    With x = a - s it is (E*/4 b**3) sqrt(2 a s) (1 - s/4a) (3 a**2 - 4 a s), up to s**2.
    """
    here, half = contact(Geometry("quartic", x**4 / (4 * b**3)), 2.0, 2.0, b=1.5), mpf(2)
    factor = mpf(VALUES["E_star"]) / (4 * mpf(1.5) ** 3) * mpmath.sqrt(2 * half)
    assert close(here(f"K_N_{side}"), 3 * factor * half**2)
    assert close(here(f"L_N_{side}"), -(4 + mpf(3) / 4) * factor * half)


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_edges_of_a_wedge_by_hand(side: str) -> None:
    """p = (2 E* phi/pi) asinh(z), z**2 = s/(2 (a - s)), close to the edge of a = c.

    asinh(z) = z - z**3/6 + ... and z = sqrt(s/2a) (1 + s/2a + ...), so that
    K_N = 2 E* phi/(pi sqrt(2 a)) and L_N = K_N (1/2a - 1/12a).
    """
    here, half = contact(geometry("wedge"), 2.0, 2.0), mpf(2)
    K_N = 2 * mpf(VALUES["E_star"]) * mpf(VALUES["phi"]) / (mpmath.pi * mpmath.sqrt(2 * half))
    assert close(here(f"K_N_{side}"), K_N)
    assert close(here(f"L_N_{side}"), K_N * 5 / (12 * half))


@pytest.mark.parametrize(("name", "left", "right"), CASES)
def test_it_takes_the_slope_from_g_as_written_and_agrees_with_another_quadrature(
    name: str, left: float, right: float
) -> None:
    here, body = contact(geometry(name), left, right), BODIES[name]
    numbers = {q.symbol: mpf(VALUES[q.name]) for q in geometry(name).parameters}
    for share in ("0.0625", "0.3125", "0.6875", "0.9375"):
        place = -mpf(left) + mpf(share) * (left + right)
        slope = numeric(slope_as_given(geometry(name).g))({**numbers, x: place})
        assert close(slope, mpf(body.slope(place)), scale=1)
    over, E = (body.slope, left, right, body.kinks), VALUES["E_star"]
    assert close(here("tilt"), integrals.tilt(*over), scale=1)
    assert close(here("load"), integrals.load(*over, E))
    assert close(here("moment"), integrals.moment(*over, E), scale=here("load"))


@pytest.mark.parametrize("ramp", [(x + Abs(x)) / 2, x - Min(0, x), Max(0, x), x * Heaviside(x)])
@pytest.mark.parametrize("power", [S(3), Rational(5, 2)])
def test_powers_of_a_ramp(ramp: Expr, power: Expr) -> None:
    """x**2 + ramp**n on [-1, 1]: alpha = -(n/pi) int_0^1 s**(n - 1)/sqrt(1 - s**2) ds."""
    body = Geometry("ramp", x**2 / b + ramp**power / b ** (power - 1))
    n, one = mpf(power.p) / power.q, mpf(1)
    here = contact(body, 1, 1, b=1)
    assert close(here("tilt"), -n * mpmath.beta(n / 2, one / 2) / (2 * mpmath.pi))


def test_a_power_beyond_a_kink_is_proven_for_contacts_on_both_sides_of_it() -> None:
    k, ramp = parameter("k", "exponent", unit="-"), (x / b - 1) * Heaviside(x - b)
    sheet = prove_sheet(derive_sheet(Geometry("ramp", b * ramp**k + x**2 / (2 * R))))
    (kink,) = sheet.geometry.slope.kinks
    assert {point[c] > point[kink.position] for point in contacts(sheet)} == {True, False}
    proofs = (sheet[name].proof for name in ("pressure", "K_N_right", "L_N_right"))
    assert all(proof is not None and proof.holds for proof in proofs)
