"""`derive new`: units found, the file written whole or not at all, and loaded as what was read."""

import ast
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from hypothesis import given, settings
from hypothesis import strategies as st
from ruff import find_ruff_bin

from derive.cli import main
from derive.errors import (
    BadName,
    BadOption,
    BadProfile,
    BadTarget,
    BadText,
    BadUnit,
    DimensionMismatch,
    OpenUnits,
    UserError,
)
from derive.library import library, load_geometry
from derive.writing import target
from derive.writing.draft import NEUTRAL, Wanted, draft, said
from derive.writing.lengths import units
from derive.writing.meaning import read
from derive.writing.target import place, write_new
from tests.derive.bodies import BODIES, geometry

CYLINDER = '''"""Profile g(x) = x**2/(2*R)."""

from derive import Geometry, parameter, x

R = parameter("R", "parameter of the profile", unit="m")
geometry = Geometry("cylinder", g=x**2 / (2 * R))
'''
FLAT = '''"""Flat punch with rounded shoulders."""

from sympy import Abs, Piecewise

from derive import Geometry, parameter, x

b = parameter("b", "half-width of the flat", unit="m")
R = parameter("R", "parameter of the profile", unit="m")
geometry = Geometry("flat", g=Piecewise((0, Abs(x) <= b), ((Abs(x) - b) ** 2 / (2 * R), True)))
'''


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """The command in an empty directory."""
    monkeypatch.chdir(tmp_path)

    def new(*arguments: str) -> Result:
        return CliRunner().invoke(main, ["new", *arguments])

    return new


def held(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


# Units


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("x**2/(2*R)", {"R": "m"}),
        ("phi*Abs(x)", {"phi": "rad"}),
        ("phi*Abs(x) + x**2/R", {"phi": "rad", "R": "m"}),
        ("C*x**4", {"C": "1/m**3"}),
        ("x**4/C", {"C": "m**3"}),
        ("C*x**2", {"C": "1/m"}),
        ("C*Abs(x)**1.5", {"C": "1/m**(1/2)"}),
        ("Abs(x)**(4/3)*C**(1/3)", {"C": "1/m"}),
        ("C*Abs(x)**k", {"C": "m**(1 - k)", "k": "-"}),
        ("(C*Abs(x))**k", {"C": "m**(-(k - 1)/k)", "k": "-"}),
        ("b*(Abs(x)/b)**k", {"b": "m", "k": "-"}),
        ("R*cosh(x/R) - R", {"R": "m"}),
        ("R - sqrt(R**2 - x**2)", {"R": "m"}),
        ("phi*sqrt(x**2 + b**2)", {"phi": "rad", "b": "m"}),
        ("phi*b*log(cosh(x/b))", {"phi": "rad", "b": "m"}),
        ("b*exp(x*k)", {"b": "m", "k": "1/m"}),
        ("Abs(x)*tan(phi)", {"phi": "rad"}),
        ("x*sin(phi) + x*cos(psi)", {"phi": "rad", "psi": "rad"}),
        ("phi*(Abs(x) - b)", {"phi": "rad", "b": "m"}),
        ("Max(0, x - b)**2/R", {"R": "m", "b": "m"}),
        ("x*sign(x - b)*phi", {"phi": "rad", "b": "m"}),
        ("phi*x*Heaviside(x - b)", {"phi": "rad", "b": "m"}),
        ("Piecewise((x**2/R, x < b), (phi*x, True))", {"R": "m", "b": "m", "phi": "rad"}),
        ("Piecewise((0, x < b), (x, True))", {"b": "m"}),
        ("Piecewise((0, Abs(x)*phi < b), (b, True))", {"phi": "rad", "b": "m"}),
        # open, and taken for lengths
        ("x**4/(R*b**2)", {"R": "m", "b": "m"}),
        ("x**3/(b*R)", {"R": "m", "b": "m"}),
        ("x**2*b/(R*k)", {"R": "m", "b": "m", "k": "m"}),
        ("h0*(Abs(x)/b)", {"h0": "m", "b": "m"}),
        # nothing agrees: refused later
        ("x**2 + R*0*x", {}),
        ("x + x**2/R + 1", {"R": "m"}),
        ("x**2*R + x/R", {"R": "m"}),
    ],
)
def test_units_follow_from_g_being_a_length(text: str, found: dict[str, str]) -> None:
    assert units(read(text), {}) == found


