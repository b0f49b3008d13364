"""Quadrature of balls: against integrals known by hand, smooth, infinite at an end, and kinked."""

from collections.abc import Callable

import mpmath
import pytest
from mpmath import mpf

from derive.proof.balls import Ball
from derive.proof.rule import integral, remembered

DIGITS = 45


def close(found: mpf, wanted: mpf, digits: int = DIGITS) -> bool:
    return bool(abs(found - wanted) <= abs(wanted) * mpf(10) ** -digits)


BY_HAND: list[tuple[str, Callable[[Ball], Ball], list[int], Callable[[], mpf]]] = [
    ("gauss-legendre", lambda t: t**5, [0, 2], lambda: mpf(32) / 3),
    ("gauss-legendre", lambda t: t.exp(), [0, 1], lambda: mpmath.e - 1),
    ("gauss-legendre", lambda t: 1 / (1 + t * t), [0, 1], lambda: mpmath.pi / 4),
    ("gauss-legendre", lambda t: abs(t - 1), [0, 1, 3], lambda: mpf(5) / 2),
    ("tanh-sinh", lambda t: t.sqrt(), [0, 1], lambda: mpf(2) / 3),
    ("tanh-sinh", lambda t: t.log(), [0, 1], lambda: mpf(-1)),
    ("tanh-sinh", lambda t: t.log() ** 2 * t.sqrt(), [0, 1], lambda: mpf(16) / 27),
    ("tanh-sinh", lambda t: t.sin(), [0, 3], lambda: 1 - mpmath.cos(3)),
]


@pytest.mark.parametrize(("method", "integrand", "cuts", "by_hand"), BY_HAND)
def test_integrals_by_hand(
    method: str, integrand: Callable[[Ball], Ball], cuts: list[int], by_hand: Callable[[], mpf]
) -> None:
    with mpmath.workdps(50):
        assert close(integral(integrand, [mpf(cut) for cut in cuts], method), by_hand())


def test_where_it_does_not_converge_it_is_cut_finer() -> None:
    """1/(1 + 1e4 t^2) from -1 to 1 = atan(100)/50: no single part of 96 nodes does."""
    with mpmath.workdps(50):
        found = integral(lambda t: 1 / (1 + 10**4 * t * t), [mpf(-1), mpf(1)], "gauss-legendre")
        assert close(found, mpmath.atan(100) / 50, 40)


@pytest.mark.parametrize("inside", [0, 160])
def test_digits_that_cancel_are_made_up_for(inside: int) -> None:
    """(1 - cos t)/t^2 down to t = 1e-30: of 62 digits nothing is left, of twice as many half."""

    def lost(t: Ball) -> Ball:
        return (1 - t.cos()) / t**2

    with mpmath.workdps(50):
        low, high = mpf(10) ** -30, mpf(10) ** -29
        wanted = (high - low) / 2  # up to t^2/24
        assert close(integral(lost, [low, high], "gauss-legendre", inside), wanted)


def test_what_divides_by_zero_has_no_weight() -> None:
    """sin(t)/t from -1 to 1, one node of which is zero: 2 Si(1)."""
    with mpmath.workdps(50):
        found = integral(lambda t: t.sin() / t, [mpf(-1), mpf(0), mpf(1)], "tanh-sinh")
        assert close(found, 2 * mpmath.si(1))


@pytest.mark.parametrize("method", ["gauss-legendre", "tanh-sinh"])
def test_where_a_part_of_the_integrand_is_no_number_the_integral_is_none(method: str) -> None:
    with mpmath.workdps(30):
        assert mpmath.isnan(integral(lambda t: t.sqrt(), [mpf(-1), mpf(0), mpf(1)], method))


def test_nodes_are_asked_once() -> None:
    asked: list[Ball] = []

    @remembered
    def square(t: Ball) -> Ball:
        asked.append(t)
        return t * t

    with mpmath.workdps(50):
        first = integral(square, [mpf(0), mpf(1)])
        count = len(asked)
        again = integral(lambda t: square(t), [mpf(0), mpf(1)])
        assert close(first, mpf(1) / 3)
        assert again == first
    assert len(asked) <= count + 1  # the middle, which tells what an integral is like
