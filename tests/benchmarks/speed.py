"""`make bench`: write docs/performance.md, with all figures from one run.

python -m tests.benchmarks.speed [--quick] [--output FILE]
"""

import importlib
import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from threading import Thread
from time import perf_counter
from typing import Any, NamedTuple

import click
import numpy as np
from sympy import lambdify

from generated.runtime.types import Contact, Regime
from tests.paper_forms import FORMS

ROOT = Path(__file__).parents[2]
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


WORDS = """\
This page is written by `make bench`, and all figures come from one run.  They are medians, except
that times at neighbouring sizes are the shortest of several calls.  Functions that are compared
with each other were timed in turn.  One thread was used, except where two threads are named.

Times of one call are for scalar arguments and exclude compilation.  The hand-written kernel
(tests/benchmarks/by_hand.py) is compiled by numba.  It solves large tension on a wedge without any
checks.  The integrated body is `hyperbola`, for which the code uses quadrature.  The ratios
between neighbouring sizes compare the times per element of arrays of neighbouring sizes.
"""

WORDS_OF_SIZES = """\
The table gives the time per element in ns.  Twenty sizes per decade were measured, and every tenth
is shown.  A cell is blank if its measurement would take too long."""


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


def in_turn(calls: Mapping[str, Call], seconds: float) -> dict[str, float]:
    """Return the seconds per warm call of each: medians over rounds that time all calls in turn."""
    once = {name: min(_timed(call, 1) for _ in range(2)) for name, call in calls.items()}
    repeats = {name: max(1, int(1e-3 / t)) for name, t in once.items()}
    per_round = sum(repeats[name] * t for name, t in once.items())
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(max(3, min(100, int(seconds / per_round)))):
        for name, call in calls.items():
            times[name].append(_timed(call, repeats[name]))
    return {name: median(column) for name, column in times.items()}


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
    dQ = 0.3 * FRICTION * module.load(a, c, **law)
    here, there = Contact(a, c, 0.0), Contact(1.01 * a, 1.02 * c, 0.0)
    return Cycle(module, law, here, there, dQ, 8 * dQ / (np.pi * (a + c)))


def loads_of(body: str) -> tuple[Any, dict[str, float], float, float]:
    """Return a module, its constants, and the normal load and moment of its contact."""
    given = cycle(body)
    loads = (of(*EDGES, **given.law) for of in (given.module.load, given.module.moment))
    return given.module, given.law, *loads


def inputs(body: str, function: str, size: int) -> dict[str, Any]:
    """Return random inputs for a function of a body."""
    rng = np.random.default_rng(7)
    a, c = rng.uniform(0.9, 1.1, (2, size)) * np.array(EDGES)[:, None]
    module, law = importlib.import_module(f"generated.{body}"), {"E_star": E_STAR, **BODIES[body]}
    own = {n: v for n, v in law.items() if n != "E_star" or function != "tilt"}
    if function == "contact":
        return {"P": module.load(a, c, **law), "M": module.moment(a, c, **law), **law}
    if function == "contact_at_tilt":
        alpha = module.tilt(a, c, **{n: v for n, v in law.items() if n != "E_star"})
        return {"P": module.load(a, c, **law), "alpha": alpha, **law}
    if function == "pressure":
        return {"x": rng.uniform(-0.9 * EDGES[0], 0.9 * EDGES[1], size), "a": a, "c": c, **law}
    return {"a": a, "c": c, **own}


def contenders(body: str, function: str, size: int) -> dict[str, Call]:
    """Return the generated function, and lambdify of the printed formula with and without cse."""
    given = inputs(body, function, size)
    module = importlib.import_module(f"generated.{body}")
    calls: dict[str, Call] = {"generated": lambda: getattr(module, function)(**given)}
    forms = FORMS.get(body, {}).get(function)
    if forms:
        held = sorted({str(s) for form in forms.values() for s in form.free_symbols})
        many = [*forms.values()] if len(forms) > 1 else next(iter(forms.values()))
        for name, cse in (("lambdify", False), ("lambdify, cse", True)):
            printed = lambdify(held, many, modules="numpy", cse=cse)
            values = [given[n] for n in held]
            calls[name] = lambda printed=printed, values=values: printed(*values)  # type: ignore[misc]
    return calls


# ------------------------------------------------------------------ figures


