"""Cycles of the wedge around its threshold: the slip zone by the solver and by other methods."""

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
"""Cycles around the threshold: at constant normal loads, and with small changes of P and M."""

CANDIDATES = ("exact", "smallest of parts", "order 1", "order 2")


class Row(NamedTuple):
    """The right slip zone of the contact at the end of the half-cycle, by several methods.

    solver     by the independent solver, and the estimate of its error
    exact      by the package; NaN if it has no exact solution
    smallest   by the smallest m and n of partial half-cycles in either regime
    first      by the series of order 1
    second     by the series of order 2
    """

    point: Point
    solver: float
    error: float
    exact: float
    smallest: float
    first: float
    second: float


def row(point: Point) -> Row:
    """The results for one cycle of the upright wedge around the threshold."""
    known = point.cycle
    result, law = reference(known.case, FINE, STEPS), {"E_star": 1.0, "phi": 1.0}
    first, second = (wedge.contact(P, M, **law) for P, M in zip(known.P, known.M, strict=True))
    given = {"f": known.f, **law}
    zone = wedge.stick_zone(first, second, known.dQ, known.dsigma, **given, mixed=True)
    moved = {"da": second.a - first.a, "dc": second.c - first.c}
    loads = second.a, second.c, known.dQ, known.dsigma
    series = [wedge.slip_zones(*loads, **given, **moved, order=order) for order in (1, 2)]
    zones = [result.zone.n, float(zone.n), smallest(known.half_cycle).n]
    solver, exact, least = (float(second.c) - n for n in zones)
    orders = (float(zones.right) for zones in series)
    return Row(point, solver, result.error.n, exact, least, *orders)


def markdown(rows: Iterable[Row]) -> str:
    """The table in Markdown; results other than the solver's are errors in per cent of it."""
    lines = [
        "## Around the threshold",
        "",
        "The upright wedge at P = E* = phi = 1, f = 1/2, dQ = 0.15.  Tensions are relative to",
        "the threshold at which the right slip zone closes.  `solver` is the length of this slip",
        "zone, and `+-` the estimate of its error.  The last four columns are the differences of",
        "other results from it: the exact zone of `stick_zone(..., mixed=True)`, which is",
        "available at constant normal loads; the smallest stick zone of all partial half-cycles",
        "in either regime; and the series.  A range of P or M is its change while the shear load",
        "rises; a negative one means that it falls.  `none` means that there is no solution.",
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
