"""Replace one directory by another.

Linux can exchange two names in a single step.  A package is then complete at every moment, even if
the process is killed.  Other systems need two steps.  If the process is killed between them, the
old directory is left in the hidden directory next to its place, and the next run writes the new
directory.
"""

import ctypes
import os
from pathlib import Path

_HERE, _EXCHANGE = -100, 2
"""Values of AT_FDCWD and RENAME_EXCHANGE on Linux."""


def put_in_place(fresh: Path, folder: Path, old: Path) -> None:
    """Rename the directory `fresh` to `folder`; the previous `folder` becomes `old` or `fresh`.

    Raises OSError; the caller must then put `old` back, if it exists.
    """
    if folder.exists():
        if _exchanged(fresh, folder):
            return
        folder.replace(old)
    fresh.replace(folder)


def _exchanged(one: Path, other: Path) -> bool:
    """Exchange the names of two directories; False if the system or the disk cannot do this."""
    try:
        rename = ctypes.CDLL(None).renameat2
    except (AttributeError, OSError, TypeError):
        return False
    return bool(rename(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0)
