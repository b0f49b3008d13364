"""`make bench`: write docs/performance.md, with all figures from one run.

python -m tests.measure.benchmarks.speed [--quick] [--output FILE]
"""

import importlib
import inspect
import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from threading import Thread
from time import perf_counter
from typing import Any, NamedTuple

import click
import numpy as np

from generated.runtime.types import Contact, Regime
from tests.measure.page import table, write

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs" / "performance.md"

Call = Callable[[], Any]

FRICTION, E_STAR = 0.5, 75e9
EDGES = 1e-3, 1.25e-3
BODIES: dict[str, dict[str, float]] = {
    "wedge": {"phi": 0.05},
    "hertz": {"R": 0.05},
    "flat_rounded": {"R": 0.05, "b": 0.5e-3},
    "hyperbola": {"phi": 0.05, "b": 0.5e-3},
}
"""Parameters of each body, in SI units; the contacts are about two millimetres wide."""


WORDS = f"""
# Speed

This page is written by `make bench`, and all figures come from one run.  They are medians.  One
thread was used, except where two threads are named.  Times of one call are for scalar arguments and
exclude compilation.  The integrated body is `hyperbola`, for which the code uses quadrature.

Python {platform.python_version()}, NumPy {np.__version__}, {os.cpu_count()} cores, \
{platform.machine()}.
"""


class Figure(NamedTuple):
    """A measured figure and its bound; `least` means that the bound is a lower one."""

    what: str
    value: float
    bound: float
    unit: str
    least: bool = False

    @property
    def met(self) -> bool:
        """Whether the figure meets its bound."""
        return self.value >= self.bound if self.least else self.value <= self.bound


# ------------------------------------------------------------------ clocks


def seconds_of(call: Call, seconds: float) -> float:
    """Return the seconds per warm call, as the median over rounds."""
    once = min(_timed(call, 1) for _ in range(2))
    repeat = max(1, int(1e-3 / once))
    rounds = max(3, min(100, int(seconds / (repeat * once))))
    return median(_timed(call, repeat) for _ in range(rounds))


def _timed(call: Call, repeat: int) -> float:
    began = perf_counter()
    for _ in range(repeat):
        call()
    return (perf_counter() - began) / repeat


# ------------------------------------------------------------------ cases


class Cycle(NamedTuple):
    """A body, its contact, and the loads of half-cycles at constant or varying normal loads."""

    module: Any
    law: dict[str, float]
    here: Contact
    there: Contact
    P: float
    M: float
    dQ: Any
    threshold: float

    def zone(self, part: Any, varying: bool = False, **options: Any) -> Any:
        """Compute the stick zone; `part` is the tension relative to the threshold."""
        second = self.there if varying else self.here
        law = self.law | {"f": FRICTION}
        dsigma = part * self.threshold
        return self.module.stick_zone(self.here, second, self.dQ, dsigma, **law, **options)


def cycle(body: str) -> Cycle:
    """Return the cycle of a body whose shear load changes by 0.3 f P."""
    module, law = importlib.import_module(f"generated.{body}"), {"E_star": E_STAR, **BODIES[body]}
    a, c = EDGES
    P, M = (of(a, c, **law) for of in (module.load, module.moment))
    dQ = 0.3 * FRICTION * P
    here, there = Contact(a, c, 0.0), Contact(1.01 * a, 1.02 * c, 0.0)
    return Cycle(module, law, here, there, P, M, dQ, 8 * dQ / (np.pi * (a + c)))


def inputs(body: str, function: str, size: int) -> dict[str, Any]:
    """Return random inputs for a function of a body."""
    rng, of = np.random.default_rng(7), cycle(body)
    a, c = rng.uniform(0.9, 1.1, (2, size)) * np.array(EDGES)[:, None]
    held = {"a": a, "c": c, "alpha": of.module.tilt(a, c, **BODIES[body]), **of.law}
    held |= {"P": of.module.load(a, c, **of.law), "M": of.module.moment(a, c, **of.law)}
    held["x"] = rng.uniform(-0.9 * EDGES[0], 0.9 * EDGES[1], size)
    return {name: held[name] for name in inspect.signature(getattr(of.module, function)).parameters}


# ------------------------------------------------------------------ figures


FUNCTIONS = {
    "wedge": ("contact", "contact_at_tilt", "load", "moment", "pressure", "K_N"),
    "hertz": ("contact", "contact_at_tilt", "load", "pressure", "K_N"),
    "flat_rounded": ("contact", "load", "pressure"),
    "hyperbola": ("load",),
}
"""Explicit functions, and two that are solved or integrated."""


def explicit(sizes: list[int], seconds: float) -> Iterator[tuple[str, list[float]]]:
    """Measure the ns per element at several sizes."""
    for body, functions in FUNCTIONS.items():
        module = importlib.import_module(f"generated.{body}")
        for function in functions:
            dear = body == "hyperbola" or (body, function) == ("flat_rounded", "contact")
            row = []
            for size in (n for n in sizes if not dear or n <= 1e5):
                given, of = inputs(body, function, size), getattr(module, function)
                row.append(1e9 * seconds_of(lambda of=of, given=given: of(**given), seconds) / size)
            yield f"{body}.{function}", row


