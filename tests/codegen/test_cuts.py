"""Which closed formulas cancel, and where bodies are cut for quadrature."""

import pytest
from sympy import Abs, Expr, Max

from derive import Geometry, parameter, x
from derive.body.profile import Slope
from derive.codegen.cuts import cancels, cuts_of
from tests.derive.bodies import L, R, b

pytestmark = pytest.mark.slow

h_0 = parameter("h_0", "distance", unit="m")


def slope(g: Expr) -> Slope:
    return Geometry("body", g=g).slope


@pytest.mark.parametrize(
    ("g", "wanted"),
    [
        (x**4 / L**3 + x**2 / (2 * R), False),
        ((x - b) ** 2 / (2 * R), False),
        (Max(0, Abs(x) - b) ** 2 / (2 * R), False),
        ((x - b) ** 4 / L**3, True),
        (Max(0, x - b) ** 3 / L**2 + Max(0, -x) ** 2 / (2 * R), True),
        (x**2 / (2 * R) + Max(0, x - b) ** 4 / L**3, True),
        (R * Abs(x / b) + Max(0, -x - b) ** 3 / L**2, True),
    ],
)
def test_powers_about_another_place_than_the_origin_cancel(g: Expr, wanted: bool) -> None:
    assert cancels(slope(g)) is wanted


def twice(curvature: Expr) -> Expr:
    return curvature.expand().integrate(x).integrate(x)


@pytest.mark.parametrize(
    ("g", "wanted"),
    [
        # at the roots of g'', and at the origin, where g' is zero
        (twice((x - b) ** 2 * (x - b - h_0) ** 2 / L**5), ["0", "b", "b + h_0"]),
        # g'' = 1/R + 12 x^2/L^3 + (20/3) x^3/L^4 + 30 x^4/L^5 has no factor of lower degree; its
        # own roots are no places that code could be written about, and took SymPy minutes
        (x**2 / (2 * R) + x**4 / L**3 + x**5 / (3 * L**4) + x**6 / L**5, ["0"]),
        # where g'' is least: its roots b +- i h_0 lie beside the axis
        (twice(((x - b) ** 2 + h_0**2) / L**3), ["0", "b"]),
        # at a level origin: g' = t/R is exact there; at t from b it is (b - t)/R, a difference
        (x**2 / (2 * R) + Max(0, x - b) ** 3 / L**2, ["0", "b"]),  # before a kink
        (x**2 / (2 * R) + Max(0, -x - b) ** 3 / L**2, ["-b", "0"]),  # beyond a kink
        (x**2 / (2 * R) + Max(0, x) ** 3 / L**2, ["0"]),  # a kink there
        (Max(0, Abs(x) - b) ** 2 / (2 * R), ["-b", "b"]),  # a flat there
        ((x - b) ** 2 / (2 * R) + x**4 / L**3 + (x + h_0) ** 6 / R**5, ["0"]),  # no kink
    ],
    ids=str,
)
def test_where_a_body_is_cut(g: Expr, wanted: list[str]) -> None:
    places, pieces = cuts_of(slope(g))
    assert [str(place) for place in places] == wanted
    assert len(pieces) == len(places) + 1
