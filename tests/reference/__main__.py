"""`python -m tests.reference`: all cycles on fine meshes, written to FINDINGS.md."""

from pathlib import Path

import click
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from tests.reference.report import CYCLES, findings

FINDINGS = Path(__file__).with_name("FINDINGS.md")


@click.command()
@click.option("--out", type=click.Path(path_type=Path), default=FINDINGS, help="Markdown file.")
def main(out: Path) -> None:
    """Compare the solver with what is known, and explore what is not."""
    columns = TextColumn("{task.description:50}"), BarColumn(), MofNCompleteColumn()
    with Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True)) as progress:
        task = progress.add_task("", total=CYCLES + 1)

        def step(description: str) -> None:
            progress.update(task, advance=1, description=description)

        text = findings(step)
        step("written")
    out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
