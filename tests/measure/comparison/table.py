"""Slip zones by the solver, the exact conditions and the series, cycle by cycle."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from generated.runtime.types import Contact, Regime
from tests.measure.comparison.cases import Compared, F
from tests.reference.solver import reference

COUNTS, STEPS = (16, 32, 64), (8, 16, 32)
FINE = (32, 64, 128)
"""Elements between breaks and load steps per half-cycle of the solver's meshes.  FINE is used for
both if slip reverses, because a slip zone may be smaller than an element otherwise."""


class Row(NamedTuple):
    """Slip zones of the contact at the end of the half-cycle, left and right.

    solver   by the independent solver
    error    the solver's estimate of its own error
    exact    by the exact conditions
    printed  order 1 with the K_T of a symmetric contact of half-width a or c, as in the paper
    first    by the series of order 1
    second   by the series of order 2
    """

    case: Compared
    solver: tuple[float, float]
    error: tuple[float, float]
    exact: tuple[float, float]
    printed: tuple[float, float]
    first: tuple[float, float]
    second: tuple[float, float]


def row(case: Compared, counts: Sequence[int] | None = None, steps: Sequence[int] = STEPS) -> Row:
    """The results for one cycle."""
    first, second = case.contacts
    shear, tension = case.changes
    given = {"f": F, **case.law}
    zone = case.module.stick_zone(first, second, shear, tension, **given, mixed=True)
    reverses = zone.regime == Regime.MIXED
    result = reference(case.case, counts or (FINE if reverses else COUNTS), steps)
    moved = {"da": second.a - first.a, "dc": second.c - first.c}
    orders = [
        case.module.slip_zones(second.a, second.c, shear, tension, **given, **moved, order=order)
        for order in (1, 2)
    ]
    edges = np.array([second.a, second.c])
    series = [(float(d.left), float(d.right)) for d in orders]
    return Row(
        case,
        _pair(edges - np.array(result.zone)),
        _pair(result.error),
        _pair(edges - np.array([zone.m, zone.n])),
        _pair(_printed(case, second, shear, tension) + np.array(list(moved.values())) / 2),
        *series,
    )


def _pair(values: Iterable[float]) -> tuple[float, float]:
    left, right = values
    return float(left), float(right)


def _printed(case: Compared, at: Contact, shear: float, tension: float) -> np.ndarray:
    """|K_T|/(f K_N), with K_T for a contact width of 2 a at the left and 2 c at the right edge."""
    widths = 2 * np.array([at.a, at.c])
    K_T = (shear / np.pi + np.array([1, -1]) * tension * widths / 8) / np.sqrt(widths)
    K_N = np.array(case.module.K_N(at.a, at.c, **case.law))
    return np.abs(K_T) / (F * K_N)


TEXT = """
# Slip zones by the independent solver, by the exact conditions, and by series

Written by `make comparison`.  The solver (tests/reference) shares no code with the
package; `+-` is the solver's estimate of its own error.  `solver` and `exact` are the
lengths of the slip zones of the contact at the end of the half-cycle, and `solver off`
is their difference.  The last three columns are the relative errors of the series.
`printed` is the first order with the K_T of a symmetric contact, as in the paper.  The
series do not allow for slip that reverses within the half-cycle.  They treat such a
cycle as one of moderate or large tension, depending on the sign of K_T, and may have
no solution (`none`).  Numbers in the names of these cycles are tensions relative to
8 dQ/(pi h).
"""
HEAD = ["cycle", "edge", "solver", "+-", "exact", "solver off", "printed", "order 1", "order 2"]


def shown(row: Row) -> Iterator[list[str]]:
    """The cells of both edges; the last three are errors relative to the exact slip zone."""
    for edge, pair in zip(("left", "right"), zip(*row[1:], strict=True), strict=True):
        solver, error, exact, *series = pair
        off = (percent(d / exact - 1) for d in series)
        figures = f"{solver:.5f}", f"{error:.1e}", f"{exact:.5f}", f"{abs(solver - exact):.1e}"
        yield [row.case.name, edge, *figures, *off]


def percent(part: float) -> str:
    """A fraction in per cent, or "none" if it is NaN.

    >>> percent(-0.123), percent(1.234), percent(float("nan"))
    ('-12 %', '123 %', 'none')
    """
    if np.isnan(part):
        return "none"
    if abs(part) < 1e-9:
        return "0 %"
    return f"{100 * part:{'.2g' if abs(part) < 0.995 else '.0f'}} %"
