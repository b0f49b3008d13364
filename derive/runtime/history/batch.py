"""Many cases at once: one a task, on as many threads as numba may use, with a bar at a terminal."""

import sys
import threading
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from ..body import kernel_of

PATIENCE = 1.0
"""Seconds after which the bar appears."""


def run(loop: str, law: Any, rows: Any, own: Any, out: Any) -> None:
    """Let a loop kernel fill the rows of `out`.

    How many threads share them is numba's own setting, NUMBA_NUM_THREADS: as many as there are
    cores unless the environment says otherwise.  Called from a thread that is not the main one, as
    by Dask, it starts no others.
    """
    kernel, count = kernel_of(loop), len(rows)

    def one(i: int) -> None:
        kernel(law, rows[i : i + 1], own[i : i + 1], out[i : i + 1])

    numba: Any = sys.modules.get("numba")
    alone = numba is None or threading.current_thread() is not threading.main_thread()
    threads = 1 if alone else min(count, numba.config.NUMBA_NUM_THREADS)
    if threads < 2:
        _exhaust(_shown(map(one, range(count)), count))
        return
    pool = ThreadPoolExecutor(threads)
    try:
        _exhaust(_shown(pool.map(one, range(count)), count))
    finally:
        pool.shutdown(cancel_futures=True)


def _exhaust(done: Iterable[None]) -> None:
    for _ in done:
        pass


def _shown(done: Iterator[None], count: int) -> Iterable[None]:
    """The same with a bar, if it takes a while, there is tqdm, and a person at a terminal."""
    if count < 2 or not sys.stderr.isatty():
        return done
    try:
        from tqdm import tqdm
    except ImportError:
        return done
    return tqdm(done, total=count, delay=PATIENCE, leave=False, unit=" histories")
