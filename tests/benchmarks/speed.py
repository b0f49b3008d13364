"""`make bench`: generated functions against lambdify of the paper's forms, in one run.

Each round times the three in turn, so that a change of the machine's pace meets all of them;
figures are medians over the rounds.  Read the ratios: they hold from machine to machine better
than times do.
"""

import importlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from statistics import median
from time import perf_counter
from typing import Any

import click
import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table
from sympy import lambdify

from tests.paper_forms import FORMS

SIZES = (1_000, 100_000, 10_000_000)

MATERIAL = {"E_star": 75e9, "phi": 0.05, "R": 0.05}
"""A titanium-like blade root: SI units."""

VARYING = {
    "contact": {"P": (1e5, 1e7), "M": (-1e3, 1e3)},
    "contact_at_tilt": {"P": (1e5, 1e7), "alpha": (-0.02, 0.02)},
    "pressure": {"x": (-0.9e-3, 1.4e-3)},
}
"""Arguments that are arrays, and their range; a function of (a, c) alone varies both."""

EDGES = {"a": (0.5e-3, 2e-3), "c": (0.5e-3, 2e-3)}
FIXED = {"a": 1e-3, "c": 1.5e-3}

Call = Callable[[], Any]


@dataclass(frozen=True)
class Row:
    """Times of one function at one size, in seconds a call."""

    name: str
    size: int
    generated: float
    plain: float
    cse: float

    @property
    def against_plain(self) -> float:
        """How many times faster than lambdify."""
        return self.plain / self.generated

    @property
    def against_cse(self) -> float:
        """How many times faster than lambdify with common subexpressions taken out."""
        return self.cse / self.generated


def arguments(function: str, size: int) -> dict[str, Any]:
    """Arrays for what varies, numbers for the rest."""
    rng = np.random.default_rng(7)
    varying = VARYING.get(function, EDGES)
    return FIXED | MATERIAL | {n: rng.uniform(*bounds, size) for n, bounds in varying.items()}


def calls(body: str, function: str, size: int) -> tuple[Call, Call, Call]:
    """The generated function, lambdify and lambdify with cse, on the same arrays."""
    given = arguments(function, size)
    forms = FORMS[body][function]
    held = sorted(set().union(*(f.free_symbols for f in forms.values())), key=str)
    values = [given[str(s)] for s in held]
    generated = getattr(importlib.import_module(f"generated.{body}"), function)
    own = {str(s): given[str(s)] for s in held}
    outputs = list(forms.values()) if len(forms) > 1 else next(iter(forms.values()))
    plain, cse = (lambdify(held, outputs, modules="numpy", cse=flag) for flag in (False, True))
    return lambda: generated(**own), lambda: plain(*values), lambda: cse(*values)


def measured(body: str, function: str, size: int, seconds: float) -> Row:
    """One row: rounds of the three, each round in turn, for about `seconds`."""
    three = calls(body, function, size)
    once = max(_timed(call, 1) for call in three)
    repeat = max(1, int(2e-3 / once))
    rounds = max(5, min(200, int(seconds / (3 * repeat * once))))
    times = [[_timed(call, repeat) for call in three] for _ in range(rounds)]
    return Row(f"{body}.{function}", size, *(median(column) for column in zip(*times, strict=True)))


def _timed(call: Call, repeat: int) -> float:
    began = perf_counter()
    for _ in range(repeat):
        call()
    return (perf_counter() - began) / repeat


def rows(sizes: tuple[int, ...], seconds: float) -> Iterator[Row]:
    """Every function that the paper prints a form of, at every size."""
    todo = [(b, f, n) for b, functions in FORMS.items() for f in functions for n in sizes]
    for body, function, size in track(
        todo, description="timing", console=Console(stderr=True), transient=True
    ):
        yield measured(body, function, size, seconds)


def table(found: list[Row]) -> Table:
    """Times in ns an element, and ratios."""
    shown = Table(
        "function",
        "elements",
        "generated",
        "lambdify",
        "with cse",
        "times faster than lambdify",
        "times faster than cse",
        title="ns an element, medians; ratios of one run",
    )
    for row in found:
        per = [f"{1e9 * t / row.size:.2f}" for t in (row.generated, row.plain, row.cse)]
        ratios = [f"{row.against_plain:.2f}", f"{row.against_cse:.2f}"]
        shown.add_row(row.name, f"{row.size:,}", *per, *ratios)
    return shown


@click.command()
@click.option("--seconds", default=2.0, help="Time for each function and size.")
@click.option("--largest", default=SIZES[-1], help="Leave out sizes above this.")
def main(seconds: float, largest: int) -> None:
    """Compare the generated functions with lambdify of the paper's forms."""
    found = list(rows(tuple(n for n in SIZES if n <= largest), seconds))
    Console(width=140).print(table(found))


if __name__ == "__main__":
    main()
