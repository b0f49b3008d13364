"""Writes one page or a directory of pages, completely or not at all."""

import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

from derive.errors import BadPage
from derive.exchange import put_in_place
from derive.files import write_whole

MARK = '<meta name="generator" content="derive '
"""A tag in every page made by a command of this package; only such pages are replaced."""


def put_page(text: str, path: Path) -> None:
    """Write one page; a page made by this package may be replaced.

    Raises BadPage if the path must not be replaced or cannot be written.
    """
    _demand_reachable(path)
    if path.is_dir():
        raise BadPage(str(path), "is a directory")
    if (path.exists() or path.is_symlink()) and not _is_ours(path):
        raise BadPage(str(path), "exists and is not a page made by `derive show --html`")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(text.encode(), path)
    except OSError as error:
        raise BadPage(str(path), f"cannot be written ({error.strerror})") from error


def put_pages(pages: Mapping[str, str], folder: Path) -> None:
    """Replace a directory by pages, given by their file names.

    Raises BadPage if it contains any other file, or cannot be written.
    """
    demand_replaceable(folder)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        workshop = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    except OSError as error:
        raise BadPage(str(folder), f"cannot be written ({error.strerror})") from error
    fresh, old = workshop / "fresh", workshop / "old"
    try:
        fresh.mkdir()
        for name, text in pages.items():
            (fresh / name).write_bytes(text.encode())
        put_in_place(fresh, folder, old)
    except OSError as error:
        if old.exists() and not folder.exists():
            old.replace(folder)
        raise BadPage(str(folder), f"cannot be replaced ({error.strerror})") from error
    finally:
        if folder.exists() or not old.exists():
            shutil.rmtree(workshop, ignore_errors=True)


def demand_replaceable(folder: Path) -> None:
    """Raise BadPage unless `folder` does not exist, or contains only pages made by this package."""
    _demand_reachable(folder)
    if not folder.exists() and not folder.is_symlink():
        return
    if folder.is_symlink() or not folder.is_dir():
        raise BadPage(str(folder), "is not a directory")
    if folder.resolve() in (Path.cwd(), *Path.cwd().parents):
        raise BadPage(str(folder), "is the current directory or contains it")
    for path in sorted(folder.iterdir()):
        if not _is_ours(path):
            why = f"contains {path.name!r}, which is not a page made by `derive show --html`"
            raise BadPage(str(folder), why)


def _demand_reachable(path: Path) -> None:
    """Raise BadPage for a path that cannot exist, for example because its name is too long."""
    try:
        path.exists()
    except OSError as error:
        raise BadPage(str(path), f"cannot be reached ({error.strerror})") from error


def _is_ours(path: Path) -> bool:
    if not path.is_file() or path.suffix != ".html":
        return False
    return MARK.encode() in path.read_bytes()[:2000]
