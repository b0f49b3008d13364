"""A generated package as a whole: its files, compared with a directory or put in its place.

In:  texts of modules.
Out: a list of differences, or the directory replaced whole or not at all.
"""

import ast
import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path

from derive.codegen.mark import MARK
from derive.errors import BadOutput
from derive.exchange import put_in_place
from derive.runtime import edge

_RUNTIME = Path(__file__).parent.parent / "runtime"
_TITLE = '"""Contact laws as NumPy functions, one module a body; every formula is proven."""\n'

_LISTED = "__all__"
"""Names the modules of a package; another that lies beside them is its user's own."""

_COMPILED = "__pycache__"
"""Where Python, and numba, keep what they compiled; they make it again if it is gone."""

FULL_STICK = "full_stick"
"""The module of what belongs to no body."""

_EDGE = "\n".join(
    (
        '"""The edge of a contact without its geometry: slip zones from coefficients."""\n',
        "from .runtime.edge import (",
        *(f"    {name}," for name in edge.__all__),
        ")\n",
        "__all__ = [",
        *(f'    "{name}",' for name in edge.__all__),
        "]\n",
    )
)
"""The module that publishes what the runtime knows of an edge alone."""

_FOLDERS = {_RUNTIME.name, *(path.name for path in _RUNTIME.rglob("*") if path.is_dir())} - {
    _COMPILED
}
"""Names of the folders that a package has."""

_SUFFIXES = (".pyc", ".nbi", ".nbc")
"""Endings of what lies there; anything else would be lost with it."""

Files = Mapping[str, str]
"""Name of each file of a package, and its text."""


@dataclass(frozen=True)
class Difference:
    """One file that is not as it would be generated."""

    name: str
    what: str
    diff: str = ""

    @property
    def lines(self) -> list[str]:
        """The diff line by line."""
        return self.diff.splitlines()


def package_files(modules: Files) -> dict[str, str]:
    """All files of a package that holds `modules`, texts by module name, and the runtime."""
    names = sorted({*modules, "edge"})
    listed = "\n".join([f"{_LISTED} = [", *(f'    "{name}",' for name in names), "]"])
    files = {"__init__.py": f"{MARK}\n{_TITLE}\n{listed}\n", "py.typed": ""}
    files |= {f"{name}.py": text for name, text in sorted(modules.items())}
    files["edge.py"] = f"{MARK}\n{_EDGE}"
    for path in sorted(_RUNTIME.rglob("*.py")):
        name = path.relative_to(_RUNTIME.parent).as_posix()
        files[name] = f"{MARK}\n{path.read_text(encoding='utf-8')}"
    return files


def modules_in(folder: Path) -> dict[str, str]:
    """Texts of the modules of bodies that a generated package holds, by name."""
    paths = [p for p in sorted(folder.glob("[!_]*.py")) if p.name != "edge.py"]
    return {p.stem: p.read_text(encoding="utf-8") for p in paths}


def differences(files: Files, folder: Path) -> list[Difference]:
    """What in `folder` is not as in `files`: the list of names first, then every byte."""
    held = {p.relative_to(folder).as_posix(): p for p in _entries(folder)}
    found = [Difference(name, "missing") for name in files if name not in held]
    found += [Difference(name, "not generated") for name in held if name not in files]
    for name, path in held.items():
        if name in files and not path.is_file():
            found.append(Difference(name, "no file"))
        elif name in files and path.read_bytes() != files[name].encode():
            found.append(Difference(name, "changed", _diff(name, path, files[name])))
    return sorted(found, key=lambda difference: difference.name)


def _diff(name: str, path: Path, wanted: str) -> str:
    on_disk = path.read_text(encoding="utf-8", errors="replace")
    lines = unified_diff(
        on_disk.splitlines(keepends=True),
        wanted.splitlines(keepends=True),
        f"{name} on disk",
        f"{name} as generated",
    )
    return "".join(lines)


