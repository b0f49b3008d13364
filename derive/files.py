"""Read a user's files completely, up to a size limit; write them completely or not at all.

In:  a path and a largest size in bytes, or the content to be written.
Out: the content of the file, or the written file.
"""

import os
import tempfile
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
        with path.open("rb") as file:
            found = file.read(most + 1)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise Unreadable(f"cannot be read ({why})") from error
    if len(found) > most:
        raise Unreadable(f"is larger than {most} bytes")
    return found


def write_whole(content: bytes, path: Path, mode: int = 0o644) -> None:
    """Replace a file in one step; nobody sees a part of it, and after a failure the old one stays.

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
