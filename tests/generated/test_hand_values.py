"""The generated functions against values worked out by hand (tests/hand_values/*.md)."""

import importlib
import pkgutil
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
import pytest

from tests.hand_values.table import DIGITS, RESULTS, Row, read_table

ULPS = 4
AT_LEAST = {"K_T": 5, "L_T": 4, "stick_margin": 5, "slip_zones": 3}
"""Rows; the other functions have ten."""

TABLES = sorted((Path(__file__).parents[1] / "hand_values").glob("*.md"))
BODIES = [table.stem for table in TABLES]
ROWS = [row for table in TABLES for row in read_table(table)]
SECTIONS = [(body, function) for body in BODIES for function in RESULTS]


def body_module(name: str) -> ModuleType:
    return importlib.import_module(f"generated.{name}")


def generated_bodies() -> list[str]:
    """The public modules of the package that have a contact."""
    package = importlib.import_module("generated")
    names = (found.name for found in pkgutil.iter_modules(package.__path__))
    return [n for n in names if not n.startswith("_") and hasattr(body_module(n), "contact")]


def rows_of(body: str, function: str) -> list[Row]:
    return [row for row in ROWS if (row.body, row.function) == (body, function)]


def field_of(result: Any, function: str, field: str) -> np.ndarray:
    """One field of a result; a function with a single field returns it bare."""
    return np.asarray(result if len(RESULTS[function]) == 1 else getattr(result, field))


def agrees(got: float, expected: mpmath.mpf) -> bool:
    """Exactly for 0, infinity and NaN, otherwise to 4 units in the last place."""
    if mpmath.isnan(expected):
        return bool(np.isnan(got))
    if expected == 0 or mpmath.isinf(expected):
        return bool(got == expected)
    with mpmath.workdps(DIGITS):
        allowed = ULPS * mpmath.mpf(float(np.spacing(abs(float(expected)))))
        return bool(abs(mpmath.mpf(got) - expected) <= allowed)


def disagreements(row: Row, got: Iterable[tuple[str, float]]) -> list[str]:
    """A line for each field that differs from the row's."""
    return [
        f"{row.place}: {row}: {field} is {value!r}, by hand {mpmath.nstr(row.expected[field], 20)}"
        f" ({row.working})"
        for field, value in got
        if not agrees(value, row.expected[field])
    ]


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_value(row: Row) -> None:
    result = getattr(body_module(row.body), row.function)(**row.arguments)
    fields = {field: field_of(result, row.function, field) for field in row.expected}
    assert all(got.shape == () and got.dtype == np.float64 for got in fields.values())
    assert not disagreements(row, ((field, float(got)) for field, got in fields.items()))


@pytest.mark.parametrize(("body", "function"), SECTIONS)
def test_all_rows_in_one_call(body: str, function: str) -> None:
    """One call with arrays: what does not exist must do no harm to its neighbours."""
    rows = rows_of(body, function)
    columns = {name: np.array([row.arguments[name] for row in rows]) for name in rows[0].arguments}
    result = getattr(body_module(body), function)(**columns)
    wrong = [
        line
        for field in RESULTS[function]
        for row, got in zip(rows, field_of(result, function, field), strict=True)
        for line in disagreements(row, [(field, float(got))])
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize(("body", "function"), SECTIONS)
def test_enough_rows(body: str, function: str) -> None:
    """Every contract function that the tables can express is exported and has its rows."""
    assert function in body_module(body).__all__
    assert len(rows_of(body, function)) >= AT_LEAST.get(function, 10)


def test_the_bodies_of_the_tables_are_generated() -> None:
    assert set(BODIES) <= set(generated_bodies())


def test_ids_are_unique() -> None:
    assert len({str(row) for row in ROWS}) == len(ROWS)


@pytest.mark.parametrize(
    ("got", "expected", "verdict"),
    [
        (0.0, "0", True),
        (-0.0, "0", True),
        (5e-324, "0", False),
        (np.nan, "nan", True),
        (0.0, "nan", False),
        (np.nan, "0", False),
        (np.nan, "1", False),
        (np.inf, "inf", True),
        (-np.inf, "inf", False),
        (1e308, "inf", False),
        (np.inf, "1", False),
        (1 + 4 * 2.0**-52, "1", True),
        (1 + 5 * 2.0**-52, "1", False),
        (-1 - 4 * 2.0**-52, "-1", True),
        (-1 - 5 * 2.0**-52, "-1", False),
        (1.0, "-1", False),
    ],
)
def test_the_comparison_itself(got: float, expected: str, verdict: bool) -> None:
    assert agrees(got, mpmath.mpf(expected)) is verdict
