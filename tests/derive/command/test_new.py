"""`derive new`: units found, the file written whole or not at all, and loaded as what was read.

What it refuses: test_bad_inputs.py.
"""

from pathlib import Path

import pytest

from derive.body.library import load_geometry
from derive.command.errors import BadTarget, OpenUnits
from derive.command.files import put_page
from derive.command.new_geometry import NEUTRAL, Wanted, new_geometry
from derive.reading.profile import read
from derive.reading.units import units_of_profile
from tests.commands import done
from tests.derive.bodies import BODIES, geometry

CYLINDER = '''"""Profile g(x) = x**2/(2*R)."""

from derive import Geometry, parameter, x

R = parameter("R", "parameter of the profile", unit="m")
geometry = Geometry("cylinder", g=x**2 / (2 * R))
'''


def held(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


FULL = OSError(28, "No space left on device")


# Units


@pytest.mark.parametrize(
    ("text", "given_units", "found"),
    [
        ("x**2/(2*R)", {}, {"R": "m"}),
        ("Abs(x)**(4/3)*C**(1/3)", {}, {"C": "1/m"}),
        ("C*Abs(x)**k", {}, {"C": "m**(1 - k)", "k": "-"}),
        ("b*exp(x*k)", {}, {"b": "m", "k": "1/m"}),
        ("x*sin(phi) + x*cos(psi)", {}, {"phi": "rad", "psi": "rad"}),
        ("Piecewise((x**2/R, x < b), (phi*x, True))", {}, {"R": "m", "b": "m", "phi": "rad"}),
        ("Piecewise((0, Abs(x)*phi < b), (b, True))", {}, {"phi": "rad", "b": "m"}),
        ("b*(Abs(x)/R)**k", {"b": "m"}, {"R": "m", "b": "m", "k": "-"}),
        ("b*k**(x/R)", {}, {"R": "m", "b": "m", "k": "-"}),
        # open, and taken for lengths
        ("x**2*b/(R*k)", {}, {"R": "m", "b": "m", "k": "m"}),
        # nothing agrees: refused later
        ("x + x**2/R + 1", {}, {"R": "m"}),
        # what is given is kept
        ("phi*x**2/R", {"R": "m"}, {"R": "m", "phi": "rad"}),
        ("phi*x**2/R", {"phi": "1/m"}, {"R": "-", "phi": "1/m"}),
        ("x**2/(2*R)", {"R": "N/Pa/m"}, {"R": "N/Pa/m"}),
    ],
)
def test_units_follow_from_g_being_a_length(
    text: str, given_units: dict[str, str], found: dict[str, str]
) -> None:
    assert units_of_profile(read(text), given_units) == found


@pytest.mark.parametrize(
    ("text", "parameters"), [("phi*x**2/R", ("R", "phi")), ("x**2*C*D*F", ("C", "D", "F"))]
)
def test_units_that_stay_open_are_asked_for(text: str, parameters: tuple[str, ...]) -> None:
    with pytest.raises(OpenUnits) as caught:
        new_geometry(Wanted("body", text))
    assert caught.value.parameters == parameters
    enough = caught.value.options.removeprefix("--unit ").removesuffix("=m").split("=m --unit ")
    assert set(enough) < set(parameters)
    new_geometry(Wanted("body", text, units=dict.fromkeys(enough, "m")))  # and this helps


# The draft

TEXTS = {
    "hertz": "x**2/(2*R)",
    "unequal_wedge": "Piecewise((-phi*x, x < 0), (psi*x, True))",
    "flat_rounded": "Piecewise((0, Abs(x) - b <= 0), ((Abs(x) - b)**2/(2*R), True))",
    "rounded_wedge": "Piecewise((x**2/(2*R), Abs(x) < b), (b*Abs(x)/R - 0.5*b**2/R, True))",
}


@pytest.mark.parametrize("name", TEXTS)
def test_a_text_makes_the_body_that_was_written_by_hand(name: str, tmp_path: Path) -> None:
    """And its file is loaded as what was read."""
    made, text = new_geometry(Wanted(f"my_{name}", TEXTS[name]))
    put_page(text, tmp_path / "body.py", mark=None)
    loaded = load_geometry(tmp_path / "body.py")
    assert (loaded.name, loaded.g, loaded.parameters) == (made.name, made.g, made.parameters)
    assert {q.meaning for q in loaded.parameters} == {NEUTRAL}
    assert made.name == f"my_{name}"
    assert (made.g - geometry(name).g).simplify() == 0
    by_hand = {p.name: p.unit for p in BODIES[name].g.free_symbols if p.name != "x"}
    assert {q.name: q.unit for q in made.parameters} == by_hand


TITLES = [
    *('He said "wedge"', '"""', '"""\nimport os\nos.system("touch X")\n"""', "\\", '\\"""'),
    *("two\nlines", "null\0byte", "Schräge Flanken, π/2 − φ, 😀", "lone \udc80 surrogate"),
]


@pytest.mark.parametrize("words", TITLES, ids=ascii)
def test_titles_and_meanings_are_kept_and_never_run(words: str, tmp_path: Path) -> None:
    wanted = Wanted("body", "x**2/(2*R)", title=words, meanings={"R": words})
    path = tmp_path / "body.py"
    put_page(new_geometry(wanted)[1], path, mark=None)
    loaded = load_geometry(path)
    kept = words.encode("utf-8", "replace").decode()  # a lone surrogate cannot be written later
    assert loaded.description == kept
    assert loaded.parameters[0].meaning == kept
    assert held(tmp_path) == ["body.py"]


# The place


@pytest.mark.parametrize(
    ("failure", "error"), [(FULL, BadTarget), (KeyboardInterrupt(), KeyboardInterrupt)], ids=repr
)
def test_a_failing_write_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failure: BaseException, error: type
) -> None:
    def fail(*_: object) -> None:
        raise failure

    monkeypatch.setattr("derive.command.files.os.fsync", fail)
    with pytest.raises(error):
        put_page("new", tmp_path / "body.py", mark=None)
    assert held(tmp_path) == []


# The command


@pytest.mark.usefixtures("in_this_process")
def test_the_command_writes_the_file_and_says_what_next(here: Path) -> None:
    told = done("new", "cylinder", "x**2/(2*R)")
    assert (here / "cylinder.py").read_text() == CYLINDER
    assert held(here) == ["cylinder.py"]
    assert "R [m]  parameter of the profile" in told
    for command in ("show cylinder.py", "generate cylinder.py --out DIRECTORY"):
        assert f"derive {command}\n" in told


@pytest.mark.usefixtures("in_this_process")
def test_the_options_are_heard(here: Path) -> None:
    (here / "my bodies").mkdir()
    units_ = ("--unit", "R=m", "--unit", "phi = rad")
    meanings = ("--meaning", "phi=slope", "--meaning", "R=radius, 1/R = 1/R1 + 1/R2")
    words = ("--title", "Blunt.", "--out", "my bodies/blunt_1.py")
    told = done("new", "blunt", "phi*Abs(x) + phi*x**2/R", *units_, *meanings, *words)
    assert "derive show 'my bodies/blunt_1.py'" in told
    loaded = load_geometry(here / "my bodies" / "blunt_1.py")
    assert (loaded.name, loaded.description) == ("blunt", "Blunt.")
    meant = {q.name: (q.meaning, q.unit) for q in loaded.parameters}
    assert meant == {"R": ("radius, 1/R = 1/R1 + 1/R2", "m"), "phi": ("slope", "rad")}
