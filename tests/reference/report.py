"""The findings as Markdown: every figure in it is of the run that writes it."""

from collections import Counter
from collections.abc import Iterable, Sequence

import numpy as np

from tests.reference.cases import CLOSED, Known
from tests.reference.conditions import LARGE, MODERATE
from tests.reference.explore import (
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
from tests.reference.parallel import Work
from tests.reference.solver import reference
from tests.reference.stick import Zone

Row = list[str]

REFINED = ("Hertz, large, P and M vary", "tilted wedge, large, M varies")
"""Cycles on which elements and steps are refined one by one."""

CYCLES = len(CLOSED) + len(REFINED) + len(WINDOW) + len(VARYING_MOMENT) + len(AROUND)
"""How many items the work has."""


def findings(work: Work) -> str:
    """The whole file."""
    parts = [HEAD.strip(), *_closed(work), *_refined(work), *_window(work), *_maps(work)]
    return "\n\n".join(parts) + "\n"


HEAD = f"""# What the independent solver finds

Written by `python -m tests.reference`.  The solver shares no line with `derive` or `generated`.
Its finest meshes have {COUNTS[-1]} elements between two breaks, its half-cycle {STEPS[-1]} steps;
"±" is its own estimate of its error.  E* = 1 and f = 1/2 throughout, R = 1 or phi = 1.
"""

CLOSED_TEXT = """## Where the zone is known

Errors are at the worse end; the order is between the coarsest mesh and the finest.
"""

WINDOW_TEXT = """## Constant loads around the threshold

The upright wedge at P = 1, dQ = 0.3 f P; the threshold is dsigma = {:.6f}.  With
H = 8 dQ/(pi dsigma), slip on the right turns round inside the half-cycle where m + n passes H: the
moderate zone is exact up to a + n = H, the large one from m + n = H on, and between them, from
{:.4f} to {:.4f} of the threshold, the three phases of `mixed.py` are.  Which of them applies
follows from the loads alone; it is the regime in the table.  What follows "±" are distances of n
from the solver's.
"""

REFINED_TEXT = """## Elements and steps, one by one

The error at the worse end with so many elements between two breaks, and so many load steps a
half-cycle.  Where slip only grows, steps change nothing but where the edges' way is known.
"""

MAP_TEXT = """## Varying moment

The same wedge; M goes from its mean less half its range to its mean plus half of it while Q and
sigma rise.  The premise is asked of both half-cycles, from the loads alone: zones of partial
half-cycles grow inside both contacts, and shear that has not slipped yet stays within friction.
It is sufficient, not necessary: some zones whose premise fails are within the estimate, too.  Where
no zone inside both contacts meets the conditions, the kind tells where the solver's ends, within
its estimate:

* an edge runs ahead: at one edge it is all that touches always; slip does not follow the edge;
* sticks: it is all that touches always; what slips, if anything, is only what comes into contact
  and leaves it.

"off" is how far a zone is from the solver's at its worse end: that of the conditions, that of the
smallest ends over partial half-cycles there and back, and the exact one of loads P and M that stand
still at their means.
"""

AROUND_TEXT = """## Varying loads around the threshold

The same wedge and the same questions; P goes from 1 less half its range to 1 plus half of it, M
from minus half its range to half of it, while Q and sigma rise; the threshold is the one of P = 1.
A negative range is the cycle of the positive one from its other end: the zones have to agree.
"""


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table, numbers to the right; ValueError where a row is not as long as its head.

    >>> print(table(["case", "n"], [["a", "1"]]))
    | case | n |
    | --- | ---: |
    | a | 1 |
    """
    rule = ["---", *["---:"] * (len(head) - 1)]
    lines = [head, rule, *rows]
    if {len(line) for line in lines} != {len(head)}:
        raise ValueError(f"every row needs {len(head)} cells: {', '.join(head)}")
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _small(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:.1e}"


def _zone(zone: Zone) -> str:
    return "none" if np.isnan(zone.m) else f"{zone.m:.5f}, {zone.n:.5f}"


# ------------------------------------------------------------------ closed cases


def _closed(work: Work) -> list[str]:
    head = ["cycle", "m, n exact", *_meshes(), "±", "order", "rounds"]
    return [CLOSED_TEXT.strip(), table(head, work(_closed_row, CLOSED))]


def _meshes() -> Row:
    return [f"error, {count}" for count in COUNTS]


def _closed_row(known: Known) -> Row:
    found, exact = reference(known.case, COUNTS, STEPS), known.exact
    errors = np.abs(np.subtract(found.zones, exact)).max(axis=1)
    order = np.log(errors[0] / errors[-1]) / np.log(COUNTS[-1] / COUNTS[0])
    rounds = str(found.finest.cycle.rounds)
    figures = [*map(_small, errors), _small(max(found.error)), f"{order:.1f}", rounds]
    return [known.name, _zone(exact), *figures]


def _refined(work: Work) -> list[str]:
    cycles = [known for known in CLOSED if known.name in REFINED]
    head = ["cycle, refined", "steps", *_meshes()]
    rows = [row for rows in work(_refined_rows, cycles) for row in rows]
    return [REFINED_TEXT.strip(), table(head, rows)]


def _refined_rows(known: Known) -> list[Row]:
    return [[known.name, str(number), *_errors(known, number)] for number in (1, *STEPS)]


def _errors(known: Known, steps: int) -> Row:
    zones = reference(known.case, COUNTS, [steps] * len(COUNTS)).zones
    return [_small(error) for error in np.abs(np.subtract(zones, known.exact)).max(axis=1)]


# ------------------------------------------------------------------ constant loads


def _window(work: Work) -> list[str]:
    candidates = ["exact", "moderate", "large", "smallest of parts"]
    head = ["dsigma / threshold", "regime", "H", "m, n solver", "±", *candidates]
    text = WINDOW_TEXT.strip().format(threshold(), *window())
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
    moment, around = work(_explored, VARYING_MOMENT), work(_explored, AROUND)
    rows = [
        [f"{at.mean:g}, {at.span:g}", f"{at.tension:g}", *_figures(found)]
        for at, found in zip(VARYING_MOMENT, moment, strict=True)
    ]
    near = [
        [f"{at.load:g}, {at.span:g}", f"{at.tension:g}", *_figures(found)]
        for at, found in zip(AROUND, around, strict=True)
    ]
    return [
        MAP_TEXT.strip(),
        _summary(moment),
        table(["M mean, range", "dsigma / threshold", *FIGURES], rows),
        AROUND_TEXT.strip(),
        _summary(around),
        table(["P range, M range", "dsigma / threshold", *FIGURES], near),
    ]


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
    """What the premise says against what the solver finds, counted."""
    kinds = Counter(point.kind for point in points)

    def of(*some: Kind) -> list[Explored]:
        return [point for point in points if point.kind in some]

    holds, fails = of(Kind.HOLDS), of(Kind.SHRINKS, Kind.BEYOND)
    turning = [point for point in fails if point.best.shrinks]
    beyond = sum(point.off(point.best.zone) > point.estimate for point in fails)
    within = _worst(point.off(point.best.zone) / point.estimate for point in holds)
    least = _worst(point.off(point.smallest) / point.estimate for point in turning)
    coarsest = _worst(point.estimate for point in points)
    farthest = _worst(point.off(point.best.zone) for point in fails)
    return f"""\
* The premise holds in {len(holds)} of {len(points)} cycles.  There the conditions are off by at
  most {within:.2f} of the solver's estimate.
* In {len(fails)} it fails, though the conditions have a zone: a slip zone shrinks in
  {kinds[Kind.SHRINKS]}, shear passes friction in {kinds[Kind.BEYOND]}.  Of these zones {beyond}
  are off by more than the estimate, by up to {farthest:.1e}.
* In {len(turning)} of those the premise holds in one half-cycle, and in the other a zone only
  shrinks.  There the smallest ends over partial half-cycles are off by at most {least:.2f} of the
  estimate.
* In {kinds[Kind.AHEAD]} an edge runs ahead of slip, and in {kinds[Kind.STICKS]} all that touches
  always sticks; {kinds[Kind.OPEN]} are neither, without a zone that meets the conditions.
* The solver's estimate of its own error is {coarsest:.1e} or less."""


def _worst(values: Iterable[float]) -> float:
    return max(values, default=np.nan)
