"""Compares the files of a generated package with a directory, or replaces the directory.

In:  the texts of the modules.
Out: a list of differences, or the replaced directory.  It is replaced completely or not at all.
"""

import os
import re
import shutil
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path

from derive.codegen.mark import MARK
from derive.errors import BadOutput
from derive.exchange import put_in_place
from derive.files import demand_writable
from derive.manifest import MANIFEST, not_written, with_manifest
from derive.runtime import edge

_RUNTIME = Path(__file__).parent.parent / "runtime"
_TITLE = (
    '"""Contact laws as NumPy functions, one module for each body; every formula is proven."""\n'
)

_FRESH, _PREVIOUS = "fresh", "old"
"""The new and the previous package in the hidden directory of a run."""

_COMPILED = "__pycache__"
"""The folder of compiled files; Python and numba write it again if it is missing."""

FULL_STICK = "full_stick"
"""The module of the functions that do not depend on a body."""

_EDGE = "\n".join(
    (
        '"""Slip zones at the edge of a contact from its coefficients, without its geometry."""\n',
        "from .runtime.edge import (",
        *(f"    {name}," for name in edge.__all__),
        ")\n",
        "__all__ = [",
        *(f'    "{name}",' for name in edge.__all__),
        "]\n",
    )
)
"""The module that exports the functions of the runtime for the edge of a contact."""

_FOLDERS = {_RUNTIME.name, *(path.name for path in _RUNTIME.rglob("*") if path.is_dir())} - {
    _COMPILED
}
"""Names of the folders of a package."""

_OLD = 5.0
"""Age in seconds above which a hidden directory may be left over from a run that was killed."""

_SUFFIXES = (".pyc", ".nbi", ".nbc")
"""Suffixes of compiled files; a package with any other file in that folder is not replaced."""

Files = Mapping[str, str]
"""The text of each file of a package, by its name."""


@dataclass(frozen=True)
class Difference:
    """One file that differs from its generated version."""

    name: str
    what: str
    diff: str = ""

    @property
    def lines(self) -> list[str]:
        """The lines of the diff."""
        return self.diff.splitlines()


def package_files(modules: Files) -> dict[str, str]:
    """All files of a package: `modules`, given as texts by name, the runtime, and a list of all."""
    names = sorted({*modules, "edge"})
    listed = "\n".join(["__all__ = [", *(f'    "{name}",' for name in names), "]"])
    files = {"__init__.py": f"{MARK}\n{_TITLE}\n{listed}\n", "py.typed": ""}
    files |= {f"{name}.py": text for name, text in sorted(modules.items())}
    files["edge.py"] = f"{MARK}\n{_EDGE}"
    for path in sorted(_RUNTIME.rglob("*.py")):
        name = path.relative_to(_RUNTIME.parent).as_posix()
        files[name] = f"{MARK}\n{path.read_text(encoding='utf-8')}"
    return with_manifest(files)


def modules_in(folder: Path) -> dict[str, str]:
    """The texts of the modules of bodies in a generated package, by name."""
    paths = [p for p in sorted(folder.glob("[!_]*.py")) if p.name != "edge.py"]
    return {p.stem: p.read_text(encoding="utf-8") for p in paths}


def differences(files: Files, folder: Path) -> list[Difference]:
    """The differences between `folder` and `files`, in the names and in the content."""
    on_disk = {p.relative_to(folder).as_posix(): p for p in _entries(folder)}
    differing = [Difference(name, "missing") for name in files if name not in on_disk]
    differing += [Difference(name, "not generated") for name in on_disk if name not in files]
    for name, path in on_disk.items():
        if name in files and not path.is_file():
            differing.append(Difference(name, "not a file"))
        elif name in files and path.read_bytes() != files[name].encode():
            differing.append(Difference(name, "changed", _diff(name, path, files[name])))
    return sorted(differing, key=lambda difference: difference.name)


def _diff(name: str, path: Path, wanted: str) -> str:
    on_disk = path.read_text(encoding="utf-8", errors="replace")
    lines = unified_diff(
        on_disk.splitlines(keepends=True),
        wanted.splitlines(keepends=True),
        f"{name} on disk",
        f"{name} as generated",
    )
    return "".join(lines)


def publish(files: Files, folder: Path, edited: bool = True) -> None:
    """Replace `folder` by a package, completely or not at all.

    edited: whether a generated file that was changed later belongs to the user.

    Raises BadOutput if `folder` contains a file that was not generated, or was changed since, or
    cannot be written.
    """
    demand_replaceable(folder, edited)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        workshop = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    except OSError as error:
        raise BadOutput(str(folder), f"cannot be written ({error.strerror})") from error
    fresh, old = workshop / _FRESH, workshop / _PREVIOUS
    with _in_use(workshop):
        _fill_and_exchange(files, folder, fresh, old, workshop)
    remove_leftovers(folder)


