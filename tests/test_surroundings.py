"""Hostile surroundings: one clear line each, the right exit status, and nothing is lost."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="devices and rights of Unix"),
]


def derive(
    folder: Path, command: str, before: str = "", **variables: str
) -> "subprocess.CompletedProcess[str]":
    """A command of the shell in a folder; `$derive` is the program."""
    settings = os.environ | {"PYTHONPATH": str(ROOT), **variables}
    settings["derive"] = f"{sys.executable} -m derive"
    return subprocess.run(
        ["sh", "-c", f"{before} $derive {command}"],
        cwd=folder,
        env=settings,
        capture_output=True,
        text=True,
        timeout=60,
    )


def demand_one_line(done: "subprocess.CompletedProcess[str]", part: str) -> None:
    assert done.returncode == 2, done.stderr
    assert len(done.stderr.splitlines()) == 1, done.stderr
    assert done.stderr.startswith("Error: ")
    assert part in done.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no full device")
@pytest.mark.parametrize(
    "command", ["show hertz", "show hertz --latex", "--help", "--version", "show --help"]
)
def test_a_full_output(tmp_path: Path, command: str) -> None:
    part = "standard output cannot be written: No space left"
    demand_one_line(derive(tmp_path, f"{command} > /dev/full"), part)


def test_a_closed_output(tmp_path: Path) -> None:
    demand_one_line(derive(tmp_path, "show hertz >&-"), "output is closed")


@pytest.mark.parametrize("errors", ["2>&-", "2>/dev/full"])
@pytest.mark.parametrize("command", ["new nn 'x**2/(2*R)'", "show hertz"])
def test_a_closed_or_full_standard_error_changes_nothing(
    tmp_path: Path, command: str, errors: str
) -> None:
    plain, done = (
        derive(tmp_path, f"{command}{end}", "rm -f nn.py;") for end in ("", f" {errors}")
    )
    assert (plain.returncode, done.returncode) == (0, 0)
    assert done.stdout == plain.stdout


@pytest.mark.parametrize(
    ("table", "part"),
    [
        ("x [m], p [Pa]\n" + "1" * 10**6 + ", 2\n", "characters; at most 20000"),
        (", ".join(f"c{i}" for i in range(10**5)) + "\n1, 2\n", "characters; at most 20000"),
        ("x [m], p [Pa]\n" + "".join(f"{i}, 1\n" for i in range(30_000)), "30000 nodes"),
    ],
    ids=["a long cell", "a long header", "many nodes"],
)
def test_a_table_without_measure(tmp_path: Path, table: str, part: str) -> None:
    (tmp_path / "table.csv").write_text(table)
    demand_one_line(derive(tmp_path, "edge table.csv --f 0.5"), part)


def test_a_body_of_claims_that_runs_away(tmp_path: Path) -> None:
    """Its abort ends another process."""
    (tmp_path / "claims.toml").write_text(
        "body = { g = 'exp(exp(exp(exp(x/R))))*R' }\n[[claims]]\nlabel = 'it'\n"
        "printed = 'load(a, a) = 1'\n"
    )
    demand_one_line(
        derive(tmp_path, "check claims.toml"), "body: g(x): the stage 'reading' crashed"
    )


def test_many_parameters(tmp_path: Path) -> None:
    terms = "+".join(f"x**2/R{i}" for i in range(150))
    done = derive(tmp_path, f"new many '{terms}'")
    demand_one_line(done, "has 150 parameters, and at most 40 are allowed")


@pytest.mark.parametrize("command", ["show hertz", "--help", "show --help"])
def test_a_reader_that_has_seen_enough(tmp_path: Path, command: str) -> None:
    """The status is the one of a program that SIGPIPE ends: 128 + 13."""
    done = derive(tmp_path, f"{command}; echo $? >&2; }} | true", "{")
    told = [line for line in done.stderr.splitlines() if not line.startswith("Still working")]
    assert told == ["141"]


@pytest.mark.parametrize(
    "command", ["new body 'x**2/R'", "generate hertz --out made", "check claims.toml"]
)
def test_a_directory_that_is_gone(tmp_path: Path, command: str) -> None:
    done = derive(tmp_path, command, "mkdir gone && cd gone && rmdir ../gone;")
    demand_one_line(done, "the working directory no longer exists")


@pytest.mark.parametrize(
    "command",
    [
        *("check {}", "check {} --draft claims.toml", "edge {} --f 0.5"),
        *("show {}", "generate {} --out made"),
    ],
)
def test_a_device_without_end(tmp_path: Path, command: str) -> None:
    done = derive(tmp_path, command.format("/dev/zero"))
    demand_one_line(done, "a device or a pipe, not a regular file")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not os.access("/proc/kmsg", os.R_OK), reason="only root may read this log")
@pytest.mark.parametrize("command", ["check {}", "edge {} --f 0.5"])
def test_a_log_whose_reading_would_wait(tmp_path: Path, command: str) -> None:
    done = derive(tmp_path, command.format("/proc/kmsg"))
    assert done.returncode == 2 and done.stderr.count("\n") == 1


def test_a_key_of_5000_parts(tmp_path: Path) -> None:
    (tmp_path / "claims.toml").write_text(f"{'.'.join('a' * 5000)} = 1\n")
    done = derive(tmp_path, "check claims.toml")
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "the key 'a' is unknown" in done.stderr


def test_a_cache_that_others_may_write_to(tmp_path: Path) -> None:
    (tmp_path / "open").mkdir()
    (tmp_path / "open").chmod(0o777)
    done = derive(tmp_path, "generate hertz --out made", DERIVE_CACHE="open")
    assert done.returncode == 0
    assert "nothing is kept there, because other users can write to it" in done.stderr
    assert list((tmp_path / "open").iterdir()) == []
    assert "run `export DERIVE_CACHE=~/derive-cache` to use a directory of your own" in done.stderr
    done = derive(tmp_path, "generate hertz --out made", DERIVE_CACHE="own")
    assert "nothing is kept" not in done.stderr
    assert len(list((tmp_path / "own").iterdir())) == 1
    done = derive(tmp_path, "generate hertz --out made", DERIVE_CACHE="/dev/full")
    assert "because it is not a directory" in done.stderr
