"""Many histories at once: one a task, on as many threads as numba may use, with a progress bar."""

import sys
import threading
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Any

import numpy as np

from ..body import kernel_of

PATIENCE = 1.0
"""Seconds after which the bar appears."""

EVERY = 0.2
"""Seconds between two looks at the progress."""


def run(loop: str, law: Any, rows: Any, own: Any, out: Any) -> None:
    """Let a loop kernel fill the rows of `out`, and show how far it is.

    NUMBA_NUM_THREADS, numba's own setting, limits the number of threads; by default it is the
    number of cores.  Called from a thread other than the main one, as by Dask, it starts no
    threads.  While a kernel works on a row, it may keep the part that is done, times -1, in the
    first column.
    """
    kernel, count = kernel_of(loop), len(rows)
    out[:, 0], finished = 0.0, np.zeros(count, dtype=bool)

    def one(i: int) -> None:
        kernel(law, rows[i : i + 1], own[i : i + 1], out[i : i + 1])
        finished[i] = True

    if threading.current_thread() is not threading.main_thread():
        for i in range(count):
            one(i)
        return
    numba: Any = sys.modules.get("numba")
    threads = 1 if numba is None else min(count, numba.config.NUMBA_NUM_THREADS)
    pool = ThreadPoolExecutor(max(threads, 1))
    try:
        _watch([pool.submit(one, i) for i in range(count)], finished, out[:, 0])
    finally:
        pool.shutdown(cancel_futures=True)


def _watch(tasks: list[Future[None]], finished: Any, begun: Any) -> None:
    """Wait for the tasks, with a bar if it takes long, tqdm is installed and stderr is a terminal.

    Raises what a task has raised.
    """
    bar = _bar(len(tasks))
    for task in tasks:
        while not wait([task], timeout=EVERY).done:
            if bar is not None:
                part = np.where(finished, 1.0, np.clip(-begun, 0.0, 1.0))
                bar.update(float(part.sum()) - bar.n)
        task.result()
    if bar is not None:
        bar.close()


def _bar(count: int) -> Any:
    """A bar for so many histories; None if nobody would see it."""
    if not sys.stderr.isatty():
        return None
    try:
        from tqdm import tqdm
    except ImportError:
        return None
    what = "1 history" if count == 1 else f"{count:,} histories"
    form = "{desc} {percentage:3.0f}%|{bar}| [{elapsed}<{remaining}]"
    return tqdm(desc=what, total=count, delay=PATIENCE, leave=False, miniters=0, bar_format=form)
