"""Tables as programs export them, and many that are wrong: one message each."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from derive.command.errors import BadTable
from derive.edge.find import find
from derive.edge.table import read
from generated import flat_rounded
from generated.runtime.types import Contact
from tests.commands import run
from tests.edge import example

X = np.linspace(-1.13, 1.11, 50)
P = 200 * np.sqrt(np.maximum(1 - X**2, 0))
Q = np.where(P > 0, 30 / np.sqrt(np.maximum(1 - X**2, 1e-9)), 0)
HEAD = "x [mm],p [MPa]\n"


def rows(*columns: np.ndarray, by: str = ",", comma: bool = False) -> str:
    lines = [by.join(f"{v:.6f}" for v in row) for row in zip(*columns, strict=True)]
    text = "\n".join(lines) + "\n"
    return text.replace(".", ",") if comma else text


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "t.csv"


def with_line(line: str) -> str:
    """A good table with one more line at its middle."""
    lines = (HEAD + rows(X, P)).splitlines()
    return "\n".join([*lines[:26], line, *lines[26:]]) + "\n"


GOOD = {
    "commas": HEAD + rows(X, P),
    "semicolons, decimal commas": "x [mm];p [MPa]\n" + rows(X, P, by=";", comma=True),
    "tabs": "X Location (mm)\tPressure (MPa)\n" + rows(X, P, by="\t"),
    "tabs, decimal commas": "x (mm)\tp (MPa)\n" + rows(X, P, by="\t", comma=True),
    "spaces": "  X [mm]     CPRESS [MPa]\n" + rows(X, P, by="   "),
    "spaces, decimal commas": "x [mm] p [MPa]\n" + rows(X, P, by="  ", comma=True),
    "units in SI": "x [m],p [Pa]\n" + rows(X * 1, P).replace("0.", "0."),
    "comments and blank lines": "# made by hand\n\n! more\n" + HEAD + "\n" + rows(X, P),
    "title above": "Contact report\nODB: job.odb\n" + HEAD + rows(X, P),
    "node numbers": "Node,x [mm],p [MPa]\n" + rows(np.arange(50.0), X, P),
    "labels": "Label;x [mm];p [MPa]\n"
    + "".join(f"PART-1.{i};{x:.6f};{p:.6f}\n" for i, (x, p) in enumerate(zip(X, P, strict=True))),
    "quotes": '"x [mm]","p [MPa]"\n' + rows(X, P),
    "closing separators": "x [mm];p [MPa];\n" + rows(X, P, by=";").replace("\n", ";\n"),
    "from right to left": HEAD + rows(X[::-1], P[::-1]),
    "Fortran": HEAD
    + "".join(f"{x:.8e},{p:.8e}\n" for x, p in zip(X, P, strict=True)).replace("e", "D"),
    "byte order mark": "\ufeff" + HEAD + rows(X, P),
    "N/mm2": "x [mm],p [N/mm^2]\n" + rows(X, P),
    "units behind underscores": "x_mm,p_MPa\n" + rows(X, P),
    "units behind strokes": "x / mm,Contact pressure / N/mm2\n" + rows(X, P),
    "header repeated": HEAD + rows(X[:25], P[:25]) + HEAD + rows(X[25:], P[25:]),
}


@pytest.mark.parametrize("name", GOOD)
def test_a_table_is_read(path: Path, name: str) -> None:
    path.write_text(GOOD[name], encoding="utf-8")
    (step,) = read(path)
    scale = (1.0, 1.0) if name == "units in SI" else (1e-3, 1e6)
    assert_allclose(step.x, scale[0] * X, atol=1e-6 * scale[0])
    assert_allclose(step.p, scale[1] * P, atol=1e-6 * scale[1])


def test_load_steps(path: Path, tmp_path: Path) -> None:
    """By a column, and by several columns of pressure."""
    long = "".join(
        f"{n},{x:.6f},{k * p:.6f}\n"
        for n, k in ((1, 1), (2, 0.5))
        for x, p in zip(X, P, strict=True)
    )
    path.write_text("Step,x [mm],p [MPa]\n" + long)
    wide = tmp_path / "w.csv"
    wide.write_text("x [mm],p 1 [MPa],p 2 [MPa]\n" + rows(X, P, 0.5 * P))
    for of in (read(path), read(wide)):
        assert len(of) == 2
        assert_allclose(of[1].p, 0.5e6 * P, atol=1.0)
    assert [step.name for step in read(path)] == ["1", "2"]


BAD = [
    ("   \n\n", "no line names a column of the position along the interface and one of"),
    ("hello\n# comment\n", "no line names a column"),
    ("x [mm],p [MPa]\n", "has no rows of numbers"),
    ("x [mm]\n" + "\n".join(f"{x:.4f}" for x in X), "no line names a column"),
    (rows(X, P), "no line names a column"),
    ("x,p\nmm,MPa\n" + rows(X, P), "the unit of 'x' is missing"),
    ("x,p\n" + rows(X, P), "the unit of 'x' is missing"),
    ("x [mm],p\n" + rows(X, P), "the unit of 'p' is missing"),
    ("x,p [MPa]\n" + rows(X, P), "the unit of 'x' is missing"),
    ("x [furlong],p [MPa]\n" + rows(X, P), "'furlong' is not a known unit"),
    ("x [mm],p [bar]\n" + rows(X, P), "'bar' is not a known unit"),
    ("x [MPa],p [MPa]\n" + rows(X, P), "'MPa' is not a known unit for the position"),
    ("u [mm],p [MPa]\n" + rows(X, P), "no line names a column"),
    ("x [mm],temperature [K]\n" + rows(X, P), "no line names a column"),
    ("x [mm],Distance [mm],p [MPa]\n" + rows(X, X, P), "may be 'x'"),
    ("x [mm],p [MPa],p [MPa]\n" + rows(X, P, P), "two columns are named 'p'"),
    ("x [mm],p [MPa],q [Pa]\n" + rows(X, P, Q), "'p' is given in different units, MPa and Pa"),
    ("x [mm],p [MPa],y\n" + rows(X, P), "has 2 instead of 3 fields"),
    ("x [mm],p [MPa]\n" + rows(X, P, P), "has 3 instead of 2 fields"),
    (
        "x [mm],p [MPa]\n" + rows(X, P, comma=True),
        "separate columns by ; if numbers have decimal commas",
    ),
    (with_line("0.5"), "has 1 instead of"),
    (with_line("0.5,1.0,2.0"), "has 3 instead of"),
    (with_line("0.05,nan"), "has 'nan' instead of a finite number in column 'p'"),
    (with_line("inf,3.0"), "has 'inf' instead of a finite number in column 'x'"),
    (with_line("0.05,"), "instead of"),
    (with_line("0.05,----"), "has '----' instead of a finite number in column 'p'"),
    (with_line("0.05,1_0"), "has '1_0' instead of a finite number in column 'p'"),
    (with_line("0.05,0x1F"), "has '0x1F' instead of a finite number in column 'p'"),
    (with_line("0.05,5e-324"), "has '5e-324' in column 'p', and numbers other than 0 must"),
    (with_line("1e-34,3.0"), "has '1e-34' in column 'x', and numbers other than 0 must"),
    (with_line("0.05,1e25"), "between 1e-30 and 1e+30 in SI units"),  # 1e31 Pa
    (HEAD + rows(1e35 * X, P), "between 1e-30 and 1e+30 in SI units"),
    (with_line("-0.9,3.0"), "x must rise or fall from each node"),
    (with_line(f"{X[24]:.6f},3.0"), "give each node once"),
    (HEAD + rows(X, np.where(np.abs(X) < 0.1, 0, P)), "one contact at a time"),
    (HEAD + rows(X, -P), "p must be positive at the nodes of one contact"),
    (HEAD + rows(X, 0 * P), "p must be positive at the nodes of one contact"),
    (HEAD + rows(X[20:30], P[20:30]), "ends inside the contact on both sides"),
    (HEAD + rows(X[:1], P[:1]), "must hold at least two nodes"),
    ("Step,x [mm],p 1 [MPa],p 2 [MPa]\n" + rows(0 * X, X, P, P), "and a column of load steps"),
    (
        "x [mm],p 1 [MPa],p 2 [MPa],p 3 [MPa],q 1 [MPa],q 2 [MPa]\n" + rows(X, P, P, P, Q, Q),
        "of shear",
    ),
    ("x [mm]\0,p [MPa]\n" + rows(X, P), "is not text"),
    ("x [mm],p [MPa]\n1.0,2.0 3.0\n2.0,abc\n", "has '2.0 3.0' instead"),
    (with_line("0.05," + 5000 * "1"), "instead of a finite number in column 'p'"),
    ("Step,x [mm],p [MPa]\n" + rows(np.arange(1001), np.ones(1001), np.ones(1001)), "1001 load"),
    ("Step,x [mm],p [MPa]\n" + 200 * "s" + ",1,1\nb,1,1\n", "a load step has 200 characters"),
]


@pytest.mark.parametrize("number", range(len(BAD)))
def test_a_bad_table_gets_one_message(path: Path, number: int) -> None:
    text, words = BAD[number]
    path.write_text(text, encoding="utf-8")
    with pytest.raises(BadTable) as raised:
        find(read(path), path.name, 0.5)
    message = raised.value.message
    assert words in message, message
    assert message.startswith("t.csv: ") and ";" in message and "\n" not in message
    assert len(message) < 600


def test_a_bad_table_leaves_with_two_and_no_traceback(path: Path, tmp_path: Path) -> None:
    path.write_text("x,p\n" + rows(X, P))
    result = run("edge", path, "--f", 0.5)
    assert result.exit_code == 2
    assert result.output.startswith("Error: t.csv: the unit of 'x' is missing")
    assert run("edge", tmp_path / "none.csv", "--f", 0.5).exit_code == 2
    assert run("edge", tmp_path, "--f", 0.5).exit_code == 2
    assert run("edge", path, "--f", -1).exit_code == 2
    assert run("edge", path, "--f", 0.5, "--unit", "z=mm").exit_code == 2


def test_the_command_by_hand(path: Path, tmp_path: Path) -> None:
    """A cylinder, a = 1 mm, p = 200 sqrt(1 - x**2) MPa: K_N = 200 sqrt(2) MPa/sqrt(mm); dQ = 94.25
    N/mm, that is dq = 30/sqrt(1 - x**2): K_T = 30/sqrt(2), d_1 = K_T/(f K_N) = 0.15 mm.  Exactly
    1 - sqrt(1 - 2*0.15): f (p_1 + p_2) has 0.3 of its square to give."""
    path, page, table = (tmp_path / name for name in ("t.csv", "t.html", "out.csv"))
    path.write_text("x [mm],p [MPa],dq [MPa]\n" + rows(X, P, Q))
    result = run("edge", path, "--f", 0.5, "--html", page, "--csv", table)
    assert result.exit_code == 0, result.output
    found = find(read(path), "t.csv", 0.5)
    for edge in found.edges:
        assert_allclose(edge.pressure.K_N, 200e6 * np.sqrt(2) * np.sqrt(1000), rtol=0.01)
    for zone in found.zones:
        assert_allclose(zone.d, 1e-3 * (1 - np.sqrt(0.7)), rtol=0.01)
    shown = page.read_text()
    assert "<svg" in shown and "^" not in shown and "sqrt" not in shown and "**" not in shown
    assert "L<sub>N</sub> [MPa/mm<sup>3/2</sup>]" in shown and "K<sub>N</sub> √s" in shown
    assert "slip zone [µm]" in shown
    assert table.read_text().startswith("load_step,side,edge")


def test_loads_in_place_of_shear(path: Path) -> None:
    path.write_text(HEAD + rows(X, P))
    without = run("edge", path, "--f", 0.5)
    assert without.exit_code == 0 and "the slip zones cannot be computed" in without.output
    found = find(read(path), "t.csv", 0.5, dQ=30e6 * np.pi * 1e-3)
    for zone in found.zones:
        assert_allclose(zone.d, 1e-3 * (1 - np.sqrt(0.7)), rtol=0.01)


def test_both_ends_of_a_half_cycle(path: Path) -> None:
    """The edges of two cylinders' contacts, 1 and 1.05 mm: they move by 0.05 mm."""
    wide = 210 * np.sqrt(np.maximum(1 - (X / 1.05) ** 2, 0))
    path.write_text("x [mm],p 1 [MPa],p 2 [MPa]\n" + rows(X, P, wide))
    found = find(read(path), "t.csv", 0.5, dQ=30e6 * np.pi * 1e-3)
    for zone in found.zones:
        assert_allclose(zone.da, 0.05e-3, atol=1e-6)
        assert zone.d > 0.05e-3


