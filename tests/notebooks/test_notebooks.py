"""A fresh run of every notebook puts out what is committed, and nothing of a machine."""

import re
import subprocess
import sys
from pathlib import Path

import matplotlib
import nbformat
import pytest

from generated.runtime.kernels import COMPILING
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


def notebook_of(*outputs: dict[str, object]) -> nbformat.NotebookNode:
    cell = nbformat.v4.new_code_cell("1", outputs=[nbformat.from_dict(o) for o in outputs])
    return nbformat.v4.new_notebook(cells=[cell])


def stream(text: str, name: str = "stdout") -> dict[str, object]:
    return {"output_type": "stream", "name": name, "text": text}


def test_warnings_errors_and_paths_are_faults() -> None:
    error = {"output_type": "error", "ename": "ValueError", "evalue": "no", "traceback": []}
    there = "/".join(("", "home", "someone", "file"))
    found = running.faults(notebook_of(stream("w", "stderr"), error, stream(f"in {there}")))
    assert [fault.split(":")[0] for fault in found] == ["a path", "a warning", "an error"]
    assert running.faults(notebook_of(stream("N/m and Pa/sqrt(m)"))) == []


def test_a_line_about_compilation_is_not_kept() -> None:
    """It comes at the first call in a fresh clone only."""
    notebook = notebook_of(stream(f"{COMPILING}\n", "stderr"), stream("2\n"))
    (cell,) = running.clean(notebook).cells
    assert [output.text for output in cell.outputs] == ["2\n"]


@pytest.mark.slow
def test_a_run_that_differs_is_told(tmp_path: Path) -> None:
    notebook = notebook_of(stream("2\n"))
    notebook.cells[0].source = "print(1 + 2)"
    path = tmp_path / "one.ipynb"
    running.write(running.clean(notebook), path)
    code = (
        "import sys; from pathlib import Path; from notebooks.running import differences; "
        "print(*differences(Path(sys.argv[1])), sep='\\n')"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(path)], cwd=running.ROOT, capture_output=True, text=True
    )
    assert "-stdout: 2" in done.stdout and "+stdout: 3" in done.stdout, done.stderr


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
