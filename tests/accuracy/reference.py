"""Exact values at float64 inputs, to far more digits than float64 holds, and their conditioning."""

from collections.abc import Callable, Mapping, Sequence
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

Point = Mapping[str, float | mpf]


@cache
def sheet_of(body: str) -> FormulaSheet:
    """The derived sheet of a body."""
    return derive_sheet(load_geometry(body))


@cache
def function_of(expr: Expr) -> tuple[tuple[str, ...], Callable[..., mpf]]:
    """An expression in mpmath, and the names of its arguments."""
    expr = expr.subs(e, M / P)
    held = sorted(expr.free_symbols, key=str)
    return tuple(map(str, held)), lambdify(held, expr, modules="mpmath")


def exact(expr: Expr, point: Point) -> mpf:
    """`expr` at `point`; the digits are doubled until the result holds still."""
    if isinstance(expr, Symbol) and str(expr) in point:
        return mpf(point[str(expr)])
    names, function = function_of(expr)
    digits, before = DIGITS, None
    while digits < 5000:
        value = _evaluated(function, [point[name] for name in names], digits)
        if None not in (value, before) and abs(value - before) <= mpf(10) ** -AGREE * abs(value):
            return value
        before, digits = value, 2 * digits
    raise ArithmeticError(f"{expr} does not settle at {dict(point)}")


def _evaluated(function: Callable[..., mpf], values: list[float | mpf], digits: int) -> mpf | None:
    with mpmath.workdps(digits):
        try:
            return mpmath.re(function(*map(mpf, values)))
        except (ZeroDivisionError, ValueError):  # a difference that needs more digits to show
            return None


def condition(expr: Expr, point: Point) -> float:
    """Relative change of the value per relative change of the inputs, summed over them."""
    names, _ = function_of(expr)
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


# ------------------------------------------------------------------ what is solved for

Conditions = Callable[[Sequence[mpf], Mapping[str, mpf]], Sequence[mpf]]
"""What vanishes at the solution, from the unknowns and the inputs."""

_STEP = mpf(10) ** -18
"""Of the unknowns and the inputs, relative: differences in place of derivatives."""


def solved(
    conditions: Conditions, start: Sequence[float], point: Point, digits: int = 50
) -> tuple[list[mpf], list[float]]:
    """The solution next to `start`, and the condition of each of its numbers.

    Newton's method; `start` is what is judged, so that it must be close, or the solution is not.
    """
    with mpmath.workdps(digits):
        given = {name: mpf(value) for name, value in point.items()}
        now = [mpf(v) for v in start]
        for _ in range(12):
            off, rates = conditions(now, given), _rates(conditions, now, given)
            step = _of_two(rates, [-v for v in off])
            now = [v + d for v, d in zip(now, step, strict=True)]
            if all(
                abs(d) <= mpf(10) ** (15 - digits) * abs(v) for v, d in zip(now, step, strict=True)
            ):
                return now, _conditioned(conditions, now, given)
        raise ArithmeticError(f"no solution next to {list(start)} at {dict(point)}")


def _of_two(columns: list[list[mpf]], right: Sequence[mpf]) -> list[mpf]:
    """Two linear equations, by determinants: no pivot is too small for numbers of any size."""
    (a_11, a_21), (a_12, a_22) = columns
    by = a_11 * a_22 - a_12 * a_21
    return [(right[0] * a_22 - right[1] * a_12) / by, (a_11 * right[1] - a_21 * right[0]) / by]


def _rates(conditions: Conditions, now: list[mpf], given: Mapping[str, mpf]) -> list[list[mpf]]:
    """By each of the unknowns, a column each."""
    at = conditions(now, given)
    columns = []
    for i, v in enumerate(now):
        moved = [*now]
        moved[i] = v * (1 + _STEP)
        there = conditions(moved, given)
        columns.append([(q - p) / (v * _STEP) for p, q in zip(at, there, strict=True)])
    return columns


def _conditioned(conditions: Conditions, now: list[mpf], given: dict[str, mpf]) -> list[float]:
    at, rates = conditions(now, given), _rates(conditions, now, given)
    total = [mpf(0)] * len(now)
    for name, value in given.items():
        if value == 0:
            continue
        there = conditions(now, given | {name: value * (1 + _STEP)})
        change = [(q - p) / _STEP for p, q in zip(at, there, strict=True)]
        moved = _of_two(rates, change)
        total = [t + abs(d / v) for t, d, v in zip(total, moved, now, strict=True)]
    return [max(1.0, float(t)) for t in total]
