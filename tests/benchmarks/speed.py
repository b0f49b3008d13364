"""`make bench`: docs/performance.md and its picture, all figures of one run.

Without AVX-512 it is docs/performance_without_avx512.md.

In each round all contenders are timed in turn, those of a case each in a process of its own, on one
core; figures are medians over the rounds.  Read the ratios: they hold from machine to machine
better than times do.
"""

import importlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import NamedTuple

import click
import numpy as np
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from sympy import lambdify

from derive.codegen.contract import CONTRACT
from derive.library import library
from derive.sheet import FormulaSheet
from generated import _arrays, _logarithm, flat_rounded, hertz, wedge
from tests.benchmarks.alone import contenders
from tests.benchmarks.cases import (
    CASES,
    CONTENDERS,
    CYLINDER,
    EDGES,
    FLOOR,
    GENERATED,
    LOADS,
    NUMBA,
    NUMEXPR,
    OURS,
    POSITIONS,
    PUNCH,
    Case,
    loads,
    positions,
)
from tests.benchmarks.picture import Curves, draw
from tests.benchmarks.stages import Seconds, stages
from tests.benchmarks.timing import (
    AMONG_ITS_LIKE,
    Call,
    compiled_for,
    in_turn,
    interleaved,
    processor,
    timed,
    versions,
)
from tests.paper_forms import FORMS

ROOT = Path(__file__).parents[2]
WITH_AVX512 = ROOT / "docs" / "performance.md"
WITHOUT_AVX512 = ROOT / "docs" / "performance_without_avx512.md"
PAGE = WITHOUT_AVX512 if _logarithm.BY_TABLE else WITH_AVX512
"""NumPy's log1p is another one on each kind of processor, and so are all ratios."""

SIZES = tuple(10**n for n in range(8))
CUT_AT = (
    *(1, 10, 100, 1_000, 10**4, 41_000, 92_000, 10**5, 200_000, 290_000, 400_000, 650_000),
    *(930_000, 10**6, 1_300_000, 1_900_000, 10**7),
)
"""Where the function is compared with itself uncut: behind the lengths at which it is cut, too."""
MEMORY_AT = (10**5, 10**6)
"""Where memory is measured: of a pressure the first is not cut, and the other is."""
BESIDE_AT = 10**6
"""Where contenders are timed beside `generated`, too, or the most that it takes part in."""
COMPILED = (NUMBA, OURS, NUMEXPR, FLOOR)
"""What keeps its arrays to itself, and what is nothing but its result."""

VARYING = {
    "contact": LOADS,
    "contact_at_tilt": {"P": LOADS["P"], "alpha": (-0.02, 0.02)},
    "pressure": POSITIONS,
}
"""Arguments that are arrays, and their range; a function of (a, c) alone varies both."""

MATERIAL = {"E_star": 75e9, "phi": 0.05, "R": 0.05}
BOTH_EDGES = {"a": (0.5e-3, 2e-3), "c": (0.5e-3, 2e-3)}

SCALARS = {
    **{"P": 2e6, "M": 100.0, "alpha": 0.005, "x": 0.3e-3, "a": 1.5e-3, "c": 1.2e-3},
    **{"dQ": 1e4, "dsigma": 1e6, "dP": 1e4, "dM": 1.0, "f": 0.5, "E_star": 75e9},
    **{"phi": 0.05, "phi_1": 0.05, "phi_2": 0.08, "R": 0.05, "R_1": 0.05, "R_2": 0.08},
    **{"b": 1e-3, "L": 0.05},
}
"""Plain numbers for every argument of an explicit formula."""


# ------------------------------------------------------------------ what is measured


def curves(case: Case, sizes: tuple[int, ...], seconds: float) -> tuple[Curves, Curves]:
    """Seconds a call, by contender and size; memory held over that of the result, at MEMORY_AT.

    Memory is that of NumPy's arrays, where a contender has them.
    """
    times: dict[str, dict[int, float]] = {name: {} for name in case.names()}
    memory: dict[str, dict[int, float]] = {name: {} for name in case.names()}
    for size in sizes:
        with contenders(case, size) as alone:
            clocks = {name: contender.timed for name, contender in alone.items()}
            for name, time in in_turn(clocks, seconds, AMONG_ITS_LIKE).items():
                times[name][size] = time
                if size in MEMORY_AT and name not in COMPILED:
                    memory[name][size] = alone[name].peak()
    return times, memory


