"""A fresh run of every notebook puts out what is committed, and nothing of a machine."""

import re
import subprocess
import sys
from pathlib import Path

import matplotlib
import nbformat
import pytest

from notebooks import picture, running

matplotlib.use("Agg")

EACH = pytest.mark.parametrize("path", running.notebooks(), ids=lambda path: path.stem)


@pytest.mark.enough("01*")  # of what the others show, tests ask more
@pytest.mark.slow
@EACH
def test_a_fresh_run_gives_what_is_committed(path: Path) -> None:
    """In a process of its own, so that no library of Jupyter's warns in this one."""
    command = [sys.executable, "-m", "notebooks", "--check", path.name]
    done = subprocess.run(command, cwd=running.ROOT, capture_output=True, text=True)
    assert done.returncode == 0, f"python -m notebooks {path.stem}\n{done.stdout}{done.stderr}"


@EACH
def test_what_is_committed_has_been_run_and_is_clean(path: Path) -> None:
    """Nothing that a second run would change; and the file is one that Jupyter accepts."""
    text = path.read_text(encoding="utf-8")
    notebook = nbformat.reads(text, as_version=4)
    nbformat.validate(notebook)
    assert nbformat.writes(running.clean(notebook)) + "\n" == text
    assert "widget-state" not in text
    assert "widget-view" not in text
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
    assert running.texts(notebook)
    assert running.faults(notebook) == []


@EACH
def test_no_result_is_typed(path: Path) -> None:
    """Per cents, and decimals of three digits or more, come from the code."""
    for cell in running.read(path).cells:
        if cell.cell_type == "markdown":
            assert not re.search(r"\d ?\\?%|\d\.\d{3}", cell.source), cell.source


# ------------------------------------------------------------------ what runs them


def test_the_readme_s_picture_is_that_of_its_code(tmp_path: Path) -> None:
    """Its text, and its curves to a twentieth of a point."""
    picture.main(tmp_path / "pressure.svg")
    drawn, kept = (
        (folder / "pressure.svg").read_text(encoding="utf-8")
        for folder in (tmp_path, running.FOLDER)
    )
    number = re.compile(r"-?\d+\.\d+")
    assert number.sub("", drawn) == number.sub("", kept)
    there = [float(value) for value in number.findall(kept)]
    assert [float(value) for value in number.findall(drawn)] == pytest.approx(there, abs=0.05)
