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
import derive.codegen.trial
import derive.parallel
import derive.pipeline
import derive.proof.prove
import derive.terminal
from derive.body import Body, by_form
from derive.cli import main
from derive.codegen.mark import MARK
from derive.derivation import derive_law, derive_sheet
from derive.library import library, load_geometry
from derive.parallel import Bounds
from derive.pipeline import DONE, GENERATED, KEPT, STAGES
from derive.proof.verdict import Proof, Verdict
from derive.sheet import FormulaSheet
from derive.view import listing, summary
from tests.derive.bodies import assumed, sheet

ROOT = Path(__file__).parents[1]

CYLINDER = '''"""A cylinder of one's own."""
from derive import Geometry, parameter, x

radius = parameter("radius", "radius", unit="m")
geometry = Geometry("cylinder", g=x**2 / (2 * radius))
'''


def contents(folder: Path) -> dict[str, bytes]:
    files = (p for p in folder.rglob("*") if p.is_file() and "__pycache__" not in p.parts)
    return {str(p.relative_to(folder)): p.read_bytes() for p in files}


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty current directory."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """No line about work that takes long, however slow the machine is."""
    monkeypatch.setattr(derive.terminal, "PATIENCE", 600.0)


@pytest.fixture
def committed(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the package `generated` in its place."""
    copy = tmp_path_factory.mktemp("copy") / "generated"
    shutil.copytree(GENERATED, copy, ignore=shutil.ignore_patterns("__pycache__"))
    (copy.parent / "pyproject.toml").touch()  # a clone, and no installed package
    monkeypatch.setattr(derive.pipeline, "GENERATED", copy)
    return copy


@pytest.fixture
def unproven(monkeypatch: pytest.MonkeyPatch) -> None:
    """The pipeline without the seconds that its proofs take."""
    monkeypatch.setattr(derive.proof.prove, "prove_sheet", assumed)
    monkeypatch.setattr(derive.codegen.trial, "demand_right", lambda *_: None)
    monkeypatch.setattr(derive.pipeline, "STRANGERS", None)  # another process would know of neither


STUCK = (Path(__file__).parents[1] / "generated" / "full_stick.py").read_text(encoding="utf-8")


def body_of(sheet: FormulaSheet, text: str) -> Body:
    """A body without the seconds that its text takes."""
    verdicts = tuple((name, Verdict.PROVEN) for name in sheet)
    proofs = tuple((name, "proven: a stand-in for a proof") for name in sheet)
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


NAMES = ("hertz", "parabola_quartic", "power", "wedge", "wedge_parabola")


