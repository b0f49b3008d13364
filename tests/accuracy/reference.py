"""The exact value of a formula at float64 inputs, to far more digits than float64 holds."""

from collections.abc import Callable, Mapping
from functools import cache

import mpmath
from mpmath import mpf
from sympy import Expr, Symbol, lambdify

from derive.derivation import derive_sheet
from derive.library import load_geometry
from derive.sheet import FormulaSheet
from derive.symbols import M, P, e

DIGITS = 60
"""Digits of the reference; more where the formula itself cancels."""

AGREE = 40
"""Digits to which the reference must not change when its precision is doubled."""


@cache
def sheet_of(body: str) -> FormulaSheet:
    """The derived sheet of a body."""
    return derive_sheet(load_geometry(body))


@cache
def _function(expr: Expr) -> tuple[tuple[str, ...], Callable[..., mpf]]:
    expr = expr.subs(e, M / P)
    held = sorted(expr.free_symbols, key=str)
    return tuple(map(str, held)), lambdify(held, expr, modules="mpmath")


def exact(expr: Expr, point: Mapping[str, float | mpf]) -> mpf:
    """`expr` at `point`; the digits are doubled until the result holds still."""
    if isinstance(expr, Symbol) and str(expr) in point:
        return mpf(point[str(expr)])
    names, function = _function(expr)
    digits, before = DIGITS, None
    while digits < 5000:
        value = _evaluated(function, [mpf(point[name]) for name in names], digits)
        if None not in (value, before) and abs(value - before) <= mpf(10) ** -AGREE * abs(value):
            return value
        before, digits = value, 2 * digits
    raise ArithmeticError(f"{expr} does not settle at {dict(point)}")


def _evaluated(function: Callable[..., mpf], values: list[mpf], digits: int) -> mpf | None:
    with mpmath.workdps(digits):
        try:
            return function(*values)
        except ZeroDivisionError:  # a difference that needs more digits to show
            return None


def condition(expr: Expr, point: Mapping[str, float]) -> float:
    """Relative change of the value per relative change of the inputs, summed over them."""
    names, _ = _function(expr)
    step = mpf(10) ** -30
    with mpmath.workdps(2 * DIGITS):
        value = exact(expr, point)
        if value == 0:
            return 1.0
        total = mpf(0)
        for name in names:
            moved = exact(expr, {**point, name: mpf(point[name]) * (1 + step)})
            total += abs((moved - value) / (step * value))
        return float(total)
