"""`make solver`: run all cycles on fine meshes, on all cores, and write FINDINGS.md."""

from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from tests.measure.page import write
from tests.measure.solver.report import findings

FINDINGS = Path(__file__).parents[2] / "reference" / "FINDINGS.md"

if __name__ == "__main__":
    with ProcessPoolExecutor() as pool:
        write(FINDINGS, *findings(lambda *work: [*pool.map(*work)]))
