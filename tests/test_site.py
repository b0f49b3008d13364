"""The site of documentation: every page has a place, and its examples run."""

import importlib.util
import re
from inspect import getdoc
from pathlib import Path
from typing import Any

import pytest

from derive.library import library

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


def test_the_pages_of_bodies_lead_to_the_handbook() -> None:
    pages = module("pages")
    bodies = pages._linked(ROOT / "docs" / "bodies.md", set())
    for text, root in ((bodies, "../"), ("\n".join(pages.handbook()), "")):
        for name in library():
            assert f'href="{root}handbook/{name}.html"' in text, name


def test_pages_of_a_handbook_lead_back(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("<header>\n<h1>")
    module("pages").lead_back(tmp_path)
    text = (tmp_path / "index.html").read_text()
    assert text == '<header>\n<p><a href="../index.html">Documentation</a></p>\n<h1>'


def test_the_theory_numbers_every_formula_of_its_sheets() -> None:
    from derive.derivation import derive_sheet
    from derive.library import load_geometry

    pages = module("pages")
    text = "\n".join(pages.theory())
    for body in pages.BODIES:
        sheet = derive_sheet(load_geometry(body))
        assert len(re.findall(rf"^\$\$ \({body}-", text, re.M)) == len(sheet)


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


def test_the_example_of_pictures_runs() -> None:
    plt = pytest.importorskip("matplotlib.pyplot")
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "pictures.md").read_text(), re.S)
    names: dict[str, object] = {}
    exec(code, names)  # noqa: S102  (our own text)
    assert names["axes"] is not None
    plt.close("all")
