"""I_k: the recursion against direct integration."""

import pytest
from mpmath import mpf

from derive.theory.moments import full_moment, kink_moment
from tests.derive.bodies import close, number, sheet
from tests.derive.integrals import over_contact


@pytest.mark.parametrize("k", range(8))
@pytest.mark.parametrize(("left", "right"), [(2.0, 1.0), (-0.5, 3.0), (1.0, -0.25)])
def test_the_recursion_is_the_integral(k: int, left: float, right: float) -> None:
    direct = over_contact(lambda s: s**k, left, right)
    assert close(number(full_moment(k), a=left, c=right), direct, scale=1)


@pytest.mark.parametrize("k", range(6))
@pytest.mark.parametrize("name", ["shifted_wedge", "wedge_on_the_left", "flat_rounded"])
def test_the_recursion_up_to_a_kink_is_the_integral_over_its_side(name: str, k: int) -> None:
    left, right = 1.5, 2.25
    for frame in sheet(name).frame.kinks:
        place, side = number(frame.kink.position), frame.kink.side
        direct = over_contact(
            lambda s, p=place, q=side: s**k if q * (s - p) > 0 else mpf(0), left, right, (place,)
        )
        expr = kink_moment(k, frame).xreplace({frame.theta: frame.angle, frame.w: frame.root})
        assert close(number(expr, a=left, c=right), direct, scale=1)
