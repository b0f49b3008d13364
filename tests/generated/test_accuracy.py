"""Some generated functions are within the bounds that `make accuracy` states, at few points."""

import pytest

from tests.measure.accuracy.measure import worst_of
from tests.measure.accuracy.regions import BULK, EXTREME

pytestmark = pytest.mark.slow

OF_CONTACTS = ("load", "pressure", "L_N", "contact", "contact_at_tilt")
OF_CYCLES = ("stick_zone, moderate", "stick_zone, moderate, varying", "stick_zone, large, varying")
OF_CYCLES += ("shear_change, large", "shear", "slip_range, moderate", "march")


@pytest.mark.enough("flat_rounded-*", "wedge-[cl]*", "hyperbola-[pc]*")
@pytest.mark.parametrize("name", [*OF_CONTACTS, *OF_CYCLES])
@pytest.mark.parametrize("body", ["wedge", "flat_rounded", "rounded_wedge", "hyperbola"])
def test_functions_are_within_their_bounds(body: str, name: str) -> None:
    rows = [*worst_of(body, name, 20 if name in OF_CYCLES else 40)]
    assert {BULK, EXTREME} <= {row.region for row in rows} or name in OF_CYCLES
    for row in rows:
        assert row.met and (name in OF_CYCLES or not row.lost), row
