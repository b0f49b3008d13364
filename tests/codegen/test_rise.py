"""g' that vanishes at a break, as a difference in SymPy and not in floating point."""

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from sympy import (
    Expr,
    Rational,
    Symbol,
    asinh,
    atan,
    cosh,
    exp,
    lambdify,
    log,
    simplify,
    sinh,
    sqrt,
    symbols,
    tanh,
)

from derive.codegen.printer import NumPyPrinter
from derive.codegen.rise import from_zero

t, b, k, phi = symbols("t b k phi", positive=True)
GIVEN = {b: 1.5, k: 1.625, phi: 0.125}

RISING = [
    phi * (exp(t / b) - 1),
    phi * exp(t / b) - phi + t / b,
    1 - exp(-t / b),
    log(1 + t / b),
    log(b + t) - log(b),
    simplify(phi * log((b + t) / b)),
    -log(1 - t / b / 16),
    phi * (sqrt(1 + t / b) - 1),
    sqrt(b**2 + t**2) / b - 1,
    (1 + t / b) ** k - 1,
    (1 + t / b) ** Rational(3, 2) - 1,
    1 - 1 / (1 + t / b) ** 2,
    cosh(t / b) - 1,
    sinh(1 + t / b) - sinh(1),
    tanh(t / b) + 1 - exp(-t / b),
    exp(t / b) * cosh(t / b) - 1,
    exp(asinh(t / b)) - 1,
]
"""Terms that cancel at t = 0."""

AS_THEY_ARE = [
    *(t * exp(t**2), atan(t / b), asinh(t / b), t / sqrt(t**2 + b**2), phi * t / (b + t)),
    *(t ** (k + 1) * exp(t), t**k, sinh(t / b), 1 + t / b, exp(t / b), 1 + tanh(t)),
]
"""Nothing cancels, or they are not zero at t = 0."""


def in_floats(expr: Expr, at: float) -> float:
    function = lambdify([t, *GIVEN], expr, modules=[{"np": np}], printer=NumPyPrinter({t}))
    return float(function(*map(np.float64, (at, *GIVEN.values()))))


def exactly(expr: Expr, at: float) -> mpf:
    function = lambdify([t, *GIVEN], expr, modules="mpmath")
    with mpmath.workdps(700):
        return function(mpf(at), *map(mpf, GIVEN.values()))


@pytest.mark.parametrize("expr", RISING, ids=str)
@pytest.mark.parametrize("at", [1e-300, 1e-100, 1e-17, 1e-8, 1e-3, 0.3, 1.0, 5.0])
def test_every_digit_is_kept(expr: Expr, at: float) -> None:
    wanted = exactly(expr, at)
    if abs(wanted) > 1e-300:  # cosh - 1 underflows
        assert abs(mpf(in_floats(from_zero(expr, t), at)) / wanted - 1) < 8 * 2.0**-52


@pytest.mark.parametrize("expr", RISING, ids=str)
def test_without_it_they_would_be_lost(expr: Expr) -> None:
    wanted = exactly(expr, 1e-17)
    assert not abs(mpf(in_floats(expr, 1e-17)) / wanted - 1) < 1e-3


@pytest.mark.parametrize("expr", AS_THEY_ARE, ids=str)
def test_what_does_not_cancel_stays(expr: Expr) -> None:
    assert from_zero(expr, t) == expr


def test_what_has_no_such_form_stays() -> None:
    u = Symbol("u", real=True)
    for expr in (tanh(1 + t) - tanh(1), (1 + t) ** t - 1, log(u + t) - log(u)):
        assert from_zero(expr, t) == expr
