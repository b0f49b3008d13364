"""Apply one function to many items in separate processes.

In:  a function, items, and a report that is called with the progress of the processes.
Out: results in the order of the items.

Bounds limit the time of a process in one stage, and its memory.  An item is refused if its process
exceeds them or fails.

The first failure, or Ctrl-C, ends all processes at once.  Processes are spawned, so that they
start in the same way on every system.  Therefore the function must be importable from its module,
items and results must be plain data, and a script that uses several processes must guard its own
start with `if __name__ == "__main__":`.

The first process has a separate connection to each of the others.  The connection closes as soon as
its process ends; an executor of the standard library can miss the end of a new process.
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
from time import monotonic, sleep
from typing import TypeVar

from derive.command.errors import LostProcess, RanAway

Item = TypeVar("Item")
Result = TypeVar("Result")

Report = Callable[[str, str], None]
"""Called with the item that is worked on and the stage that it enters."""

_MOST = 60
"""Largest number of processes that one process can wait for on every system."""
_INTERVAL = 0.2
"""Seconds between two checks for Ctrl-C, on systems where waiting delays it."""
_GRACE = 2.0
"""Seconds that a process has, once it is told to end, to remove its temporary files."""
_NO_MEMORY = 77
"""Exit status of a process that has no memory left."""


@dataclass(frozen=True)
class Bounds:
    """Limits on the work of a process on one item.

    seconds    time for one stage
    gigabytes  memory, on systems that can limit it
    stages     time in seconds of stages with a limit of their own
    """

    seconds: float
    gigabytes: float
    stages: Mapping[str, float] = field(default_factory=dict)

    def at(self, stage: str) -> float:
        """Time limit of a stage in seconds."""
        return self.stages.get(stage, self.seconds)


def cores() -> int:
    """Number of cores that this process may use."""
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
    """Apply `function` to every item, at most `jobs` at once; raise here what one of them raises.

    No other process is used if one is enough and there are no bounds.

    Raises LostProcess if a process ends before its item is done.  With bounds, raises RanAway if a
    process exceeds them or ends early.
    """
    jobs = min(jobs, len(items), _MOST)
    if not items or (jobs <= 1 and bounds is None):
        return [function(item, report) for item in items]
    with _processes(function, jobs, bounds) as processes:
        return _results(processes, items, report, bounds)


@contextmanager
def _processes(
    function: Callable[[Item, Report], Result], jobs: int, bounds: Bounds | None
) -> Iterator[dict[Connection, BaseProcess]]:
    """The processes, by connection; they work until the end of the block and no longer."""
    context = get_context("spawn")
    started: dict[Connection, BaseProcess] = {}
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
                started[line] = process
                other_end.close()
        yield started
    finally:
        for each in started.values():
            each.terminate()
        for each in started.values():
            each.join(_GRACE)
            each.kill()
            each.join()
        for line in lines:
            line.close()


def _results(
    processes: Mapping[Connection, BaseProcess],
    items: Sequence[Item],
    report: Report,
    bounds: Bounds | None,
) -> list[Result]:
    """Distribute the items one by one; pass reports on, and raise the first failure."""
    waiting = iter(range(len(items)))
    at_work: dict[Connection, int] = {}
    watches: dict[Connection, _Watch] = {}
    results: dict[int, Result] = {}

    def hand_out(line: Connection) -> None:
        number = next(waiting, None)
        if number is not None:
            at_work[line] = number
            watches[line] = _Watch(processes[line], bounds, len(processes))
            with watches[line].no_loss():
                line.send(items[number])

    for line in processes:
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
    """The work of one process on one item: the present stage, and when it began."""

    def __init__(self, process: BaseProcess, bounds: Bounds | None, jobs: int) -> None:
        self.process, self.bounds, self.jobs = process, bounds, jobs
        self.enter("", "")

    def enter(self, what: str, stage: str) -> None:
        """Record that the process has entered a stage."""
        self.what, self.stage, self.since = what, stage, monotonic()

    def look(self) -> None:
        """Raise RanAway if the time of the stage is over."""
        if self.bounds and monotonic() - self.since > self.bounds.at(self.stage):
            raise RanAway(self.what, self.stage, seconds=self.bounds.at(self.stage))

    @contextmanager
    def no_loss(self) -> Iterator[None]:
        """Raise LostProcess, or RanAway if there are bounds, if the connection closes."""
        try:
            yield
        except (EOFError, ConnectionError):
            if self.bounds is None:
                raise LostProcess(self.jobs) from None
            self.process.join(_INTERVAL)
            full = self.process.exitcode == _NO_MEMORY
            gigabytes = self.bounds.gigabytes if full else None
            raise RanAway(self.what, self.stage, gigabytes=gigabytes) from None


def _with_note(error: Exception, note: str) -> Exception:
    error.add_note(note)
    return error


@contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """Delay Ctrl-C until the end of the block; a process started in it never receives Ctrl-C."""
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
    """Let a process started in the block find the standard library, whatever the directory holds.

    Otherwise it would first import a user's file such as threading.py instead of Python's own.
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


# ------------------------------------------------------------------ in a separate process


def _work(
    function: Callable[[Item, Report], Result], line: Connection, bounds: Bounds | None
) -> None:
    """Work on items from the connection until it closes or the first process ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the first process ends this one
    signal.signal(signal.SIGTERM, end)
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
        os._exit(_NO_MEMORY)  # the first process notices that the connection closes
    except Exception as error:
        line.send(("failure", _portable(error), f"in another process:\n{traceback.format_exc()}"))


def _bind(bounds: Bounds) -> None:
    """Limit the memory of this process, and keep libraries that abort it from printing."""
    with suppress(ImportError, OSError, ValueError):
        from resource import RLIMIT_CORE, RLIMIT_DATA, getrlimit, setrlimit

        setrlimit(RLIMIT_CORE, (0, getrlimit(RLIMIT_CORE)[1]))
        setrlimit(RLIMIT_DATA, (int(bounds.gigabytes * 2**30), getrlimit(RLIMIT_DATA)[1]))
    sys.stdout, sys.stderr = (os.fdopen(os.dup(number), "w", buffering=1) for number in (1, 2))
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)


def _portable(error: Exception) -> Exception:
    """The exception itself if it can be sent to another process, otherwise one with its text."""
    with suppress(Exception):
        if type(pickle.loads(pickle.dumps(error))) is type(error):
            return error
    return RuntimeError(f"{type(error).__name__}: {error}")


def end(number: int, frame: object) -> None:
    """End this process at a signal in such a way that temporary files are removed."""
    signal.signal(number, signal.SIG_IGN)  # it may come twice
    sys.exit(128 + number)


def _end_with_the_first() -> None:
    """End this process, whatever it is doing, when the process that started it ends."""
    first = parent_process()
    if first is not None:
        first.join()
    os.kill(os.getpid(), signal.SIGTERM)
    sleep(_GRACE)
    os._exit(1)
