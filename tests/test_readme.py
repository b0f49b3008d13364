"""What the README shows is what happens."""

import doctest
import importlib.util
import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from derive.cli import main

README = Path(__file__).parents[1] / "README.md"


TUTORIAL = re.compile(r"```pycon\n(.*?)```", re.S)
PLOT = re.compile(r"```python\n(import matplotlib.*?)```", re.S)


def failures(text: str, names: dict[str, object]) -> tuple[int, int]:
    """Examples that fail, and all that were tried."""
    test = doctest.DocTestParser().get_doctest(text, names, "README", str(README), 0)
    done = doctest.DocTestRunner().run(test, clear_globs=False)
    names |= test.globs
    return done.failed, done.attempted


@pytest.mark.parametrize(("page", "least"), [("README.md", 6), ("docs/slip.md", 5)])
def test_the_examples_give_what_they_show(page: str, least: int) -> None:
    text = (README.parent / page).read_text()
    failed, attempted = failures(TUTORIAL.sub("", text) if page == "README.md" else text, {})
    assert (failed, attempted >= least) == (0, True)


@pytest.mark.slow
def test_the_tutorial_works_as_it_stands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its commands one after the other, its calls, and its plot where matplotlib is there.

    The new package runs as plain Python, for which nothing needs to be compiled.
    """
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    text = README.read_text()
    (block,) = re.findall(r"```sh\n(derive new.*?)```", text, re.S)
    commands = re.findall(r"^derive (.*?)(?: +#.*)?$", block, re.M)
    assert len(commands) >= 3
    for command in commands:
        done = CliRunner().invoke(main, shlex.split(command), catch_exceptions=False)
        assert done.exit_code == 0, done.output
    if importlib.util.find_spec("numba"):
        monkeypatch.setattr("numba.config.DISABLE_JIT", 1)
    calls, (plot,) = "\n".join(TUTORIAL.findall(text)), PLOT.findall(text)
    names: dict[str, object] = {}
    assert failures(calls, names) == (0, 7)
    if importlib.util.find_spec("matplotlib"):
        monkeypatch.setenv("MPLBACKEND", "Agg")
        exec(plot, names)  # noqa: S102  (our own text)


def test_the_geometry_file_shown_is_that_of_the_library() -> None:
    shown = re.search(r'```python\n("""Cylinder.*?)```', README.read_text(), re.S)
    assert shown is not None
    written = (README.parent / "derive" / "geometries" / "hertz.py").read_text()
    assert shown.group(1).split() == written.split()


PAGES = [README, *sorted((README.parent / "docs").glob("*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_leads_somewhere(page: Path) -> None:
    for link in re.findall(r"\]\(([^)#:]+)[^):]*\)", page.read_text()):
        assert (page.parent / link).exists(), link
