"""What the README shows is what happens."""

import doctest
import re
from pathlib import Path

import pytest

README = Path(__file__).parents[1] / "README.md"


def test_the_examples_of_the_page_of_slip_give_what_they_show() -> None:
    """Those of the README need the package that it makes: test_wheel.py."""
    done = doctest.testfile(str(README.parent / "docs" / "slip.md"), module_relative=False)
    assert (done.failed, done.attempted >= 5) == (0, True)


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