def test_columns_that_are_numbered_are_load_steps(path: Path) -> None:
    """p1 and p2; of Abaqus' two components of shear the second is another direction."""
    path.write_text("x [mm],p1 [MPa],p2 [MPa],q1 [MPa],q2 [MPa]\n" + rows(X, P, P, 0 * Q, Q))
    assert [(step.name, step.q.max() > 0) for step in read(path) if step.q is not None] == [
        ("p1", False),
        ("p2", True),
    ]
    path.write_text("x [mm],CPRESS [MPa],CSHEAR1 [MPa],CSHEAR2 [MPa]\n" + rows(X, P, Q, 0 * Q))
    (step,) = read(path)
    assert step.q is not None and step.q.max() > 0


def test_a_contact_that_slides_has_no_slip_zone(path: Path) -> None:
    """P = 100 pi N/mm and f = 0.5 hold 100 pi over a half-cycle; 3.2 dq is 96 pi, 3.5 dq 105 pi."""
    for factor, slides in ((3.2, False), (3.5, True)):
        path.write_text("x [mm],p [MPa],dq [MPa]\n" + rows(X, P, factor * Q))
        found = find(read(path), "t.csv", 0.5)
        assert any("slides" in note for note in found.notes) is slides
        assert all(np.isnan(zone.d) == slides for zone in found.zones)


