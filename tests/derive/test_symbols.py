"""The table of symbols: complete, in units that can be read, and of the assumed signs."""

from sympy import Symbol

import generated.wedge
from derive import symbols
from derive.reading.units import parse_unit
from derive.symbols import QUANTITIES, RESERVED


def test_every_symbol_has_a_meaning_and_a_readable_unit_in_the_table() -> None:
    for quantity in QUANTITIES.values():
        assert quantity.meaning and quantity.name in RESERVED
        parse_unit(quantity.unit)
    made = {value for value in vars(symbols).values() if isinstance(value, Symbol)}
    assert made == {quantity.symbol for quantity in QUANTITIES.values()}


def test_no_parameter_can_have_the_name_of_a_generated_function() -> None:
    assert {*generated.wedge.__all__} <= RESERVED
