"""Exact values at float64 inputs, to far more digits than float64 holds, and their conditioning."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

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

Given = Mapping[str, mpf]

Conditions = Callable[[Sequence[mpf], Given], Sequence[mpf]]
"""What vanishes at the solution, from the unknowns and the inputs."""

Told = Callable[[Sequence[mpf], Given], Sequence[mpf]]
"""What a function gives, from the unknowns and the inputs."""

_FAR, _SLOW = 1e-6, 1e-2
"""A step longer than this, or one that has not shrunk by so much, asks for new rates."""


@dataclass(frozen=True)
class Problem:
    """What a function gives, by conditions for unknowns.

    conditions  as many as there are unknowns, which may be none
    told        the function's numbers; the unknowns themselves unless it says more
    digits      of the reference
    """

    conditions: Conditions
    told: Told | None = None
    digits: int = 50

    def answer(self, start: Sequence[float], point: Point) -> "Answer":
        """Its solution next to `start`.

        Newton's method; `start` comes from what is judged, so that it must be close, or the
        solution is not.
        """
        with mpmath.workdps(self.digits):
            given = {name: mpf(value) for name, value in point.items()}
            now, before = [mpf(v) for v in start], mpf(0)
            if not now:
                return Answer(self, [], given, [])
            rates: list[list[mpf]] = []
            for _ in range(20):
                at = self.conditions(now, given)
                rates = rates or _rates(self.conditions, now, given, at)
                step = _solution(rates, [-v for v in at], now)
                now = [v + d for v, d in zip(now, step, strict=True)]
                length = max(abs(d / v) for v, d in zip(now, step, strict=True))
                rests = length <= mpf(10) ** (15 - self.digits) and length > before / 10 > 0
                if rests or length <= mpf(10) ** (5 - self.digits):
                    return Answer(self, now, given, rates)
                if length > _FAR or not length < _SLOW * before:
                    rates = []
                before = length
            raise ArithmeticError(f"no solution next to {list(start)} at {dict(point)}")

    def numbers(self, unknowns: Sequence[mpf], given: Given) -> list[mpf]:
        """What the function gives."""
        return [*(self.told(unknowns, given) if self.told else unknowns)]


@dataclass(frozen=True)
class Answer:
    """A solution: `numbers` are what is compared."""

    problem: Problem
    unknowns: list[mpf]
    given: dict[str, mpf]
    rates: list[list[mpf]]

    @cached_property
    def numbers(self) -> list[mpf]:
        """What the function gives, in many digits."""
        with mpmath.workdps(self.problem.digits):
            return self.problem.numbers(self.unknowns, self.given)

    @cached_property
    def conditions(self) -> list[float]:
        """Of each of these numbers."""
        with mpmath.workdps(self.problem.digits):
            total = [mpf(0)] * len(self.numbers)
            at = self.problem.conditions(self.unknowns, self.given)
            for name, value in self.given.items():
                if value:
                    moved = self._moved(self.given | {name: value * (1 + _step())}, at)
                    total = [t + d for t, d in zip(total, moved, strict=True)]
            return [max(1.0, float(t)) for t in total]

    def _moved(self, given: dict[str, mpf], at: Sequence[mpf]) -> list[mpf]:
        """Relative changes of the numbers per relative change of an input."""
        there = self.problem.conditions(self.unknowns, given)
        back = [p - q for p, q in zip(at, there, strict=True)]
        step = _solution(self.rates, back, self.unknowns) if back else []
        unknowns = [v + d for v, d in zip(self.unknowns, step, strict=True)]
        numbers = self.problem.numbers(unknowns, given)
        return [
            abs((p - q) / (_step() * q)) if q else mpf(0)
            for p, q in zip(numbers, self.numbers, strict=True)
        ]


def _step() -> mpf:
    """Of the unknowns and the inputs, relative: differences in place of derivatives."""
    return mpf(10) ** -max(18, 9 * mpmath.mp.dps // 20)


def _solution(columns: list[list[mpf]], right: list[mpf], sizes: list[mpf]) -> list[mpf]:
    """Linear equations; a column an unknown of such a size, numbers of any size."""
    scaled = [[v * size for v in column] for column, size in zip(columns, sizes, strict=True)]
    rows = []
    for row in zip(*scaled, right, strict=True):
        most = max(map(abs, row[:-1]))
        if not most:
            raise ZeroDivisionError("a condition that no unknown changes")
        rows.append([v / most for v in row])
    found = mpmath.lu_solve([row[:-1] for row in rows], [row[-1] for row in rows])
    return [v * size for v, size in zip(found, sizes, strict=True)]


def _rates(
    conditions: Conditions, now: list[mpf], given: Given, at: Sequence[mpf]
) -> list[list[mpf]]:
    """By each of the unknowns, a column each."""
    columns, step = [], _step()
    for i, v in enumerate(now):
        moved = [*now]
        moved[i] = v * (1 + step)
        there = conditions(moved, given)
        columns.append([(q - p) / (v * step) for p, q in zip(at, there, strict=True)])
    return columns
