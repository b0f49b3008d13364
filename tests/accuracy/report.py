"""`make accuracy`: docs/accuracy.md, the worst relative error of every generated function.

Functions are measured in processes of their own, as many at once as there are cores.
"""

from collections.abc import Sequence
from pathlib import Path

import click

from derive.library import library
from derive.parallel import Report, cores, in_processes
from tests.accuracy.measure import BOUNDS, CATALOGUE, EXACT, EXPLICIT, Worst, worst_of
from tests.accuracy.regions import REGIONS

PAGE = Path(__file__).parents[2] / "docs" / "accuracy.md"

Task = tuple[str, str, int]
"""A body, one of its functions, points a region."""

WORDS = f"""\
# Accuracy

Made by `make accuracy`: the worst relative error of each function at random float64 inputs, up to
%d a region, fewer where the reference is dear, against many digits of mpmath and python-flint.
The reference of a formula is the proven formula, of an integral its definition, of what is solved
for the equations, solved again from the very same inputs.

Errors are relative to the number itself; those of edges, stick and slip zones to the width a + c of
the contact, of a tilt to P/(E* (a + c)), of a moment to P (a + c), of L_N to K_N/(a + c) if that is
larger, of K_T, L_T, stick_margin and closing_tension to the larger of both, of shear to the
friction 2 f p at x.

Regions: contacts in the bulk; edges, places or stick-zone edges beside a kink, and places beside an
edge, at 1e-9 to a tenth of the width; widths over 24 decades (six where the pressure is an
integral), contacts down to 1e-8 of the width on one side, and lengths of the body six decades
apart.

Bounds: {BOUNDS[True]:.0e} in the bulk and {BOUNDS[False]:.0e} elsewhere; explicit formulas of
{", ".join(EXACT)}: {EXPLICIT:.0e}.  An error within its bound, or within what rounding the inputs
explains (some units in the last place times the problem's condition), meets it; `~` marks the
latter, **bold** what does not meet it.  In brackets: points of so many that gave no number, or have
no solution beside it.  A dash: not measured, there is no such region or a point would take minutes.

"""


def measured(task: Task, report: Report) -> list[Worst]:
    """All regions of one function."""
    body, function, count = task
    report(body, function)
    return [*worst_of(body, function, count)]


def page(rows: Sequence[Worst], count: int) -> str:
    """The tables in Markdown, one a body, and what meets its bound."""
    bodies, lines = sorted({row.body for row in rows}), [WORDS % count]
    found = {(row.body, row.function, row.region): row for row in rows}
    beyond = [row for row in rows if not row.met]
    lines += [f"Of {len(rows)} figures {len(rows) - len(beyond)} meet their bound.", ""]
    for body in bodies:
        lines += [f"## {body}", "", "| function | " + " | ".join(REGIONS) + " |"]
        lines += ["| --- |" + " ---: |" * len(REGIONS)]
        for entry in CATALOGUE:
            its = [found.get((body, entry.name, region)) for region in REGIONS]
            if any(its):
                lines.append(f"| {entry.name} | " + " | ".join(map(_cell, its)) + " |")
        lines.append("")
    if beyond:
        lines += ["## Beyond their bounds", ""]
    for row in beyond:
        inputs = ", ".join(f"{name} = {value!r}" for name, value in row.point.items())
        what = f"{row.body}, {row.function}, {row.region}: {row.error:.1e}"
        lines += [f"- {what}, condition {row.condition:.1e}, at {inputs}"]
    return "\n".join(lines).rstrip() + "\n"


def _cell(row: Worst | None) -> str:
    if row is None:
        return "-"
    number = f"{row.error:.1e}"
    shown = number if row.met else f"**{number}**"
    explained = "~" if row.met and row.condition else ""
    return explained + shown + (f" ({row.lost} of {row.points})" if row.lost else "")


@click.command()
@click.option("--count", default=200, help="Points a region of explicit formulas.")
@click.option("--quick", is_flag=True, help="Ten points a region, of hertz and flat_rounded.")
@click.option("--body", "bodies", multiple=True, help="Bodies; all if none is named.")
@click.option("--output", default=PAGE, type=click.Path(path_type=Path), help="The page.")
def main(count: int, quick: bool, bodies: tuple[str, ...], output: Path) -> None:
    """Measure and write the page."""
    bodies, count = (("hertz", "flat_rounded"), 10) if quick else (bodies, count)
    tasks = [(body, entry.name, count) for body in bodies or library() for entry in CATALOGUE]
    rows: list[Worst] = []
    for found in in_processes(measured, tasks, lambda *_: None, cores()):
        rows += found
    text = page(rows, count)
    output.write_text(text, encoding="utf-8")
    print(f"{sum(row.met for row in rows)} of {len(rows)} figures meet their bound: {output}")


if __name__ == "__main__":
    main()
