"""Rewritten formulas: equal to what they were made from; what is false is refuted."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from sympy import Abs, Expr, Piecewise, Rational, nan, tan

from derive import Geometry
from derive.codegen.contract import CONTRACT, Function
from derive.codegen.example import example_of
from derive.codegen.function import FunctionText
from derive.codegen.plan import Route, route_of
from derive.codegen.program import Program
from derive.codegen.rewrite import prove_equal, stable_program
from derive.proof.points import contacts, loads
from derive.proof.verdict import Proof, Verdict
from derive.sheet.derivation import derive_sheet
from derive.symbols import P, a, c
from derive.symbols import x as along
from tests.derive.bodies import phi, sheet


def named(body: str, name: str) -> Function:
    return next(f for f in CONTRACT if f.available(sheet(body)) and f.name == name)


def source(body: str, function: Function) -> dict[str, Expr]:
    """The formulas of a function, with every symbol of the frame written out."""
    of = sheet(body)
    return {name: of.frame.flat(expr) for name, expr in function.outputs(of).items()}


def compared(body: str, function: Function, program: Program) -> Proof:
    """The program against its source at the points that generation uses."""
    of = sheet(body)
    if P not in function.arguments:
        return prove_equal(program, source(body, function), contacts(of))
    formula = next(of[name] for _, name in function.fields if isinstance(name, str))
    return prove_equal(program, source(body, function), loads(of, formula))


@pytest.mark.parametrize("body", ["hertz", "quartic", "wedge", "unequal_wedge"])
def test_a_rewritten_program_equals_its_source(body: str) -> None:
    of = sheet(body)
    for function in CONTRACT:
        if route_of(of, function) is Route.FORMULA:
            example = example_of(of, function.conditions(of), function.geometric)
            program = stable_program(of, function.outputs(of), example)
            proof = compared(body, function, program)
            assert proof.verdict is Verdict.NUMERICAL and proof.digits >= 30, function.name


# ------------------------------------------------------------------ what is false is refuted


def falsified(program: Program, field: str, change: Callable[[Expr], Expr]) -> Program:
    return replace(program, outputs={**program.outputs, field: change(program.outputs[field])})


FALSE: dict[str, Callable[[Expr], Expr]] = {
    "another sign": lambda expr: -expr,
    "twice as large": lambda expr: 2 * expr,
    "wrong in the 25th digit": lambda expr: expr * (1 + Rational(1, 10**25)),
    "wrong for a > c only": lambda expr: Piecewise((2 * expr, a > c), (expr, True)),
    "wrong for a < c only": lambda expr: Piecewise((2 * expr, a < c), (expr, True)),
    "zero": lambda expr: 0 * expr,
    "not a number": lambda expr: expr + nan,
}


@pytest.mark.parametrize(
    ("body", "name", "field"),
    [
        ("hertz", "K_N", "right"),
        ("wedge", "tilt", ""),
        ("wedge", "pressure", ""),
        ("flat_rounded", "moment", ""),
    ],
)
def test_a_falsified_program_is_refuted(body: str, name: str, field: str) -> None:
    function = named(body, name)
    true = Program(source(body, function))
    assert compared(body, function, true).verdict == Verdict.NUMERICAL
    for change in FALSE.values():
        false = falsified(true, field, change)
        assert compared(body, function, false).verdict == Verdict.REFUTED


@pytest.mark.parametrize("field", ["a", "c", "alpha"])
def test_a_falsified_inverse_is_refuted(field: str) -> None:
    function = named("wedge", "contact")
    program = Program(source("wedge", function))
    for what in ("another sign", "wrong in the 25th digit", "zero"):
        false = falsified(program, field, FALSE[what])
        assert compared("wedge", function, false).verdict == Verdict.REFUTED


@pytest.mark.slow
def test_a_tangent_of_a_parameter_is_a_number() -> None:
    """Also under a tilt, where the edges hold the tangent of the kink's angle as well."""
    steep = derive_sheet(Geometry("steep", tan(phi / 2) * Abs(along)))
    found = {f.name: f for f in CONTRACT if f.available(steep)}
    for name in ("tilt", "load", "contact_at_tilt"):
        FunctionText(steep, found[name])  # raises NotProven