class Beside(NamedTuple):
    """Seconds a call in a process that has imported `generated`, by contender."""

    size: int
    times: Mapping[str, float]


def beside(case: Case, largest: int, seconds: float) -> Beside:
    """All contenders that take part where the generated function does."""
    size = min(BESIDE_AT, largest, case.limits.get(GENERATED, largest))
    with contenders(case, size, "generated._arrays") as those:
        clocks = {name: contender.timed for name, contender in those.items()}
        return Beside(size, in_turn(clocks, seconds, AMONG_ITS_LIKE))


class Printed(NamedTuple):
    """One formula that the paper prints: seconds of the generated one, lambdify, with cse."""

    name: str
    size: int
    generated: float
    plain: float
    cse: float


def printed_calls(body: str, function: str, size: int) -> tuple[Call, Call, Call]:
    """The generated function, lambdify and lambdify with cse, on the same arrays."""
    rng = np.random.default_rng(7)
    varying = VARYING.get(function, BOTH_EDGES)
    given = EDGES | MATERIAL | {n: rng.uniform(*bounds, size) for n, bounds in varying.items()}
    forms = FORMS[body][function]
    held = sorted(set().union(*(f.free_symbols for f in forms.values())), key=str)
    values = [given[str(s)] for s in held]
    generated = getattr(importlib.import_module(f"generated.{body}"), function)
    own = {str(s): given[str(s)] for s in held}
    outputs = list(forms.values()) if len(forms) > 1 else next(iter(forms.values()))
    plain, cse = (lambdify(held, outputs, modules="numpy", cse=flag) for flag in (False, True))
    return lambda: generated(**own), lambda: plain(*values), lambda: cse(*values)


def printed(size: int, seconds: float) -> Iterator[Printed]:
    """Every function that the paper prints a form of."""
    for body, functions in FORMS.items():
        for function in functions:
            three = dict(zip("gpc", printed_calls(body, function, size), strict=True))
            yield Printed(f"{body}.{function}", size, *interleaved(three, seconds).values())


@contextmanager
def uncut() -> Iterator[None]:
    """Functions compute arrays of every length as a whole."""
    held = _arrays.RESIDENT
    _arrays.RESIDENT = np.iinfo(np.int64).max
    try:
        yield
    finally:
        _arrays.RESIDENT = held


def cut_or_not(sizes: tuple[int, ...], seconds: float) -> dict[str, dict[int, tuple[float, float]]]:
    """Seconds of functions as they are, and without blocks."""
    found: dict[str, dict[int, tuple[float, float]]] = {}
    for name, call_at in _CUT.items():
        for size in sizes:
            call = call_at(size)
            clocks = {"cut": partial(timed, call), "whole": partial(_timed_uncut, call)}
            times = in_turn(clocks, seconds, AMONG_ITS_LIKE)
            found.setdefault(name, {})[size] = times["cut"], times["whole"]
    return found


def _timed_uncut(call: Call, repeat: int) -> float:
    with uncut():
        return timed(call, repeat)


def _cut_pressure(size: int) -> Call:
    return partial(wedge.pressure, **positions(size))


def _cut_contact(size: int) -> Call:
    return partial(wedge.contact, **loads(size))


def _cut_cylinder(size: int) -> Call:
    given = loads(size)
    return partial(hertz.contact, given["P"], given["M"], **CYLINDER)


def _cut_edges(size: int) -> Call:
    a, c = np.random.default_rng(7).uniform(0.5e-3, 2e-3, (2, size))
    return lambda: hertz.K_N(a, c, **CYLINDER)


