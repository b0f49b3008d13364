"""Bodies that were built before, found by the content of all that they follow from.

    program_digest  the sources of `derive` and the versions of libraries -> a digest
    key_of          a geometry file and that digest -> the body's key; None: it is never kept
    Cache.get       a key -> the Body that was kept under it, or None
    Cache.put       a key and a Body -> a file

One JSON file a body, in the user's cache directory or in the directory that the environment
variable DERIVE_CACHE names; nothing is kept where it is empty.  A file that is not whole, or not
ours, is as good as none, and a directory that cannot be read or written is no error.

A key says what a body follows from only if its geometry file reads nothing but itself.  So one that
imports anything besides SymPy, mpmath, math, fractions and the three names of `derive` that a
geometry needs, or that names a built-in function by which it could read or execute more, is not
kept.

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

from derive.body import Body
from derive.files import write_whole
from derive.proof.verdict import Verdict

VARIABLE = "DERIVE_CACHE"
"""Names the directory; empty: nothing is kept."""

PROGRAM = Path(__file__).parent
"""The package whose sources every body follows from."""

MOST = 200
"""Bodies kept; the ones used last stay."""

_LIBRARIES = ("sympy", "mpmath", "ruff", "gmpy2", "python-flint")
"""What else the bytes of a module depend on; the last two take over SymPy's numbers if present."""

_IMPORTS = {"sympy", "mpmath", "math", "fractions", "__future__"}
_FROM_DERIVE = {"Geometry", "parameter", "x"}
_READ_MORE = {
    *("open", "input", "eval", "exec", "compile", "breakpoint", "globals", "vars"),
    *("__import__", "__builtins__", "__loader__", "__spec__", "__file__"),
}
"""Names by which a file without further imports could depend on more than its bytes."""

_OURS = re.compile(r"[0-9a-f]{64}\.(json|\w+\.tmp)")


# ------------------------------------------------------------------ keys


def program_digest(program: Path = PROGRAM) -> str:
    """Digest of every source file of `derive` but the library's bodies, and of the versions."""
    bodies = program / "geometries"
    files = sorted(
        (path.relative_to(program).as_posix(), _content(path))
        for path in program.rglob("*.py")
        if bodies not in path.parents
    )
    return _digest([files, versions()])


def _content(path: Path) -> str:
    """Digest of a file; empty for one that is gone since it was listed."""
    try:
        return sha256(path.read_bytes()).hexdigest()
    except OSError:
        return ""


@cache
def program_as_loaded() -> str:
    """The digest when this process first asked; files may change after it has imported them."""
    return program_digest()


def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that have a say in the bytes of a module."""
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    return {"python": python} | {name: _version(name) for name in _LIBRARIES}


def _version(library: str) -> str:
    try:
        return metadata.version(library)
    except metadata.PackageNotFoundError:
        return "absent"


def key_of(geometry: Path, origin: str, program: str) -> str | None:
    """The key of the body that `program` makes of a geometry file, or None if it is never kept.

    origin: what the module says its g(x) came from.
    """
    try:
        if not geometry.is_file():  # a device may have no end
            return None
        source = geometry.read_bytes()
    except (OSError, ValueError):
        return None
    if not _is_all_there_is(source):
        return None
    return _digest([origin, sha256(source).hexdigest(), program])


def _is_all_there_is(source: bytes) -> bool:
    """Whether a geometry file follows from its own bytes."""
    try:
        with catch_warnings():
            simplefilter("ignore")  # loading the file tells the user
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
    """Bodies in the files of one directory; None: nothing is kept."""

    folder: Path | None

    def get(self, key: str | None) -> Body | None:
        """The body kept under `key`, if there is one and its file is as it was written."""
        if self.folder is None or key is None:
            return None
        path = self.folder / f"{key}.json"
        try:
            body = _read(path.read_bytes(), key)
        except (OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
            return None
        with suppress(OSError):
            os.utime(path)
        return body

    def put(self, key: str, body: Body) -> None:
        """Keep a body; its file is there whole or not at all."""
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
        """Those of the directory that were written here, half-written ones included."""
        if self.folder is not None:
            yield from (p for p in self.folder.iterdir() if _OURS.fullmatch(p.name))


def users_cache() -> Cache:
    """The cache that the environment asks for; none where others may write to it."""
    folder = _asked_for()
    return Cache(folder if folder and _is_private(folder) else None)


def distrusted() -> Path | None:
    """The directory that is asked for and not used, since others may write to it."""
    folder = _asked_for()
    return folder if folder and not _is_private(folder) else None


def _asked_for() -> Path | None:
    folder = os.environ.get(VARIABLE)
    if folder is None:
        folder = user_cache_dir("contact-derive", appauthor=False)
    return Path(folder) if folder else None


def _is_private(folder: Path) -> bool:
    """Whether nobody else may write to a directory; one that is not there will be made so."""
    try:
        status = folder.stat()
    except OSError:
        return True
    mine = not hasattr(os, "getuid") or status.st_uid == os.getuid()
    return mine and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def _last_used(path: Path) -> float:
    try:
        return path.stat().st_mtime
    except OSError:  # another process has forgotten it
        return 0.0


def _written(body: Body, key: str) -> bytes:
    facts = asdict(body)
    del facts["kept"]
    return json.dumps({"body": facts, "digest": _digest([key, facts])}).encode()


def _read(content: bytes, key: str) -> Body:
    """The body in a file; raises one of many errors for a file that `_written` did not make."""
    entry: dict[str, Any] = json.loads(content)
    facts = entry["body"]
    if entry["digest"] != _digest([key, facts]):
        raise ValueError("not as it was written")
    if [name for name, _ in facts["proofs"]] != [name for name, _ in facts["verdicts"]]:
        raise ValueError("verdicts without their proofs")
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
