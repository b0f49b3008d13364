"""Results in the order of the items; one failure ends all, and is told as in one process."""

import os
import subprocess
import sys
import time
from multiprocessing import active_children
from pathlib import Path

import psutil
import pytest

from derive.command.errors import NotProven, RanAway
from derive.command.processes import Bounds, Report, in_processes
from tests.tasks import ERRORS, fails, late, meeting, process

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]


def silent(what: str, stage: str) -> None:
    """Tells nobody."""


def test_results_come_in_the_order_of_the_items() -> None:
    items = [(1, 0.5), (2, 0.0), (3, 0.2), (4, 0.0)]
    assert in_processes(late, items, silent, 3) == [1, 2, 3, 4]


def test_the_work_is_done_by_as_many_processes_as_asked_for(tmp_path: Path) -> None:
    found = in_processes(meeting, [(str(tmp_path), 2)] * 6, silent, 2)
    assert len(set(found)) == 2
    assert os.getpid() not in found
    assert active_children() == []


@pytest.mark.parametrize(("items", "jobs"), [((1,), 4), ((1, 2), 1), ((), 4)])
def test_where_one_process_is_enough_it_is_this_one(items: tuple[int, ...], jobs: int) -> None:
    assert set(in_processes(process, items, silent, jobs)) <= {os.getpid()}


def test_a_file_of_the_user_s_hides_no_module_of_python_s(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A geometry file may be called so; a process starts in the directory that holds it."""
    for name in ("threading.py", "signal.py", "keyword.py"):
        (tmp_path / name).write_text("raise RuntimeError('hidden')\n")
    monkeypatch.chdir(tmp_path)
    assert in_processes(late, [(1, 0.0), (2, 0.0)], silent, 2) == [1, 2]
    assert "PYTHONSAFEPATH" not in os.environ


# ------------------------------------------------------------------ failures


@pytest.mark.parametrize("name", ["user", "object", "proof", "print", "fault"])
def test_what_is_raised_in_a_process_is_raised_here(name: str) -> None:
    """A fault of the program tells where it was."""
    here = ERRORS[name]()
    with pytest.raises(type(here)) as caught:
        in_processes(fails, [name, "done"], silent, 2)
    assert type(caught.value) is type(here)
    if name != "object":  # its repr is an address
        assert str(caught.value) == str(here)
    if name == "fault":
        assert "in fails" in "".join(caught.value.__notes__)


def test_an_error_that_cannot_travel_is_told_by_its_text() -> None:
    with pytest.raises(RuntimeError, match="Strange: 1 and 2"):
        in_processes(fails, ["strange", "done"], silent, 2)


def interrupt(what: str, stage: str) -> None:
    """As Ctrl-C, which is raised wherever the first process is."""
    raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("name", "report", "error", "told"),
    [
        ("proof", silent, NotProven, "tilt of 'body'"),
        ("exit", silent, RanAway, r"exit: the stage 'begun' crashed, .* --jobs 1"),
        ("wait", interrupt, KeyboardInterrupt, None),
    ],
)
def test_a_failure_does_not_wait_for_the_others(
    name: str, report: Report, error: type[BaseException], told: str | None
) -> None:
    began = time.monotonic()
    with pytest.raises(error, match=told):
        in_processes(fails, ["wait", name, "wait", "wait"], report, 2)
    assert time.monotonic() - began < 60  # far less than one of them waits
    assert active_children() == []


# ------------------------------------------------------------------ limits


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("wait", "the stage 'begun' took longer than the limit of 1 s: "),
        ("memory", "the stage 'begun' needed more memory than the limit of 1 GB: "),
    ],
)
def test_what_stopped_a_process_is_told(name: str, told: str) -> None:
    """One limit of its own, or none: never both limits."""
    with pytest.raises(RanAway) as caught:
        in_processes(fails, [name], silent, 1, Bounds(60, 1, {"begun": 1}))
    assert told in str(caught.value)
    assert "kinks" not in str(caught.value)


ORPHANS = """
import os, sys
from derive.command.processes import in_processes
from tests.tasks import fails

def tell(what, stage):
    print(what, flush=True)

in_processes(fails, ["wait", "wait"], tell, 2)
"""


def test_no_process_or_file_outlives_one_that_was_killed(tmp_path: Path) -> None:
    killed = subprocess.Popen(
        [sys.executable, "-c", ORPHANS],
        cwd=ROOT,
        env=os.environ | {"TMPDIR": str(tmp_path)},
        stdout=subprocess.PIPE,
        text=True,
    )
    assert killed.stdout is not None
    assert [killed.stdout.readline() for _ in range(2)] == ["wait\n", "wait\n"]
    children = psutil.Process(killed.pid).children()
    assert len(children) >= 2
    killed.kill()
    killed.communicate()
    _, alive = psutil.wait_procs(children, timeout=30)
    assert not alive
    assert [*tmp_path.iterdir()] == []
