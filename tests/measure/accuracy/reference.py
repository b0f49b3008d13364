"""Numbers in many digits at float64 inputs: what a function should give, and its conditioning."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import mpmath
from mpmath import mpf
from sympy import Expr, lambdify

from derive.symbols import M, P, e

Given = Mapping[str, mpf]
Conditions = Callable[[Sequence[mpf], Given], Sequence[mpf]]
"""What vanishes at the solution, from the unknowns and the inputs."""

Told = Callable[[Sequence[mpf], Given], Sequence[mpf]]
"""What a function gives, from the unknowns and the inputs."""

_FAR, _SLOW = 1e-6, 1e-2
"""A step longer than this, or one that has not shrunk by so much, asks for new rates."""


@cache
def function_of(expr: Expr) -> tuple[tuple[str, ...], Callable[..., mpf]]:
    """An expression in mpmath, and the names of its arguments."""
    expr = expr.subs(e, M / P)
    held = sorted(expr.free_symbols, key=str)
    return tuple(map(str, held)), lambdify(held, expr, modules="mpmath")


@dataclass(frozen=True)
class Problem:
    """What a function gives, by conditions for unknowns, of which there may be none.

    told        the function's numbers; the unknowns themselves unless it says more
    digits      of the reference
    """

    conditions: Conditions = lambda _, __: []
    told: Told = lambda unknowns, _: unknowns
    digits: int = 50

    def answer(self, start: Sequence[float], point: Mapping[str, float]) -> "Answer":
        """Its solution next to `start`, which is what is judged, by Newton's method."""
        with mpmath.workdps(self.digits):
            given = {name: mpf(value) for name, value in point.items()}
            now, before = [mpf(v) for v in start], mpf(0)
            rates: list[list[mpf]] = []
            for _ in range(20 if now else 0):
                at = self.conditions(now, given)
                rates = rates or self._rates(now, given, at)
                step = _solution(rates, [-v for v in at], now)
                now = [v + d for v, d in zip(now, step, strict=True)]
                length = max(abs(d / v) for v, d in zip(now, step, strict=True))
                rests = length <= mpf(10) ** (15 - self.digits) and length > before / 10 > 0
                if rests or length <= mpf(10) ** (5 - self.digits):
                    break
                if length > _FAR or not length < _SLOW * before:
                    rates = []
                before = length
            else:
                if now:
                    raise ArithmeticError(f"no solution next to {list(start)} at {dict(point)}")
            return Answer(self, now, given, rates)

    def _rates(self, now: list[mpf], given: Given, at: Sequence[mpf]) -> list[list[mpf]]:
        """Differences of the conditions by each of the unknowns, a column each."""
        columns, step = [], _step()
        for i, v in enumerate(now):
            there = self.conditions([*now[:i], v * (1 + step), *now[i + 1 :]], given)
            columns.append([(q - p) / (v * step) for p, q in zip(at, there, strict=True)])
        return columns


@dataclass(frozen=True)
class Answer:
    """A solution: `numbers` are what is compared."""

    problem: Problem
    unknowns: list[mpf]
    given: Given
    rates: list[list[mpf]]

    @cached_property
    def numbers(self) -> list[mpf]:
        """What the function gives, in many digits."""
        with mpmath.workdps(self.problem.digits):
            return [mpmath.re(v) for v in self.problem.told(self.unknowns, self.given)]

    @cached_property
    def moved(self) -> list[float]:
        """Changes of these numbers per relative change of the inputs, summed over them."""
        with mpmath.workdps(self.problem.digits):
            total = [mpf(0)] * len(self.numbers)
            at = self.problem.conditions(self.unknowns, self.given)
            for name, value in self.given.items():
                if value:
                    given = {**self.given, name: value * (1 + _step())}
                    there = self.problem.conditions(self.unknowns, given)
                    back = [p - q for p, q in zip(at, there, strict=True)]
                    step = _solution(self.rates, back, self.unknowns) if back else []
                    unknowns = [v + d for v, d in zip(self.unknowns, step, strict=True)]
                    changed = zip(self.problem.told(unknowns, given), self.numbers, strict=True)
                    changes = [abs(mpmath.re(p) - q) / _step() for p, q in changed]
                    total = [t + d for t, d in zip(total, changes, strict=True)]
            return [float(t) for t in total]


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
            raise ArithmeticError("a condition that no unknown changes")
        rows.append([v / most for v in row])
    found = mpmath.lu_solve([row[:-1] for row in rows], [row[-1] for row in rows])
    return [v * size for v, size in zip(found, sizes, strict=True)]