@pytest.mark.parametrize(("units", "told"), [("m Pa", True), ("mm Pa", True), ("mm MPa", False)])
def test_units_that_cannot_be_are_told(units: str, told: bool, path: Path) -> None:
    path.write_text("x [{}],p [{}]\n".format(*units.split()) + rows(X, P))
    found = find(read(path), "t.csv", 0.5)
    assert any("check the units" in note for note in found.notes) is told


@pytest.mark.parametrize("size", [1e-28, 1e27])
@pytest.mark.parametrize("wide", [1e-25, 1e26])
def test_numbers_of_any_size_that_is_allowed(path: Path, size: float, wide: float) -> None:
    """Nothing overflows: warnings are errors here.  K_N goes with p/sqrt(x)."""
    path.write_text("x [m],p [Pa]\n" + "".join(f"{x},{p}\n" for x, p in zip(X, P, strict=True)))
    plain = find(read(path), path.name, 0.5)
    path.write_text(
        "x [m],p [Pa]\n" + "".join(f"{wide * x},{size * p}\n" for x, p in zip(X, P, strict=True))
    )
    found = find(read(path), path.name, 0.5)
    for large, one in zip(found.edges, plain.edges, strict=True):
        assert_allclose(large.pressure.K_N, one.pressure.K_N * size / wide**0.5, rtol=1e-6)


