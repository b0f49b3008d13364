"""Time and peak memory of examples/monte_carlo.py, as its samples grow.

    python -m tests.benchmarks.monte_carlo        the table, also kept in notebooks/monte_carlo.md

Each run is a process of its own, with two workers.  Memory is that of the process and all that it
starts, sampled every INTERVAL seconds; pages that processes share are counted once (PSS).
"""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from time import perf_counter, sleep
from typing import NamedTuple

import psutil

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "monte_carlo.py"
TABLE = ROOT / "notebooks" / "monte_carlo.md"
COUNTS = (10**6, 10**7, 10**8)
WORKERS = 2
INTERVAL = 0.1


class Run(NamedTuple):
    """One run: wall time, processor time of all processes, peak memory of all, what it found."""

    samples: int
    seconds: float
    busy: float
    peak: float
    report: str


def measured(samples: int) -> Run:
    """Run the example and watch it."""
    command = [sys.executable, str(EXAMPLE), f"--samples={samples}", f"--workers={WORKERS}"]
    start, peak, busy = perf_counter(), 0.0, 0.0
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True) as run:
        root = psutil.Process(run.pid)
        while run.poll() is None:
            seen = [*_held(root)]
            peak = max(peak, sum(memory for memory, _ in seen))
            busy = max(busy, sum(time for _, time in seen))
            sleep(INTERVAL)
        assert run.stdout is not None
        printed = run.stdout.read()
    if run.returncode:
        raise SystemExit(f"{' '.join(command)} failed")
    report = printed[printed.index(f"{samples:,} samples") :]  # behind the progress bar
    return Run(samples, perf_counter() - start, busy, peak, report)


def _held(root: psutil.Process) -> Iterator[tuple[float, float]]:
    """Memory and processor time of a process and all that come from it."""
    with suppress(psutil.Error):
        for process in (root, *root.children(recursive=True)):
            with suppress(psutil.Error):
                times = process.cpu_times()
                yield process.memory_full_info().pss, times.user + times.system


def table(runs: list[Run]) -> str:
    """The table in Markdown, and the last run's distribution."""
    lines = [
        "# A Monte Carlo of the slip zone",
        "",
        "Made by `make bench-monte-carlo`: `examples/monte_carlo.py`, one process and two workers.",
        "Samples of load, moment and friction go through `wedge.contact` and `wedge.stick_zone` as",
        "Dask arrays, chunk by chunk.  Peak memory is that of all processes together; processor",
        "time is their sum, two seconds of it for starting them.",
        "",
        "| samples | wall time [s] | processor time [s] | ns a sample | peak memory [MB] |",
        "| ---: | ---: | ---: | ---: | ---: |",
    ]
    for run in runs:
        each = 1e9 * run.busy / run.samples
        lines.append(
            f"| {run.samples:,} | {run.seconds:.1f} | {run.busy:.1f} | {each:.0f} "
            f"| {run.peak / 1e6:.0f} |"
        )
    lines += ["", "The last of them found:", "", "```text"]
    lines += (line.rstrip() for line in runs[-1].report.splitlines())
    return "\n".join([*lines, "```", ""])


def main() -> None:
    """Measure, print, keep."""
    text = table([measured(samples) for samples in COUNTS])
    TABLE.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
