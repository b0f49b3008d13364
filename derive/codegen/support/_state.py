"""What a contact carries, as the solver wants to know it."""

from typing import Any, NamedTuple

Array = Any


class State(NamedTuple):
    """What a contact carries for E* = 1, NaN if it carries nothing, and its edge coefficients."""

    load: Array
    moment: Array
    tilt: Array
    left: Array
    right: Array
