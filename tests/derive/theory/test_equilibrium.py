"""Tilt, load and moment: against quadrature of slopes written by hand."""

import pytest

from tests.derive import integrals
from tests.derive.bodies import BODIES, CASES, VALUES, close, value

ALL = pytest.mark.parametrize(("name", "left", "right"), CASES)


@ALL
def test_tilt_load_and_moment_are_the_moments_of_the_slope(
    name: str, left: float, right: float
) -> None:
    slope, kinks, E_star = BODIES[name].slope, BODIES[name].kinks, VALUES["E_star"]
    tilt, load, moment = (value(name, f, a=left, c=right) for f in ("tilt", "load", "moment"))
    assert close(tilt, integrals.tilt(slope, left, right, kinks), scale=1)
    assert close(load, integrals.load(slope, left, right, kinks, E_star))
    assert close(moment, integrals.moment(slope, left, right, kinks, E_star), scale=load)
