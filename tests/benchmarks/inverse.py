"""`make bench-inverse`: from loads to contacts, against SciPy, in one run.

`contact` of arrays, a loop of scipy.optimize.fsolve over the same functions, and
scipy.optimize.elementwise.find_root where there is one unknown: a centred load on a symmetric body.
Round trips count what is lost, and how far load and moment are off.
"""

import importlib
from collections.abc import Iterator
from dataclasses import dataclass
from time import perf_counter
from types import ModuleType
from typing import Any

import click
import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table
from scipy.optimize import fsolve
from scipy.optimize.elementwise import bracket_root, find_root

PARAMETERS: dict[str, dict[str, float]] = {
    "catenary": {"R": 1.0, "b": 0.5},
    "circular_arc": {"R": 1.0},
    "flat_rounded": {"b": 1.0, "R": 2.0},
    "flat_sloped": {"b": 1.0, "phi": 0.1},
    "hyperbola": {"phi": 0.1, "b": 1.0},
    "parabola_quartic": {"R": 1.0, "L": 1.0},
    "power": {"k": 2.5, "L": 1.0},
    "quartic": {"L": 1.0},
    "rounded_wedge": {"phi": 0.1, "b": 1.0},
    "two_radii": {"R_1": 1.0, "R_2": 3.0},
    "wedge_parabola": {"phi": 0.1, "R": 1.0},
}
SYMMETRIC = {"catenary", "circular_arc", "flat_rounded", "flat_sloped", "hyperbola"} | {
    *("parabola_quartic", "power", "quartic", "rounded_wedge"),
}
WIDEST = {"catenary": 1.0, "circular_arc": -0.1}
"""Decades of the widest contact, where a body ends or its load leaves float64."""

E_STAR = 1.0


@dataclass(frozen=True)
class Row:
    """One body: seconds a state, states lost, and the worst relative errors."""

    name: str
    contact: float
    fsolve: float
    centred: float
    find_root: float
    lost: int
    load: float
    moment: float


def states(name: str, count: int) -> tuple[ModuleType, dict[str, float], Any, Any]:
    """Random contacts over 24 decades of width, central and lopsided."""
    rng, own = np.random.default_rng(5), PARAMETERS[name]
    module = importlib.import_module(f"generated.{name}")
    if name.startswith("flat"):
        width = 10 ** rng.uniform(0.4, 12, count)
        middle = rng.uniform(-0.49, 0.49, count) * (width - 2 * own["b"])
    else:
        width = 10 ** rng.uniform(-12, WIDEST.get(name, 12.0), count)
        middle = width * rng.uniform(-0.45, 0.45, count)
    return module, own, width / 2 - middle, width / 2 + middle


def measured(name: str, count: int, loops: int) -> Row:
    """Times and errors of one body."""
    module, own, a, c = states(name, count)
    given = {"E_star": E_STAR, **own}
    load, moment = module.load(a, c, **given), module.moment(a, c, **given)
    module.contact(load[:10], moment[:10], **given)  # what a first call alone has to do

    began = perf_counter()
    found = module.contact(load, moment, **given)
    alone = (perf_counter() - began) / count
    back = module.load(found.a, found.c, **given), module.moment(found.a, found.c, **given)

    def off(edges: Any, i: int) -> list[float]:
        left, right = edges
        return [
            float(module.load(left, right, **given) / load[i] - 1),
            float((module.moment(left, right, **given) - moment[i]) / (load[i] * (a[i] + c[i]))),
        ]

    began = perf_counter()
    for i in range(loops):
        fsolve(off, [a[i] * 1.05, c[i] * 0.95], args=(i,), full_output=True)
    by_fsolve = (perf_counter() - began) / loops

    centred, by_root = np.nan, np.nan
    if name in SYMMETRIC:
        half = (a + c) / 2
        load_0 = module.load(half, half, **given)
        began = perf_counter()
        module.contact(load_0, 0.0, **given)
        centred = (perf_counter() - began) / count

        def excess(y: Any, wanted: Any) -> Any:
            return module.load(np.exp(y), np.exp(y), **given) / wanted - 1

        began = perf_counter()
        start = np.zeros(count)  # it knows the body's order of size, as contact does
        bracket = bracket_root(excess, start - 0.5, start + 0.6, args=(load_0,))
        find_root(excess, bracket.bracket, args=(load_0,))
        by_root = (perf_counter() - began) / count
    return Row(
        name,
        alone,
        by_fsolve,
        centred,
        by_root,
        int(np.count_nonzero(np.isnan(found.a))),
        float(np.nanmax(np.abs(back[0] / load - 1))),
        float(np.nanmax(np.abs(back[1] - moment) / (load * (a + c)))),
    )


def rows(count: int, loops: int) -> Iterator[Row]:
    """Every body of the library that is solved."""
    for name in track(PARAMETERS, "solving", console=Console(stderr=True), transient=True):
        yield measured(name, count, loops)


def table(found: list[Row]) -> Table:
    """Microseconds a state, ratios, and what is lost."""
    shown = Table(
        *("body", "contact", "fsolve loop", "times faster", "contact, M = 0", "find_root"),
        *("times faster", "lost", "load off by", "moment off by, of P h"),
        title="us a state; ratios of one run",
    )
    for row in found:
        times = [f"{1e6 * t:.1f}" for t in (row.contact, row.fsolve, row.centred, row.find_root)]
        shown.add_row(
            *(row.name, *times[:2], f"{row.fsolve / row.contact:.0f}", *times[2:]),
            f"{row.find_root / row.centred:.1f}",
            *(str(row.lost), f"{row.load:.1e}", f"{row.moment:.1e}"),
        )
    return shown


@click.command()
@click.option("--count", default=100_000, help="States a body.")
@click.option("--loops", default=100, help="States of them for fsolve.")
def main(count: int, loops: int) -> None:
    """Compare contact() with SciPy's solvers."""
    Console(width=150).print(table(list(rows(count, loops))))


if __name__ == "__main__":
    main()
