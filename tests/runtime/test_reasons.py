"""What is wrong with a cycle is said, all of it, in the words of what was given."""

import math

import numpy as np
import pytest

from generated import hertz, wedge
from generated.hertz import Contact

HERE = Contact(1.0, 1.0, 0.0)
NOWHERE = hertz.contact(-1.0, E_star=1.0, R=1.0)
GIVEN = {"f": 0.5, "E_star": 1.0, "R": 1.0}


@pytest.mark.parametrize(
    ("first", "dQ", "dsigma", "changed", "part"),
    [
        (HERE, 0.1, 0.0, {}, "both edges slip forward"),
        (HERE, 0.1, 2.0, {}, "the edges slip in opposite directions"),
        (HERE, 5.0, 0.0, {}, "the contact slides"),
        (HERE, 0.0, 0.0, {}, "nothing slips"),
        (HERE, -0.1, 0.0, {}, "dQ = -0.1 is negative"),
        (HERE, 0.1, math.nan, {}, "dsigma = nan is not finite"),
        (HERE, 0.1, 0.0, {"f": -1.0}, "f = -1 is not positive"),
        (HERE, 0.1, 0.0, {"R": 0.0}, "R = 0 is not positive"),
        (NOWHERE, 0.1, 0.0, {}, "first is NaN: there is no contact under its loads"),
        (Contact(1.0, -2.0, 0.0), 0.1, 0.0, {}, "first has a + c = -1"),
    ],
)
def test_it_is_said(
    first: Contact, dQ: float, dsigma: float, changed: dict[str, float], part: str
) -> None:
    assert part in hertz.why(first, HERE, dQ, dsigma, **(GIVEN | changed))


def test_a_contact_that_the_body_cannot_make() -> None:
    """A wedge leans on its apex: [-a, c] holds x = 0."""
    told = wedge.why(Contact(2.0, -1.0, 0.0), HERE, 0.1, 0.0, f=0.5, E_star=1.0, phi=0.1)
    assert told == (
        "first or second is not a contact [-a, c] of the body under any load and tilt: "
        "pass contacts returned by contact(...)"
    )


def test_one_cycle_at_a_time() -> None:
    with pytest.raises(ValueError, match=r"`why` takes one cycle.*; got arrays of shape \(2,\)"):
        hertz.why(HERE, HERE, np.array([0.1, 0.2]), 0.0, **GIVEN)
