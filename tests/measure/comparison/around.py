"""Cycles of the wedge around its threshold: the slip zone by the solver and by other methods."""

from typing import NamedTuple

from tests.measure.comparison.cases import Compared, F
from tests.measure.comparison.table import FINE, Row, percent
from tests.measure.comparison.table import row as compared
from tests.measure.solver.explore import WINDOW, Point, smallest

CYCLES = [
    *(Point(part, 0.0, 0.0) for part in WINDOW if 0.93 < part < 1.09),
    *(
        Point(part, 0.0, span, load)
        for load, span in ((-0.005, 0.0), (0.005, 0.0), (0.01, 0.0), (0.0, 0.005), (0.0, 0.01))
        for part in (0.95, 1.0, 1.05)
    ),
]
"""Cycles around the threshold: at constant normal loads, and with small changes of P and M."""


class Around(NamedTuple):
    """A cycle of the upright wedge, and its slip zones.

    smallest  the right slip zone by the smallest n of partial half-cycles in either regime
    """

    point: Point
    row: Row
    smallest: float


def row(point: Point) -> Around:
    """The results for one cycle."""
    known = point.cycle
    case = Compared("", "wedge", known.P, known.M, known.dQ / F, point.tension, closing=True)
    least = float(case.contacts[1].c) - smallest(known.half_cycle).n
    return Around(point, compared(case, FINE), least)


TEXT = """
## Around the threshold

The upright wedge at P = E* = phi = 1, f = 1/2, dQ = 0.15.  Tensions are relative to
the threshold at which the right slip zone closes.  `solver` is the length of this slip
zone, and `+-` the estimate of its error.  The last four columns are the differences of
other results from it: the exact zone of `stick_zone(..., mixed=True)`, which is
available at constant normal loads; the smallest stick zone of all partial half-cycles
in either regime; and the series.  A range of P or M is its change while the shear load
rises; a negative one means that it falls.  `none` means that there is no solution.
"""


def shown(found: Around) -> list[str]:
    """The cells; results other than the solver's are errors in per cent of it."""
    at, row, least = found
    solver, error, exact, _, *series = (pair[1] for pair in row[1:])
    off = (percent(d / solver - 1) for d in (exact, least, *series))
    return [
        f"{at.load:g}",
        f"{at.span:g}",
        f"{at.tension:g}",
        f"{solver:.5f}",
        f"{error:.1e}",
        *off,
    ]


HEAD = ["range of P", "range of M", "tension", "solver", "+-"]
HEAD += ["exact", "smallest of parts", "order 1", "order 2"]
