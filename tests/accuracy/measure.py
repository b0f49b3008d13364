"""Errors of generated functions in units in the last place, region by region."""

import importlib
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import mpmath
import numpy as np
from mpmath import mpf
from sympy import Expr, lambdify

from derive.codegen.contract import CONTRACT, Function
from derive.codegen.integrated import keeps_its_digits
from derive.codegen.parabolas import is_parabolic
from derive.proof.points import numeric
from tests.accuracy.cycles import CYCLES, Cycle
from tests.accuracy.inverses import INVERSES
from tests.accuracy.reference import Conditions, Point, condition, exact, sheet_of, solved
from tests.accuracy.regions import Regions, Sample
from tests.paper_forms import FORMS

CLOSED, PARTS, INTEGRATED, SOLVED, CYCLE = "closed", "by parts", "integrated", "solved", "cycle"
"""How a function computes: a formula; sums over the parts between kinks; quadrature; Newton's
method; the conditions of partial slip."""

LIMITS = {
    CLOSED: 4.0,
    PARTS: 4.0,
    INTEGRATED: 64.0,
    SOLVED: 64.0,
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


SHARES = {CLOSED: 1.0, PARTS: 1.0, SOLVED: 0.1, INTEGRATED: 0.005}
"""How many points are tried in a region, in parts of those asked for: some references are dear."""


def functions(body: str) -> Iterator[str]:
    """Every function of one body that is measured."""
    yield from (f.name for f in CONTRACT)
    yield from (cycle.name for cycle in CYCLES if cycle.takes(sheet_of(body)))


def worst_of(body: str, count: int, only: str = "") -> Iterator[Worst]:
    """Every function of one body, or one of them, over all its regions."""
    for name in functions(body):
        if only in ("", name):
            kind = kind_of(body, name)
            cycle = next((c for c in CYCLES if c.name == name), None)
            share = cycle.share if cycle else SHARES[kind]
            integrated = not sheet_of(body).geometry.slope.is_polynomial
            if kind == SOLVED and integrated:
                share = SHARES[INTEGRATED] / 2  # each is many integrals
            points = max(1, round(share * count))
            regions = Regions(sheet_of(body), importlib.import_module(f"generated.{body}"), points)
            for region, sample in cycle.regions(regions) if cycle else regions.of(name):
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
        of = _by_integrals(expr) if kind == INTEGRATED else _by_formula(body, expr)
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


def _by_integrals(expr: Expr) -> _Reference:
    """The defining integrals, by the rule of the proofs."""
    function, step = numeric(expr), mpf(10) ** -15
    names = {str(s): s for s in expr.free_symbols}

    def value(point: Point) -> mpf:
        with mpmath.workdps(40):
            known = {s: mpf(point[n]) for n, s in names.items() if n in point}
            return function(known | {s: mpf(1) for n, s in _edges.items() if n not in names})

    def conditioned(_: int, point: Point) -> float:
        with mpmath.workdps(40):
            at = value(point)
            moved = (value({**point, n: mpf(v) * (1 + step)}) for n, v in point.items())
            return max(1.0, float(sum(abs((v - at) / (step * at)) for v in moved)))

    _edges: dict[str, Any] = {}
    return _Reference(value, conditioned)


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


def _inverses(body: str, name: str, region: str, sample: Sample) -> Iterator[Worst]:
    sheet, inverse = sheet_of(body), INVERSES[name]
    digits = 50 if sheet.geometry.slope.is_polynomial else 36
    names = [*inverse.arguments, "E_star", *(q.name for q in sheet.geometry.parameters)]
    given = {n: sample[n] for n in names}
    result = getattr(importlib.import_module(f"generated.{body}"), name)(**given)
    points, found = _points(given), list(zip(result.a, result.c, strict=True))
    answers = [
        _answer(inverse.conditions(body), edges, point, digits)
        for edges, point in zip(found, points, strict=True)
    ]
    for i, field in enumerate("ac"):
        yield _of_answers(
            (body, name, field, region, SOLVED), getattr(result, field), points, answers, i
        )


def _cycles(body: str, region: str, sample: Sample, cycle: Cycle) -> Iterator[Worst]:
    module = importlib.import_module(f"generated.{body}")
    results, points = cycle.results(module, sample), _points(sample)
    answers = [
        _answer(cycle.conditions(body), start, point, cycle.digits)
        for start, point in zip(zip(*results, strict=True), points, strict=True)
    ]
    for i, field in enumerate(cycle.fields):
        got = results[i]
        yield _of_answers((body, cycle.name, field, region, CYCLE), got, points, answers, i)


def _answer(conditions: Conditions, start: Sequence[float], point: Point, digits: int) -> Any:
    """The solution next to what a function gave; None where there is none."""
    if not np.isfinite(start[0]):
        return None
    try:
        return solved(conditions, start, point, digits)
    except ArithmeticError:
        return None


def _of_answers(
    names: tuple[str, ...], got: Any, points: list[Point], answers: list[Any], i: int
) -> Worst:
    """The worst of one unknown; what was not solved is lost."""
    there = [k for k, answer in enumerate(answers) if answer is not None]
    row = _worst(
        names,
        np.array([got[k] for k in there]),
        [points[k] for k in there],
        [answers[k][0][i] for k in there],
        lambda k, _: answers[there[k]][1][i],
        None,
        lost=len(answers) - len(there),
    )
    return row


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
