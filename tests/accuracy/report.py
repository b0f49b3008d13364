"""`make accuracy`: the worst point of every generated function, and what the paper's form loses."""

import click
from rich.console import Console
from rich.progress import track
from rich.table import Table

from tests.accuracy.measure import Worst, worst_of
from tests.accuracy.regions import BODIES


def table(rows: list[Worst]) -> Table:
    """One line a region and output, the worst point beside its error."""
    shown = Table(
        "function",
        "region",
        "ulp",
        "condition",
        "paper's form, ulp",
        "worst point",
        title="Worst error in units in the last place, against mpmath at 60 digits or more",
    )
    for row in rows:
        place = ", ".join(f"{name}={value!r}" for name, value in row.point.items())
        shown.add_row(
            f"{row.body}.{row.function}{row.output and '.' + row.output}",
            row.region,
            f"{row.ulp:.2f}",
            f"{row.condition:.2g}",
            "-" if row.paper is None else f"{row.paper:.2g}",
            place,
        )
    return shown


@click.command()
@click.option("--count", default=2000, help="Random points a region.")
def main(count: int) -> None:
    """Measure every function of the bodies that are closed both ways."""
    rows = [
        row
        for body in track(BODIES, description="measuring", console=Console(stderr=True))
        for row in worst_of(body, count)
    ]
    Console(width=200).print(table(rows))


if __name__ == "__main__":
    main()