def explicit(sizes: list[int], seconds: float) -> Iterator[tuple[str, int, dict[str, float]]]:
    """Measure the ns per element of explicit functions and of lambdify."""
    for body, forms in FORMS.items():
        for function in forms:
            if body in BODIES:
                for size in sizes:
                    times = in_turn(contenders(body, function, size), seconds)
                    yield f"{body}.{function}", size, {n: 1e9 * t / size for n, t in times.items()}


def scan(sizes: list[int], seconds: float) -> Iterator[tuple[str, list[float]]]:
    """Measure the ns per element at many sizes, as the least of several calls."""
    for body, function in (
        *(("wedge", f) for f in ("contact", "pressure", "load", "K_N")),
        *(("flat_rounded", f) for f in ("load", "pressure", "contact")),
        ("hyperbola", "load"),
    ):
        dear = (function == "contact" and body != "wedge") or body == "hyperbola"
        row = []
        for size in (n for n in sizes if n <= (1e5 if dear else 1e7)):
            call = contenders(body, function, size)["generated"]
            began, times = perf_counter(), [_timed(call, 1)]
            while len(times) < 4 or perf_counter() - began < seconds / 10:
                times.append(_timed(call, 1))
            row.append(1e9 * min(times) / size)
        yield f"{body}.{function}", row


def hole(row: list[float]) -> float:
    """Return the largest ratio of the times per element at two neighbouring sizes."""
    ratios = [v / w for v, w in pairwise(row)] + [w / v for v, w in pairwise(row)]
    return max(ratios) if ratios else 1.0


def once(seconds: float) -> Iterator[Figure]:
    """Measure single warm calls."""
    wedge, smooth = cycle("wedge"), cycle("hyperbola")
    contact, law, P, M = loads_of("hyperbola")
    punch, punched, P_1, M_1 = loads_of("flat_rounded")
    marched, wedged, P_2, M_2 = loads_of("wedge")
    Q = 0.3 * FRICTION * P_2 * np.sin(np.linspace(0, 2 * np.pi, 101)[:-1])
    law_2 = wedged | {"f": FRICTION}
    P_3 = P_2 * (1 + 0.05 * np.cos(np.linspace(0, 2 * np.pi, 101)[:-1]))
    cases: list[tuple[str, Call, float]] = [
        ("stick_zone, moderate", lambda: wedge.zone(0.5), 15),
        ("stick_zone, large", lambda: wedge.zone(3.0), 25),
        ("stick_zone, large, varying loads", lambda: wedge.zone(3.0, varying=True), 1.5e3),
        ("stick_zone, mixed", lambda: wedge.zone(1.1, mixed=True), 1e5),
        ("contact, integrated body", lambda: contact.contact(P, M, **law), 200),
        ("stick_zone, large, integrated body", lambda: smooth.zone(3.0), 5e3),
        (
            "stick_zone, large, varying loads, integrated body",
            lambda: smooth.zone(3.0, varying=True),
            1.5e5,
        ),
        ("contact by Newton, piecewise polynomial", lambda: punch.contact(P_1, M_1, **punched), 20),
        (
            "march of 100 instants",
            lambda: marched.march(P_2, M_2, Q, 0.0, **law_2),
            1e4,
        ),
        (
            "history of 100 instants, loads out of phase",
            lambda: marched.history(P_3, M_2, Q, 0.0, **law_2),
            3e5,
        ),
    ]
    for name, call, limit in cases:
        yield Figure(name, 1e6 * in_turn({name: call}, seconds)[name], limit, "us")


def beside_by_hand(counts: list[int], seconds: float) -> Iterator[Figure]:
    """Compare large tension with a kernel that makes no checks, on one core."""
    by_hand = importlib.import_module("tests.benchmarks.by_hand")
    for count in counts:
        some, rows, ours = _large(count)
        law, out = (FRICTION, *some.law.values()), np.empty((count, 2))

        def theirs(rows: Any = rows, law: Any = law, out: Any = out) -> None:
            by_hand.each(rows, law, out)

        theirs()
        zone = ours()
        zone = np.stack([np.atleast_1d(zone.m), np.atleast_1d(zone.n)], axis=1)
        if zone.shape != out.shape or not np.allclose(zone, out, rtol=1e-6):
            raise ArithmeticError("the hand-written kernel gives different stick zones")
        times = in_turn({"ours": ours, "theirs": theirs}, seconds)
        yield Figure(
            f"large tension relative to the hand-written kernel, batch of {count:,}",
            times["ours"] / times["theirs"],
            2,
            "times",
        )
        if count >= 1000:
            each = 1e6 * times["ours"] / count
            yield Figure(f"large tension, time per case in a batch of {count:,}", each, 20, "us")