def _cut_shear(size: int) -> Call:
    Q = np.random.default_rng(7).uniform(1e4, 1e6, size)
    return lambda: wedge.K_T(**EDGES, dQ=Q, dsigma=1e6)


def _cut_punch(size: int) -> Call:
    x, a, c = np.random.default_rng(7).uniform(2e-3, 4e-3, (3, size))
    return lambda: flat_rounded.pressure(x - 3e-3, a, c, **PUNCH)


_CUT: dict[str, Callable[[int], Call]] = {
    "wedge.pressure": _cut_pressure,
    "hertz.contact": _cut_cylinder,
    "hertz.K_N": _cut_edges,
    "wedge.contact": _cut_contact,
    "wedge.K_T": _cut_shear,
    "flat_rounded.pressure": _cut_punch,
}


def scalars(bodies: tuple[str, ...] = ()) -> dict[str, dict[str, float]]:
    """Seconds of a call with plain numbers, of every explicit formula, by body."""
    from derive.derivation import derive_sheet
    from derive.library import load_geometry

    found: dict[str, dict[str, float]] = {}
    for body in bodies or library():
        geometry = load_geometry(body)
        if not geometry.slope.is_polynomial:
            continue
        sheet: FormulaSheet = derive_sheet(geometry)
        module = importlib.import_module(f"generated.{body}")
        calls: dict[str, Call] = {}
        for function in CONTRACT:
            if function.available(sheet):
                names = map(str, (*function.arguments, *function.keywords(sheet)))
                given = {name: SCALARS[name] for name in names}
                calls[function.name] = partial(getattr(module, function.name), **given)
        found[body] = interleaved(calls, 0.2)
    return found


# ------------------------------------------------------------------ the page


class Found(NamedTuple):
    """All figures of one run."""

    curves: Mapping[str, Curves]
    memory: Mapping[str, Curves]
    beside: Mapping[str, Beside]
    printed: list[Printed]
    cut: Mapping[str, Mapping[int, tuple[float, float]]]
    scalars: Mapping[str, Mapping[str, float]]
    stages: Seconds


def measured(
    largest: int, seconds: float, bodies: tuple[str, ...], told: Callable[[str], None]
) -> Found:
    """Measure everything; `told` hears what comes next."""
    sizes = tuple(n for n in SIZES if n <= largest)
    lines, peaks, near = {}, {}, {}
    for case in CASES:
        told(case.name)
        lines[case.name], peaks[case.name] = curves(case, sizes, seconds)
        near[case.name] = beside(case, largest, seconds)
    told("printed formulas")
    forms = [*printed(min(1_000, largest), seconds / 4), *printed(min(10**6, largest), seconds)]
    told("with and without blocks")
    both = cut_or_not(tuple(n for n in CUT_AT if n <= largest), seconds)
    told("scalar calls")
    numbers = scalars(bodies)
    built = stages(bodies, lambda body: told(f"deriving {body}"))
    return Found(lines, peaks, near, forms, both, numbers, built)


def parts(bodies: tuple[str, ...]) -> int:
    """How often `measured` tells what comes next."""
    return len(CASES) + 3 + len(bodies or library())


_WITH = (
    "Of a processor with AVX-512, on which NumPy computes logarithms, log1p among them, several",
    "times as fast as elsewhere; runs on others: [without it](performance_without_avx512.md),",
    "[an AMD EPYC](performance_amd_epyc.md).  As long as all lies in a core's own cache,",
    "wedge.pressure and lambdify's form with common subexpressions do the same work, one root and",
    "one logarithm among a dozen operations.  What blocks save beyond is what memory takes: the",
    "larger and quicker the processor's last cache, the less.",
)

_WITHOUT = (
    "NumPy computes log1p many elements at once on processors with AVX-512 alone.  Here generated",
    "functions take log(1 + q) from a table, in a dozen steps that go many at once: long arrays",
    "in a third of the time, while arrays of less than some 1,500 elements lose up to ten",
    "microseconds a call.  They are right to 1.1 units in the last place.  The table, 9 MB, is",
    "made at the first call, some 20 ms, and stays.  [With AVX-512](performance.md) there is none.",
    "",
    "To a short array NumPy's two dozen steps are two dozen calls.  Of a long one that lies in the",
    "caches they take longer than a loop that numba compiles over the printed formula, which loses",
    "half of its digits at the edges and all of them at the apex, and less than one over the form",
    "that keeps them (`numba, our form`).",
)


