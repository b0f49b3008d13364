"""`python -m tests.reference`: run all cycles on fine meshes, and write FINDINGS.md."""

from pathlib import Path

import click

from tests.reference.parallel import at_once
from tests.reference.report import CYCLES, findings

FINDINGS = Path(__file__).with_name("FINDINGS.md")


@click.command()
@click.option("--out", type=click.Path(path_type=Path), default=FINDINGS, help="Output file.")
@click.option("--jobs", type=click.IntRange(1), default=None, help="Processes; default: all cores.")
def main(out: Path, jobs: int | None) -> None:
    """Compare the solver with known stick zones, and explore cycles whose stick zone is unknown."""
    with at_once(CYCLES, jobs) as work:
        text = findings(work)
    out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
