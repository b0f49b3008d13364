"""`make bench`: docs/performance.md, all figures of one run.

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
"""Of micrometres to millimetres, in SI units."""


WORDS_OF_SIZES = """\
ns an element.  Twenty sizes a decade were measured, every tenth is shown; a blank would take too
long."""


class Figure(NamedTuple):
    """One figure and the bound that it is held to."""

    what: str
    value: float
    bound: float
    unit: str
    least: bool = False

    @property
    def met(self) -> bool:
        """Whether it is within its bound."""
        return self.value >= self.bound if self.least else self.value <= self.bound


# ------------------------------------------------------------------ clocks


def in_turn(calls: Mapping[str, Call], seconds: float) -> dict[str, float]:
    """Seconds of one call of each, warm: medians over rounds that time all of them in turn."""
    once = {name: min(_timed(call, 1) for _ in range(2)) for name, call in calls.items()}
    repeats = {name: max(1, int(1e-3 / t)) for name, t in once.items()}
    a_round = sum(repeats[name] * t for name, t in once.items())
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(max(3, min(100, int(seconds / a_round)))):
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
    """A body, its contact, and half-cycles at constant or varying normal loads."""

    module: Any
    law: dict[str, float]
    here: Contact
    there: Contact
    dQ: Any
    threshold: float

    def zone(self, part: Any, varying: bool = False, **options: Any) -> Any:
        """The stick zone, tension in parts of that at which it is no longer moderate."""
        second = self.there if varying else self.here
        law = self.law | {"f": FRICTION}
        dsigma = part * self.threshold
        return self.module.stick_zone(self.here, second, self.dQ, dsigma, **law, **options)


def cycle(body: str) -> Cycle:
    """Shear of 0.3 f P."""
    module, law = importlib.import_module(f"generated.{body}"), {"E_star": E_STAR, **BODIES[body]}
    a, c = EDGES
    dQ = 0.3 * FRICTION * module.load(a, c, **law)
    here, there = Contact(a, c, 0.0), Contact(1.01 * a, 1.02 * c, 0.0)
    return Cycle(module, law, here, there, dQ, 8 * dQ / (np.pi * (a + c)))


def loads_of(body: str) -> tuple[Any, dict[str, float], float, float]:
    """A module, its law, and the loads of a contact."""
    given = cycle(body)
    loads = (of(*EDGES, **given.law) for of in (given.module.load, given.module.moment))
    return given.module, given.law, *loads


def inputs(body: str, function: str, size: int) -> dict[str, Any]:
    """Random inputs of an explicit function."""
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
    """The generated function, and lambdify of the printed one with and without cse."""
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
    """ns an element of explicit functions, against lambdify."""
    for body, forms in FORMS.items():
        for function in forms:
            if body in BODIES:
                for size in sizes:
                    times = in_turn(contenders(body, function, size), seconds)
                    yield f"{body}.{function}", size, {n: 1e9 * t / size for n, t in times.items()}


def scan(sizes: list[int], seconds: float) -> Iterator[tuple[str, list[float]]]:
    """ns an element at many sizes, of functions of every kind: the least of several calls."""
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
    """The largest ratio of the times an element at two neighbouring sizes."""
    above = [v / w for v, w in pairwise(row)] + [w / v for v, w in pairwise(row)]
    return max(above) if above else 1.0


def once(seconds: float) -> Iterator[Figure]:
    """One call, warm."""
    wedge, smooth = cycle("wedge"), cycle("hyperbola")
    contact, law, P, M = loads_of("hyperbola")
    punch, punched, P_1, M_1 = loads_of("flat_rounded")
    marched, wedged, P_2, M_2 = loads_of("wedge")
    Q = 0.3 * FRICTION * P_2 * np.sin(np.linspace(0, 2 * np.pi, 101)[:-1])
    law_2 = wedged | {"f": FRICTION}
    cases: list[tuple[str, Call, float]] = [
        ("stick_zone, moderate", lambda: wedge.zone(0.5), 30),
        ("stick_zone, large", lambda: wedge.zone(3.0), 100),
        ("stick_zone, large, varying loads", lambda: wedge.zone(3.0, varying=True), 3e3),
        ("stick_zone, mixed", lambda: wedge.zone(1.1, mixed=True), 1e4),
        ("integrated contact", lambda: contact.contact(P, M, **law), 300),
        ("integrated stick_zone, large", lambda: smooth.zone(3.0), 5e3),
        (
            "integrated stick_zone, large, varying loads",
            lambda: smooth.zone(3.0, varying=True),
            1.5e5,
        ),
        ("solved contact, piecewise polynomial", lambda: punch.contact(P_1, M_1, **punched), 20),
        (
            "march of 100 instants",
            lambda: marched.march(P_2, M_2, Q, 0.0, **law_2),
            1e4,
        ),
    ]
    for name, call, limit in cases:
        yield Figure(name, 1e6 * in_turn({name: call}, seconds)[name], limit, "us")


def beside_by_hand(counts: list[int], seconds: float) -> Iterator[Figure]:
    """Large tension against a kernel that tests nothing, one core."""
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
            raise ArithmeticError("the kernel written by hand finds other stick zones")
        times = in_turn({"ours": ours, "theirs": theirs}, seconds)
        yield Figure(
            f"large tension over a kernel by hand, {count:,} cases",
            times["ours"] / times["theirs"],
            2,
            "times",
        )
        if count >= 1000:
            each = 1e6 * times["ours"] / count
            yield Figure(f"large tension, a case of {count:,}", each, 12, "us")


def _large(count: int) -> tuple[Cycle, Any, Call]:
    """Cycles of large tension of a wedge: shear of 0.1 to 0.4 f P, tension 2.5 to 4 thresholds."""
    given, rng = cycle("wedge"), np.random.default_rng(7)
    dQ = rng.uniform(1 / 3, 4 / 3, count) * given.dQ
    dsigma = rng.uniform(2.5, 4.0, count) * dQ * (given.threshold / given.dQ)
    rows = np.stack([np.full(count, e) for e in EDGES] + [dQ, dsigma], axis=1)
    law = given.law | {"f": FRICTION}
    loads = (dQ, dsigma) if count > 1 else (float(dQ[0]), float(dsigma[0]))
    found = given.module.stick_zone(given.here, given.here, *loads, **law)
    if not np.all(found.regime == Regime.LARGE):
        raise ArithmeticError("a case of the sample is not of large tension")
    return given, rows, lambda: given.module.stick_zone(given.here, given.here, *loads, **law)


def threads(count: int) -> Figure:
    """Two threads of a user's own against one, the same work in all."""
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
    return Figure("two threads over one", faster, 1.7, "times", least=True)


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
    """A fresh copy of the package: the first call that compiles, and imports once all is cached."""
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

        yield Figure("first call of a fresh installation", run()[1], 20, "s")
        later = [run() for _ in range(repeat)]
        yield Figure("import generated.wedge, cached", median(v[0] for v in later), 0.5, "s")
        yield Figure("import and first call, cached", median(v[1] for v in later), 2, "s")


