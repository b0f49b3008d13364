"""Each contender in a process of its own, as it would run for whoever chose it.

What one package does to a process serves or harms the others in it: `generated` has the system's
allocator keep what is freed, so that temporaries of the others would cost no page faults, either.

    python -m tests.benchmarks.alone CASE CONTENDER DATA [PACKAGE]

reads the data from a file, imports a package that others may share the process with, builds the
call and answers 0; then it reads orders line by line, and answers each with a number:

    time REPEAT   seconds of one of so many calls
    peak          most memory during a call over the size of its result

All keep to the same core, one at a time, so that a change of its pace meets all of them.
"""

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from tests.benchmarks.cases import CASES, Case
from tests.benchmarks.timing import Call, peak_over_result, timed

ROOT = Path(__file__).parents[2]


class Alone:
    """A contender in its process.

    Raises RuntimeError where it ends before it answers; its own message is on the standard error.
    """

    def __init__(self, case: str, contender: str, data: Path, beside: str = "") -> None:
        self._name = f"{contender} of {case}"
        given = [case, contender, str(data), *filter(None, [beside])]
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.benchmarks.alone", *given],
            **{"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "cwd": ROOT},
        )

    def __enter__(self) -> "Alone":
        self._answer("its data")
        return self

    def __exit__(self, *_: object) -> None:
        self._end()

    def _end(self) -> None:
        self._process.communicate()  # it ends where its orders do

    def timed(self, repeat: int) -> float:
        """Seconds of one of so many calls."""
        return self._ordered(f"time {repeat}")

    def peak(self) -> float:
        """Most memory during a call over the size of its result."""
        return self._ordered("peak")

    def _ordered(self, order: str) -> float:
        orders = self._process.stdin
        assert orders
        with suppress(BrokenPipeError):  # no answer will come
            orders.write(f"{order}\n")
            orders.flush()
        return self._answer(order)

    def _answer(self, order: str) -> float:
        answers = self._process.stdout
        assert answers
        if not (answer := answers.readline()):
            self._end()
            raise RuntimeError(f"{self._name} failed at {order}")
        return float(answer)


@contextmanager
def contenders(case: Case, size: int, beside: str = "") -> Iterator[Mapping[str, Alone]]:
    """Those that take part at a size, each in a process of its own.

    beside: a package that each finds imported.
    """
    with TemporaryDirectory() as folder, ExitStack() as stack:
        file = Path(folder) / "data.npz"
        np.savez(file, **case.data(size))
        yield {
            name: stack.enter_context(Alone(case.name, name, file, beside))
            for name in case.names(size)
        }


def built(case: str, contender: str, file: Path) -> Call:
    """The call of a contender, its data from a file."""
    with np.load(file) as kept:
        data = {name: v if v.ndim else float(v) for name, v in kept.items()}
    return next(c for c in CASES if c.name == case).contenders[contender](data)


def _answers(case: str, contender: str, file: str, beside: str = "") -> Iterator[float]:
    if sys.platform == "linux":
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    if beside:
        import_module(beside)
    call = built(case, contender, Path(file))
    yield 0.0
    for line in sys.stdin:
        match line.split():
            case ["time", repeat]:
                yield timed(call, int(repeat))
            case ["peak"]:
                yield peak_over_result(call)
            case order:
                raise ValueError(f"no order: {order}")


if __name__ == "__main__":
    for answer in _answers(*sys.argv[1:]):
        print(answer, flush=True)
