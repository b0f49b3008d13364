"""Lay out what Sphinx reads: `python docs/site/pages.py DIR`, from the root of the repository.

The pages keep their places, so that their links lead where they lead in the repository.  Two pages
are written here: the theory, from formula sheets that are proven in this run, and the reference of
the functions, which names the modules that Sphinx reads the docstrings of.
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
    """Write all pages into the directory `target`, which is emptied first."""
    shutil.rmtree(target, ignore_errors=True)
    sources = [path for pattern in PAGES for path in ROOT.glob(pattern)]
    sources += [ROOT / name for name in ALSO]
    pages = {path.resolve() for path in sources if path.name != "paper.md"}
    for path in sorted(pages):
        place = target / path.relative_to(ROOT)
        place.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix == ".md":
            place.write_text(_linked(path, pages))
        else:
            shutil.copy(path, place)
    shutil.copy(ROOT / "docs" / "site" / "index.md", target / "index.md")
    shutil.copy(ROOT / "docs" / "site" / "conf.py", target / "conf.py")
    (target / "theory.md").write_text("\n".join(theory()))
    (target / "api.md").write_text("\n".join(reference()))


def _linked(path: Path, pages: set[Path]) -> str:
    """A page's text; a link to what is no page of the site becomes its words."""

    def kept(match: re.Match[str]) -> str:
        return match[0] if (path.parent / match[2]).resolve() in pages else match[1]

    return LINK.sub(kept, path.read_text())


def theory() -> Iterator[str]:
    """The formulas of some bodies, each with number, meaning, condition, source and proof."""
    yield "# Theory\n"
    yield (
        "Every equation of this page is printed from a formula sheet that was derived and proven "
        "as the page was built; none is typed. `derive show NAME` prints the sheet of any body, "
        'and the <a href="handbook/index.html">handbook</a> has the sheets of all.\n'
    )
    yield (
        "The contact is $[-a, c]$, the tilt $\\alpha$ is anticlockwise, s is the distance from an "
        "edge, and $\\Delta Q$ and $\\Delta\\sigma$ are the changes of shear load and bulk tension."
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
            yield f"### {_begun(prose(formula.meaning))}\n"
            yield f"$$\n{formula.left} = {latex_of(sheet.shown(formula.name))}\n$$ ({label})\n"
            yield f"`{formula.name}` [{formula.unit}], where `{formula.assumptions}`.\n"
            yield f"- Source: {_plain(formula.source)}."
            yield f"- {_begun(_plain(str(formula.proof)))}.\n"


def _begun(words: str) -> str:
    """A sentence begins with a capital, unless with a symbol such as P'(c)."""
    return f"{words[0].upper()}{words[1:]}" if words[1:2].isalpha() else words


def _plain(text: str) -> str:
    """Words and their formulas, with what Markdown would read as marks made plain."""
    return re.sub(r"([*_$|\[\]])", r"\\\1", prose(text))


def reference() -> Iterator[str]:
    """The functions of one body, and what all bodies share."""
    yield "# Functions, with their docstrings\n"
    yield (
        "All generated modules have the same functions; they differ in the body's own parameters "
        "and in the formulas that they evaluate. This page shows the wedge's. `help(hertz.load)` "
        "shows those of another body, as its page of the "
        '<a href="handbook/index.html">handbook</a> does.\n'
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