def test_one_edge_alone(path: Path) -> None:
    part = X < -0.1
    path.write_text("x [mm],p [MPa],dq [MPa]\n" + rows(X[part], P[part], Q[part]))
    found = find(read(path), "t.csv", 0.5)
    assert [zone.side for zone in found.zones] == ["left"]
    assert any("ends inside the contact" in note for note in found.notes)


def test_the_example_is_what_the_solver_gives() -> None:
    assert example.PATH.read_text() == example.table()


def test_the_chain_on_the_example() -> None:
    """Coarse table -> coefficients -> slip zones, within two standard deviations of the exact."""
    found = find(read(example.PATH), "t.csv", example.F)
    law, a, c = example.LAW, example.A, example.C
    K = flat_rounded.K_N(a, c, **law)
    here = Contact(a, c, 0.0)
    zone = flat_rounded.stick_zone(here, here, example.DQ, 0.0, f=example.F, **law)
    exact = {"left": a - zone.m, "right": c - zone.n}
    for edge, place, true in zip(found.edges, (-a, c), K, strict=True):
        fit = edge.pressure
        assert abs(1e3 * fit.edge - place) < 2e3 * fit.edge_error
        assert abs(fit.K_N - true * 1e6 * 1000**0.5) < 2 * fit.K_N_error
    for one in found.zones:
        off = abs(1e3 * one.d - exact[one.side])
        assert off < 2e3 * np.hypot(one.error, one.series)
        assert off < 0.1 * exact[one.side]


def test_a_table_that_was_given_is_not_written_over(path: Path, tmp_path: Path) -> None:
    path.write_text("mine\n")
    table = tmp_path / "given.csv"
    table.write_text(HEAD + rows(X, P))
    for target, why in ((path, "exists and was not made by"), (tmp_path, "is a directory")):
        result = run("edge", table, "--f", 0.5, "--csv", target)
        assert result.exit_code == 2
        assert why in result.output and "choose another path with --csv" in result.output
    assert path.read_text() == "mine\n"


def test_a_unit_that_the_table_gives_otherwise_is_refused(path: Path) -> None:
    path.write_text(HEAD + rows(X, P))
    result = run("edge", path, "--f", 0.5, "--unit", "p=Pa")
    assert result.exit_code == 2
    assert "'p' is given in different units, MPa and Pa; use one unit" in result.output
    assert run("edge", path, "--f", 0.5, "--unit", "p=MPa").exit_code == 0


@pytest.mark.parametrize("label", ["=1+1", "+A1", "-A1", "@SUM(A1)", "first"])
def test_no_spreadsheet_computes_a_label(path: Path, tmp_path: Path, label: str) -> None:
    lines = rows(X, P).splitlines()
    path.write_text("Step,x [mm],p [MPa]\n" + "".join(f"{label},{line}\n" for line in lines))
    assert run("edge", path, "--f", 0.5, "--csv", tmp_path / "out.csv").exit_code == 0
    _, first, *_ = (tmp_path / "out.csv").read_text().splitlines()
    assert first.startswith("first,left" if label == "first" else f"'{label},left")
