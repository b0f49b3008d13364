"""The commands: what they print, what they write, and with which status they leave."""

import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import derive.command.processes
import derive.command.terminal
import derive.pipeline
import derive.proof.prove
from derive.body.library import library, load_geometry
from derive.codegen.publish import MARK
from derive.command.cli import main
from derive.command.processes import Bounds
from derive.pipeline import GENERATED, STAGES
from derive.proof.verdict import Proof, Verdict
from derive.sheet.built import BuiltBody
from derive.sheet.formulas import FormulaSheet
from derive.sheet.notation import text_of
from tests.codegen.made import body_of
from tests.commands import CYLINDER, MODULE, ROOT, contents, done, lines, python, real, refused, run
from tests.derive.bodies import sheet


@pytest.fixture
def committed(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the package `generated` in its place."""
    copy = tmp_path_factory.mktemp("copy") / "generated"
    shutil.copytree(GENERATED, copy, ignore=shutil.ignore_patterns("__pycache__"))
    (copy.parent / "pyproject.toml").touch()  # a clone, and no installed package
    monkeypatch.setattr(derive.pipeline, "GENERATED", copy)
    return copy


def underived(name: str, text: str) -> BuiltBody:
    """A body without the seconds of its derivation: its forms are the cylinder's."""
    return replace(body_of(sheet("hertz"), text), name=name)


@pytest.fixture
def built(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The pipeline with modules of the library as they are committed; what it was asked to build.

    In one process: another one would build in earnest.
    """
    texts = {name: (GENERATED / f"{name}.py").read_text() for name in library()}
    asked = []

    def build(
        source: str, report: Callable[[str, str], None], limit: float
    ) -> tuple[FormulaSheet, BuiltBody]:
        asked.append(source)
        for stage in STAGES:
            report(source, stage)
        if source in texts:
            return sheet("hertz"), underived(source, texts[source])
        made = load_geometry(source)
        return sheet("hertz"), underived(made.name, f"{MARK}\n# {made.g}\n")

    monkeypatch.setattr(derive.pipeline, "sheet_and_body", build)
    monkeypatch.setattr(derive.pipeline, "USER_FILE_LIMITS", None)
    monkeypatch.setattr(derive.command.processes, "cores", lambda: 1)
    return asked


# ------------------------------------------------------------------ list, show, help


@pytest.mark.slow
def test_list_names_every_geometry_with_its_profile_and_its_forms(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """No name and no word is cut, in the columns that are asked for, into a pipe, too; of three."""
    names = ["flat_rounded", "hertz", "power"]
    monkeypatch.setattr("derive.body.library.library", lambda: names)
    monkeypatch.setenv("COLUMNS", "60")
    printed = done("list")
    assert max(map(len, lines(printed))) <= 60
    parts = dict(part.split(maxsplit=1) for part in printed.split("\n\n") if part.strip())
    assert [*parts] == names
    for name in names:
        geometry = load_geometry(name)
        assert geometry.name == name and all(q.meaning for q in geometry.parameters)
        for word in (name, *geometry.title.split(), *text_of(geometry.g).split()):
            assert word in f"{name} {parts[name]}"
    power = " ".join(parts["power"].split())
    assert "closed form forward by special functions" in power
    assert "numerical forward in code, from (P, M)" in power
    assert "special" not in parts["hertz"]


def test_the_command_is_a_module_too(tmp_path: Path) -> None:
    """And it advises to go on in the same way."""
    (tmp_path / "body.py").write_text(CYLINDER)
    ended = real(*MODULE, "generate", "body.py", cwd=tmp_path)
    assert ended.returncode == 2, ended.stderr
    told = re.search("as in `(.*) generate body.py --out my_package`", ended.stderr)
    assert told is not None
    ended = real("sh", "-c", f"{told[1]} --version", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")


@pytest.mark.usefixtures("unproven")
def test_show_prints_every_formula_with_its_proof() -> None:
    """On one line where no terminal is, and as one display in LaTeX."""
    printed = done("show", "wedge")
    for name in sheet("wedge"):
        assert sheet("wedge").equation(name) in printed
    assert printed.count("proven: assumed by a test") == len(sheet("wedge"))
    assert not [line for line in printed.splitlines() if line != line.rstrip()]
    printed = done("show", "hertz", "--latex")
    assert printed.startswith("\\begin{aligned}\n") and printed.endswith("\\end{aligned}\n")
    assert printed.count("{") == printed.count("}")
    assert printed.count("&=") == len(sheet("hertz")) + 1


FORMS = [(), ("--slip", "1"), ("--html",)]
ENDS, WAITS_ON = f"import os\nos.abort()\n{CYLINDER}", "import time\ntime.sleep(600)\n"


@pytest.mark.enough("*form0", "*form3")
@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "words", "form"),
    [
        *((ENDS, "crashed", form) for form in FORMS),
        (WAITS_ON, "took longer than the limit of 1 s", ()),
    ],
)
def test_show_refuses_a_file_that_ends_its_process_or_never_ends(
    here: Path, monkeypatch: pytest.MonkeyPatch, text: str, words: str, form: tuple[str, ...]
) -> None:
    """As a number ends it that is too large for the library under SymPy."""
    if text == WAITS_ON:
        monkeypatch.setattr(derive.pipeline, "USER_FILE_LIMITS", Bounds(60, 4, {STAGES[0]: 1}))
    (here / "mine.py").write_text(text)
    assert f"mine.py: the stage 'reading g(x)' {words}" in refused("show", "mine.py", *form)
    assert contents(here).keys() == {"mine.py"}


def test_a_file_is_not_run_to_ask_for_a_directory(here: Path) -> None:
    """`generate` has limits only in its other processes."""
    (here / "ends.py").write_text("import os\nos._exit(3)\n")
    assert "--out my_package" in refused("generate", "ends.py")


@pytest.mark.slow
def test_generate_tells_of_a_limit_that_struck(here: Path, unproven: None) -> None:
    """The module is the same."""
    told = "catenary: No closed form found within 1e-09 s; the formulas remain integrals.\n"
    first = run("generate", "catenary", "--out", "made", "--limit", "1e-9")
    assert (first.exit_code, first.stderr) == (0, told)
    text = (here / "made" / "catenary.py").read_bytes()
    again = run("generate", "catenary", "--out", "made")
    assert "by special functions" in again.stdout
    assert again.stderr == ""
    assert (here / "made" / "catenary.py").read_bytes() == text


def test_help_is_given() -> None:
    printed = done("--help")
    assert "..." not in printed.replace("[ARGS]...", "")  # no summary is cut
    for command in main.commands:
        assert f"  {command} " in printed
        assert done(command, "-h") == done(command, "--help")


@pytest.mark.parametrize(
    ("arguments", "status"),
    [(["generate", "--help"], 0), (["generate", "derive/geometries/hertz.py"], 2)],
)
def test_help_and_an_order_do_not_wait_for_sympy(arguments: list[str], status: int) -> None:
    code = (
        "import sys\nfrom derive.command.cli import main\n"
        f"try:\n    main({arguments!r})\nexcept SystemExit as end:\n"
        f"    assert end.code == {status}\n"
        "late = {'sympy', 'numpy', 'scipy'} & set(sys.modules)\n"
        "assert not late, late\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT, capture_output=True)


# ------------------------------------------------------------------ bad input


def test_a_profile_that_cannot_be_printed_is_bad_input(here: Path, unproven: None) -> None:
    """g(x) is convex and derived, but float64 ends at 1.8e308."""
    steep = CYLINDER.replace("x**2 /", "exp(999) * x**2 /")
    (here / "large.py").write_text(f"from sympy import exp\n{steep}")
    message = refused("generate", "large.py", "--out", "new")
    assert "exp(999) has no finite, nonzero value in float64" in message
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
    """The whole path once more, in one interpreter of its own that seldom looks for garbage."""
    order = "import gc; gc.set_threshold(100_000, 50, 50); from derive.command.cli import main; "
    ended = python(order + "main(['generate', '--check', '--jobs', '1'])")
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
def test_a_file_becomes_a_package_that_stands_alone(here: Path, unproven: None) -> None:
    """P = pi E* h^2/(16 R) = pi 4 4/8; alpha = M/(P R) = 1/(2/2)."""
    (here / "cylinder.py").write_text(CYLINDER)
    assert "Wrote mine" in done("generate", "cylinder.py", "--out", "mine")
    held = contents(here / "mine")
    assert {"__init__.py", "cylinder.py", "py.typed"} < held.keys()
    assert not any(str(here).encode() in text for text in held.values())
    (here / "cylinder.py").unlink()
    lonely = [sys.executable, "-W", "error", "-c", LONELY]
    lonely = subprocess.run(lonely, cwd=here, capture_output=True, text=True, check=True)
    load, tilt = map(float, lonely.stdout.split())
    assert abs(load - 6.283185307179586) < 1e-14
    assert tilt == 1.0


@pytest.mark.usefixtures("built")
class TestGenerate:
    """`derive generate` around the pipeline."""

    def test_it_writes_what_has_changed_and_nothing_else(self, committed: Path) -> None:
        before = contents(committed)
        for path in committed.glob("*.*"):  # all but the library, which is written by hand
            path.unlink()
        printed = done("generate")
        assert "Wrote" in printed
        assert printed.count("0.0 s") == len(library())
        assert all(name in printed for name in library())
        assert contents(committed) == before
        times = {p: p.stat().st_mtime_ns for p in [committed, *committed.iterdir()]}
        assert "Nothing to change" in done("generate", "--fresh")
        assert {p: p.stat().st_mtime_ns for p in times} == times
        (committed / "hertz.py").write_text(f"{MARK}\nold = 1\n")
        done("generate", "hertz")
        assert contents(committed) == before

    def test_out_holds_what_was_asked_for_last_and_no_more(self, here: Path) -> None:
        assert "Removed" not in done("generate", "wedge", "--out", "new")
        assert "Removed wedge.py: name all bodies" in done("generate", "hertz", "--out", "new")
        own = {n for n in contents(here / "new") if not n.startswith(("_", "runtime/"))}
        assert own == {"edge.py", "hertz.py", "full_stick.py", "py.typed", "files.sha256"}

    def test_out_may_be_a_link_to_a_directory(self, here: Path) -> None:
        (here / "there").mkdir()
        (here / "link").symlink_to(here / "there")
        done("generate", "hertz", "--out", "link")
        assert (here / "link").is_symlink()
        assert "hertz.py" in contents(here / "there")

    @pytest.mark.parametrize(
        ("arguments", "word"),
        [
            (("cylinder.py", "twin.py", "--out", "new"), "two geometries are named 'cylinder'"),
            (("hertz", "clash.py", "--out", "new"), "two geometries are named 'hertz'"),
            (("hertz", "--out", "link/deeper"), "'link', which is a broken link"),
        ],
        ids=" ".join,
    )
    def test_two_bodies_of_one_name_and_broken_links_are_refused(
        self, here: Path, arguments: tuple[str, ...], word: str
    ) -> None:
        for name, body in (("cylinder", "cylinder"), ("twin", "cylinder"), ("clash", "hertz")):
            (here / f"{name}.py").write_text(CYLINDER.replace('"cylinder"', f'"{body}"'))
        (here / "link").symlink_to(here / "there")
        before = contents(here)
        assert word in refused("generate", *arguments)
        assert contents(here) == before
        assert not (here / "there").exists()


@pytest.mark.usefixtures("built")
class TestCheck:
    """`derive generate --check`."""

    def test_it_passes_where_nothing_has_changed(self, committed: Path) -> None:
        assert "is up to date" in done("generate", "--check")

    def test_it_names_the_files_that_differ_and_how(self, committed: Path) -> None:
        (committed / "wedge.py").write_text(f"{MARK}\nmine = 1\n")
        (committed / "__init__.py").unlink()
        before = contents(committed)
        result = run("generate", "--check")
        assert result.exit_code == 1
        told = {line for line in lines(result.stdout) if ".py: " in line}
        assert told == {"wedge.py: changed", "__init__.py: missing"}
        assert "-mine = 1" in result.stdout and "derive generate" in result.stdout
        assert contents(committed) == before


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
from derive.command.cli import main
main(["generate", "waits.py", "waits_too.py", "hertz", "--out", "new", "--jobs", "2"])
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "killpg"), reason="Ctrl-C is sent to a group of processes")
@pytest.mark.parametrize(
    ("kind", "status", "words"), [(signal.SIGINT, 130, ["Interrupted"]), (signal.SIGTERM, 143, [])]
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
        assert started.poll() is None, started.communicate()
        time.sleep(0.05)
    os.killpg(started.pid, kind)
    stdout, stderr = started.communicate(timeout=60)
    assert started.returncode == status
    assert stdout == ""
    assert [told for told in lines(stderr) if not told.startswith("Still working")] == words
    assert sorted(p.name for p in here.iterdir()) == before
    for pid in (here / "waits").iterdir():
        with pytest.raises(ProcessLookupError):
            os.kill(int(pid.name), 0)


# ------------------------------------------------------------------ the bar


def test_what_takes_long_is_told_once_where_nothing_moves(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(derive.command.terminal, "PATIENCE", 0.05)
    with derive.command.terminal.progress(1, STAGES) as step:
        step("a", STAGES[3])
        time.sleep(0.2)
    with derive.command.terminal.status("b: reading g(x)"):
        time.sleep(0.2)
    first, second = capsys.readouterr().err.splitlines()
    assert first.endswith(" 0.05 s: a: proving")
    assert second.endswith(" 0.05 s: b: reading g(x)")


def test_the_time_of_a_series_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    """For a body of the library, too."""
    monkeypatch.setattr(derive.pipeline, "USER_FILE_LIMITS", Bounds(seconds=0.2, gigabytes=4))
    told = refused("show", "hertz", "--slip", "2")
    assert "took longer than the limit of 0.2 s" in told


def test_code_names_the_command_that_prints_it(here: Path, unproven: None) -> None:
    (here / "my body.py").write_text(CYLINDER)
    printed = done("show", "my body.py", "--code", "Julia")
    assert "function load(a, c, E_star, radius)" in printed
    command = re.search("`derive (.*)`", printed)
    assert command is not None
    assert done(*shlex.split(command[1])) == printed


EXAMPLE = str(ROOT / "examples" / "cattaneo_mindlin.toml")


def test_findings_as_a_page(here: Path) -> None:
    printed = done("check", EXAMPLE, "--html", "page.html")
    assert "stick zone: fails: correct is c = a*sqrt(1 - Q/(P*f))" in printed
    assert "half-width" in (here / "page.html").read_text()
    assert "claims is named 'nope'; the most similar" in refused(
        "check", EXAMPLE, "--explain", "nope"
    )
