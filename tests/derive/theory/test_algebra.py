"""The ring of the formulas: one form for each, and an exact answer to "is it zero"."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mpf
from sympy import Expr, Integer, Rational, Symbol

from derive.symbols import a, c, h, w, x
from derive.theory.algebra import is_zero, reduced, tidy
from tests.derive import bodies
from tests.derive.bodies import close, sheet

SMOOTH, CORNER = sheet("hertz").frame, sheet("shifted_wedge").frame
(KINK,) = CORNER.kinks
b = Symbol("b", positive=True)


def number(expr: Expr, **given: float) -> mpf:
    return bodies.number(CORNER.flat(expr), **{"a": 2.0, "c": 1.5, "x": 0.875} | given)


@pytest.mark.parametrize(
    "expr",
    [
        (a + c) ** 2 - a**2 - 2 * a * c - c**2,
        *(1 / (a + c) + 1 / (a - c) - 2 * a / ((a + c) * (a - c)), KINK.w**2 - (a + b) * (c - b)),
        *(KINK.w**3 / (a + b) - KINK.w * (c - b), 1 / KINK.w - KINK.w / ((a + b) * (c - b))),
        *(w**2 - (a + x) * (c - x), KINK.theta * (a + c) - KINK.theta * a - KINK.theta * c),
    ],
    ids=str,
)
def test_what_is_zero_is_found_zero(expr: Expr) -> None:
    assert is_zero(expr, CORNER)


@pytest.mark.parametrize(
    "expr",
    [
        *(Integer(1), KINK.w - KINK.theta, KINK.w**2 - (a + b) * (c + b), KINK.w**3 - KINK.w),
        *(a * c - c * a + Rational(1, 10**30) * KINK.theta, w - KINK.w),
        1 / (KINK.w**2 - (a + b) * c),
    ],
    ids=str,
)
def test_what_is_not_zero_is_not_found_zero(expr: Expr) -> None:
    assert not is_zero(expr, CORNER)


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


@pytest.mark.parametrize("name", ["two_radii", "flat_rounded"])
def test_a_reduced_form_also_holds_where_the_contact_has_left_the_kink(name: str) -> None:
    """A clipped root is zero there, its square is not (a + x_j)(c - x_j)."""
    frame = sheet(name).frame
    for k in frame.kinks:
        form = frame.flat(reduced(k.w**2 + a, frame))
        for left, right in ((-1.0, 3.0), (3.0, -1.0)):
            assert close(bodies.number(form, a=left, c=right), mpf(left))
