"""Expressions as polynomials in FLINT, against SymPy's own algebra."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import E, Expr, Integer, Mul, Rational, Symbol, cos, exp, expand, factor, pi, sqrt, srepr

from derive.symbols import a, c, h, s, x
from derive.theory.ring import Ring, factored, linear_parts, powers_of

b, theta = Symbol("b", positive=True), Symbol("theta_1", nonnegative=True)


@pytest.mark.parametrize(
    "expr",
    [h ** Rational(3, 2) + sqrt(h) * b, sqrt(h) * a + sqrt(h) * c, (a * cos(x) + c * cos(x)) / b],
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


def test_linear_parts_are_what_stands_before_the_symbols() -> None:
    parts = linear_parts((theta * (a**2 - c**2) + b) / (a + c), [theta])
    assert parts == {theta: a - c, 1: b / (a + c)}


@pytest.mark.parametrize("expr", [theta**2 + a, theta * b, 1 / (theta + a), cos(theta)], ids=str)
def test_what_is_not_linear_has_no_linear_parts(expr: Expr) -> None:
    assert linear_parts(expr, [theta, b]) is None


def test_powers_of_a_symbol() -> None:
    found = powers_of(s, (a - s) ** 2 / c + s * theta)
    assert found == {0: a**2 / c, 1: theta - 2 * a / c, 2: 1 / c}


@pytest.mark.parametrize(("least", "left"), [(0, theta), (1, theta), (2, theta**3)])
def test_powers_are_lowered_down_to_the_least_that_is_left(least: int, left: Expr) -> None:
    """theta**5 with theta**2 = a + c: twice, or once where two powers of theta must stay."""
    ring = Ring([theta**5, a + c])
    low = ring.lowered(ring.polynomial(theta**5), theta, 2, a + c, least)
    times = 2 if left == theta else 1
    assert ring.written(low) == expand((a + c) ** times * left)


def test_a_power_of_a_number_is_a_number_times_a_power() -> None:
    power = 2 ** (Symbol("k", positive=True) - 3)
    ring = Ring([power])
    assert ring.written(ring.polynomial(power)).subs(Symbol("k", positive=True), 5) == 4
    assert len(ring.generators) == 1  # 2**k; 1/8 is a coefficient


def test_a_root_of_a_product_is_one_of_primes() -> None:
    """sqrt(6) = sqrt(2) sqrt(3), sqrt(12) = 2 sqrt(3): no further generator, and so no relation."""
    ring = Ring([sqrt(6) * a, sqrt(2) * c, sqrt(12)])
    assert {*ring.roots} == {sqrt(2), sqrt(3)}
    assert ring.polynomial(sqrt(6) * a) == ring.polynomial(sqrt(2)) * ring.polynomial(sqrt(3) * a)


def test_the_number_e_below_a_line_is_the_same_generator() -> None:
    """SymPy writes 1/E as exp(-1), in which E is not found."""
    parts = linear_parts(a * theta / E + E * c, [theta])
    assert parts is not None
    assert parts == {1: E * c, theta: a * exp(-1)}
