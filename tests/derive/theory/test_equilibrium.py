"""Tilt, load and moment: against quadrature of slopes written by hand."""

import pytest
from mpmath import mpf
from sympy import simplify

from derive.symbols import E_star, a, c
from derive.theory.equilibrium import load, moment, tilt
from tests.derive import integrals
from tests.derive.bodies import BODIES, CASES, VALUES, close, sheet, value
from tests.derive.integrals import over_contact

ALL = pytest.mark.parametrize(("name", "left", "right"), CASES)


@ALL
def test_the_tilt_is_minus_the_mean_slope(name: str, left: float, right: float) -> None:
    body = BODIES[name]
    expected = integrals.tilt(body.slope, left, right, body.kinks)
    assert close(value(name, "tilt", a=left, c=right), expected, scale=1)


@ALL
def test_the_load_is_the_first_moment_of_the_slope(name: str, left: float, right: float) -> None:
    body = BODIES[name]
    expected = integrals.load(body.slope, left, right, body.kinks, VALUES["E_star"])
    assert close(value(name, "load", a=left, c=right), expected)


@ALL
def test_the_moment_is_the_second_moment_of_the_slope(name: str, left: float, right: float) -> None:
    body = BODIES[name]
    expected = integrals.moment(body.slope, left, right, body.kinks, VALUES["E_star"])
    size = value(name, "load", a=left, c=right)
    assert close(value(name, "moment", a=left, c=right), expected, scale=size)


@ALL
def test_load_and_moment_are_resultants_of_the_pressure(
    name: str, left: float, right: float
) -> None:
    """P = int p dx and M = -int p x dx: the sign of M is that of the convention."""

    def p(s: mpf) -> mpf:
        return value(name, "pressure", x=s, a=left, c=right)

    kinks = BODIES[name].kinks
    found = value(name, "load", a=left, c=right)
    assert close(integrals.resultant(p, left, right, kinks), found, digits=18)
    arm = integrals.resultant(lambda s: -s * p(s), left, right, kinks)
    assert close(arm, value(name, "moment", a=left, c=right), digits=18, scale=found)


@ALL
def test_the_pressure_would_be_infinite_at_an_edge_for_any_other_tilt(
    name: str, left: float, right: float
) -> None:
    """I_0 = int (g' + alpha)/w ds = 0, the condition for a bounded pressure."""
    body, alpha = BODIES[name], value(name, "tilt", a=left, c=right)
    total = over_contact(lambda s: body.slope(s) + alpha, left, right, body.kinks)
    assert close(total, mpf(0), scale=1)


@pytest.mark.parametrize("name", ["hertz", "quartic", "flat_rounded", "rounded_wedge"])
def test_more_contact_on_the_left_means_an_anticlockwise_tilt(name: str) -> None:
    """Turned anticlockwise a symmetric body digs in on its left: a > c, alpha > 0, M > 0."""
    assert value(name, "tilt", a=2.0, c=1.0) > 0
    assert value(name, "moment", a=2.0, c=1.0) > 0
    assert value(name, "tilt", a=1.0, c=2.0) < 0
    assert value(name, "moment", a=1.0, c=2.0) < 0


def test_the_stages_are_what_the_sheet_shows() -> None:
    body = sheet("two_radii")
    for name, stage in (("tilt", tilt), ("load", load), ("moment", moment)):
        assert body[name].expr == stage(body.frame)


@pytest.mark.parametrize("name", ["hertz", "skew", "quartic"])
def test_no_load_and_no_moment_without_width(name: str) -> None:
    for formula in ("load", "moment"):
        assert simplify(sheet(name)[formula].expr.subs(c, -a)) == 0


@pytest.mark.parametrize("name", BODIES)
def test_load_and_moment_are_proportional_to_the_modulus(name: str) -> None:
    for formula in ("load", "moment"):
        expr = sheet(name)[formula].expr
        assert simplify(expr.diff(E_star) * E_star - expr) == 0
        assert not sheet(name)["tilt"].expr.has(E_star)
