"""Tables as programs export them, and many that are wrong: one message each."""

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from derive.command.errors import BadTable
from derive.edge.find import Findings, Zone, find
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


def zones(found: Findings) -> list[Zone]:
    return [e.zone for e in found.edges if e.zone]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "t.csv"


def both_steps(first: np.ndarray, second: np.ndarray) -> str:
    """The pressures at the same nodes at two load steps."""
    lines = [f"{n},{line}" for n, p in ((1, first), (2, second)) for line in rows(X, p).split()]
    return "\n".join(["Step,x [mm],p [MPa]", *lines])


def with_line(line: str) -> str:
    """A good table with one more line at its middle."""
    lines = (HEAD + rows(X, P)).splitlines()
    return "\n".join([*lines[:26], line, *lines[26:]]) + "\n"


GOOD = {
    "commas": HEAD + rows(X, P),
    "semicolons, decimal commas": "x [mm];p [MPa]\n" + rows(X, P, by=";", comma=True),
    "tabs, decimal commas": "x [mm]\tp [MPa]\n" + rows(X, P, by="\t", comma=True),
    "other names and units": "COORD1 [ um ], CPRESS [N/mm^2]\n" + rows(1e3 * X, P),
    "units in SI": "Position [m],Pressure [Pa]\n"
    + "".join(f"{x:.9e},{p:.9E}\n" for x, p in zip(1e-3 * X, 1e6 * P, strict=True)),
    "comments, blank lines, quotes": '# by hand\n\n"x [mm]","p [MPa]"\n\n# more\n' + rows(X, P),
    "labels": "Label;x [mm];p [MPa];\n"
    + "".join(f"A.{i};{x:.6f};{p:.6f};\n" for i, (x, p) in enumerate(zip(X, P, strict=True))),
    "from right to left": HEAD + rows(X[::-1], P[::-1]),
    "byte order mark": "\ufeff" + HEAD + rows(X, P),
}


@pytest.mark.parametrize("name", GOOD)
def test_a_table_is_read(path: Path, name: str) -> None:
    path.write_text(GOOD[name], encoding="utf-8")
    (step,) = read(path)
    assert_allclose(step.x, 1e-3 * X, atol=1e-9)
    assert_allclose(step.p, 1e6 * P, atol=1.0)


def test_a_thousand_pounds_force_per_square_inch_by_hand(path: Path) -> None:
    """1 lbf = 4.4482216 N and 1 in = 25.4 mm: 1 ksi = 4448.2216 N/(25.4 mm)**2 = 6.8947573 MPa.
    The shear has a unit of its own."""
    path.write_text("x [in],p [ksi],q [psi]\n0,0,0\n1,1,1\n")
    (step,) = read(path)
    assert step.q is not None
    assert_allclose([step.x[1], step.p[1], step.q[1]], [0.0254, 6894757.3, 6894.7573], rtol=1e-8)


def test_a_column_distinguishes_load_steps(path: Path) -> None:
    path.write_text(both_steps(P, 0.5 * P))
    first, second = read(path)
    assert (first.name, second.name) == ("1", "2")
    assert_allclose(second.p, 0.5e6 * P, atol=1.0)


