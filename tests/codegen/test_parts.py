"""Functions that are sums over the parts of a contact: their text, and the digits that it keeps."""

from collections.abc import Callable
from functools import cache
from random import Random
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Max, Piecewise

from derive import Geometry, parameter
from derive.codegen.parts import common_steps, definitions_text, parts_program
from derive.codegen.plan import Route, carried_by
from derive.codegen.printer import NumPyPrinter
from derive.derivation import derive_sheet
from derive.errors import NotProven
from derive.library import load_geometry
from derive.notation import text_of
from derive.proof.points import Point, holds, numeric
from derive.runtime import elementary, segments
from derive.sheet import FormulaSheet
from derive.symbols import E_star, a, c, x
from derive.theory.edges import Edge, pressure_series
from derive.theory.segments import Parts
from tests.derive import integrals

BODIES = ("flat_rounded", "rounded_wedge", "two_radii", "wedge_parabola", "flat_sloped")
R = parameter("R", "length", unit="m")
L = parameter("L", "length of the steeper curve", unit="m")
b = parameter("b", "place of the kink", unit="m")
phi = parameter("phi", "slope", unit="rad")

GROWN = {
    "parabola_then_quartic": x**2 / (2 * R) + Max(0, x - b) ** 4 / L**3,
    "corner_and_powers": phi * Abs(x) + Max(0, -x - b) ** 3 / L**2 + Max(0, -x - b) ** 4 / R**3,
    "cubic_between_kinks": Piecewise(
        (x**2 / (2 * R), x < 0),
        (0, x < b),
        ((x - b) ** 3 / L**2, x < 2 * b),
        (b**2 * (3 * x - 5 * b) / L**2, True),
    ),
}
"""Bodies whose g'' is no constant on each piece: it grows from a kink on."""

FIELDS: tuple[tuple[str, ...], ...] = (
    *(("tilt",), ("load",), ("moment",), ("pressure",)),
    *((f"{name}_left", f"{name}_right") for name in ("K_N", "L_N", "third")),
)
"""Formulas of the functions that are sums over parts, one or two of each."""


def named(formulas: tuple[str, ...]) -> dict[str, str]:
    """The fields of a function with their formulas."""
    return dict(zip(("left", "right") if formulas[1:] else ("",), formulas, strict=True))


def fields_of(name: str) -> list[tuple[str, ...]]:
    series = Parts(sheet_of(name).frame).has_series
    return [*FIELDS] if series else [*FIELDS[:5]]


@cache
def sheet_of(name: str) -> FormulaSheet:
    if name in GROWN:
        return derive_sheet(Geometry(name, g=GROWN[name]).described("A body."))
    return derive_sheet(load_geometry(name))


@cache
def function_of(name: str, formulas: tuple[str, ...]) -> Callable[..., Any]:
    """The program as NumPy; each begins with the common steps."""
    sheet, printer = sheet_of(name), NumPyPrinter()
    program, common = parts_program(sheet, named(formulas)), common_steps(sheet)
    assert program.steps[: len(common)] == common
    given = ["x", "a", "c", "E_star", *(q.name for q in sheet.geometry.parameters)]
    outputs = ", ".join(map(printer.doprint, program.outputs.values()))
    lines = [f"{step.symbol} = {printer.doprint(step.expr)}" for step in program.steps]
    text = "\n    ".join([f"def made({', '.join(given)}):", *lines, f"return ({outputs},)"])
    held: dict[str, Any] = {"np": np} | vars(elementary) | vars(segments)
    exec(text, held)  # noqa: S102
    made: Callable[..., Any] = held["made"]
    return made


@cache
def derived(body: str, name: str) -> Expr:
    sheet = sheet_of(body)
    if not name.startswith("third_"):
        return sheet.flat(name)
    edge = Edge[name.removeprefix("third_").upper()]
    return sheet.frame.flat(pressure_series(sheet.frame, edge, 3)[2])


def contacts(sheet: FormulaSheet, count: int = 12) -> list[Point]:
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


@pytest.mark.parametrize("name", [*BODIES, *GROWN])
def test_digits_are_kept_beside_kinks(name: str) -> None:
    sheet = sheet_of(name)
    points = contacts(sheet)
    order = [x, a, c, E_star, *(q.symbol for q in sheet.geometry.parameters)]
    for formulas in fields_of(name):
        made = function_of(name, formulas)
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


def _grown(s: mpf, power: int) -> mpf:
    """Beyond zero alone."""
    return s**power if s > 0 else mpf(0)


SLOPES: dict[str, Callable[[mpf], mpf]] = {
    "parabola_then_quartic": lambda s: s / mpf(1.5) + 4 * _grown(s - B, 3) / 8,
    "corner_and_powers": lambda s: (
        (mpf(0.125) if s > 0 else mpf(-0.125))
        - 3 * _grown(-s - B, 2) / 4
        - 4 * _grown(-s - B, 3) / mpf(1.5) ** 3
    ),
    "cubic_between_kinks": lambda s: (
        min(s, mpf(0)) / mpf(1.5)
        + 3 * (_grown(s - B, 2) - _grown(s - 2 * B, 2)) / 4
        - 6 * B * _grown(s - 2 * B, 1) / 4
    ),
}
"""g' by hand for b = 0.5, R = 1.5, L = 2, phi = 0.125.  The last: beyond 2 b, with s - b = b + v,
3 ((b + v)**2 - v**2 - 2 b v) is 3 b**2, a straight line."""

