"""One function of many items in processes of their own.

In:  a function, items, a report that is told what the processes do.
Out: results in the order of the items.

Bounds say how long a process may be at one stage, and how much memory it may take: what runs away,
or brings its process down, is refused.

The first failure, or Ctrl-C, ends every process at once.  Processes are spawned, so that they begin
alike on every system: the function is named by its module, items and results are plain data, and a
script that asks for several processes guards its own start, by `if __name__ == "__main__":`.

Each process has a line of its own to the first one, whose end tells of its death at once; an
executor of the standard library can miss the death of a process that it has just spawned.
"""

import os
import pickle
import signal
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing import get_context, parent_process
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from threading import Thread
from time import monotonic
from typing import TypeVar

from derive.errors import LostProcess, RanAway

Item = TypeVar("Item")
Result = TypeVar("Result")

Report = Callable[[str, str], None]
"""Told what is worked on, and the stage that it enters."""

_MOST = 60
"""Processes that one can wait for on every system."""
_INTERVAL = 0.2
"""Seconds between two looks at whether Ctrl-C was pressed, on systems where waiting hides it."""


@dataclass(frozen=True)
class Bounds:
    """What a process may take for one item.

    seconds   at one stage
    gigabytes of memory, where the system can hold a process to it
    stages    seconds of stages that may take another time
    """

    seconds: float
    gigabytes: float
    stages: Mapping[str, float] = field(default_factory=dict)

    def at(self, stage: str) -> float:
        """Seconds that a stage may take."""
        return self.stages.get(stage, self.seconds)


def cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def in_processes(
    function: Callable[[Item, Report], Result],
    items: Sequence[Item],
    report: Report,
    jobs: int,
    bounds: Bounds | None = None,
) -> list[Result]:
    """`function` of every item, at most `jobs` at once; what one of them raises is raised here.

    Where one process is enough and nothing bounds it, it is this one.

    Raises LostProcess for a process that ends before its item is done, RanAway for one that goes
    beyond its bounds, or ends although they are kept.
    """
    jobs = min(jobs, len(items), _MOST)
    if not items or (jobs <= 1 and bounds is None):
        return [function(item, report) for item in items]
    with _processes(function, jobs, bounds) as lines:
        return _results(lines, items, report, bounds)


@contextmanager
def _processes(
    function: Callable[[Item, Report], Result], jobs: int, bounds: Bounds | None
) -> Iterator[list[Connection]]:
    """Lines to processes that work until the block's end, and no longer."""
    context = get_context("spawn")
    started: list[BaseProcess] = []
    lines: list[Connection] = []
    try:
        with _interrupts_held_back(), _safe_path():
            for _ in range(jobs):
                line, other_end = context.Pipe()
                lines.append(line)
                process = context.Process(
                    target=_work, args=(function, other_end, bounds), daemon=True
                )
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


def _results(
    lines: Sequence[Connection], items: Sequence[Item], report: Report, bounds: Bounds | None
) -> list[Result]:
    """Hand out the items one by one; reports are passed on, the first failure is raised."""
    ahead = iter(range(len(items)))
    at_work: dict[Connection, int] = {}
    watches: dict[Connection, _Watch] = {}
    results: dict[int, Result] = {}

    def hand_out(line: Connection) -> None:
        number = next(ahead, None)
        if number is not None:
            at_work[line], watches[line] = number, _Watch(bounds, len(lines))
            with watches[line].no_loss():
                line.send(items[number])

    for line in lines:
        hand_out(line)
    while at_work:
        ready = wait([*at_work], _INTERVAL)
        for line in [line for line in at_work if line not in ready]:
            watches[line].look()
        for line in [line for line in at_work if line in ready]:
            with watches[line].no_loss():
                what, *told = line.recv()
            if what == "report":
                watches[line].enter(*told)
                report(*told)
            elif what == "failure":
                raise _with_note(*told)
            else:
                results[at_work.pop(line)] = told[0]
                hand_out(line)
    return [results[number] for number in range(len(items))]


class _Watch:
    """Over one process at one item: what it is at, and since when."""

    def __init__(self, bounds: Bounds | None, jobs: int) -> None:
        self.bounds, self.jobs = bounds, jobs
        self.enter("", "")

    def enter(self, what: str, stage: str) -> None:
        """It has entered a stage."""
        self.what, self.stage, self.since = what, stage, monotonic()

    def look(self) -> None:
        """Raise RanAway when the time of the stage is over."""
        if self.bounds and monotonic() - self.since > self.bounds.at(self.stage):
            raise self._ran_away()

    @contextmanager
    def no_loss(self) -> Iterator[None]:
        """Raise LostProcess, or RanAway of one that is bounded, if the line ends."""
        try:
            yield
        except (EOFError, ConnectionError):
            raise (self._ran_away() if self.bounds else LostProcess(self.jobs)) from None

    def _ran_away(self) -> RanAway:
        assert self.bounds is not None
        return RanAway(self.what, self.stage, self.bounds.at(self.stage), self.bounds.gigabytes)


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


def _work(
    function: Callable[[Item, Report], Result], line: Connection, bounds: Bounds | None
) -> None:
    """Do what the line brings, until it, or the process at its other end, is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the first process ends this one
    Thread(target=_end_with_the_first, daemon=True).start()
    if bounds is not None:
        _bind(bounds)
    with suppress(EOFError, ConnectionError):
        while True:
            _do(function, line.recv(), line)


def _do(function: Callable[[Item, Report], Result], item: Item, line: Connection) -> None:
    def report(what: str, stage: str) -> None:
        line.send(("report", what, stage))

    try:
        line.send(("result", function(item, report)))
    except MemoryError:
        os._exit(1)  # nothing more can be done here; the first process is told by the line's end
    except Exception as error:
        line.send(("failure", _portable(error), f"in another process:\n{traceback.format_exc()}"))


def _bind(bounds: Bounds) -> None:
    """Hold this process to its memory; libraries that abort it have no say on the terminal."""
    with suppress(ImportError, OSError, ValueError):
        from resource import RLIMIT_CORE, RLIMIT_DATA, getrlimit, setrlimit

        setrlimit(RLIMIT_CORE, (0, getrlimit(RLIMIT_CORE)[1]))
        setrlimit(RLIMIT_DATA, (int(bounds.gigabytes * 2**30), getrlimit(RLIMIT_DATA)[1]))
    sys.stdout, sys.stderr = (os.fdopen(os.dup(number), "w", buffering=1) for number in (1, 2))
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)


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
