"""`make accuracy`: write docs/accuracy.md, the largest relative error of every generated function.

Each function is measured in its own process, and as many processes run at once as there are cores.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

import click

from derive.body.library import library
from derive.command.processes import Report, cores, in_processes
from tests.measure.accuracy.measure import BOUNDS, CATALOGUE, EXACT, EXPLICIT, Worst, worst_of
from tests.measure.accuracy.regions import REGIONS
from tests.measure.page import table, write

PAGE = Path(__file__).parents[3] / "docs" / "accuracy.md"

Task = tuple[str, str, int]
"""A body, one of its functions, and the number of points per region."""

WORDS = f"""\
# Accuracy

This page is written by `make accuracy`.  The tables give the largest relative error of each
function at random float64 inputs, with up to %d points per region, or fewer if the reference is
expensive to compute.  The reference values are computed with many digits by mpmath and
python-flint.  The reference of a formula is the formula on the sheet, and that of an integral is
its definition.  For a quantity that is found by solving equations, it is their solution for exactly
the same inputs.

Errors are relative to the value itself, with the following exceptions:

| quantity | relative to |
| --- | --- |
| contact edges, stick zones, slip zones | the contact width a + c |
| tilt | P/(E* (a + c)) |
| moment | P (a + c) |
| L_N | the larger of L_N and K_N/(a + c) |
| K_T, L_T, stick_margin | the larger of the two values of the result |
| shear, shear_change | the friction limit 2 f p at x |

There are three regions of inputs:

- "Bulk" means ordinary contacts and positions.
- "Near kinks and edges" means that an edge or a stick-slip boundary lies next to a kink, or that
  the position x lies next to a kink or an edge, at a distance of 1e-9 to 0.1 of the width.
- "Extreme" means widths over 24 decades (six decades if the pressure is an integral), contacts that
  reach only 1e-8 of the width to one side, and dimensions of the body that differ by up to six
  decades.

The bounds are {BOUNDS[True]:.0e} in the bulk and {BOUNDS[False]:.0e} elsewhere.  The bound is
{EXPLICIT:.0e} in every region for explicit formulas of
{", ".join(EXACT)}.
An error meets its bound if it lies within the bound or if rounding of the inputs explains it, that
is, if it is no more than a few units in the last place times the condition of the problem.  `~`
marks an error that rounding of the inputs explains, and **bold** marks an error that does not meet
its bound.  The numbers in parentheses are the number of points at which the function returned no
number or no solution was found near its result, and the total number of points.  A dash means that
nothing was measured, because the body has no such region or a point would take minutes.
"""


BEYOND = """\
Each entry gives the body, the function and the region, then the largest error, the condition of the
problem, and the inputs."""


def measured(task: Task, report: Report) -> list[Worst]:
    """Measure one function in all regions."""
    body, function, count = task
    report(body, function)
    return [*worst_of(body, function, count)]


def page(rows: Sequence[Worst], count: int) -> Iterator[str]:
    """The parts of the page: a table per body, and the errors that exceed their bounds."""
    by_key = {(row.body, row.function, row.region): row for row in rows}
    beyond = [row for row in rows if not row.met]
    yield WORDS % count
    yield f"Of {len(rows)} figures, {len(rows) - len(beyond)} meet their bounds."
    for body in sorted({row.body for row in rows}):
        found = {e.name: [by_key.get((body, e.name, at)) for at in REGIONS] for e in CATALOGUE}
        lines = [[name, *map(_cell, cells)] for name, cells in found.items() if any(cells)]
        yield f"## {body}"
        yield table(["function", *REGIONS], lines)
    if beyond:
        yield f"## Errors beyond their bounds\n\n{BEYOND}"
        yield "\n".join(map(_entry, beyond))


def _entry(row: Worst) -> str:
    inputs = ", ".join(f"{name} = {value!r}" for name, value in row.point.items())
    entry_of = f"{row.body}, {row.function}, {row.region}: {row.error:.1e}"
    return f"- {entry_of}, condition {row.condition:.1e}, at {inputs}"


def _cell(row: Worst | None) -> str:
    if row is None:
        return "-"
    number = f"{row.error:.1e}"
    shown = number if row.met else f"**{number}**"
    explained = "~" if row.met and row.condition else ""
    return explained + shown + (f" ({row.lost} of {row.points})" if row.lost else "")


@click.command()
@click.option("--count", default=200, help="Points per region for explicit formulas.")
@click.option(
    "--body",
    "bodies",
    multiple=True,
    help="A body to measure; may be repeated; all bodies by default.",
)
@click.option("--output", default=PAGE, type=click.Path(path_type=Path), help="The page to write.")
def main(count: int, bodies: tuple[str, ...], output: Path) -> None:
    """Measure the functions and write the page."""
    tasks = [(body, entry.name, count) for body in bodies or library() for entry in CATALOGUE]
    rows: list[Worst] = []
    for worst in in_processes(measured, tasks, lambda *_: None, cores()):
        rows += worst
    write(output, *page(rows, count))


if __name__ == "__main__":
    main()
