"""Compares the files of a generated package with a directory, or replaces the directory.

In:  the texts of the modules.
Out: a list of differences, or the replaced directory.  It is replaced completely or not at all.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path

from derive.codegen.mark import MARK
from derive.errors import BadOutput
from derive.folder import replace_folder
from derive.manifest import entries, with_manifest
from derive.runtime import edge

_RUNTIME = Path(__file__).parent.parent / "runtime"
_TITLE = (
    '"""Contact laws as NumPy functions, one module for each body; every formula is proven."""\n'
)

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

Files = Mapping[str, str]
"""The text of each file of a package, by its name."""


@dataclass(frozen=True)
class Difference:
    """One file that differs from its generated version."""

    name: str
    what: str
    diff: str = ""

    @property
    def removed(self) -> bool:
        """Whether the generated package does not have this file."""
        return self.what == "not generated"

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
    on_disk = {p.relative_to(folder).as_posix(): p for p in entries(folder, files)}
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
    replace_folder(files, folder, BadOutput, edited)


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
