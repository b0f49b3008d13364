"""The site of documentation: every page has a place, and its examples run."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SITE = ROOT / "docs" / "site"
INDEX = (SITE / "index.md").read_text()


def listed() -> set[str]:
    """Pages that the index leads to, as they are named there."""
    blocks = re.findall(r"```{toctree}\n(.*?)```", INDEX, re.S)
    lines = [line for block in blocks for line in block.splitlines() if line and line[0] != ":"]
    return {re.sub(r".*<(.*)>", r"\1", line) for line in lines}


def test_the_index_leads_to_every_page() -> None:
    pages = [*ROOT.glob("docs/*.md"), *ROOT.glob("notebooks/*.md"), *ROOT.glob("notebooks/*.ipynb")]
    there = {path.relative_to(ROOT).with_suffix("").as_posix() for path in pages}
    made = {"theory", "api"}
    assert there <= listed()
    for name in listed() - there - made:
        assert (ROOT / f"{name}.md").exists(), name


def test_the_theory_numbers_every_formula_of_its_sheets() -> None:
    from derive.derivation import derive_sheet
    from derive.library import load_geometry

    spec = importlib.util.spec_from_file_location("pages", SITE / "pages.py")
    assert spec is not None and spec.loader is not None
    pages = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(pages)
    text = "\n".join(pages.theory())
    for body in pages.BODIES:
        sheet = derive_sheet(load_geometry(body))
        assert len(re.findall(rf"^\$\$ \({body}-", text, re.M)) == len(sheet)


def test_the_example_of_pictures_runs() -> None:
    plt = pytest.importorskip("matplotlib.pyplot")
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "pictures.md").read_text(), re.S)
    names: dict[str, object] = {}
    exec(code, names)  # noqa: S102  (our own text)
    assert names["axes"] is not None
    plt.close("all")
