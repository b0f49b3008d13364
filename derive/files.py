"""Reading a file that a user names: all of it, and no more than it may hold.

In:  a path and a number of bytes.
Out: the file's bytes.
"""

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
