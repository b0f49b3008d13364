"""Rewritten formulas: what is false is refuted.  Generation proves those of the library."""

from collections.abc import Callable, Iterable
from dataclasses import replace

import pytest
from sympy import Abs, Expr, Piecewise, Rational, nan, tan

from derive import Geometry
from derive.codegen.contract import CONTRACT, Function
from derive.codegen.function import FunctionText
from derive.codegen.program import Program
from derive.codegen.rewrite import prove_equal
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


FALSE: dict[str, Callable[[Expr], Expr]] = {
    "another sign": lambda expr: -expr,
    "twice as large": lambda expr: 2 * expr,
    "wrong in the 25th digit": lambda expr: expr * (1 + Rational(1, 10**25)),
    "wrong for a > c only": lambda expr: Piecewise((2 * expr, a > c), (expr, True)),
    "wrong for a < c only": lambda expr: Piecewise((2 * expr, a < c), (expr, True)),
    "zero": lambda expr: 0 * expr,
    "not a number": lambda expr: expr + nan,
}
OF_AN_INVERSE = ("another sign", "wrong in the 25th digit", "zero")


@pytest.mark.parametrize(
    ("body", "name", "field", "changes"),
    [
        *(("hertz", "K_N", "right", FALSE), ("wedge", "tilt", "", FALSE)),
        *(("wedge", "pressure", "", FALSE), ("flat_rounded", "moment", "", FALSE)),
        *(("wedge", "contact", field, OF_AN_INVERSE) for field in ("a", "c", "alpha")),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_falsified_program_is_refuted(
    body: str, name: str, field: str, changes: Iterable[str]
) -> None:
    function = named(body, name)
    true = Program(source(body, function))
    assert compared(body, function, true).verdict == Verdict.NUMERICAL
    for what in changes:
        false = replace(true, outputs=true.outputs | {field: FALSE[what](true.outputs[field])})
        assert compared(body, function, false).verdict == Verdict.REFUTED, what


@pytest.mark.slow
def test_a_tangent_of_a_parameter_is_a_number() -> None:
    """Also under a tilt, where the edges hold the tangent of the kink's angle as well."""
    steep = derive_sheet(Geometry("steep", tan(phi / 2) * Abs(along)))
    found = {f.name: f for f in CONTRACT if f.available(steep)}
    for name in ("tilt", "load", "contact_at_tilt"):
        FunctionText(steep, found[name])  # raises NotProven