@pytest.mark.parametrize(
    ("text", "given_units", "found"),
    [
        ("phi*x**2/R", {"R": "m"}, {"R": "m", "phi": "rad"}),
        ("phi*x**2/R", {"phi": "-"}, {"R": "m", "phi": "-"}),
        ("phi*x**2/R", {"phi": "1/m"}, {"R": "-", "phi": "1/m"}),
        ("x**2/(2*R)", {"R": "N/Pa/m"}, {"R": "N/Pa/m"}),
        ("C*Abs(x)**k", {"C": "m**(1 - k)"}, {"C": "m**(1 - k)", "k": "-"}),
    ],
)
def test_a_unit_that_is_given_is_kept(
    text: str, given_units: dict[str, str], found: dict[str, str]
) -> None:
    assert units(read(text), given_units) == found


@pytest.mark.parametrize(
    ("text", "parameters"),
    [
        ("phi*x**2/R", ("R", "phi")),
        ("x**2/(R*k)", ("R", "k")),
        ("x**2*C*D*F", ("C", "D", "F")),
        ("phi*x**2/R + psi*Abs(x)", ("R", "phi")),
    ],
)
def test_units_that_stay_open_are_asked_for(text: str, parameters: tuple[str, ...]) -> None:
    with pytest.raises(OpenUnits) as caught:
        draft(Wanted("body", text))
    assert caught.value.parameters == parameters
    assert set(caught.value.enough) < set(parameters)
    assert f"--unit {caught.value.enough[0]}=m" in caught.value.message
    enough = dict.fromkeys(caught.value.enough, "m")
    draft(Wanted("body", text, units=enough))  # what the message says helps


@pytest.mark.parametrize("name", ["x**2", "x + 1", "Abs(x) + x**2", "R*x**2 + x/R", "cosh(x)"])
def test_a_dimension_that_cannot_agree_is_refused_as_by_geometry(name: str) -> None:
    with pytest.raises(DimensionMismatch) as caught:
        draft(Wanted("body", name))
    assert "a number has no unit: write it as a parameter with its unit" in caught.value.message
    assert ("check the units" in caught.value.message) == ("R" in name)


# The draft

TEXTS = {
    "hertz": "x**2/(2*R)",
    "wedge": "phi*abs(x)",
    "unequal_wedge": "Piecewise((-phi*x, x < 0), (psi*x, True))",
    "shifted_wedge": "phi*Abs(x - b)",
    "flat_rounded": "Piecewise((0, Abs(x) - b <= 0), ((Abs(x) - b)**2/(2*R), True))",
    "flat_cornered": "phi*max(0, abs(x) - b)",
    "rounded_wedge": "Piecewise((x**2/(2*R), Abs(x) < b), (b*Abs(x)/R - 0.5*b**2/R, True))",
    "quartic": "x**4/C",
    "parabola_quartic": "x**2/2/R + x**4/C",
    "two_radii": "Piecewise((x**2/(2*R1), 0 > x), (x**2/(2*R), True))",
    "skew": "x**2/R + x**3/R**2 + x**4/R**3",
    "spline": "x**2/R + Max(0, x - b)**3/R**2",
    "three_corners": "phi*(Abs(Abs(x) - b) + 2*Abs(x))",
}


@pytest.mark.parametrize("name", TEXTS)
def test_a_text_makes_the_body_that_was_written_by_hand(name: str) -> None:
    made = draft(Wanted(f"my_{name}", TEXTS[name])).geometry
    assert made.name == f"my_{name}"
    assert (made.g - geometry(name).g).simplify() == 0
    by_hand = {p.name: p.unit for p in BODIES[name].g.free_symbols if p.name != "x"}
    assert {q.name: q.unit for q in made.parameters} == by_hand


@pytest.mark.parametrize("name", TEXTS)
def test_the_file_is_loaded_as_what_was_read(name: str, tmp_path: Path) -> None:
    made = draft(Wanted(f"my_{name}", TEXTS[name]))
    path = tmp_path / "body.py"
    write_new(path, made.text)
    loaded = load_geometry(path)
    assert loaded.g == made.geometry.g
    assert (loaded.name, loaded.parameters) == (made.geometry.name, made.geometry.parameters)
    assert {q.meaning for q in loaded.parameters} == {NEUTRAL}


