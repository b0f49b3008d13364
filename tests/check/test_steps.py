"""Where an error enters a derivation, in which displays follow from earlier ones.

By hand, for a cylinder of radius R: P = pi E* a**2/(4 R), p_0 = 2 P/(pi a) = E* a/(2 R), and
K_N = p_0 sqrt(2/a) = E* sqrt(2 a)/(2 R).  An error in p_0 is passed on to both of its results.
"""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.check import asking

HEAD = """
body = "hertz"
[variables]
a = { unit = "m" }
b = { unit = "m" }
[symbols]
P = "load(a, a)"
p_0 = "pressure(0, a, a)"
K_N = "K_N_left(a, a)"
u = ""
"""
RIGHT = {
    "(1)": "P = pi*E_star*a**2/(4*R)",
    "(2)": "p_0 = 2*P/(pi*a)",
    "(3)": "p_0 = E_star*a/(2*R)",
    "(4)": "K_N = p_0*sqrt(2/a)",
    "(5)": "K_N = E_star*sqrt(2*a)/(2*R)",
}
GIVEN = {"(3)": ["(1)", "(2)"], "(5)": ["(3)", "(4)"]}


def told(
    folder: Path, changed: dict[str, str], given: dict[str, list[str]]
) -> dict[str, dict[str, Any]]:
    """What is told of each display, of which some are printed in another way."""
    text = HEAD
    for label, printed in {**RIGHT, **changed}.items():
        text += f"[[claims]]\nlabel = {json.dumps(label)}\nprinted = {json.dumps(printed)}\n"
        if label in given:
            text += f"given = {json.dumps(given[label])}\n"
    return {each["label"]: each for each in asking.told(folder, text)}


@pytest.mark.parametrize(
    ("changed", "verdicts", "at"),
    [
        ({}, {}, {}),
        # the misprint is in (2), and what follows is wrong by the same factor
        (
            {
                "(2)": "p_0 = 4*P/(pi*a)",
                "(3)": "p_0 = E_star*a/R",
                "(5)": "K_N = E_star*sqrt(2*a)/R",
            },
            {"(2)": "fails"},
            {"(2)": ["(2)"], "(3)": ["(2)"], "(5)": ["(2)"]},
        ),
        # it is in print only: the displays after it are right
        (
            {"(2)": "p_0 = 4*P/(pi*a)"},
            {"(2)": "fails", "(3)": "unchecked"},
            {"(2)": ["(2)"], "(3)": ["(2)"]},
        ),
        # it is in the step to (3), or in the last step
        (
            {"(3)": "p_0 = E_star*a/R", "(5)": "K_N = E_star*sqrt(2*a)/R"},
            {"(3)": "fails"},
            {"(3)": ["(3)"], "(5)": ["(3)"]},
        ),
        ({"(5)": "K_N = E_star*sqrt(a)/(2*R)"}, {"(5)": "fails"}, {"(5)": ["(5)"]}),
        # two errors, the second in the last step
        (
            {"(2)": "p_0 = 4*P/(pi*a)", "(3)": "p_0 = E_star*a/R", "(5)": "K_N = E_star*sqrt(a)/R"},
            {"(2)": "fails", "(5)": "fails"},
            {"(2)": ["(2)"], "(3)": ["(2)"], "(5)": ["(2)", "(5)"]},
        ),
    ],
)
def test_the_display_at_which_an_error_enters(
    tmp_path: Path, changed: dict[str, str], verdicts: dict[str, str], at: dict[str, list[str]]
) -> None:
    found = told(tmp_path, changed, GIVEN)
    for label, each in found.items():
        assert each["verdict"] == verdicts.get(label, "holds"), each["evidence"]
        assert each["error_enters_at"] == at.get(label, [])
        if each["corrected"]:  # not by what is wrong itself
            assert each["corrected"] == RIGHT[label]
    shown = asking.run(tmp_path / "claims.toml", "--explain", "(5)").stdout
    assert ("the error enters at" in shown) == ("(5)" in at)


@pytest.mark.parametrize(
    ("changed", "given", "verdict", "at", "told_of_it"),
    [
        # nothing is known of u alone: it is as it is given
        ({"(2)": "u = 4*P", "it": "u = 2*P"}, ["(2)"], "fails", [], "not known where"),
        ({"(2)": "u = 4*P", "it": "u = pi*E_star*a**2/R"}, ["(2)"], "holds", [], "given (2)"),
        # a true display that does not depend on what is wrong
        ({"(2)": "p_0 = 4*P/(pi*a)", "it": "p_0*b = b*p_0"}, ["(2)"], "holds", [], "(2) (fails)"),
        (
            {"(2)": "p_0 = 4*P/(pi*a)", "it": "p_0 < b"},
            ["(2)"],
            "fails",
            ["(2)", "it"],
            "at (2) and",
        ),
        # what cannot be read is no error
        ({"(2)": "p_0 = v", "it": "p_0 = b"}, ["(2)"], "unchecked", [], "can be read"),
    ],
)
def test_what_is_not_known_is_not_told(
    tmp_path: Path,
    changed: dict[str, str],
    given: list[str],
    verdict: str,
    at: list[str],
    told_of_it: str,
) -> None:
    it = told(tmp_path, changed, {"it": given})["it"]
    assert (it["verdict"], it["error_enters_at"]) == (verdict, at), it["evidence"]
    assert told_of_it in it["evidence"]