def once(seconds: float) -> Iterator[Figure]:
    """Measure single warm calls."""

    def contact(of: Cycle) -> Any:
        return of.module.contact(of.P, of.M, **of.law)

    wedge, punch, smooth = map(cycle, ("wedge", "flat_rounded", "hyperbola"))
    t, law = np.linspace(0, 2 * np.pi, 101)[:-1], wedge.law | {"f": FRICTION}
    turned, Q = wedge.P * (1 + 0.05 * np.cos(t)), wedge.dQ * np.sin(t)
    marched, followed = wedge.module.march, wedge.module.history
    cases: list[tuple[str, Call, float]] = [
        ("stick_zone, moderate", lambda: wedge.zone(0.5), 15),
        ("stick_zone, large", lambda: wedge.zone(3.0), 25),
        ("stick_zone, large, varying loads", lambda: wedge.zone(3.0, varying=True), 1.5e3),
        ("stick_zone, mixed", lambda: wedge.zone(1.1, mixed=True), 1e5),
        ("contact, integrated body", lambda: contact(smooth), 200),
        ("stick_zone, large, integrated body", lambda: smooth.zone(3.0), 5e3),
        (
            "stick_zone, large, varying loads, integrated body",
            lambda: smooth.zone(3.0, varying=True),
            1.5e5,
        ),
        ("contact by Newton, piecewise polynomial", lambda: contact(punch), 20),
        ("march of 100 instants", lambda: marched(wedge.P, wedge.M, Q, 0.0, **law), 1e4),
        (
            "history of 100 instants, loads out of phase",
            lambda: followed(turned, wedge.M, Q, 0.0, **law),
            3e5,
        ),
    ]
    for name, call, limit in cases:
        yield Figure(name, 1e6 * seconds_of(call, seconds), limit, "us")


def batches(counts: list[int], seconds: float) -> Iterator[Figure]:
    """Measure the time per case of large tension, on one core."""
    for count in counts:
        each = 1e6 * seconds_of(_large(count), seconds) / count
        yield Figure(f"large tension, time per case in a batch of {count:,}", each, 20, "us")


def _large(count: int) -> Call:
    """Return cycles of a wedge: shear of 0.1 to 0.4 f P, tension of 2.5 to 4 thresholds."""
    given, rng = cycle("wedge"), np.random.default_rng(7)
    dQ = rng.uniform(1 / 3, 4 / 3, count) * given.dQ
    dsigma = rng.uniform(2.5, 4.0, count) * dQ * (given.threshold / given.dQ)
    law = given.law | {"f": FRICTION}

    def call() -> Any:
        return given.module.stick_zone(given.here, given.here, dQ, dsigma, **law)

    if not np.all(call().regime == Regime.LARGE):
        raise ArithmeticError("the sample contains a case that is not of large tension")
    return call


def threads(count: int) -> Figure:
    """Compare two threads of a user's own with one thread that does the same work."""
    call = _large(count)

    def by(number: int) -> float:
        workers = [
            Thread(target=lambda: [call() for _ in range(4 // number)]) for _ in range(number)
        ]
        began = perf_counter()
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        return perf_counter() - began

    faster = median(by(1) / by(2) for _ in range(5))
    return Figure("speed of two threads relative to one", faster, 1.7, "times", least=True)


FIRST = """
from time import perf_counter
began = perf_counter()
import generated.wedge as wedge
imported = perf_counter() - began
here = wedge.Contact(1.0, 1.25, 0.0)
wedge.stick_zone(here, here, 0.1, 0.3, f=0.5, E_star=1.0, phi=0.5)
print(imported, perf_counter() - began)
"""


def first_calls(repeat: int) -> Iterator[Figure]:
    """Measure the first call of a fresh copy, which compiles, and later imports and first calls."""
    with TemporaryDirectory() as folder:
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / "generated", Path(folder) / "generated", ignore=ignored)
        environment = {n: v for n, v in os.environ.items() if n != "NUMBA_CACHE_DIR"}

        def run() -> list[float]:
            command = [sys.executable, "-c", FIRST]
            ran = subprocess.run(
                command, cwd=folder, env=environment, capture_output=True, text=True, check=True
            )
            return [float(v) for v in ran.stdout.split()]

        yield Figure("first call of a fresh installation", run()[1], 9, "s")
        later = [run() for _ in range(repeat)]
        yield Figure("import generated.wedge, cached", median(v[0] for v in later), 0.6, "s")
        yield Figure("import and first call, cached", median(v[1] for v in later), 2, "s")


# ------------------------------------------------------------------ the page


def shown(value: float, digits: int) -> str:
    """A number with so many significant digits, and all digits before the point."""
    return f"{value:,.0f}" if value >= 10 ** (digits - 1) else f"{value:.{digits}g}"


def figure_row(f: Figure) -> list[str]:
    """The cells of a figure."""
    limit = f"{'at least' if f.least else 'at most'} {shown(f.bound, 4)} {f.unit}"
    return [f.what, f"{shown(f.value, 4)} {f.unit}", limit, "yes" if f.met else "no"]


@click.command()
@click.option("--quick", is_flag=True, help="Few sizes and cases, to test that everything runs.")
@click.option("--output", default=PAGE, type=click.Path(path_type=Path), help="The page to write.")
def main(quick: bool, output: Path) -> None:
    """Measure the figures, and print and write the page."""
    seconds = 0.01 if quick else 0.5
    sizes = [10**k for k in range(3, 5 if quick else 8)]
    rows = [*explicit(sizes, seconds)]
    figures = [*once(seconds), *batches([1000] if quick else [1, 1000, 100_000], seconds)]
    figures += [threads(1000 if quick else 20_000), *first_calls(1 if quick else 5)]
    arrays = [
        [name, *(shown(v, 3) for v in row), *[""] * (len(sizes) - len(row))] for name, row in rows
    ]
    write(
        output,
        WORDS,
        table(["figure", "measured", "bound", "met"], map(figure_row, figures)),
        "## Arrays",
        "Times are in ns per element; a blank would take too long.",
        table(["function", *(f"{n:,}" for n in sizes)], arrays),
    )


if __name__ == "__main__":
    main()
