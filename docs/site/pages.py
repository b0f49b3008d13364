"""Prepare the input of Sphinx: run `python docs/site/pages.py DIR` in the root of the repository.

The pages keep their relative paths, so that their links work as they do in the repository.  Two
pages are written here.  The theory comes from formula sheets that are proven in this run.  The
reference of the functions names the modules whose docstrings Sphinx reads.
"""

import re
import shutil
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

from derive.derivation import derive_sheet
from derive.handbook.prose import prose
from derive.library import load_geometry
from derive.notation import latex_of
from derive.proof.prove import prove_sheet

ROOT = Path(__file__).parents[2]
PAGES = ("*.md", "docs/*.md", "notebooks/*.md", "notebooks/*.ipynb", "notebooks/*.svg")
ALSO = ("tests/reference/FINDINGS.md", "docs/site/conf.py", "docs/site/style/site.css")
BODIES = ("hertz", "wedge")
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)#:]+)(#[^)]*)?\)")


def lay_out(target: Path) -> None:
    """Write all pages to the directory `target`, which is deleted first."""
    shutil.rmtree(target, ignore_errors=True)
    sources = [path for pattern in PAGES for path in ROOT.glob(pattern)]
    sources += [ROOT / name for name in ALSO]
    pages = {path.resolve() for path in sources if path.name != "paper.md"}
    for path in sorted(pages):
        copy = target / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix == ".md":
            copy.write_text(_linked(path, pages))
        else:
            shutil.copy(path, copy)
    shutil.copy(ROOT / "docs" / "site" / "index.md", target / "index.md")
    shutil.copy(ROOT / "docs" / "site" / "conf.py", target / "conf.py")
    (target / "theory.md").write_text("\n".join(theory()))
    (target / "api.md").write_text("\n".join(reference()))


def _linked(path: Path, pages: set[Path]) -> str:
    """Return the text of a page; a link to a file outside the website becomes plain text."""

    def kept(match: re.Match[str]) -> str:
        return match[0] if (path.parent / match[2]).resolve() in pages else match[1]

    return LINK.sub(kept, path.read_text())


def theory() -> Iterator[str]:
    """Yield the theory page: formulas of some bodies with meaning, condition, source and proof."""
    yield "# Theory\n"
    yield (
        "Every equation on this page is printed from a formula sheet. The sheet was derived when "
        "the page was built, and each formula was proven symbolically or checked to at least 30 "
        "digits; the line below a formula says which. `derive show NAME` prints the sheet of any "
        'body, and the <a href="handbook/index.html">handbook</a> contains the sheets of all '
        "bodies.\n"
    )
    yield (
        "The contact is $[-a, c]$, the tilt $\\alpha$ is positive anticlockwise, and s is the "
        "distance from an edge. $\\Delta Q$ and $\\Delta\\sigma$ are the changes of the shear load "
        "and of the bulk tension."
        "\n"
    )
    for name in BODIES:
        geometry = load_geometry(name)
        sheet = prove_sheet(derive_sheet(geometry)).demand_proven()
        yield f"## {prose(geometry.title.removesuffix('.'))}\n"
        yield f"$$g(x) = {latex_of(geometry.g)}$$ ({name}-profile)\n"
        for parameter in geometry.parameters:
            meaning = f"{prose(parameter.meaning)} [{parameter.unit}]"
            yield f"- ${latex_of(parameter.symbol)}$: {meaning}"
        yield ""
        for symbol, expr in sheet.definitions.items():
            yield f"$$\n{latex_of(symbol)} = {latex_of(expr)}\n$$\n"
        for formula in sheet.values():
            label = f"{name}-{formula.name}".replace("_", "-")
            yield f"### {_capitalised(prose(formula.meaning))}\n"
            yield f"$$\n{formula.left} = {latex_of(sheet.shown(formula.name))}\n$$ ({label})\n"
            yield f"`{formula.name}` [{formula.unit}], valid for `{formula.assumptions}`.\n"
            yield f"- Source: {_plain(formula.source)}."
            yield f"- {_capitalised(_plain(str(formula.proof)))}.\n"


def _capitalised(words: str) -> str:
    """Capitalise the first letter of a sentence, unless it is a symbol such as P'(c)."""
    return f"{words[0].upper()}{words[1:]}" if words[1:2].isalpha() else words


def _plain(text: str) -> str:
    """Return text and its formulas, with the special characters of Markdown escaped."""
    return re.sub(r"([*_$|\[\]])", r"\\\1", prose(text))


def reference() -> Iterator[str]:
    """Yield the reference page: functions of one body, and functions that all bodies share."""
    yield "# Functions, with their docstrings\n"
    yield (
        "All generated modules have the same functions. They differ in the parameters of the body "
        "and in the formulas that they evaluate. This page shows the functions of the wedge. For "
        "another body, use `help(hertz.load)`, for example, or its page in the "
        '<a href="handbook/index.html">handbook</a>.\n'
    )
    wedge = import_module("generated.wedge")
    shared = ("K_T", "L_T", "stick_margin")
    own = [name for name in wedge.__all__ if name not in shared]
    results = [name for name in own if isinstance(getattr(wedge, name), type)]
    functions = [name for name in own if name not in results]
    for title, module, kind, names in (
        ("A body: the wedge", "wedge", "function", functions),
        ("The same for every body", "full_stick", "function", shared),
        ("Results", "runtime.types", "class", results),
    ):
        yield f"## {title}\n"
        for name in names:
            yield f"```{{eval-rst}}\n.. auto{kind}:: generated.{module}.{name}\n```\n"


if __name__ == "__main__":
    lay_out(Path(sys.argv[1]))