# ------------------------------------------------------------------ the page


def figures_of(scanned: Any) -> Iterator[Figure]:
    """The worst ratios of what was measured along arrays."""
    for name, row in scanned:
        yield Figure(f"between neighbouring sizes, {name}", hole(row), 2, "times")


def page(
    figures: list[Figure],
    rows: list[tuple[str, int, dict[str, float]]],
    sizes: list[int],
    scanned: list[tuple[str, list[float]]],
) -> str:
    """The page in Markdown."""
    lines = [
        "# Speed",
        "",
        "Made by `make bench`, all in one run: medians, contenders timed in turn, one thread but",
        "where two are named.  One call is of numbers, warm.  The kernel by hand, in numba,",
        "solves large tension on a wedge and tests nothing (tests/benchmarks/by_hand.py).",
        f"Python {platform.python_version()}, NumPy {np.__version__}, {os.cpu_count()} cores, "
        f"{platform.machine()}.",
        "",
        "| figure | measured | bound | met |",
        "| --- | ---: | ---: | --- |",
    ]
    for f in figures:
        limit = f"{'at least' if f.least else 'at most'} {f.bound:,.4g} {f.unit}"
        lines.append(
            f"| {f.what} | {f.value:,.4g} {f.unit} | {limit} | {'yes' if f.met else 'no'} |"
        )
    lines += [
        "",
        "## Explicit functions",
        "",
        "ns an element; lambdify has the printed formula, and tests nothing.",
        "",
    ]
    lines += ["| function | elements | generated | lambdify | lambdify, cse |"]
    lines += ["| --- | ---: | ---: | ---: | ---: |"]
    for name, size, times in rows:
        values = [f"{times[n]:.3g}" for n in ("generated", "lambdify", "lambdify, cse")]
        lines.append(f"| {name} | {size:,} | " + " | ".join(values) + " |")
    lines += ["", "## Neighbouring sizes", "", WORDS_OF_SIZES, ""]
    lines += ["| function | " + " | ".join(f"{n:,}" for n in sizes) + " |"]
    lines += ["| --- |" + " ---: |" * len(sizes)]
    for name, row in scanned:
        cells = [f"{v:.3g}" for v in row[::10]]
        cells += [""] * (len(sizes) - len(cells))
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join([*lines, ""])


@click.command()
@click.option("--quick", is_flag=True, help="Few sizes and cases, to see that all runs.")
@click.option("--output", default=PAGE, type=click.Path(path_type=Path), help="The page.")
def main(quick: bool, output: Path) -> None:
    """Measure, print and write the page."""
    seconds = 0.01 if quick else 0.5
    most = 4 if quick else 7
    sizes = [round(10 ** (k / 20)) for k in range(80, 101 if quick else 20 * most + 1)]
    rows = [*explicit([10**k for k in range(3, most + 1)], seconds)]
    scanned = [*scan(sizes, seconds)]
    found = [*figures_of(scanned), *once(seconds)]
    found += beside_by_hand([1, 1000] if quick else [1, 1000, 100_000], seconds)
    found += [threads(1000 if quick else 20_000), *first_calls(1 if quick else 5)]
    text = page(found, rows, sizes[::10], scanned)
    output.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
