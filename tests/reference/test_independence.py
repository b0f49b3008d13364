"""The reference solver imports nothing from the package that it checks."""

import ast
import sys
from pathlib import Path

ALLOWED = {"numpy", "scipy", "pytest", "rich", "click", "tests", *sys.stdlib_module_names}


def imported(path: Path) -> set[str]:
    """The imported packages and modules."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            found.add(node.module or "")
    return found


def test_neither_derive_nor_generated_is_imported() -> None:
    files = sorted(Path(__file__).parent.glob("*.py"))
    assert len(files) > 10
    for path in files:
        names = imported(path)
        assert {name.partition(".")[0] for name in names} <= ALLOWED, path.name
        inner = {name for name in names if name.startswith("tests")}
        assert all(name.startswith("tests.reference") for name in inner), path.name
