"""Files that a user names: read whole, and no more than they may hold; written whole or not at all.

In:  a path and a number of bytes, or a text.
Out: the file's bytes, or the file.
"""

import os
import tempfile
from pathlib import Path


class Unreadable(Exception):
    """Why a file cannot be read, in a few words."""


def bytes_of(path: Path, most: int) -> bytes:
    """The bytes of a file.

    Raises Unreadable for what is no file, a device that may have no end say, for one of more than
    `most` bytes, and for what the system does not let us read.
    """
    try:
        if path.exists() and not path.is_file():
            what = "a directory" if path.is_dir() else "no file but a device or a pipe"
            raise Unreadable(f"is {what}")
        with path.open("rb") as file:
            found = file.read(most + 1)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise Unreadable(f"cannot be read ({why})") from error
    if len(found) > most:
        raise Unreadable(f"is larger than {most} bytes")
    return found


def write_whole(content: bytes, path: Path, mode: int = 0o644) -> None:
    """Write a file in place of another; nobody sees half of it, and what fails leaves the old one.

    Raises OSError.
    """
    descriptor, name = tempfile.mkstemp(".tmp", f"{path.stem}.", path.parent)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(content)
        Path(name).chmod(mode)
        Path(name).replace(path)
    finally:
        Path(name).unlink(missing_ok=True)
