"""The generated functions against values worked out by hand (tests/hand_values/*.md)."""

import importlib
from collections.abc import Iterable, Mapping
from itertools import product
from pathlib import Path
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
import pytest

from derive.body.library import library
from tests.hand_values.table import DIGITS, RESULTS, Row, read_table

ULPS = 4
ULPS_OF_SUMS = 64
"""1.4e-14, of bodies that are added up part by part, integrated or solved for."""

IN_FULL = ("hertz", "wedge")
"""Bodies whose tables have rows for every function; the others have those that are worth a row."""

ORDER_ONE = {"alpha": 0.5, "M": 0.5}
"""Slopes and levers that cancel: what a 0 is judged by, in rows whose numbers are of order one."""

NOT_OF_THE_PROFILE = ("dQ", "dsigma", "f", "E_star")

TABLES = sorted((Path(__file__).parents[1] / "hand_values").glob("*.md"))
ROWS = [row for table in TABLES for row in read_table(table)]
SECTIONS = sorted({(row.body, row.function) for row in ROWS})


def body_module(name: str) -> ModuleType:
    return importlib.import_module(f"generated.{name}")


def rows_of(body: str, function: str) -> list[Row]:
    return [row for row in ROWS if (row.body, row.function) == (body, function)]


def called(body: str, function: str, arguments: Mapping[str, Any]) -> Any:
    """What a body's function returns; stick_zone is given the edges of a contact that stays."""
    module = body_module(body)
    if function != "stick_zone":
        return getattr(module, function)(**arguments)
    edges = {name: arguments[name] for name in ("a", "c")}
    others = {name: value for name, value in arguments.items() if name not in edges}
    law = {name: value for name, value in others.items() if name not in NOT_OF_THE_PROFILE}
    contact = module.Contact(**edges, alpha=module.tilt(**edges, **law))
    return module.stick_zone(contact, contact, **others)


def field_of(result: Any, function: str, field: str) -> np.ndarray:
    """One field of a result; a function with a single field returns it bare."""
    return np.asarray(result if len(RESULTS[function]) == 1 else getattr(result, field))


def agrees(got: float, expected: mpmath.mpf, ulps: int = ULPS, scale: float = 0.0) -> bool:
    """To some units in the last place of the value, or of `scale` if that is more.

    Exactly for infinity and NaN, and for 0 without a scale.
    """
    if mpmath.isnan(expected):
        return bool(np.isnan(got))
    if mpmath.isinf(expected) or (expected == 0 and scale == 0):
        return bool(got == expected)
    with mpmath.workdps(DIGITS):
        unit = mpmath.mpf(float(np.spacing(max(abs(float(expected)), scale))))
        return bool(abs(mpmath.mpf(got) - expected) <= ulps * unit)


def right(row: Row, field: str, got: float) -> bool:
    """Whether a field agrees with the row.

    Outside the bodies in full, both edges are judged by the larger value, a tilt by the slope of
    the flanks if the body has one, and a 0 where others cancel by what they are.
    """
    if row.body in IN_FULL:
        return agrees(got, row.expected[field])
    if field == "alpha":
        peers = [value for name, value in row.arguments.items() if name.startswith("phi")]
    else:
        peers = [abs(float(value)) for name, value in row.expected.items() if name != "alpha"]
    scale = max(peers, default=0.0)
    if row.expected[field] == 0:
        scale = ORDER_ONE.get(field, scale)
    return agrees(got, row.expected[field], ULPS_OF_SUMS, scale)


def disagreements(row: Row, got: Iterable[tuple[str, float]]) -> list[str]:
    """A line for each field that differs from the row's."""
    return [
        f"{row.place}: {row}: {field} is {value!r}, by hand {mpmath.nstr(row.expected[field], 20)}"
        f" ({row.working})"
        for field, value in got
        if not right(row, field, value)
    ]


@pytest.mark.parametrize(("body", "function"), SECTIONS)
def test_values_row_by_row_and_all_in_one_call(body: str, function: str) -> None:
    """In a call with arrays what does not exist must do no harm to its neighbours."""
    rows, wrong = rows_of(body, function), []
    columns = {name: np.array([row.arguments[name] for row in rows]) for name in rows[0].arguments}
    together = called(body, function, columns)
    for i, row in enumerate(rows):
        alone = called(body, function, row.arguments)
        for field in row.expected:
            got = field_of(alone, function, field)
            assert got.shape == () and got.dtype == np.float64
            both = (got, field_of(together, function, field)[i])
            wrong += disagreements(row, ((field, float(value)) for value in both))
    assert not wrong, "\n".join(wrong)


def test_every_body_has_rows_for_what_depends_on_its_profile() -> None:
    own = {*RESULTS} - {"K_T", "L_T", "stick_margin"}
    assert {*SECTIONS} >= {*product(library(), own), *product(IN_FULL, RESULTS)}
