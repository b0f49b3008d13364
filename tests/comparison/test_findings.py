"""Stick zones of the package against those of the independent solver, cycle by cycle.

FINDINGS.md contains the results of `make solver`: two maps of the upright wedge with mean load
P = E* = phi = 1, f = 1/2 and dQ = 0.15.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from generated import wedge
from generated.runtime.types import Regime
from tests.reference import explore
from tests.reference.explore import AROUND, VARYING_MOMENT, Kind, Point, threshold

FINDINGS = Path(explore.__file__).with_name("FINDINGS.md")

GIVEN = {"f": 0.5, "E_star": 1.0, "phi": 1.0}


class Line(NamedTuple):
    """One line of a map: a cycle, and the solver's stick zone with its error and kind."""

    point: Point
    m: float
    n: float
    error: float
    kind: Kind


def lines() -> list[Line]:
    """All lines of both maps."""
    maps: dict[str, list[list[str]]] = {"M mean, range": [], "P range, M range": []}
    rows: list[list[str]] = []
    for text in FINDINGS.read_text(encoding="utf-8").splitlines():
        row = [cell.strip() for cell in text.split("|")[1:-1]]
        if row and row[0] in maps:
            rows = maps[row[0]]
        elif not row:
            rows = []  # outside the maps
        elif row[0] != "---":
            rows.append(row)
    return [*map(_of_moment, maps["M mean, range"]), *map(_around, maps["P range, M range"])]


def _of_moment(row: list[str]) -> Line:
    mean, span = (float(word) for word in row[0].split(","))
    return _line(Point(float(row[1]), mean, span), row)


def _around(row: list[str]) -> Line:
    load, span = (float(word) for word in row[0].split(","))
    return _line(Point(float(row[1]), 0.0, span, load), row)


def _line(point: Point, row: list[str]) -> Line:
    m, n = (float(word) for word in row[2].split(","))
    return Line(point, m, n, float(row[3]), Kind(row[7]))


def zone(point: Point) -> wedge.StickZone:
    """The stick zone of the package."""
    known = point.cycle
    law = {"E_star": 1.0, "phi": 1.0}
    ends = (wedge.contact(P, M, **law) for P, M in zip(known.P, known.M, strict=True))
    return wedge.stick_zone(*ends, known.dQ, point.tension * threshold(), **GIVEN)


LINES = lines()
EACH = pytest.mark.parametrize(
    "line",
    [
        pytest.param(line, marks=() if i % 6 == 0 else pytest.mark.thorough)
        for i, line in enumerate(LINES)
    ],
    ids=lambda line: "-".join(map(str, line.point)),
)


def test_both_maps_are_complete() -> None:
    assert [line.point for line in LINES] == [*VARYING_MOMENT, *AROUND]


@EACH
def test_a_zone_is_that_of_the_solver_and_returned_only_if_the_premise_holds(line: Line) -> None:
    result = zone(line.point)
    if np.isfinite(result.m):
        assert abs(result.m - line.m) <= line.error
        assert abs(result.n - line.n) <= line.error
    assert np.isfinite(result.m) == np.isfinite(result.n) == (line.kind is Kind.HOLDS)
    assert (result.regime == Regime.MIXED) == (line.kind is not Kind.HOLDS)


def test_the_maps_contain_cycles_of_every_kind() -> None:
    assert {line.kind for line in LINES} == set(Kind)
