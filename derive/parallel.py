"""One function of many items in processes of their own.

In:  a function, items, a report that is told what the processes do.
Out: results in the order of the items.

The first failure, or Ctrl-C, ends every process at once.  Processes are spawned, so that they begin
alike on every system: the function is named by its module, items and results are plain data, and a
script that asks for several processes guards its own start, by `if __name__ == "__main__":`.

Each process has a line of its own to the first one, whose end tells of its death at once; an
executor of the standard library can miss the death of a process that it has just spawned.
"""

import os
import pickle
import signal
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing import get_context, parent_process
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from threading import Thread
from typing import TypeVar

from derive.errors import LostProcess

Item = TypeVar("Item")
Result = TypeVar("Result")

Report = Callable[[str, str], None]
"""Told what is worked on, and the stage that it enters."""

_MOST = 60
"""Processes that one can wait for on every system."""
_INTERVAL = 0.2
"""Seconds between two looks at whether Ctrl-C was pressed, on systems where waiting hides it."""


def cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def in_processes(
    function: Callable[[Item, Report], Result], items: Sequence[Item], report: Report, jobs: int
) -> list[Result]:
    """`function` of every item, at most `jobs` at once; what one of them raises is raised here.

    Where one process is enough, it is this one.

    Raises LostProcess for a process that ends before its item is done.
    """
    jobs = min(jobs, len(items), _MOST)
    if jobs <= 1:
        return [function(item, report) for item in items]
    with _processes(function, jobs) as lines:
        return _results(lines, items, report)


@contextmanager
def _processes(function: Callable[[Item, Report], Result], jobs: int) -> Iterator[list[Connection]]:
    """Lines to processes that work until the block's end, and no longer."""
    context = get_context("spawn")
    started: list[BaseProcess] = []
    lines: list[Connection] = []
    try:
        with _interrupts_held_back(), _safe_path():
            for _ in range(jobs):
                line, other_end = context.Pipe()
                lines.append(line)
                process = context.Process(target=_work, args=(function, other_end), daemon=True)
                process.start()
                started.append(process)
                other_end.close()
        yield lines
    finally:
        for each in started:
            each.terminate()
        for each in started:
            each.join()
        for line in lines:
            line.close()


def _results(lines: Sequence[Connection], items: Sequence[Item], report: Report) -> list[Result]:
    """Hand out the items one by one; reports are passed on, the first failure is raised."""
    ahead = iter(range(len(items)))
    at_work: dict[Connection, int] = {}
    results: dict[int, Result] = {}

    def hand_out(line: Connection) -> None:
        number = next(ahead, None)
        if number is not None:
            at_work[line] = number
            with _no_loss(len(lines)):
                line.send(items[number])

    for line in lines:
        hand_out(line)
    while at_work:
        ready = wait([*at_work], _INTERVAL)
        for line in [line for line in at_work if line in ready]:
            with _no_loss(len(lines)):
                what, *told = line.recv()
            if what == "report":
                report(*told)
            elif what == "failure":
                raise _with_note(*told)
            else:
                results[at_work.pop(line)] = told[0]
                hand_out(line)
    return [results[number] for number in range(len(items))]


@contextmanager
def _no_loss(jobs: int) -> Iterator[None]:
    """Raise LostProcess if a line ends."""
    try:
        yield
    except (EOFError, ConnectionError):
        raise LostProcess(jobs) from None


def _with_note(error: Exception, note: str) -> Exception:
    error.add_note(note)
    return error


@contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """Ctrl-C waits until the block's end; a process started within it is never told of Ctrl-C."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _safe_path() -> Iterator[None]:
    """A process started within it finds the standard library, whatever the directory holds.

    Before it is told where to look, it would take a file threading.py of the user's for Python's.
    """
    name = "PYTHONSAFEPATH"
    before = os.environ.get(name)
    os.environ[name] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before


# ------------------------------------------------------------------ in a process of its own


def _work(function: Callable[[Item, Report], Result], line: Connection) -> None:
    """Do what the line brings, until it, or the process at its other end, is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the first process ends this one
    Thread(target=_end_with_the_first, daemon=True).start()
    with suppress(EOFError, ConnectionError):
        while True:
            _do(function, line.recv(), line)


def _do(function: Callable[[Item, Report], Result], item: Item, line: Connection) -> None:
    def report(what: str, stage: str) -> None:
        line.send(("report", what, stage))

    try:
        line.send(("result", function(item, report)))
    except Exception as error:
        line.send(("failure", _portable(error), f"in another process:\n{traceback.format_exc()}"))


def _portable(error: Exception) -> Exception:
    """An exception that arrives in another process as what it is; its text, if it would not."""
    with suppress(Exception):
        if type(pickle.loads(pickle.dumps(error))) is type(error):
            return error
    return RuntimeError(f"{type(error).__name__}: {error}")


def _end_with_the_first() -> None:
    """End this process, whatever it is at, when the one that started it is gone."""
    first = parent_process()
    if first is not None:
        first.join()
    os._exit(1)
