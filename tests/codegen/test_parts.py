"""Functions that are sums over the parts of a contact: their text, and the digits that it keeps."""

from collections.abc import Callable
from functools import cache
from random import Random
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Max

from derive import Geometry, parameter
from derive.codegen.parts import common_steps, definitions_text, parts_programs
from derive.codegen.plan import Route, carried_by
from derive.codegen.printer import NumPyPrinter
from derive.proof.points import Point, holds, numeric
from derive.sheet.derivation import derive_sheet
from derive.sheet.formulas import FormulaSheet
from derive.sheet.notation import text_of
from derive.symbols import E_star, a, c, x
from generated.runtime import elementary, kernels, segments
from tests.derive.bodies import of_library as sheet_of

BODIES = ("flat_rounded", "rounded_wedge", "two_radii", "wedge_parabola", "flat_sloped")
R = parameter("R", "length", unit="m")
L = parameter("L", "length of the steeper curve", unit="m")
b = parameter("b", "place of the kink", unit="m")
phi = parameter("phi", "slope", unit="rad")

FORMULAS = {name: (name,) for name in ("tilt", "load", "moment", "pressure")}
FORMULAS |= {name: (f"{name}_left", f"{name}_right") for name in ("K_N", "L_N")}
"""Formulas of the functions that are sums over parts."""


@cache
def function_of(body: str, name: str) -> Callable[..., Any]:
    """The program as NumPy; each begins with the common steps."""
    sheet, printer = sheet_of(body), NumPyPrinter()
    program, common = parts_programs(sheet)[name], common_steps(sheet)
    assert program.steps[: len(common)] == common
    given = ["x", "a", "c", "E_star", *(q.name for q in sheet.geometry.parameters)]
    outputs = ", ".join(map(printer.doprint, program.outputs.values()))
    lines = [f"{step.symbol} = {printer.doprint(step.expr)}" for step in program.steps]
    text = "\n    ".join([f"def made({', '.join(given)}):", *lines, f"return ({outputs},)"])
    held: dict[str, Any] = {"np": np, "where": kernels.where, **vars(elementary), **vars(segments)}
    exec(text, held)  # noqa: S102
    made: Callable[..., Any] = held["made"]
    return made


@cache
def derived(body: str, name: str) -> Expr:
    return sheet_of(body).flat(name)


def contacts(sheet: FormulaSheet, count: int = 8) -> list[Point]:
    """Contacts with edges, and places in them, by 1e-9 of their width and more beside kinks."""
    rng, found = Random(sheet.geometry.name), []
    while len(found) < count:
        h = 10 ** rng.uniform(-1, 1)
        point = {q.symbol: mpf(rng.uniform(0.2, 3)) for q in sheet.geometry.parameters}
        point |= {s: mpf(h * 10 ** rng.uniform(-6, 3)) for s in point if str(s) == "b"}
        places = [float(numeric(kink.position)(point)) for kink in sheet.geometry.slope.kinks]

        def beside(size: float, of: list[float] = places) -> float:
            return rng.choice(of) + rng.choice([-1, 1]) * size * 10 ** rng.uniform(-9, -1)

        left = rng.choice([beside(h), beside(h) - h, rng.choice(places) - h * rng.random()])
        point |= {E_star: mpf(1), a: mpf(-left), c: mpf(left + h)}
        point[x] = mpf(rng.choice([beside(h), left + h * rng.random()]))
        edges = [-point[a], point[c]]
        if not edges[0] < point[x] < edges[1]:
            continue
        gaps = [abs(edge - place) for edge in (*edges, point[x]) for place in places]
        gaps += [abs(point[x] - edge) for edge in edges]
        if min(gaps) > 0.9e-9 * h and holds(sheet["pressure"].conditions, point):
            found.append(point)
    return found


@pytest.mark.enough("wedge_parabola", "rounded_wedge")
@pytest.mark.parametrize("name", BODIES)
def test_digits_are_kept_beside_kinks(name: str) -> None:
    sheet = sheet_of(name)
    points = contacts(sheet)
    order = [x, a, c, E_star, *(q.symbol for q in sheet.geometry.parameters)]
    for called, formulas in FORMULAS.items():
        made = function_of(name, called)
        for point in points:
            with np.errstate(all="ignore"):
                found = made(*(float(point[symbol]) for symbol in order))
            for value, formula in zip(found, formulas, strict=True):
                with mpmath.workdps(100):
                    true = numeric(derived(name, formula))(point)
                    scale = abs(true)
                    if formula in ("tilt", "moment"):  # by symmetry these may vanish
                        scale += 1e-3 * abs(numeric(derived(name, "load"))(point))
                    assert abs(mpf(float(value)) - true) <= 2e-13 * scale, (formula, point)


def test_what_is_printed_is_what_runs() -> None:
    sheet = sheet_of("flat_rounded")
    program = parts_programs(sheet)["load"]
    (load,) = program.outputs.values()
    assert text_of(load) == "E_star*h**2*(segment(t_1) + segment(t_3))/(16*R)"
    assert NumPyPrinter().doprint(load).replace(" ", "") == text_of(load).replace(" ", "")
    assert program.steps == common_steps(sheet)
    assert [*definitions_text(sheet)][:5] == [
        "h = a + c",
        "t_1 = edge_angle(a - b, b + c)",
        "t_3 = edge_angle(-b + c, a + b)",
        "edge_angle(A, B) = 2*atan2(sqrt(Max(0, A)), sqrt(Max(0, B)))",
        "segment(t) = t - sin(t)*cos(t)",
    ]


@pytest.mark.enough("phi*", "(-b*")
@pytest.mark.parametrize(
    "g",
    [
        x**2 / (2 * R) + Max(0, x - b) ** 4 / L**3,
        phi * Abs(x) + Max(0, -x - b) ** 3 / L**2,
        (x - b) ** 4 / L**3,
    ],
    ids=str,
)
def test_a_curve_of_higher_degree_is_integrated(g: Expr) -> None:
    sheet = derive_sheet(Geometry("body", g=g).described("A body."))
    assert carried_by(sheet) is Route.QUADRATURE


def test_nothing_presses_beyond_the_edges() -> None:
    count = len(sheet_of("rounded_wedge").geometry.parameters)
    with np.errstate(all="ignore"):
        (p,) = function_of("rounded_wedge", "pressure")(
            np.array([-4.0, -3.0, 2.0, 5.0]), 3.0, 2.0, 1.0, *[1.0] * count
        )
    np.testing.assert_array_equal(p, 0.0)
