"""The ring of the formulas: one form for each, and an exact answer to "is it zero"."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mpf
from sympy import Expr, Integer, Rational, Symbol

from derive.symbols import a, c, h
from derive.theory.algebra import is_zero, reduced, tidy
from tests.derive import bodies
from tests.derive.bodies import close, sheet

SMOOTH, CORNER = sheet("hertz").frame, sheet("shifted_wedge").frame
(KINK,) = CORNER.kinks
b = Symbol("b", positive=True)


def number(expr: Expr, **given: float) -> mpf:
    return bodies.number(CORNER.flat(expr), **{"a": 2.0, "c": 1.5, "x": 0.875} | given)


_part = st.sampled_from([a, c, b, KINK.w, KINK.theta, h, a + b, c - b, a * KINK.w, KINK.w**3])
_term = st.tuples(st.integers(-4, 4).filter(bool), _part, _part, st.sampled_from([1, a + c, h + 2]))


@pytest.mark.slow
@settings(max_examples=15)
@given(st.lists(_term, min_size=1, max_size=3))
def test_tidying_keeps_the_value(terms: list[tuple[int, Expr, Expr, Expr]]) -> None:
    expr = sum((n * p * q / r for n, p, q, r in terms), Integer(0))
    for form in (reduced(expr, CORNER), tidy(expr, CORNER)):
        assert close(number(form), number(expr), scale=1)
        assert is_zero(form - expr, CORNER)


@pytest.mark.slow
@settings(max_examples=40)
@given(st.lists(_term, min_size=1, max_size=3), st.integers(1, 9))
def test_a_difference_is_seen_however_it_is_dressed(
    terms: list[tuple[int, Expr, Expr, Expr]], gap: int
) -> None:
    expr = sum((n * p * q / r for n, p, q, r in terms), Integer(0))
    assert not is_zero(expr + Rational(gap, 10**25) - reduced(expr, CORNER), CORNER)
