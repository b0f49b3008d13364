"""Puts a text where no file is yet, whole or not at all."""

import os
import secrets
from pathlib import Path

from derive.errors import BadTarget


def place(name: str, out: Path | None) -> Path:
    """Where the file of a geometry goes: `out` is a directory, a path in .py, or nothing.

    Raises BadTarget where no new file can be.
    """
    folder = out if out is not None else Path()
    try:
        path = folder if folder.suffix == ".py" and not folder.is_dir() else folder / f"{name}.py"
        if os.path.lexists(path):
            raise BadTarget(str(path), "is there already")
        if not path.parent.is_dir():
            raise BadTarget(str(path.parent), "is no directory")
    except OSError as error:
        raise _unwritable(folder, error) from error
    return path


def write_new(path: Path, text: str) -> None:
    """Write a file that is not there yet; a reader never sees a part of it.

    Raises BadTarget where a file is there, or appears in the meantime, or cannot be written.
    """
    workpiece = path.with_name(f".{path.stem[:40]}-{secrets.token_hex(8)}.tmp")
    try:
        try:
            _write(workpiece, text)
            _publish(workpiece, path)
        finally:
            workpiece.unlink(missing_ok=True)
    except FileExistsError as error:
        raise BadTarget(str(path), "is there already") from error
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from error


def _write(path: Path, text: str) -> None:
    with path.open("xb") as file:
        file.write(text.encode())
        file.flush()
        os.fsync(file.fileno())


def _publish(workpiece: Path, path: Path) -> None:
    """Give the finished file its name, unless something bears it."""
    try:
        path.hardlink_to(workpiece)
    except FileExistsError:
        raise
    except OSError:  # a file system without links: claim the name, then replace what was claimed
        path.open("xb").close()
        try:
            workpiece.replace(path)
        except OSError:
            path.unlink()
            raise


def _unwritable(path: Path, error: Exception) -> BadTarget:
    reason = error.strerror if isinstance(error, OSError) else error
    return BadTarget(str(path), f"cannot be written ({reason})")
