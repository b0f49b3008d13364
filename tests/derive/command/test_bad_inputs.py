"""What a user can get wrong, each with the one line that tells so.

Every command leaves with status 2, without a traceback, and writes nothing.
"""

import shlex
from pathlib import Path

import pytest

import derive.command.new_geometry
import derive.pipeline
from derive.command.processes import in_processes
from tests.commands import contents, run

HEAD = """from sympy import *
from derive import Geometry, parameter, x
R = parameter("R", "radius", unit="m")
b = parameter("b", "width", unit="m")
phi = parameter("phi", "slope", unit="rad")
"""
BODY = f'{HEAD}geometry = Geometry("body", g=x**2 / R)\n'

PROFILES = {
    "-x**2/R": "is not convex, because its curvature is negative",
    "b*(1 - cos(x/b))": "contains cos(x/b), a function of x that is not supported",
    "phi*Abs(x) - phi*Max(0, x - b)": "its slope decreases at",
    "EulerGamma*b*cosh(x/b)": "contains EulerGamma, which the proofs cannot compute",
    "zeta(phi + 2)*x**2/R": "contains zeta(phi + 2), which the proofs cannot compute",
    "x**2/Symbol('r')": "contains the symbol 'r'",
    "Symbol('x')**2/R": "write `from derive import x`",
    "'x**2/R'": "not an expression",
}
"""g(x) in a geometry file, and a part of the message."""

FILES = {
    "geometry = (": "SyntaxError",
    "import no_such_module_anywhere": "ModuleNotFoundError",
    "from derive import Geometry\ngeometry = Geometry('body')": "TypeError",
    "raise ValueError('one\\ntwo')": "ValueError: one;",
    "def f(): f()\nf()": "RecursionError",
    "import sys\nsys.exit(0)": "SystemExit",
    "import this_file_is_fine\0": "null bytes",
    "": "bad.py: it does not define `geometry`",
    "from derive import x\ngeometry = x**2": "does not define `geometry`",
    f"{HEAD}c = parameter('c_1', 'width', unit='furlong')": (
        "unit 'furlong': 'furlong' is not a known unit; write a product of powers"
    ),
    f"{HEAD}c = parameter('c_1', 'width', unit=len)": "it is not a string",
    f"{HEAD}E_star = parameter('E_star', 'modulus')": "'E_star' is reserved by the theory",
    f"{HEAD}geometry = Geometry('two words', g=x**2 / R)": "'two words'",
    f"{HEAD}geometry = Geometry('[red]:bug:[/]', g=x**2 / R)": "'[red]:bug:[/]'",
}
"""Files without a body, and a part of the message."""

COMMANDS = {
    "nope": "nope",
    "show": "NAME",
    "show hertz --nope": "--nope",
    "generate --jobs 0": "--jobs",
    "show catenary --limit 0": "'--limit': 0 is not a finite number above zero",
    "show hertz --slip 0": "--slip",
    "show hertz --code c --latex": "--latex",
    "show hertz --html --slip 2": "cannot be combined",
    "show hertz --all --html": "give either NAME",
    "show hertz --out x.html": "--all and --out require --html",
    "show --all": "--all and --out require --html",
    "show hertz --slip 2 --latex": "--slip",
    "show hertz --code perl": "'c', 'fortran', 'javascript', 'julia', 'matlab'",
    "show nowhere.py": "nowhere.py: there is no such file; a geometry file is a Python file",
    "show .": "it is a directory",
    "show ''": "there is no geometry ''",
    "generate '' --out n": "there is no geometry ''",
    "check ''": "'[FILE]': it is empty: give the path of a file or directory",
    "check --html ''": "'--html': it is empty",
    "edge '' --f 0.5": "'FILE': it is empty",
    "check 'no\x1b[31m\nsuch'": r"'[FILE]': 'no\x1b[31m\nsuch' contains a control character",
    "show mine.py": "a directory",
    f"show {'a' * 300}": "a" * 300,
    "show sphere": "there is no geometry 'sphere'; the library contains",
    "show '[red]:bug:[/]'": "[red]:bug:[/]",
    "show body.txt": "not a Python file",
    "show bytes.py": "bytes.py",
    "generate hertz sphere": "sphere",
    "generate body.py": "body.py is not in the library, and the package `generated` contains only",
    "generate body.py --check": "--out",
    "generate body.py --out mine": "notes.txt",
    "generate hertz --out .": "which was not written by `derive`; nothing was written",
    "generate body.py --out notes.txt": "is not a directory",
    f"generate body.py --out {'a' * 300}": "too long",
    "new blunt \"(lambda: open('X', 'w'))()\"": "lambda is not allowed",
    "new blunt y**2/(2*R)": "it does not contain x, only parameters (y, R)",
    "new blunt 'x**2/R + b - b'": "cancels out",
    "new blunt 10*x**2": "by a parameter, such as R in",
    "new blunt phi*x**2/R": "the units of R, phi are not determined",
    "new blunt x**2/R --unit b=m": "g(x) has no parameter 'b'; its parameters are R; write --unit",
    "new blunt x**2/R --meaning R": "such as --meaning R=radius",
    "new blunt x**2/R --unit 'R=m**(1/0)'": "write a product of powers",
    "new blunt x**2/R --unit R=m --unit R=m": "a second time",
    "new blunt x**2/R --out nowhere/": "is not a directory; nothing was written: a path",
    "check --html nowhere/page.html": "nowhere is not a directory; nothing was written",
    "check none.tex --draft nowhere/new.toml": "nowhere is not a directory; nothing was written",
    "check none.tex --draft notes.txt": "notes.txt already exists; nothing was written",
    "show hertz --html --out notes.txt": "notes.txt exists and was not made by `derive`",
    "show hertz --html --out mine": "mine is a directory",
    f"show hertz --html --out {'a' * 300}": "too long",
    "show --all --html --out mine": "contains 'notes.txt'",
    "new ../body x**2/R": "name of a module",
    "new contact x**2/R": "reserved by the theory",
    "new hertz x**2/R": "in the library",
    "new sympy x**2/R": "hide",
    "new blunt": "Missing argument",
    f"new many {'+'.join(f'x**2/R{i}' for i in range(150))}": "has 150 parameters, and at most 40",
}
"""Commands, and a part of the message."""

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

