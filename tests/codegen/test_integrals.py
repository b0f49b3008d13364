"""What the docstrings of integrated bodies print, computed by mpmath, is what the sheet says by
closed formulas, which were derived another way."""

from functools import cache

import mpmath
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Integral, Max, Piecewise, S, lambdify

from derive import Geometry, parameter, x
from derive.codegen.integrals import lines_of
from derive.proof.points import Point, numeric
from derive.sheet.derivation import derive_sheet
from derive.sheet.formulas import FormulaSheet
from derive.symbols import E_star, a, c
from derive.theory.superposition import curvature, formulas, slope, xi

R = parameter("R", "radius", unit="m")
b = parameter("b", "half-width", unit="m")
phi = parameter("phi", "slope", unit="rad")

TIP_AND_CORNER = phi * Max(0, x - 2 * b) + Piecewise(
    (phi * (3 * x**2 / (4 * b) - x**4 / (8 * b**3)), Abs(x) < b),
    (phi * (Abs(x) - 3 * b / 8), True),
)
PLACES = [mpf(end) for end in ("-2.5", "-0.5", "0.3", "0.5", "1.0", "1.5")]
"""The edges, the kinks and x."""


@cache
def tip_and_corner() -> FormulaSheet:
    """The sheet of that body, derived once."""
    return derive_sheet(Geometry("body", g=TIP_AND_CORNER))


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["tilt", "load", "moment", "pressure", "K_N_left", "K_N_right", "L_N_left", "L_N_right"]
)
def test_the_printed_integrals_are_the_formulas_of_the_sheet(name: str) -> None:
    sheet = tip_and_corner()
    point: Point = {
        **{
            q.symbol: {"b": mpf("0.5"), "phi": mpf("0.125")}[q.name]
            for q in sheet.geometry.parameters
        },
        **{E_star: mpf(1), a: mpf("2.5"), c: mpf("1.5"), x: mpf("0.3")},
    }

    def value(integral: Expr) -> mpf:
        integrand = lambdify([xi, *point], integral.function, "mpmath")
        low, high = (numeric(end)(point) for end in integral.limits[0][1:])
        cuts = [place for place in PLACES if low <= place <= high]
        return mpmath.quad(lambda s: integrand(s, *point.values()), cuts)

    def curve(of: Expr) -> Expr:
        inside = Abs(of) < b
        return phi * Piecewise(
            (3 * of / (2 * b) - of**3 / (2 * b**3), inside), (of / Abs(of), True)
        )

    with mpmath.workdps(40):
        printed = formulas(sheet.frame.kinks)[name].replace(
            slope, lambda s: curve(s) + Piecewise((phi, s > 2 * b), (0, True))
        )
        straight = {-a, c}  # the flanks at both edges
        printed = printed.replace(
            curvature, lambda s: S.Zero if s in straight else curve(x).diff(x).subs(x, s)
        )
        printed = printed.replace(lambda e: isinstance(e, Integral), lambda e: value(e))
        found, wanted = numeric(sheet.frame.flat(printed))(point), numeric(sheet.flat(name))(point)
        assert abs(found - wanted) < 1e-15 * abs(wanted)


def test_the_lines_define_all_that_they_hold() -> None:
    edges = Piecewise((0, Abs(x) < b), ((Abs(x) - b) ** 3 / R**2, True))
    assert [*lines_of(derive_sheet(Geometry("body", g=edges)), ("load",))] == [
        "P = E_star*Integral(sqrt((a + xi)*(c - xi))*g''(xi), (xi, -a, c))/2",
        "g''(xi) = Piecewise((-6*(b + xi)/R**2, b < -xi), (0, b > xi), (6*(-b + xi)/R**2, True))",
    ]
    corner = [*lines_of(tip_and_corner(), ("load",))]
    assert corner[0].startswith("P = E_star*(phi*w_3 + Integral(")
    assert corner[-1] == "w_3 = sqrt(Max(0, a + 2*b)*Max(0, -2*b + c))"
