"""A cache of built bodies, identified by the content of everything that they depend on.

    program_digest  the sources of `derive` and the versions of libraries -> a digest
    key_of          a geometry file and that digest -> the body's key; None if it is never kept
    Cache.get       a key -> the Body that was kept under it, or None
    Cache.put       a key and a Body -> a file

Each body is one JSON file, in the user's cache directory or in the directory named by the
environment variable DERIVE_CACHE.  Nothing is kept if that variable is empty.  A file that is
incomplete or was not written here is ignored, and a directory that cannot be read or written is
not an error.  Neither a directory nor a file is used if it belongs to another user or if others may
write to it.

A key is complete only if the geometry file reads nothing but itself.  A file is therefore not kept
if it imports anything besides SymPy, mpmath, math, fractions and the three names of `derive` that
a geometry needs, or if it uses a built-in function by which it could read or execute more.

Nothing here imports SymPy.
"""

import ast
import json
import os
import re
import stat
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path
from typing import Any
from warnings import catch_warnings, simplefilter

from platformdirs import user_cache_dir

from derive.command.files import write_whole
from derive.proof.verdict import Verdict
from derive.sheet.built import Body

VARIABLE = "DERIVE_CACHE"
"""Environment variable that names the directory; if it is empty, nothing is kept."""

PROGRAM = Path(__file__).parents[1]
"""The package on whose sources every body depends."""

MOST = 200
"""Largest number of bodies kept; those used most recently stay."""

_LIBRARIES = ("sympy", "mpmath", "ruff", "gmpy2", "python-flint")
"""Libraries that affect the text of a module; SymPy computes with the last two if installed."""

_IMPORTS = {"sympy", "mpmath", "math", "fractions", "__future__"}
_FROM_DERIVE = {"Geometry", "parameter", "x"}
_READ_MORE = {
    *("open", "input", "eval", "exec", "compile", "breakpoint", "globals", "vars"),
    *("__import__", "__builtins__", "__loader__", "__spec__", "__file__"),
}
"""Names by which a file without other imports could depend on more than its own content."""

_OURS = re.compile(r"[0-9a-f]{64}\.(json|\w+\.tmp)")


# ------------------------------------------------------------------ keys


def program_digest(program: Path = PROGRAM) -> str:
    """Digest of all source files of `derive`, except the library's bodies, and of the versions."""
    bodies = program / "geometries"
    files = sorted(
        (path.relative_to(program).as_posix(), _content(path))
        for path in (*program.rglob("*.py"), *program.rglob("*.txt"))
        if bodies not in path.parents
    )
    return _digest([files, versions()])


def _content(path: Path) -> str:
    """Digest of a file; empty if the file was removed after it was listed."""
    try:
        return sha256(path.read_bytes()).hexdigest()
    except OSError:
        return ""


@cache
def program_as_loaded() -> str:
    """Digest at the first call in this process; source files may change after they are imported."""
    return program_digest()


