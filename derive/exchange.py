"""One directory in the place of another.

Linux exchanges two names in one step, so that a package is in place at every moment, even if the
process is killed.  Elsewhere there are two steps; killed between them, the old directory lies in
the hidden one beside its place, and the next run makes the new one.
"""

import ctypes
import os
from pathlib import Path

_HERE, _EXCHANGE = -100, 2
"""AT_FDCWD and RENAME_EXCHANGE of Linux."""


def put_in_place(fresh: Path, folder: Path, old: Path) -> None:
    """Name the directory `fresh` as `folder`; what was there is `old` or `fresh` afterwards.

    Raises OSError; `old` is to be put back then, if it is there.
    """
    if folder.exists():
        if _exchanged(fresh, folder):
            return
        folder.replace(old)
    fresh.replace(folder)


def _exchanged(one: Path, other: Path) -> bool:
    """Exchange the names of two directories; False where the system or the disk cannot."""
    try:
        rename = ctypes.CDLL(None).renameat2
    except (AttributeError, OSError, TypeError):
        return False
    return bool(rename(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0)
