"""A paper in LaTeX read into a claims file: numbers, labels, statements, and what is refused."""

import errno
import json
import os
import tomllib
from pathlib import Path

import pytest

from derive.reading.displays import displays
from tests.check import asking
from tests.check.asking import run

ROOT = Path(__file__).parents[2]

PAPER = r"""
\documentclass{article}
\newcommand{\dif}{\mathrm{d}}
\title[Short]{On $E^*$,\\\emph{\& more}\thanks{To all.}}\begin{document}
% \begin{equation} a = 1 \end{equation}
\begin{equation}\label{law}
P = \int_{-a}^{a} p(x)\,\dif x = \frac{a^2 \pi E^*}{4 R}\;\text{,}
\end{equation}
\begin{align}
a &= b, \label{first}\\
c &\simeq d + \ldots \nonumber\\
K_T &= \frac{\pm Q}{\pi}
\end{align}
\begin{subequations}\begin{align} m &= n \\ n &= m \end{align}\end{subequations}
\[ u = v \]
\begin{equation} \sum_i a_i = b \end{equation}
\end{document}
"""


def written(folder: Path, text: str) -> Path:
    return asking.written(folder, text, "paper.tex")


def test_displays_are_numbered_as_latex_numbers_them(tmp_path: Path) -> None:
    source = displays(written(tmp_path, PAPER))
    found = source.found
    assert source.environments == 5
    assert [(each.number, "".join(each.labels)) for each in found] == [
        ("1", "law"),
        ("2", "first"),
        ("", ""),
        ("3", ""),
        ("4a", ""),
        ("4b", ""),
        ("", ""),
        ("5", ""),
    ]
    assert found[0].line == 6


def test_a_draft_says_what_was_read_and_judges_nothing(tmp_path: Path) -> None:
    new = tmp_path / "draft.toml"
    done = run(written(tmp_path, PAPER), "--draft", new)
    assert done.exit_code == 0, done.output
    assert "eq. (5), paper.tex" in done.output
    data = tomllib.loads(new.read_text())
    assert data["title"] == "On E^*, & more"
    claims = {claim["label"]: claim for claim in data["claims"]}
    assert claims["law/1"]["understood"] == "P = integral(p_at_x, x, -a, a)"
    assert claims["law/2"]["accepted"] is False
    assert {"P", "p_at_x", "K_T", "Q"} <= data["symbols"].keys()
    assert data["symbols"]["P"]["proposal"] == "integral(p_at_x, x, -a, a)"
    assert "understood" not in claims["(5)"]
    told = json.loads(run(new, "--format", "json").stdout)
    assert {each["verdict"] for each in told} == {"unchecked"}
    assert all(each["reason"] for each in told)


def test_displays_of_one_label_are_counted(tmp_path: Path) -> None:
    new = tmp_path / "draft.toml"
    again = PAPER.replace(r"\[ u = v \]", r"\begin{equation}\label{first} u = v \end{equation}")
    run(written(tmp_path, again), "--draft", new)
    labels = [claim["label"] for claim in tomllib.loads(new.read_text())["claims"]]
    assert [label for label in labels if label.startswith("first")] == ["first", "first [2]"]


def test_a_full_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One line with the file, and nothing is left or lost."""

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    paper, claims = written(tmp_path, PAPER), tmp_path / "new.toml"
    for arguments, answers in ([paper, "--draft", claims], ""), ([claims, "--accept"], "y\n" * 9):
        before = {path: path.read_text() for path in tmp_path.iterdir()}
        with monkeypatch.context() as patch:
            patch.setattr(os, "fsync", full)
            done = run(*arguments, answers=answers)
        (told,) = done.stderr.splitlines()
        assert done.exit_code == 2 and str(claims) in told and "free some space" in told
        assert {path: path.read_text() for path in tmp_path.iterdir()} == before
        run(*arguments, answers=answers)


def test_a_draft_replaces_nothing(tmp_path: Path) -> None:
    paper = written(tmp_path, PAPER)
    assert run(paper, "--draft", paper).exit_code == 2
    assert paper.read_text() == PAPER


PHYSICS = r"""
\newcommand{\half}[1]{\frac{#1}{2}}
\DeclareMathOperator{\sgn}{sgn}
\begin{document}
The normal load, $P$, acts.
\begin{align} p(x) &= \half{P} \sgn(x) \label{one} \\
p(0) &= P, \quad |x| < a \label{two} \end{align}
\begin{equation} P = p(\sqrt{s}) \end{equation}
\begin{equation} \frac{d}{dx} p(x) = 0 \end{equation}
In a line $a = \half{b}$ may stand.
\end{document}
"""


def test_a_draft_asks_where_it_is_not_sure(tmp_path: Path) -> None:
    new = tmp_path / "draft.toml"
    done = run(written(tmp_path, PHYSICS), "--draft", new, "--inline")
    assert done.exit_code == 0, done.output
    assert "p is a function elsewhere" in done.output
    assert "at `d}{dx} p(x) = 0`" in done.output
    data = tomllib.loads(new.read_text())
    claims = {claim["label"]: claim for claim in data["claims"]}
    assert claims["one"]["understood"] == "p_at_x = P/2*sign(x)"
    assert claims["two"]["require"] == "abs(x) < a"
    assert claims["line 10"]["understood"] == "a = b/2"
    assert data["symbols"]["P"] == data["symbols"]["p_at_0"] == ""
    assert {each["verdict"] for each in json.loads(run(new, "--format", "json").stdout)} == {
        "unchecked"
    }


@pytest.mark.parametrize(
    ("text", "part"),
    [
        (r"\begin{equation} a = b", "is not closed"),
        ("no mathematics", "no displayed equations"),
        ("$$a$$" * 600, "more than 500 displays"),
        ("x" * 5_000_001, "larger than"),
    ],
)
def test_a_file_that_cannot_be_drafted(text: str, part: str, tmp_path: Path) -> None:
    done = run(written(tmp_path, text), "--draft", tmp_path / "new.toml")
    assert (done.exit_code, part in done.output) == (2, True), done.output
    assert not (tmp_path / "new.toml").exists()
