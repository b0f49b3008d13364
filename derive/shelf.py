"""Writes one page or a directory of pages, completely or not at all."""

import shutil
import tempfile
import time
from collections.abc import Mapping
from contextlib import suppress
from glob import escape
from pathlib import Path

from derive.errors import BadPage
from derive.exchange import put_in_place
from derive.files import demand_writable, write_whole
from derive.manifest import MANIFEST, not_written, with_manifest

MARK = '<meta name="generator" content="derive '
"""A tag in every page made by a command of this package; only such pages are replaced."""

_OLD = 60.0
"""Age in seconds above which a hidden directory is left over from a run that was killed."""


def put_page(text: str, path: Path, option: str = "--out", mark: str = MARK) -> None:
    """Write one file; only a file made by this package, which has the mark, is replaced.

    option: the option that gave the path

    Raises BadPage if the path must not be replaced or cannot be written.
    """
    demand_page(path, option, mark)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(text.encode(), path)
    except OSError as error:
        raise BadPage(str(path), f"cannot be written ({error.strerror})", option) from error


def demand_page(path: Path, option: str = "--out", mark: str = MARK) -> None:
    """Raise BadPage if `put_page` would not write this path; call this before a long task."""
    _demand_writable(path, option)
    if path.is_dir():
        raise BadPage(str(path), "is a directory", option)
    if (path.exists() or path.is_symlink()) and not _is_ours(path, mark):
        raise BadPage(str(path), "exists and was not made by `derive`", option)


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
        for name, text in with_manifest(pages).items():
            (fresh / name).write_bytes(text.encode())
        put_in_place(fresh, folder, old)
    except OSError as error:
        raise BadPage(str(folder), f"cannot be replaced ({error.strerror})") from error
    finally:
        if old.exists() and not folder.exists():
            old.replace(folder)
        shutil.rmtree(workshop, ignore_errors=True)
    _remove_leftovers(folder)


def _remove_leftovers(folder: Path) -> None:
    """Remove the hidden directories of pages that killed runs have left beside a directory."""
    for path in folder.parent.glob(f".{escape(folder.name)}-????????"):
        with suppress(OSError):
            if not {each.name for each in path.iterdir()} <= {"fresh", "old"}:
                continue
            files = [each for each in path.rglob("*") if not each.is_dir() or each.is_symlink()]
            ours = all(
                _is_ours(each) or each.name == MANIFEST or each.stat().st_size == 0
                for each in files
            )
            if ours and time.time() - path.stat().st_mtime > _OLD:
                shutil.rmtree(path)


def demand_replaceable(folder: Path) -> None:
    """Raise BadPage unless `folder` can be created, or contains only pages made by this package."""
    _demand_writable(folder)
    if not folder.exists() and not folder.is_symlink():
        return
    if folder.is_symlink() or not folder.is_dir():
        raise BadPage(str(folder), "is not a directory")
    if folder.resolve() in (Path.cwd(), *Path.cwd().parents):
        raise BadPage(str(folder), "is the current directory or contains it")
    if stranger := not_written(folder, sorted(folder.iterdir())):
        raise BadPage(str(folder), f"contains {stranger}")


def _demand_writable(path: Path, option: str = "--out") -> None:
    try:
        demand_writable(path)
    except OSError as error:
        raise BadPage(str(path), f"cannot be written ({error.strerror})", option) from error


def _is_ours(path: Path, mark: str = MARK) -> bool:
    if not path.is_file() or (mark == MARK and path.suffix != ".html"):
        return False
    with path.open("rb") as file:
        return mark.encode() in file.read(2000)
