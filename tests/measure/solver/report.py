"""The findings as Markdown; all numbers in it come from the run that writes it."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tests.measure.page import table
from tests.measure.solver.explore import (
    AROUND,
    COUNTS,
    STEPS,
    VARYING_MOMENT,
    WINDOW,
    Explored,
    Kind,
    Point,
    at_constant_loads,
    cycle,
    explored,
    narrowest,
    smallest,
    threshold,
    window,
)
from tests.reference.cases import CLOSED, Known
from tests.reference.conditions import LARGE, MODERATE
from tests.reference.solver import reference
from tests.reference.stick import Zone

Row = list[str]

Work = Callable[[Callable[[Any], Any], Sequence[Any]], list[Any]]
"""A function that works like `map`."""


def findings(work: Work) -> list[str]:
    """The parts of the page."""
    return [HEAD, *_closed(work), *_window(work), *_maps(work)]


HEAD = f"""# Results of the independent solver

Written by `make solver`.  The solver shares no code with `derive` or `generated`.
The finest meshes have {COUNTS[-1]} elements between two breaks, and {STEPS[-1]} load steps per
half-cycle.  "±" is the solver's estimate of its own error, and "rounds" is the number of cycles
until the shear traction repeats itself.  In all cycles E* = 1, f = 1/2, and R = 1 or phi = 1.
"""

CLOSED_TEXT = """## Known stick zones

Errors are those of the worse end of the zone.  The order of convergence is that between the
coarsest and the finest mesh.
"""

WINDOW_TEXT = """## Constant loads around the threshold

The upright wedge at P = 1, dQ = 0.3 f P.  The threshold is dsigma = {:.6f}.  Let
H = 8 dQ/(pi dsigma).  Slip on the right reverses within the half-cycle if m + n passes through H.
The zone of moderate tension is exact if a + n <= H, and that of large tension if m + n >= H.
Between them, from {:.4f} to {:.4f} of the threshold, the solution in three phases in `mixed.py` is
exact ("turns round").  The loads alone determine which of the three applies; this is the regime in
the table.  The columns after "±" are differences from the solver's n.
"""

MAP_TEXT = """## Varying moment

The wedge is the same.  M varies from its mean minus half its range to its mean plus half its range
while Q and sigma rise.  The premise of the conditions is evaluated for both half-cycles, from the
loads alone.  It holds if the slip zones of partial half-cycles grow inside both contacts, and if
the shear traction stays within the friction bound where slip has yet to begin.  The premise is
sufficient but not necessary: some zones are within the estimate although it fails.  If no zone
inside both contacts satisfies the conditions, the kind is "no zone" or describes the solver's zone,
within its estimate:

* an edge runs ahead: at one end, the zone extends to the limit of permanent contact, because slip
  does not follow the edge;
* sticks: this is so at both ends; if anything slips, it is a region that comes into contact and
  leaves it again.

"off" is the difference from the solver's zone at the worse end.  It is given for the zone of the
conditions, for the smallest m and n of partial half-cycles in both directions ("smallest"), and for
the exact zone of P and M that are constant at their means ("constant").
"""

AROUND_TEXT = """## Varying loads around the threshold

The wedge and the columns are the same.  While Q and sigma rise, P varies from 1 minus half its
range to 1 plus half its range, and M from minus half its range to plus half its range.  The
threshold is that of P = 1.  A cycle with a negative range is the cycle with the positive range,
started at its other end, so that the zones must agree.
"""


def _small(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:.1e}"


def _zone(zone: Zone) -> str:
    return "none" if np.isnan(zone.m) else f"{zone.m:.5f}, {zone.n:.5f}"


# ------------------------------------------------------------------ closed cases


def _closed(work: Work) -> list[str]:
    head = ["cycle", "m, n exact", *_meshes(), "±", "order", "rounds"]
    return [CLOSED_TEXT, table(head, work(_closed_row, CLOSED))]


def _meshes() -> Row:
    return [f"error, {count}" for count in COUNTS]


def _closed_row(known: Known) -> Row:
    found, exact = reference(known.case, COUNTS, STEPS), known.exact
    errors = np.abs(np.subtract(found.zones, exact)).max(axis=1)
    order = np.log(errors[0] / errors[-1]) / np.log(COUNTS[-1] / COUNTS[0])
    rounds = str(found.finest.cycle.rounds)
    figures = [*map(_small, errors), _small(max(found.error)), f"{order:.1f}", rounds]
    return [known.name, _zone(exact), *figures]


# ------------------------------------------------------------------ constant loads


def _window(work: Work) -> list[str]:
    candidates = ["exact", "moderate", "large", "smallest of parts"]
    head = ["dsigma / threshold", "regime", "H", "m, n solver", "±", *candidates]
    text = WINDOW_TEXT.format(threshold(), *window())
    return [text, table(head, work(_window_row, WINDOW))]


def _window_row(part: float) -> Row:
    known = cycle(part * threshold())
    half, found = known.half_cycle, reference(known.case, COUNTS, STEPS)
    regime, exact = at_constant_loads(half)
    candidates = exact, half.exact(MODERATE), half.exact(LARGE), smallest(half)
    return [
        f"{part:g}",
        regime,
        f"{narrowest(known.dsigma):.5f}",
        _zone(found.zone),
        _small(found.error.n),
        *(_small(abs(zone.n - found.zone.n)) for zone in candidates),
    ]


# ------------------------------------------------------------------ varying loads

FIGURES = [
    "m, n solver",
    "±",
    "off",
    "smallest, off",
    "constant, off",
    "kind",
    "premise there",
    "and back",
    "rounds",
]


def _maps(work: Work) -> list[str]:
    parts = []
    for text, head, points in (
        (MAP_TEXT, "M mean, range", VARYING_MOMENT),
        (AROUND_TEXT, "P range, M range", AROUND),
    ):
        found = work(_explored, points)
        rows = [
            [f"{at.mean or at.load:g}, {at.span:g}", f"{at.tension:g}", *_figures(of)]
            for at, of in zip(points, found, strict=True)
        ]
        parts += [text, _summary(found), table([head, "dsigma / threshold", *FIGURES], rows)]
    return parts


def _explored(point: Point) -> Explored:
    return explored(point.cycle)


def _figures(found: Explored) -> Row:
    best = found.best
    return [
        _zone(found.zone),
        _small(found.estimate),
        _small(found.off(best.zone)),
        _small(found.off(found.smallest)),
        _small(found.off(found.constant)),
        found.kind.value,
        best.there.value,
        best.back.value,
        str(found.rounds),
    ]


def _summary(points: Sequence[Explored]) -> str:
    """How often the premise holds, and how close the solver is then."""
    holds = [point for point in points if point.kind is Kind.HOLDS]
    within = max(point.off(point.best.zone) / point.estimate for point in holds)
    coarsest = max(point.estimate for point in points)
    return f"""\
The premise holds in {len(holds)} of {len(points)} cycles.  In these the zone of the conditions
differs from the solver's by at most {within:.2f} of the solver's estimate of its own error.  This
estimate is at most {coarsest:.1e} in all cycles."""
