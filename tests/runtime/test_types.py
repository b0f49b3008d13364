"""The codes that kernels store are those of the enum that users read."""

from generated.runtime import types
from generated.runtime.types import Regime


def test_codes_of_kernels_are_those_of_the_enum():
    codes = {name: getattr(types, name) for name in Regime.__members__}
    assert codes == Regime.__members__
    assert all(type(code) is float for code in codes.values())


def test_every_regime_says_what_it_is():
    assert {regime.name for regime in Regime} <= {*str(Regime.__doc__).split()}
