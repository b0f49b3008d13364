"""The sheet: a mapping that checks dimensions and knows when its formulas apply."""

from dataclasses import replace

import pytest
from sympy import Or, Symbol

from derive.command.errors import NotProven
from derive.proof.verdict import Proof, Verdict
from derive.sheet.formulas import (
    Formula,
    FormulaSheet,
    contact_conditions,
    inside_contact,
    tilt_conditions,
)
from derive.symbols import E_star, P, a, alpha, c, h, x
from derive.symbols import f as friction
from tests.derive.bodies import BODIES, assumed, sheet

phi, psi, b = (Symbol(name, positive=True) for name in ("phi", "psi", "b"))


def test_a_sheet_is_a_mapping_in_the_order_of_derivation() -> None:
    body = sheet("hertz")
    assert list(body)[:4] == ["tilt", "load", "moment", "pressure"]
    assert len(body) == len(list(body)) == len(body.formulas)
    assert "load" in body
    assert "slip" not in body
    assert all(body[name].name == name for name in body)
    with pytest.raises(KeyError):
        body["slip"]


def test_one_more_formula_makes_a_new_sheet() -> None:
    body = sheet("hertz")
    more = Formula("extra", Symbol("T"), (a, c), E_star * a, "a test", "N/m", "here", ())
    longer = body.plus(more)
    assert "extra" in longer and "extra" not in body
    assert len(longer) == len(body) + 1


@pytest.mark.enough("hertz", "flat_rounded", "two_radii", "three_corners")
@pytest.mark.parametrize("name", BODIES)
def test_a_formula_has_a_meaning_and_a_source_and_holds_what_a_user_gives_alone(name: str) -> None:
    body = sheet(name)
    parameters = {q.symbol for q in body.geometry.parameters}
    for key, f in body.items():
        assert f.meaning and f.source and f.conditions and f.proof is None
        lever = {Symbol("e", real=True)} if P in f.arguments else set()
        assert body.flat(key).free_symbols <= {*f.arguments, E_star, friction, *parameters} | lever


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


@pytest.mark.parametrize("verdict", [Verdict.PROVEN, Verdict.NUMERICAL])
def test_a_sheet_whose_formulas_all_hold_may_be_used(verdict: Verdict) -> None:
    whole = assumed(sheet("hertz"), verdict)
    assert whole.demand_proven() is whole


def test_the_latex_of_a_formula_has_both_sides() -> None:
    assert sheet("wedge")["load"]._repr_latex_().startswith(r"$\displaystyle P(a, c) = ")
    assert sheet("wedge")._repr_latex_().startswith("$$\n\\begin{aligned}")
