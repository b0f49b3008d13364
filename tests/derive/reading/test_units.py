"""Units: read, multiplied, and refused; dimensions of expressions."""

import pytest
from sympy import (
    Integral,
    Max,
    Piecewise,
    Rational,
    Symbol,
    atan2,
    cosh,
    hyper,
    log,
    sign,
    sqrt,
    sympify,
    tan,
)

from derive.command.errors import BadUnit, DimensionMismatch
from derive.reading.units import NUMBER, Dimension, dimension_of, parse_unit

n = Symbol("n", positive=True)
length, stress, angle = Symbol("length"), Symbol("stress"), Symbol("angle")
HELD = {length: parse_unit("m"), stress: parse_unit("Pa"), angle: parse_unit("rad"), n: NUMBER}


@pytest.mark.parametrize(
    ("text", "pressure", "metres"),
    [
        *(("m", 0, 1), ("Pa", 1, 0), ("N/m", 1, 1), ("rad", 0, 0), ("-", 0, 0), ("1/m", 0, -1)),
        ("N", 1, 2),  # Pa m^2
        *(("m**3", 0, 3), ("m**(1/3)", 0, Rational(1, 3)), ("m**(1 - n)", 0, 1 - n)),
        ("Pa/sqrt(m)", 1, Rational(-1, 2)),
    ],
)
def test_a_unit_is_read(text: str, pressure: object, metres: object) -> None:
    assert parse_unit(text) == Dimension(sympify(pressure), sympify(metres))


@pytest.mark.parametrize(
    "text",
    [
        *("kg", "2*m", "m + m", "m**0.5", "m**(1/0)", "m^2", "m(", "m; m", "__import__('os')"),
        *("m\0", "(" * 10_000 + "m" + ")" * 10_000),
    ],
)
def test_a_bad_unit_is_refused_with_a_remedy(text: str) -> None:
    with pytest.raises(BadUnit) as caught:
        parse_unit(text)
    assert repr(text) in caught.value.message
    assert "product of powers" in caught.value.message


@pytest.mark.parametrize(
    ("expr", "unit"),
    [
        *((length * stress, "N/m"), (length + 3 * length, "m"), (Max(0, length), "m")),
        *((sqrt(length) * stress, "Pa*sqrt(m)"), (length**n * length ** (1 - n), "m")),
        *((sign(length), "-"), (atan2(length, 2 * length), "-"), (angle + 1, "-")),
        *((tan(angle), "-"), (log(length / (2 * length + length)), "-")),
        (Piecewise((0, length < 0), (stress, True)), "Pa"),
    ],
    ids=str,
)
def test_the_dimension_of_an_expression(expr: object, unit: str) -> None:
    assert dimension_of(expr, HELD) == parse_unit(unit)


@pytest.mark.parametrize(
    "expr",
    [
        *(length + stress, Max(1, length), atan2(length, stress), cosh(length)),
        *(hyper((length, 2), (3,), angle), 2**length),
        Piecewise((length, length > 0), (stress, True)),
        *(Piecewise((1, length > stress), (2, True)), sqrt(length + length**2)),
        Integral(length, (length, stress, angle)),
    ],
    ids=str,
)
def test_terms_that_do_not_agree_are_refused(expr: object) -> None:
    with pytest.raises(DimensionMismatch):
        dimension_of(expr, HELD)
