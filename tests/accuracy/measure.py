"""Errors of generated functions in units in the last place, region by region."""

import importlib
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import mpmath
import numpy as np
from mpmath import mpf
from sympy import Expr, lambdify

from derive.codegen.contract import CONTRACT, Function
from derive.codegen.integrated import keeps_its_digits
from derive.codegen.parabolas import is_parabolic
from tests.accuracy.cycles import CYCLES, Cycle
from tests.accuracy.definitions import formula
from tests.accuracy.inverses import INVERSES
from tests.accuracy.reference import Answer, Point, Problem, condition, exact, sheet_of
from tests.accuracy.regions import Regions, Sample
from tests.paper_forms import FORMS

CLOSED, PARTS, INTEGRATED, SOLVED, CYCLE = "closed", "by parts", "integrated", "solved", "cycle"
"""How a function computes: a formula; sums over the parts between kinks; quadrature; Newton's
method; the conditions of partial slip."""

LIMITS = {
    CLOSED: 4.0,
    PARTS: 4.0,
    INTEGRATED: 64.0,
    SOLVED: 4.0,
    CYCLE: 64.0,
}
"""Largest error over the condition of the problem, in units in the last place."""

WELL = 10.0
"""A problem of a smaller condition is well conditioned."""


@dataclass(frozen=True)
class Worst:
    """The worst of one output in one region.

    points      how many were tried
    lost        how many of them gave no number
    ulp         largest error, and `condition` of the problem there, at `point`
    well        largest error where the problem is well conditioned
    excess      largest error over the condition, which explains that much, at `over`
    paper       worst error of the paper's printed form, None where it prints none
    """

    body: str
    function: str
    output: str
    region: str
    kind: str
    points: int
    lost: int
    ulp: float
    condition: float
    point: Point
    well: float
    excess: float
    over: Point
    paper: float | None = None


def ulps(value: float, reference: mpf) -> float:
    """|value - reference| in units in the last place of the reference."""
    nearest = float(reference)
    if not np.isfinite(value) or not np.isfinite(nearest):
        return np.inf
    with mpmath.workdps(60):
        return float(abs(mpf(value) - reference) / mpf(np.spacing(abs(nearest))))


@cache
def kind_of(body: str, function: str) -> str:
    """How a function of a body computes."""
    sheet = sheet_of(body)
    its = next((f for f in CONTRACT if f.name == function), None)
    if its is None:
        return CYCLE
    if not its.available(sheet):
        return SOLVED
    if not all(sheet.is_closed(name) for name in its.formulas):
        return INTEGRATED
    by_parts = its.geometric and is_parabolic(sheet) and not keeps_its_digits(sheet, function)
    return PARTS if by_parts else CLOSED


SHARES = {CLOSED: 1.0, PARTS: 1.0, SOLVED: 0.1, INTEGRATED: 0.05}
"""How many points are tried in a region, in parts of those asked for: some references are dear."""


def functions(body: str) -> Iterator[str]:
    """Every function of one body that is measured."""
    yield from (f.name for f in CONTRACT)
    yield from (cycle.name for cycle in CYCLES if cycle.takes(sheet_of(body)))


def share_of(body: str, name: str) -> float:
    """Of the points asked for, those that are tried of one function."""
    cycle = next((c for c in CYCLES if c.name == name), None)
    kind = kind_of(body, name)
    share = cycle.share if cycle else SHARES[kind]
    dear = kind != CLOSED and not sheet_of(body).geometry.slope.is_polynomial
    return min(share, SHARES[INTEGRATED]) if dear else share


def worst_of(body: str, count: int, only: str = "") -> Iterator[Worst]:
    """Every function of one body, or one of them, over all its regions."""
    for name in functions(body):
        if only in ("", name):
            kind = kind_of(body, name)
            cycle = next((c for c in CYCLES if c.name == name), None)
            integrated = not sheet_of(body).geometry.slope.is_polynomial
            points = max(1, round(share_of(body, name) * count))
            regions = Regions(sheet_of(body), importlib.import_module(f"generated.{body}"), points)
            for region, sample in cycle.where(regions) if cycle else regions.of(name):
                if integrated and "extreme widths" in region:
                    continue  # the proofs' quadrature does not reach so far
                if len(next(iter(sample.values()))):
                    yield from _measured(body, name, kind, region, sample, cycle)


