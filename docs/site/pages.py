"""Prepare the input of Sphinx: run `python docs/site/pages.py DIR` in the root of the repository.

The pages keep their relative paths, so that their links work as they do in the repository.  Some
pages are written here: the theory, the handbook from proven formula sheets, and references, which
name the modules whose docstrings Sphinx reads.
"""

import re
import shutil
import sys
from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path

from sympy import together

from derive import symbols
from derive.body.library import library, load_geometry
from derive.handbook.curves import profile
from derive.handbook.page import figures
from derive.pipeline import sheet_and_body
from derive.sheet.built import BuiltBody
from derive.sheet.derivation import derive_sheet
from derive.sheet.formulas import FormulaSheet
from derive.sheet.notation import latex_of
from derive.sheet.prose import prose, unit
from derive.symbols import QUANTITIES

sys.path.insert(0, str(Path(__file__).parent))

from outline import EQUATIONS, outlined

ROOT = Path(__file__).parents[2]
PAGES = ("*.md", "docs/*.md", "notebooks/*.md", "notebooks/*.ipynb", "notebooks/*.svg")
ALSO = ("tests/reference/FINDINGS.md", "docs/site/style/site.css")
SETTINGS = ("conf.py", "docstrings.py")
FIGURES = ROOT / "derive" / "handbook" / "templates" / "figures.css"
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)#:]+)(#[^)]*)?\)")
ROW = re.compile(r"^\| (`(\w+)`) \|", re.M)
EXAMPLE = re.compile(r"^```python\n(.*?)^```\n", re.M | re.S)


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
    shutil.copy(FIGURES, target / "docs" / "site" / "style")
    (target / "docs" / "pictures.md").write_text(
        drawn((target / "docs" / "pictures.md").read_text(), target / "docs")
    )
    (target / "theory.md").write_text(theory())
    built = [sheet_and_body(name) for name in library()]
    (target / "handbook.md").write_text("\n".join(handbook(sheet for sheet, _ in built)))
    (target / "handbook").mkdir()
    for sheet, body in built:
        (target / "handbook" / f"{body.name}.md").write_text("\n".join(formulas(sheet, body)))
    for name, write in REFERENCES.items():
        (target / f"{name}.md").write_text("\n".join(write()))


def _linked(path: Path, pages: set[Path]) -> str:
    """Return the text of a page; a link to a file outside the website becomes plain text."""

    def kept(match: re.Match[str]) -> str:
        return match[0] if (path.parent / match[2]).resolve() in pages else match[1]

    text = LINK.sub(kept, path.read_text())
    return ROW.sub(r"| [\1](../handbook/\2.md) |", text) if path.stem == "bodies" else text


def drawn(text: str, folder: Path) -> str:
    """A page with the pictures that its examples draw, whose files go to `folder`."""
    from matplotlib import pyplot

    from derive import plot

    names: dict[str, object] = {}
    pyplot.close("all")  # figures of the caller are not of this page

    def with_picture(match: re.Match[str]) -> str:
        exec(match[1], names)  # noqa: S102  (our own text)
        if not pyplot.get_fignums():
            return match[0]
        title = re.findall(r"^#+ (.+)", text[: match.start()], re.M)[-1]
        file = re.sub(r"\W+", "-", title).lower() + ".svg"
        plot.save(pyplot.gcf(), folder / file)
        pyplot.close("all")
        return f"{match[0]}\n![{title}]({file})\n"

    return EXAMPLE.sub(with_picture, text)


def theory() -> str:
    """The theory page, with the formulas of the theory's own modules."""
    sheet = derive_sheet(load_geometry("hertz"))
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


def handbook(sheets: Iterable[FormulaSheet]) -> Iterator[str]:
    """Yield the page that leads to the pages of all bodies."""
    yield "# Handbook of bodies\n"
    yield (
        "The handbook has one page for each body of the library: its profile and pressure, all "
        "formulas with their units, conditions, proofs and LaTeX, and the generated module. "
        "`derive show --all --html` writes the same content as pages that need no website.\n"
    )
    yield "| body | profile |\n| --- | --- |"
    names = []
    for sheet in sheets:
        geometry = sheet.geometry
        names.append(geometry.name)
        title = _plain(geometry.title.removesuffix("."))
        shape = latex_of(geometry.g).replace("|", r"\vert ")  # a bar would end the cell
        link = f"[{geometry.name}](handbook/{geometry.name}.md)"
        yield f"| {link} {profile(sheet)} | {title}:<br>$g(x) = {shape}$ |"
    pages = "\n".join(f"handbook/{name}" for name in names)
    yield f"\n```{{toctree}}\n:hidden:\n\n{pages}\n```\n"


def formulas(sheet: FormulaSheet, body: BuiltBody) -> Iterator[str]:
    """Yield the page of one body: all formulas with meaning, condition, source and proof."""
    geometry = sheet.geometry
    yield f"# {_plain(geometry.name)}\n"
    yield f"{_plain(geometry.title)}\n"
    yield f"$$g(x) = {latex_of(geometry.g)}$$ ({body.name}-profile)\n"
    for parameter in geometry.parameters:
        meaning = f"{_plain(parameter.meaning)} [{unit(parameter.unit)}]"
        yield f"- ${latex_of(parameter.symbol)}$: {meaning}"
    yield "\n[Theory](../theory.md) defines all other symbols.\n"
    yield f"## Pictures\n\n```{{raw}} html\n{figures(sheet, body)}\n```\n"
    yield f"## Formulas\n\n{_plain(sheet.remark)}\n"
    for name, formula in sheet.items():
        label = f"{body.name}-{name}".replace("_", "-")
        latex = f"{formula.left} = {latex_of(sheet.shown(name))}"
        yield f"### {_capitalised(_plain(formula.meaning))}\n"
        yield f"$$\n{latex}\n$$ ({label})\n"
        conditions = ", ".join(f"${latex_of(each)}$" for each in formula.conditions)
        yield f"`{name}` [{unit(formula.unit)}], valid for {conditions}.\n"
        yield f"- Source: {_plain(formula.source)}."
        yield f"- {_capitalised(_plain(str(formula.proof)))}.\n"
        yield _folded("LaTeX", "latex", latex)
    if sheet.definitions:
        yield "## Abbreviations\n"
    for symbol, expr in sheet.definitions.items():
        yield f"$$\n{latex_of(symbol)} = {latex_of(expr)}\n$$\n"
    yield "## The generated module\n"
    yield (
        f"`{body.name}.py`, {body.text.count(chr(10))} lines. The functions remain accurate at "
        "the edges, accept arrays, and require only NumPy and numba.\n"
    )
    yield _folded("Show the code", "python", body.text)


def _folded(summary: str, language: str, text: str) -> str:
    """A block of code that is shown on demand."""
    code = f"````{language}\n{text.strip()}\n````"
    return f"<details><summary>{summary}</summary>\n\n{code}\n\n</details>\n"


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


if __name__ == "__main__":
    lay_out(Path(sys.argv[1]))
