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


def test_signs_are_assumed_where_the_theory_says_so_alone() -> None:
    positive = {name for name, quantity in QUANTITIES.items() if quantity.symbol.is_positive}
    assert {"E_star", "P", "f", "s"} <= positive
    assert not positive & {"a", "c", "alpha", "x", "M", "e", "dQ", "dsigma"}
    assert QUANTITIES["dQ"].symbol.is_nonnegative


def test_width_middle_and_root_are_those_of_the_contact() -> None:
    assert expand(mid + h / 2 - c) == expand(mid - h / 2 + a) == 0
    assert expand(w**2 - (a + x) * (c - x)) == 0