def publish(files: Files, folder: Path) -> None:
    """Put a package in place of `folder`, whole or not at all.

    Raises BadOutput where `folder` holds anything that was not generated, or can't be written.
    """
    demand_replaceable(folder)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        workshop = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    except OSError as error:
        raise BadOutput(str(folder), f"can't be written ({error.strerror})") from error
    fresh, old = workshop / "fresh", workshop / "old"
    try:
        fresh.mkdir()
        for name, text in files.items():
            (fresh / name).parent.mkdir(parents=True, exist_ok=True)
            (fresh / name).write_bytes(text.encode())
        put_in_place(fresh, folder, old)
    except OSError as error:
        why = f"can't be replaced ({error.strerror}){_put_back(old, folder)}"
        raise BadOutput(str(folder), why) from error
    except BaseException:
        _put_back(old, folder)
        raise
    finally:
        if folder.exists() or not old.exists():
            shutil.rmtree(workshop, ignore_errors=True)


def _put_back(old: Path, folder: Path) -> str:
    """The old package in its place again; in words where it lies if even that fails."""
    if old.exists() and not folder.exists():
        try:
            old.replace(folder)
        except OSError:
            return f", the old package lies in {old}"
    return ""


def resolved(folder: Path) -> Path:
    """The directory that a path leads to, through links to directories that are there.

    Raises BadOutput for a link that leads nowhere: what it names would be made wherever that is;
    and for what can't be a path.
    """
    try:
        for link in (folder, *folder.parents):
            if link.is_symlink() and not link.exists():
                raise BadOutput(str(folder), f"leads through {link.name!r}, a link to nothing")
        return folder.resolve()
    except OSError as error:  # such as a name that is too long
        raise BadOutput(str(folder), f"can't be reached ({error.strerror})") from error


def demand_replaceable(folder: Path) -> None:
    """Raise BadOutput unless `folder` is absent, empty, or a package made here."""
    if not folder.exists() and not folder.is_symlink():
        return
    if folder.is_symlink() or not folder.is_dir():
        raise BadOutput(str(folder), "is no directory")
    listed = _modules_listed(folder / "__init__.py")
    for path in _entries(folder):
        if not _is_ours(path) or (path.parent == folder and listed and path.stem not in listed):
            name = path.relative_to(folder).as_posix()
            raise BadOutput(str(folder), f"holds {name!r}, which was not generated")
    if folder.resolve() in (Path.cwd(), *Path.cwd().parents):
        raise BadOutput(str(folder), "is where this command runs")


def _modules_listed(init: Path) -> set[str]:
    """Names of what was generated into a folder; none where it is not told, as long ago."""
    try:
        tree = ast.parse(init.read_bytes())
        lists = [n.value for n in tree.body if isinstance(n, ast.Assign)]
        names = [name for each in lists for name in ast.literal_eval(each)]
    except (OSError, ValueError, TypeError, SyntaxError, RecursionError, MemoryError):
        return set()
    return {*names, "__init__", "py"} if names else set()


def _entries(folder: Path) -> list[Path]:
    """What a folder and those in it hold, but for what was compiled."""
    found: list[Path] = []
    for path in sorted(folder.iterdir()) if folder.is_dir() else []:
        if path.is_symlink() or not path.is_dir():
            found.append(path)
        elif path.name == _COMPILED:
            found += [p for p in sorted(path.iterdir()) if not _is_compiled(p)]
        elif path.name in _FOLDERS:
            found += _entries(path) or [path]
        else:
            found.append(path)
    return found


def _is_compiled(path: Path) -> bool:
    return path.is_file() and not path.is_symlink() and path.suffix in _SUFFIXES


def _is_ours(path: Path) -> bool:
    if not path.is_file():
        return False
    first = path.read_bytes()[: len(MARK)]
    return first == MARK.encode() if path.suffix == ".py" else path.name == "py.typed"
