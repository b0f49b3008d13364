"""Writes a new file, completely or not at all."""

import os
from pathlib import Path

from derive.command import files
from derive.command.errors import BadTarget


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
        files.demand_writable(path)
    except (OSError, ValueError) as error:
        raise _unwritable(folder, error) from error
    return path


def write_new(path: Path, text: str) -> None:
    """Write a new file; other programs never see an incomplete file.

    Raises BadTarget if the file exists, is created in the meantime, or cannot be written.
    """
    try:
        files.write_new(text.encode(), path)
    except FileExistsError as error:
        raise BadTarget(str(path), "already exists") from error
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from error


def _unwritable(path: Path, error: Exception) -> BadTarget:
    reason = error.strerror if isinstance(error, OSError) else error
    return BadTarget(str(path), f"cannot be written ({reason})")
