"""The site of documentation: every page has a place, and its examples run."""

import importlib.util
import re
from pathlib import Path
from typing import Any

import pytest

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


def test_the_handbook_has_a_page_with_every_formula_of_a_body() -> None:
    from tests.codegen.made import body_of
    from tests.derive.bodies import assumed, of_library

    pages = module("pages")
    sheet = assumed(of_library("wedge"))
    body = body_of(sheet, (ROOT / "generated" / "wedge.py").read_text())
    text = "\n".join(pages.formulas(sheet, body))
    assert len(re.findall(r"^\$\$ \(wedge-", text, re.M)) == len(sheet)
    assert text.count("Proven: assumed by a test") == len(sheet)
    assert text.count("<figure>") == 2 and "At a corner the pressure is infinite" in text
    assert body.text in text
    index = "\n".join(pages.handbook([sheet]))
    assert "[wedge](handbook/wedge.md)" in index
    assert "\nhandbook/wedge\n" in index[index.index("{toctree}") :]


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
    given = [p for p in main.commands[name].params if not getattr(p, "hidden", False)]
    options = {each for option in given for each in option.opts}
    assert rows and {each for each in options if each.startswith("--")} <= named
    known = {each for command in main.commands.values() for p in command.params for each in p.opts}
    assert named <= known
