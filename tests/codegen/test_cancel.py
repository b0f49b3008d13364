"""Which closed formulas cancel, how large their terms are, and where such bodies are cut."""

import pytest
from sympy import Abs, Expr, Max, Rational

from derive import Geometry, parameter, x
from derive.codegen.cancel import cancels, cuts_of, plain_cuts, size_of_terms
from derive.library import library, load_geometry
from derive.profile import Slope
from derive.symbols import a, c

pytestmark = pytest.mark.slow

b = parameter("b", "place", unit="m")
h_0 = parameter("h_0", "distance", unit="m")
L = parameter("L", "length", unit="m")
R = parameter("R", "radius", unit="m")


def slope(g: Expr) -> Slope:
    return Geometry("body", g=g).slope


@pytest.mark.parametrize("name", sorted(library()))
def test_no_body_of_the_library_cancels(name: str) -> None:
    """Their formulas and their speed stay what they are."""
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
    ("g", "wanted", "plain"),
    [
        (x**2 / (2 * R) + Max(0, x - b) ** 3 / L**2, ["0", "b"], (0,)),
        (x**2 / (2 * R) + Max(0, -x - b) ** 3 / L**2, ["-b", "0"], (1,)),
        (x**2 / (2 * R) + Max(0, x) ** 3 / L**2, ["0"], ()),
        (Max(0, Abs(x) - b) ** 2 / (2 * R), ["-b", "b"], ()),
        ((x - b) ** 2 / (2 * R) + x**4 / L**3 + (x + h_0) ** 6 / R**5, ["0"], ()),
    ],
    ids=["before a kink", "beyond a kink", "a kink there", "a flat there", "no kink"],
)
def test_a_body_that_is_level_at_the_origin_is_cut_there(
    g: Expr, wanted: list[str], plain: tuple[int, ...]
) -> None:
    """g' = t/R is exact there; at a distance t from b it is (b - t)/R, a small difference."""
    places, _ = cuts_of(slope(g))
    assert [str(place) for place in places] == wanted
    assert plain_cuts(slope(g)) == plain


def test_the_size_of_the_terms_of_a_cube() -> None:
    """g' = 3 (s - b)^2/L^2 beyond b: 3 s^2 + 6 b s + 3 b^2, at b = 1 and s = 2 of 27, L = 1."""
    size, farthest = size_of_terms(slope(Max(0, x - b) ** 3 / L**2))
    at = {"x": 2, "b": 1, "L": 1}
    numbers = {s: at[s.name] for s in size.free_symbols if s.name in at}
    assert size.subs(numbers).subs({a: 2, c: Rational(3, 2)}) == 27
    assert size.subs(numbers).subs({a: 2, c: Rational(1, 2)}) == 0
    assert farthest.subs({a: -2, c: 3}) == 3
    assert {s.name for s in size.free_symbols} == {"x", "b", "L", "c"}
