"""What the docstrings of integrated bodies print, taken by its word: mpmath computes it, to 20
digits and more, and it is what the sheet says by formulas that were derived from g' another way."""

from collections.abc import Callable
from functools import cache
from itertools import pairwise

import mpmath
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Function, Integral, Max, Piecewise, cosh, lambdify

from derive import Geometry, parameter, x
from derive.body.profile import Slope
from derive.codegen.contract import CONTRACT
from derive.codegen.integrals import (
    FinitePart,
    curvature,
    definitions_of,
    formula_of,
    lines_of,
)
from derive.codegen.plan import Route, route_of
from derive.proof.points import Point, numeric
from derive.sheet.derivation import derive_sheet
from derive.sheet.formulas import FormulaSheet
from derive.symbols import E_star, P, a, c
from derive.theory.superposition import xi

R = parameter("R", "radius", unit="m")
b = parameter("b", "half-width", unit="m")
phi = parameter("phi", "slope", unit="rad")

BODIES: dict[str, Expr] = {
    "cubic edges": Piecewise((0, Abs(x) < b), ((Abs(x) - b) ** 3 / R**2, True)),
    "a smooth tip and a corner": phi * Max(0, x - 2 * b)
    + Piecewise(
        (phi * (3 * x**2 / (4 * b) - x**4 / (8 * b**3)), Abs(x) < b),
        (phi * (Abs(x) - 3 * b / 8), True),
    ),
    "catenary": b**2 / R * (cosh(x / b) - 1),
}


@cache
def sheet_of(name: str) -> FormulaSheet:
    return derive_sheet(Geometry("body", g=BODIES[name]).described("A body."))


PLACES = (
    ("cubic edges", (-0.25, 2.0, 0.75)),
    ("a smooth tip and a corner", (2.5, 1.5, 0.3)),
    ("catenary", (2.5, 1.5, 0.3)),
)
"""A body with a, c and x; b = 0.5 and R = 1.5.  The first one prints L_N alone in this way."""

NAMES = ("tilt", "load", "moment", "pressure")
AT_EDGES = ("K_N_left", "K_N_right", "L_N_left", "L_N_right")


def written_out(expr: Expr, definitions: dict[Expr, Expr]) -> Expr:
    """An expression without the functions that are defined beside it."""
    for called, definition in definitions.items():
        expr = expr.replace(
            called.func,
            lambda *given, d=definition, of=called.args: d.subs(dict(zip(of, given, strict=True))),
        )
    return expr


def computed(printed: Expr, body: Slope, point: Point) -> mpf:
    """A printed formula in numbers, its integrals by quadrature."""
    known: dict[Expr, mpf] = {}
    for node in printed.atoms(Integral, FinitePart):
        if not isinstance(node, FinitePart):
            known[node] = _integral(_along(node.function, body, point), point, body)
    for node in printed.atoms(FinitePart):
        known[node] = _finite_part(node.args[0].function, body, point)
    held = sorted(known, key=lambda node: isinstance(node, Integral))
    names = {node: Function(f"value_{i}")() for i, node in enumerate(held)}
    rest = written_out(printed.subs([(node, names[node]) for node in held]), definitions_of(body))
    numbers = {str(name.func): lambda v=known[node]: v for node, name in names.items()}
    symbols = [*point]
    return lambdify(symbols, rest, [numbers, "mpmath"])(*(point[s] for s in symbols))


def _along(integrand: Expr, body: Slope, point: Point) -> Callable[[mpf], mpf]:
    whole = written_out(integrand, definitions_of(body))
    symbols = [*point]
    function = lambdify([xi, *symbols], whole, "mpmath")
    return lambda s: function(s, *(point[symbol] for symbol in symbols))


def _integral(f: Callable[[mpf], mpf], point: Point, body: Slope, d: mpf | int = 0) -> mpf:
    """From edge to edge, or from d beside the left one to d beside the right one."""
    low, high = -point[a], point[c]
    inner = [numeric(kink.position)(point) for kink in body.kinks]
    inner += [point[x], *(end for k in range(90) for end in _beside(low, high, d * 2**k) if d)]
    cuts = sorted({low + d, high - d, *(s for s in inner if low + d < s < high - d)})
    return sum(mpmath.quad(f, ends, method="tanh-sinh") for ends in pairwise(cuts))


def _beside(low: mpf, high: mpf, d: mpf) -> tuple[mpf, mpf]:
    return (low + d, high - d) if d < (high - low) / 4 else (low, high)


def _finite_part(integrand: Expr, body: Slope, point: Point) -> mpf:
    """Close to its edge it is 2 g'' (h/s)**(3/2): without 4 g'' h**(3/2)/sqrt(d)."""
    f, d = _along(integrand, body, point), mpf(10) ** -22
    h, side = point[a] + point[c], "left" if "r_left" in str(integrand) else "right"
    edge = -point[a] if side == "left" else point[c]
    return _integral(f, point, body, d) - 4 * _along(curvature(xi), body, point)(edge) * h ** mpf(
        1.5
    ) / mpmath.sqrt(d)


@pytest.mark.slow
@pytest.mark.enough("cubic*")
@pytest.mark.parametrize(("name", "given"), PLACES, ids=str)
def test_the_printed_integrals_are_the_formulas_of_the_sheet(
    name: str, given: tuple[float, float, float]
) -> None:
    sheet = sheet_of(name)
    (second,) = (function for function in CONTRACT if function.name == "L_N")
    assert route_of(sheet, second) is Route.QUADRATURE
    body = sheet.geometry.slope
    with mpmath.workdps(60):  # differences at the edges lose half of them
        own = {"R": mpf(1.5), "b": mpf(0.5), "phi": mpf(0.125)}
        point: Point = {q.symbol: own[q.name] for q in sheet.geometry.parameters}
        point |= {E_star: mpf(1), **dict(zip((a, c, x), map(mpf, given), strict=True))}
        point[P] = numeric(sheet.flat("load"))(point)
        for formula in (*NAMES, *AT_EDGES):
            found = computed(formula_of(body, formula), body, point)
            wanted = numeric(sheet.flat(formula))(point)
            allowed = 1e-9 if formula.startswith("L_N") else 1e-25
            assert abs(found - wanted) <= allowed * (abs(wanted) + point[P] / 100), formula


def test_the_lines_define_all_that_they_hold() -> None:
    assert [*lines_of(sheet_of("cubic edges"), ("load",))] == [
        "P = E_star*Integral(g''(xi)*w(xi), (xi, -a, c))/2",
        "w(xi) = sqrt((a + xi)*(c - xi))",
        "g''(xi) = Piecewise((-6*(b + xi)/R**2, b < -xi), (0, b > xi), (6*(-b + xi)/R**2, True))",
    ]


def test_a_parameter_may_have_the_name_of_the_theory_s_root() -> None:
    w = parameter("w", "half-width", unit="m")
    sheet = derive_sheet(Geometry("valley", g=w * (cosh(x / w) - 1)))
    assert list(lines_of(sheet, ("load",))) == [
        "P = E_star*Integral(g''(xi)*w_(xi), (xi, -a, c))/2",
        "w_(xi) = sqrt((a + xi)*(c - xi))",
        "g''(xi) = cosh(xi/w)/w",
    ]
