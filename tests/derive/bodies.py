"""Bodies that the tests share: g(x) for the program, and g'(x) once more in plain numbers.

The slopes are written by hand, so that no quadrature rests on how the program reads g(x).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import pytest
from mpmath import mpf
from sympy import Abs, Expr, Max, Piecewise, lambdify

from derive import Geometry, parameter, x
from derive.body.library import load_geometry
from derive.proof.verdict import Proof, Verdict
from derive.sheet.derivation import derive_sheet
from derive.sheet.formulas import FormulaSheet

R = parameter("R", "radius of curvature", unit="m")
R1 = parameter("R1", "radius of curvature on the left", unit="m")
phi = parameter("phi", "slope of the left flank", unit="rad")
psi = parameter("psi", "slope of the right flank", unit="rad")
b = parameter("b", "half-width of the middle", unit="m")
C = parameter("C", "constant of the quartic", unit="m**3")
L = parameter("L", "length", unit="m")
k = parameter("k", "exponent", unit="-")

# All exact in binary: a number means the same to Python, mpmath and SymPy.
VALUES = {"E_star": 1.25, "R": 1.5, "R1": 0.75, "phi": 0.25, "psi": 0.375, "b": 0.5, "C": 2.0}

SPANNED = ((2.0, 1.0), (0.75, 3.0), (-0.25, 3.0), (1.5, 1.5))
"""Contacts [-a, c] around x = b, one of them wholly to the right of the origin."""
ANYWHERE = ((2.0, 1.0), (0.75, 3.0), (-1.0, 3.0), (3.0, -1.0), (0.25, 2.0), (1.5, 1.5))
"""Contacts with a > c and a < c; two have left every kink, one the left kink at -b only."""
RIGHT = ((2.0, 1.0), (0.75, 3.0), (-1.0, 3.0), (1.5, 1.5))
"""Contacts of a body that is straight for x < 0."""


@dataclass(frozen=True)
class Body:
    """One example body.

    slope     g'(x) in numbers, at VALUES
    kinks     where it changes its polynomial, in numbers
    contacts  (a, c) at which it is tested
    """

    g: Expr
    slope: Callable[[mpf], mpf]
    kinks: tuple[float, ...] = ()
    contacts: tuple[tuple[float, float], ...] = ANYWHERE


def _sign(s: mpf) -> int:
    return 1 if s > 0 else -1


_beyond = Abs(x) - b

BODIES = {
    "hertz": Body(x**2 / (2 * R), lambda s: s / 1.5),
    "wedge": Body(phi * Abs(x), lambda s: 0.25 * _sign(s), (0.0,), SPANNED[:2] + SPANNED[3:]),
    "unequal_wedge": Body(
        Piecewise((-phi * x, x < 0), (psi * x, True)),
        lambda s: 0.375 if s > 0 else -0.25,
        (0.0,),
        SPANNED[:2] + SPANNED[3:],
    ),
    "shifted_wedge": Body(phi * Abs(x - b), lambda s: 0.25 * _sign(s - 0.5), (0.5,), SPANNED),
    "wedge_on_the_left": Body(
        phi * Abs(x + b),
        lambda s: 0.25 * _sign(s + 0.5),
        (-0.5,),
        tuple((c, a) for a, c in SPANNED),
    ),
    "flat_rounded": Body(
        Piecewise((0, _beyond <= 0), (_beyond**2 / (2 * R), True)),
        lambda s: _sign(s) * max(abs(s) - 0.5, mpf(0)) / 1.5,
        (-0.5, 0.5),
    ),
    "flat_cornered": Body(
        phi * Max(0, _beyond),
        lambda s: 0.25 * _sign(s) if abs(s) > 0.5 else mpf(0),
        (-0.5, 0.5),
        ((2.0, 1.0), (0.75, 3.0), (0.25, 2.0), (-0.25, 2.0), (2.0, -0.25), (1.5, 1.5)),
    ),
    "rounded_wedge": Body(
        Piecewise((x**2 / (2 * R), Abs(x) < b), (b * Abs(x) / R - b**2 / (2 * R), True)),
        lambda s: _sign(s) * min(abs(s), mpf(0.5)) / 1.5,
        (-0.5, 0.5),
        ((2.0, 1.0), (0.75, 3.0), (0.25, 2.0), (-0.25, 2.0), (0.25, 0.375), (1.5, 1.5)),
    ),
    "quartic": Body(x**4 / C, lambda s: 2 * s**3),
    "parabola_quartic": Body(x**2 / (2 * R) + x**4 / C, lambda s: s / 1.5 + 2 * s**3),
    "two_radii": Body(
        Piecewise((x**2 / (2 * R1), x < 0), (x**2 / (2 * R), True)),
        lambda s: s / 1.5 if s > 0 else s / 0.75,
        (0.0,),
    ),
    "skew": Body(
        x**2 / R + x**3 / R**2 + x**4 / R**3,  # g'' R^3 = 2 R^2 + 6 R x + 12 x^2 > 0
        lambda s: 2 * s / 1.5 + 3 * s**2 / 2.25 + 4 * s**3 / 3.375,
    ),
    "spline": Body(
        x**2 / R + Max(0, x - b) ** 3 / R**2,
        lambda s: 2 * s / 1.5 + 3 * max(s - 0.5, mpf(0)) ** 2 / 2.25,
        (0.5,),
    ),
    "wedge_on_parabola": Body(
        phi * Abs(x) + x**2 / (2 * R), lambda s: 0.25 * _sign(s) + s / 1.5, (0.0,)
    ),
    "half_parabola": Body(Max(0, x) ** 2 / (2 * R), lambda s: max(s, mpf(0)) / 1.5, (0.0,), RIGHT),
    "three_corners": Body(
        phi * (Abs(Abs(x) - b) + 2 * Abs(x)),  # slope 3 phi beyond b, phi within
        lambda s: _sign(s) * (0.75 if abs(s) > 0.5 else 0.25),
        (-0.5, 0.0, 0.5),
        ((2.0, 1.0), (0.75, 3.0), (0.25, 2.0), (-0.25, 2.0), (2.0, -0.25), (0.25, 0.375)),
    ),
}

QUICK = {"hertz", "wedge", "shifted_wedge", "flat_rounded", "quartic", "two_radii"}
"""One of every kind; the others are slow."""

CASES = [
    pytest.param(
        *(name, a, c),
        marks=()
        if name in QUICK and i < 4
        else pytest.mark.slow
        if i < 1
        else pytest.mark.thorough,
        id=f"{name}[{-a:g},{c:g}]",
    )
    for name, body in BODIES.items()
    for i, (a, c) in enumerate(body.contacts)
]
EACH = [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in BODIES]
"""What tests are parametrized with: contacts of every body, and every body."""


@cache
def geometry(name: str) -> Geometry:
    """One body, read once."""
    return Geometry(name, g=BODIES[name].g)


@cache
def of_library(name: str) -> FormulaSheet:
    """The sheet of a body of the library, derived once."""
    return derive_sheet(load_geometry(name))


@cache
def sheet(name: str) -> FormulaSheet:
    """The sheet of one body, derived once."""
    return derive_sheet(geometry(name))


def assumed(of: FormulaSheet, verdict: Verdict = Verdict.PROVEN) -> FormulaSheet:
    """The sheet as if every formula had this verdict: for tests of what comes after the proof."""
    proof = Proof(verdict, "assumed by a test")
    return replace(of, formulas={name: replace(f, proof=proof) for name, f in of.items()})


@cache
def _function(expr: Expr) -> tuple[tuple[str, ...], Callable[..., mpf]]:
    held = sorted(expr.free_symbols, key=str)
    return tuple(symbol.name for symbol in held), lambdify(held, expr, modules="mpmath")


def number(expr: Expr, **given: float | mpf) -> mpf:
    """An expression in numbers, at VALUES where nothing else is given; compiled once."""
    numbers = VALUES | given
    held, function = _function(expr)
    return mpf(function(*(mpf(numbers[symbol]) for symbol in held)))


@cache
def _flat(name: str, formula: str) -> Expr:
    return sheet(name).flat(formula)


def value(name: str, formula: str, **given: float | mpf) -> mpf:
    """One formula of one body of BODIES in numbers, at VALUES where nothing else is given; e stands
    for M/P."""
    if "P" in given and "M" in given:
        given["e"] = mpf(given["M"]) / given["P"]
    return number(_flat(name, formula), **given)


def close(first: mpf, second: mpf, *, digits: int = 22, scale: float | mpf = 0) -> bool:
    """Whether two numbers agree to so many digits of the larger one, or of `scale`."""
    size = max(abs(first), abs(second), abs(mpf(scale)))
    return bool(abs(first - second) <= size * mpf(10) ** -digits)
