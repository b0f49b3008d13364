"""Prepare the input of Sphinx: run `python docs/site/pages.py DIR` in the root of the repository.

With `--handbook DIR`, the pages of a handbook that was written into the website lead back to it.

The pages keep their relative paths, so that their links work as they do in the repository.  Some
pages are written here.  The theory comes from formula sheets that are proven in this run.  The
references name the modules whose docstrings Sphinx reads.
"""

import re
import shutil
import sys
from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path

from sympy import together

from derive import symbols
from derive.derivation import derive_sheet
from derive.library import library, load_geometry
from derive.notation import latex_of
from derive.proof.prove import prove_sheet
from derive.prose import prose, unit
from derive.symbols import QUANTITIES

sys.path.insert(0, str(Path(__file__).parent))

from outline import EQUATIONS, outlined

ROOT = Path(__file__).parents[2]
PAGES = ("*.md", "docs/*.md", "notebooks/*.md", "notebooks/*.ipynb", "notebooks/*.svg")
ALSO = ("tests/reference/FINDINGS.md", "docs/site/style/site.css")
SETTINGS = ("conf.py", "docstrings.py")
BODIES = ("hertz", "wedge")
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)#:]+)(#[^)]*)?\)")

ROW = re.compile(r"^\| `(\w+)` \|", re.M)


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
    for name in SETTINGS:
        shutil.copy(ROOT / "docs" / "site" / name, target / name)
    (target / "theory.md").write_text("\n".join(theory()))
    (target / "handbook.md").write_text("\n".join(handbook()))
    for name, write in REFERENCES.items():
        (target / f"{name}.md").write_text("\n".join(write()))


def _linked(path: Path, pages: set[Path]) -> str:
    """Return the text of a page; a link to a file outside the website becomes plain text."""

    def kept(match: re.Match[str]) -> str:
        return match[0] if (path.parent / match[2]).resolve() in pages else match[1]

    text = LINK.sub(kept, path.read_text())
    return ROW.sub(_leading, text) if path.stem == "bodies" else text


def _leading(match: re.Match[str]) -> str:
    """The first cell of a row of the table of bodies, as a link to the page of the body."""
    return f"| {_handbook(match[1], f'<code>{match[1]}</code>', '../')} |"


def theory() -> Iterator[str]:
    """Yield the theory page: formulas of some bodies with meaning, condition, source and proof."""
    yield _outline()
    for name in BODIES:
        geometry = load_geometry(name)
        sheet = prove_sheet(derive_sheet(geometry)).demand_proven()
        yield f"## {prose(geometry.title.removesuffix('.'))}\n"
        yield f"$$g(x) = {latex_of(geometry.g)}$$ ({name}-profile)\n"
        for parameter in geometry.parameters:
            meaning = f"{prose(parameter.meaning)} [{unit(parameter.unit)}]"
            yield f"- ${latex_of(parameter.symbol)}$: {meaning}"
        yield ""
        for symbol, expr in sheet.definitions.items():
            yield f"$$\n{latex_of(symbol)} = {latex_of(expr)}\n$$\n"
        for formula in sheet.values():
            label = f"{name}-{formula.name}".replace("_", "-")
            yield f"### {_capitalised(prose(formula.meaning))}\n"
            yield f"$$\n{formula.left} = {latex_of(sheet.shown(formula.name))}\n$$ ({label})\n"
            conditions = ", ".join(f"${latex_of(each)}$" for each in formula.conditions)
            yield f"`{formula.name}` [{unit(formula.unit)}], valid for {conditions}.\n"
            yield f"- Source: {_plain(formula.source)}."
            yield f"- {_capitalised(_plain(str(formula.proof)))}.\n"


def _outline() -> str:
    """The first part of the theory page, with the formulas of the theory's own modules."""
    sheet = derive_sheet(load_geometry(BODIES[0]))
    rows = (
        f"| ${latex_of(q.symbol)}$ | {_plain(q.meaning)} | {unit(q.unit)} |"
        for q in QUANTITIES.values()
    )
    shown = {
        "quantities": "\n".join(rows),
        "h": latex_of(together(symbols.h)),
        "mid": latex_of(together(symbols.mid)),
        "w": latex_of(symbols.w),
    }
    shown |= {name: outlined(name) for name in EQUATIONS}
    for name in ("K_N", "L_N", "K_T", "L_T"):
        shown[f"unit_{name}"] = unit(sheet[f"{name}_left"].unit)
    text = (ROOT / "docs" / "site" / "theory.md").read_text()
    return re.sub("<<(\\w+)>>", lambda match: shown[match[1]], text)


