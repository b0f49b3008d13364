"""Quotients of exponentials, close to a break and where exponentials leave float64."""

import numpy as np
import pytest
from sympy import Expr, Rational, Symbol, exp, lambdify, oo, sqrt

from derive.codegen.decay import decaying

t = Symbol("t", positive=True)
b = Symbol("b", positive=True)

QUOTIENTS = [
    (exp(t / b) / (1 + exp(t / b)), 1.0),
    (exp(t / b) / (1 + exp(t / b)) ** 2, 0.0),
    ((1 - t * exp(t / b + 1)) / (exp(t / b) + 2), -oo),
    (t * exp(2 * t / b) / (3 + exp(3 * t / b + 1)), 0.0),
    ((exp(t / b) - exp(-t / b)) / (exp(t / b) + exp(-t / b)), 1.0),
    (exp(-t / b) / (2 + exp(-t / b) + exp(t / (2 * b))), 0.0),
]


@pytest.mark.parametrize(("expr", "far"), QUOTIENTS)
def test_it_is_the_same_and_has_its_limit_far_off(expr: Expr, far: float) -> None:
    """At exp(1e4) numbers end: a quotient of two infinities would be no number."""
    found = decaying(expr, t)
    for at in (Rational(1, 7), Rational(5, 2), Rational(40)):
        values = {t: at, b: Rational(4, 5)}
        assert abs((found - expr).subs(values).evalf(40)) < 1e-30
    value = lambdify((t, b), found, "numpy")
    with np.errstate(over="ignore"):
        at_distance = value(np.float64(1e4), np.float64(0.8))
    assert np.isfinite(at_distance)
    if far != -oo:
        assert at_distance == pytest.approx(float(far), abs=1e-300)


@pytest.mark.parametrize(
    "expr",
    [exp(t) + t, exp(t) / (1 + t), 1 / (1 + exp(-t)), 1 / (1 + exp(t**2)), 1 / t],
)
def test_what_does_not_grow_below_a_line_stays(expr: Expr) -> None:
    assert decaying(expr, t) == expr


def test_rates_that_have_no_common_measure_stay() -> None:
    expr = exp(sqrt(2) * t) / (1 + exp(t))
    assert decaying(expr, t) == expr
