"""Writes a new file, completely or not at all."""

import os
import secrets
from pathlib import Path

from derive.errors import BadTarget


def place(name: str, out: Path | None) -> Path:
    """The path for the file of a geometry.

    out: a directory, a path that ends in .py, or None for the current directory

    Raises BadTarget if no new file can be created there.
    """
    folder = out if out is not None else Path()
    try:
        path = folder if folder.suffix == ".py" and not folder.is_dir() else folder / f"{name}.py"
        if os.path.lexists(path):
            raise BadTarget(str(path), "already exists")
        if not path.parent.is_dir():
            raise BadTarget(str(path.parent), "is not a directory")
    except OSError as error:
        raise _unwritable(folder, error) from error
    return path


def write_new(path: Path, text: str) -> None:
    """Write a new file; other programs never see an incomplete file.

    Raises BadTarget if the file exists, is created in the meantime, or cannot be written.
    """
    workpiece = path.with_name(f".{path.stem[:40]}-{secrets.token_hex(8)}.tmp")
    try:
        try:
            _write(workpiece, text)
            _publish(workpiece, path)
        finally:
            workpiece.unlink(missing_ok=True)
    except FileExistsError as error:
        raise BadTarget(str(path), "already exists") from error
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from error


def _write(path: Path, text: str) -> None:
    with path.open("xb") as file:
        file.write(text.encode())
        file.flush()
        os.fsync(file.fileno())


def _publish(workpiece: Path, path: Path) -> None:
    """Give the finished file its name, unless a file with this name exists."""
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


def _unwritable(path: Path, error: Exception) -> BadTarget:
    reason = error.strerror if isinstance(error, OSError) else error
    return BadTarget(str(path), f"cannot be written ({reason})")
