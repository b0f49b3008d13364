"""What a user can get wrong, each with the one line that tells so.

Geometry files, directories, and loads; of g(x) as text: derive/test_new.py.  Every
command leaves with status 2, without a traceback, and writes nothing.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import derive.pipeline
from generated import circular_arc, hertz, power, wedge
from tests.commands import contents, run

HEAD = """from sympy import *
from derive import Geometry, parameter, x
R = parameter("R", "radius", unit="m")
b = parameter("b", "width", unit="m")
d_0 = parameter("d_0", "another width", unit="m")
phi = parameter("phi", "slope", unit="rad")
"""

FILES = [
    ("-x**2/R", "is not convex, because its curvature is negative"),
    ("b*(1 - cos(x/b))", "contains cos(x/b), a function of x that is not supported"),
    ("phi*Abs(x) - phi*Max(0, x - b)", "its slope decreases at"),
    ("EulerGamma*b*cosh(x/b)", "contains EulerGamma, which the proofs cannot compute"),
    ("zeta(phi + 2)*x**2/R", "contains zeta(phi + 2), which the proofs cannot compute"),
    ("x**2", "the dimension of g of 'bad' is m**2, but must be m"),
    ("R*Abs(x/R)**R", "the dimension of the exponent of (Abs(x)/R)**R is m"),
    ("x**2/Symbol('r')", "contains the symbol 'r'"),
    ("Symbol('x')**2/R", "write `from derive import x`"),
    ("'x**2/R'", "not an expression"),
]
"""g(x) in a geometry file, and a part of the message."""

NO_GEOMETRY = [
    ("geometry = (", "SyntaxError"),
    ("import no_such_module_anywhere", "ModuleNotFoundError"),
    ("from derive import sphere", "ImportError"),
    ("from derive import Geometry\ngeometry = Geometry('body')", "TypeError"),
    ("geometry = 1 / 0", "ZeroDivisionError"),
    ("raise ValueError('one\\ntwo')", "ValueError: one;"),
    ("def f(): f()\nf()", "RecursionError"),
    ("import sys\nsys.exit(0)", "SystemExit"),
    ("raise KeyboardInterrupt", "bad.py: KeyboardInterrupt;"),
    ("open('no such file anywhere')", "FileNotFoundError"),
    ("import this_file_is_fine\0", "null bytes"),
    ("", "does not define `geometry`"),
    ("from derive import x\ngeometry = x**2", "does not define `geometry`"),
    (f"{HEAD}c = parameter('c_1', 'width', unit='furlong')", "furlong"),
    (f"{HEAD}E_star = parameter('E_star', 'modulus')", "'E_star' is reserved by the theory"),
    (f"{HEAD}geometry = Geometry('two words', g=x**2 / R)", "'two words'"),
    (f"{HEAD}geometry = Geometry('class', g=x**2 / R)", "'class'"),
    (f"{HEAD}geometry = Geometry('[red]:bug:[/]', g=x**2 / R)", "'[red]:bug:[/]'"),
]
"""Files without a body, and a part of the message."""

PLACES = [
    (["show", "nowhere.py"], "no such file"),
    (["show", "."], "it is a directory"),
    *((args, "there is no geometry ''") for args in (["show", ""], ["generate", "", "--out", "n"])),
    (["check", ""], "FILE is an empty path"),
    (["check", "", "--draft", "new"], "FILE is an empty path"),
    (["check", "--html", ""], "--html is an empty path"),
    (["edge", "", "--f", "0.5"], "FILE is an empty path"),
    (["edge", "notes.txt", "--f", "0.5", "--csv", ""], "--csv is an empty path"),
    (["generate", "hertz", "--out", ""], "--out is an empty path"),
    (["new", "body", "x**2/R", "--out", ""], "--out is an empty path"),
    (["check", "no\x1b[31m\nsuch"], r"FILE 'no\x1b[31m\nsuch' contains a control character"),
    (["new", "body", "x**2/R", "--out", "q\nz"], r"--out 'q\nz' contains a control character"),
    (["show", "mine.py"], "a directory"),
    (["show", "a" * 300], "a" * 300),
    (["show", "sphere"], "there is no geometry 'sphere'; the library contains"),
    (["show", "[red]:bug:[/]"], "[red]:bug:[/]"),
    (["show", "body.txt"], "not a Python file"),
    (["show", "bytes.py"], "bytes.py"),
    (["generate", "hertz", "sphere"], "sphere"),
    (["generate", "body.py"], "--out"),
    (["generate", "body.py", "--check"], "--out"),
    (["generate", "body.py", "--out", "mine"], "notes.txt"),
    (["generate", "hertz", "--out", "."], "which was not written by `derive`"),
    (["generate", "body.py", "--out", "notes.txt"], "is not a directory"),
    (["generate", "body.py", "--out", "a" * 300], "too long"),
    (["show", "--all", "--html", "--out", "a" * 300], "too long"),
]
"""Files and directories, and a part of the message."""

TARGETS = [
    "show sphere --html --out",
    "show --all --html --out",
    "generate sphere --out",
    "check none.toml --html",
    "check none.tex --draft",
    "edge none.csv --f 0.5 --html",
    "edge none.csv --f 0.5 --csv",
]
"""Commands that end in the path of their result; most of the inputs do not exist."""

LOADS: list[tuple[Any, type[Exception], str]] = [
    (lambda: hertz.contact("1e5", E_star=1.0, R=1.0), TypeError, "P must be a real number"),
    (lambda: hertz.contact(None, E_star=1.0, R=1.0), TypeError, "P must be a real number"),
    (lambda: hertz.contact(1 + 2j, E_star=1.0, R=1.0), TypeError, "P must be a real number"),
    (lambda: hertz.contact(True, E_star=1.0, R=1.0), TypeError, "P must be a real number"),
    (
        lambda: hertz.contact(np.ones(2), np.ones(3), E_star=1.0, R=1.0),
        ValueError,
        "must broadcast to one shape; their shapes are P (2,), M (3,)",
    ),
    (lambda: hertz.contact(1.0, E_star=1.0), TypeError, "R"),
    (lambda: hertz.contact(1.0, E_star=1.0, R=1.0, phi=2.0), TypeError, "phi"),
]
"""Calls that are no contact problem at all, and a part of the message."""

NOWHERE = [
    (hertz.contact, (-1.0,), {"E_star": 1.0, "R": 1.0}),
    (hertz.contact, (np.nan,), {"E_star": 1.0, "R": 1.0}),
    (hertz.contact, (1.0, np.inf), {"E_star": 1.0, "R": 1.0}),
    (hertz.contact, (1.0,), {"E_star": 0.0, "R": 1.0}),
    (wedge.contact_at_tilt, (1.0, 0.5), {"E_star": 1.0, "phi": 0.25}),
    pytest.param(  # two or three seconds: no quadrature of it converges
        *(power.contact, (1.0,), {"E_star": 1.0, "k": 0.5, "L": 1.0}), marks=pytest.mark.slow
    ),
    (circular_arc.load, (1.5, 0.5), {"E_star": 1.0, "R": 1.0}),
]
"""States that do not exist: NaN, and no warning."""


WITHOUT_MEASURE = {
    "a long cell": ("x [m], p [Pa]\n" + "1" * 10**6 + ", 2\n", "characters; at most 20000"),
    "a long header": (
        ", ".join(f"c{i}" for i in range(10**5)) + "\n1, 2\n",
        "characters; at most 20000",
    ),
    "many nodes": (
        "x [m], p [Pa]\n" + "".join(f"{i}, 1\n" for i in range(30_000)),
        "30000 nodes",
    ),
    "a body that runs away": (
        "body = { g = 'exp(exp(exp(exp(x/R))))*R' }\n[[claims]]\nlabel = 'it'\n"
        "printed = 'load(a, a) = 1'\n",
        "body: g(x): the stage 'reading' crashed",
    ),
}
"""Tables and claims, and a part of the message; the abort of the last ends another process."""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A current directory with files; a geometry file runs without the seconds of a process."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(derive.pipeline, "STRANGERS", None)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "body.txt").write_text("no Python")
    (tmp_path / "bytes.py").write_bytes(b"\xff\xfe\x00geometry")
    (tmp_path / "mine.py").mkdir()
    (tmp_path / "body.py").write_text(f'{HEAD}geometry = Geometry("body", g=x**2 / R)\n')
    return tmp_path


def refused(arguments: list[str], here: Path) -> str:
    """The one line of a command that is refused and writes nothing."""
    before = contents(here)
    result = run(*arguments)
    assert contents(here) == before
    assert result.exit_code == 2, result.output
    assert result.output.startswith("Error: ") and result.output.count("\n") == 1
    return result.output


def refused_file(text: str, here: Path) -> str:
    (here / "bad.py").write_text(text)
    return refused(["generate", "bad.py", "--out", "new"], here)


@pytest.mark.parametrize(("g", "words"), FILES, ids=[g for g, _ in FILES])
def test_a_file_whose_profile_is_refused(g: str, words: str, here: Path) -> None:
    assert words in refused_file(f'{HEAD}geometry = Geometry("bad", g={g})\n', here)


@pytest.mark.parametrize(("text", "words"), NO_GEOMETRY, ids=[words for _, words in NO_GEOMETRY])
def test_a_file_that_holds_no_body(text: str, words: str, here: Path) -> None:
    message = refused_file(text, here)
    assert words in message
    assert "bad.py" in message or words.startswith("'") or words == "furlong"


@pytest.mark.slow
@pytest.mark.parametrize("text", ["raise KeyboardInterrupt", "import sys\nsys.exit(0)"])
def test_a_file_is_refused_in_the_same_words_by_a_process_with_limits(
    text: str, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = refused_file(text, here)
    monkeypatch.undo()
    monkeypatch.chdir(here)
    assert refused_file(text, here) == told


@pytest.mark.parametrize(("arguments", "words"), PLACES, ids=[" ".join(a)[:50] for a, _ in PLACES])
def test_a_file_or_directory_that_will_not_do(arguments: list[str], words: str, here: Path) -> None:
    assert words in refused(arguments, here)


@pytest.mark.slow
@pytest.mark.parametrize("kind", WITHOUT_MEASURE)
def test_a_table_or_claims_without_measure(kind: str, here: Path) -> None:
    text, words = WITHOUT_MEASURE[kind]
    (here / "file").write_text(text)
    command = ["check", "file"] if "claims" in text else ["edge", "file", "--f", "0.5"]
    assert words in refused(command, here)


def test_a_key_of_5000_parts(here: Path) -> None:
    (here / "claims.toml").write_text(f"{'.'.join('a' * 5000)} = 1\n")
    result = run("check", "claims.toml")
    assert result.exit_code == 2
    assert "Traceback" not in result.stderr
    assert "the key 'a' is unknown" in result.stderr


@pytest.mark.parametrize("target", ["notes.txt/new", "a/b/new"])
@pytest.mark.parametrize("command", TARGETS)
def test_a_target_that_cannot_be_written_is_refused_before_the_input_is_read(
    command: str, target: str, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One lies below a file, and the folder of the other is read-only."""
    monkeypatch.setattr("os.access", lambda *_: False)
    message = refused([*command.split(), target], here)
    assert f"new{':' * ('--draft' in command)} " in message and "cannot be written (" in message
    assert ("Not a directory" if "notes" in target else "Permission denied") in message


@pytest.mark.parametrize(("call", "error", "words"), LOADS, ids=[words for *_, words in LOADS])
def test_a_load_that_is_no_number(call: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error) as caught:
        call()
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("function", "given", "own"), NOWHERE)
def test_a_state_that_does_not_exist(function: Any, given: Any, own: dict[str, float]) -> None:
    assert np.all(np.isnan(np.asarray(function(*given, **own))))
