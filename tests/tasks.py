"""What the tests let other processes do; those find it here by its name.

Nothing here imports SymPy at once: a process that does little begins without it.
"""

import os
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from derive.command.errors import BadUnit, NotProven, UnknownGeometry
from derive.command.processes import Report


def process(item: object, report: Report) -> int:
    """Who does it."""
    return os.getpid()


def meeting(item: tuple[str, int], report: Report) -> int:
    """Who does it, when as many processes as said have come to a folder."""
    folder, expected = Path(item[0]), item[1]
    (folder / str(os.getpid())).touch()
    until = time.monotonic() + 60
    while len([*folder.iterdir()]) < expected and time.monotonic() < until:
        time.sleep(0.02)
    return os.getpid()


def late(item: tuple[int, float], report: Report) -> int:
    """The first number, after as many seconds as the second."""
    number, seconds = item
    report(str(number), "begun")
    time.sleep(seconds)
    report(str(number), "ended")
    return number


class Strange(Exception):
    """An exception that cannot be made again from its message."""

    def __init__(self, first: int, second: int) -> None:
        super().__init__(f"{first} and {second}")


def cannot_print() -> Exception:
    """Of the printer, which needs SymPy."""
    from derive.codegen.printer import CannotPrint

    return CannotPrint("no NumPy code is known for zeta: zeta(3)")


ERRORS: dict[str, Callable[[], BaseException]] = {
    "user": lambda: UnknownGeometry(given="sphere", known=("hertz", "wedge")),
    "object": lambda: BadUnit(repr(len), "is no text"),
    "proof": lambda: NotProven("tilt of 'body': unknown: no point drawn"),
    "print": cannot_print,
    "strange": lambda: Strange(1, 2),
    "fault": lambda: AssertionError("a fault of the program"),
    "end": lambda: EOFError("of a file"),
    "memory": lambda: MemoryError(),
}


def fails(item: str, report: Report) -> str:
    """Raises the error of that name, ends its process, waits for ever, or is done."""
    report(item, "begun")
    if item in ERRORS:
        raise ERRORS[item]()
    if item == "exit":
        os._exit(3)
    if item == "wait":
        with TemporaryDirectory():
            time.sleep(600)
    return item
