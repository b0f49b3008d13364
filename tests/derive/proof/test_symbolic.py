"""What is false is not proven by algebra, whatever the number of kinks."""

from dataclasses import replace

import pytest
from sympy import Expr, Max, Rational

from derive.proof.symbolic import symbolic_proof
from derive.symbols import a, c
from tests.derive.bodies import sheet

FALSE = {
    "sign": lambda expr: -expr,
    "factor": lambda expr: expr * (1 + Rational(1, 10**25)),
    "nothing at a = c": lambda expr: expr + (a - c) / 10**12,
    "nothing for a < c": lambda expr: expr + Max(0, a - c) ** 3 / 10**12,
}
FORMULAS = (
    *("pressure", "K_N_left", "K_N_right", "load_rate", "edge_ratio", "punch"),
    *("load_by_a", "tilt_by_c", "full_stick_change"),
)


LONG = [pytest.param(body, marks=pytest.mark.slow) for body in ("two_radii", "flat_rounded")]


@pytest.mark.parametrize("body", ["wedge", "flat_cornered", *LONG])
@pytest.mark.parametrize("name", FORMULAS)
def test_a_rate_is_proven_and_what_is_not_it_is_not(body: str, name: str) -> None:
    true = sheet(body)
    assert symbolic_proof(true, name) is not None
    for change in FALSE.values():
        expr: Expr = change(true[name].expr)
        false = replace(true, formulas={**true.formulas, name: replace(true[name], expr=expr)})
        assert symbolic_proof(false, name) is None
