"""The findings as Markdown: every figure in it is of the run that writes it."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from tests.reference.cases import CLOSED, Known
from tests.reference.conditions import LARGE, MODERATE
from tests.reference.explore import (
    COUNTS,
    MEANS,
    RANGES,
    STEPS,
    TENSIONS,
    WINDOW,
    Explored,
    at_constant_loads,
    cycle,
    explored,
    narrowest,
    smallest,
    threshold,
    window,
)
from tests.reference.solver import reference
from tests.reference.stick import Zone

Step = Callable[[str], None]
"""Told what is done next, once a cycle."""

COARSE = 1e-3
"""An estimate from which on the solver has not settled the matter."""

MAP = [(mean, span, part) for mean in MEANS for span in RANGES for part in TENSIONS]

CYCLES = len(CLOSED) + len(WINDOW) + len(MAP)
"""How often `Step` is called."""


def findings(step: Step) -> str:
    """The whole file."""
    return "\n\n".join([HEAD.strip(), *_closed(step), *_window(step), *_map(step)]) + "\n"


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

MAP_TEXT = """## Varying moment

The same wedge; M goes from its mean less half its range to its mean plus half of it while Q and
sigma rise.  The premise is asked of both half-cycles, from the loads alone: zones of partial
half-cycles grow inside both contacts, and shear that has not slipped yet stays within friction.
"off" is how far a zone is from the solver's at its worse end: that of the conditions, and that of
the smallest ends over partial half-cycles there and back.
"""


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table, numbers to the right.

    >>> print(table(["case", "n"], [["a", "1"]]))
    | case | n |
    | --- | ---: |
    | a | 1 |
    """
    rule = ["---", *["---:"] * (len(head) - 1)]
    return "\n".join(f"| {' | '.join(row)} |" for row in (head, rule, *rows))


def _small(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:.1e}"


def _zone(zone: Zone) -> str:
    return "none" if np.isnan(zone.m) else f"{zone.m:.5f}, {zone.n:.5f}"


# ------------------------------------------------------------------ closed cases


def _closed(step: Step) -> list[str]:
    rows = [_closed_row(known, step) for known in CLOSED]
    head = ["cycle", "m, n exact", *_meshes(), "±", "order", "rounds"]
    return [CLOSED_TEXT.strip(), table(head, rows)]


def _meshes() -> list[str]:
    return [f"error, {count}" for count in COUNTS]


def _closed_row(known: Known, step: Step) -> list[str]:
    step(known.name)
    found, exact = reference(known.case, COUNTS, STEPS), known.exact
    errors = np.abs(np.subtract(found.zones, exact)).max(axis=1)
    order = np.log(errors[0] / errors[-1]) / np.log(COUNTS[-1] / COUNTS[0])
    rounds = str(found.finest.cycle.rounds)
    figures = [*map(_small, errors), _small(max(found.error)), f"{order:.1f}", rounds]
    return [known.name, _zone(exact), *figures]


# ------------------------------------------------------------------ constant loads


def _window(step: Step) -> list[str]:
    rows = [_window_row(part, step) for part in WINDOW]
    candidates = ["exact", "moderate", "large", "smallest of parts"]
    head = ["dsigma / threshold", "regime", "H", "m, n solver", "±", *candidates]
    return [WINDOW_TEXT.strip().format(threshold(), *window()), table(head, rows)]


def _window_row(part: float, step: Step) -> list[str]:
    step(f"constant loads, {part} of the threshold")
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


# ------------------------------------------------------------------ varying moment


def _map(step: Step) -> list[str]:
    points = [_explored(*point, step) for point in MAP]
    rows = [_map_row(*at, point) for at, point in zip(MAP, points, strict=True)]
    premises = ["premise there", "and back", "rounds"]
    head = [
        "M mean, range",
        "dsigma / threshold",
        "m, n solver",
        "±",
        "off",
        "smallest, off",
        *premises,
    ]
    return [MAP_TEXT.strip(), _summary(points), table(head, rows)]


def _explored(mean: float, span: float, part: float, step: Step) -> Explored:
    step(f"moment {mean} ± {span / 2:g}, {part} of the threshold")
    return explored(cycle(part * threshold(), (mean - span / 2, mean + span / 2)))


def _map_row(mean: float, span: float, part: float, point: Explored) -> list[str]:
    best = point.best
    return [
        f"{mean:g}, {span:g}",
        f"{part:g}",
        _zone(point.found.zone),
        _small(point.error),
        _small(point.off(best.zone)),
        _small(point.off(point.smallest)),
        best.there.value,
        best.back.value,
        str(point.found.finest.cycle.rounds),
    ]


def _summary(points: Sequence[Explored]) -> str:
    holds = [p for p in points if p.best.holds]
    fails = [p for p in points if not p.best.holds and not np.isnan(p.best.zone.m)]
    none = [p for p in points if np.isnan(p.best.zone.m)]
    worst = max((p.off(p.best.zone) / p.error for p in holds), default=np.nan)
    beyond = sum(p.off(p.best.zone) > p.error for p in fails)
    largest = max((p.off(p.best.zone) for p in fails), default=np.nan)
    shrinks = [p for p in fails if p.best.shrinks]
    turns = max((p.off(p.smallest) / p.error for p in shrinks), default=np.nan)
    ahead = sum(
        abs(p.found.zone.n - p.known.half_cycle.always.n) <= p.found.error.n < COARSE for p in none
    )
    coarse = sum(p.error >= COARSE for p in none)
    return f"""\
* The premise holds in {len(holds)} of {len(points)} cycles.  There the conditions are off by at
  most {worst:.2f} of the solver's estimate.
* In {len(fails)} cycles it fails, but the conditions have a zone: {beyond} of these are off by more
  than the estimate, by up to {largest:.1e}.
* In {len(shrinks)} of those it holds in one half-cycle, and in the other one a zone only shrinks.
  There the smallest ends over partial half-cycles are off by at most {turns:.2f} of the estimate.
* In {len(none)} there is no zone inside both contacts.  In {ahead} of these the solver's n is where
  the contact ends at its smallest: the edge runs ahead of slip.  In {coarse} the solver's own
  estimate is above {COARSE:g}."""