def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that affect the text of a module."""
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    return {"python": python} | {name: _version(name) for name in _LIBRARIES}


def _version(library: str) -> str:
    try:
        return metadata.version(library)
    except metadata.PackageNotFoundError:
        return "absent"


def key_of(geometry: Path, origin: str, program: str) -> str | None:
    """Key of the body that `program` makes from a geometry file; None if the body is never kept.

    origin: the source of g(x) that the module states.
    """
    try:
        if not geometry.is_file():  # reading from a device may never end
            return None
        source = geometry.read_bytes()
    except (OSError, ValueError):
        return None
    if not _is_self_contained(source):
        return None
    return _digest([origin, sha256(source).hexdigest(), program])


def _is_self_contained(source: bytes) -> bool:
    """Whether a geometry file depends only on its own content."""
    try:
        with catch_warnings():
            simplefilter("ignore")  # the user sees the warnings when the file is loaded
            nodes = [*ast.walk(ast.parse(source))]
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return not any(_reads_more(node) for node in nodes)


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


# ------------------------------------------------------------------ files


@dataclass(frozen=True)
class Cache:
    """Bodies in the files of one directory; if `folder` is None, nothing is kept."""

    folder: Path | None

    def get(self, key: str | None) -> Body | None:
        """The body kept under `key`, or None if there is none or its file is not to be trusted."""
        if self.folder is None or key is None:
            return None
        path = self.folder / f"{key}.json"
        try:
            with path.open("rb") as file:
                if _fault(os.fstat(file.fileno())):  # it is replaced when the body is kept again
                    return None
                body = _read(file.read(), key)
        except (OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
            return None
        with suppress(OSError):
            os.utime(path)
        return body

    def put(self, key: str, body: Body) -> None:
        """Keep a body; its file is written completely or not at all."""
        if self.folder is None:
            return
        with suppress(OSError):
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            write_whole(_written(body, key), self.folder / f"{key}.json", mode=0o600)
            self._forget_the_oldest()

    def _forget_the_oldest(self) -> None:
        for path in sorted(self._files(), key=_last_used, reverse=True)[MOST:]:
            path.unlink(missing_ok=True)

    def _files(self) -> Iterator[Path]:
        """Files in the directory that were written here, including incomplete ones."""
        if self.folder is not None:
            yield from (p for p in self.folder.iterdir() if _OURS.fullmatch(p.name))


def users_cache() -> Cache:
    """The cache that the environment selects; it keeps nothing in a directory that others share."""
    return Cache(None if distrusted() else _selected())


def distrusted() -> str:
    """Why the selected directory is not used, and what to do; "" if it is used."""
    folder = _selected()
    try:
        fault = _fault_of(folder) if folder else ""
    except OSError:  # a missing directory will belong to the user
        return ""
    if not folder or not fault:
        return ""
    remedy = f"run `export {VARIABLE}=~/derive-cache` to use a directory of your own"
    return f"{folder}: nothing is kept there, because {fault}: {remedy}"


def _fault_of(folder: Path) -> str:
    return (
        _fault(folder.stat()) if folder.is_dir() or not folder.exists() else "it is not a directory"
    )


def _selected() -> Path | None:
    folder = os.environ.get(VARIABLE)
    if folder is None:
        folder = user_cache_dir("contact-derive", appauthor=False)
    return Path(folder) if folder else None


_FOREIGN, _OPEN = "it belongs to another user", "other users can write to it"


def _fault(status: os.stat_result) -> str:
    """Why a file or directory is not to be trusted; "" if only the user may write to it."""
    if not hasattr(os, "getuid"):  # the rights of Windows are not in these numbers
        return ""
    if status.st_uid != os.getuid():
        return _FOREIGN
    return _OPEN if status.st_mode & (stat.S_IWGRP | stat.S_IWOTH) else ""


def _last_used(path: Path) -> float:
    try:
        return path.stat().st_mtime
    except OSError:  # another process has removed it
        return 0.0


def _written(body: Body, key: str) -> bytes:
    facts = asdict(body)
    del facts["kept"]
    return json.dumps({"body": facts, "digest": _digest([key, facts])}).encode()


def _read(content: bytes, key: str) -> Body:
    """The body in a file; raises one of several errors if `_written` did not make the file."""
    entry: dict[str, Any] = json.loads(content)
    facts = entry["body"]
    if entry["digest"] != _digest([key, facts]):
        raise ValueError("the file was changed after it was written")
    if [name for name, _ in facts["proofs"]] != [name for name, _ in facts["verdicts"]]:
        raise ValueError("verdicts and proofs do not belong together")
    return Body(
        name=facts["name"],
        text=facts["text"],
        stuck=facts["stuck"],
        seconds=facts["seconds"],
        closed=tuple(facts["closed"]),
        numerical=tuple(facts["numerical"]),
        verdicts=tuple((name, Verdict(found)) for name, found in facts["verdicts"]),
        proofs=tuple((str(name), str(words)) for name, words in facts["proofs"]),
        struck=facts["struck"],
        kept=True,
    )