def _large(count: int) -> tuple[Cycle, Any, Call]:
    """Return cycles of a wedge: shear of 0.1 to 0.4 f P, tension of 2.5 to 4 thresholds."""
    given, rng = cycle("wedge"), np.random.default_rng(7)
    dQ = rng.uniform(1 / 3, 4 / 3, count) * given.dQ
    dsigma = rng.uniform(2.5, 4.0, count) * dQ * (given.threshold / given.dQ)
    rows = np.stack([np.full(count, e) for e in EDGES] + [dQ, dsigma], axis=1)
    law = given.law | {"f": FRICTION}
    loads = (dQ, dsigma) if count > 1 else (float(dQ[0]), float(dsigma[0]))
    zones = given.module.stick_zone(given.here, given.here, *loads, **law)
    if not np.all(zones.regime == Regime.LARGE):
        raise ArithmeticError("the sample contains a case that is not of large tension")
    return given, rows, lambda: given.module.stick_zone(given.here, given.here, *loads, **law)


def threads(count: int) -> Figure:
    """Compare two threads of a user's own with one thread that does the same work."""
    _, _, call = _large(count)

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


def figures_of(scanned: Any) -> Iterator[Figure]:
    """Return the largest ratio between neighbouring sizes of each function."""
    for name, row in scanned:
        yield Figure(f"largest ratio between neighbouring sizes, {name}", hole(row), 2, "times")


def shown(value: float, digits: int) -> str:
    """A number with so many significant digits, and all digits before the point."""
    return f"{value:,.0f}" if value >= 10 ** (digits - 1) else f"{value:.{digits}g}"


def page(
    figures: list[Figure],
    rows: list[tuple[str, int, dict[str, float]]],
    sizes: list[int],
    scanned: list[tuple[str, list[float]]],
) -> str:
    """Return the page in Markdown."""
    lines = [
        "# Speed",
        "",
        WORDS,
        f"Python {platform.python_version()}, NumPy {np.__version__}, {os.cpu_count()} cores, "
        f"{platform.machine()}.",
        "",
        "| figure | measured | bound | met |",
        "| --- | ---: | ---: | --- |",
    ]
    for f in figures:
        limit = f"{'at least' if f.least else 'at most'} {shown(f.bound, 4)} {f.unit}"
        lines.append(
            f"| {f.what} | {shown(f.value, 4)} {f.unit} | {limit} | {'yes' if f.met else 'no'} |"
        )
    lines += [
        "",
        "## Explicit functions",
        "",
        "Times are in ns per element.  lambdify evaluates the printed formula and makes no checks.",
        "",
    ]
    lines += ["| function | elements | generated | lambdify | lambdify, cse |"]
    lines += ["| --- | ---: | ---: | ---: | ---: |"]
    for name, size, times in rows:
        values = [shown(times[n], 3) for n in ("generated", "lambdify", "lambdify, cse")]
        lines.append(f"| {name} | {size:,} | " + " | ".join(values) + " |")
    lines += ["", "## Neighbouring sizes", "", WORDS_OF_SIZES, ""]
    lines += ["| function | " + " | ".join(f"{n:,}" for n in sizes) + " |"]
    lines += ["| --- |" + " ---: |" * len(sizes)]
    for name, row in scanned:
        cells = [shown(v, 3) for v in row[::10]]
        cells += [""] * (len(sizes) - len(cells))
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join([*lines, ""])


@click.command()
@click.option("--quick", is_flag=True, help="Few sizes and cases, to test that everything runs.")
@click.option("--output", default=PAGE, type=click.Path(path_type=Path), help="The page to write.")
def main(quick: bool, output: Path) -> None:
    """Measure the figures, and print and write the page."""
    seconds = 0.01 if quick else 0.5
    most = 4 if quick else 7
    sizes = [round(10 ** (k / 20)) for k in range(80, 101 if quick else 20 * most + 1)]
    rows = [*explicit([10**k for k in range(3, most + 1)], seconds)]
    scanned = [*scan(sizes, seconds)]
    figures = [*figures_of(scanned), *once(seconds)]
    figures += beside_by_hand([1, 1000] if quick else [1, 1000, 100_000], seconds)
    figures += [threads(1000 if quick else 20_000), *first_calls(1 if quick else 5)]
    text = page(figures, rows, sizes[::10], scanned)
    output.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
