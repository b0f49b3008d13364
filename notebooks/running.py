"""Runs the notebooks, and keeps those outputs that are the same on every machine."""

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

from derive.files import write_whole

FOLDER = Path(__file__).parent
ROOT = FOLDER.parent

TIMEOUT = 600
"""Seconds that one cell may take."""

_METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}
_INLINE = "ignore:InlineBackend._figure_formats_changed:DeprecationWarning"
"""What matplotlib-inline says of itself when it is told the format of pictures."""

_WIDGET = "application/vnd.jupyter.widget-view+json"


def notebooks() -> list[Path]:
    """Every notebook, in the order of their names."""
    return sorted(FOLDER.glob("*.ipynb"))


def read(path: Path) -> NotebookNode:
    """A notebook as it is on disk."""
    return nbformat.read(path, as_version=4)


def run(path: Path) -> NotebookNode:
    """A notebook whose cells have all been run afresh, in order, in its own folder.

    Its pictures have 200 dots an inch, and say at what size they are shown.

    Raises nbclient.exceptions.CellExecutionError for a cell that raises.
    """
    notebook = read(path)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    import_module("matplotlib.font_manager")  # its first import lists fonts, and says so at length
    client = NotebookClient(notebook, timeout=TIMEOUT, kernel_name="python3")
    client.extra_arguments = ["--log-level=ERROR", "--InlineBackend.figure_formats=retina"]
    client.resources = {"metadata": {"path": str(path.parent)}}
    with TemporaryDirectory() as folder:
        client.execute(env=_environment(folder))
    return clean(notebook)


def _environment(folder: str) -> dict[str, str]:
    """None of the user's own settings; this checkout's packages come before those installed."""
    own = {"IPYTHONDIR": folder, "PYTHONPATH": str(ROOT), "PYTHONHASHSEED": "0"}
    threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    dropped = ("MPLBACKEND", "MATPLOTLIBRC", "PYTHONWARNINGS")
    kept = {name: value for name, value in os.environ.items() if name not in dropped}
    return {**kept, **own, **threads, "PYTHONWARNINGS": f"default,{_INLINE}"}


def clean(notebook: NotebookNode) -> NotebookNode:
    """Without what differs between runs: times, widget numbers, the kernel's version."""
    notebook.metadata = nbformat.from_dict(_METADATA)
    notebook.nbformat, notebook.nbformat_minor = 4, 5
    for number, cell in enumerate(notebook.cells, start=1):
        cell.id = f"cell-{number:02d}"
        cell.metadata = nbformat.from_dict({})
        if cell.cell_type == "code":
            cell.outputs = [_steady(output) for output in _merged(cell.outputs)]
    for number, cell in enumerate(_code(notebook), start=1):
        cell.execution_count = number
        for output in cell.outputs:
            if output.output_type == "execute_result":
                output.execution_count = number
    return notebook


def _code(notebook: NotebookNode) -> Iterator[NotebookNode]:
    return (cell for cell in notebook.cells if cell.cell_type == "code")


def _merged(outputs: list[NotebookNode]) -> Iterator[NotebookNode]:
    """Text of one stream in one piece, however it arrived."""
    last: NotebookNode | None = None
    for output in outputs:
        if output.output_type == "stream" and last is not None and last.get("name") == output.name:
            last.text += output.text
            continue
        last = output if output.output_type == "stream" else None
        yield output


def _steady(output: NotebookNode) -> NotebookNode:
    """An output without its widget's number, which differs each time; a picture keeps its size."""
    if "data" in output and _WIDGET in output.data:
        del output.data[_WIDGET]
        output.data["text/plain"] = "(sliders: run this notebook in Jupyter)"
    if "metadata" in output:
        sizes = {k: of for k, of in output.metadata.items() if k.startswith("image/")}
        output.metadata = nbformat.from_dict(sizes)
    return output


def write(notebook: NotebookNode, path: Path) -> None:
    """Write a notebook whole, or not at all."""
    nbformat.validate(notebook)
    write_whole(f"{nbformat.writes(notebook)}\n".encode(), path)


# ------------------------------------------------------------------ what tests compare

_TEXTS = ("text/plain", "text/markdown", "text/latex", "text/html")


def texts(notebook: NotebookNode) -> list[str]:
    """Every text that the cells put out, in order; of a picture its size."""
    found = []
    for cell in _code(notebook):
        for output in cell.outputs:
            if output.output_type == "stream":
                found.append(f"{output.name}: {output.text}")
            elif output.output_type == "error":
                found.append(f"{output.ename}: {output.evalue}")
            else:
                found += [str(output.data[kind]) for kind in _TEXTS if kind in output.data]
    return found


def pictures(notebook: NotebookNode) -> int:
    """How many pictures the cells put out."""
    data: list[Mapping[str, Any]] = [
        output.data for cell in _code(notebook) for output in cell.outputs if "data" in output
    ]
    return sum("image/png" in of or "image/svg+xml" in of for of in data)


MACHINE = re.compile(r"(?<![\w.~*/-])/(home|work|tmp|root|Users|opt|mnt|private|var|usr)/[\w.]")
"""A path of some machine."""


def faults(notebook: NotebookNode) -> list[str]:
    """What no output may contain: errors, warnings, paths of a machine."""
    found = [f"a path: {text}" for text in texts(notebook) if MACHINE.search(text)]
    for cell in _code(notebook):
        for output in cell.outputs:
            if output.output_type == "error":
                found.append(f"an error: {output.ename}: {output.evalue}")
            elif output.output_type == "stream" and output.name == "stderr":
                found.append(f"a warning: {output.text}")
    return found


def differences(path: Path) -> list[str]:
    """Lines of a diff between the output on disk and that of a fresh run; and its faults."""
    fresh, kept = run(path), read(path)
    before, after = ("\n".join(texts(of)).splitlines() for of in (kept, fresh))
    lines = list(unified_diff(before, after, "as committed", "fresh", lineterm=""))
    if pictures(fresh) != pictures(kept):
        lines.append(f"{pictures(kept)} pictures as committed, {pictures(fresh)} fresh")
    return lines + faults(fresh)


def main(arguments: list[str] | None = None) -> int:
    """Run all notebooks in place, or those whose names hold one of the given words."""
    parser = ArgumentParser(prog="python -m notebooks", description=str(main.__doc__))
    parser.add_argument("words", nargs="*")
    parser.add_argument("--check", action="store_true", help="write nothing; show what differs")
    given = parser.parse_args(arguments)
    chosen = [p for p in notebooks() if not given.words or any(w in p.name for w in given.words)]
    if not chosen:
        parser.error(f"no notebook's name holds {' or '.join(given.words)}")
    found = []
    for path in chosen:
        print(path.name, flush=True)
        if given.check:
            found += differences(path)
        else:
            write(run(path), path)
    print(*found, sep="\n", end="")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
