"""`python -m tests.measure.solver`: run all cycles on fine meshes, and write FINDINGS.md."""

from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import click

from tests.measure.page import write
from tests.measure.solver.report import findings

FINDINGS = Path(__file__).parents[2] / "reference" / "FINDINGS.md"


@click.command()
@click.option("--out", type=click.Path(path_type=Path), default=FINDINGS, help="Output file.")
@click.option("--jobs", type=click.IntRange(1), default=None, help="Processes; default: all cores.")
def main(out: Path, jobs: int | None) -> None:
    """Compare the solver with known stick zones, and explore cycles whose stick zone is unknown."""
    with ProcessPoolExecutor(jobs) as pool:
        write(out, *findings(lambda *work: [*pool.map(*work)]))


if __name__ == "__main__":
    main()
