"""Compute how far a wedge slips if its loads and its friction scatter, by the Monte Carlo method.

    python examples/monte_carlo.py                               1e7 samples, on this machine
    python examples/monte_carlo.py --samples 1e8 --out slip.csv  1e8 samples and a histogram file
    python examples/monte_carlo.py --scheduler tcp://host:8786   on a running cluster

The program needs `pip install 'contact-derive[cluster]'`.  Only the code that draws and counts the
samples depends on Dask: `slip_zones` below also accepts NumPy arrays.

Samples are drawn, evaluated and counted chunk by chunk.  A new portion of PORTION chunks is handed
out only when another one is finished, so that memory use does not grow with the number of samples.
Every STREAM samples have a seed of their own.  The counts are therefore exactly the same for any
size of the chunks, any number of workers, and any order in which the workers finish.

To use a cluster of your own, start `dask scheduler` on one machine and
`dask worker tcp://host:8786` on each machine, and give this address with `--scheduler`.  Clusters
of batch systems and clouds also have an address.  The program sends the package `generated` to the
cluster.  NumPy, numba and Dask must be installed there, in the same versions as on this machine.
"""

import argparse
import csv
import logging
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import dask.array as da
import numpy as np
from dask.config import set as dask_settings
from distributed import Client, LocalCluster, as_completed
from rich.progress import Progress

import generated
from generated import wedge

E_STAR, PHI = 60e9, 0.05  # Pa, rad
DQ, DSIGMA = 3e5, 400e6  # changes in shear load [N/m] and bulk tension [Pa] in a half-cycle

SCATTER: Mapping[str, Callable[[np.random.Generator, int], Any]] = {
    "P": lambda rng, n: rng.normal(2e6, 2e5, n),  # N/m
    "M": lambda rng, n: rng.normal(100.0, 30.0, n),  # N
    "f": lambda rng, n: rng.lognormal(np.log(0.5), 0.15, n),
}
"""The uncertain inputs: replace them with your own."""

STREAM = 50_000
"""Number of samples that share a seed."""

PORTION = 8
"""Number of chunks that are handed out together, as one Dask array."""

SHORT = {
    "distributed.diagnostics.computations.max-history": 1,
    "distributed.admin.low-level-log-length": 100,
    "distributed.admin.log-length": 100,
}
"""Limits on the records that a local cluster keeps; without them, its memory use grows slowly."""

BINS, LONGEST = 2_000, 500.0
"""Number of bins of the histogram, and the longest slip zone that it covers [um]."""

QUANTILES = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99)


class Counts(NamedTuple):
    """Number of samples in each bin of the left and the right slip zone, and in each regime."""

    left: Any
    right: Any
    regime: Any