def _measured(
    body: str, name: str, kind: str, region: str, sample: Sample, cycle: Cycle | None
) -> Iterator[Worst]:
    function = next((f for f in CONTRACT if f.name == name), None)
    if cycle is not None:
        yield from _cycles(body, region, sample, cycle)
    elif kind == SOLVED:
        yield from _inverses(body, name, region, sample)
    elif function is not None:
        yield from _formulas(body, kind, region, sample, function)


# ------------------------------------------------------------------ formulas


def _formulas(
    body: str, kind: str, region: str, sample: Sample, function: Function
) -> Iterator[Worst]:
    sheet = sheet_of(body)
    names = [str(s) for s in (*function.arguments, *function.keywords(sheet))]
    given = {name: sample[name] for name in names}
    module = importlib.import_module(f"generated.{body}")
    result = getattr(module, function.name)(**given)
    points = _points(given)
    for field, expr in function.outputs(sheet).items():
        if field and expr.is_Symbol:
            continue  # an argument, handed back
        expr = sheet.frame.flat(expr)
        got = getattr(result, field) if field else result
        if kind == INTEGRATED:
            of = _by_integrals(body, dict(function.fields)[field])
        else:
            of = _by_formula(body, expr)
        yield _worst(
            (body, function.name, field, region, kind),
            got,
            points,
            [of.value(point) for point in points],
            of.condition,
            _paper(body, function.name, field, given) if kind == CLOSED else None,
        )


@dataclass(frozen=True)
class _Reference:
    value: Callable[[Point], mpf]
    condition: Callable[[int, Point], float]


@cache
def _by_formula(body: str, expr: Expr) -> _Reference:
    kinks = [k.position for k in sheet_of(body).geometry.slope.kinks]

    def beside(point: Point) -> Point:
        """x beside a kink by nothing to speak of: there a formula is zero times infinity."""
        if "x" in point and any(exact(place, point) == point["x"] for place in kinks):
            with mpmath.workdps(400):
                return {**point, "x": mpf(point["x"]) + mpf(10) ** -300}
        return point

    return _Reference(
        lambda point: exact(expr, beside(point)),
        lambda _, point: max(1.0, condition(expr, beside(point))),
    )


@cache
def _by_integrals(body: str, name: str) -> _Reference:
    """The defining integrals."""
    of = formula(body, name)

    def problem() -> Problem:
        return Problem(lambda _, __: [], lambda _, given: [of(**given)], digits=_digits(body))

    @cache
    def answer(point: tuple[tuple[str, float], ...]) -> Answer:
        return problem().answer([], dict(point))

    return _Reference(
        lambda point: answer(tuple(point.items())).numbers[0],
        lambda _, point: answer(tuple(point.items())).conditions[0],
    )


def _paper(
    body: str, function: str, field: str, given: Sample
) -> Callable[[list[mpf]], float] | None:
    expr: Expr | None = FORMS.get(body, {}).get(function, {}).get(field)
    if expr is None:
        return None
    held = sorted(expr.free_symbols, key=str)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        values = lambdify(held, expr, modules="numpy")(*(given[str(s)] for s in held))
    return lambda references: max(
        ulps(float(v), r) for v, r in zip(values, references, strict=True)
    )


# ------------------------------------------------------------------ what is solved


def _digits(body: str) -> int:
    """Of what is solved for."""
    return 50 if sheet_of(body).geometry.slope.is_polynomial else 36


