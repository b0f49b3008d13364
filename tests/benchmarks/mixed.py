"""Cycles in which slip turns round: how many `mixed=True` leaves unsolved, and the time of each.

    python -m tests.benchmarks.mixed

Normal loads are constant.  Contacts are drawn with a and c uniform in EDGES, the change of shear dQ
uniform in SHEAR of 2 f P, from which on all slides, and the change of tension, of either sign, with
its logarithm uniform in TENSION of 8 dQ/(pi (a + c)), where moderate tension ends.  Of COUNT such
cycles those of regime MIXED are solved.  What share is left unsolved depends on the sample: it is
printed by parts of it, and for the whole.
"""

import importlib
from itertools import pairwise
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

from generated._types import Contact, Regime

COUNT = 2000
F, E_STAR = 0.5, 1.25
BODIES: dict[str, dict[str, float]] = {"wedge": {"phi": 0.25}, "hertz": {"R": 1.5}}
EDGES = 0.75, 2.0
SHEAR = 0.0, 0.2, 0.4, 0.6, 0.8, 0.99
"""Borders of the parts printed, dQ/(2 f P)."""

TENSION = 0.95, 1.2, 1.5, 2.0, 3.0, 6.0
"""Borders of the parts printed, abs(dsigma) over the threshold."""


class Turning(NamedTuple):
    """Cycles of regime MIXED: where in the sample, which are unsolved, and seconds for all."""

    shear: Any
    tension: Any
    unsolved: Any
    seconds: float

    def between(self, shear: tuple[float, float], tension: tuple[float, float]) -> tuple[int, int]:
        """How many are unsolved, of how many, in one part of the sample."""
        here = (self.shear >= shear[0]) & (self.shear < shear[1])
        here &= (self.tension >= tension[0]) & (self.tension < tension[1])
        return int(np.count_nonzero(self.unsolved & here)), int(np.count_nonzero(here))


def turning(name: str, count: int = COUNT) -> Turning:
    """The sample of one body, solved; the same on every machine."""
    body: Any = importlib.import_module(f"generated.{name}")
    law = {"E_star": E_STAR, **BODIES[name]}
    rng = np.random.default_rng(7)
    a, c = rng.uniform(*EDGES, (2, count))
    shear = rng.uniform(SHEAR[0], SHEAR[-1], count)
    tension = np.exp(rng.uniform(*np.log([TENSION[0], TENSION[-1]]), count))
    dQ = shear * 2 * F * body.load(a, c, **law)
    dsigma = tension * rng.choice([-1, 1], count) * 8 * dQ / (np.pi * (a + c))
    there = Contact(a, c, 0.0 * a)
    known = body.stick_zone(there, there, dQ, dsigma, f=F, **law)
    rows = np.flatnonzero(known.regime == Regime.MIXED)
    some = Contact(a[rows], c[rows], 0.0 * a[rows])
    start = perf_counter()
    zone = body.stick_zone(some, some, dQ[rows], dsigma[rows], f=F, **law, mixed=True)
    seconds = perf_counter() - start
    return Turning(shear[rows], tension[rows], zone.regime == Regime.UNSOLVED, seconds)


def pairs(borders: tuple[float, ...]) -> list[tuple[float, float]]:
    """From each border to the next."""
    return list(pairwise(borders))


def share(unsolved: int, of: int) -> str:
    """Per cent, and of how many."""
    return f"{100 * unsolved / of:.0f} % of {of}" if of else "-"


def parts(name: str, found: Turning) -> Table:
    """Shares by parts of the sample, all of it last."""
    whole = (SHEAR[0], SHEAR[-1]), (TENSION[0], TENSION[-1])
    columns = [f"{low:g} to {high:g}" for low, high in pairs(TENSION)]
    title = f"{name}: unsolved, by dQ/(2 f P) and tension over its threshold"
    table = Table("dQ/(2 f P)", *columns, "all", title=title)
    for shear in [*pairs(SHEAR), whole[0]]:
        row = [share(*found.between(shear, tension)) for tension in [*pairs(TENSION), whole[1]]]
        table.add_row(f"{shear[0]:g} to {shear[1]:g}", *row, end_section=shear[1] == SHEAR[-1])
    return table


def main() -> None:
    """Solve and print."""
    console = Console(width=110)
    for name in BODIES:
        found = turning(name)
        console.print(parts(name, found))
        console.print(
            f"{found.unsolved.size} of {COUNT} cycles are mixed; "
            f"{1e3 * found.seconds / max(found.unsolved.size, 1):.0f} ms each with mixed=True\n"
        )


if __name__ == "__main__":
    main()
