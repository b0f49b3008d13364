"""Makes the files of a generated package, and compares them with a directory.

In:  the texts of the modules.
Out: the texts of all files, or a list of differences.

The hand-written library of every package, runtime/, stands in `generated`, where it is left alone.
It is copied into other packages.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path

from derive.codegen.mark import MARK
from derive.command.errors import BadTarget
from derive.command.folder import entries, with_manifest

RUNTIME = "runtime"
"""The folder of the library."""

LIBRARY = Path(__file__).parents[2] / "generated" / RUNTIME
"""That folder under version control."""

_TITLE = (
    '"""Contact laws as NumPy functions, one module for each body; every formula is proven."""\n'
)

FULL_STICK = "full_stick"
"""The module of the functions that do not depend on a body."""

_EDGE = '''"""Slip zones at the edge of a contact from its coefficients, without its geometry."""

from .runtime.edge import *  # noqa: F403
from .runtime.edge import __all__ as __all__
'''
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


def package_files(modules: Files, with_runtime: bool = True) -> dict[str, str]:
    """All files of a package: `modules`, given as texts by name, the runtime, and a list of all."""
    names = sorted({*modules, "edge"})
    listed = "\n".join(["__all__ = [", *(f'    "{name}",' for name in names), "]"])
    files = {"__init__.py": f"{MARK}\n{_TITLE}\n{listed}\n", "py.typed": ""}
    files |= {f"{name}.py": text for name, text in sorted(modules.items())}
    files["edge.py"] = f"{MARK}\n{_EDGE}"
    if with_runtime:
        for path in sorted(LIBRARY.rglob("*.py")):
            files[path.relative_to(LIBRARY.parent).as_posix()] = path.read_text(encoding="utf-8")
    return with_manifest(files)


def modules_in(folder: Path) -> dict[str, str]:
    """The texts of the modules of bodies in a generated package, by name."""
    paths = [p for p in sorted(folder.glob("[!_]*.py")) if p.name != "edge.py"]
    return {p.stem: p.read_text(encoding="utf-8") for p in paths}


def differences(files: Files, folder: Path, kept: str = "") -> list[Difference]:
    """The differences between `folder` and `files`, in the names and in the content.

    kept: an entry that is not compared.
    """
    on_disk = {p.relative_to(folder).as_posix(): p for p in entries(folder, files, kept)}
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


def resolved(folder: Path) -> Path:
    """The directory to which a path leads, with all links resolved.

    Raises BadTarget for a broken link, because the package would be created at its target, and for
    a path that cannot exist.
    """
    try:
        for link in (folder, *folder.parents):
            if link.is_symlink() and not link.exists():
                raise BadTarget(str(folder), f"leads through {link.name!r}, which is a broken link")
        return folder.resolve()
    except OSError as error:  # for example, the name is too long
        raise BadTarget(str(folder), f"cannot be reached ({error.strerror})") from error
