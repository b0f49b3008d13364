"""What is false is not proven by algebra, whatever the number of kinks, and numbers refute it."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from sympy import Expr, Max, Rational

from derive.proof.numerical import numeric_proof
from derive.proof.symbolic import symbolic_proof
from derive.proof.verdict import DIGITS, POINTS, Verdict
from derive.sheet.formulas import FormulaSheet
from derive.symbols import a, c
from tests.derive.bodies import sheet

FALSE = {
    "sign": lambda expr: -expr,
    "factor": lambda expr: expr * (1 + Rational(1, 10**25)),
    "nothing at a = c": lambda expr: expr + (a - c) / 10**12,
    "nothing for a < c": lambda expr: expr + Max(0, a - c) ** 3 / 10**12,
}
FORMULAS = (
    *("load", "moment", "pressure", "K_N_left", "K_N_right", "load_rate", "edge_ratio", "punch"),
    *("load_by_a", "tilt_by_c", "full_stick_change"),
)


def falsified(true: FormulaSheet, name: str, change: Callable[[Expr], Expr]) -> FormulaSheet:
    """The sheet with one formula changed."""
    changed = replace(true[name], expr=change(true[name].expr))
    return replace(true, formulas={**true.formulas, name: changed})


LONG = [pytest.param(body, marks=pytest.mark.slow) for body in ("two_radii", "flat_rounded")]


@pytest.mark.parametrize("body", ["wedge", "flat_cornered", *LONG])
@pytest.mark.parametrize("name", FORMULAS)
def test_a_rate_is_proven_and_what_is_not_it_is_not(body: str, name: str) -> None:
    assert symbolic_proof(sheet(body), name) is not None
    for change in FALSE.values():
        assert symbolic_proof(falsified(sheet(body), name, change), name) is None


def test_every_formula_of_a_cylinder_is_proven_and_with_another_sign_it_is_not() -> None:
    whole = sheet("hertz")
    by_numbers = {f"contact_at_tilt_{found}" for found in ("a", "c", "M")}
    for name in whole.keys() - by_numbers - {"contact_alpha", "stick_m", "stick_n"}:
        assert symbolic_proof(whole, name) is not None, name
        assert symbolic_proof(falsified(whole, name, FALSE["sign"]), name) is None, name


@pytest.mark.parametrize("name", ["tilt", "K_N_left", "stick_m", "contact_a"])
def test_numbers_agree_with_what_is_true_and_refute_what_is_not(name: str) -> None:
    """Routes by quadrature of g(x), at the ends of the stick zone, and by substitution."""
    proof = numeric_proof(sheet("hertz"), name)
    assert proof is not None and proof.verdict == Verdict.NUMERICAL
    assert proof.points == POINTS and proof.digits >= DIGITS
    refuted = numeric_proof(falsified(sheet("hertz"), name, FALSE["factor"]), name)
    assert refuted is not None and refuted.verdict == Verdict.REFUTED
