"""Around the threshold of the wedge: the solver, and all that may tell its slip zone."""

from collections.abc import Iterable
from typing import NamedTuple

from generated import wedge
from tests.comparison.table import FINE, STEPS, percent
from tests.reference.explore import WINDOW, Point, smallest
from tests.reference.solver import reference

CYCLES = [
    *(Point(part, 0.0, 0.0) for part in WINDOW if 0.93 < part < 1.09),
    *(
        Point(part, 0.0, span, load)
        for load, span in ((-0.005, 0.0), (0.005, 0.0), (0.01, 0.0), (0.0, 0.005), (0.0, 0.01))
        for part in (0.95, 1.0, 1.05)
    ),
]
"""Cycles around the threshold: at constant loads, and with small changes of P and M."""

CANDIDATES = ("exact", "smallest of parts", "order 1", "order 2")


class Row(NamedTuple):
    """The right slip zone of the contact at the end of the half-cycle, by all that may tell it.

    exact      of the package; NaN where it has none
    smallest   from the smallest ends of zones over partial half-cycles, both regimes
    """

    point: Point
    solver: float
    error: float
    exact: float
    smallest: float
    first: float
    second: float


def row(point: Point) -> Row:
    """One cycle of the upright wedge around the threshold."""
    known = point.cycle
    found, law = reference(known.case, FINE, STEPS), {"E_star": 1.0, "phi": 1.0}
    first, second = (wedge.contact(P, M, **law) for P, M in zip(known.P, known.M, strict=True))
    given = {"f": known.f, **law}
    zone = wedge.stick_zone(first, second, known.dQ, known.dsigma, **given, mixed=True)
    moved = {"da": second.a - first.a, "dc": second.c - first.c}
    loads = second.a, second.c, known.dQ, known.dsigma
    series = [wedge.slip_zones(*loads, **given, **moved, order=order) for order in (1, 2)]
    zones = [found.zone.n, float(zone.n), smallest(known.half_cycle).n]
    solver, exact, least = (float(second.c) - n for n in zones)
    orders = (float(zones.right) for zones in series)
    return Row(point, solver, found.error.n, exact, least, *orders)


def markdown(rows: Iterable[Row]) -> str:
    """The table; what stands behind the solver's slip zone is off from it, in per cent."""
    lines = [
        "## Around the threshold",
        "",
        "The upright wedge at P = E* = phi = 1, f = 1/2, dQ = 0.15; tension over the threshold at",
        "which the right slip zone closes.  That slip zone by the solver, and by how much each",
        "candidate is off from it: the exact one of `stick_zone(..., mixed=True)`, which has one",
        "at constant loads; the smallest stick zone over partial half-cycles of either regime; and",
        "the series.  A negative range falls while shear rises.",
        "",
        f"| range of P | range of M | tension | solver | +- | {' | '.join(CANDIDATES)} |",
        "|" + " ---: |" * (5 + len(CANDIDATES)),
    ]
    for row in rows:
        at = row.point
        candidates = (row.exact, row.smallest, row.first, row.second)
        off = " | ".join(percent(d / row.solver - 1) for d in candidates)
        lines.append(
            f"| {at.load:g} | {at.span:g} | {at.tension:g} | {row.solver:.5f} | {row.error:.1e} | "
            f"{off} |"
        )
    return "\n".join(lines) + "\n"
