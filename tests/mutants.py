"""Faults put into the theory and the rewriting rules, one at a time: which of them no test catches.

    python -m tests.mutants [--count 100] [--jobs 2] [--only TEXT]

A mutant changes one sign, factor or exponent of one file.  It is caught if a test of the theory
fails, if a body can no longer be built, if a generated module is no longer what is committed, or if
a test of `make thorough` fails.  Each is printed with what caught it, and the exit status is 1 if
more than one in a hundred survives.
"""

import ast
import os
import shutil
import subprocess
import sys
import tempfile
from argparse import ArgumentParser
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parent.parent
FILES = [
    *sorted((ROOT / "derive/theory").glob("*.py")),
    *(ROOT / "derive" / "codegen" / name for name in ("angles.py", "rewrite.py")),
]
BODIES = ("wedge", "hertz", "unequal_wedge", "quartic", "flat_rounded", "rounded_wedge", "catenary")
"""Built of every mutant, and compared with what is committed."""

TESTS = (
    *("derive/theory", "derive/codegen/rewrite.py"),  # their examples
    *("tests/derive/theory", "tests/derive/test_closed_forms.py", "tests/edge/test_theory.py"),
    *("tests/codegen/test_rewrite.py", "tests/codegen/test_parts.py"),
)
LONGEST = 600
"""Seconds after which a mutant that runs on is caught."""

BUILD = """
import sys
from pathlib import Path
from derive.pipeline import build
for name in sys.argv[1:]:
    made = build(name)
    if made.text != (Path("generated") / f"{name}.py").read_text(encoding="utf-8"):
        sys.exit(f"{name}.py differs")
    if made.stuck != Path("generated/full_stick.py").read_text(encoding="utf-8"):
        sys.exit("full_stick.py differs")
"""


class Mutant(NamedTuple):
    """One fault: the file, the line, what stood there, what stands there now, the whole text."""

    path: Path
    line: int
    before: str
    after: str
    text: str

    def __str__(self) -> str:
        place = f"{self.path.relative_to(ROOT)}:{self.line}"
        return f"{place}: {self.before}  ->  {self.after}"


def mutants_of(path: Path) -> Iterator[Mutant]:
    """Every fault of one file: + for -, * for /, a sign dropped, a whole number one larger."""
    source = path.read_text(encoding="utf-8")
    for number, (node, _) in enumerate(_places(ast.parse(source))):
        tree = ast.parse(source)
        place, change = [*_places(tree)][number]
        before = ast.unparse(place)
        change()
        after = ast.unparse(place)
        yield Mutant(path, node.lineno, before, after, ast.unparse(tree))


def _places(tree: ast.AST) -> Iterator[tuple[ast.expr, object]]:
    """Arithmetic that can be changed, and what changes it."""
    for node in ast.walk(tree):
        match node:
            case ast.BinOp(op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div()):
                if not _is_text(node):
                    yield node, lambda node=node: setattr(node, "op", _OTHER[type(node.op)]())
                yield from _numbers(node)
            case ast.BinOp(op=ast.Pow()):
                yield from _numbers(node)
            case ast.UnaryOp(op=ast.USub()):
                yield node, lambda node=node: setattr(node, "op", ast.UAdd())


def _numbers(node: ast.BinOp) -> Iterator[tuple[ast.expr, object]]:
    for side in (node.left, node.right):
        if isinstance(side, ast.Constant) and type(side.value) is int:
            yield node, lambda side=side: setattr(side, "value", side.value + 1)


def _is_text(node: ast.BinOp) -> bool:
    return any(
        isinstance(part, ast.JoinedStr | ast.List | ast.Tuple | ast.Dict)
        or (isinstance(part, ast.Constant) and isinstance(part.value, str))
        for part in ast.walk(node)
    )


_OTHER = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}


def chosen(count: int, only: str) -> list[Mutant]:
    """So many of all, in an order that is the same everywhere and has nothing to do with place."""
    every = [m for path in FILES for m in mutants_of(path) if only in str(m)]
    return sorted(every, key=lambda m: sha256(str(m).encode()).digest())[:count]


def caught(mutant: Mutant) -> str:
    """What catches a mutant; nothing if it survives."""
    plain = os.environ | {"NUMBA_DISABLE_JIT": "1"}  # to compile takes longer than to run once
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder)
        for name in ("derive", "generated", "tests", "pyproject.toml"):
            source = ROOT / name
            if source.is_dir():
                shutil.copytree(source, home / name)
            else:
                shutil.copy(source, home)
        (home / mutant.path.relative_to(ROOT)).write_text(mutant.text, encoding="utf-8")
        tests = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *TESTS]
        steps = {
            "tests": tests,
            "build": [sys.executable, "-c", BUILD, *BODIES],
            "thorough": [*tests, "-m", "thorough"],
        }
        for name, command in steps.items():
            try:
                done = subprocess.run(
                    command, cwd=home, env=plain, capture_output=True, timeout=LONGEST, check=False
                )
            except subprocess.TimeoutExpired:
                return f"{name}: time"
            if done.returncode:
                return name
    return ""


def main() -> int:
    """Try the mutants, and tell what survives."""
    parser = ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="part of a file, a line or an expression")
    given = parser.parse_args()
    mutants = chosen(given.count, given.only)
    same = mutants[0]._replace(text=mutants[0].path.read_text(encoding="utf-8"))
    if by := caught(same):
        sys.exit(f"no fault is needed: {by} fails as it is; run `make` and `make test` first")
    survivors = 0
    with ThreadPoolExecutor(given.jobs) as pool:
        for mutant, by in zip(mutants, pool.map(caught, mutants), strict=True):
            survivors += not by
            print(f"{by or 'SURVIVES':12} {mutant}", flush=True)
    print(f"{len(mutants) - survivors} of {len(mutants)} mutants caught")
    return int(survivors > len(mutants) / 100)


if __name__ == "__main__":
    sys.exit(main())