def drawn(name: str, seed: int, start: int, stop: int) -> Any:
    """Samples from `start` to `stop` of one quantity; a stream must begin at `start`."""
    place = [*SCATTER].index(name)
    streams = range(start // STREAM, -(-stop // STREAM))
    rows = [SCATTER[name](np.random.default_rng([seed, place, s]), STREAM) for s in streams]
    return np.concatenate(rows)[: stop - start]


def slip_zones(P: Any, M: Any, f: Any) -> tuple[Any, Any, Any]:
    """Slip zones at the left and the right edge [um], and the regime."""
    state = wedge.contact(P, M, E_star=E_STAR, phi=PHI)
    zone = wedge.stick_zone(state, state, DQ, DSIGMA, f=f, E_star=E_STAR, phi=PHI)
    return 1e6 * (state.a - zone.m), 1e6 * (state.c - zone.n), zone.regime


def counted(start: int, stop: int, chunk: int, seed: int) -> da.Array:
    """All counts of some samples as one lazy array; nothing is drawn yet."""
    whole, rest = divmod(stop - start, chunk)
    sizes = (*[chunk] * whole, *([rest] if rest else []))

    def some(name: str, block_info: Any = None) -> Any:
        first, last = block_info[None]["array-location"][0]
        return drawn(name, seed, start + first, start + last)

    P, M, f = (da.map_blocks(some, name, chunks=(sizes,), dtype=float) for name in SCATTER)
    left, right, regime = slip_zones(P, M, f)
    bins = {"bins": BINS, "range": (0.0, LONGEST)}
    counts = [da.histogram(zone, **bins)[0] for zone in (left, right)]
    return da.concatenate([*counts, da.bincount(regime, minlength=len(wedge.Regime))])


def summed(client: Client, samples: int, chunk: int, seed: int) -> Counts:
    """Counts of all samples; only a few portions are computed at once, however many there are."""
    starts = range(0, samples, PORTION * chunk)
    portions = (counted(s, min(s + PORTION * chunk, samples), chunk, seed) for s in starts)
    threads: Any = client.nthreads()
    ahead = 1 + sum(threads.values())
    running = as_completed(map(client.compute, islice(portions, ahead)))
    total = np.zeros(2 * BINS + len(wedge.Regime), dtype=np.int64)
    with Progress() as bar:
        task = bar.add_task("portions of samples", total=len(starts))
        for future in running:
            total += future.result().astype(np.int64)
            running.update(map(client.compute, islice(portions, 1)))
            bar.advance(task)
    return Counts(*np.split(total, [BINS, 2 * BINS]))


def quantiles(counts: Any) -> list[float]:
    """Quantiles of the counted lengths [um], accurate to the width of a bin."""
    below = np.concatenate([[0], np.cumsum(counts)])
    edges = np.linspace(0.0, LONGEST, BINS + 1)
    return [float(v) for v in np.interp(np.multiply(QUANTILES, below[-1]), below, edges)]


def report(counts: Counts) -> Iterator[str]:
    """Quantiles, regimes and a rough histogram, line by line."""
    total = int(np.sum(counts.regime))
    yield f"{total:,} samples; slip zones in um, to {LONGEST / BINS:g}"
    yield "edge  " + "".join(f"{100 * q:7g} %" for q in QUANTILES) + "   not counted"
    for edge, found in zip(("left", "right"), counts[:2], strict=True):
        rest = total - int(np.sum(found))  # zone not known or longer than LONGEST
        yield f"{edge:6}" + "".join(f"{v:9.1f}" for v in quantiles(found)) + f"{rest:14,}"
    for regime in wedge.Regime:
        if counts.regime[regime]:
            yield f"{regime.name:11} {100 * counts.regime[regime] / total:8.4f} %"
    rough = counts.left.reshape(50, -1).sum(axis=1)
    used = np.flatnonzero(rough >= 0.001 * rough.max())
    for i in range(used.min(), used.max() + 1) if used.size else ():
        bar = "#" * round(60 * rough[i] / rough.max())
        yield f"left {LONGEST * i / 50:5.0f} to {LONGEST * (i + 1) / 50:3.0f} um  {bar}"


def write(counts: Counts, path: Path) -> None:
    """Write the histogram as CSV."""
    edges = np.linspace(0.0, LONGEST, BINS + 1)
    with path.open("w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow(["from [um]", "to [um]", "left", "right"])
        out.writerows(zip(edges, edges[1:], counts.left, counts.right, strict=False))


@contextmanager
def connected(scheduler: str | None, workers: int | None, wait: int) -> Iterator[Client]:
    """Connect to a running cluster that answers within `wait` seconds, or start local processes."""
    if scheduler is None:
        local: dict[str, Any] = {"n_workers": workers, "threads_per_worker": 1}
        local["dashboard_address"] = "127.0.0.1:0"  # any free port, so that runs do not collide
        local["silence_logs"] = logging.CRITICAL  # errors are raised in this process
        with dask_settings(SHORT), LocalCluster(**local) as cluster, Client(cluster) as client:
            yield client
        return
    try:
        client = Client(scheduler, timeout=wait)
    except (OSError, ValueError) as error:
        raise SystemExit(f"no cluster answers at {scheduler}: {error}") from None
    with client, tempfile.TemporaryDirectory() as folder:
        home = Path(generated.__file__).parent
        package = shutil.make_archive(f"{folder}/generated", "zip", home.parent, home.name)
        client.upload_file(package)
        try:
            client.wait_for_workers(1, timeout=60)
        except TimeoutError:
            raise SystemExit(
                f"no worker joined {scheduler} within a minute: start `dask worker {scheduler}`"
            ) from None
        yield client


def number(text: str) -> int:
    """A whole number, such as 1e8 or 100000000."""
    with suppress(ValueError, OverflowError):
        if float(text) >= 1 and float(text) == int(float(text)):
            return int(float(text))
    raise argparse.ArgumentTypeError(f"must be a whole number, such as 1e8 or 1000000, got {text}")


def arguments() -> argparse.Namespace:
    """Read the command line."""
    said = argparse.ArgumentParser(description="Distribution of a wedge's slip zones.")
    said.add_argument("--samples", type=number, default=10**7, help="how many; default 1e7")
    said.add_argument(
        "--chunk", type=number, default=5 * STREAM, help=f"size of a chunk, a multiple of {STREAM}"
    )
    said.add_argument("--seed", type=int, default=0, help="seed of the random numbers, >= 0")
    said.add_argument("--workers", type=number, help="local processes; default one per core")
    said.add_argument(
        "--scheduler", metavar="ADDRESS", help="a running cluster, such as tcp://host:8786"
    )
    said.add_argument(
        "--wait", type=number, default=10, help="seconds for the cluster to answer; default 10"
    )
    said.add_argument("--out", type=Path, metavar="FILE", help="write the histogram here, as CSV")
    given = said.parse_args()
    if given.chunk % STREAM:
        said.error(f"--chunk must be a multiple of {STREAM}, got {given.chunk}")
    if given.seed < 0:
        said.error(f"--seed must not be negative, got {given.seed}")
    if given.out and not given.out.parent.is_dir():
        said.error(f"--out: there is no directory {given.out.parent}")
    return given


def main() -> None:
    """Draw, evaluate and count the samples, and report the result."""
    given = arguments()
    with connected(given.scheduler, given.workers, given.wait) as client:
        counts = summed(client, given.samples, given.chunk, given.seed)
    print("\n".join(report(counts)))
    if given.out:
        write(counts, given.out)


if __name__ == "__main__":
    main()
