"""Rewritten formulas: equal to what they were made from, and keeping their digits in float64.

Reference values at the edges, at the apex and under extreme loads are hand-derived closed forms,
worked out at as many digits as they need; the closed forms themselves are compared with quadrature.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cache

import mpmath
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Piecewise, Rational, Symbol, atan2, lambdify, nan, pi, tan

from derive import Geometry
from derive.body.library import load_geometry
from derive.codegen.angles import shares_of_the_half_circle
from derive.codegen.contract import CONTRACT, Function
from derive.codegen.function import FunctionText
from derive.codegen.program import Program
from derive.codegen.rewrite import prove_equal, stable_program
from derive.proof.points import Point, contacts, loads, numeric, numeric_by_steps
from derive.proof.verdict import Proof, Verdict
from derive.sheet.derivation import derive_sheet
from derive.symbols import P, a, c
from derive.symbols import x as along
from tests.derive import integrals
from tests.derive.bodies import BODIES, VALUES, phi, sheet

WORKING = 50
DIGITS = 30
SHARES = ("0.0625", "0.3125", "0.4375", "0.71875", "0.984375")
"""Places in a contact, as shares of its width."""

REWRITTEN = ("hertz", "unequal_wedge")


# ------------------------------------------------------------------ equal to the source


@cache
def states(body: str) -> list[dict[str, mpf]]:
    """Contacts of a body with their loads and tilts by quadrature, five places in each."""
    with mpmath.workdps(WORKING):
        return list(_states(body))


def _states(body: str) -> Iterator[dict[str, mpf]]:
    for left, right in BODIES[body].contacts[:3]:
        slope, kinks = BODIES[body].slope, BODIES[body].kinks
        edges = mpf(left), mpf(right)
        state = {name: mpf(value) for name, value in VALUES.items()}
        state |= {"a": edges[0], "c": edges[1], "dQ": mpf("0.375"), "dsigma": mpf("-0.25")}
        state |= {"dP": mpf("0.25"), "dM": mpf("-0.125"), "f": mpf("0.5")}
        state["alpha"] = integrals.tilt(slope, *edges, kinks)
        state["P"] = integrals.load(slope, *edges, kinks, state["E_star"])
        state["M"] = integrals.moment(slope, *edges, kinks, state["E_star"])
        state["e"] = state["M"] / state["P"]
        for share in SHARES:
            yield state | {"x": mpf(share) * (edges[0] + edges[1]) - edges[0]}


def named(body: str, name: str) -> Function:
    return next(function for function in functions(body) if function.name == name)


def functions(body: str) -> list[Function]:
    return [function for function in CONTRACT if function.available(sheet(body))]


def source(body: str, function: Function) -> dict[str, Expr]:
    """The formulas of a function, with every symbol of the frame written out."""
    of = sheet(body)
    return {name: of.frame.flat(expr) for name, expr in function.outputs(of).items()}


def point(body: str, state: Mapping[str, mpf]) -> Point:
    """A state by the symbols of the sheet."""
    of = sheet(body)
    symbols = {s for f in of.values() for s in of.flat(f.name).free_symbols | set(f.arguments)}
    return {symbol: state[str(symbol)] for symbol in symbols if str(symbol) in state}


@cache
def rewritten(body: str, name: str) -> Program:
    """The program of one function, rewritten once."""
    of = sheet(body)
    return stable_program(of, named(body, name).outputs(of), point(body, states(body)[0]))


@pytest.mark.slow
@pytest.mark.parametrize("body", REWRITTEN)
def test_a_rewritten_program_equals_its_source_to_30_digits(body: str) -> None:
    for function in functions(body):
        program = rewritten(body, function.name).in_mathematics()
        steps = [(step.symbol, step.expr) for step in program.steps]
        wanted = source(body, function)
        assert program.outputs.keys() == wanted.keys()
        apart = 1 if along in function.arguments else len(SHARES)  # else places do not matter
        for state in (point(body, state) for state in states(body)[::apart]):
            with mpmath.workdps(WORKING):
                for name, expr in program.outputs.items():
                    here = numeric_by_steps(steps, expr)(state)
                    there = numeric(wanted[name])(state)
                    scale = max(abs(there), mpf(10) ** -15)  # a tilt of zero is a difference
                    assert abs(here - there) <= scale * mpf(10) ** -DIGITS, (function.name, state)


# ------------------------------------------------------------------ what is false is refuted


def compared(body: str, function: Function, program: Program) -> Proof:
    """The program against its source at the points that generation uses."""
    of = sheet(body)
    if P not in function.arguments:
        return prove_equal(program, source(body, function), contacts(of))
    formula = next(of[name] for _, name in function.fields if isinstance(name, str))
    return prove_equal(program, source(body, function), loads(of, formula))


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


# ------------------------------------------------------------------ names


# ------------------------------------------------------------------ shares of the half circle


def test_angles_become_shares_of_the_half_circle() -> None:
    """pi R_2 + (R_1 - R_2) theta = R_2 theta' + R_1 theta: both positive; and of an atan2 alike."""
    two = derive_sheet(load_geometry("two_radii"))
    (kink,) = two.frame.kinks
    R_1, R_2 = (q.symbol for q in two.geometry.parameters)
    lean, reach = Symbol("lean", real=True), Symbol("reach", positive=True)
    for angle in (kink.theta, atan2(reach, lean)):
        source = pi * R_2 + angle * (R_1 - R_2)
        found = shares_of_the_half_circle(Program({"": source}), two).outputs[""]
        assert found.coeff(angle) == R_1
        assert not found.has(pi)
        both = [expr.xreplace({kink.theta: kink.angle}) for expr in (source, found)]
        held = sorted(set().union(*(v.free_symbols for v in both)), key=str)
        for values in ((2, 3, 5, 7), (0.5, 11, 3, 0.25)):
            numbers = dict(zip(held, map(mpf, values), strict=False))
            first, second = (lambdify(held, v, modules="mpmath")(*numbers.values()) for v in both)
            assert abs(first - second) < mpf(10) ** -13
    unlike = kink.theta * R_1 + pi * lean
    assert shares_of_the_half_circle(Program({"": unlike}), two).outputs[""] == unlike


# ------------------------------------------------------------------ tangents


@pytest.mark.slow
def test_a_tangent_of_a_parameter_is_a_number() -> None:
    """Also under a tilt, where the edges hold the tangent of the kink's angle as well."""
    steep = derive_sheet(Geometry("steep", tan(phi / 2) * Abs(along)))
    found = {f.name: f for f in CONTRACT if f.available(steep)}
    for name in ("tilt", "load", "contact_at_tilt"):
        FunctionText(steep, found[name])  # raises NotProven
