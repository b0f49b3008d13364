"""What the README shows is what happens."""

import doctest
import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from derive.cli import main

README = Path(__file__).parents[1] / "README.md"


def test_the_examples_give_what_they_show() -> None:
    result = doctest.testfile(str(README), module_relative=False)
    assert result.attempted >= 6
    assert result.failed == 0


@pytest.mark.slow
def test_the_commands_for_a_body_of_your_own_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    commands = re.findall(r"^\.venv/bin/derive (.*?)(?: +#.*)?$", README.read_text(), re.M)
    assert len(commands) >= 3
    for command in commands:
        done = CliRunner().invoke(main, shlex.split(command), catch_exceptions=False)
        assert done.exit_code == 0, done.output
    assert (tmp_path / "my_bodies" / "quad.py").is_file()


def test_the_geometry_file_shown_is_that_of_the_library() -> None:
    shown = re.search(r'```python\n("""Cylinder.*?)```', README.read_text(), re.S)
    assert shown is not None
    written = (README.parent / "derive" / "geometries" / "hertz.py").read_text()
    assert shown.group(1).split() == written.split()


def test_every_link_leads_somewhere() -> None:
    links = re.findall(r"\]\(([^)#:]+)\)", README.read_text())
    assert links
    for link in links:
        assert (README.parent / link).exists(), link