def _inverses(body: str, name: str, region: str, sample: Sample) -> Iterator[Worst]:
    sheet, inverse = sheet_of(body), INVERSES[name]
    names = [*inverse.arguments, "E_star", *(q.name for q in sheet.geometry.parameters)]
    given = {n: sample[n] for n in names}
    result = getattr(importlib.import_module(f"generated.{body}"), name)(**given)
    found = result.a, result.c
    problem = inverse.problem(body, _digits(body))
    yield from _answered((body, name), ("a", "c"), region, SOLVED, given, found, found, problem)


def _cycles(body: str, region: str, sample: Sample, cycle: Cycle) -> Iterator[Worst]:
    module = importlib.import_module(f"generated.{body}")
    results = cycle.results(module, sample)
    starts = cycle.starts(module, sample) if cycle.starts else results
    problem, names = cycle.of(body, _digits(body)), (body, cycle.name)
    yield from _answered(names, cycle.fields, region, CYCLE, sample, results, starts, problem)


def _answered(
    names: tuple[str, str],
    fields: Sequence[str],
    region: str,
    kind: str,
    sample: Sample,
    results: Sequence[Any],
    starts: Sequence[Any],
    problem: Problem,
) -> Iterator[Worst]:
    """The worst of each number; what was not solved is lost."""
    points, begun = _points(sample), [*zip(*starts, strict=True)]
    given = np.all(np.isfinite(np.array(results, dtype=float)), axis=0)
    answers = {
        k: answer
        for k, point in enumerate(points)
        if given[k] and (answer := _answer(problem, begun[k], point)) is not None
    }
    there = [*answers]
    for i, field in enumerate(fields):
        yield _worst(
            (*names, field, region, kind),
            np.array([results[i][k] for k in there]),
            [points[k] for k in there],
            [answers[k].numbers[i] for k in there],
            lambda k, _, i=i: answers[there[k]].conditions[i],  # type: ignore[misc]
            None,
            lost=len(points) - len(there),
        )


def _answer(problem: Problem, start: Sequence[float], point: Point) -> Answer | None:
    """The solution next to what a function gave; None where there is none.

    Where many digits do not show it, beside a kink, twice as many may.
    """
    if not np.all(np.isfinite(start)):
        return None
    for digits in (problem.digits, 2 * problem.digits):
        try:
            return replace(problem, digits=digits).answer(start, point)
        except ArithmeticError:
            continue
    return None


# ------------------------------------------------------------------ the worst of many


def _points(given: Sample) -> list[Point]:
    count = len(next(iter(given.values())))
    return [{n: float(v[i]) for n, v in given.items()} for i in range(count)]


def _worst(
    names: tuple[str, ...],
    got: Any,
    points: list[Point],
    references: list[mpf],
    conditioned: Callable[[int, Point], float],
    paper: Callable[[list[mpf]], float] | None,
    lost: int = 0,
) -> Worst:
    if not points:
        return Worst(*names, lost, lost, 0.0, 1.0, {}, 0.0, 0.0, {})  # type: ignore[arg-type]
    errors = np.array([ulps(float(v), r) for v, r in zip(got, references, strict=True)])
    kappa = np.ones(len(errors))
    for i in np.flatnonzero(errors > 1):
        kappa[i] = conditioned(int(i), points[i])
    at, over = int(np.argmax(errors)), int(np.argmax(errors / kappa))
    if errors[at] <= 1:
        kappa[at] = conditioned(at, points[at])
    well = errors[kappa <= WELL]
    return Worst(
        *names,  # type: ignore[arg-type]
        len(points) + lost,
        lost,
        float(errors[at]),
        float(kappa[at]),
        points[at],
        float(np.max(well)) if well.size else 0.0,
        float(np.max(errors / np.maximum(kappa, 1))),
        points[over],
        paper(references) if paper else None,
    )


def worst_rows(rows: Iterable[Worst]) -> dict[tuple[str, str], list[Worst]]:
    """Rows by body and function."""
    found: dict[tuple[str, str], list[Worst]] = {}
    for row in rows:
        found.setdefault((row.body, row.function), []).append(row)
    return found
