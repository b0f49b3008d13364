"""A cache of built bodies, identified by the content of everything that they depend on.

Each body is one JSON file, in the user's cache directory or in the directory named by the
environment variable DERIVE_CACHE.  Nothing is kept if that variable is empty.  The directory is
trusted: nobody else should be able to write to it.  A directory that cannot be read or written is
not an error, nor is a file that does not contain a body.

A key is complete only if the geometry file reads nothing but itself.  A file is therefore not kept
if it imports anything besides SymPy, mpmath, math, fractions and the three names of `derive` that
a geometry needs, or if it uses a built-in function by which it could read or execute more.

Nothing here imports SymPy.
"""

import ast
import json
import os
import sys
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path
from warnings import catch_warnings, simplefilter

import msgspec
from platformdirs import user_cache_dir

from derive.command.files import write_whole
from derive.sheet.built import BuiltBody

VARIABLE = "DERIVE_CACHE"
"""Environment variable that names the directory; if it is empty, nothing is kept."""

PROGRAM = Path(__file__).parents[1]
"""The package on whose sources every body depends."""

MOST = 200
"""Largest number of bodies kept; those used most recently stay."""

_LIBRARIES = ("sympy", "mpmath", "ruff", "gmpy2", "python-flint")
"""Libraries that affect the text of a module; SymPy computes with the last two."""

_IMPORTS = {"sympy", "mpmath", "math", "fractions", "__future__"}
_FROM_DERIVE = {"Geometry", "parameter", "x"}
_READ_MORE = {
    *("open", "input", "eval", "exec", "compile", "breakpoint", "globals", "vars"),
    *("__import__", "__builtins__", "__loader__", "__spec__", "__file__"),
}
"""Names by which a file without other imports could depend on more than its own content."""


def program_digest(program: Path = PROGRAM) -> str:
    """Digest of all files of `derive`, except the library's bodies, and of the versions."""
    left_out = {program / "geometries"}
    files = sorted(
        (path.relative_to(program).as_posix(), sha256(path.read_bytes()).hexdigest())
        for path in program.rglob("*.*")
        if path.is_file() and path.suffix != ".pyc" and left_out.isdisjoint(path.parents)
    )
    versions = {library: metadata.version(library) for library in _LIBRARIES}
    return _digest([files, versions, sys.version_info[:2]])


@cache
def program_as_loaded() -> str:
    """Digest at the first call in this process; source files may change after they are imported."""
    return program_digest()


def key_of(geometry: Path, origin: str, program: str) -> str | None:
    """Key of the body that `program` makes from a geometry file; None if the body is never kept.

    origin: the source of g(x) that the module states.
    """
    try:
        source = geometry.read_bytes() if geometry.is_file() else b"("  # a device may never end
        with catch_warnings():
            simplefilter("ignore")  # the user sees the warnings when the file is loaded
            nodes = [*ast.walk(ast.parse(source))]
    except (OSError, ValueError, SyntaxError, RecursionError, MemoryError):
        return None
    if any(map(_reads_more, nodes)):
        return None
    return _digest([origin, sha256(source).hexdigest(), program])


def _reads_more(node: ast.AST) -> bool:
    if isinstance(node, ast.Import):
        return any(alias.name.partition(".")[0] not in _IMPORTS for alias in node.names)
    if isinstance(node, ast.ImportFrom) and node.module == "derive" and not node.level:
        return any(alias.name not in _FROM_DERIVE for alias in node.names)
    if isinstance(node, ast.ImportFrom):
        return bool(node.level) or (node.module or "").partition(".")[0] not in _IMPORTS
    return isinstance(node, ast.Name) and node.id in _READ_MORE


def _digest(what: object) -> str:
    return sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()


@dataclass(frozen=True)
class Cache:
    """Bodies in the files of one directory; if `folder` is None, nothing is kept."""

    folder: Path | None

    def get(self, key: str | None) -> BuiltBody | None:
        """The body kept under `key`, or None."""
        if self.folder is None or key is None:
            return None
        path = self.folder / f"{key}.json"
        try:
            body = msgspec.json.decode(path.read_bytes(), type=BuiltBody)
            os.utime(path)  # the oldest files are removed first
        except (OSError, msgspec.MsgspecError, ValueError, RecursionError):
            return None
        return replace(body, kept=True)

    def put(self, key: str, body: BuiltBody) -> None:
        """Keep a body; its file is written completely or not at all."""
        if self.folder is None:
            return
        with suppress(OSError):
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            write_whole(msgspec.json.encode(body), self.folder / f"{key}.json", mode=0o600)
            kept = sorted(
                self.folder.glob(f"{'?' * len(key)}.json"), key=lambda p: p.stat().st_mtime
            )
            for path in kept[:-MOST]:
                path.unlink(missing_ok=True)


def users_cache() -> Cache:
    """The cache that the environment selects."""
    folder = os.environ.get(VARIABLE, user_cache_dir("contact-derive", appauthor=False))
    return Cache(Path(folder) if folder else None)
