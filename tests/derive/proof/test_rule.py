"""Quadrature of balls: against integrals known by hand, smooth, infinite at an end, and kinked."""

from collections.abc import Callable

import mpmath
import pytest
from flint import arb
from mpmath import mpf

from derive.proof.balls import Ball, ball, digits, known_digits, number
from derive.proof.rule import integral

DIGITS = 45


def close(found: mpf, wanted: mpf, digits: int = DIGITS) -> bool:
    return bool(abs(found - wanted) <= abs(wanted) * mpf(10) ** -digits)


BY_HAND: list[tuple[Callable[[Ball], Ball], list[int], Callable[[], mpf]]] = [
    (lambda t: t**5, [0, 2], lambda: mpf(32) / 3),
    (lambda t: t.exp(), [0, 1], lambda: mpmath.e - 1),
    (lambda t: 1 / (1 + t * t), [0, 1], lambda: mpmath.pi / 4),
    (lambda t: abs(t - 1), [0, 1, 3], lambda: mpf(5) / 2),
    (lambda t: t.sqrt(), [0, 1], lambda: mpf(2) / 3),
    (lambda t: 1 / (t * (2 - t)).sqrt(), [0, 2], lambda: mpmath.pi),
    (lambda t: t.log(), [0, 1], lambda: mpf(-1)),
    (lambda t: t.log() ** 2 * t.sqrt(), [0, 1], lambda: mpf(16) / 27),
    (lambda t: t.sin(), [0, 3], lambda: 1 - mpmath.cos(3)),
    (lambda t: t**3, [-1, 1], lambda: mpf(0)),
    # no single part converges
    (lambda t: 1 / (1 + 10**4 * t * t), [-1, 1], lambda: mpmath.atan(100) / 50),
    # one node divides zero by zero
    (lambda t: t.sin() / t, [-1, 0, 1], lambda: 2 * mpmath.si(1)),
]


@pytest.mark.parametrize(("integrand", "cuts", "by_hand"), BY_HAND)
def test_integrals_by_hand_lie_in_the_ball(
    integrand: Callable[[Ball], Ball], cuts: list[int], by_hand: Callable[[], mpf]
) -> None:
    with mpmath.workdps(50):
        found = integral(integrand, [mpf(cut) for cut in cuts])
    with mpmath.workdps(80), digits(80):
        wanted = by_hand()
        assert abs(number(found) - wanted) <= max(abs(wanted), mpf(1)) * mpf(10) ** -DIGITS
        assert abs(found - ball(wanted)).lower() <= arb(10) ** -70
        assert found.rad() < arb(10) ** -DIGITS


@pytest.mark.parametrize("power", ["-0.9", "-0.99"])
def test_what_is_not_computed_well_has_a_wide_ball(power: str) -> None:
    """int_0^1 t**power dt = 1/(1 + power), which rests on places nearer to 0 than any node."""
    with mpmath.workdps(30):
        found = integral(lambda t: t ** ball(mpf(power)), [mpf(0), mpf(1)])
        assert abs(number(found) - 1 / (1 + mpf(power))) > mpf(10) ** -10
        assert known_digits(found) < 10


def test_where_a_part_of_the_integrand_is_no_number_the_integral_is_none() -> None:
    with mpmath.workdps(30):
        assert mpmath.isnan(number(integral(lambda t: t.sqrt(), [mpf(-1), mpf(0), mpf(1)])))
