"""The sheet: a mapping that checks dimensions and knows when its formulas apply."""

from dataclasses import replace

import pytest
from sympy import Or, Symbol

from derive.command.errors import NotProven
from derive.proof.verdict import Proof, Verdict
from derive.sheet.formulas import (
    FormulaSheet,
    contact_conditions,
    inside_contact,
    tilt_conditions,
)
from derive.symbols import a, alpha, c, h, x
from tests.derive.bodies import assumed, sheet

phi, psi, b = (Symbol(name, positive=True) for name in ("phi", "psi", "b"))


@pytest.mark.parametrize(
    ("name", "extra"),
    [
        *(("hertz", set()), ("quartic", set()), ("wedge", {a > 0, c > 0})),
        *(("shifted_wedge", {a > -b, c > b}), ("half_parabola", {c > 0})),
        ("flat_rounded", {Or(a > b, c > b)}),
        ("flat_cornered", {c > -b, Or(a > b, c > b), a > -b}),
        ("rounded_wedge", {c > -b, a > -b}),
    ],
)
def test_a_contact_has_a_width_and_is_not_all_straight(name: str, extra: set[object]) -> None:
    conditions = contact_conditions(sheet(name).frame)
    assert set(conditions) == {h > 0, *extra}
    assert len(conditions) == 1 + len(extra)


@pytest.mark.parametrize(
    ("name", "bounds"),
    [
        ("hertz", set()),
        ("wedge", {alpha > -phi, alpha < phi}),  # slopes -phi + alpha < 0 < phi + alpha
        ("unequal_wedge", {alpha > -psi, alpha < phi}),
        ("half_parabola", {alpha < 0}),  # the straight half must slope down
        ("flat_rounded", set()),
    ],
)
def test_the_tilt_leaves_slopes_of_both_signs(name: str, bounds: set[object]) -> None:
    assert {str(t) for t in tilt_conditions(sheet(name).frame)} == {
        "P > 0",
        *(str(bound) for bound in bounds),
    }


def test_a_place_inside_lies_between_the_edges() -> None:
    frame = sheet("hertz").frame
    assert set(inside_contact(frame, x)) == {h > 0, x > -a, x < c}


def judged(load: Proof | None, others: Verdict) -> FormulaSheet:
    """The sheet of a cylinder with this proof of its load."""
    of = assumed(sheet("hertz"), others)
    return replace(of, formulas={**of.formulas, "load": replace(of["load"], proof=load)})


@pytest.mark.parametrize("verdict", [Verdict.REFUTED, Verdict.UNKNOWN, None])
def test_one_formula_that_does_not_hold_spoils_the_sheet(verdict: Verdict | None) -> None:
    with pytest.raises(NotProven, match="load of 'hertz'"):
        judged(verdict and Proof(verdict, "here"), Verdict.PROVEN).demand_proven()
