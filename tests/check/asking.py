"""What the tests of the checker ask for: the command, a file of claims, a finding."""

import json
from pathlib import Path
from typing import Any

from click.testing import CliRunner, Result

from derive.check.userfile import read_claims
from derive.check.verdict import Finding, check
from derive.command.cli import main


def run(*arguments: object, answers: str = "") -> Result:
    """`derive check` with these arguments."""
    given = ["check", *map(str, arguments)]
    return CliRunner().invoke(main, given, input=answers, catch_exceptions=False)


def written(folder: Path, text: str, name: str = "claims.toml") -> Path:
    """A file in a folder."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def told(folder: Path, text: str) -> list[dict[str, Any]]:
    """What the command says of each claim of a file."""
    done = run(written(folder, text), "--format", "json")
    assert done.exit_code in (0, 1), done.output
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


def claim(printed: str, more: str = "") -> str:
    """A claim by its equation, and by further lines of its entry."""
    return f'[[claims]]\nlabel = "it"\nprinted = {json.dumps(printed)}\n{more}\n'


def judged(folder: Path, text: str) -> Finding:
    """The finding of the first claim of a file."""
    return check(read_claims(written(folder, text)).claims[0])
