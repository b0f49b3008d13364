"""Hostile surroundings: one clear line each, the right exit status, and nothing is lost."""

import sys
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tests.commands import MODULE, real, refused, run

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="devices and rights of Unix"),
]


TABLE, LINES = "check one.toml", "new nn 'x**2/(2*R)'"
"""Commands by what they print; the second one starts another process."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a claims file."""
    (tmp_path / "one.toml").write_text('[[claims]]\nlabel = "(1)"\nprinted = "2 = 1 + 1"\n')
    return tmp_path


def derive(folder: Path, command: str, before: str = "") -> CompletedProcess[str]:
    """A command of the shell in a folder; `$derive` is the program."""
    return real("sh", "-c", f"{before} $derive {command}", cwd=folder, derive=" ".join(MODULE))


def demand_one_line(done: CompletedProcess[str], part: str) -> None:
    told = [line for line in done.stderr.splitlines() if not line.startswith("Still working")]
    assert (done.returncode, len(told)) == (2, 1), done.stderr
    assert told[0].startswith("Error: ") and part in told[0]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no full device")
@pytest.mark.parametrize("command", [LINES, "--help"])
def test_a_full_output(folder: Path, command: str) -> None:
    part = "standard output cannot be written: No space left"
    demand_one_line(derive(folder, f"{command} > /dev/full"), part)


def test_a_closed_output(tmp_path: Path) -> None:
    demand_one_line(derive(tmp_path, "--help >&-"), "output is closed")


def test_a_closed_standard_error_changes_nothing(folder: Path) -> None:
    done = derive(folder, f"{LINES} --out {folder} 2>&-")
    assert done.returncode == 0 and "show " in done.stdout


@pytest.mark.parametrize("command", [TABLE, "--help"])
def test_a_reader_that_has_seen_enough(folder: Path, command: str) -> None:
    """The status is the one of a program that SIGPIPE ends: 128 + 13."""
    done = derive(folder, f"{command}; echo $? >&2; }} | true", "{")
    told = [line for line in done.stderr.splitlines() if not line.startswith("Still working")]
    assert told == ["141"]


@pytest.mark.parametrize(
    "command", ["new body x**2/R", "generate hertz --out made", "check claims.toml"]
)
def test_a_directory_that_is_gone(here: Path, command: str) -> None:
    here.rmdir()
    assert "the working directory no longer exists" in refused(*command.split())


@pytest.mark.parametrize(
    "command",
    ["check {} --draft claims.toml", "edge {} --f 0.5", "generate {} --out made"],
)
def test_a_device_without_end(here: Path, command: str) -> None:
    done = run(*command.format("/dev/zero").split())
    assert done.exit_code == 2 and len(done.stderr.splitlines()) == 1
    assert "a device or a pipe, not a regular file" in done.stderr
    assert list(here.iterdir()) == []


def test_a_package_of_another_version_in_the_current_folder(tmp_path: Path) -> None:
    runtime = tmp_path / "generated" / "runtime"
    runtime.mkdir(parents=True)
    (runtime.parent / "__init__.py").touch()
    (runtime / "__init__.py").write_text("VERSION = 0\n")
    (tmp_path / "table.csv").write_text("x [mm],p [MPa]\n0,1\n")
    done = derive(tmp_path, "edge table.csv --f 0.5")
    demand_one_line(done, f"{runtime.parent} is of another version than `derive`")
