"""What the pages of docs/ list is what there is."""

import re
from pathlib import Path

import pytest

from derive.check.claim import Verdict
from derive.check.userfile import read_claims
from tests.derive.bodies import of_library

CLAIMS = (Path(__file__).parents[1] / "docs" / "claims.md").read_text()


def test_the_formulas_listed_are_those_of_the_sheet() -> None:
    sheet = of_library("hertz")
    listed = re.findall(r"^\| `(\w+)\((.*?)\)` \| (.*?) \| (.*?) \|$", CLAIMS, re.M)
    assert len(listed) > 15
    for name, arguments, meaning, unit in listed:
        formula = sheet[name]
        assert ", ".join(map(str, formula.arguments)) == arguments
        assert (str(formula.meaning), str(formula.unit)) == (meaning, unit)
        if name.endswith("_left"):
            assert name.replace("_left", "_right") in sheet


def test_the_file_shown_is_read(tmp_path: Path) -> None:
    answers, shown, *_ = re.findall(r"```toml\n(.*?)```", CLAIMS, re.S)
    path = tmp_path / "note.toml"
    path.write_text(shown)
    (claim,) = read_claims(path).claims
    assert claim.entry.expected is Verdict.HOLDS
    path.write_text(f"{answers}[[claims]]\nlabel = 'flat'\nprinted = 'P = load(b, b)'\n")
    (claim,) = read_claims(path).claims
    assert not claim.unchecked


@pytest.mark.parametrize("verdict", list(Verdict))
def test_every_verdict_is_told(verdict: Verdict) -> None:
    assert f"| {verdict} |" in CLAIMS
