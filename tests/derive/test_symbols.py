"""The table of symbols: complete, in units that can be read, and of the assumed signs."""

import pytest
from sympy import Symbol, expand

from derive import symbols
from derive.symbols import QUANTITIES, RESERVED, Quantity, a, c, h, mid, w, x
from derive.units import parse_unit

_TABLE = pytest.mark.parametrize("quantity", QUANTITIES.values(), ids=list(QUANTITIES))


@_TABLE
def test_a_quantity_has_a_meaning_and_a_readable_unit(quantity: Quantity) -> None:
    assert quantity.meaning
    parse_unit(quantity.unit)
    assert quantity.name in RESERVED


def test_every_symbol_of_the_module_is_in_the_table() -> None:
    made = {value for value in vars(symbols).values() if isinstance(value, Symbol)}
    assert made == {quantity.symbol for quantity in QUANTITIES.values()}


@pytest.mark.parametrize("name", ["a", "c", "alpha", "x", "M", "e", "dsigma"])
def test_a_signed_quantity_is_assumed_to_have_no_sign(name: str) -> None:
    symbol = QUANTITIES[name].symbol
    assert symbol.is_real
    assert symbol.is_positive is None


@pytest.mark.parametrize("name", ["E_star", "P", "f", "s"])
def test_a_positive_quantity_is_assumed_positive(name: str) -> None:
    assert QUANTITIES[name].symbol.is_positive


def test_dQ_does_not_fall_over_the_half_cycle() -> None:
    assert QUANTITIES["dQ"].symbol.is_nonnegative
    assert QUANTITIES["dQ"].symbol.is_positive is None


def test_width_and_middle_span_the_contact() -> None:
    assert expand(mid + h / 2 - c) == 0
    assert expand(mid - h / 2 + a) == 0


def test_the_root_vanishes_at_both_edges_and_is_half_the_width_in_the_middle() -> None:
    assert w.subs(x, -a) == 0
    assert w.subs(x, c) == 0
    assert expand(w.subs(x, mid) ** 2 - h**2 / 4) == 0


@pytest.mark.parametrize(
    "name",
    ["a", "c", "m", "n", "h", "w", "mid", "p", "q", "Q", "xi", "kappa", "pi", "E", "I", "np"],
)
def test_the_theory_keeps_its_names(name: str) -> None:
    assert name in RESERVED