def handbook() -> Iterator[str]:
    """Yield the page that leads to the handbook, which `derive show` writes beside the website."""
    yield "# Handbook of bodies\n"
    yield (
        f"{_handbook('index', 'The handbook')} has one page for each body of the library: its "
        "profile and pressure, all formulas with their units, conditions, proofs and LaTeX, and "
        "the generated module.\n"
    )
    yield "| body | description | $g(x)$ |\n| --- | --- | --- |"
    for name in library():
        geometry = load_geometry(name)
        title = _plain(geometry.title.removesuffix("."))
        profile = latex_of(geometry.g).replace("|", r"\vert ")  # a bar would end the cell
        yield f"| {_handbook(name, name)} | {title} | ${profile}$ |"


def _handbook(page: str, words: str, root: str = "") -> str:
    """A link to a page of the handbook, which Sphinx does not know."""
    return f'<a href="{root}handbook/{page}.html">{words}</a>'


def _capitalised(words: str) -> str:
    """Capitalise the first letter of a sentence, unless it is a symbol such as P'(c)."""
    return f"{words[0].upper()}{words[1:]}" if words[1:2].isalpha() else words


def _plain(text: str) -> str:
    """Return text and its formulas, with the special characters of Markdown escaped."""
    return re.sub(r"([*_$|\[\]])", r"\\\1", prose(text))


def body_reference() -> Iterator[str]:
    """Yield the reference page of a body: its functions, those that all bodies share, results."""
    yield "# Functions of a body\n"
    yield (
        "Every generated module has the functions on this page, with the same names, arguments and "
        "results. The modules differ only in the parameters of the body and in the formulas that "
        "they evaluate. This page shows the functions of the wedge, whose parameter is `phi`. For "
        "another body, use `help(hertz.load)`, for example, or its page in the "
        "[handbook](handbook.md).\n"
    )
    wedge = import_module("generated.wedge")
    shared = ("K_T", "L_T", "stick_margin")
    own = [name for name in wedge.__all__ if name not in shared]
    results = [name for name in own if isinstance(getattr(wedge, name), type)]
    functions = [name for name in own if name not in results]
    yield from _described("A body: the wedge", "generated.wedge", functions)
    yield from _described("The same formulas for every body", "generated.full_stick", shared)
    yield from _described("Results", "generated.runtime.types", results)


def edge_reference() -> Iterator[str]:
    """Yield the reference page of `generated.edge`."""
    yield "# Functions of an edge\n"
    yield (
        "`generated.edge` needs the coefficients of an edge, but no body. "
        "[An edge without its geometry](docs/edge.md) shows how to use it.\n"
    )
    edge = import_module("generated.edge")
    results = [name for name in edge.__all__ if isinstance(getattr(edge, name), type)]
    functions = [name for name in edge.__all__ if name not in results]
    yield from _described("Functions", "generated.edge", functions)
    yield from _described("Arguments and results", "generated.edge", results)


def geometry_reference() -> Iterator[str]:
    """Yield the reference page of what a geometry file and a derivation need."""
    yield "# Geometry and derivation\n"
    yield (
        "A geometry file needs `Geometry`, `parameter` and the symbol `x`, the position along the "
        "contact; [a notebook](notebooks/02_your_own_geometry.ipynb) shows how to write one. The "
        "other functions derive and prove the formula sheet of a body.\n"
    )
    derive = import_module("derive")
    names = [name for name in derive.__all__ if name != "x"]
    yield from _described("The package `derive`", "derive", names)


def plot_reference() -> Iterator[str]:
    """Yield the reference page of `derive.plot`."""
    yield "# Functions for pictures\n"
    yield (
        "`derive.plot` draws with matplotlib; [Pictures](docs/pictures.md) shows an example. "
        "`COLOURS` and `LINES` are dictionaries of the colours and line styles.\n"
    )
    plot = import_module("derive.plot")
    names = [name for name in plot.__all__ if not isinstance(getattr(plot, name), dict)]
    yield from _described("Functions", "derive.plot", names)


REFERENCES = {
    "api": body_reference,
    "api_edge": edge_reference,
    "api_geometry": geometry_reference,
    "api_plot": plot_reference,
}


def _described(title: str, module: str, names: Iterable[str]) -> Iterator[str]:
    """Yield one section, in which Sphinx describes objects of a module."""
    home = import_module(module)
    yield f"## {title}\n"
    for name in names:
        kind = "class" if isinstance(getattr(home, name), type) else "function"
        yield f"```{{eval-rst}}\n.. auto{kind}:: {module}.{name}\n```\n"


def lead_back(folder: Path) -> None:
    """Add a link to the website to every page of a handbook inside it."""
    for path in folder.glob("*.html"):
        link = '<header>\n<p><a href="../index.html">Documentation</a></p>'
        path.write_text(path.read_text().replace("<header>", link, 1))


if __name__ == "__main__":
    *option, folder = sys.argv[1:]
    task = lead_back if option == ["--handbook"] else lay_out
    task(Path(folder))