B = mpf(0.5)
BESIDE = 2.0**-30
"""Nearly 1e-9."""

BOTH_SIDES = [(0.5 + 2 * BESIDE, 1.5), (1.5, 0.5 - BESIDE)]
RIGHT, LEFT = [(-0.5 - BESIDE, 2.0)], [(2.0, -0.5 - BESIDE)]
CONTACTS = {
    "parabola_then_quartic": [*BOTH_SIDES, *RIGHT, *LEFT],
    "corner_and_powers": [*BOTH_SIDES, *LEFT],
    "cubic_between_kinks": [*BOTH_SIDES, (0.25, 1 + BESIDE), (-0.75, 1.5)],
}


@pytest.mark.parametrize("name", GROWN)
def test_they_are_the_integrals_of_the_definition(name: str) -> None:
    """Load, moment, tilt, pressure and K_N by quadrature of g' to 30 digits."""
    slope, own = SLOPES[name], {"R": 1.5, "b": 0.5, "L": 2.0, "phi": 0.125}
    given = [own[q.name] for q in sheet_of(name).geometry.parameters]
    kinks = [mpf(k) for k in (-0.5, 0.0, 0.5, 1.0)]

    def around(place: mpf | float) -> list[mpf]:
        """Cuts at the kinks, and ever closer to a place that may lie beside one of them."""
        return [*kinks, *(mpf(place) + side * mpf(8) ** -k for k in range(12) for side in (1, -1))]

    with mpmath.workdps(30):
        for left, right in CONTACTS[name]:
            ends, h = (mpf(left), mpf(right)), mpf(left) + mpf(right)
            load = integrals.load(slope, *ends, kinks, mpf(1))
            known = {
                "tilt": (integrals.tilt(slope, *ends, kinks), mpf(1)),
                "load": (load, load),
                "moment": (integrals.moment(slope, *ends, kinks, mpf(1)), load * h),
            }
            for side, edge in (("left", -ends[0]), ("right", ends[1])):
                rises = integrals.over_contact(
                    lambda s, e=edge: (slope(s) - slope(e)) / (s - e), *ends, around(edge)
                )
                K = mpmath.sqrt(h) * rises / (2 * mpmath.pi)
                known[f"K_N_{side}"] = (K, K)
            for formulas in (of for of in fields_of(name) if {*of} <= {*known}):
                found = function_of(name, formulas)(0.0, left, right, 1.0, *given)
                for value, (true, scale) in zip(found, map(known.get, formulas), strict=True):
                    assert abs(mpf(float(value)) - true) <= 1e-13 * (abs(true) + scale), formulas
            places = [-left + 1e-6 * (left + right), 0.125, *(float(k) + 2e-9 for k in kinks)]
            for place in (p for p in places if -left < p < right):
                true = integrals.pressure(slope, mpf(place), *ends, around(place), mpf(1))
                (value,) = function_of(name, ("pressure",))(place, left, right, 1.0, *given)
                assert abs(mpf(float(value)) - true) <= 1e-12 * true, (left, right, place)


def test_what_is_printed_is_what_runs() -> None:
    sheet = sheet_of("flat_rounded")
    program = parts_program(sheet, {"": "load"})
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


def test_a_sum_that_is_not_the_sheet_s_formula_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Parts, "load", property(lambda parts: 2 * E_star * (a + c)))
    with pytest.raises(NotProven, match="part by part"):
        parts_program(sheet_of("two_radii"), {"": "load"})


@pytest.mark.parametrize(
    "g",
    [
        Piecewise(
            (phi * (3 * x**2 / (4 * b) - x**4 / (8 * b**3)), Abs(x) < b),
            (phi * (Abs(x) - 3 * b / 8), True),
        ),
        x**2 / (2 * R) + Max(0, x - b) ** 11 / L**10,
        (x - b) ** 4 / L**3,
    ],
    ids=["falls from its middle on", "too steep", "no kink"],
)
def test_what_does_not_grow_from_a_kink_on_is_integrated(g: Expr) -> None:
    sheet = derive_sheet(Geometry("body", g=g).described("A body."))
    assert carried_by(sheet) is Route.QUADRATURE
    assert carried_by(sheet_of("corner_and_powers")) is Route.PARTS


@pytest.mark.parametrize("name", ["rounded_wedge", "corner_and_powers"])
def test_nothing_presses_beyond_the_edges(name: str) -> None:
    count = len(sheet_of(name).geometry.parameters)
    with np.errstate(all="ignore"):
        (p,) = function_of(name, ("pressure",))(
            np.array([-4.0, -3.0, 2.0, 5.0]), 3.0, 2.0, 1.0, *[1.0] * count
        )
    np.testing.assert_array_equal(p, 0.0)
