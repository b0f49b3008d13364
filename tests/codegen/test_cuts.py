"""Which closed formulas cancel, and where bodies are cut for quadrature."""

import pytest
from sympy import Abs, Expr, Max

from derive import Geometry, parameter, x
from derive.codegen.cuts import cancels, cuts_of
from derive.library import library, load_geometry
from derive.profile import Slope

pytestmark = pytest.mark.slow

b = parameter("b", "place", unit="m")
h_0 = parameter("h_0", "distance", unit="m")
L = parameter("L", "length", unit="m")
R = parameter("R", "radius", unit="m")


def slope(g: Expr) -> Slope:
    return Geometry("body", g=g).slope


@pytest.mark.parametrize("name", sorted(library()))
def test_no_body_of_the_library_cancels(name: str) -> None:
    assert not cancels(load_geometry(name).slope)


@pytest.mark.parametrize(
    ("g", "wanted"),
    [
        (x**4 / L**3 + x**2 / (2 * R), False),
        ((x - b) ** 2 / (2 * R), False),
        (Max(0, Abs(x) - b) ** 2 / (2 * R), False),
        ((x - b) ** 4 / L**3, True),
        (Max(0, x - b) ** 3 / L**2 + Max(0, -x) ** 2 / (2 * R), True),
    ],
)
def test_powers_about_another_place_than_the_origin_cancel(g: Expr, wanted: bool) -> None:
    assert cancels(slope(g)) is wanted


def test_a_body_is_cut_at_the_roots_of_its_curvature() -> None:
    """g'' = (x - b)^2 (x - b - h_0)^2/L^5 is zero at b and at b + h_0, g' at the origin."""
    curvature = (x - b) ** 2 * (x - b - h_0) ** 2 / L**5
    g = curvature.expand().integrate(x).integrate(x)
    places, pieces = cuts_of(slope(g))
    assert [str(place) for place in places] == ["0", "b", "b + h_0"]
    assert len(pieces) == 4


def test_a_body_is_not_cut_at_the_roots_of_a_quartic() -> None:
    """g'' = 1/R + 12 x^2/L^3 + (20/3) x^3/L^4 + 30 x^4/L^5 has no factor of lower degree; its own
    roots are no places that code could be written about, and took SymPy minutes."""
    g = x**2 / (2 * R) + x**4 / L**3 + x**5 / (3 * L**4) + x**6 / L**5
    assert [str(place) for place in cuts_of(slope(g))[0]] == ["0"]


def test_a_body_is_cut_where_its_curvature_is_least() -> None:
    """g'' = ((x - b)^2 + h_0^2)/L^3, whose roots b +- i h_0 lie beside the axis."""
    g = (((x - b) ** 2 + h_0**2) / L**3).expand().integrate(x).integrate(x)
    assert [str(place) for place in cuts_of(slope(g))[0]] == ["0", "b"]


@pytest.mark.parametrize(
    ("g", "wanted"),
    [
        (x**2 / (2 * R) + Max(0, x - b) ** 3 / L**2, ["0", "b"]),
        (x**2 / (2 * R) + Max(0, -x - b) ** 3 / L**2, ["-b", "0"]),
        (x**2 / (2 * R) + Max(0, x) ** 3 / L**2, ["0"]),
        (Max(0, Abs(x) - b) ** 2 / (2 * R), ["-b", "b"]),
        ((x - b) ** 2 / (2 * R) + x**4 / L**3 + (x + h_0) ** 6 / R**5, ["0"]),
    ],
    ids=["before a kink", "beyond a kink", "a kink there", "a flat there", "no kink"],
)
def test_a_body_that_is_level_at_the_origin_is_cut_there(g: Expr, wanted: list[str]) -> None:
    """g' = t/R is exact there; at a distance t from b it is (b - t)/R, a small difference."""
    assert [str(place) for place in cuts_of(slope(g))[0]] == wanted
