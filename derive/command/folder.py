"""Replaces a directory by other files, completely or not at all.

In:  the texts of the files, by name; the first is their list, with their checksums, in the format
     of the command sha256sum.
Out: the replaced directory; or BadTarget is raised, and nothing has changed.  A file that is not in
     the list of a directory or differs from it belongs to the user: nothing is replaced.

Ctrl-C and a request to end wait until everything is in place.  If the process is killed between the
two steps, the old directory is left in the hidden directory next to its place.
"""

import re
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from hashlib import sha256
from pathlib import Path

from derive.command.errors import BadTarget
from derive.command.files import demand_writable, refused, signals_held_back

MANIFEST = "files.sha256"
"""The name of the list."""

_COMPILED, _SUFFIXES = "__pycache__", (".pyc", ".nbi", ".nbc")
"""The folder of compiled files, which Python and numba write again if it is missing, and their
suffixes; any other file in that folder belongs to the user."""

_FRESH, _PREVIOUS = "fresh", "old"
"""The new and the previous directory in the hidden directory of a run."""


def with_manifest(files: Mapping[str, str]) -> dict[str, str]:
    """The texts of all files of a directory, by name; their list comes first."""
    lines = [f"{_checksum(text.encode())}  {name}" for name, text in sorted(files.items())]
    return {MANIFEST: "\n".join([*lines, ""]), **files}


def replace_folder(files: Mapping[str, str], folder: Path, kept: str = "") -> None:
    """Replace a directory by these files, of which the first is their list.

    kept: an entry that stays as it is, in a directory whose files are under version control; else
        a written file that was changed later belongs to the user.

    Raises BadTarget if the directory contains a file that belongs to the user, or cannot be
    written.
    """
    demand_replaceable(folder, kept)
    with signals_held_back():
        with refused(folder):
            folder.parent.mkdir(parents=True, exist_ok=True)
            workshop = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
        fresh, old = workshop / _FRESH, workshop / _PREVIOUS
        try:
            fresh.mkdir()
            if kept:
                shutil.copytree(folder / kept, fresh / kept)
            for name, text in files.items():
                (fresh / name).parent.mkdir(parents=True, exist_ok=True)
                (fresh / name).write_bytes(text.encode())
            if folder.exists():
                folder.replace(old)
            fresh.replace(folder)
        except BaseException as error:
            note = _put_back(old, folder)
            if isinstance(error, OSError):
                why = f"cannot be replaced ({error.strerror}){note}"
                raise BadTarget(str(folder), why) from error
            raise
        finally:
            if folder.exists() or not old.exists():
                shutil.rmtree(workshop, ignore_errors=True)


def demand_replaceable(folder: Path, kept: str = "") -> None:
    """Raise BadTarget unless `folder` can be created, is empty, or holds only files of a list."""
    with refused(folder):
        demand_writable(folder)
    if not folder.exists() and not folder.is_symlink():
        return
    if folder.is_symlink() or not folder.is_dir():
        raise BadTarget(str(folder), "is not a directory")
    if stranger := _not_written(folder, kept):
        raise BadTarget(str(folder), f"contains {stranger}")
    if folder.resolve() in (Path.cwd(), *Path.cwd().parents):
        raise BadTarget(str(folder), "is the current directory or contains it")


def _put_back(old: Path, folder: Path) -> str:
    """Move the old directory back; if that fails too, return a note of where it is."""
    if old.exists() and not folder.exists():
        try:
            old.replace(folder)
        except OSError:
            return f", and the old directory is now {old}"
    return ""


# ------------------------------------------------------------------ the list of the files


def _not_written(folder: Path, kept: str) -> str:
    """Name the first entry that belongs to the user, and say why; "" if there is none."""
    listed = _listed(folder / MANIFEST)
    for path in entries(folder, listed, kept):
        name = path.relative_to(folder).as_posix()
        if path.is_file() and listed and name == MANIFEST:
            continue
        if name not in listed:
            unlisted = f"is not in the list {MANIFEST} of what was written there"
            return f"{name!r}, which {unlisted if listed else 'was not written by `derive`'}"
        if not path.is_file() or (not kept and _checksum(path.read_bytes()) != listed[name]):
            return f"{name!r}, which was changed after it was written"
    return ""


def entries(folder: Path, names: Iterable[str], kept: str = "") -> list[Path]:
    """All entries of a directory, in order, except compiled files and the entry `kept`.

    A folder is entered if it is to hold one of the named files; any other counts as one entry.
    """
    inner = {folder / parent for name in names for parent in Path(name).parents}

    def below(here: Path) -> Iterator[Path]:
        for path in sorted(here.iterdir()) if here.is_dir() else []:
            if path == folder / kept:
                continue
            if path in inner and path.is_dir() and not path.is_symlink():
                yield from below(path)
            elif path.name == _COMPILED and path.is_dir() and not path.is_symlink():
                yield from (each for each in sorted(path.iterdir()) if not _is_compiled(each))
            else:
                yield path

    return [*below(folder)]


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
