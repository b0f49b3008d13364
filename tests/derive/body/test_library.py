"""Geometry files: found, executed once, leaving nothing behind; what is wrong with a bad one."""

import os
import signal
import sys
from pathlib import Path
from typing import Any

import pytest

from derive.body.library import load_geometry
from derive.command.processes import end
from tests.commands import CYLINDER


def written(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


def test_a_file_is_executed_once_and_leaves_nothing_behind(tmp_path: Path) -> None:
    diary = tmp_path / "diary.txt"
    path = written(
        tmp_path / "body.py",
        CYLINDER + f"with open({str(diary)!r}, 'a') as file:\n    file.write('x')\n",
    )
    load_geometry("hertz")  # the first body of all loads NumPy
    before, writes = set(sys.modules), sys.dont_write_bytecode
    load_geometry(path)
    assert diary.read_text() == "x"
    assert {p.name for p in tmp_path.iterdir()} == {"body.py", "diary.txt"}
    assert set(sys.modules) == before
    assert sys.dont_write_bytecode == writes


PRESSES = "import os, signal\nos.kill(os.getpid(), signal.{})\nwhile True:\n    pass\n"


@pytest.mark.skipif(os.name == "nt", reason="no signal can be sent to a process of one's own")
@pytest.mark.parametrize(
    ("name", "handler", "error"),
    [("SIGINT", signal.default_int_handler, KeyboardInterrupt), ("SIGTERM", end, SystemExit)],
)
def test_a_signal_while_a_file_is_loaded_is_no_mistake_in_the_file(
    name: str, handler: Any, error: type[BaseException], tmp_path: Path
) -> None:
    number = signal.Signals[name]
    before = signal.signal(number, handler)
    try:
        with pytest.raises(error):
            load_geometry(written(tmp_path / "presses.py", PRESSES.format(name)))
    finally:
        signal.signal(number, before)
