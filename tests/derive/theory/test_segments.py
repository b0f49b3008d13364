"""Formulas as sums over the parts of a contact: against the derived ones, and in their signs."""

from dataclasses import replace
from functools import cache

import mpmath
import pytest
from sympy import Piecewise, Rational

from derive.body.geometry import Geometry, parameter
from derive.proof.points import contacts, numeric, numeric_by_steps
from derive.proof.prove import prove_sheet
from derive.proof.verdict import POINTS
from derive.sheet.derivation import derive_sheet
from derive.sheet.formulas import FormulaSheet
from derive.symbols import x
from derive.theory.edges import Edge, pressure_series
from derive.theory.parts import parts_of
from derive.theory.segments import written_out
from tests.derive.bodies import of_library

BODIES = ("flat_rounded", "rounded_wedge", "two_radii", "wedge_parabola", "flat_sloped")


b, R = parameter("b", "half a length", unit="m"), parameter("R", "radius", unit="m")
many_parts = Geometry(
    "many_parts",
    g=Piecewise(
        (-(x + b) / 4, x < -b),
        (0, x < 0),
        (x**2 / (2 * R), x < b),
        (x**2 / R - b * x / R + b**2 / (2 * R), x < 2 * b),
        (3 * b * x / R - 7 * b**2 / (2 * R), x < 3 * b),
        (3 * b * x / R - 7 * b**2 / (2 * R) + (x - 3 * b) ** 2 / (2 * R), True),
    ),
)
"""A flank, a corner, a flat, two curved parts between kinks, a straight one and a curved end."""


@cache
def sheet_of(name: str) -> FormulaSheet:
    return derive_sheet(many_parts) if name == "many_parts" else of_library(name)


@pytest.mark.enough("many_parts", "flat_rounded")
@pytest.mark.parametrize("name", [*BODIES, "many_parts"])
def test_the_sums_are_the_derived_formulas(name: str) -> None:
    sheet = sheet_of(name)
    parts, points = parts_of(sheet.frame), contacts(sheet)
    steps = [(d.symbol, written_out(d.expr)) for d in parts.definitions]
    assert len(points) == POINTS
    for formula, expr in parts.formulas.items():
        if formula.startswith("third_"):
            edge = Edge[formula.removeprefix("third_").upper()]
            derived = sheet.frame.flat(pressure_series(sheet.frame, edge, 3)[2])
        else:
            derived = sheet.flat(formula)
        with mpmath.workdps(50):
            summed, true = numeric_by_steps(steps, written_out(expr)), numeric(derived)
            pairs = [(summed(p), true(p)) for p in points]
        gaps = [abs(found / wanted - 1) for found, wanted in pairs if wanted]
        assert max(gaps) < mpmath.mpf(10) ** -42, formula


@pytest.mark.enough("flat_rounded", "rounded_wedge")
@pytest.mark.parametrize("name", BODIES)
def test_no_term_of_what_a_contact_carries_is_negative(name: str) -> None:
    parts = parts_of(sheet_of(name).frame)
    for formula in ("load", "K_N_left", "K_N_right", "pressure"):
        terms = parts.formulas[formula].expand().as_ordered_terms()
        assert not any(term.could_extract_minus_sign() for term in terms)


def test_a_sum_that_is_not_the_formula_is_refuted() -> None:
    sheet = sheet_of("flat_sloped")
    load = sheet["load"]
    wrong = replace(load, computed=load.computed * Rational(1001, 1000))
    formulas = {name: sheet[name] for name in ("tilt", "load", "pressure", "K_N_left", "K_N_right")}
    proven = prove_sheet(replace(sheet, formulas={**formulas, "load": wrong}))
    assert not proven["load"].proof.holds
    assert proven["tilt"].proof.holds
