"""Many histories at once: one task each, on all threads that numba may use, with a progress bar."""

import sys
import threading
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Any

import numpy as np

from ..body import kernel_of

PATIENCE = 1.0
"""Seconds after which the progress bar appears."""

EVERY = 0.2
"""Seconds between two updates of the progress bar."""


def run(loop: str, law: Any, rows: Any, own: Any, out: Any) -> None:
    """Let a loop kernel fill the rows of `out`, and show the progress.

    numba's own setting NUMBA_NUM_THREADS limits the number of threads; its default is the number
    of cores.  A call from a thread other than the main one, such as a thread of Dask, starts no
    further threads.  While a kernel works on a row, it may store the completed fraction, times -1,
    in the first column.
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


def _watch(tasks: list[Future[None]], finished: Any, progress: Any) -> None:
    """Wait for the tasks, with a bar if they take long, tqdm is installed and stderr is a terminal.

    An exception in a task is raised again here.
    """
    bar, waiting, done = _bar(len(tasks)), set(tasks), np.zeros(len(tasks))
    while waiting:
        ended, waiting = wait(waiting, timeout=EVERY)
        for task in ended:
            task.result()
        if bar is not None:
            # A kernel may have stored its result in the first column and not yet be finished.
            seen = np.where(finished, 1.0, np.clip(np.nan_to_num(-progress), 0.0, 1.0))
            done = np.maximum(done, seen)
            bar.update(float(done.sum()) - bar.n)
    if bar is not None:
        bar.close()


def _bar(count: int) -> Any:
    """A progress bar for `count` histories; None if nobody would see it."""
    if not sys.stderr.isatty():
        return None
    try:
        from tqdm import tqdm
    except ImportError:
        return None
    label = "1 history" if count == 1 else f"{count:,} histories"
    form = "{desc} {percentage:3.0f}%|{bar}| [{elapsed}<{remaining}]"
    return tqdm(desc=label, total=count, delay=PATIENCE, leave=False, miniters=0, bar_format=form)