def test_the_file_is_like_those_of_the_library() -> None:
    assert draft(Wanted("cylinder", "x**2/(2*R)")).text == CYLINDER
    text = "Piecewise((0, abs(x) <= b), ((Abs(x)-b)**2/(2*R), True))"
    meanings = {"b": "half-width of the flat"}
    wanted = Wanted("flat", text, title="Flat punch with rounded shoulders.", meanings=meanings)
    assert draft(wanted).text == FLAT


def test_a_profile_without_parameters_imports_no_more_than_it_needs() -> None:
    text = draft(Wanted("edge", "abs(x)/3")).text
    assert "from derive import Geometry, x\n" in text
    assert "from sympy import Abs\n" in text


def test_the_file_passes_the_linter() -> None:
    text = draft(Wanted("assorted", "max(0, x)**2/R + 0.1*abs(x) + pi*sqrt(x**2)/4")).text
    command = [
        find_ruff_bin(),
        "check",
        "--isolated",
        "--line-length=100",
        "--select=E,F,I,D1,RUF",
        "-",
    ]
    done = subprocess.run(command, input=text, text=True, capture_output=True)
    assert done.returncode == 0, done.stdout


def test_a_long_formula_is_no_title() -> None:
    text = " + ".join(["phi*Abs(x)"] * 12)
    assert draft(Wanted("long_one", text)).text.startswith('"""Profile long_one."""')


TITLES = [
    'He said "wedge"',
    '"""',
    '"""\nimport os\nos.system("touch X")\n"""',
    '"""; raise SystemExit; """',
    "\\",
    "\\" * 3,
    '\\"""',
    '"',
    '""',
    '"quoted',
    "two\nlines",
    "tab\tand\rreturn",
    "null\0byte",
    "Schräge Flanken, π/2 − φ, 😀",
    "bidi \u202e override",
    "lone \udc80 surrogate",
    "{braces} %s %(x)s",
    "'''",
    "\\N{BULLET} \\x41 \\u0041",
    "# noqa",
]


@pytest.mark.parametrize("words", TITLES, ids=ascii)
def test_titles_and_meanings_are_kept_and_never_run(words: str, tmp_path: Path) -> None:
    wanted = Wanted("body", "x**2/(2*R)", title=words, meanings={"R": words})
    path = tmp_path / "body.py"
    write_new(path, draft(wanted).text)
    loaded = load_geometry(path)
    assert loaded.description == words
    assert loaded.parameters[0].meaning == words
    assert held(tmp_path) == ["body.py"]


@settings(max_examples=60)
@given(st.text(alphabet=st.one_of(st.characters(), st.sampled_from("\"\\\n'")), min_size=1))
def test_any_words_are_data(words: str) -> None:
    text = draft(Wanted("body", "x**2/(2*R)", title=words, meanings={"R": words})).text
    module = ast.parse(text)
    kinds = [type(statement) for statement in module.body]
    assert kinds == [ast.Expr, ast.ImportFrom, ast.Assign, ast.Assign]
    title = ast.get_docstring(module, clean=False)
    assert title is not None
    assert title.strip() == (words.strip() or "Profile g(x) = x**2/(2*R).")
    assert isinstance(module.body[2], ast.Assign)
    call = module.body[2].value
    assert isinstance(call, ast.Call)
    assert ast.literal_eval(call.args[1]) == words


def test_an_empty_title_is_none() -> None:
    assert draft(Wanted("cylinder", "x**2/(2*R)", title="  ")).text == CYLINDER


@pytest.mark.parametrize(
    ("text", "column"), [("x**2/R + b - b", 9), ("0*b + Abs(x)", 2), ("Abs(x)*b/b", 7)]
)
def test_a_parameter_without_influence_is_refused(text: str, column: int) -> None:
    with pytest.raises(BadText) as caught:
        draft(Wanted("body", text))
    assert caught.value.column == column
    assert "cancels out" in caught.value.why