def page(found: Found) -> str:
    """All of it in Markdown."""
    return "\n".join(
        [
            "# Speed" if PAGE == WITH_AVX512 else "# Speed without AVX-512",
            "",
            "Made by `make bench`, all in one run; contenders are timed in turn, round by round,",
            "each in a process of its own on the same core, and figures are medians.  One thread",
            "each.  Ratios hold from machine to machine better than times do.  Measured with:",
            "",
            f"- processor: {processor()}",
            f"- {compiled_for()}",
            f"- {versions()}",
            "",
            f"![ns an element over the number of elements]({PAGE.stem}.svg)",
            "",
            *(_WITH if PAGE == WITH_AVX512 else _WITHOUT),
            "",
            *_case_tables(found),
            *_beside_table(found),
            *_cut_table(found),
            *_printed_table(found),
            *_scalar_table(found),
            *_stage_table(found),
        ]
    )


def _case_tables(found: Found) -> Iterator[str]:
    yield from (
        "What takes too long is left out.  The last columns are the most memory held during a",
        f"call, its result included, over the size of the result, at {MEMORY_AT[0]:,} and",
        f"{MEMORY_AT[1]:,} elements: 1 is the result and nothing else.  tracemalloc sees NumPy's",
        "arrays and not those of compiled code.  The floor is one logarithm of the same array,",
        "`one np.log`.",
        "",
        "In a process of its own a contender finds the memory that it has left itself.  On Linux",
        "the allocator gives large arrays that are freed back to the system, and the next call",
        "asks for each page anew.  `generated` has it keep them, for all in the process, so that",
        "others are quicker [beside it](#beside-generated).",
        "",
    )
    for case in CASES:
        lines = found.curves[case.name]
        ours = lines[GENERATED]
        sizes = sorted({n for times in lines.values() for n in times})
        yield from (f"## {case.name}", "", case.words, "")
        columns = [*(f"{n:,}" for n in sizes), *(f"memory at {n:,}" for n in MEMORY_AT)]
        yield f"| ns an element | {' | '.join(columns)} |"
        yield "| --- |" + " ---: |" * len(columns)
        for name, times in lines.items():
            peaks = found.memory[case.name][name]
            each = [_three(1e9 * times[n] / n) if n in times else "" for n in sizes]
            each += [f"{peaks[n]:.3f}" if n in peaks else "" for n in MEMORY_AT]
            yield f"| {name} | {' | '.join(each)} |"
        yield from ("", f"| times faster than | {' | '.join(f'{n:,}' for n in sizes)} |")
        yield "| --- |" + " ---: |" * len(sizes)
        for name, times in lines.items():
            if name in CONTENDERS and name != GENERATED:
                both = [
                    _three(times[n] / ours[n]) if n in times and n in ours else "" for n in sizes
                ]
                yield f"| {name} | {' | '.join(both)} |"
        yield ""


def _beside_table(found: Found) -> Iterator[str]:
    others = [name for name in CONTENDERS if name != GENERATED]
    yield from (
        "## Beside `generated`",
        "",
        "The same in processes that have imported it: how many times faster it is.",
        "",
        f"| times faster than | elements | {' | '.join(others)} |",
        "| --- |" + " ---: |" * (len(others) + 1),
    )
    for name, (size, times) in found.beside.items():
        ours = times[GENERATED]
        each = [_three(times[other] / ours) if other in times else "" for other in others]
        yield f"| {name} | {size:,} | {' | '.join(each)} |"
    yield ""