WITHOUT_MEASURE = {
    "x [m], p [Pa]\n" + "1" * 10**6 + ", 2\n": "characters; at most 20000",
    ", ".join(f"c{i}" for i in range(10**5)) + "\n1, 2\n": "characters; at most 20000",
    "x [m], p [Pa]\n" + "".join(f"{i}, 1\n" for i in range(30_000)): "30000 nodes",
    "body = { g = 'exp(exp(exp(exp(x/R))))*R - exp(exp(exp(x/R)))*R' }\n[[claims]]\nlabel = 'it'\n"
    "printed = 'load(a, a) = 1'\n": "body: g(x): the stage 'reading' crashed",
    f"{'.'.join('a' * 5000)} = 1\n": "the key 'a' is unknown",
}
"""Tables and claims, and a part of the message; the abort of one ends another process."""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, in_this_process: None) -> Path:
    """A current directory with files; a geometry file runs without the seconds of a process."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(derive.pipeline, "USER_FILE_LIMITS", None)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "body.txt").write_text("no Python")
    (tmp_path / "bytes.py").write_bytes(b"\xff\xfe\x00geometry")
    (tmp_path / "mine.py").mkdir()
    (tmp_path / "body.py").write_text(BODY)
    return tmp_path


def refused_here(here: Path, *arguments: str) -> str:
    """The message of a command that is refused and writes nothing."""
    before = contents(here)
    result = run(*arguments)
    assert contents(here) == before
    assert isinstance(result.exception, SystemExit), result.exception
    assert (result.exit_code, result.stdout) == (2, ""), result.output
    assert f"\n{result.stderr}".count("\nError: ") == 1 and "Traceback" not in result.stderr
    return result.stderr


def refused_file(here: Path, text: str) -> str:
    (here / "bad.py").write_text(text)
    return refused_here(here, "generate", "bad.py", "--out", "new")


@pytest.mark.parametrize("g", PROFILES)
def test_a_file_whose_profile_is_refused(g: str, here: Path) -> None:
    assert PROFILES[g] in refused_file(here, f'{HEAD}geometry = Geometry("bad", g={g})\n')


@pytest.mark.parametrize("text", FILES, ids=FILES.values())
def test_a_file_that_holds_no_body(text: str, here: Path) -> None:
    assert FILES[text] in refused_file(here, text)


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: repr(command[:50]))
def test_a_command_that_will_not_do(command: str, here: Path) -> None:
    told = refused_here(here, *shlex.split(command))
    assert COMMANDS[command] in told


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("[bold]x", ["    [bold]x", "    ^", "allowed in g(x): "]),
        ("x*\udc80", ["    x*?", "      ^", "allowed in g(x): "]),
    ],
)
def test_a_text_is_shown_with_a_caret_under_its_mistake(
    text: str, lines: list[str], here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also when the refusal comes back from another process."""
    told = refused_here(here, "new", "blunt", text)
    assert all(map(str.startswith, told.splitlines()[1:], lines)), told
    if "*" in text:
        monkeypatch.setattr(derive.command.new_geometry, "in_processes", in_processes)
        assert refused_here(here, "new", "blunt", text) == told


@pytest.mark.slow
@pytest.mark.parametrize("text", WITHOUT_MEASURE, ids=WITHOUT_MEASURE.values())
def test_a_table_or_claims_without_measure(text: str, here: Path) -> None:
    (here / "file").write_text(text)
    command = ["check", "file"] if " = " in text else ["edge", "file", "--f", "0.5"]
    assert WITHOUT_MEASURE[text] in refused_here(here, *command)


@pytest.mark.parametrize("target", ["notes.txt/new", "a/b/new"])
@pytest.mark.parametrize("command", TARGETS)
def test_a_target_that_cannot_be_written_is_refused_before_the_input_is_read(
    command: str, target: str, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One lies below a file, and the folder of the other is read-only."""
    monkeypatch.setattr("os.access", lambda *_: False)
    message = refused_here(here, *command.split(), target)
    assert "new cannot be written (" in message
    assert ("Not a directory" if "notes" in target else "Permission denied") in message