@pytest.mark.parametrize(
    ("text", "error", "part"),
    [
        ("-x**2/R", BadProfile, "not convex"),
        ("phi*x", BadProfile, "straight"),
        ("R", BadProfile, "there is no x in it, only parameters (R)"),
        ("y**2/(2*R)", BadProfile, "no x in it, only parameters (y, R)"),
        ("y**2/(R*k)", BadProfile, "write g(x) with it, such as x**2/(2*R)"),
        ("10*x**2", DimensionMismatch, "write it as a parameter with its unit, such as R in"),
        ("0", BadProfile, "straight"),
        ("phi*x*sign(x - b)", BadProfile, "jumps"),
        ("x**3/R**2", BadProfile, "not convex"),
        ("Piecewise((x**2/R, x < b))", BadProfile, "not defined"),
        ("Piecewise((phi*x, Abs(x - b) < R), (0, True))", UserError, ""),
        ("x**2/R + 1", DimensionMismatch, "dimension"),
    ],
)
def test_what_geometry_refuses_is_refused_here(
    text: str, error: type[UserError], part: str
) -> None:
    with pytest.raises(error) as caught:
        draft(Wanted("body", text))
    assert part in caught.value.message


def test_a_fault_of_the_reader_is_no_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise RecursionError("too deep")

    wanted = Wanted("body", "x**2/R")
    monkeypatch.setattr("derive.geometry.check", fail)
    with pytest.raises(BadProfile) as caught:
        draft(wanted)
    assert "RecursionError: too deep" in caught.value.why


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("", "cannot be the name of a module"),
        ("2b", "cannot be the name of a module"),
        ("my body", "cannot be the name of a module"),
        ("../evil", "cannot be the name of a module"),
        ("a/b", "cannot be the name of a module"),
        ("_types", "cannot be the name of a module"),
        ("body.py", "cannot be the name of a module"),
        ("class", "cannot be the name of a module"),
        ("é", "cannot be the name of a module"),
        ("body\n", "cannot be the name of a module"),
        ("body\0", "cannot be the name of a module"),
        ("contact", "taken by the theory"),
        ("P", "taken by the theory"),
        ("numpy", "hide the Python module"),
        ("derive", "hide the Python module"),
        ("random", "hide the Python module"),
        *((name, "in the library already") for name in library()),
    ],
)
def test_a_bad_name_is_refused(name: str, why: str) -> None:
    with pytest.raises(BadName) as caught:
        Wanted(name, "x**2/(2*R)")
    assert caught.value.given == name
    assert why in caught.value.why


# Options


@pytest.mark.parametrize(
    ("given_options", "part"),
    [
        (["R"], "not of the form"),
        (["=m"], "not of the form"),
        (["R="], "not of the form"),
        (["R=  "], "not of the form"),
        ([""], "not of the form"),
        (["R=m", "b=m", "R=m"], "a second time"),
    ],
)
def test_a_malformed_option_is_refused(given_options: Sequence[str], part: str) -> None:
    with pytest.raises(BadOption) as caught:
        said("--unit", given_options)
    assert part in caught.value.why
    assert "--unit NAME=TEXT" in caught.value.message


def test_a_meaning_may_hold_an_equals_sign() -> None:
    assert said("--meaning", ["R=radius, 1/R = 1/R1 + 1/R2"]) == {"R": "radius, 1/R = 1/R1 + 1/R2"}


@pytest.mark.parametrize("option", ["units", "meanings"])
@pytest.mark.parametrize(
    ("text", "part"), [("x**2/(2*R)", "its parameters are R"), ("Abs(x)", "it has no parameters")]
)
def test_an_option_for_another_name_is_refused(option: str, text: str, part: str) -> None:
    with pytest.raises(BadOption) as caught:
        draft(Wanted("body", text, **{option: {"b": "m"}}))  # type: ignore[arg-type]
    assert "no parameter 'b'" in caught.value.why
    assert part in caught.value.why


@pytest.mark.parametrize(
    "unit", ["kg", "m^2", "m\0", "(" * 10**5, "m" * 100, "m**(1/0)", "9**9**9"]
)
def test_a_bad_unit_is_refused(unit: str) -> None:
    with pytest.raises(BadUnit) as caught:
        draft(Wanted("body", "x**2/(2*R)", units={"R": unit}))
    assert "write a product of powers" in caught.value.message


# The place


def test_a_file_goes_to_the_current_directory_a_directory_or_a_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder.py").mkdir()
    assert place("body", None) == Path("body.py")
    assert place("body", Path("folder")) == Path("folder/body.py")
    assert place("body", Path("folder.py")) == Path("folder.py/body.py")
    assert place("body", Path("folder/mine.py")) == Path("folder/mine.py")


