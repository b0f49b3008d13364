"""Faults put into the program, one at a time: which of them no test catches.

    python -m tests.mutants GROUP [--count 100] [--jobs 2] [--only TEXT]

GROUP is theory, check, proof or runtime; `all` takes one after the other.  A mutant exchanges one
operator, comparison or boolean, drops a sign or a `not`, adds one to a number, or exchanges two
arguments of one call.  It is caught if a test fails or runs on for too long; tests that compare the
committed text of generated/ do not count.  The tests named after the mutated file run first, then
the others of its group, both until the first failure.  Every mutant is printed with the test that
caught it.  The exit status is 1 if more than three in a hundred survive.
"""

import ast
import os
import re
import shutil
import subprocess
import sys
import tempfile
from argparse import ArgumentParser
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from pathlib import Path
from queue import Queue
from time import perf_counter
from typing import NamedTuple

ROOT = Path(__file__).parent.parent
COPIED = ("derive", "generated", "tests", "notebooks", "docs", "examples", "pyproject.toml")
OF_TEXT = "not committed and not fresh_run and not drift"
"""Names of tests that compare text; they are not run."""

PATIENCE = 2.0
"""Tests that run on for this many times what those of the group take have caught a mutant."""

GROUPS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "theory": (
        ("derive/theory", "derive/codegen"),
        (
            *("derive/theory", "tests/derive/theory", "tests/derive/sheet", "tests/codegen"),
            *("tests/derive/test_closed_forms.py", "tests/edge/test_theory.py"),
        ),
    ),
    "check": (("derive/check", "derive/reading"), ("tests/check", "tests/derive/reading")),
    "proof": (
        ("derive/proof", "derive/body"),
        ("tests/derive/proof", "tests/derive/body", "tests/derive/sheet"),
    ),
    "runtime": (("generated/runtime",), ("tests/runtime", "tests/generated", "tests/edge")),
}
"""Folders of each group, and the tests that may catch what is wrong in them."""

NAMED = {
    "march": ("tests/runtime/test_march.py",),
    "mixed": ("tests/generated/test_turning.py",),
    "series": ("tests/generated/test_slip.py",),
    "segments": ("tests/runtime/test_segments.py",),
    "inverse": ("tests/generated/test_library.py",),
    "cycle": ("tests/runtime/test_cycle.py",),
    "cycles": ("tests/runtime/test_zone.py", "tests/runtime/test_march.py"),
    "chunks": ("tests/runtime/test_chunks.py",),
}
"""Tests of files that are not named after them."""


ELSEWHERE = ("tests/generated/test_cluster.py", "tests/runtime/test_kernels.py")
"""Tests of processes and of compiled files; they run for what is named like them alone."""


class Mutant(NamedTuple):
    """One fault: the file, its number there, the line, what stood there, what stands there now."""

    path: str
    number: int
    line: int
    before: str
    after: str

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.before}  ->  {self.after}"

    @property
    def text(self) -> str:
        """The whole file with the fault."""
        tree = ast.parse((ROOT / self.path).read_text(encoding="utf-8"))
        _, changed, attribute, value = [*_places(tree)][self.number]
        setattr(changed, attribute, value)
        return ast.unparse(tree)

    def tests(self, group: str) -> Iterator[tuple[str, ...]]:
        """Tests to run, in turn: those of the file, and those of the group."""
        stem = Path(self.path).stem
        own = [str(p.relative_to(ROOT)) for p in (ROOT / "tests").rglob(f"test_{stem}.py")]
        first = (*own, *NAMED.get(stem, ()))
        yield first
        yield (*GROUPS[group][1], *(f"--ignore={test}" for test in (*first, *ELSEWHERE)))


# ------------------------------------------------------------------ faults

Place = tuple[ast.AST, ast.AST, str, object]
"""What is shown; and what gets which attribute."""

OTHER: dict[type[ast.AST], type[ast.AST]] = {
    **{ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult},
    **{ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE, ast.LtE: ast.Gt},
    **{ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is},
    **{ast.In: ast.NotIn, ast.NotIn: ast.In, ast.And: ast.Or, ast.Or: ast.And},
}


def mutants_of(path: Path) -> Iterator[Mutant]:
    """Every fault of one file."""
    tree, name = ast.parse(path.read_text(encoding="utf-8")), str(path.relative_to(ROOT))
    for number, (shown, changed, attribute, value) in enumerate([*_places(tree)]):
        before, kept = ast.unparse(shown), getattr(changed, attribute)
        setattr(changed, attribute, value)
        yield Mutant(name, number, getattr(shown, "lineno", 0), before, ast.unparse(shown))
        setattr(changed, attribute, kept)


