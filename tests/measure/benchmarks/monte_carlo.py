"""`make bench-monte-carlo`: time and peak memory of examples/monte_carlo.py.

Each run is a separate process with two workers.  The memory is that of the process and all its
children, measured every INTERVAL seconds.  Pages that processes share are counted once (PSS).
"""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from time import perf_counter, sleep
from typing import NamedTuple

import psutil

from tests.measure.page import table, write

ROOT = Path(__file__).parents[3]
EXAMPLE = ROOT / "examples" / "monte_carlo.py"
TABLE = ROOT / "notebooks" / "monte_carlo.md"
COUNTS = (10**6, 10**7, 10**8)
WORKERS = 2
INTERVAL = 0.1


class Run(NamedTuple):
    """One run.

    seconds  wall time
    busy     processor time of all processes
    peak     peak memory of all processes together
    report   the distribution that the example prints
    """

    samples: int
    seconds: float
    busy: float
    peak: float
    report: str


def measured(samples: int) -> Run:
    """Run the example and measure it."""
    command = [sys.executable, str(EXAMPLE), f"--samples={samples}", f"--workers={WORKERS}"]
    start, peak, busy = perf_counter(), 0.0, 0.0
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True) as run:
        root = psutil.Process(run.pid)
        while run.poll() is None:
            usage = [*_usage(root)]
            peak = max(peak, sum(memory for memory, _ in usage))
            busy = max(busy, sum(time for _, time in usage))
            sleep(INTERVAL)
        assert run.stdout is not None
        printed = run.stdout.read()
    if run.returncode:
        raise SystemExit(f"{' '.join(command)} failed")
    report = printed[printed.index(f"{samples:,} samples") :]  # without the progress bar
    return Run(samples, perf_counter() - start, busy, peak, report)


def _usage(root: psutil.Process) -> Iterator[tuple[float, float]]:
    """Memory and processor time of a process and of each of its descendants."""
    with suppress(psutil.Error):
        for process in (root, *root.children(recursive=True)):
            with suppress(psutil.Error):
                times = process.cpu_times()
                yield process.memory_full_info().pss, times.user + times.system


TEXT = """
# Monte Carlo simulation of the slip zone

Written by `make bench-monte-carlo`, which runs `examples/monte_carlo.py` in one process
with two workers.  Samples of load, moment and coefficient of friction are passed to
`wedge.contact` and `wedge.stick_zone` as Dask arrays, chunk by chunk.  Peak memory and
processor time are those of all processes together.  About two seconds of the processor
time are needed to start them.
"""
HEAD = ["samples", "wall time [s]", "processor time [s]", "ns per sample", "peak memory [MB]"]


def row(run: Run) -> list[str]:
    """The cells of one run."""
    each = f"{1e9 * run.busy / run.samples:.0f}"
    times = f"{run.seconds:.1f}", f"{run.busy:.1f}"
    return [f"{run.samples:,}", *times, each, f"{run.peak / 1e6:.0f}"]


if __name__ == "__main__":
    runs = [measured(samples) for samples in COUNTS]
    report = "\n".join(line.rstrip() for line in runs[-1].report.splitlines())
    rows = table(HEAD, map(row, runs), words=0)
    write(TABLE, TEXT, rows, "Result of the last run:", f"```text\n{report}\n```")
