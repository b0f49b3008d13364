"""The three symbols of a kink: how they change with the edges."""

import mpmath
import pytest
from mpmath import mpf
from sympy import Expr, Symbol

from derive.symbols import a, c, x
from tests.derive.bodies import close, number, sheet

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", ["wedge_on_the_left", "flat_rounded"])
@pytest.mark.parametrize("edge", [a, c], ids=str)
@pytest.mark.parametrize(
    ("left", "right"),
    [(2.0, 1.5), (0.75, 3.0), (-1.0, 3.0), (3.0, -1.0)],
    ids=["a > c", "a < c", "right of all kinks", "left of all kinks"],
)
def test_the_chain_rule_is_the_derivative(
    name: str, edge: Symbol, left: float, right: float
) -> None:
    frame = sheet(name).frame
    if left + right < 3 and any(not k.clipped for k in frame.kinks):
        left, right = left + 2, right + 2  # such a body has no contact beside its kink
    place = (right - left) / 2 + 0.3125
    for k in frame.kinks:
        for symbol in (k.theta, k.w, k.L, x * k.theta * k.w + a * c * k.L**2):
            ruled = number(frame.flat(frame.diff(symbol, edge)), a=left, c=right, x=place)
            flat = frame.flat(symbol)

            def moved(step: mpf, flat: Expr = flat) -> mpf:
                ends = {"a": mpf(left), "c": mpf(right)}
                ends[edge.name] += step
                return number(flat, **ends, x=place)

            assert close(ruled, mpmath.diff(moved, 0), digits=10, scale=1)