def test_a_place_that_is_none_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "text.txt").write_text("kept")
    (tmp_path / "body.py").write_text("kept")
    (tmp_path / "link.py").symlink_to("nowhere")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "body.py").mkdir()
    for out in (None, "body.py", "link.py", "nowhere", "nowhere/mine.py", "text.txt", "other"):
        with pytest.raises(BadTarget) as caught:
            place("body", None if out is None else Path(out))
        assert "nothing was written" in caught.value.message
    for out in ("text.txt/mine.py", "q" * 300 + ".py", "a\0.py"):
        with pytest.raises(BadTarget):
            write_new(place("body", Path(out)), "new")
    assert (tmp_path / "body.py").read_text() == (tmp_path / "text.txt").read_text() == "kept"


def test_a_file_that_appears_meanwhile_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "body.py"
    path.write_text("kept")
    with pytest.raises(BadTarget) as caught:
        write_new(path, "new")
    assert caught.value == BadTarget(str(path), "is there already")
    assert path.read_text() == "kept"
    assert held(tmp_path) == ["body.py"]


def test_a_link_that_leads_nowhere_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "body.py").symlink_to(tmp_path / "elsewhere.py")
    with pytest.raises(BadTarget):
        write_new(tmp_path / "body.py", "new")
    assert held(tmp_path) == ["body.py"]


def _fail(*_: object, **__: object) -> None:
    raise OSError(28, "No space left on device")