def _places(tree: ast.AST) -> Iterator[Place]:
    for node in ast.walk(tree):
        match node:
            case ast.BinOp(op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div()) | ast.BoolOp():
                if not _is_text(node):
                    yield node, node, "op", OTHER[type(node.op)]()
                yield from _numbers(node)
            case ast.BinOp(op=ast.Pow()):
                yield from _numbers(node)
            case ast.Compare(ops=[op]) if type(op) in OTHER:
                yield node, node, "ops", [OTHER[type(op)]()]
                yield from _numbers(node)
            case ast.UnaryOp(op=ast.USub()):
                yield node, node, "op", ast.UAdd()
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                yield node, node, "operand", ast.UnaryOp(ast.Not(), operand)
            case ast.Call(args=[ast.Name() as one, ast.Name() as other, *rest]):
                if one.id != other.id:
                    yield node, node, "args", [other, one, *rest]


def _numbers(node: ast.AST) -> Iterator[Place]:
    for side in ast.iter_child_nodes(node):
        if isinstance(side, ast.Constant) and type(side.value) is int:
            yield node, side, "value", side.value + 1


def _is_text(node: ast.AST) -> bool:
    return any(
        isinstance(part, ast.JoinedStr | ast.List | ast.Tuple | ast.Dict)
        or (isinstance(part, ast.Constant) and isinstance(part.value, str))
        for part in ast.walk(node)
    )


def chosen(group: str, count: int, only: str) -> list[Mutant]:
    """So many of all, in an order that is the same everywhere and has nothing to do with place."""
    files = {path for folder in GROUPS[group][0] for path in (ROOT / folder).rglob("*.py")}
    every = [m for path in sorted(files) for m in mutants_of(path) if only in str(m)]
    return sorted(every, key=lambda m: sha256(str(m).encode()).digest())[:count]


# ------------------------------------------------------------------ tests


class Sandbox:
    """A copy of the program, its tests and compiled kernels, in which one file changes."""

    def __init__(self, home: Path) -> None:
        self.home, self.limit = home, 3600.0
        for name in COPIED:
            source, target = ROOT / name, home / name
            (shutil.copytree if source.is_dir() else shutil.copy2)(source, target)

    def caught(self, mutant: Mutant, group: str) -> str:
        """The first test that fails; nothing if the mutant survives."""
        path = self.home / mutant.path
        kept = path.read_text(encoding="utf-8")
        path.write_text(mutant.text, encoding="utf-8")
        try:
            return next(filter(None, map(self.failed, mutant.tests(group))), "")
        finally:
            path.write_text(kept, encoding="utf-8")

    def failed(self, tests: tuple[str, ...]) -> str:
        """The first of these tests that fails, or that they run on for too long."""
        if all(test.startswith("--") for test in tests):
            return ""
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider"]
        settings = os.environ | {"PYTHONPATH": str(self.home), "OMP_NUM_THREADS": "1"}
        try:
            done = subprocess.run(
                [*command, "-k", OF_TEXT, *tests],
                cwd=self.home,
                env=settings,
                capture_output=True,
                text=True,
                timeout=self.limit,
            )
        except subprocess.TimeoutExpired:
            return "time"
        failed = re.findall(r"^(?:FAILED|ERROR) (\S+)", done.stdout, re.M)
        return failed[0] if failed else "no test runs" if done.returncode not in (0, 5) else ""


def tried(group: str, count: int, jobs: int, only: str) -> tuple[int, int]:
    """How many mutants of a group survive, of how many."""
    mutants = chosen(group, count, only)
    survivors = 0
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(jobs) as pool:
        idle: Queue[Sandbox] = Queue()
        for number in range(jobs):
            idle.put(Sandbox(Path(folder) / str(number)))

        def caught(mutant: Mutant) -> str:
            sandbox = idle.get()
            sandbox.limit = limit
            try:
                return sandbox.caught(mutant, group)
            finally:
                idle.put(sandbox)

        began = perf_counter()
        if by := idle.queue[0].failed(GROUPS[group][1]):
            sys.exit(f"no fault is needed: {by} fails as it is")
        limit = 60 + PATIENCE * (perf_counter() - began)
        for mutant, by in zip(mutants, pool.map(caught, mutants), strict=True):
            survivors += not by
            print(f"{by or 'SURVIVES'}  {mutant}", flush=True)
    print(f"{group}: {len(mutants) - survivors} of {len(mutants)} mutants caught", flush=True)
    return survivors, len(mutants)


def main() -> int:
    """Try the mutants, and tell what survives."""
    parser = ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("group", choices=[*GROUPS, "all"])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="part of a file, a line or an expression")
    given = parser.parse_args()
    groups = GROUPS if given.group == "all" else [given.group]
    results = [tried(group, given.count, given.jobs, given.only) for group in groups]
    return int(any(lost > 0.03 * total for lost, total in results))


if __name__ == "__main__":
    sys.exit(main())
