"""Read a user's files completely, up to a size limit; write them completely or not at all.

In:  a path and a largest size in bytes, or the content to be written.
Out: the content of the file, or the written file.
"""

import errno
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


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
    _exists(here)
    folder = next(each for each in here.parents if _exists(each))
    if not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(folder))
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(folder))


def _exists(path: Path) -> bool:
    """Whether there is anything at a path; raises OSError if nothing can be there."""
    try:
        path.lstat()
    except FileNotFoundError:
        return False
    return True


def write_whole(content: bytes, path: Path, mode: int = 0o644) -> None:
    """Replace a file in one step: it is never seen incomplete, and a failure leaves the old one.

    Raises OSError.
    """
    with _workpiece(content, path) as workpiece:
        workpiece.chmod(mode)
        workpiece.replace(path)


def write_new(content: bytes, path: Path) -> None:
    """Write a new file, which is never seen incomplete.

    Raises FileExistsError if the file exists or is created in the meantime, or another OSError.
    """
    with _workpiece(content, path) as workpiece:
        try:
            path.hardlink_to(workpiece)
        except FileExistsError:
            raise
        except OSError:  # a file system without hard links: create an empty file, then replace it
            path.open("xb").close()
            try:
                workpiece.replace(path)
            except OSError:
                path.unlink()
                raise


@contextmanager
def _workpiece(content: bytes, path: Path) -> Iterator[Path]:
    """A finished file beside the path, which is removed at the end of the block."""
    workpiece = path.with_name(f".{path.stem[:40]}-{secrets.token_hex(8)}.tmp")
    try:
        with workpiece.open("xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        yield workpiece
    finally:
        workpiece.unlink(missing_ok=True)
