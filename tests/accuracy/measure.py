"""Errors of generated functions in units in the last place, region by region."""

import importlib
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
from sympy import Expr, lambdify

from derive.codegen.contract import CONTRACT, Function
from tests.accuracy.reference import condition, exact, sheet_of
from tests.accuracy.regions import Regions, Sample
from tests.paper_forms import FORMS


@dataclass(frozen=True)
class Worst:
    """The worst point of one output in one region.

    ulp         error of the generated function there
    excess      largest error over what the conditioning explains, in the region
    paper       worst error of the paper's printed form in the region, None where it prints none
    """

    body: str
    function: str
    output: str
    region: str
    ulp: float
    excess: float
    condition: float
    point: Mapping[str, float]
    paper: float | None


def ulps(value: float, reference: mpmath.mpf) -> float:
    """|value - reference| in units in the last place of the reference."""
    nearest = float(reference)
    if not np.isfinite(value) or not np.isfinite(nearest):
        return np.inf
    with mpmath.workdps(60):
        return float(abs(mpmath.mpf(value) - reference) / mpmath.mpf(np.spacing(abs(nearest))))


def worst_of(body: str, count: int, only: str = "") -> Iterator[Worst]:
    """Every function of one body, or one of them, over all its regions."""
    module, sheet = importlib.import_module(f"generated.{body}"), sheet_of(body)
    regions = Regions(sheet, module, count)
    for function in CONTRACT:
        if function.available(sheet) and only in ("", function.name):
            for region, sample in regions.of(function.name):
                yield from _worst_in(body, module, function, region, sample)


def _worst_in(
    body: str, module: Any, function: Function, region: str, sample: Sample
) -> Iterator[Worst]:
    sheet = sheet_of(body)
    names = [str(s) for s in (*function.arguments, *function.keywords(sheet))]
    given = {name: sample[name] for name in names}
    result = getattr(module, function.name)(**given)
    for field, expr in function.outputs(sheet).items():
        expr = sheet.frame.flat(expr)
        got = getattr(result, field) if field else result
        points = [{n: float(v[i]) for n, v in given.items()} for i in range(len(got))]
        references = [exact(expr, point) for point in points]
        errors = np.array([ulps(v, r) for v, r in zip(got, references, strict=True)])
        at = int(np.argmax(errors))
        yield Worst(
            body,
            function.name,
            field,
            region,
            float(errors[at]),
            _excess(expr, points, errors),
            condition(expr, points[at]),
            points[at],
            _paper(body, function.name, field, given, references),
        )


def _excess(expr: Expr, points: list[dict[str, float]], errors: np.ndarray) -> float:
    """The largest error over its conditioning, which is asked for where it can matter only."""
    largest = max((float(error) for error in errors if error <= 1), default=0.0)
    for i in np.argsort(-errors):
        if errors[i] <= max(largest, 1):
            break
        largest = max(largest, float(errors[i]) / max(1.0, condition(expr, points[i])))
    return largest


def _paper(
    body: str, function: str, field: str, given: Sample, references: list[mpmath.mpf]
) -> float | None:
    expr: Expr | None = FORMS.get(body, {}).get(function, {}).get(field)
    if expr is None:
        return None
    held = sorted(expr.free_symbols, key=str)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        values = lambdify(held, expr, modules="numpy")(*(given[str(s)] for s in held))
    return max(ulps(float(v), r) for v, r in zip(values, references, strict=True))
