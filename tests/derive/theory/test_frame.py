"""The three symbols of a kink: what they stand for, and how they change with the edges."""

import mpmath
import pytest
from mpmath import mpf
from sympy import Expr, Symbol

from derive.symbols import a, c, x
from derive.theory.frame import Frame
from tests.derive.bodies import close, number, sheet
from tests.derive.integrals import principal_value, root

pytestmark = pytest.mark.slow

KINKED = ("wedge", "shifted_wedge", "wedge_on_the_left", "two_radii", "flat_rounded")


def frames(name: str) -> Frame:
    return sheet(name).frame


@pytest.mark.parametrize("name", (*KINKED, "three_corners"))
@pytest.mark.parametrize(("left", "right"), [(2.0, 1.5), (0.75, 3.0)])
def test_the_angle_is_that_of_the_part_in_which_the_jump_acts_and_the_root_is_w_there(
    name: str, left: float, right: float
) -> None:
    """cos t_j = (x_j - mid)/(h/2) for the part right of the kink, the rest of pi on its left."""
    for k in frames(name).kinks:
        place = number(k.kink.position)
        angle = mpmath.acos((place - (right - left) / 2) / ((left + right) / 2))
        angle = angle if k.kink.side > 0 else mpmath.pi - angle
        assert close(number(k.angle, a=left, c=right), angle)
        assert close(number(k.root, a=left, c=right), root(place, mpf(left), mpf(right)))


@pytest.mark.parametrize("name", (*KINKED, "three_corners"))
@pytest.mark.parametrize("place", [-0.625, -0.375, 0.25, 0.875, 1.375])
def test_the_logarithm_is_a_principal_value(name: str, place: float) -> None:
    """w(x) PV int_{jump acts} ds/((s - x) w(s)) = 2 side L_j(x)."""
    left, right = mpf(0.75), mpf(1.5)
    for k in frames(name).kinks:
        at, side = number(k.kink.position), k.kink.side

        def acting(s: mpf, at: mpf = at, side: int = side) -> mpf:
            return 1 / root(s, left, right) if side * (s - at) > 0 else mpf(0)

        # the kernel of principal_value is 1/(x - s)
        value = -principal_value(acting, mpf(place), left, right, (at,)) * root(place, left, right)
        found = 2 * side * number(k.logarithm, a=left, c=right, x=place)
        assert close(found, value, digits=12, scale=1)


@pytest.mark.parametrize(("left", "right"), [(-1.0, 3.0), (3.0, -1.0)], ids=["right", "left"])
@pytest.mark.parametrize("name", ["two_radii", "flat_rounded", "wedge_on_parabola"])
def test_a_kink_outside_the_contact_contributes_nothing(
    name: str, left: float, right: float
) -> None:
    for k in frames(name).kinks:
        acts = (k.kink.side > 0) == (left < 0)  # the whole contact lies where the jump acts
        assert close(number(k.angle, a=left, c=right), mpmath.pi if acts else mpf(0), scale=1)
        assert number(k.root, a=left, c=right) == 0
        middle = (right - left) / 2
        assert close(number(k.logarithm, a=left, c=right, x=middle), mpf(0), scale=1)


@pytest.mark.parametrize("name", ["wedge", "wedge_on_the_left", "two_radii", "flat_rounded"])
@pytest.mark.parametrize("edge", [a, c], ids=str)
@pytest.mark.parametrize(
    ("left", "right"),
    [(2.0, 1.5), (0.75, 3.0), (-1.0, 3.0), (3.0, -1.0)],
    ids=["a > c", "a < c", "right of all kinks", "left of all kinks"],
)
def test_the_chain_rule_is_the_derivative(
    name: str, edge: Symbol, left: float, right: float
) -> None:
    frame = frames(name)
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
