"""The sheet: a mapping that checks dimensions and knows when its formulas apply."""

from dataclasses import replace

import pytest
from sympy import Integer, Or, Symbol

from derive.errors import DimensionMismatch, NotProven
from derive.proof.verdict import Proof, Verdict
from derive.sheet import (
    Formula,
    FormulaSheet,
    contact_conditions,
    inside_contact,
    load_conditions,
    tilt_conditions,
)
from derive.symbols import E_star, P, a, alpha, c, h, x
from derive.symbols import f as friction
from derive.units import parse_unit
from tests.derive.bodies import BODIES, geometry, sheet

phi, psi, b = (Symbol(name, positive=True) for name in ("phi", "psi", "b"))


def formula(expr: object, unit: str = "N/m") -> Formula:
    return Formula("extra", Symbol("T"), (a, c), Integer(0) + expr, "a test", unit, "here", ())


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
    longer = body.plus(formula(E_star * a))
    assert "extra" in longer
    assert "extra" not in body
    assert len(longer) == len(body) + 1


@pytest.mark.parametrize(
    ("expr", "unit"), [(E_star, "N/m"), (E_star * a + c, "N/m"), (a, "Pa"), (a + E_star, "m")]
)
def test_a_formula_of_another_dimension_is_refused(expr: object, unit: str) -> None:
    with pytest.raises(DimensionMismatch) as caught:
        sheet("hertz").plus(formula(expr, unit))
    assert "extra of 'hertz'" in caught.value.message or "in" in caught.value.where


@pytest.mark.parametrize("name", BODIES)
def test_every_symbol_of_every_formula_has_a_dimension(name: str) -> None:
    body = sheet(name)
    for f in body.values():
        assert f.expr.free_symbols <= set(body.dimensions)
        assert set(f.arguments) <= set(body.dimensions)
        parse_unit(f.unit)


@pytest.mark.parametrize("name", BODIES)
def test_a_flat_formula_holds_arguments_material_and_parameters_only(name: str) -> None:
    body = sheet(name)
    parameters = {q.symbol for q in body.geometry.parameters}
    for key, f in body.items():
        lever = {Symbol("e", real=True)} if P in f.arguments else set()
        assert body.flat(key).free_symbols <= {*f.arguments, E_star, friction, *parameters} | lever


@pytest.mark.parametrize("name", BODIES)
def test_every_formula_says_what_it_is_and_where_it_comes_from(name: str) -> None:
    for f in sheet(name).values():
        assert f.meaning
        assert f.source
        assert f.conditions
        assert f.proof is None


@pytest.mark.parametrize(
    ("name", "extra"),
    [
        ("hertz", set()),
        ("wedge", {a > 0, c > 0}),
        ("shifted_wedge", {a > -b, c > b}),
        ("half_parabola", {c > 0}),
        ("flat_rounded", {Or(a > b, c > b)}),
        ("flat_cornered", {c > -b, Or(a > b, c > b), a > -b}),
        ("rounded_wedge", {c > -b, a > -b}),
        ("quartic", set()),
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


def test_loads_are_positive() -> None:
    (condition,) = load_conditions(sheet("hertz").frame)
    assert str(condition) == "P > 0"
    assert (condition.lhs, condition.rhs) == (P, 0)


def test_a_place_inside_lies_between_the_edges() -> None:
    frame = sheet("hertz").frame
    assert set(inside_contact(frame, x)) == {h > 0, x > -a, x < c}


@pytest.mark.parametrize(
    ("name", "closed"),
    [
        ("hertz", True),
        ("wedge", True),
        ("shifted_wedge", True),
        ("flat_rounded", False),
        ("quartic", False),
        ("two_radii", False),
    ],
)
def test_closed_means_that_the_loads_give_the_contact(name: str, closed: bool) -> None:
    assert sheet(name).is_closed("contact_a") is closed
    assert sheet(name).is_closed("contact_at_tilt_a") is closed
    assert sheet(name).is_closed("load")


def test_definitions_name_only_what_is_held() -> None:
    assert sheet("hertz").definitions == {}
    for name in BODIES:
        body = sheet(name)
        printed = set().union(*(body.shown(key).free_symbols for key in body))
        said = set().union(*(d.free_symbols for d in body.definitions.values()), printed)
        assert set(body.definitions) <= said
        free = {q.symbol for q in body.geometry.quantities.values()}
        assert said <= free | set(body.definitions)


def test_a_sheet_without_proofs_may_not_be_used() -> None:
    with pytest.raises(NotProven) as caught:
        sheet("hertz").demand_proven()
    assert "tilt of 'hertz'" in str(caught.value)


@pytest.mark.parametrize("verdict", [Verdict.REFUTED, Verdict.UNKNOWN])
def test_one_formula_that_does_not_hold_spoils_the_sheet(verdict: Verdict) -> None:
    body = sheet("hertz")
    judged = {
        name: replace(f, proof=Proof(verdict if name == "load" else Verdict.PROVED, "here"))
        for name, f in body.items()
    }
    with pytest.raises(NotProven) as caught:
        replace(body, formulas=judged).demand_proven()
    assert "load of 'hertz'" in str(caught.value)


@pytest.mark.parametrize("verdict", [Verdict.PROVED, Verdict.NUMERICAL])
def test_a_sheet_whose_formulas_all_hold_may_be_used(verdict: Verdict) -> None:
    body = sheet("hertz")
    judged = {name: replace(f, proof=Proof(verdict, "here")) for name, f in body.items()}
    whole = replace(body, formulas=judged)
    assert whole.demand_proven() is whole


def test_flat_and_shown_leave_a_formula_without_kinks_alone() -> None:
    body = sheet("hertz")
    assert body.flat("load") == body.shown("load") == body["load"].expr


def test_the_latex_of_a_formula_has_both_sides() -> None:
    load = sheet("wedge")["load"]
    assert load.left == "P(a, c)"
    assert load._repr_latex_().startswith(r"$\displaystyle P(a, c) = ")
    assert load._repr_latex_().endswith("$")
    assert sheet("wedge")._repr_latex_().startswith("$$\n\\begin{aligned}")


def test_a_sheet_can_be_made_bare_and_filled() -> None:
    body = sheet("hertz")
    bare = FormulaSheet(geometry("hertz"), body.frame)
    assert len(bare) == 0
    assert list(bare.plus(body["tilt"])) == ["tilt"]


def test_replacing_a_formula_leaves_the_first_sheet_alone() -> None:
    body = sheet("hertz")
    wrong = replace(body, formulas={**body.formulas, "load": formula(E_star * a)})
    assert body["load"].expr != wrong["load"].expr
