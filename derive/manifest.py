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


def with_manifest(files: Mapping[str, str]) -> dict[str, str]:
    """The texts of all files of a directory, by name, and their list."""
    lines = [f"{_checksum(text.encode())}  {name}" for name, text in sorted(files.items())]
    return {**files, MANIFEST: "\n".join([*lines, ""])}


def not_written(folder: Path, entries: Iterable[Path], edited: bool = True) -> str:
    """Of the first entry that was not written as it is, its name and why; "" if there is none.

    edited: whether that includes files that were changed later.
    """
    listed = _listed(folder / MANIFEST)
    for path in entries:
        name = path.relative_to(folder).as_posix()
        if path.is_file() and listed and name == MANIFEST:
            continue
        if name not in listed:
            unlisted = f"is not in the list {MANIFEST} of what was written there"
            return f"{name!r}, which {unlisted if listed else 'was not written by `derive`'}"
        if not path.is_file() or (edited and _checksum(path.read_bytes()) != listed[name]):
            return f"{name!r}, which was changed after it was written"
    return ""


def _checksum(content: bytes) -> str:
    return sha256(content).hexdigest()


def _listed(path: Path) -> dict[str, str]:
    """The checksums in a list, by file name; empty if there is no such list."""
    if path.is_symlink() or not path.is_file():
        return {}
    text = path.read_text(encoding="utf-8", errors="replace")
    lines = [re.fullmatch(r"([0-9a-f]{64})  (.+)", line) for line in text.splitlines()]
    return {line[2]: line[1] for line in lines if line} if all(lines) else {}
