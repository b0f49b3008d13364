"""Rewritten formulas: equal to what they were made from, and keeping their digits in float64.

Reference values at the edges, at the apex and under extreme loads are hand-derived closed forms,
worked out at as many digits as they need; the closed forms themselves are compared with quadrature.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cache

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Piecewise, Rational, Symbol, atan2, lambdify, nan, pi, tan

from derive import Geometry
from derive.body.library import load_geometry
from derive.codegen.contract import CONTRACT, Function
from derive.codegen.function import FunctionText
from derive.codegen.program import Program
from derive.codegen.rewrite import prove_equal, shares_of_the_half_circle, stable_program
from derive.proof.points import contacts, loads
from derive.proof.verdict import Proof, Verdict
from derive.sheet.derivation import derive_sheet
from derive.symbols import P, a, c
from derive.symbols import x as along
from generated import wedge
from tests.derive import integrals
from tests.derive.bodies import BODIES, VALUES, phi, sheet

WORKING = 50
DIGITS = 30
ULPS = 8
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


@cache
def rewritten(body: str, name: str) -> Program:
    """The program of one function, rewritten once."""
    of, function = sheet(body), named(body, name)
    symbols = {s for f in of.values() for s in of.flat(f.name).free_symbols | set(f.arguments)}
    state = states(body)[0]
    example = {symbol: state[str(symbol)] for symbol in symbols if str(symbol) in state}
    return stable_program(of, function.outputs(of), example)


Numbers = Callable[[Mapping[str, mpf]], mpf]


def numbers(formulas: Mapping[str, Expr]) -> dict[str, Numbers]:
    """Formulas as functions of a state."""
    return {name: _number(expr) for name, expr in formulas.items()}


def _number(expr: Expr) -> Numbers:
    held = sorted(expr.free_symbols, key=str)
    function = lambdify(held, expr, modules="mpmath")
    return lambda state: mpf(function(*(state[str(symbol)] for symbol in held)))


@pytest.mark.slow
@pytest.mark.parametrize("body", REWRITTEN)
def test_a_rewritten_program_equals_its_source_to_30_digits(body: str) -> None:
    for function in functions(body):
        wanted = numbers(source(body, function))
        got = numbers(rewritten(body, function.name).flat())
        assert got.keys() == wanted.keys()
        step = 1 if along in function.arguments else len(SHARES)  # else places do not matter
        for state in states(body)[::step]:
            with mpmath.workdps(WORKING):
                for name in wanted:
                    here, there = got[name](state), wanted[name](state)
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


def test_a_falsified_step_is_refuted() -> None:
    function = named("wedge", "pressure")
    program = rewritten("wedge", "pressure")
    assert program.steps
    for place, step in enumerate(program.steps):
        steps = list(program.steps)
        steps[place] = replace(step, expr=step.expr * (1 + Rational(1, 10**20)))
        false = replace(program, steps=tuple(steps))
        assert compared("wedge", function, false).verdict == Verdict.REFUTED


def test_a_difference_beyond_all_digits_is_none_and_a_refutation_names_the_point() -> None:
    function = named("hertz", "load")
    true = Program(source("hertz", function))
    near = falsified(true, "", lambda v: v * (1 + Rational(1, 10**40)))
    assert compared("hertz", function, near).holds
    proof = compared("hertz", function, falsified(true, "", lambda v: 3 * v))
    assert all(f"{symbol} = " in proof.example for symbol in ("a", "c", "E_star", "R"))


# ------------------------------------------------------------------ names


@pytest.mark.parametrize("body", REWRITTEN)
def test_a_step_knows_only_those_before_it_and_bears_no_argument_s_name(body: str) -> None:
    for function in functions(body):
        program = rewritten(body, function.name)
        steps = [str(step.symbol) for step in program.steps]
        assert len(steps) == len(set(steps))
        assert {str(s) for s in (*function.arguments, *function.keywords(sheet(body)))}.isdisjoint(
            steps
        )
        for place, step in enumerate(program.steps):
            later = {other.symbol for other in program.steps[place:]}
            assert step.expr.free_symbols.isdisjoint(later)


# ------------------------------------------------------------------ digits


def ulps(got: float, exact: mpf) -> float:
    """Error in units in the last place of the exact value."""
    with mpmath.workdps(60):
        return float(abs(mpf(float(got)) - exact) / mpf(float(np.spacing(abs(float(exact))))))


def wedge_pressure(x: float, left: float, right: float, E_star: float, phi: float) -> mpf:
    """p = (2 E* phi/pi) atanh k, k^2 = a (c - x)/(c (a + x)) right of the apex, else its inverse.

    By p = (E*/2 pi) w(x) int (g'(s) - g'(x))/((s - x) w(s)) ds: for x > 0 the numerator is -2 phi
    on (-a, 0) and 0 elsewhere; t = sqrt((c - s)/(a + s)) turns the integral into
    2 phi/w(x) log((1 + k)/(1 - k)), the logarithm being 2 atanh k.
    """
    x, left, right = mpf(x), mpf(left), mpf(right)
    k2 = left * (right - x) / (right * (left + x))
    return 2 * mpf(E_star) * phi / mpmath.pi * mpmath.atanh(mpmath.sqrt(k2 if x > 0 else 1 / k2))


def wedge_contact(load: float, moment: float, E_star: float, phi: float) -> tuple[mpf, mpf, mpf]:
    """P = E* phi sqrt(a c) and M = P (a - c)/4 solved; tan(pi alpha/2 phi) = (a - c)/(2 sqrt(a c)).

    With B = P/(E* phi) and D = 2 M/P: a c = B^2 and a - c = 2 D, so a = D + sqrt(D^2 + B^2).
    """
    base, lean = mpf(load) / (mpf(E_star) * phi), 2 * mpf(moment) / load
    root = mpmath.sqrt(lean**2 + base**2)
    return root + lean, root - lean, 2 * mpf(phi) / mpmath.pi * mpmath.atan(lean / base)


def wedge_contact_at_tilt(load: float, tilt: float, E_star: float, phi: float) -> tuple[mpf, mpf]:
    """a, c = B (sec t +- tan t), t = pi alpha/(2 phi), from (a - c)/(2 B) = tan t and a c = B^2."""
    base, t = mpf(load) / (mpf(E_star) * phi), mpmath.pi * tilt / (2 * mpf(phi))
    return base * (mpmath.sec(t) + mpmath.tan(t)), base * (mpmath.sec(t) - mpmath.tan(t))


@pytest.mark.parametrize(("left", "right"), [(2.0, 1.0), (0.75, 3.0), (1.5, 1.5)])
def test_the_closed_forms_agree_with_quadrature(left: float, right: float) -> None:
    slope, kinks = BODIES["wedge"].slope, BODIES["wedge"].kinks
    E_star, phi = VALUES["E_star"], VALUES["phi"]
    with mpmath.workdps(30):
        edges = mpf(left), mpf(right)
        tilt = integrals.tilt(slope, *edges, kinks)
        load = integrals.load(slope, *edges, kinks, mpf(E_star))
        moment = integrals.moment(slope, *edges, kinks, mpf(E_star))
        pairs = list(zip((*edges, tilt), wedge_contact(load, moment, E_star, phi), strict=True))
        pairs += zip(edges, wedge_contact_at_tilt(load, tilt, E_star, phi), strict=True)
        for x in (mpf(-left) / 4, mpf(right) / 8):
            here = integrals.pressure(slope, x, *edges, kinks, mpf(E_star))
            pairs.append((here, wedge_pressure(x, left, right, E_star, phi)))
        assert all(abs(one - other) < mpf(10) ** -22 for one, other in pairs)


WEDGES = [(1.0, 1.0, 8.0, 0.125), (0.3, 7.1, 2.3e11, 0.07), (4.7e-4, 1.3e-4, 1.15e11, 0.0123)]
"""a, c, E_star, phi; most of them not exact in binary."""


def next_to_edges(left: float, right: float) -> list[float]:
    """Places as close to both edges and to the apex as float64 has them, and less close."""
    shares = (2e-16, 1e-15, 1e-12, 1e-6, 1e-3, 0.1)
    places = [float(np.nextafter(-left, np.inf)), float(np.nextafter(right, -np.inf))]
    places += [p for s in shares for p in (right - s * abs(right), -left + s * abs(left))]
    places += [sign * near for near in (1e-140, 1e-30, 1e-6) for sign in (1, -1)]
    return [p for p in places if -left < p < right]


@pytest.mark.parametrize(("left", "right", "E_star", "phi"), WEDGES)
def test_the_wedge_s_pressure_keeps_its_digits_next_to_an_edge_and_the_apex(
    left: float, right: float, E_star: float, phi: float
) -> None:
    for x in next_to_edges(left, right):
        with mpmath.workdps(320):  # k is 1 to more than 140 digits at the apex
            exact = wedge_pressure(x, left, right, E_star, phi)
        got = wedge.pressure(x, left, right, E_star=E_star, phi=phi)
        assert ulps(got, exact) <= ULPS, (x, got)


@pytest.mark.parametrize("load", [1e-12, 3.7e-5, 1e12])
@pytest.mark.parametrize("lean", [0.0, 1e-8, -0.3, 41.0, 1e8])
def test_the_wedge_s_contact_keeps_its_digits_under_extreme_loads(load: float, lean: float) -> None:
    E_star, phi = 1.7e3, 0.0123
    moment = lean * load**2 / (E_star * phi)
    with mpmath.workdps(100):
        exact = wedge_contact(load, moment, E_star, phi)
    got = wedge.contact(load, moment, E_star=E_star, phi=phi)
    assert got.alpha == 0 if lean == 0 else ulps(got.alpha, exact[2]) <= ULPS
    assert max(ulps(got.a, exact[0]), ulps(got.c, exact[1])) <= ULPS


@pytest.mark.parametrize("share", [0.0, 1e-9, 0.5, 1 - 1e-12])
@pytest.mark.parametrize("load", [1e-12, 1e12])
def test_the_wedge_s_contact_keeps_its_digits_up_to_the_largest_tilt(
    load: float, share: float
) -> None:
    E_star, phi = 1.7e3, 0.0123
    for tilt in (share * phi, -share * phi):
        with mpmath.workdps(60):
            exact = wedge_contact_at_tilt(load, tilt, E_star, phi)
        got = wedge.contact_at_tilt(load, tilt, E_star=E_star, phi=phi)
        assert max(ulps(got.a, exact[0]), ulps(got.c, exact[1])) <= ULPS, tilt


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
