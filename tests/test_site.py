"""The site of documentation: every page has a place, and its examples run."""

import importlib.util
import re
from inspect import getdoc
from pathlib import Path
from typing import Any

import pytest

from derive.body.library import library, load_geometry
from derive.command.cli import main

ROOT = Path(__file__).parents[1]
SITE = ROOT / "docs" / "site"
INDEX = (SITE / "index.md").read_text()


def listed() -> set[str]:
    """Pages that the index leads to, as they are named there."""
    blocks = re.findall(r"```{toctree}\n(.*?)```", INDEX, re.S)
    lines = [line for block in blocks for line in block.splitlines() if line and line[0] != ":"]
    return {re.sub(r".*<(.*)>", r"\1", line) for line in lines}


def module(name: str) -> Any:
    """A module of docs/site, which is no package."""
    spec = importlib.util.spec_from_file_location(name, SITE / f"{name}.py")
    assert spec is not None and spec.loader is not None
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


def test_the_index_leads_to_every_page() -> None:
    pages = [*ROOT.glob("docs/*.md"), *ROOT.glob("notebooks/*.md"), *ROOT.glob("notebooks/*.ipynb")]
    there = {path.relative_to(ROOT).with_suffix("").as_posix() for path in pages}
    made = {"theory", "handbook", "api", "api_edge", "api_geometry", "api_plot"}
    assert there <= listed()
    for name in listed() - there - made:
        assert (ROOT / f"{name}.md").exists(), name


def test_the_table_of_bodies_leads_to_their_pages() -> None:
    text = module("pages")._linked(ROOT / "docs" / "bodies.md", set())
    for name in library():
        assert f"[`{name}`](../handbook/{name}.md)" in text, name


def test_the_handbook_has_a_page_with_every_formula_of_a_body() -> None:
    from derive.sheet.derivation import derive_sheet
    from tests.derive.handbook.test_handbook import body_of

    pages = module("pages")
    sheet = derive_sheet(load_geometry("wedge"))
    body = body_of(sheet, (ROOT / "generated" / "wedge.py").read_text())
    text = "\n".join(pages.formulas(sheet, body))
    assert len(re.findall(r"^\$\$ \(wedge-", text, re.M)) == len(sheet)
    assert text.count("Proven: a stand-in for a proof") == len(sheet)
    assert text.count("<figure>") == 2 and "At a corner the pressure is infinite" in text
    assert body.text in text
    index = "\n".join(pages.handbook([sheet]))
    assert "[wedge](handbook/wedge.md)" in index
    assert "\nhandbook/wedge\n" in index[index.index("{toctree}") :]


def test_the_theory_has_a_formula_in_every_gap() -> None:
    assert "<<" not in module("pages").theory()


@pytest.mark.parametrize(("length", "marked"), [(50, []), (51, ["formulas"])])
def test_a_table_with_a_long_formula_is_marked(length: int, marked: list[str]) -> None:
    """The style makes it a list on a phone."""
    pytest.importorskip("sphinx")
    nodes = pytest.importorskip("docutils.nodes")
    table = nodes.table("", nodes.entry("", nodes.math("", "x" * length)))
    module("conf")._tables(None, nodes.container("", table))
    assert table["classes"] == marked


DOCSTRING = """Slip zone, |K_T|/(f K_N) + O(d**2) of `edge`.

    d = K_T/(f*K_N
        *E_star)

    order 1: d = -int p x dx,
        for any body
    order 2: sqrt(s)

Not -1 <= h^2/8.

Parameters
----------
a, K_T_ : array_like
    Edge; E* > 0.

Examples
--------
>>> 2 * 3 ** 1
6
""".splitlines()

RESTRUCTURED = r"""Slip zone, \|K\ :sub:`T`\ \|/(f K\ :sub:`N`\ ) + O(d\ :sup:`2`\ ) of ``edge``.

.. code-block:: text

   d = K_T/(f*K_N
       *E_star)

| order 1: d = −∫ p x dx,
  for any body
| order 2: √s

Not −1 ≤ h\ :sup:`2`\ /8.

Parameters
----------
a, K_T_ : array_like
    Edge; E\* > 0.

Examples
--------
>>> 2 * 3 ** 1
6
""".splitlines()


def test_docstrings_become_restructured_text() -> None:
    found = module("docstrings").restructured(DOCSTRING)
    assert [line for line in found if line] == [line for line in RESTRUCTURED if line]


def test_prose_in_docstrings_is_no_block_of_code() -> None:
    """An indented block of code contains formulas in Python's notation only."""
    restructured = module("docstrings").restructured
    from generated import wedge

    of_wedge = {
        name: restructured((getdoc(getattr(wedge, name)) or "").splitlines())
        for name in wedge.__all__
    }
    assert ".. code-block:: text" in of_wedge["load"]
    for name in ("history", "shear", "steady_cycle", "stick_zone"):
        assert ".. code-block:: text" not in of_wedge[name], name


def test_the_references_describe_all_public_names() -> None:
    pages = module("pages")
    text = "\n".join(line for write in pages.REFERENCES.values() for line in write())
    described = set(re.findall(r"auto(?:class|function):: ([\w.]+)", text))
    from derive import plot
    from generated import edge, wedge

    assert {f"generated.edge.{name}" for name in edge.__all__} <= described
    drawing = {f"derive.plot.{name}" for name in plot.__all__} - described
    assert drawing == {"derive.plot.COLOURS", "derive.plot.LINES"}
    for name in wedge.__all__:
        homes = ("wedge", "full_stick", "runtime.types")
        assert any(f"generated.{home}.{name}" in described for home in homes), name


def test_the_page_of_pictures_shows_one_in_every_section(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    text = (ROOT / "docs" / "pictures.md").read_text()
    shown = module("pages").drawn(text, tmp_path)
    files = re.findall(r"^!\[.+\]\((.+)\)$", shown, re.M)
    assert len(files) == len(re.findall("^## ", text, re.M)) > 3
    assert sorted(files) == sorted(path.name for path in tmp_path.iterdir())


@pytest.mark.parametrize("name", sorted(main.commands))
def test_the_page_of_commands_names_every_option(name: str) -> None:
    text = (ROOT / "docs" / "commands.md").read_text()
    rows = "\n".join(re.findall(rf"^\| `derive {name}\b.*", text, re.M))
    named = set(re.findall(r"--[a-zA-Z]+", rows))
    options = {each for given in main.commands[name].params for each in given.opts}
    assert rows and {each for each in options if each.startswith("--")} <= named
    known = {each for command in main.commands.values() for p in command.params for each in p.opts}
    assert named <= known
