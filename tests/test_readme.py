"""What the README shows is what happens."""

import doctest
import re
from pathlib import Path

import pytest

README = Path(__file__).parents[1] / "README.md"


@pytest.mark.parametrize(("page", "least"), [("README.md", 6), ("docs/slip.md", 5)])
def test_the_examples_give_what_they_show(page: str, least: int) -> None:
    """Those of the tutorial need the package that it makes: test_wheel.py."""
    text = re.sub(r"```pycon\n(.*?)```", "", (README.parent / page).read_text(), flags=re.S)
    test = doctest.DocTestParser().get_doctest(text, {}, page, None, 0)
    done = doctest.DocTestRunner().run(test)
    assert (done.failed, done.attempted >= least) == (0, True)


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
