"""`make accuracy`: docs/accuracy.md, the worst error of every generated function.

The bodies are measured in processes of their own, as many at once as there are cores.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

import click
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from derive.library import library
from derive.parallel import Report, cores, in_processes
from tests.accuracy.measure import (
    CLOSED,
    LIMITS,
    PARTS,
    SOLVED,
    WELL,
    Worst,
    functions,
    share_of,
    worst_of,
    worst_rows,
)

PAGE = Path(__file__).parents[2] / "docs" / "accuracy.md"

Task = tuple[str, str, int]
"""A body, one of its functions, points a region."""


def measured(task: Task, report: Report) -> list[Worst]:
    """All regions of one function."""
    body, function, count = task
    report(body, function)
    return [*worst_of(body, count, function)]


def tasks(bodies: Iterable[str], count: int) -> list[Task]:
    """Every function of the bodies, those first that take longest."""
    found = [(body, function, count) for body in bodies for function in functions(body)]
    return sorted(found, key=lambda task: share_of(*task[:2]))


def page(rows: list[Worst], count: int, regions: bool = False) -> str:
    """The tables in Markdown, a section a body."""
    most, few, least = (max(1, round(share * count)) for share in (0.2, 0.05, 0.01))
    lines = [
        "# Accuracy",
        "",
        f"Made by `make accuracy`: random float64 inputs, {count} a region for closed formulas",
        f"and fewer where the reference is dear: {most} to {few} for most functions of partial",
        f"slip, {few} where the pressure is an integral, {least} or more for slip, marches and",
        "large tension; against many digits of mpmath and python-flint.",
        "The reference of a formula is the proven formula itself with 60 digits or more; of an",
        "integral, its definition, by a quadrature of its own; of what is solved for, the",
        "equations solved in many digits from the very same inputs, and so is the stick zone from",
        "which a shear or a slip is told.  A march is judged at one instant on the way up and one",
        "after the reversal.",
        "",
        "- ulp: largest error in units in the last place of the exact value, and the condition of",
        "  the problem at that point: how many times larger the relative change of the result is",
        "  than that of the inputs, summed over them.  Half a unit in each input explains as much.",
        f"- well: largest error among problems whose condition is at most {WELL:g}.",
        "- ulp/condition: largest error over the condition (at least 1) of its point; 4 or less is",
        "  what closed formulas are held to, sums over the parts between kinks, and contacts that",
        "  are solved for.",
        "- lost: points at which the function gave no number, or none next to a solution.",
        "- paper: worst error of the printed form, where there is one.",
        "",
        "Regions: contacts in the bulk; widths, or loads, over 24 decades; lopsided ones, down to",
        "1e-8 of the width on one side of the origin, at extreme widths, too; nearly level; an",
        "edge beside a kink, from 1e-15 to a tenth of the body's size, of common contacts and, but",
        "for cycles, of some up to 1e4 times as wide as that size; x beside each edge, and beside",
        "each kink to 1e-300, beside the origin where a smooth body is integrated, and outside the",
        "parts between kinks, a tenth to ten of their lengths away; tilts near their limit;",
        "parameters six decades apart, and exponents from 1.06 to 60; tiny slip zones, down to",
        "1e-12 of the load; tension near its threshold; normal loads that vary, where the program",
        "calls the cycle moderate; x beside an end of the stick zone, to 1e-10 of the slip zone.",
        "Integrated bodies are not tried at extreme widths.  Of large tension, what the program",
        "calls mixed is left out.",
        "",
        "Digits that the problem keeps are lost where order 3 of an integrated body is asked",
        "for, or the error of its order 2: the third coefficient follows from differences of",
        "L_N, and is right to eight digits or more. What else is solved or integrated for a",
        "cycle stays within some hundreds of times the condition; the stick zone of a contact",
        "that a corner or a curve has just joined, and the change of shear there, within some",
        "thousands. Of power order 3 and large tension are not tried, nor of integrated bodies",
        "slip: one point would take minutes.",
        "",
        "Of a contact that is solved for the edges are measured. Its tilt under a moment is",
        "right to the rounding of P/(E* (a + c)), and so to fewer digits of its own where the",
        "contact is nearly level. Not among the regions: contacts at a tilt that reach over one",
        "shoulder of a flat by less than 1e-8 of it, of which the other edge is right to 1e-5 of",
        "its length at worst, or none is found; an edge within 1e-5 of a circular arc's end, some",
        "thousands of times the condition; and the apex of power beyond an edge by 1e-11 of the",
        "contact or less, exponents below 1.5, where no contact is found.",
        "",
    ]
    grouped = worst_rows(rows)
    for body in sorted({row.body for row in rows}):
        lines += [f"## {body}", "", *_header()]
        for function in functions(body):
            found = grouped.get((body, function), [])
            shown = found if regions or not found else [_summed(found)]
            lines += [_line(function, row) for row in shown]
        lines.append("")
    return "\n".join([*lines, *_worst_points(rows)])


def _header() -> Iterator[str]:
    numbers = "ulp | condition | well | ulp/condition | points | lost | paper"
    yield f"| function | by | worst in | {numbers} |"
    yield "| --- | --- | --- |" + " ---: |" * 7


def _line(function: str, row: Worst) -> str:
    name = f"{function}.{row.output}" if row.output else function
    paper = "" if row.paper is None else _short(row.paper)
    numbers = " | ".join(map(_short, (row.ulp, row.condition, row.well, row.excess)))
    counts = f"{row.points:,} | {row.lost or ''}"
    return f"| {name} | {row.kind} | {row.region} | {numbers} | {counts} | {paper} |"


def _summed(rows: list[Worst]) -> Worst:
    """The worst of several regions and outputs, each number by itself."""
    worst = max(rows, key=lambda row: row.ulp)
    over = max(rows, key=lambda row: row.excess)
    papers = [row.paper for row in rows if row.paper is not None]
    return replace(
        worst,
        points=sum(row.points for row in rows),
        lost=sum(row.lost for row in rows),
        well=max(row.well for row in rows),
        excess=over.excess,
        over=over.over,
        paper=max(papers) if papers else None,
    )


def _worst_points(rows: list[Worst]) -> Iterator[str]:
    """Where formulas, and contacts that are solved for, miss what they are held to."""
    held = (CLOSED, PARTS, SOLVED)
    missed = [r for r in rows if r.kind in held and r.excess > LIMITS[r.kind]]
    yield from ("## Closed formulas and contacts beyond 4 times the condition", "")
    if not missed:
        yield from ("None.", "")
    for row in missed:
        place = ", ".join(f"{name} = {value!r}" for name, value in row.over.items())
        name = f"{row.body}.{row.function}{row.output and '.' + row.output}"
        yield from (f"- {name}, {row.region}: {_short(row.excess)} at {place}", "")


def _short(value: float) -> str:
    return f"{value:.2g}" if value < 1e3 else f"{value:.1e}"


@click.command()
@click.option("--count", default=120, help="Random points a region.")
@click.option("--body", "bodies", multiple=True, help="Measure these alone.")
@click.option("--regions", is_flag=True, help="A line for each region and output.")
@click.option("--jobs", default=0, help="Processes; as many as there are cores.")
@click.option("--to", default=PAGE, type=click.Path(path_type=Path), help="The page to write.")
def main(count: int, bodies: tuple[str, ...], regions: bool, jobs: int, to: Path) -> None:
    """Measure every function of every body, print the page, keep it."""
    todo = tasks(bodies or library(), count)
    columns = TextColumn("{task.description:44}"), BarColumn(), MofNCompleteColumn()
    with Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True)) as progress:
        bar = progress.add_task("", total=len(todo))

        def told(body: str, function: str) -> None:
            progress.update(bar, advance=1, description=f"{body}.{function}")

        found = in_processes(measured, todo, told, jobs or cores())
    text = page([row for rows in found for row in rows], count, regions)
    to.write_text(text, encoding="utf-8")
    click.echo(text)


if __name__ == "__main__":
    main()
