"""Writes one page or a directory of pages, completely or not at all."""

from collections.abc import Mapping
from pathlib import Path

from derive.command.errors import BadPage
from derive.command.files import demand_writable, write_whole
from derive.command.folder import replace_folder
from derive.command.manifest import with_manifest

MARK = '<meta name="generator" content="derive '
"""A tag in every page made by a command of this package; only such pages are replaced."""


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
    try:
        demand_writable(path)
    except OSError as error:
        raise BadPage(str(path), f"cannot be written ({error.strerror})", option) from error
    if path.is_dir():
        raise BadPage(str(path), "is a directory", option)
    if (path.exists() or path.is_symlink()) and not _is_ours(path, mark):
        raise BadPage(str(path), "exists and was not made by `derive`", option)


def put_pages(pages: Mapping[str, str], folder: Path) -> None:
    """Replace a directory by pages, given by their file names.

    Raises BadPage if it contains any other file, or cannot be written.
    """
    replace_folder(with_manifest(pages), folder, BadPage)


def _is_ours(path: Path, mark: str = MARK) -> bool:
    if not path.is_file() or (mark == MARK and path.suffix != ".html"):
        return False
    with path.open("rb") as file:
        return mark.encode() in file.read(2000)
