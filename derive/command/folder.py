"""Replaces a directory by other files, completely or not at all.

In:  the texts of the files, by name, with their list (manifest.py).
Out: the replaced directory; or an error, of the caller's class, and nothing has changed.

Linux can exchange two names in a single step.  A directory is then complete at every moment, even
if the process is killed.  Other systems need two steps.  If the process is killed between them, the
old directory is left in the hidden directory next to its place, and the next run writes the new
directory.
"""

import ctypes
import os
import re
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from derive.command.files import demand_writable
from derive.command.manifest import not_written

_FRESH, _PREVIOUS = "fresh", "old"
"""The new and the previous directory in the hidden directory of a run."""

_AGE = 5.0
"""Age in seconds above which a hidden directory may be left over from a run that was killed."""

_HERE, _EXCHANGE = -100, 2
"""Values of AT_FDCWD and RENAME_EXCHANGE on Linux."""


Refusal = Callable[[str, str], Exception]
"""An error class, called with the directory and with the reason, in words that follow its name."""


def replace_folder(
    files: Mapping[str, str], folder: Path, refusal: Refusal, kept: str = ""
) -> None:
    """Replace a directory by these files, of which the first is their list.

    kept: an entry that stays as it is, in a directory whose files are under version control; else
        a written file that was changed later belongs to the user.

    Raises `refusal` if the directory contains a file that belongs to the user, or cannot be
    written.
    """
    demand_replaceable(folder, refusal, kept)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        workshop = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    except OSError as error:
        raise refusal(str(folder), f"cannot be written ({error.strerror})") from error
    with in_use(workshop):
        _fill_and_exchange(files, folder, workshop, refusal, kept)
    remove_leftovers(folder, kept)


def demand_replaceable(folder: Path, refusal: Refusal, kept: str = "") -> None:
    """Raise `refusal` unless `folder` can be created, is empty, or holds only files of a list."""
    try:
        demand_writable(folder)
    except OSError as error:
        raise refusal(str(folder), f"cannot be written ({error.strerror})") from error
    if not folder.exists() and not folder.is_symlink():
        return
    if folder.is_symlink() or not folder.is_dir():
        raise refusal(str(folder), "is not a directory")
    if stranger := not_written(folder, edited=not kept, kept=kept):
        raise refusal(str(folder), f"contains {stranger}")
    if folder.resolve() in (Path.cwd(), *Path.cwd().parents):
        raise refusal(str(folder), "is the current directory or contains it")


def _fill_and_exchange(
    files: Mapping[str, str], folder: Path, workshop: Path, refusal: Refusal, kept: str
) -> None:
    fresh, old = workshop / _FRESH, workshop / _PREVIOUS
    try:
        fresh.mkdir()
        if kept:
            shutil.copytree(folder / kept, fresh / kept)
        for name, text in files.items():
            (fresh / name).parent.mkdir(parents=True, exist_ok=True)
            (fresh / name).write_bytes(text.encode())
        _put_in_place(fresh, folder, old)
    except OSError as error:
        why = f"cannot be replaced ({error.strerror}){_put_back(old, folder)}"
        raise refusal(str(folder), why) from error
    except BaseException:
        _put_back(old, folder)
        raise
    finally:
        if folder.exists() or not old.exists():
            shutil.rmtree(workshop, ignore_errors=True)


def _put_in_place(fresh: Path, folder: Path, old: Path) -> None:
    """Rename `fresh` to `folder`; the previous `folder` becomes `old` or `fresh`."""
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


def _put_back(old: Path, folder: Path) -> str:
    """Move the old directory back; if that fails too, return a note of where it is."""
    if old.exists() and not folder.exists():
        try:
            old.replace(folder)
        except OSError:
            return f", and the old directory is now {old}"
    return ""


# ---------------------------------------------------------------- what a killed run has left


@contextmanager
def in_use(workshop: Path) -> Iterator[bool]:
    """Lock a directory during the block; False if another process has locked it.

    The system removes the lock when the process ends, however it ends.
    """
    try:
        from fcntl import LOCK_EX, LOCK_NB, flock

        descriptor = os.open(workshop, os.O_RDONLY)
    except (ImportError, OSError):  # a system without such locks: nothing is removed
        yield False
        return
    try:
        try:
            flock(descriptor, LOCK_EX | LOCK_NB)
            locked = True
        except OSError:
            locked = False
        yield locked
    finally:
        os.close(descriptor)


def remove_leftovers(folder: Path, kept: str = "") -> None:
    """Remove the hidden directories that killed runs have left next to a directory.

    Only those with a name that `replace_folder` gives are removed, and only if they hold nothing
    but listed files and no process uses them.
    """
    named = re.compile(rf"\.{re.escape(folder.name)}-[a-z0-9_]{{8}}")
    with suppress(OSError):
        for path in [p for p in folder.parent.iterdir() if named.fullmatch(p.name)]:
            with suppress(OSError), in_use(path) as unused:
                if unused and _is_leftover(path, kept):
                    shutil.rmtree(path, ignore_errors=True)


def _is_leftover(path: Path, kept: str) -> bool:
    if path.is_symlink() or not path.is_dir() or time.time() - path.stat().st_mtime < _AGE:
        return False
    inside = list(path.iterdir())
    if any(p.is_symlink() or not p.is_dir() for p in inside):
        return False
    named = {p.name for p in inside} <= {_FRESH, _PREVIOUS}
    return named and not any(not_written(p, edited=False, kept=kept) for p in inside)
