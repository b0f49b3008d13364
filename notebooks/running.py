"""Run the notebooks, and keep those outputs that are the same on every machine."""

import os
import re
import sys
from argparse import ArgumentParser
from collections.abc import Iterator, Mapping
from difflib import unified_diff
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import nbformat
from nbclient import NotebookClient
from nbformat import NotebookNode

from derive.command.files import write_whole
from generated.runtime.kernels import COMPILING

FOLDER = Path(__file__).parent
ROOT = FOLDER.parent

TIMEOUT = 600
"""Longest time of one cell in seconds."""

_METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}
_INLINE = "ignore:InlineBackend._figure_formats_changed:DeprecationWarning"
"""A warning of matplotlib-inline that is caused by the option for the format of pictures."""

_WIDGET = "application/vnd.jupyter.widget-view+json"


def notebooks() -> list[Path]:
    """All notebooks, sorted by name."""
    return sorted(FOLDER.glob("*.ipynb"))


def read(path: Path) -> NotebookNode:
    """A notebook as stored on disk."""
    return nbformat.read(path, as_version=4)


def run(path: Path) -> NotebookNode:
    """A notebook all of whose cells have been run again, in order, in its own folder.

    Its pictures have 200 dots per inch and contain the size at which they are shown.

    Raises nbclient.exceptions.CellExecutionError if a cell raises an exception.
    """
    notebook = read(path)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    import_module("matplotlib.font_manager")  # its first import lists fonts, with a long message
    client = NotebookClient(notebook, timeout=TIMEOUT, kernel_name="python3")
    client.extra_arguments = ["--log-level=ERROR", "--InlineBackend.figure_formats=retina"]
    client.resources = {"metadata": {"path": str(path.parent)}}
    with TemporaryDirectory() as folder:
        client.execute(env=_environment(folder))
    return clean(notebook)


def _environment(folder: str) -> dict[str, str]:
    """The environment without the user's settings; this checkout precedes installed packages."""
    own = {"IPYTHONDIR": folder, "PYTHONPATH": str(ROOT), "PYTHONHASHSEED": "0"}
    threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    dropped = ("MPLBACKEND", "MATPLOTLIBRC", "PYTHONWARNINGS")
    kept = {name: value for name, value in os.environ.items() if name not in dropped}
    return {**kept, **own, **threads, "PYTHONWARNINGS": f"default,{_INLINE}"}


def clean(notebook: NotebookNode) -> NotebookNode:
    """Remove what differs between runs: times, numbers of widgets, the version of the kernel."""
    notebook.metadata = nbformat.from_dict(_METADATA)
    notebook.nbformat, notebook.nbformat_minor = 4, 5
    for number, cell in enumerate(notebook.cells, start=1):
        cell.id = f"cell-{number:02d}"
        cell.metadata = nbformat.from_dict({})
        if cell.cell_type == "code":
            outputs = [output for output in cell.outputs if not _compiles(output)]
            cell.outputs = [_steady(output) for output in _merged(outputs)]
    for number, cell in enumerate(_code(notebook), start=1):
        cell.execution_count = number
        for output in cell.outputs:
            if output.output_type == "execute_result":
                output.execution_count = number
    return notebook


def _code(notebook: NotebookNode) -> Iterator[NotebookNode]:
    return (cell for cell in notebook.cells if cell.cell_type == "code")


def _compiles(output: NotebookNode) -> bool:
    """Whether an output only says that solvers are compiled, as at the first call in a clone."""
    return output.get("name") == "stderr" and set(output.text.splitlines()) == {COMPILING}


def _merged(outputs: list[NotebookNode]) -> Iterator[NotebookNode]:
    """The outputs, with consecutive pieces of text of the same stream joined."""
    last: NotebookNode | None = None
    for output in outputs:
        if output.output_type == "stream" and last is not None and last.get("name") == output.name:
            last.text += output.text
            continue
        last = output if output.output_type == "stream" else None
        yield output


def _steady(output: NotebookNode) -> NotebookNode:
    """An output without the number of its widget, which varies; a picture keeps its size."""
    if "data" in output and _WIDGET in output.data:
        del output.data[_WIDGET]
        output.data["text/plain"] = "(sliders: run this notebook in Jupyter)"
    if "metadata" in output:
        sizes = {k: of for k, of in output.metadata.items() if k.startswith("image/")}
        output.metadata = nbformat.from_dict(sizes)
    return output


def write(notebook: NotebookNode, path: Path) -> None:
    """Write a notebook completely or not at all."""
    nbformat.validate(notebook)
    write_whole(f"{nbformat.writes(notebook)}\n".encode(), path)


# ------------------------------------------------------------------ comparison of outputs

_TEXTS = ("text/plain", "text/markdown", "text/latex", "text/html")


def texts(notebook: NotebookNode) -> list[str]:
    """All texts in the outputs of the cells, in order; for a picture its size."""
    lines = []
    for cell in _code(notebook):
        for output in cell.outputs:
            if output.output_type == "stream":
                lines.append(f"{output.name}: {output.text}")
            elif output.output_type == "error":
                lines.append(f"{output.ename}: {output.evalue}")
            else:
                lines += [str(output.data[kind]) for kind in _TEXTS if kind in output.data]
    return lines


def pictures(notebook: NotebookNode) -> int:
    """Number of pictures in the outputs of the cells."""
    data: list[Mapping[str, Any]] = [
        output.data for cell in _code(notebook) for output in cell.outputs if "data" in output
    ]
    return sum("image/png" in of or "image/svg+xml" in of for of in data)


MACHINE = re.compile(r"(?<![\w.~*/-])/(home|work|tmp|root|Users|opt|mnt|private|var|usr)/[\w.]")
"""Pattern of an absolute path."""


def faults(notebook: NotebookNode) -> list[str]:
    """Faults that no output may contain: errors, warnings, absolute paths."""
    lines = [f"a path: {text}" for text in texts(notebook) if MACHINE.search(text)]
    for cell in _code(notebook):
        for output in cell.outputs:
            if output.output_type == "error":
                lines.append(f"an error: {output.ename}: {output.evalue}")
            elif output.output_type == "stream" and output.name == "stderr":
                lines.append(f"a warning: {output.text}")
    return lines


def differences(path: Path) -> list[str]:
    """A diff between the outputs on disk and those of a new run, and the faults of the new run."""
    fresh, kept = run(path), read(path)
    before, after = ("\n".join(texts(of)).splitlines() for of in (kept, fresh))
    lines = list(unified_diff(before, after, "as committed", "new run", lineterm=""))
    if pictures(fresh) != pictures(kept):
        lines.append(f"{pictures(kept)} pictures as committed, {pictures(fresh)} in a new run")
    return lines + faults(fresh)


def main(arguments: list[str] | None = None) -> int:
    """Run all notebooks in place, or those whose names contain one of the given words."""
    parser = ArgumentParser(prog="python -m notebooks", description=str(main.__doc__))
    parser.add_argument("words", nargs="*")
    parser.add_argument("--check", action="store_true", help="write nothing; show the differences")
    given = parser.parse_args(arguments)
    chosen = [p for p in notebooks() if not given.words or any(w in p.name for w in given.words)]
    if not chosen:
        parser.error(f"no notebook has a name that contains {' or '.join(given.words)}")
    lines = []
    for path in chosen:
        print(path.name, flush=True)
        if given.check:
            lines += differences(path)
        else:
            write(run(path), path)
    print(*lines, sep="\n", end="")
    return int(bool(lines))


if __name__ == "__main__":
    sys.exit(main())
