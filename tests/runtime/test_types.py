"""The regimes that users read."""

from generated.runtime.types import Regime


def test_every_regime_says_what_it_is():
    assert {regime.name for regime in Regime} <= {*str(Regime.__doc__).split()}