@pytest.mark.parametrize("step", ["derive.writing.target.os.fsync", "derive.writing.target._write"])
def test_a_failing_write_leaves_nothing_behind(
    step: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(step, _fail)
    with pytest.raises(BadTarget) as caught:
        write_new(tmp_path / "body.py", "new")
    assert "No space left on device" in caught.value.why
    assert held(tmp_path) == []


def test_an_interrupted_write_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(_: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(target.os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_new(tmp_path / "body.py", "new")
    assert held(tmp_path) == []


def test_a_file_system_without_links_will_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Path, "hardlink_to", _fail)
    path = tmp_path / "body.py"
    write_new(path, "new")
    assert path.read_text() == "new"
    with pytest.raises(BadTarget):
        write_new(path, "newer")
    assert path.read_text() == "new"
    monkeypatch.setattr(Path, "replace", _fail)
    with pytest.raises(BadTarget):
        write_new(tmp_path / "other.py", "new")
    assert held(tmp_path) == ["body.py"]


def test_a_file_has_the_rights_of_any_new_file(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    write_new(tmp_path / "body.py", "new")
    assert (tmp_path / "body.py").stat().st_mode == (tmp_path / "plain").stat().st_mode


# The command


def test_the_command_writes_the_file_and_says_what_next(
    run: Callable[..., Result], tmp_path: Path
) -> None:
    result = run("cylinder", "x**2/(2*R)")
    assert result.exit_code == 0, result.output
    assert (tmp_path / "cylinder.py").read_text() == CYLINDER
    assert held(tmp_path) == ["cylinder.py"]
    assert result.stdout.splitlines() == [
        "Wrote cylinder.py: g(x) = x**2/(2*R)",
        "  R [m]  parameter of the profile",
        "See its formulas:    derive show cylinder.py",
        "Make a module of it: derive generate cylinder.py --out DIRECTORY",
    ]


def test_the_options_are_heard(run: Callable[..., Result], tmp_path: Path) -> None:
    (tmp_path / "my bodies").mkdir()
    units_ = ("--unit", "R=m", "--unit", "phi = rad")
    meanings = ("--meaning", "phi=slope", "--meaning", "R=radius of the apex")
    words = ("--title", "Blunt.", "--out", "my bodies/blunt_1.py")
    result = run("blunt", "phi*Abs(x) + phi*x**2/R", *units_, *meanings, *words)
    assert result.exit_code == 0, result.output
    assert "derive show 'my bodies/blunt_1.py'" in result.stdout
    loaded = load_geometry(tmp_path / "my bodies" / "blunt_1.py")
    assert (loaded.name, loaded.description) == ("blunt", "Blunt.")
    meant = {q.name: (q.meaning, q.unit) for q in loaded.parameters}
    assert meant == {"R": ("radius of the apex", "m"), "phi": ("slope", "rad")}


@pytest.mark.parametrize("text", ["-phi*Min(x, -x)", "-h0 + phi*Abs(x)", "- phi*Min(x, -x)"])
def test_a_formula_may_begin_with_a_minus(
    text: str, run: Callable[..., Result], tmp_path: Path
) -> None:
    result = run("wedge_2", text)
    assert result.exit_code == 0, result.output
    assert load_geometry(tmp_path / "wedge_2.py").g.has(load_geometry("wedge").parameters[0].symbol)


def test_help_is_there() -> None:
    for option in ("-h", "--help"):
        result = CliRunner().invoke(main, ["new", option])
        assert result.exit_code == 0
        assert "NAME G" in result.output


def test_a_file_is_never_overwritten(run: Callable[..., Result], tmp_path: Path) -> None:
    (tmp_path / "cylinder.py").write_text("mine")
    for arguments in ((), ("--out", "."), ("--out", "cylinder.py")):
        result = run("cylinder", "x**2/(2*R)", *arguments)
        assert result.exit_code == 2
        assert "cylinder.py is there already; nothing was written" in result.stderr
    assert (tmp_path / "cylinder.py").read_text() == "mine"
    assert held(tmp_path) == ["cylinder.py"]


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (("body", "x^2/R"), "write ** for a power"),
        (("body", "2x"), "an operator is missing"),
        (("body", ""), "empty"),
        (("body", "__import__('os').system('touch X')"), "cannot be a name"),
        (("body", "(lambda: open('X', 'w'))()"), "lambda cannot stand"),
        (("body", "[open('X', 'w')]"), "[ ]"),
        (("body", "x**2/R", "--title", "t", "--unit", "R=__import__('os')"), "is no unit"),
        (("body", "9**9**9**9*x"), "exponent is too large"),
        (("body", "(" * 10**5), "characters"),
        (("body", "x + :smile:"), ": stands for nothing"),
        (("body", "[bold]x"), "[ ]"),
        (("body", "x*\udc80"), "U+DC80"),
        (("body", "-x**2/R"), "not convex"),
        (("body", "x**2"), "dimension"),
        (("body", "phi*x**2/R"), "--unit"),
        (("body", "x**2/R", "--unit", "b=m"), "no parameter 'b'"),
        (("body", "x**2/R", "--unit", "R"), "NAME=TEXT"),
        (("body", "x**2/R", "--unit", "R=m", "--unit", "R=m"), "a second time"),
        (("body", "x**2/R", "--meaning", "b=width"), "no parameter 'b'"),
        (("body", "x**2/R", "--out", "nowhere/"), "is no directory"),
        (("../body", "x**2/R"), "name of a module"),
        (("hertz", "x**2/R"), "in the library"),
        (("sympy", "x**2/R"), "hide"),
        (("body",), "Missing argument"),
        (("body", "x", "b"), "unexpected extra argument"),
        (("body", "x", "--tittle", "b"), "No such option"),
    ],
)
def test_bad_input_is_one_message_and_status_2(
    arguments: tuple[str, ...], part: str, run: Callable[..., Result], tmp_path: Path
) -> None:
    result = run(*arguments)
    assert result.exit_code == 2
    assert part in " ".join(result.stderr.split())
    assert result.stderr.count("Error:") == 1
    assert "Traceback" not in result.output
    assert result.stdout == ""
    assert isinstance(result.exception, SystemExit)
    assert held(tmp_path) == []


def test_the_caret_stands_under_its_character_in_a_terminal_too(
    run: Callable[..., Result],
) -> None:
    lines = run("body", "x + b^2").stderr.splitlines()
    assert lines[1] == "    x + b^2"
    assert lines[2] == "         ^"


@pytest.mark.slow
def test_what_was_written_is_shown_and_generated(
    run: Callable[..., Result], tmp_path: Path
) -> None:
    assert run("cylinder", "x**2/(2*R)", "--meaning", "R=radius").exit_code == 0
    result = CliRunner().invoke(main, ["show", "cylinder.py"])
    assert result.exit_code == 0, result.output
    result = CliRunner().invoke(main, ["generate", "cylinder.py", "--out", "package"])
    assert result.exit_code == 0, result.output
    assert (tmp_path / "package" / "cylinder.py").is_file()
