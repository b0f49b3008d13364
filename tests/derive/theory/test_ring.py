"""Expressions as polynomials in FLINT, against SymPy's own algebra."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import E, Expr, Integer, Mul, Rational, Symbol, cos, exp, expand, factor, pi, sqrt, srepr

from derive.symbols import a, c, h, x
from derive.theory.ring import factored, linear_parts

b, theta = Symbol("b", positive=True), Symbol("theta_1", nonnegative=True)


@pytest.mark.parametrize(
    "expr",
    [
        h ** Rational(3, 2) + sqrt(h) * b,
        sqrt(h) * a + sqrt(h) * c,
        (a * cos(x) + c * cos(x)) / b,
        a * b / sqrt(2) + b * c / sqrt(2),
    ],
    ids=str,
)
def test_roots_and_functions_are_factored_as_sympy_factors(expr: Expr) -> None:
    assert srepr(factored(expr)) == srepr(factor(expr))


_sum = st.lists(
    st.tuples(st.integers(-3, 3), st.lists(st.sampled_from([a, b, c, theta, pi]), max_size=3)),
    min_size=1,
    max_size=4,
).map(lambda terms: sum((n * Mul(*held) for n, held in terms), Integer(0)))


@settings(max_examples=60, deadline=None)
@given(_sum, _sum, _sum.filter(lambda total: expand(total) != 0), st.integers(1, 6))
def test_random_quotients_are_factored_as_sympy_factors(
    p: Expr, q: Expr, divisor: Expr, number: int
) -> None:
    expr = (p * q + p) / (number * divisor)
    assert srepr(factored(expr)) == srepr(factor(expr))


def test_the_number_e_below_a_line_is_the_same_generator() -> None:
    """SymPy writes 1/E as exp(-1), in which E is not found."""
    parts = linear_parts(a * theta / E + E * c, [theta])
    assert parts is not None
    assert parts == {1: E * c, theta: a * exp(-1)}
