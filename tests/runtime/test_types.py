"""The codes that kernels write are those of the enum that users read."""

import pytest

from generated.runtime.history import reversals, solve
from generated.runtime.slip import march, zone
from generated.runtime.types import Regime


@pytest.mark.parametrize(
    ("module", "names"),
    [
        (zone, "NONE MODERATE LARGE MIXED SLIDING FULL_STICK UNSOLVED"),
        (march, "OUT_OF_PHASE NOT_CLOSED"),
        (solve, "NONE SLIDING FULL_STICK UNSOLVED COMPUTED NO_STICK"),
        (reversals, "MODERATE FULL_STICK"),
    ],
    ids=["zone", "march", "solve", "reversals"],
)
def test_codes_of_kernels_are_those_of_the_enum(module, names):
    assert {name: getattr(module, name) for name in names.split()} == {
        name: Regime[name] for name in names.split()
    }


def test_every_regime_says_what_it_is():
    assert {regime.name for regime in Regime} <= {*str(Regime.__doc__).split()}
