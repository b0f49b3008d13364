"""Every generated function is right to the last digits, corners included."""

import pytest

from derive.codegen.contract import CONTRACT
from tests.accuracy.measure import worst_of
from tests.accuracy.regions import BODIES

POINTS = 300
"""Random points a region; `make accuracy` takes more."""

ULPS = 4.0

CANCELLING = {
    # The sum or difference of two given numbers is one of the unknowns; what rounding does to the
    # given numbers shows in it however it is computed.
    ("hertz", "contact"),  # a, c = half-width +- M/P
    ("hertz", "contact_at_tilt"),  # a, c = half-width +- R alpha
    # dQ/pi +- dsigma h/8, and more such sums of given numbers
    *((body, name) for body in BODIES for name in ("K_T", "L_T", "stick_margin")),
}
"""Here the error is held against the conditioning of the problem."""

CASES = [(body, function.name) for body in BODIES for function in CONTRACT]


@pytest.mark.parametrize(("body", "function"), CASES)
def test_worst_error_in_units_in_the_last_place(body: str, function: str) -> None:
    rows = list(worst_of(body, POINTS, function))
    assert rows
    for row in rows:
        error = row.excess if (body, function) in CANCELLING else row.ulp
        assert error <= ULPS, f"{row.region}: {error:.1f} ulp at {row.point}"


def test_what_cancels_is_named_once_and_exists() -> None:
    assert set(CASES) >= CANCELLING
