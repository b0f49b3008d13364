"""Stick zones of large tension: time for a hundred thousand load cases, and how many are unsolved.

    python -m tests.benchmarks.slip

Contacts, shear and tension are drawn at random, tension from the threshold to ten times it.  Some
of the cycles in which slip turns round are then solved, too.
"""

import importlib
from time import perf_counter
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from generated._types import Contact, Regime

COUNT = 100_000
F, E_STAR = 0.5, 1.0
BODIES: tuple[tuple[str, dict[str, float], int], ...] = (
    ("hertz", {"R": 1.0}, COUNT),
    ("wedge", {"phi": 0.125}, COUNT),
    ("unequal_wedge", {"phi_1": 0.125, "phi_2": 0.25}, COUNT),
    ("two_radii", {"R_1": 0.5, "R_2": 2.0}, COUNT),
    ("wedge_parabola", {"R": 1.0, "phi": 0.125}, COUNT),
    ("quartic", {"L": 1.0}, COUNT),
    ("flat_sloped", {"phi": 0.125, "b": 0.5}, COUNT),
    ("flat_sloped", {"phi": 0.125, "b": 1.3}, COUNT),
    ("flat_rounded", {"R": 1.0, "b": 0.5}, COUNT),
    ("flat_rounded", {"R": 1.0, "b": 1.3}, COUNT),
    ("rounded_wedge", {"phi": 0.125, "b": 0.5}, COUNT),
    ("rounded_wedge", {"phi": 0.125, "b": 1.3}, COUNT),
    ("hyperbola", {"b": 0.5, "phi": 0.125}, COUNT // 1000),
)
"""Parameters, and how many cases: where the pressure is integrated, few.

At b = 1.3 kinks lie close to many an edge; contacts that end before they reach one are left out.
"""

TURNING = 100
"""Cycles of regime MIXED that are solved."""


def cases(body: Any, own: dict[str, float], count: int) -> tuple[Contact, Any, Any]:
    """Contacts with their changes of shear and tension, where there is a contact."""
    rng = np.random.default_rng(7)
    a, c = 0.6 + np.exp(0.4 * rng.normal(size=(2, count)))
    shear = 2 * F * rng.uniform(0.01, 0.9, count) * body.load(a, c, E_star=E_STAR, **own)
    over = np.exp(rng.uniform(0, np.log(10), count)) * rng.choice([-1, 1], count)
    tension = over * 8 * shear / (np.pi * (a + c))
    a, c, shear, tension = (v[np.isfinite(shear)] for v in (a, c, shear, tension))
    return Contact(a, c, 0.0 * a), shear, tension


def turning(
    body: Any, here: Contact, shear: Any, tension: Any, regime: Any, law: dict[str, float]
) -> tuple[int, int, float]:
    """Cycles in which slip turns round: how many are solved, of how many, and the time of each."""
    rows = np.flatnonzero(regime == Regime.MIXED)[:TURNING]
    some = Contact(here.a[rows], here.c[rows], here.alpha[rows])
    start = perf_counter()
    zone = body.stick_zone(some, some, shear[rows], tension[rows], **law, mixed=True)
    seconds = perf_counter() - start
    return int(np.count_nonzero(np.isfinite(zone.m))), rows.size, seconds / max(rows.size, 1)


def main() -> None:
    """Measure and print."""
    columns = ["cases", "large", "mixed", "unsolved", "s for 1e5 cases"]
    table = Table("geometry", *columns, "of mixed, solved", "ms for each")
    for name, own, count in BODIES:
        body: Any = importlib.import_module(f"generated.{name}")
        here, shear, tension = cases(body, own, count)
        law = {"f": F, "E_star": E_STAR, **own}
        start = perf_counter()
        regime = body.stick_zone(here, here, shear, tension, **law).regime
        seconds = (perf_counter() - start) * COUNT / shear.size
        solved, tried, each = turning(body, here, shear, tension, regime, law)
        counts = [np.count_nonzero(regime == r) for r in (Regime.LARGE, Regime.MIXED)]
        unsolved = np.count_nonzero(regime == Regime.UNSOLVED)
        row = [*map(str, (shear.size, *counts, unsolved)), f"{seconds:.1f}"]
        label = f"{name}, b = {own['b']}" if "b" in own else name
        table.add_row(label, *row, f"{solved} of {tried}", f"{1e3 * each:.0f}")
    Console(width=110).print(table)


if __name__ == "__main__":
    main()
