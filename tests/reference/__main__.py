"""`python -m tests.reference`: all cycles on fine meshes, written to FINDINGS.md."""

from pathlib import Path

import click

from tests.reference.parallel import at_once
from tests.reference.report import CYCLES, findings

FINDINGS = Path(__file__).with_name("FINDINGS.md")


@click.command()
@click.option("--out", type=click.Path(path_type=Path), default=FINDINGS, help="Markdown file.")
@click.option("--jobs", type=click.IntRange(1), default=None, help="Processes; all cores if left.")
def main(out: Path, jobs: int | None) -> None:
    """Compare the solver with what is known, and explore what is not."""
    with at_once(CYCLES, jobs) as work:
        text = findings(work)
    out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
