"""Apply one function to many items in separate processes.

In:  a function, items, and a report that is called with the progress of the processes.
Out: results in the order of the items.

Bounds limit the time of a process in one stage, and its memory.  An item is refused if its process
exceeds them or fails.  The first failure, or Ctrl-C, ends all processes at once.

Processes are spawned, so that they start in the same way on every system.  Therefore the function
must be importable from its module, items and results must be plain data, and a script that uses
several processes must guard its own start with `if __name__ == "__main__":`.  The connection to a
process closes as soon as the process ends, however it ends.
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

from derive.command.errors import RanAway

Item = TypeVar("Item")
Result = TypeVar("Result")

Report = Callable[[str, str], None]
"""Called with the item that is worked on and the stage that it enters."""


def silent(what: str, stage: str) -> None:
    """Ignore a report."""


_MAX_PROCESSES = 60
"""Largest number of processes that one process can wait for on every system."""
_INTERVAL = 0.2
"""Seconds between two checks of the clock, and for Ctrl-C on systems where waiting delays it."""
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


@dataclass
class _Worker:
    """A process and its connection; the item and the stage in which it is, and since when."""

    process: BaseProcess
    line: Connection
    number: int = -1
    what: str = ""
    stage: str = ""
    since: float = 0.0

    def enter(self, what: str, stage: str) -> None:
        """Record that the process has entered a stage."""
        self.what, self.stage, self.since = what, stage, monotonic()

    def demand_in_time(self, bounds: Bounds | None) -> None:
        """Raise RanAway if the time of the stage is over."""
        seconds = bounds.stages.get(self.stage, bounds.seconds) if bounds else float("inf")
        if monotonic() - self.since > seconds:
            raise self._ran_away(f"took longer than the limit of {seconds:g} s")

    def lost(self, bounds: Bounds | None) -> RanAway:
        """The error if the process has ended before its item was done."""
        self.process.join(_INTERVAL)
        if bounds and self.process.exitcode == _NO_MEMORY:
            return self._ran_away(f"needed more memory than the limit of {bounds.gigabytes:g} GB")
        return self._ran_away("crashed, which can happen if numbers are large or memory runs out")

    def _ran_away(self, why: str) -> RanAway:
        remedy = "simplify the profile, or build fewer bodies at once, as with --jobs 1"
        return RanAway(self.what or "this body", self.stage or "starting", why, remedy)


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

    Raises RanAway if a process ends before its item is done, or exceeds the bounds.
    """
    jobs = min(jobs, len(items), _MAX_PROCESSES)
    if not items or (jobs <= 1 and bounds is None):
        return [function(item, report) for item in items]
    with _workers(function, jobs, bounds) as workers:
        return _results(workers, items, report, bounds)


@contextmanager
def _workers(
    function: Callable[[Item, Report], Result], jobs: int, bounds: Bounds | None
) -> Iterator[list[_Worker]]:
    """Processes that work until the end of the block and no longer."""
    context = get_context("spawn")
    workers: list[_Worker] = []
    try:
        with _starting():
            for _ in range(jobs):
                line, other_end = context.Pipe()
                more = (function, other_end, bounds)
                workers.append(_Worker(context.Process(target=_work, args=more, daemon=True), line))
                workers[-1].process.start()
                other_end.close()
        yield workers
    finally:
        started = [worker.process for worker in workers if worker.process.pid]
        for process in started:
            process.terminate()
        for process in started:
            process.join(_GRACE)
            process.kill()
            process.join()
        for worker in workers:
            worker.line.close()


@contextmanager
def _starting() -> Iterator[None]:
    """Let processes start without Ctrl-C, which never reaches them, and without a user's modules.

    A file such as threading.py in the current directory would hide the module of Python.
    """
    masks = hasattr(signal, "pthread_sigmask")
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT}) if masks else set()
    name, before = "PYTHONSAFEPATH", os.environ.get("PYTHONSAFEPATH")
    os.environ[name] = "1"
    try:
        yield
    finally:
        del os.environ[name]
        if before is not None:
            os.environ[name] = before
        if masks:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _results(
    workers: Sequence[_Worker], items: Sequence[Item], report: Report, bounds: Bounds | None
) -> list[Result]:
    """Distribute the items one by one; pass reports on, and raise the first failure."""
    waiting = iter(enumerate(items))
    busy: dict[object, _Worker] = {}
    results: dict[int, Result] = {}

    def hand_out(worker: _Worker) -> None:
        if (following := next(waiting, None)) is not None:
            worker.number, item = following
            worker.enter("", "")
            busy[worker.line] = worker
            with suppress(ConnectionError):  # the loop below notices that it is closed
                worker.line.send(item)

    for worker in workers:
        hand_out(worker)
    while busy:
        ready = wait([worker.line for worker in busy.values()], _INTERVAL)
        for line in busy.keys() - ready:
            busy[line].demand_in_time(bounds)
        for line in ready:
            worker = busy[line]
            try:
                kind, *told = worker.line.recv()
            except (EOFError, ConnectionError):
                raise worker.lost(bounds) from None
            if kind == "report":
                worker.enter(*told)
                report(*told)
            elif kind == "failure":
                error, note = told
                error.add_note(note)
                raise error
            else:
                results[busy.pop(line).number] = told[0]
                hand_out(worker)
    return [results[number] for number in range(len(items))]


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

    def report(what: str, stage: str) -> None:
        line.send(("report", what, stage))

    with suppress(EOFError, ConnectionError):
        while True:
            item = line.recv()
            try:
                line.send(("result", function(item, report)))
            except MemoryError:
                os._exit(_NO_MEMORY)  # the first process notices that the connection closes
            except Exception as error:
                note = f"in another process:\n{traceback.format_exc()}"
                line.send(("failure", _portable(error), note))
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # this process is ending anyway


def _bind(bounds: Bounds) -> None:
    """Limit the memory of this process, and keep libraries that abort it from printing."""
    with suppress(ImportError, OSError, ValueError):
        from resource import RLIMIT_CORE, RLIMIT_DATA, getrlimit, setrlimit

        setrlimit(RLIMIT_CORE, (0, getrlimit(RLIMIT_CORE)[1]))
        setrlimit(RLIMIT_DATA, (int(bounds.gigabytes * 2**30), getrlimit(RLIMIT_DATA)[1]))
    sys.stdout, sys.stderr = (
        os.fdopen(os.dup(number), "w", buffering=1, closefd=False) for number in (1, 2)
    )
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