def _fill_and_exchange(files: Files, folder: Path, fresh: Path, old: Path, workshop: Path) -> None:
    try:
        fresh.mkdir()
        for name, text in files.items():
            (fresh / name).parent.mkdir(parents=True, exist_ok=True)
            (fresh / name).write_bytes(text.encode())
        put_in_place(fresh, folder, old)
    except OSError as error:
        why = f"cannot be replaced ({error.strerror}){_put_back(old, folder)}"
        raise BadOutput(str(folder), why) from error
    except BaseException:
        _put_back(old, folder)
        raise
    finally:
        if folder.exists() or not old.exists():
            shutil.rmtree(workshop, ignore_errors=True)


@contextmanager
def _in_use(workshop: Path) -> Iterator[bool]:
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


def remove_leftovers(folder: Path) -> None:
    """Remove the hidden directories that killed runs have left beside a package.

    Only directories with names that `publish` gives are removed, and only if they hold nothing but
    generated files and no process uses them.
    """
    named = re.compile(rf"\.{re.escape(folder.name)}-[a-z0-9_]{{8}}")
    with suppress(OSError):
        for path in [p for p in folder.parent.iterdir() if named.fullmatch(p.name)]:
            with suppress(OSError), _in_use(path) as unused:
                if unused and _is_leftover(path):
                    shutil.rmtree(path, ignore_errors=True)


def _is_leftover(path: Path) -> bool:
    if path.is_symlink() or not path.is_dir() or time.time() - path.stat().st_mtime < _OLD:
        return False
    inside = list(path.iterdir())
    if any(p.is_symlink() or not p.is_dir() for p in inside):
        return False
    if not {p.name for p in inside} <= {_FRESH, _PREVIOUS}:
        return False
    held = [p for package in inside for p in _entries(package) if not _is_empty_folder(p)]
    return all(_is_ours(p) or (p.is_file() and p.stat().st_size == 0) for p in held)


def _is_empty_folder(path: Path) -> bool:
    return path.name in _FOLDERS and path.is_dir() and not any(path.iterdir())


def _put_back(old: Path, folder: Path) -> str:
    """Move the old package back to `folder`; if that fails too, return a note of where it is."""
    if old.exists() and not folder.exists():
        try:
            old.replace(folder)
        except OSError:
            return f", and the old package is now in {old}"
    return ""


def resolved(folder: Path) -> Path:
    """The directory to which a path leads, with all links resolved.

    Raises BadOutput for a broken link, because the package would be created at its target, and for
    a path that cannot exist.
    """
    try:
        for link in (folder, *folder.parents):
            if link.is_symlink() and not link.exists():
                raise BadOutput(str(folder), f"leads through {link.name!r}, which is a broken link")
        return folder.resolve()
    except OSError as error:  # for example, the name is too long
        raise BadOutput(str(folder), f"cannot be reached ({error.strerror})") from error


def demand_replaceable(folder: Path, edited: bool = True) -> None:
    """Raise BadOutput unless `folder` is empty or a generated package, or can be created."""
    try:
        demand_writable(folder)
    except OSError as error:
        raise BadOutput(str(folder), f"cannot be written ({error.strerror})") from error
    if not folder.exists() and not folder.is_symlink():
        return
    if folder.is_symlink() or not folder.is_dir():
        raise BadOutput(str(folder), "is not a directory")
    if stranger := not_written(folder, _entries(folder), edited):
        raise BadOutput(str(folder), f"contains {stranger}")
    if folder.resolve() in (Path.cwd(), *Path.cwd().parents):
        raise BadOutput(str(folder), "is the current directory or contains it")


def _entries(folder: Path) -> list[Path]:
    """All entries of a folder and of the folders of a package in it, except compiled files."""
    entries: list[Path] = []
    for path in sorted(folder.iterdir()) if folder.is_dir() else []:
        if path.is_symlink() or not path.is_dir():
            entries.append(path)
        elif path.name == _COMPILED:
            entries += [p for p in sorted(path.iterdir()) if not _is_compiled(p)]
        elif path.name in _FOLDERS:
            entries += _entries(path) or [path]
        else:
            entries.append(path)
    return entries


def _is_compiled(path: Path) -> bool:
    return path.is_file() and not path.is_symlink() and path.suffix in _SUFFIXES


def _is_ours(path: Path) -> bool:
    if not path.is_file():
        return False
    first = path.read_bytes()[: len(MARK)]
    return first == MARK.encode() if path.suffix == ".py" else path.name in ("py.typed", MANIFEST)