def _cut_table(found: Found) -> Iterator[str]:
    yield from (
        "## Blocks",
        "",
        "A function is computed in blocks where the arrays that it holds at once, as its",
        f"decorator counts them, are more than {_arrays.RESIDENT:,} numbers, which the process",
        "keeps.  Several results do not count, since copying them costs what cutting saves; the",
        f"rest of these, and more than {_arrays.FEW} arrays, count as far as the arguments vary.",
        "Where there is no rest nothing is cut.",
        f"Blocks have {_arrays.BLOCK:,} elements, or more where they hold no more than one in",
        f"{_arrays.SHARE} of the results' numbers; of more than {_arrays.FEW} arrays they hold",
        "half as many numbers as are kept.",
        "Time in blocks over the time of the same function without; under 1 is faster.  Up to",
        "41,000 elements nothing is cut, and what differs from 1 tells how well this can be",
        "measured.",
        "",
    )
    sizes = [*next(iter(found.cut.values()))]
    yield f"| | {' | '.join(f'{n:,}' for n in sizes)} |"
    yield "| --- |" + " ---: |" * len(sizes)
    for name, times in found.cut.items():
        yield f"| {name} | {' | '.join(f'{cut / whole:.2f}' for cut, whole in times.values())} |"
    yield ""


def _printed_table(found: Found) -> Iterator[str]:
    yield from (
        "## Every formula that the paper prints",
        "",
        "Against `sympy.lambdify` of the printed form, in one process.",
        "",
        "| function | elements | ns an element | times faster than lambdify | than with cse |",
        "| --- | ---: | ---: | ---: | ---: |",
    )
    for row in found.printed:
        each = _three(1e9 * row.generated / row.size)
        ratios = f"{row.plain / row.generated:.2f} | {row.cse / row.generated:.2f}"
        yield f"| {row.name} | {row.size:,} | {each} | {ratios} |"
    yield ""


def _scalar_table(found: Found) -> Iterator[str]:
    functions = [f.name for f in CONTRACT if any(f.name in row for row in found.scalars.values())]
    yield from (
        "## A call with plain numbers",
        "",
        "Microseconds, of explicit formulas.",
        "",
        f"| body | {' | '.join(functions)} |",
        "| --- |" + " ---: |" * len(functions),
    )
    for body, row in found.scalars.items():
        each = [f"{1e6 * row[f]:.1f}" if f in row else "" for f in functions]
        yield f"| {body} | {' | '.join(each)} |"
    yield ""


def _stage_table(found: Found) -> Iterator[str]:
    names = [*next(iter(found.stages.values()))]
    yield from (
        "## From g(x) to a module",
        "",
        "Seconds of each stage, on one core; `derive generate` builds several bodies at once.",
        "",
        f"| body | {' | '.join(names)} | all |",
        "| --- |" + " ---: |" * (len(names) + 1),
    )
    for body, row in found.stages.items():
        each = " | ".join(f"{t:.1f}" for t in row.values())
        yield f"| {body} | {each} | {sum(row.values()):.1f} |"
    yield ""


def _three(value: float) -> str:
    """Three digits, in an exponent where the value is tiny."""
    if value >= 100:
        return f"{float(f'{value:.3g}'):,.0f}"
    return f"{value:#.3g}"


@click.command()
@click.option("--seconds", default=1.0, help="Time for each function and size.")
@click.option("--largest", default=SIZES[-1], help="Leave out sizes above this.")
@click.option("--body", "bodies", multiple=True, help="Derive these alone.")
@click.option("--to", default=PAGE, type=click.Path(path_type=Path), help="The page to write.")
def main(seconds: float, largest: int, bodies: tuple[str, ...], to: Path) -> None:
    """Measure, print the page, keep it with its picture."""
    columns = TextColumn("{task.description:32}"), BarColumn(), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True)) as progress:
        task = progress.add_task("", total=parts(bodies))
        begun = iter(range(parts(bodies)))

        def told(what: str) -> None:
            progress.update(task, completed=next(begun), description=what)

        found = measured(largest, seconds, bodies, told)
    text = page(found)
    to.write_text(text, encoding="utf-8")
    draw(found.curves, to.with_suffix(".svg"))
    click.echo(text)


if __name__ == "__main__":
    main()
