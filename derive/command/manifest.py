"""The list of the files that were written into a directory, with their checksums.

In:  the texts of the files; later, the directory.
Out: the text of the list, in the format of the command sha256sum; later, the first file that is not
     in the list or differs from it.  Such a file belongs to the user, and nothing is replaced.
"""

import re
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path

MANIFEST = "files.sha256"
"""The name of the list."""

_COMPILED = "__pycache__"
"""The folder of compiled files; Python and numba write it again if it is missing."""

_SUFFIXES = (".pyc", ".nbi", ".nbc")
"""Suffixes of compiled files; any other file in that folder belongs to the user."""


def with_manifest(files: Mapping[str, str]) -> dict[str, str]:
    """The texts of all files of a directory, by name; their list comes first."""
    lines = [f"{_checksum(text.encode())}  {name}" for name, text in sorted(files.items())]
    return {MANIFEST: "\n".join([*lines, ""]), **files}


def not_written(folder: Path, edited: bool = True, kept: str = "") -> str:
    """Name the first entry that was not written in this form, and say why; "" if there is none.

    edited: whether that includes files that were changed later.
    kept: an entry that is left alone.
    """
    listed = _listed(folder / MANIFEST)
    for path in entries(folder, listed, kept):
        name = path.relative_to(folder).as_posix()
        if path.is_file() and listed and name == MANIFEST:
            continue
        if name not in listed:
            unlisted = f"is not in the list {MANIFEST} of what was written there"
            return f"{name!r}, which {unlisted if listed else 'was not written by `derive`'}"
        if not path.is_file() or (edited and _checksum(path.read_bytes()) != listed[name]):
            return f"{name!r}, which was changed after it was written"
    return ""


def entries(folder: Path, names: Iterable[str], kept: str = "") -> list[Path]:
    """All entries of a directory, in order, except compiled files and the entry `kept`.

    A folder is entered if it is to hold one of the named files; any other counts as one entry.
    """
    inner = {parent.as_posix() for name in names for parent in Path(name).parents}
    found = _entries(folder, folder, inner)
    return [path for path in found if path.relative_to(folder).parts[0] != kept]


def _entries(folder: Path, root: Path, inner: set[str]) -> list[Path]:
    found: list[Path] = []
    for path in sorted(folder.iterdir()) if folder.is_dir() else []:
        if path.is_symlink() or not path.is_dir():
            found.append(path)
        elif path.name == _COMPILED:
            found += [p for p in sorted(path.iterdir()) if not _is_compiled(p)]
        elif path.relative_to(root).as_posix() in inner:
            found += _entries(path, root, inner)
        else:
            found.append(path)
    return found


def _is_compiled(path: Path) -> bool:
    return path.is_file() and not path.is_symlink() and path.suffix in _SUFFIXES


def _checksum(content: bytes) -> str:
    return sha256(content).hexdigest()


def _listed(path: Path) -> dict[str, str]:
    """The checksums in a list, by file name; empty if there is no such list."""
    if path.is_symlink() or not path.is_file():
        return {}
    text = path.read_text(encoding="utf-8", errors="replace")
    lines = [re.fullmatch(r"([0-9a-f]{64})  (.+)", line) for line in text.splitlines()]
    return {line[2]: line[1] for line in lines if line} if all(lines) else {}
