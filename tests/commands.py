"""The commands as the tests call them, in this process or in an interpreter of its own."""

import os
import subprocess
import sys
from pathlib import Path

from click.testing import CliRunner, Result

from derive.command.cli import main

ROOT = Path(__file__).parents[1]
MODULE = (sys.executable, "-m", "derive")

CYLINDER = '''"""A cylinder of one's own."""
from derive import Geometry, parameter, x

radius = parameter("radius", "radius", unit="m")
geometry = Geometry("cylinder", g=x**2 / (2 * radius))
'''
"""A geometry file."""


def run(*arguments: object) -> Result:
    return CliRunner().invoke(main, [*map(str, arguments)])


def done(*arguments: str) -> str:
    """What a command prints that succeeds."""
    result = run(*arguments)
    assert result.exit_code == 0, result.output
    return result.stdout


def lines(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.strip()]


def refused(*arguments: str) -> str:
    """The one line about bad input; a misused command is answered with its usage, too."""
    result = run(*arguments)
    assert isinstance(result.exception, SystemExit), result.exception
    assert result.exit_code == 2, result.output
    assert (result.stdout, result.stderr.count("Error: ")) == ("", 1), result.output
    told = lines(result.stderr)
    assert len(told) == 1 or told[0].startswith("Usage: ")
    return told[-1]


def real(*command: str, cwd: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    """In an interpreter of its own."""
    environment = os.environ | {"PYTHONPATH": str(ROOT)} | variables
    return subprocess.run(
        command, cwd=cwd, env=environment, capture_output=True, text=True, timeout=600
    )


def python(*arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """An interpreter of its own with these arguments, or with one text to run."""
    command = ("-c", *arguments) if len(arguments) == 1 else arguments
    return real(sys.executable, *command, cwd=ROOT, **variables)


def contents(folder: Path) -> dict[str, bytes]:
    files = (p for p in folder.rglob("*") if p.is_file() and "__pycache__" not in p.parts)
    return {str(p.relative_to(folder)): p.read_bytes() for p in files}
