"""Property tests draw the same examples on every machine."""

import gc
import os
import subprocess
import sys
from fnmatch import fnmatchcase
from pathlib import Path

import pytest
from hypothesis import settings

import derive.command.terminal
import derive.proof.verdict

settings.register_profile("ci", derandomize=True, deadline=None)
settings.load_profile("ci")

if "PYTHONPATH" in os.environ:
    # A relative one would lead processes to the directories of the tests that start them.
    _FOLDERS = os.environ["PYTHONPATH"].split(os.pathsep)
    os.environ["PYTHONPATH"] = os.pathsep.join(str(Path(folder).resolve()) for folder in _FOLDERS)

derive.proof.verdict.POINTS = 8
"""Points of a proof in the tests; `derive` takes 24, which makes proofs three times as long.

A difference of analytic functions is none at nearly every point or nowhere; set before any other
module has read it."""

# SymPy makes millions of small objects that stay: the collector need not look at them so often.
gc.set_threshold(100_000, 50, 50)

LONGEST = ("test_the_committed_package_is_as_generated", "test_a_fresh_run_gives_what_is_committed")
SHARED = {"installed"}

SLOW_EXAMPLES = {"derive.proof.prove.prove_sheet"}
"""Examples in docstrings cannot be marked where they stand."""


os.environ.pop("COLUMNS", None)  # tables in a pipe are as wide as they need to be


def pytest_configure(config: pytest.Config) -> None:
    """Compile the solvers of a fresh clone once, before several processes each would."""
    if config.getoption("numprocesses", None):
        order = "import doctest; from generated import wedge; doctest.testmod(wedge)"
        subprocess.run([sys.executable, "-c", order], check=False)  # the tests say what fails


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """The longest tests first, then the slow ones; short ones fill up both workers at the end.

    Behind the longest, and so by one worker, those that share what takes long to make.
    """
    for item in items:
        if item.name in SLOW_EXAMPLES:
            item.add_marker("slow")
        if _is_one_more(item):
            item.add_marker("thorough")
    items.sort(
        key=lambda item: (
            not item.name.startswith(LONGEST),
            SHARED.isdisjoint(getattr(item, "fixturenames", ())),
            item.get_closest_marker("slow") is None,
        )
    )


def _is_one_more(item: pytest.Item) -> bool:
    """Whether it is a case beyond those that are enough for `make test`."""
    enough = item.get_closest_marker("enough")
    return enough is not None and not any(fnmatchcase(_case(item), name) for name in enough.args)


def _case(item: pytest.Item) -> str:
    """What stands in the brackets of a test; nothing for one without."""
    case = getattr(item, "callspec", None)
    return case.id if case else ""


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """No line about work that takes long, however slow the machine is."""
    monkeypatch.setattr(derive.command.terminal, "PATIENCE", 600.0)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty current directory."""
    monkeypatch.chdir(tmp_path)
    return tmp_path