def test_list_names_every_geometry_and_its_profile(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("derive.library.library", lambda: NAMES)
    printed = done("list")
    assert "x**2/(2*R)" in printed
    assert "phi*Abs(x)" in printed
    rows = {row.split()[1]: row for row in printed.splitlines() if len(row.split()) > 1}
    assert rows.keys() >= {*NAMES}
    assert "forward by special functions │ forward in code, from (P, M)" in " ".join(
        rows["power"].split()
    )
    assert "closed form" in printed and "special" not in rows["hertz"]


def test_a_narrow_list_cuts_no_name() -> None:
    console = Console(width=70, record=True, file=StringIO())
    console.print(listing(derive_law(load_geometry(name)) for name in NAMES))
    shown = console.export_text()
    assert all(f" {name} " in shown for name in NAMES)


def test_the_command_is_a_module_too(tmp_path: Path) -> None:
    """And it advises to go on in the same way."""
    ended = real("new", "body", "x**2/R", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    told = re.search("^See its formulas: +(.*) show body.py$", ended.stdout, re.M)
    assert told is not None
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    again = f"{told[1]} new body x**2/R"
    ended = subprocess.run(
        again, shell=True, cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert (ended.returncode, ended.stdout) == (2, "")
    assert "already exists" in ended.stderr and "Traceback" not in ended.stderr


@pytest.mark.parametrize(
    ("typed", "told"),
    [
        (".venv/bin/derive", ".venv/bin/derive"),
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
    monkeypatch.setattr(derive.pipeline, "STRANGERS", None)  # another process would not know


@pytest.mark.usefixtures("shown_unproven")
def test_show_prints_every_formula_with_its_proof() -> None:
    printed = done("show", "hertz")
    assert all(name in printed for name in sheet("hertz"))
    assert "P(a, c) = pi*E_star*(a + c)**2/(16*R)" in printed
    assert "g(x) = x**2/(2*R)" in printed
    assert printed.count("proven: assumed by a test") == len(sheet("hertz"))


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
    (here / "cylinder.py").write_text(CYLINDER)
    assert "cylinder: g(x) = x**2/(2*radius)" in done("show", str(here / "cylinder.py"))


FORMS = [(), ("--latex",), ("--code", "c"), ("--slip", "1"), ("--html",)]


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS, ids=" ".join)
def test_show_refuses_a_file_that_ends_its_process(here: Path, form: tuple[str, ...]) -> None:
    """As a number does that is too large for the library under SymPy."""
    (here / "ends.py").write_text(f"import os\nos.abort()\n{CYLINDER}")
    result = run("show", "ends.py", *form)
    assert result.exit_code == 2
    (message,) = lines(result.stderr)
    assert "ends.py: the stage 'reading g(x)' made its process fail" in message
    assert contents(here).keys() == {"ends.py"}


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS, ids=" ".join)
def test_show_does_not_wait_for_a_file_without_end(
    here: Path, monkeypatch: pytest.MonkeyPatch, form: tuple[str, ...]
) -> None:
    monkeypatch.setattr(derive.pipeline, "STRANGERS", Bounds(60, 4, {STAGES[0]: 1}))
    (here / "loop.py").write_text("while True: pass\n")
    result = run("show", "loop.py", *form)
    assert result.exit_code == 2
    (message,) = lines(result.stderr)
    assert "loop.py: the stage 'reading g(x)' took longer than its limit of 1 s" in message


@pytest.mark.slow
def test_show_prints_the_same_of_a_file_as_of_the_library(here: Path) -> None:
    shutil.copy(ROOT / "derive" / "geometries" / "hertz.py", here)
    for form in [(), ("--latex",), ("--code", "C"), ("--slip", "1")]:
        assert done("show", "hertz.py", *form) == done("show", "hertz", *form)
    refused = run("show", "hertz.py", "--slip", "1", "--latex")
    assert (refused.exit_code, "exclude each other" in refused.stderr) == (2, True)


def test_a_file_is_not_run_to_ask_for_a_directory(here: Path) -> None:
    """`generate` has limits only in its other processes."""
    (here / "ends.py").write_text("import os\nos._exit(3)\n")
    assert "--out my_package" in run("generate", "ends.py").stderr


@pytest.mark.usefixtures("shown_unproven")
def test_a_formula_is_never_broken_where_no_terminal_is() -> None:
    """What a program reads stands on one line."""
    printed = done("show", "wedge")
    for name in sheet("wedge"):
        assert sheet("wedge").equation(name) in printed


@pytest.mark.usefixtures("shown_unproven")
def test_show_prints_closed_forms_beside_the_integrals() -> None:
    printed = done("show", "catenary")
    assert "Each closed form follows its integral" in printed
    assert "load_closed" in printed
    assert "besseli(1, (a + c)/(2*b))" in printed
    assert "Integral(" in printed


@pytest.mark.usefixtures("shown_unproven")
def test_a_limit_that_strikes_is_told() -> None:
    result = run("show", "catenary", "--limit", "1e-9")
    told = "No closed form found within 1e-09 s; the formulas remain integrals."
    assert result.exit_code == 0
    assert result.stderr == f"catenary: {told}\n"
    assert told in result.stdout
    assert "load_closed" not in result.stdout
    assert run("show", "wedge", "--limit", "1e-9").stderr == ""


@pytest.mark.parametrize("seconds", ["0", "nan", "-inf"])
@pytest.mark.parametrize("command", ["show", "generate"])
def test_a_limit_is_a_time_that_can_pass(command: str, seconds: str) -> None:
    result = run(command, "catenary", "--limit", seconds)
    assert result.exit_code == 2
    (message,) = lines(result.stderr)
    assert message.startswith(f"Error: --limit {float(seconds):g} ")
    assert "such as --limit 20" in message


@pytest.mark.slow
def test_generate_tells_of_a_limit_that_struck(
    here: Path, unproven: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also when the body is kept from an earlier run; another limit looks again."""
    monkeypatch.setattr(derive.parallel, "cores", lambda: 1)
    told = "catenary: No closed form found within 1e-09 s; the formulas remain integrals.\n"
    first = run("generate", "catenary", "--out", "made", "--limit", "1e-9")
    assert (first.exit_code, first.stderr) == (0, told)
    text = (here / "made" / "catenary.py").read_bytes()
    again = run("generate", "catenary", "--out", "made", "--limit", "1e-9")
    assert "kept" in again.stdout
    assert again.stderr == told
    third = run("generate", "catenary", "--out", "made")
    assert "kept" not in third.stdout
    assert "by special functions" in third.stdout
    assert third.stderr == ""
    assert (here / "made" / "catenary.py").read_bytes() == text


def test_no_summary_is_cut() -> None:
    assert "..." not in done("--help").replace("[ARGS]...", "")


@pytest.mark.parametrize("command", ["list", "show", "generate", "new", "check"])
def test_help_is_given(command: str) -> None:
    assert f"  {command} " in done("--help")
    assert done(command, "-h") == done(command, "--help")


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("nope",), "nope"),
        (("show",), "NAME"),
        (("show", "hertz", "--nope"), "--nope"),
        (("generate", "--jobs", "0"), "--jobs"),
    ],
    ids=" ".join,
)
def test_a_misused_command_is_answered_with_its_usage(
    here: Path, arguments: tuple[str, ...], word: str
) -> None:
    result = run(*arguments)
    assert result.exit_code == 2
    assert result.stderr.count("Error: ") == 1
    assert word in lines(result.stderr)[-1]
    assert contents(here) == {}


@pytest.mark.parametrize("arguments", [["--version"], ["generate", "--help"]])
def test_help_does_not_wait_for_sympy(arguments: list[str]) -> None:
    code = (
        "import sys\nfrom derive.cli import main\n"
        f"try:\n    main({arguments!r})\nexcept SystemExit as end:\n    assert not end.code\n"
        "late = {'sympy', 'mpmath', 'numpy', 'scipy', 'derive.pipeline'} & set(sys.modules)\n"
        "assert not late, late\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT, capture_output=True)


# ------------------------------------------------------------------ bad input


def test_a_profile_that_cannot_be_printed_is_bad_input(here: Path, unproven: None) -> None:
    """g(x) is convex and derived, but float64 ends at 1.8e308."""
    steep = CYLINDER.replace("x**2 /", "exp(999) * x**2 /")
    (here / "large.py").write_text(f"from sympy import exp\n{steep}")
    result = run("generate", "large.py", "--out", "new")
    assert isinstance(result.exception, SystemExit), result.exception
    assert result.exit_code == 2
    assert len(lines(result.stderr)) == 1
    assert "exp(999) has no finite, nonzero value in float64" in result.stderr
    assert not (here / "new").exists()


# ------------------------------------------------------------------ a check that falls short


def without_proof(of: FormulaSheet) -> FormulaSheet:
    proof = Proof(Verdict.UNKNOWN, "no point drawn")
    return replace(of, formulas={name: replace(f, proof=proof) for name, f in of.items()})


@pytest.mark.parametrize("arguments", [("generate", "hertz", "--out", "new"), ("show", "hertz")])
def test_what_is_not_proven_is_neither_generated_nor_shown(
    here: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...]
) -> None:
    monkeypatch.setattr(derive.proof.prove, "prove_sheet", without_proof)
    result = run(*arguments)
    assert result.exit_code == 1
    assert isinstance(result.exception, SystemExit)
    assert "tilt of 'hertz'" in result.stderr
    assert "no point drawn" in result.stderr
    assert "P(a, c)" not in result.stdout
    assert contents(here) == {}


# ------------------------------------------------------------------ generate


@pytest.mark.slow
def test_the_committed_package_is_as_generated() -> None:
    """The whole path once more, in an interpreter of its own."""
    ended = real("generate", "--check", cwd=ROOT)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert "is up to date" in ended.stdout


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

    def test_one_name_leaves_the_other_modules_alone(self, committed: Path) -> None:
        before = contents(committed)
        (committed / "hertz.py").write_text(f"{MARK}\nold = 1\n")
        done("generate", "hertz")
        assert contents(committed) == before

    def test_out_holds_what_was_asked_for_and_no_more(self, here: Path) -> None:
        done("generate", "hertz", "--out", "new")
        own = {n for n in contents(here / "new") if not n.startswith(("_", "runtime/"))}
        assert own == {"edge.py", "hertz.py", "full_stick.py", "py.typed"}

    def test_out_replaces_a_package_made_before(self, here: Path) -> None:
        done("generate", "hertz", "--out", "new")
        done("generate", "wedge", "--out", "new")
        assert "wedge.py" in contents(here / "new")
        assert "hertz.py" not in contents(here / "new")

    @pytest.mark.parametrize(
        ("arguments", "word"),
        [
            (("cylinder.py", "twin.py", "--out", "new"), "two geometries are named 'cylinder'"),
            (("hertz", "clash.py", "--out", "new"), "two geometries are named 'hertz'"),
            (("hertz", "--out", "cylinder.py/new"), "new"),
        ],
        ids=" ".join,
    )
    def test_two_bodies_of_one_name_and_a_folder_in_a_file_are_refused(
        self, here: Path, arguments: tuple[str, ...], word: str
    ) -> None:
        for name, body in (("cylinder", "cylinder"), ("twin", "cylinder"), ("clash", "hertz")):
            (here / f"{name}.py").write_text(CYLINDER.replace('"cylinder"', f'"{body}"'))
        before = contents(here)
        result = run("generate", *arguments)
        assert result.exit_code == 2
        assert word in result.stderr and len(lines(result.stderr)) == 1
        assert contents(here) == before

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
        assert "'link', which is a broken link" in result.stderr
        assert len(lines(result.stderr)) == 1
        assert not (here / "there").exists()


@pytest.mark.usefixtures("built")
class TestCheck:
    """`derive generate --check`."""

    def test_it_passes_on_what_was_generated(self, committed: Path) -> None:
        assert "is up to date" in done("generate", "--check")

    @pytest.mark.parametrize(
        ("name", "text"),
        [
            ("wedge.py", f"{MARK}\nmine = 1\n"),
            ("py.typed", "mine"),
            ("__init__.py", None),
            ("old.py", f"{MARK}\n"),
            ("notes.txt", "mine"),
        ],
    )
    def test_it_names_the_one_file_that_is_changed_missing_or_not_generated(
        self, committed: Path, name: str, text: str | None
    ) -> None:
        if text is None:
            (committed / name).unlink()
        else:
            (committed / name).write_text(text)
        before = contents(committed)
        result = run("generate", "--check")
        assert result.exit_code == 1
        others = {path.name for path in committed.iterdir()} - {name}
        assert name in result.stdout
        assert not {line.partition(": ")[0] for line in lines(result.stdout)} & others
        assert ("-mine = 1" in result.stdout) == (name == "wedge.py")
        assert "derive generate" in result.stdout
        assert contents(committed) == before

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


@pytest.mark.usefixtures("committed")
def test_what_an_earlier_run_built_is_not_built_again(built: list[str]) -> None:
    assert "kept" not in done("generate")
    assert built == [*library()]
    printed = done("generate")
    assert built == [*library()]
    assert printed.count("kept") == len(library())
    assert "Nothing to change" in printed
    assert "kept" not in done("generate", "--fresh")
    assert built == [*library()] * 2


@pytest.mark.usefixtures("committed", "built")
def test_a_check_never_opens_what_was_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """Which may be anything: `generate` cannot know."""

    def refuse(*_: object) -> None:
        raise AssertionError("the cache was read")

    monkeypatch.setattr(derive.cache.Cache, "get", refuse)
    assert "is up to date" in done("generate", "--check")


def test_the_table_says_what_was_built_when() -> None:
    fresh = body_of(sheet("hertz"), "")
    shown = [list(summary([body]).columns[-1].cells) for body in (fresh, replace(fresh, kept=True))]
    assert shown == [["0.0 s"], ["kept"]]


# ------------------------------------------------------------------ several processes

WAITS = f"""import os, time
from pathlib import Path
Path("waits", str(os.getpid())).touch()
time.sleep(600)
{CYLINDER}"""


@pytest.mark.slow
def test_bad_input_is_told_by_several_processes_as_by_one(here: Path) -> None:
    """The other body is not waited for."""
    (here / "waits").mkdir()
    (here / "waits.py").write_text(WAITS.replace('"cylinder"', '"waits"'))
    (here / "concave.py").write_text(CYLINDER.replace("g=x", "g=-x"))
    one = run("generate", "concave.py", "hertz", "--out", "new", "--jobs", "1")
    began = time.perf_counter()
    two = run("generate", "waits.py", "concave.py", "wedge", "--out", "new", "--jobs", "2")
    assert time.perf_counter() - began < 60
    assert (one.exit_code, two.exit_code) == (2, 2), two.output
    assert one.stderr == two.stderr
    assert "not convex" in two.stderr and len(lines(two.stderr)) == 1
    assert not (here / "new").exists()


INTERRUPTIBLE = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # even where the tests run in background
from derive.cli import main
main(["generate", "waits.py", "waits_too.py", "hertz", "--out", "new", "--jobs", "2"])
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "killpg"), reason="Ctrl-C is sent to a group of processes")
@pytest.mark.parametrize(
    ("kind", "status", "words"), [(signal.SIGINT, 1, ["Aborted!"]), (signal.SIGTERM, 143, [])]
)
def test_a_signal_ends_every_process_and_writes_nothing(
    here: Path, kind: int, status: int, words: list[str]
) -> None:
    """Both processes are in the middle of their bodies."""
    (here / "waits").mkdir()
    for name in ("waits.py", "waits_too.py"):
        (here / name).write_text(WAITS.replace('"cylinder"', f'"{name.removesuffix(".py")}"'))
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
    os.killpg(started.pid, kind)
    stdout, stderr = started.communicate(timeout=60)
    assert started.returncode == status
    assert stdout == ""
    assert stderr.split() == words
    assert sorted(p.name for p in here.iterdir()) == before
    for pid in (here / "waits").iterdir():
        with pytest.raises(ProcessLookupError):
            os.kill(int(pid.name), 0)


# ------------------------------------------------------------------ the bar


def test_the_bar_counts_stages_of_all_bodies(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[Mapping[str, object]] = []
    monkeypatch.setattr("rich.progress.Progress.update", lambda bar, task, **now: told.append(now))
    with derive.terminal.progress(3, STAGES) as step:
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
        "c: reading g(x), 1 more in progress",
        "b: proving, 1 more in progress",
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
    with derive.terminal.progress(1, STAGES) as step:
        step("a", STAGES[0])
    assert capsys.readouterr().err == ""


def test_what_takes_long_is_told_once_where_nothing_moves(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(derive.terminal, "PATIENCE", 0.05)
    with derive.terminal.progress(1, STAGES) as step:
        step("a", STAGES[3])
        time.sleep(0.2)
    assert capsys.readouterr().err == "Still at work after 0.05 s: a: proving\n"
    with derive.terminal.status("reading") as update:
        update("a: reading g(x)")
        time.sleep(0.2)
    assert capsys.readouterr().err == "Still at work after 0.05 s: a: reading g(x)\n"
    with derive.terminal.status("reading"):
        pass
    time.sleep(0.2)
    assert capsys.readouterr().err == ""


class TestSlip:
    """`derive show NAME --slip ORDER`."""

    def test_it_prints_the_terms_of_both_edges(self) -> None:
        done = CliRunner().invoke(main, ["show", "hertz", "--slip", "2"])
        lines = done.output.splitlines()
        assert done.exit_code == 0
        assert [line.split(":")[0] for line in lines if ":" in line] == [
            *(f"d_{side}, order {order}" for side in ("left", "right") for order in (1, 2)),
            "kappa_left, kappa_right",
        ]
        assert "D_left = K_T_left/(K_N_left*f*kappa_left)" in lines
        assert "K_N_left = E_star*sqrt(a + c)/(2*R)" in lines

    @pytest.mark.parametrize(
        ("name", "order"), [("hertz", "0"), ("hertz", "x"), ("hyperbola", "3")]
    )
    def test_an_order_that_there_is_not(self, name: str, order: str) -> None:
        done = CliRunner().invoke(main, ["show", name, "--slip", order])
        assert done.exit_code == 2
        assert "--slip" in done.output

    def test_its_time_is_limited(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """For a body of the library, too."""
        monkeypatch.setattr(derive.pipeline, "STRANGERS", Bounds(seconds=0.2, gigabytes=4))
        done = run("show", "hertz", "--slip", "4")
        assert done.exit_code == 2
        assert "took longer than its limit of 0.2 s: give a lower order" in done.stderr


class TestCode:
    """`derive show NAME --code LANGUAGE`."""

    def test_it_prints_functions(self, unproven: None) -> None:
        done = run("show", "hertz", "--code", "julia")
        assert done.exit_code == 0
        assert run("show", "hertz", "--code", "Julia").output == done.output
        assert "function load(a, c, E_star, R)" in done.output

    @pytest.mark.parametrize("other", [("--latex",), ("--html",), ("--slip", "2")])
    def test_one_form_at_a_time(self, other: tuple[str, ...]) -> None:
        done = run("show", "hertz", "--code", "c", *other)
        assert done.exit_code == 2
        assert "exclude each other" in done.output

    def test_a_language_that_is_not_spoken(self) -> None:
        done = run("show", "hertz", "--code", "perl")
        assert done.exit_code == 2
        assert "'c', 'fortran', 'javascript', 'julia', 'matlab'" in done.output


def test_tables_keep_to_the_columns_that_are_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """Into a pipe, too; no word is cut."""
    monkeypatch.setenv("COLUMNS", "80")
    printed = done("list")
    assert max(map(len, lines(printed))) == 80
    assert "…" not in printed
    assert all(line[-1] in "┓┃┩│┘" for line in lines(printed))
    cells = [[cell.strip() for cell in line.split("│")] for line in lines(printed)]
    bodies = " ".join(row[-2] for row in cells if len(row) > 2)
    assert all(" ".join(load_geometry(name).title.split()) in bodies for name in library())


def test_findings_as_a_page(here: Path) -> None:
    example = str(ROOT / "examples" / "cattaneo_mindlin.toml")
    done = run("check", example, "--html", "page.html")
    assert done.exit_code == 0
    assert "stick zone: fails: c = a*sqrt(1 - Q/(P*f))" in done.stdout
    assert "half-width" in (here / "page.html").read_text()


@pytest.mark.parametrize("command", [("show", "hertz"), ("list",)])
def test_no_line_ends_in_blanks(command: tuple[str, ...], here: Path) -> None:
    assert not [line for line in done(*command).splitlines() if line != line.rstrip()]


def test_an_explanation_is_no_wider_than_its_words(here: Path) -> None:
    example = str(ROOT / "examples" / "cattaneo_mindlin.toml")
    printed = done("check", example, "--explain", "half-width")
    words, _, table = printed.partition("numbers")
    assert all(line == line.rstrip() for line in words.splitlines())
    assert max(map(len, lines(table))) < 200
