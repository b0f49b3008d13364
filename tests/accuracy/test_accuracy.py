"""Some generated functions are within the bounds that `make accuracy` states, at few points."""

import mpmath
import pytest
from mpmath import mpf

from tests.accuracy.measure import CATALOGUE, Worst, worst_of
from tests.accuracy.reference import Problem
from tests.accuracy.regions import BULK, EXTREME, KINKS
from tests.accuracy.report import page

pytestmark = pytest.mark.slow

NAMES = [entry.name for entry in CATALOGUE]


@pytest.mark.enough("flat_rounded-*", "wedge-*", "rounded_wedge-contact*")
@pytest.mark.parametrize("name", ["load", "pressure", "L_N", "contact", "contact_at_tilt"])
@pytest.mark.parametrize("body", ["wedge", "flat_rounded", "rounded_wedge", "quartic"])
def test_contacts_are_within_their_bounds(body: str, name: str) -> None:
    rows = [*worst_of(body, name, 40)]
    assert {BULK, EXTREME} <= {row.region for row in rows}
    for row in rows:
        assert row.met and not row.lost, row


@pytest.mark.enough("flat_rounded-*")
@pytest.mark.parametrize("name", [n for n in NAMES if n.startswith(("stick", "shear", "march"))])
@pytest.mark.parametrize("body", ["wedge", "flat_rounded"])
def test_cycles_are_within_their_bounds(body: str, name: str) -> None:
    for row in worst_of(body, name, 20):
        assert row.met, row


@pytest.mark.parametrize("name", ["load", "pressure", "contact", "stick_zone, moderate"])
def test_what_is_integrated_is_within_its_bounds(name: str) -> None:
    for row in worst_of("hyperbola", name, 20):
        assert row.met and not row.lost, row


def test_a_solution_and_its_condition() -> None:
    """x**2 = p, x y = q: dx/x = dp/(2 p), dy/y = dq/q - dp/(2 p)."""

    def off(u: list[mpf], given: dict[str, mpf]) -> list[mpf]:
        return [u[0] ** 2 - given["p"], u[0] * u[1] - given["q"]]

    answer = Problem(off).answer((1.4, 2.1), {"p": 2.0, "q": 3.0})
    x, y = answer.numbers
    with mpmath.workdps(40):
        assert abs(x - mpmath.sqrt(2)) < mpf(10) ** -30
        assert abs(y - 3 / mpmath.sqrt(2)) < mpf(10) ** -30
    assert answer.moved == pytest.approx([float(x) / 2, 1.5 * float(y)])


def test_the_page_tells_what_is_met_and_what_is_not() -> None:
    rows = [
        Worst("hertz", "load", BULK, 8, 0, 2e-16),
        Worst("hertz", "load", KINKS, 8, 1, 3e-11, True, 1e6),
        Worst("hertz", "load", EXTREME, 8, 0, 4e-11, False, 1.0, {"a": 0.5}),
    ]
    text = page(rows, 8)
    assert "Of 3 figures, 2 meet their bounds" in text
    assert "| load | 2.0e-16 | ~3.0e-11 (1 of 8) | **4.0e-11** |" in text
    assert "condition 1.0e+00, at a = 0.5" in text
