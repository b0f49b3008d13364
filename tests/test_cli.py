"""The commands: what they print, what they write, and with which status they leave."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from rich.console import Console

import derive.cache
import derive.cli
import derive.codegen.trial
import derive.parallel
import derive.pipeline
import derive.proof.prove
from derive.body import Body, by_form
from derive.cache import VARIABLE, key_of, program_digest, users_cache
from derive.cli import main
from derive.codegen.mark import MARK
from derive.derivation import derive_sheet
from derive.library import FOLDER, library, load_geometry
from derive.pipeline import DONE, GENERATED, KEPT, STAGES
from derive.proof.verdict import Proof, Verdict
from derive.sheet import FormulaSheet
from derive.view import summary
from tests.derive.bodies import assumed, sheet

ROOT = Path(__file__).parents[1]

CYLINDER = '''"""A cylinder of one's own."""
from derive import Geometry, parameter, x

radius = parameter("radius", "radius", unit="m")
geometry = Geometry("cylinder", g=x**2 / (2 * radius))
'''
HEAD = """from sympy import I, Piecewise, Symbol, exp, floor
from derive import Geometry, parameter, x
R = parameter("R", "radius", unit="m")
"""
FLAT_ROUNDED = """from sympy import Abs, Piecewise
from derive import Geometry, parameter, x
b = parameter("b", "half-width of the middle", unit="m")
R = parameter("R", "radius of curvature", unit="m")
beyond = Abs(x) - b
geometry = Geometry("flat_rounded", g=Piecewise((0, beyond <= 0), (beyond**2 / (2 * R), True)))
"""
FILES = {
    "cylinder.py": CYLINDER,
    "twin.py": CYLINDER.replace("2 * radius", "3 * radius"),
    "clash.py": CYLINDER.replace('"cylinder"', '"hertz"'),
    "syntax.py": "geometry = (",
    "raises.py": 'raise ValueError("no such body")',
    "lines.py": 'raise ValueError("one\\ntwo\\nthree")',
    "divides.py": "geometry = 1 / 0",
    "imports.py": "import no_such_module_anywhere",
    "recursion.py": "def f(): f()\nf()",
    "quits.py": "import sys\nsys.exit(0)",
    "interrupts.py": "raise KeyboardInterrupt",
    "without.py": '"""Nothing here."""\n',
    "number.py": "geometry = 3",
    "unit.py": HEAD + 'b = parameter("b", "width", unit="furlong")\n',
    "concave.py": HEAD + 'geometry = Geometry("body", g=-x**2 / R)\n',
    "straight.py": HEAD + 'geometry = Geometry("body", g=x)\n',
    "jumps.py": HEAD + 'geometry = Geometry("body", g=Piecewise((0, x < 0), (R, True)))\n',
    "floor.py": HEAD + 'geometry = Geometry("body", g=R * floor(x / R))\n',
    "complex.py": HEAD + 'geometry = Geometry("body", g=I * x**2 / R)\n',
    "stray.py": HEAD + 'geometry = Geometry("body", g=x**2 / Symbol("r"))\n',
    "dimension.py": HEAD + 'geometry = Geometry("body", g=x**2)\n',
    "astext.py": HEAD + 'geometry = Geometry("body", g="x**2/R")\n',
    "spaces.py": HEAD + 'geometry = Geometry("two words", g=x**2 / R)\n',
    "keyword.py": HEAD + 'geometry = Geometry("class", g=x**2 / R)\n',
    "taken.py": HEAD + 'E_star = parameter("E_star", "modulus")\n',
    "markup.py": HEAD + 'geometry = Geometry("[red]:bug:[/]", g=x**2 / R)\n',
    "body.txt": CYLINDER,
    "notes.txt": "mine",
}

# Arguments, and a word of the message.
BAD = [
    (("show", "sphere"), "sphere"),
    (("show", ":bug:"), ":bug:"),
    (("show", "[red]x[/]"), "[red]x[/]"),
    (("show", "nowhere.py"), "no such file"),
    (("show", "."), "a directory"),
    (("show", ""), "a directory"),
    (("show", "a" * 300), "a" * 300),
    (("show", "body.txt"), "no Python file"),
    (("show", "folder.py"), "a directory"),
    (("show", "bytes.py"), "bytes.py"),
    (("show", "syntax.py"), "SyntaxError"),
    (("show", "raises.py"), "ValueError: no such body"),
    (("show", "lines.py"), "ValueError"),
    (("show", "divides.py"), "ZeroDivisionError"),
    (("show", "imports.py"), "no_such_module_anywhere"),
    (("show", "recursion.py"), "RecursionError"),
    (("show", "quits.py"), "quits.py"),
    (("show", "interrupts.py"), "interrupts.py: KeyboardInterrupt;"),
    (("generate", "interrupts.py", "--out", "new"), "interrupts.py: KeyboardInterrupt;"),
    (("show", "without.py"), "defines no `geometry`"),
    (("show", "number.py"), "defines no `geometry`"),
    (("show", "unit.py"), "furlong"),
    (("show", "concave.py"), "not convex"),
    (("show", "straight.py"), "straight"),
    (("show", "jumps.py"), "jumps"),
    (("show", "floor.py"), "floor"),
    (("show", "complex.py"), "not real"),
    (("show", "stray.py"), "'r'"),
    (("show", "dimension.py"), "dimension"),
    (("show", "astext.py"), "no expression"),
    (("show", "spaces.py"), "two words"),
    (("show", "keyword.py"), "class"),
    (("show", "taken.py"), "E_star"),
    (("show", "markup.py"), "[red]:bug:[/]"),
    (("show", "concave.py", "--latex"), "not convex"),
    (("generate", "sphere"), "sphere"),
    (("generate", "hertz", "sphere"), "sphere"),
    (("generate", "nowhere.py"), "no such file"),
    (("generate", "cylinder.py"), "--out"),
    (("generate", "cylinder.py", "--check"), "--out"),
    (("generate", "concave.py", "--out", "new"), "not convex"),
    (("generate", "quits.py", "--out", "new"), "quits.py"),
    (("generate", "cylinder.py", "--out", "notes.txt"), "is no directory"),
    (("generate", "cylinder.py", "--out", "a" * 300), "too long"),
    (("show", "--all", "--html", "--out", "a" * 300), "too long"),
    (("generate", "cylinder.py", "--out", "notes.txt/new"), "new"),
    (("generate", "cylinder.py", "--out", "foreign"), "notes.txt"),
    (("generate", "cylinder.py", "--out", "foreign", "--check"), "notes.txt"),
    (("generate", "hertz", "--out", "."), "which was not generated"),
    (("generate", "cylinder.py", "twin.py", "--out", "new"), "two geometries are named 'cylinder'"),
    (("generate", "hertz", "clash.py", "--out", "new"), "two geometries are named 'hertz'"),
    (("generate", "cylinder.py", "twin.py", "--out", "new", "--check"), "two geometries"),
]
MISUSED = [
    (("--nope",), "--nope"),
    (("nope",), "nope"),
    (("show",), "NAME"),
    (("show", "hertz", "wedge"), "wedge"),
    (("show", "hertz", "--nope"), "--nope"),
    (("list", "hertz"), "hertz"),
    (("generate", "--out"), "--out"),
    (("generate", "--check=yes"), "--check"),
    (("generate", "--fresh=yes"), "--fresh"),
    (("generate", "--jobs"), "--jobs"),
    (("generate", "--jobs", "0"), "--jobs"),
    (("generate", "--jobs", "many"), "--jobs"),
]


def words(given: tuple[str, ...] | str) -> str:
    """Arguments and words as the name of a test."""
    return (given if isinstance(given, str) else " ".join(given))[:50]


def written(folder: Path) -> Path:
    """All files of the cases, good and bad."""
    for name, text in FILES.items():
        (folder / name).write_text(text)
    (folder / "bytes.py").write_bytes(b"\xff\xfe\x00geometry")
    (folder / "folder.py").mkdir()
    (folder / "foreign").mkdir()
    (folder / "foreign" / "notes.txt").write_text("mine")
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    files = (p for p in folder.rglob("*") if p.is_file() and "__pycache__" not in p.parts)
    return {str(p.relative_to(folder)): p.read_bytes() for p in files}


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty current directory."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def committed(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the package `generated` in its place."""
    copy = tmp_path_factory.mktemp("copy") / "generated"
    shutil.copytree(GENERATED, copy, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(derive.pipeline, "GENERATED", copy)
    return copy


@pytest.fixture
def unproven(monkeypatch: pytest.MonkeyPatch) -> None:
    """The pipeline without the seconds that its proofs take."""
    monkeypatch.setattr(derive.proof.prove, "prove_sheet", assumed)
    monkeypatch.setattr(derive.codegen.trial, "demand_right", lambda *_: None)


STUCK = (Path(__file__).parents[1] / "generated" / "full_stick.py").read_text(encoding="utf-8")


def body_of(sheet: FormulaSheet, text: str) -> Body:
    """A body without the seconds that its text takes."""
    verdicts = tuple((name, Verdict.PROVED) for name in sheet)
    proofs = tuple((name, "proved: a stand-in for a proof") for name in sheet)
    return Body(sheet.geometry.name, text, STUCK, 0.0, *by_form(sheet.is_closed), verdicts, proofs)


def of_library(name: str, text: str) -> Body:
    """A body of the library without the seconds of its derivation: its forms are the cylinder's."""
    return replace(body_of(sheet("hertz"), text), name=name)


@pytest.fixture
def built(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The pipeline with modules of the library as they are committed; what it was asked to build.

    In one process: another one would build in earnest.
    """
    texts = {name: (GENERATED / f"{name}.py").read_text() for name in library()}
    asked = []

    def build(source: str, report: Callable[[str, str], None], limit: float) -> Body:
        asked.append(source)
        for stage in STAGES:
            report(source, stage)
        if source in texts:
            return of_library(source, texts[source])
        made = derive_sheet(load_geometry(source))
        return body_of(made, f"{MARK}\n# {made.geometry.g}\n")

    monkeypatch.setattr(derive.pipeline, "build", build)
    monkeypatch.setattr(derive.parallel, "cores", lambda: 1)
    return asked


def run(*arguments: str) -> Result:
    return CliRunner().invoke(main, arguments)


def done(*arguments: str) -> str:
    """What a command prints that succeeds."""
    result = run(*arguments)
    assert result.exit_code == 0, result.output
    return result.stdout


def real(*arguments: str, cwd: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """The command in an interpreter of its own."""
    environment = os.environ | {"PYTHONPATH": str(ROOT)} | environment
    command = [sys.executable, "-m", "derive", *arguments]
    return subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True)


def lines(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.strip()]


# ------------------------------------------------------------------ list, show, help


@pytest.mark.parametrize("names", [("parabola_quartic", "wedge_parabola")], ids=len)
def test_a_narrow_list_cuts_no_name(
    names: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    from derive import load_geometry, view
    from derive.derivation import derive_law

    console = Console(width=70, record=True, file=StringIO())
    console.print(view.listing(derive_law(load_geometry(name)) for name in names))
    shown = console.export_text()
    assert all(f" {name} " in shown for name in names)


@pytest.mark.parametrize(
    "names", [("hertz", "power", "wedge"), pytest.param(library(), marks=pytest.mark.slow)], ids=len
)
def test_list_names_every_geometry_and_its_profile(
    names: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("derive.library.library", lambda: names)
    printed = done("list")
    assert all(name in printed for name in names)
    assert ("catenary" in printed) == ("catenary" in names)
    assert "x**2/(2*R)" in printed
    assert "phi*Abs(x)" in printed
    assert "closed form" in printed
    assert "numerical" in printed
    rows = {row.split()[1]: row for row in printed.splitlines() if len(row.split()) > 1}
    assert "│ forward by special functions │ forward in code, from (P, M)" in " ".join(
        rows["power"].split()
    )
    assert "special" not in rows["hertz"]


@pytest.mark.parametrize("module", ["derive", pytest.param("derive.cli", marks=pytest.mark.slow)])
def test_the_command_is_a_module_too(tmp_path: Path, module: str) -> None:
    command = [sys.executable, "-m", module, "new", "body", "x**2/R"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    ended = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    assert (tmp_path / "body.py").is_file()
    told = re.search("^See its formulas: +(.*) show body.py$", ended.stdout, re.M)
    assert told is not None
    again = f"{told[1]} new body x**2/R"
    ended = subprocess.run(again, shell=True, cwd=tmp_path, env=environment, capture_output=True)
    assert (ended.returncode, b"is there already" in ended.stderr) == (2, True), ended.stderr


@pytest.mark.parametrize(
    ("typed", "told"),
    [
        (".venv/bin/derive", ".venv/bin/derive"),
        ("derive", "derive"),
        ("{here}/.venv/bin/derive", ".venv/bin/derive"),
        ("{here}/on path/derive", "derive"),
        ("{else}/of mine/derive", "'{else}/of mine/derive'"),
        ("{else}/pytest/__main__.py", "derive"),
    ],
)
def test_advice_names_the_command_as_it_was_typed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, typed: str, told: str
) -> None:
    folders = {"here": tmp_path / "here", "else": tmp_path / "else"}
    on_path = folders["here"] / "on path"
    on_path.mkdir(parents=True)
    (on_path / "derive").write_text("#!/bin/sh\n")
    (on_path / "derive").chmod(0o755)
    (folders["here"] / ".venv").mkdir()
    monkeypatch.chdir(folders["here"])
    monkeypatch.setenv("PATH", str(on_path))
    monkeypatch.setattr(sys, "argv", [typed.format(**folders), "new"])
    (folders["here"] / "body.py").write_text(CYLINDER)
    told = told.format(**folders)
    refused = run("generate", "body.py")
    assert f"`{told} generate body.py --out my_package`" in refused.stderr
    assert f"See its formulas:    {told} show mine.py" in done("new", "mine", "x**2/R")
    assert f"Make a module of it: {told} generate" in done("new", "other", "x**2/R")


@pytest.fixture
def shown_unproven(monkeypatch: pytest.MonkeyPatch) -> None:
    """`derive show` without the seconds that its proofs take."""
    monkeypatch.setattr(derive.proof.prove, "prove_sheet", assumed)


@pytest.mark.usefixtures("shown_unproven")
def test_show_prints_every_formula_with_its_proof() -> None:
    printed = done("show", "hertz")
    assert all(name in printed for name in sheet("hertz"))
    assert "P(a, c) = pi*E_star*(a + c)**2/(16*R)" in printed
    assert "g(x) = x**2/(2*R)" in printed
    assert printed.count("proved: assumed by a test") == len(sheet("hertz"))


@pytest.mark.usefixtures("shown_unproven")
def test_show_latex_prints_one_display() -> None:
    printed = done("show", "hertz", "--latex")
    assert printed.startswith("\\begin{aligned}\n")
    assert printed.endswith("\\end{aligned}\n")
    assert printed.count("{") == printed.count("}")
    assert printed.count("&=") == len(sheet("hertz")) + 1
    assert printed.strip() == sheet("hertz").latex


@pytest.mark.usefixtures("shown_unproven")
def test_show_takes_a_file(here: Path) -> None:
    written(here)
    assert "cylinder: g(x) = x**2/(2*radius)" in done("show", "cylinder.py")
    assert "cylinder: g(x) = x**2/(2*radius)" in done("show", str(here / "cylinder.py"))


@pytest.mark.usefixtures("shown_unproven")
def test_a_formula_is_never_broken_where_no_terminal_is() -> None:
    """What a program reads stands on one line."""
    printed = done("show", "wedge")
    for name in sheet("wedge"):
        assert sheet("wedge").equation(name) in printed


@pytest.mark.slow
@pytest.mark.usefixtures("shown_unproven")
def test_a_long_formula_is_not_broken_either(here: Path) -> None:
    (here / "flat_rounded.py").write_text(FLAT_ROUNDED)
    printed = done("show", "flat_rounded.py")
    assert max(len(sheet("flat_rounded").equation(name)) for name in sheet("flat_rounded")) > 200
    for name in sheet("flat_rounded"):
        assert sheet("flat_rounded").equation(name) in printed


@pytest.mark.usefixtures("shown_unproven")
def test_show_prints_closed_forms_beside_the_integrals() -> None:
    printed = done("show", "catenary")
    assert "Closed forms stand behind the integrals" in printed
    assert "load_closed" in printed
    assert "besseli(1, (a + c)/(2*b))" in printed
    assert "Integral(" in printed


@pytest.mark.usefixtures("shown_unproven")
def test_a_limit_that_strikes_is_told() -> None:
    result = run("show", "catenary", "--limit", "1e-9")
    told = "No closed form found within 1e-09 s; its integrals stay."
    assert result.exit_code == 0
    assert result.stderr == f"catenary: {told}\n"
    assert told in result.stdout
    assert "load_closed" not in result.stdout
    assert run("show", "wedge", "--limit", "1e-9").stderr == ""


@pytest.mark.parametrize("seconds", ["-1", "0", "-0.0", "nan", "inf", "-inf", "1e999"])
@pytest.mark.parametrize("command", ["show", "generate"])
def test_a_limit_is_a_time_that_can_pass(command: str, seconds: str) -> None:
    result = run(command, "catenary", "--limit", seconds)
    assert result.exit_code == 2
    (message,) = lines(result.stderr)
    assert message.startswith(f"Error: --limit {float(seconds):g}: ")
    assert "such as --limit 20" in message


@pytest.mark.slow
def test_generate_tells_of_a_limit_that_struck(
    here: Path, unproven: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also when the body is kept from an earlier run; another limit looks again."""
    monkeypatch.setattr(derive.parallel, "cores", lambda: 1)
    told = "catenary: No closed form found within 1e-09 s; its integrals stay.\n"
    first = run("generate", "catenary", "--out", "made", "--limit", "1e-9")
    assert (first.exit_code, first.stderr) == (0, told)
    text = (here / "made" / "catenary.py").read_bytes()
    again = run("generate", "catenary", "--out", "made", "--limit", "1e-9")
    assert "kept" in again.stdout
    assert again.stderr == told
    third = run("generate", "catenary", "--out", "made")
    assert "kept" not in third.stdout
    assert "load_closed" in third.stdout
    assert third.stderr == ""
    assert (here / "made" / "catenary.py").read_bytes() == text


@pytest.mark.parametrize("command", [(), ("list",), ("show",), ("generate",)])
@pytest.mark.parametrize("option", ["--help", "-h"])
def test_help_is_given(command: tuple[str, ...], option: str) -> None:
    printed = done(*command, option)
    assert printed.startswith("Usage:")
    assert "Traceback" not in printed


def test_help_lists_the_commands() -> None:
    printed = done("--help")
    assert all(f"  {name} " in printed for name in ("list", "show", "generate"))


def test_the_version_is_told() -> None:
    assert done("--version").startswith("derive, version ")


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["generate", "--help"]])
def test_help_does_not_wait_for_sympy(arguments: list[str]) -> None:
    code = (
        "import sys\nfrom derive.cli import main\n"
        f"try:\n    main({arguments!r})\nexcept SystemExit as end:\n    assert not end.code\n"
        "late = {'sympy', 'mpmath', 'numpy', 'scipy', 'derive.pipeline'} & set(sys.modules)\n"
        "assert not late, late\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT, capture_output=True)


# ------------------------------------------------------------------ bad input


@pytest.mark.usefixtures("built")
@pytest.mark.parametrize(("arguments", "word"), BAD, ids=words)
def test_bad_input_is_answered_in_one_line(
    here: Path, arguments: tuple[str, ...], word: str
) -> None:
    written(here)
    before = contents(here)
    result = run(*arguments)
    assert result.exit_code == 2, result.output
    assert result.exception is None or isinstance(result.exception, SystemExit)
    message = lines(result.stderr)
    assert message[0].startswith("Error: ")
    assert word in message[0]
    assert len(message) == 1
    assert contents(here) == before
    assert not (here / "new").exists()


@pytest.mark.parametrize(("arguments", "word"), MISUSED, ids=words)
def test_a_misused_command_is_answered_with_its_usage(
    here: Path, arguments: tuple[str, ...], word: str
) -> None:
    result = run(*arguments)
    assert result.exit_code == 2
    assert isinstance(result.exception, SystemExit)
    assert [line.startswith("Error: ") for line in lines(result.stderr)].count(True) == 1
    assert word in lines(result.stderr)[-1]
    assert contents(here) == {}


def test_a_long_path_does_not_break_the_message(here: Path) -> None:
    folder = here / ("deep" * 20) / ("deeper" * 20)
    folder.mkdir(parents=True)
    (folder / "body.py").write_text("geometry = (")
    result = run("show", str(folder / "body.py"))
    assert result.exit_code == 2
    assert len(lines(result.stderr)) == 1
    assert str(folder / "body.py") in result.stderr


def test_a_profile_that_cannot_be_printed_is_bad_input(here: Path, unproven: None) -> None:
    """g(x) is convex and derived, but float64 ends at 1.8e308."""
    (here / "large.py").write_text(HEAD + 'geometry = Geometry("body", g=exp(999) * x**2 / R)\n')
    result = run("generate", "large.py", "--out", "new")
    assert isinstance(result.exception, SystemExit), result.exception
    assert result.exit_code == 2
    assert len(lines(result.stderr)) == 1
    assert "float64 has no number near exp(999)" in result.stderr
    assert not (here / "new").exists()


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("show", "sphere"), "sphere"),
        (("show", "syntax.py"), "SyntaxError"),
        (("show", "quits.py"), "quits.py"),
        (("show", "interrupts.py"), "interrupts.py"),
        (("generate", "cylinder.py"), "--out"),
        (("show",), "NAME"),
    ],
    ids=words,
)
def test_the_real_command_leaves_with_status_2_and_no_traceback(
    tmp_path: Path, arguments: tuple[str, ...], word: str
) -> None:
    before = contents(written(tmp_path))
    ended = real(*arguments, cwd=tmp_path)
    assert ended.returncode == 2, ended.stderr
    assert ended.stdout == ""
    assert "Traceback" not in ended.stderr
    assert word in lines(ended.stderr)[-1]
    assert contents(tmp_path) == before


# ------------------------------------------------------------------ a check that falls short


def without_proof(of: FormulaSheet) -> FormulaSheet:
    proof = Proof(Verdict.UNKNOWN, "no point drawn")
    return replace(of, formulas={name: replace(f, proof=proof) for name, f in of.items()})


def test_what_is_not_proven_is_not_generated(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(derive.proof.prove, "prove_sheet", without_proof)
    result = run("generate", "hertz", "--out", "new")
    assert result.exit_code == 1
    assert isinstance(result.exception, SystemExit)
    assert "tilt of 'hertz'" in result.stderr
    assert "no point drawn" in result.stderr
    assert contents(here) == {}


def test_what_is_not_proven_is_not_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(derive.proof.prove, "prove_sheet", without_proof)
    result = run("show", "hertz")
    assert isinstance(result.exception, SystemExit), result.exception
    assert result.exit_code == 1
    assert "tilt of 'hertz'" in result.stderr
    assert "P(a, c)" not in result.stdout


# ------------------------------------------------------------------ generate


@pytest.mark.slow
def test_the_committed_package_is_as_generated() -> None:
    """The whole path once more, in an interpreter of its own."""
    ended = real("generate", "--check", cwd=ROOT)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert "is as generated" in ended.stdout


LONELY = """
import sys
for name in ("sympy", "mpmath", "derive", "generated", "click", "rich", "ruff"):
    sys.modules[name] = None
from mine import cylinder
print(repr(float(cylinder.load(1.0, 1.0, E_star=4.0, radius=0.5))))
print(repr(float(cylinder.contact(2.0, 1.0, E_star=4.0, radius=0.5).alpha)))
"""


@pytest.mark.slow
def test_a_file_becomes_a_package_that_stands_alone(tmp_path: Path) -> None:
    """P = pi E* h^2/(16 R) = pi 4 4/8; alpha = M/(P R) = 1/(2/2)."""
    (tmp_path / "cylinder.py").write_text(CYLINDER)
    ended = real("generate", "cylinder.py", "--out", "mine", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "Wrote mine" in ended.stdout
    assert "Traceback" not in ended.stderr
    held = contents(tmp_path / "mine")
    assert {"__init__.py", "cylinder.py", "py.typed"} < held.keys()
    assert not any(str(tmp_path).encode() in text for text in held.values())
    (tmp_path / "cylinder.py").unlink()
    lonely = subprocess.run(
        [sys.executable, "-W", "error", "-c", LONELY],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    load, tilt = map(float, lonely.stdout.split())
    assert abs(load - 6.283185307179586) < 1e-14
    assert tilt == 1.0


@pytest.mark.usefixtures("built")
class TestGenerate:
    """`derive generate` around the pipeline."""

    def test_without_arguments_it_makes_the_package(self, committed: Path) -> None:
        before = contents(committed)
        shutil.rmtree(committed)
        printed = done("generate")
        assert "Wrote" in printed
        assert all(name in printed for name in library())
        assert contents(committed) == before

    def test_what_has_not_changed_is_not_written(self, committed: Path) -> None:
        before = {p: p.stat().st_mtime_ns for p in [committed, *committed.iterdir()]}
        assert "Nothing to change" in done("generate")
        assert {p: p.stat().st_mtime_ns for p in before} == before

    def test_a_module_that_is_not_wanted_any_more_goes(self, committed: Path) -> None:
        before = contents(committed)
        (committed / "old.py").write_text(f"{MARK}\nold = 1\n")
        done("generate")
        assert contents(committed) == before

    def test_one_name_leaves_the_other_modules_alone(self, committed: Path) -> None:
        before = contents(committed)
        (committed / "hertz.py").write_text(f"{MARK}\nold = 1\n")
        done("generate", "hertz")
        assert contents(committed) == before

    def test_a_name_given_twice_is_made_once(self, here: Path) -> None:
        done("generate", "hertz", "hertz", "--out", "new")
        assert "hertz.py" in contents(here / "new")

    def test_out_holds_what_was_asked_for_and_no_more(self, here: Path) -> None:
        done("generate", "hertz", "--out", "new")
        own = {n for n in contents(here / "new") if not n.startswith(("_", "runtime/"))}
        assert own == {"edge.py", "hertz.py", "full_stick.py", "py.typed"}

    def test_out_replaces_a_package_made_before(self, here: Path) -> None:
        done("generate", "hertz", "--out", "new")
        done("generate", "wedge", "--out", "new")
        assert "wedge.py" in contents(here / "new")
        assert "hertz.py" not in contents(here / "new")

    def test_files_and_names_go_into_one_package(self, here: Path) -> None:
        written(here)
        done("generate", "cylinder.py", "hertz", "--out", "new")
        assert {"cylinder.py", "hertz.py"} < contents(here / "new").keys()

    def test_out_may_be_the_current_directory_or_is_refused(self, here: Path) -> None:
        """A shell must not be left in a directory that was replaced under it."""
        result = run("generate", "hertz", "--out", ".")
        assert isinstance(result.exception, SystemExit | None), result.exception
        assert Path.cwd() == here
        if result.exit_code == 0:
            assert "hertz.py" in contents(here)
        else:
            assert result.exit_code == 2
            assert len(lines(result.stderr)) == 1

    def test_out_may_be_a_link_to_a_directory(self, here: Path) -> None:
        (here / "there").mkdir()
        (here / "link").symlink_to(here / "there")
        done("generate", "hertz", "--out", "link")
        assert (here / "link").is_symlink()
        assert "hertz.py" in contents(here / "there")

    @pytest.mark.parametrize("out", ["link", "link/deeper"])
    def test_out_through_a_link_to_nothing_is_refused(self, here: Path, out: str) -> None:
        (here / "link").symlink_to(here / "there")
        result = run("generate", "hertz", "--out", out)
        assert result.exit_code == 2
        assert "'link', a link to nothing" in result.stderr
        assert len(lines(result.stderr)) == 1
        assert not (here / "there").exists()

    def test_the_library_is_not_needed_in_the_current_directory(self, here: Path) -> None:
        (here / "hertz").mkdir()
        (here / "hertz.py").write_text("geometry = (")
        done("generate", "hertz", "--out", "new")


@pytest.mark.usefixtures("built")
class TestCheck:
    """`derive generate --check`."""

    def test_it_passes_on_what_was_generated(self, committed: Path) -> None:
        assert "is as generated" in done("generate", "--check")

    @pytest.mark.enough("__init__.py", "py.typed", "wedge.py")
    @pytest.mark.parametrize("name", sorted(p.name for p in GENERATED.iterdir() if p.is_file()))
    @pytest.mark.slow
    def test_it_fails_and_names_a_file_of_which_a_byte_is_changed(
        self, committed: Path, name: str
    ) -> None:
        path = committed / name
        text = bytearray(path.read_bytes() or b"  ")
        text[len(text) // 2] ^= 1
        path.write_bytes(text)
        self.falls_short(committed, name)

    def test_it_fails_and_names_a_file_that_is_missing(self, committed: Path) -> None:
        (committed / "wedge.py").unlink()
        self.falls_short(committed, "wedge.py")

    @pytest.mark.parametrize("name", ["old.py", "notes.txt", "_extra.py"])
    def test_it_fails_and_names_a_file_that_is_not_generated(
        self, committed: Path, name: str
    ) -> None:
        (committed / name).write_text(f"{MARK}\n")
        self.falls_short(committed, name)

    def falls_short(self, committed: Path, name: str) -> None:
        before = contents(committed)
        result = run("generate", "--check")
        assert result.exit_code == 1
        assert isinstance(result.exception, SystemExit)
        assert name in result.stdout
        others = {p.name for p in committed.glob("*.py")} - {name}
        named = {line.partition(": ")[0] for line in lines(result.stdout)}
        assert not named & others
        assert "derive generate" in result.stdout
        assert contents(committed) == before

    def test_it_shows_what_changed(self, committed: Path) -> None:
        path = committed / "hertz.py"
        path.write_text(path.read_text() + "mine = 1\n")
        assert "-mine = 1" in run("generate", "--check").stdout

    def test_one_name_is_checked_against_the_whole_package(self, committed: Path) -> None:
        assert run("generate", "hertz", "--check").exit_code == 0
        (committed / "hertz.py").write_text(f"{MARK}\n")
        assert run("generate", "hertz", "--check").exit_code == 1

    def test_a_directory_of_one_s_own_is_checked(self, here: Path) -> None:
        done("generate", "hertz", "--out", "new")
        assert run("generate", "hertz", "--out", "new", "--check").exit_code == 0
        (here / "new" / "hertz.py").write_text(f"{MARK}\n")
        result = run("generate", "hertz", "--out", "new", "--check")
        assert result.exit_code == 1
        assert "hertz.py" in result.stdout
        assert "derive generate hertz --out new" in result.stdout

    def test_an_absent_directory_falls_short_and_stays_absent(self, here: Path) -> None:
        result = run("generate", "hertz", "--out", "new", "--check")
        assert result.exit_code == 1
        assert "hertz.py" in result.stdout
        assert contents(here) == {}


# ------------------------------------------------------------------ what an earlier run built


def keep(name: str, text: str) -> None:
    """Put a text where the next run finds it for a body of the library."""
    key = key_of(FOLDER / f"{name}.py", f"derive/geometries/{name}.py", program_digest())
    assert key is not None
    users_cache().put(key, of_library(name, text))


def keep_the_library() -> None:
    for name in library():
        keep(name, (GENERATED / f"{name}.py").read_text())


WRONG = f"{MARK}\nwrong = 1\n"


class TestKept:
    """`derive generate` a second time."""

    def test_nothing_is_built_again(self, committed: Path, built: list[str]) -> None:
        assert "kept" not in done("generate")
        assert built == [*library()]
        printed = done("generate")
        assert built == [*library()]
        assert printed.count("kept") == len(library())
        assert "Nothing to change" in printed

    def test_what_was_lost_is_written_again(self, committed: Path, built: list[str]) -> None:
        before = contents(committed)
        done("generate")
        shutil.rmtree(committed)
        assert "Wrote" in done("generate")
        assert contents(committed) == before
        assert built == [*library()]

    def test_only_what_changed_is_built_again(self, here: Path, built: list[str]) -> None:
        written(here)
        sources = ("hertz", "cylinder.py", "wedge")
        done("generate", *sources, "--out", "new")
        (here / "cylinder.py").write_text(FILES["twin.py"])
        printed = done("generate", *sources, "--out", "new")
        assert built == [*sources, "cylinder.py"]
        assert printed.count("kept") == 2
        assert "3*radius" in (here / "new" / "cylinder.py").read_text()

    def test_fresh_builds_everything(self, committed: Path, built: list[str]) -> None:
        keep("hertz", WRONG)
        assert "kept" not in done("generate", "--fresh")
        assert built == [*library()]
        assert "kept" in done("generate")  # what was built is kept in its place
        assert run("generate", "--check").exit_code == 0

    def test_without_a_cache_everything_is_built(
        self, committed: Path, built: list[str], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setenv(VARIABLE, "")
        done("generate")
        done("generate")
        assert built == [*library()] * 2

    @pytest.mark.parametrize("name", ["file", "file/below"])
    def test_a_cache_that_cannot_be_written_is_no_error(
        self, here: Path, built: list[str], monkeypatch: pytest.MonkeyPatch, name: str
    ) -> None:
        (here / "file").write_text("mine")
        monkeypatch.setenv(VARIABLE, str(here / name))
        done("generate", "hertz", "--out", "new")
        done("generate", "hertz", "--out", "new")
        assert built == ["hertz"] * 2

    def test_a_file_that_imports_another_is_always_built(
        self, here: Path, built: list[str], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.syspath_prepend(here)
        (here / "shared_by_bodies.py").write_text("factor = 2\n")
        text = CYLINDER.replace("(2 *", "(factor *") + "\n"
        (here / "own.py").write_text(f"from shared_by_bodies import factor\n{text}")
        done("generate", "own.py", "--out", "new")
        monkeypatch.delitem(sys.modules, "shared_by_bodies")
        (here / "shared_by_bodies.py").write_text("factor = 12\n")
        done("generate", "own.py", "--out", "new")
        assert built == ["own.py"] * 2
        assert "12*radius" in (here / "new" / "cylinder.py").read_text()

    def test_bad_input_is_told_again(self, here: Path, built: list[str]) -> None:
        written(here)
        first = run("generate", "concave.py", "--out", "new")
        again = run("generate", "concave.py", "--out", "new")
        assert (first.exit_code, again.exit_code) == (2, 2)
        assert first.stderr == again.stderr

    def test_a_name_that_is_taken_by_what_is_kept_is_refused(
        self, here: Path, built: list[str]
    ) -> None:
        written(here)
        done("generate", "cylinder.py", "--out", "new")
        done("generate", "twin.py", "--out", "new")
        result = run("generate", "cylinder.py", "twin.py", "--out", "new")
        assert result.exit_code == 2
        assert "two geometries are named 'cylinder'" in result.stderr


class TestPoisoned:
    """A cache that holds what was never built: `generate` cannot know, `--check` does not ask."""

    def test_generate_takes_it(self, committed: Path, built: list[str]) -> None:
        keep("hertz", WRONG)
        done("generate")
        assert (committed / "hertz.py").read_text() == WRONG

    def test_check_reports_what_came_of_it(self, committed: Path, built: list[str]) -> None:
        keep("hertz", WRONG)
        done("generate")
        result = run("generate", "--check")
        assert result.exit_code == 1
        assert "hertz.py: changed" in result.stdout
        assert "-wrong = 1" in result.stdout
        assert "wedge.py" not in result.stdout

    def test_check_passes_on_what_is_right(self, committed: Path, built: list[str]) -> None:
        keep("hertz", WRONG)
        assert "is as generated" in done("generate", "--check")
        assert built == [*library()]

    def test_generate_is_right_after_a_check(self, committed: Path, built: list[str]) -> None:
        """As the check says: update with derive generate."""
        before = contents(committed)
        keep("hertz", WRONG)
        done("generate")
        run("generate", "--check")
        done("generate")
        assert contents(committed) == before

    def test_check_never_opens_it(
        self, committed: Path, built: list[str], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def refuse(*_: object) -> None:
            raise AssertionError("the cache was read")

        monkeypatch.setattr(derive.cache.Cache, "get", refuse)
        assert "is as generated" in done("generate", "--check")


def test_nothing_changed_builds_nothing(tmp_path: Path) -> None:
    """The real command with the whole library."""
    keep_the_library()
    assert real("generate", "--out", "package", cwd=tmp_path).returncode == 0
    ended = real("generate", "--out", "package", cwd=tmp_path)
    assert "Nothing to change in package" in ended.stdout
    assert ended.stdout.count("kept") == len(library())


def test_the_table_says_what_was_built_when() -> None:
    fresh = body_of(sheet("hertz"), "")
    shown = [list(summary([body]).columns[-1].cells) for body in (fresh, replace(fresh, kept=True))]
    assert shown == [["0.0 s"], ["kept"]]


# ------------------------------------------------------------------ several processes

UNPROVEN = """
import derive.proof.numerical
from derive.errors import NotProven

def refuse(*_):
    raise NotProven("tilt of 'cylinder': refused by a test")

derive.proof.numerical.NumericalRoutes.__init__ = refuse
"""
WAITS = f"""import os, time
from pathlib import Path
Path("waits", str(os.getpid())).touch()
time.sleep(600)
{CYLINDER}"""


@pytest.mark.slow
@pytest.mark.parametrize(
    "bad",
    [
        "concave.py",
        *(
            pytest.param(bad, marks=pytest.mark.slow)
            for bad in ("syntax.py", "unit.py", "nowhere.py", "zeta")
        ),
    ],
)
def test_bad_input_is_told_by_several_processes_as_by_one(here: Path, bad: str) -> None:
    """The other body is not waited for."""
    written(here)
    (here / "waits").mkdir()
    (here / "waits.py").write_text(WAITS)
    before = contents(here)
    one = run("generate", bad, "hertz", "--out", "new", "--jobs", "1")
    began = time.perf_counter()
    two = run("generate", "waits.py", bad, "wedge", "--out", "new", "--jobs", "2")
    assert time.perf_counter() - began < 60
    assert (one.exit_code, two.exit_code) == (2, 2), two.output
    assert one.stderr == two.stderr
    assert len(lines(two.stderr)) == 1
    assert {k: v for k, v in contents(here).items() if not k.startswith("waits/")} == before


@pytest.mark.slow
def test_what_is_not_proven_in_a_process_is_not_generated(here: Path) -> None:
    (here / "waits").mkdir()
    (here / "waits.py").write_text(WAITS)
    (here / "refused.py").write_text(UNPROVEN + CYLINDER)
    result = run("generate", "waits.py", "refused.py", "--out", "new", "--jobs", "2")
    assert result.exit_code == 1
    assert isinstance(result.exception, SystemExit)
    assert result.stderr == "Not proven: tilt of 'cylinder': refused by a test\n"
    assert not (here / "new").exists()


def test_a_process_that_is_lost_is_told_in_one_line(here: Path) -> None:
    (here / "lost.py").write_text("import os\nos._exit(1)\n")
    (here / "cylinder.py").write_text(CYLINDER)
    result = run("generate", "lost.py", "cylinder.py", "--out", "new", "--jobs", "2")
    assert result.exit_code == 2
    assert "--jobs 1" in result.stderr
    assert len(lines(result.stderr)) == 1
    assert not (here / "new").exists()


INTERRUPTIBLE = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # even where the tests run in background
from derive.cli import main
main(["generate", "waits.py", "waits_too.py", "hertz", "--out", "new", "--jobs", "2"])
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "killpg"), reason="Ctrl-C is sent to a group of processes")
def test_ctrl_c_ends_every_process_and_writes_nothing(here: Path) -> None:
    """Both processes are in the middle of their bodies."""
    (here / "waits").mkdir()
    for name in ("waits.py", "waits_too.py"):
        (here / name).write_text(WAITS)
    before = sorted(p.name for p in here.iterdir())
    started = subprocess.Popen(
        [sys.executable, "-c", INTERRUPTIBLE],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    until = time.monotonic() + 60
    while len([*(here / "waits").iterdir()]) < 2 and time.monotonic() < until:
        time.sleep(0.05)
    os.killpg(started.pid, signal.SIGINT)
    stdout, stderr = started.communicate(timeout=60)
    assert started.returncode == 1
    assert stdout == ""
    assert stderr.split() == ["Aborted!"]
    assert sorted(p.name for p in here.iterdir()) == before
    for pid in (here / "waits").iterdir():
        with pytest.raises(ProcessLookupError):
            os.kill(int(pid.name), 0)


# ------------------------------------------------------------------ the bar


def test_the_bar_counts_stages_of_all_bodies(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[Mapping[str, object]] = []
    monkeypatch.setattr("rich.progress.Progress.update", lambda bar, task, **now: told.append(now))
    with derive.cli._progress(3, STAGES) as step:
        for body, stage in [
            ("a", KEPT),
            ("b", STAGES[0]),
            ("c", STAGES[0]),
            ("b", STAGES[3]),
            ("c", DONE),
            ("b", DONE),
        ]:
            step(body, stage)
    assert [now["completed"] for now in told] == [6, 6, 6, 9, 15, 18]
    assert [now["description"] for now in told][1:4] == [
        "b: reading g(x)",
        "c: reading g(x), 1 more at work",
        "b: proving, 1 more at work",
    ]


@pytest.mark.parametrize("variable", ["FORCE_COLOR", "TTY_COMPATIBLE"])
def test_what_moves_is_left_out_of_a_pipe(
    here: Path,
    variable: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Spinner and bar, however colours are asked for."""
    monkeypatch.setenv(variable, "1")
    done = run("new", "body", "x**2/R")
    assert (done.exit_code, done.stderr) == (0, "")
    with derive.cli._progress(1, STAGES) as step:
        step("a", STAGES[0])
    assert capsys.readouterr().err == ""


class TestSlip:
    """`derive show NAME --slip ORDER`."""

    def test_it_prints_the_terms_of_both_edges(self) -> None:
        done = CliRunner().invoke(main, ["show", "hertz", "--slip", "2"])
        lines = done.output.splitlines()
        assert done.exit_code == 0
        assert [line.split(":")[0] for line in lines] == [
            *(f"d_{side}, order {order}" for side in ("left", "right") for order in (1, 2)),
            "kappa_left, kappa_right",
        ]
        assert "kappa_left" in lines[0]

    @pytest.mark.parametrize(
        ("name", "order"), [("hertz", "0"), ("hertz", "x"), ("hyperbola", "3")]
    )
    def test_an_order_that_there_is_not(self, name: str, order: str) -> None:
        done = CliRunner().invoke(main, ["show", name, "--slip", order])
        assert done.exit_code == 2
        assert "--slip" in done.output
