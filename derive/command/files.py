"""Read a user's files up to a size limit; write a file completely or not at all.

In:  a path and a largest size in bytes, or the content to be written.
Out: the content of the file, or the written file.

While a file is written, Ctrl-C and a request to end wait, so that no incomplete file stays behind.
"""

import errno
import os
import secrets
import signal
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from functools import partial
from pathlib import Path

from derive.command.errors import BadTarget, UserError

MARK = '<meta name="generator" content="derive '
"""A tag in every page made by a command of this package; only such pages are replaced."""

_FULL = (errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC))
"""Errors of a full disk, of a limit on the size of files, and of a quota."""


class Unreadable(Exception):
    """The reason why a file cannot be read, in a few words."""


def bytes_of(path: Path, most: int) -> bytes:
    """Return the content of a file.

    Raises Unreadable for a path that is not a regular file (reading a device may never end), for a
    file of more than `most` bytes, and for a file that the system does not allow to be read.
    """
    try:
        if path.exists() and not path.is_file():
            what = "a directory" if path.is_dir() else "a device or a pipe, not a regular file"
            raise Unreadable(f"is {what}")
        with open(path, "rb", opener=_without_waiting) as file:
            found = file.read(most + 1) or b""
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise Unreadable(f"cannot be read ({why})") from error
    if len(found) > most:
        raise Unreadable(f"is larger than {most} bytes")
    return found


def _without_waiting(path: str, flags: int) -> int:
    """Open a file whose reading never waits, such as a log of the system would wait for its end."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def demand_writable(path: Path) -> None:
    """Raise OSError if the system does not let a file or directory be created at this path.

    Nothing is created.  Folders on the way that do not exist are taken to be created as well.
    """
    here = path.absolute()
    with suppress(FileNotFoundError):
        here.lstat()  # fails if nothing can be at this path, such as below a file
    folder = next(each for each in here.parents if os.path.lexists(each))
    if not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(folder))
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(folder))


@contextmanager
def signals_held_back() -> Iterator[None]:
    """Delay Ctrl-C and a request to end until the end of the block."""
    came: list[int] = []
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    held = [number for number, handler in before.items() if callable(handler)]
    with suppress(ValueError):  # another thread than the main one receives no signals
        for number in held:
            signal.signal(number, lambda which, _: came.append(which))
    try:
        yield
    finally:
        with suppress(ValueError):
            for number in held:
                signal.signal(number, before[number])
        for which in came[:1]:
            signal.raise_signal(which)


@contextmanager
def refused_as(
    refusal: Callable[[str, str], UserError], path: Path, what: str = "cannot be written"
) -> Iterator[None]:
    """Raise `refusal` if the system does not allow what the block does with a path."""
    try:
        yield
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        if isinstance(error, OSError) and error.errno in _FULL:
            reason = f"{reason}: free some space"
        raise refusal(str(path), f"{what} ({reason})") from error


def refused(path: Path, option: str = "--out") -> AbstractContextManager[None]:
    """Raise BadTarget if the system does not allow what the block does with a path.

    option: the option that gave the path
    """
    return refused_as(partial(BadTarget, option=option), path)


def write_whole(content: bytes, path: Path, mode: int = 0o644) -> None:
    """Replace a file in one step: it is never seen incomplete, and a failure leaves the old one.

    Raises OSError.
    """
    workpiece = path.with_name(f".{path.stem[:40]}-{secrets.token_hex(8)}.tmp")
    with signals_held_back():
        write_new(content, workpiece)
        try:
            workpiece.chmod(mode)
            workpiece.replace(path)
        finally:
            workpiece.unlink(missing_ok=True)


def write_new(content: bytes, path: Path) -> None:
    """Write a new file; a failure leaves none.

    Raises FileExistsError if the file exists or is created in the meantime, or another OSError.
    """
    with signals_held_back(), path.open("xb") as file:
        try:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        except BaseException:
            path.unlink()
            raise


# ------------------------------------------------------------------ what the commands write


def place_of_geometry(name: str, out: Path | None) -> Path:
    """The path for the file of a new geometry.

    out: a directory, a path that ends in .py, or None for the current directory

    Raises BadTarget if no new file can be created there.
    """
    folder = out if out is not None else Path()
    with refused(folder):
        path = folder if folder.suffix == ".py" and not folder.is_dir() else folder / f"{name}.py"
    demand_page(path, mark=None)
    return path


def put_page(text: str, path: Path, option: str = "--out", mark: str | None = MARK) -> None:
    """Write one file; only a file made by this package, which has the mark, is replaced.

    option: the option that gave the path
    mark: None if no file is replaced

    Raises BadTarget if the path must not be replaced or cannot be written.
    """
    demand_page(path, option, mark)
    with refused(path, option):
        (write_new if mark is None else write_whole)(text.encode(), path)


def demand_page(path: Path, option: str = "--out", mark: str | None = MARK) -> None:
    """Raise BadTarget if `put_page` would not write this path; call this before a long task."""
    with refused(path, option):
        demand_writable(path)
        if not path.parent.is_dir():
            raise BadTarget(str(path.parent), "is not a directory", option)
        if path.is_dir():
            raise BadTarget(str(path), "is a directory", option)
    if os.path.lexists(path) and not _has_mark(path, mark):
        why = "exists and was not made by `derive`" if mark else "already exists"
        raise BadTarget(str(path), why, option)


def _has_mark(path: Path, mark: str | None) -> bool:
    if mark is None or not path.is_file() or (mark == MARK and path.suffix != ".html"):
        return False
    with path.open("rb") as file:
        return mark.encode() in file.read(2000)