BAD = [
    ("   \n\n", "has no rows of numbers"),
    (HEAD, "has no rows of numbers"),
    (rows(X, P), "no column is named x, position, coord1; the first line is '-1.13"),
    ("Contact report\n" + HEAD + rows(X, P), "the first line is 'Contact report'"),
    ("x [mm] p [MPa]\n" + rows(X, P, by=" "), "the first line is 'x [mm] p [MPa]'"),
    ("x [mm],p 1 [MPa],p 2 [MPa]\n" + rows(X, P, P), "no column is named p, pressure"),
    ("x,p\nmm,MPa\n" + rows(X, P), "the unit of 'x' is missing"),
    ("x [furlong],p [MPa]\n" + rows(X, P), "'furlong' is not a known unit of 'x'"),
    ("x [mm],p [mPa]\n" + rows(X, P), "'mPa' is not a known unit of 'p'"),
    ("x [MPa],p [MPa]\n" + rows(X, P), "'MPa' is not a known unit of 'x'"),
    ("x [mm],Position [mm],p [MPa]\n" + rows(X, X, P), "columns 'x' and 'Position' are x"),
    ("x [mm],p [MPa],y\n" + rows(X, P), "has 2 instead of 3 fields"),
    (HEAD + rows(X, P, comma=True), "line 2 has 4 instead of 2 fields"),
    (with_line("0.5"), "line 27 has 1 instead of 2 fields"),
    (with_line("0.05,nan"), "line 27 has 'nan' in column 'p' instead of 0 or a finite number"),
    (with_line("inf,3.0"), "has 'inf' in column 'x'"),
    (with_line("0.05,"), "has '' in column 'p'"),
    (with_line("0.05,1_0"), "has '1_0' in column 'p'"),
    (with_line('0.05,"1,5"'), "has '1,5' in column 'p'"),
    (with_line("0.05,5e-324"), "has '5e-324' in column 'p'"),
    (with_line("0.05,1e25"), "between 1e-30 and 1e+30 in SI units"),  # 1e31 Pa
    (with_line("0.05," + 5000 * "1"), "in column 'p' instead of 0 or a finite number"),
    (with_line("-0.9,3.0"), "x must rise or fall from each node"),
    (HEAD + rows(X[20:30], P[20:30]), "ends inside the contact on both sides"),
    (
        "Step,x [mm],p [MPa]\n" + rows(np.arange(1001), np.ones(1001), np.ones(1001)),
        "has 1001 load steps",
    ),
    ("Step,x [mm],p [MPa]\n" + 200 * "s" + ",1,1\nb,1,1\n", "names of up to 200 characters"),
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


@pytest.mark.parametrize("coding", ["utf-16", "latin-1"])
def test_another_encoding_is_refused(path: Path, coding: str) -> None:
    path.write_text(HEAD.replace("mm", "µm") + rows(X, P), encoding=coding)
    with pytest.raises(BadTable, match="the file is not text in UTF-8; write one line of names"):
        read(path)


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
    for zone in zones(found):
        assert_allclose(zone.d, 1e-3 * (1 - np.sqrt(0.7)), rtol=0.01)
    shown = page.read_text()
    shown, count = re.subn(r'"data:image/svg[^"]*"', "", shown)
    assert count == 2 and "^" not in shown and "sqrt" not in shown and "**" not in shown
    assert "L<sub>N</sub> [MPa/mm<sup>3/2</sup>]" in shown and "K<sub>N</sub> √s" in shown
    assert "slip zone [µm]" in shown
    assert table.read_text().startswith("load_step,side,edge")


def test_loads_in_place_of_shear(path: Path) -> None:
    path.write_text(HEAD + rows(X, P))
    without = run("edge", path, "--f", 0.5)
    assert without.exit_code == 0 and "the slip zones cannot be computed" in without.output
    found = find(read(path), "t.csv", 0.5, dQ=30e6 * np.pi * 1e-3)
    for zone in zones(found):
        assert_allclose(zone.d, 1e-3 * (1 - np.sqrt(0.7)), rtol=0.01)


def test_both_ends_of_a_half_cycle(path: Path) -> None:
    """The edges of two cylinders' contacts, 1 and 1.05 mm: they move by 0.05 mm."""
    wide = 210 * np.sqrt(np.maximum(1 - (X / 1.05) ** 2, 0))
    path.write_text(both_steps(P, wide))
    found = find(read(path), "t.csv", 0.5, dQ=30e6 * np.pi * 1e-3)
    for edge in found.edges[2:]:
        assert_allclose(edge.da, 0.05e-3, atol=1e-6)
        assert edge.zone and edge.zone.d > 0.05e-3


def test_a_contact_that_slides_has_no_slip_zone(path: Path) -> None:
    """P = 100 pi N/mm and f = 0.5 hold 100 pi over a half-cycle; 3.2 dq is 96 pi, 3.5 dq 105 pi."""
    for factor, slides in ((3.2, False), (3.5, True)):
        path.write_text("x [mm],p [MPa],dq [MPa]\n" + rows(X, P, factor * Q))
        found = find(read(path), "t.csv", 0.5)
        assert any("slides" in note for note in found.notes) is slides
        assert all(np.isnan(zone.d) == slides for zone in zones(found))


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
    assert [(e.side, e.zone is None) for e in found.edges] == [("left", False)]
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
        assert edge.zone
        off = abs(1e3 * edge.zone.d - exact[edge.side])
        assert off < 2e3 * np.hypot(edge.zone.error, edge.zone.series)
        assert off < 0.1 * exact[edge.side]


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
