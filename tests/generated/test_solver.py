"""The stick zones of the package beside those of the independent solver, cycle by cycle."""

from pathlib import Path

import numpy as np
import pytest

from generated import wedge
from generated.runtime.types import Regime
from tests.measure.comparison.cases import EVERY, Compared, F
from tests.measure.comparison.table import row
from tests.measure.solver.explore import AROUND, VARYING_MOMENT, Kind, Point

FINDINGS = Path(__file__).parents[1] / "reference" / "FINDINGS.md"
"""Two maps of the upright wedge with mean load P = E* = phi = 1, f = 1/2 and dQ = 0.15."""

ONES = {"E_star": 1.0, "phi": 1.0}


@pytest.mark.enough("5.2*", "two radii, slip*")
@pytest.mark.slow
@pytest.mark.parametrize("case", EVERY, ids=lambda case: case.name)
def test_solver_and_exact_conditions_agree(case: Compared) -> None:
    """In the regime that is part of the cycle's name."""
    zone = case.module.stick_zone(*case.contacts, *case.changes, f=F, **case.law)
    known = {"large": Regime.LARGE, "reverses": Regime.MIXED}
    named = [regime for words, regime in known.items() if words in case.name]
    assert zone.regime == (named or [Regime.MODERATE])[0]
    assert np.isnan(zone.m) == ("reverses" in case.name)
    result = row(case, (12, 24, 48), (4, 8, 16))
    assert np.all(np.abs(np.subtract(result.solver, result.exact)) <= result.error)
    # if slip reverses, one slip zone is only a few elements long
    limit = 1e-2 if "reverses" in case.name else 1e-3
    assert np.all(np.array(result.error) < limit)


def mapped() -> list[list[str]]:
    """The lines of both maps: ranges, tension, m and n, error; the kind is the eighth."""
    found: list[list[str]] = []
    inside = False
    for text in FINDINGS.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in text.split("|")[1:-1]]
        if cells[:1] in (["M mean, range"], ["P range, M range"]):
            inside = True
        elif not cells:
            inside = False
        elif inside and cells[0] != "---":
            found.append(cells)
    return found


MAPS = [*zip([*VARYING_MOMENT, *AROUND], mapped(), strict=True)]


def test_zones_are_those_of_the_solver_and_returned_only_if_the_premise_holds() -> None:
    assert {Kind(cells[7]) for _, cells in MAPS} == set(Kind)
    for point, (ranges, tension, ends, error, *_, kind, _, _, _) in MAPS:
        loads = (point.mean, point.span) if point.load == 0 else (point.load, point.span)
        assert [float(v) for v in ranges.split(",")] in ([*loads], [point.load, point.span])
        assert float(tension) == point.tension
        zone = at(point)
        holds = Kind(kind) is Kind.HOLDS
        assert np.isfinite(zone.m) == np.isfinite(zone.n) == holds, point
        assert (zone.regime == Regime.MIXED) == (not holds), point
        if holds:
            off = np.abs(np.subtract((zone.m, zone.n), [float(v) for v in ends.split(",")]))
            assert np.all(off <= float(error)), point


def at(point: Point) -> wedge.StickZone:
    """The stick zone of the package."""
    known = point.cycle
    first, second = (wedge.contact(P, M, **ONES) for P, M in zip(known.P, known.M, strict=True))
    return wedge.stick_zone(first, second, known.dQ, known.dsigma, f=known.f, **ONES)
