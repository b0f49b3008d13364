"""Each contender in a process of its own, as it would run for whoever chose it.

What one package does to a process serves or harms the others in it: `generated` has the system's
allocator keep what is freed, so that temporaries of the others would cost no page faults, either.

    python -m tests.benchmarks.alone CASE CONTENDER

reads orders line by line, a word and its argument, and answers each with a number:

    load FILE     reads the data and builds the call, which is called once; 0
    time REPEAT   seconds of one of so many calls
    peak          most memory during a call over the size of its result
"""

import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from tests.benchmarks.cases import CASES, Case
from tests.benchmarks.timing import Call, peak_over_result, timed

ROOT = Path(__file__).parents[2]


class Alone:
    """A contender in its process."""

    def __init__(self, case: str, contender: str) -> None:
        self._name = f"{contender} of {case}"
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.benchmarks.alone", case, contender],
            **{"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "cwd": ROOT},
        )

    def __enter__(self) -> "Alone":
        return self

    def __exit__(self, *_: object) -> None:
        self._process.communicate()  # it ends where its orders do

    def load(self, file: Path) -> None:
        """Build the call of the data in a file."""
        self._ordered(f"load {file}")

    def timed(self, repeat: int) -> float:
        """Seconds of one of so many calls."""
        return self._ordered(f"time {repeat}")

    def peak(self) -> float:
        """Most memory during a call over the size of its result."""
        return self._ordered("peak")

    def _ordered(self, order: str) -> float:
        orders, answers = self._process.stdin, self._process.stdout
        assert orders and answers
        orders.write(f"{order}\n")
        orders.flush()
        answer = answers.readline()
        if not answer:
            raise RuntimeError(f"{self._name} failed: {order}")
        return float(answer)


@contextmanager
def contenders(case: Case) -> Iterator[Mapping[str, Alone]]:
    """Those of a case, each in a process of its own."""
    with ExitStack() as stack:
        yield {name: stack.enter_context(Alone(case.name, name)) for name in case.names()}


@contextmanager
def given(case: Case, size: int) -> Iterator[Path]:
    """A file with the data of a size."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "data.npz"
        np.savez(file, **case.data(size))
        yield file


def _read(file: str) -> dict[str, Any]:
    """Arrays, and numbers as Python's."""
    with np.load(file) as held:
        return {name: held[name] if held[name].ndim else held[name].item() for name in held}


def _answers(case: str, contender: str) -> Iterator[float]:
    built = next(c for c in CASES if c.name == case).contenders[contender]
    call: Call = list
    for line in sys.stdin:
        match line.split(maxsplit=1):
            case ["load", file]:
                call = built(_read(file.strip()))
                call()
                yield 0.0
            case ["time", repeat]:
                yield timed(call, int(repeat))
            case ["peak"]:
                yield peak_over_result(call)
            case other:
                raise ValueError(f"no order: {other}")


if __name__ == "__main__":
    for answer in _answers(*sys.argv[1:]):
        print(answer, flush=True)
