"""Parameters and bodies: what is accepted, and what is refused in which words."""

import pytest
from sympy import Expr, GoldenRatio, Max, Symbol, cosh, sqrt

from derive import Geometry, parameter, x
from derive.command.errors import BadName, DimensionMismatch, UnknownSymbol
from derive.symbols import QUANTITIES, RESERVED
from tests.derive.bodies import R, phi


@pytest.mark.parametrize(
    "name",
    ["alpha", "theta_1", "w_12", "q_left_1", "sin_x", "t_1", "np", "pi", *sorted(RESERVED)[::20]],
)
def test_a_name_of_the_theory_is_refused(name: str) -> None:
    with pytest.raises(BadName) as caught:
        parameter(name, "something")
    assert caught.value.message == BadName("parameter", name, "is reserved by the theory").message
    assert "choose another" in caught.value.message


@pytest.mark.parametrize("name", ["", "b b", "_b", "é", "lambda", 3])
def test_what_is_no_identifier_is_refused(name: str) -> None:
    with pytest.raises(BadName) as caught:
        parameter(name, "something")
    assert repr(str(name)) in caught.value.message
    assert "letters, digits and _" in caught.value.message


def test_a_parameter_used_twice_has_the_unit_its_last_maker_said() -> None:
    length = parameter("q2", "a length", unit="m")
    Geometry("first", g=x**2 / (2 * length))
    slope = parameter("q2", "a slope", unit="rad")
    with pytest.raises(DimensionMismatch):
        Geometry("second", g=x**2 / (2 * slope))


def test_two_parameters_of_one_name_in_one_body_are_refused() -> None:
    """One symbol of the sheet cannot mean two things."""
    first = parameter("q3", "first radius", unit="m")
    second = parameter("q3", "second radius", unit="m")
    with pytest.raises(BadName):
        Geometry("body", g=x**2 / first + x**4 / second**3)


@pytest.mark.parametrize(
    ("symbol", "made"),
    [
        *((Symbol("y"), "y"), (Symbol("R"), "R"), (QUANTITIES["alpha"].symbol, "alpha0")),
        *((Symbol("lambda"), "lambda0"), (Symbol("w_1"), "my_w_1"), (Symbol("my radius"), "R0")),
    ],
    ids=str,
)
def test_an_unknown_symbol_is_refused_with_a_line_that_is_accepted(
    symbol: Symbol, made: str
) -> None:
    with pytest.raises(UnknownSymbol) as caught:
        Geometry("body", g=x**2 / symbol)
    assert caught.value.given == str(symbol)
    assert f'{made} = parameter("{made}", "its meaning", unit="m")' in caught.value.message
    Geometry("body", g=x**2 / parameter(made, "its meaning", unit="m"))


def test_an_x_of_one_s_own_is_refused_with_where_to_get_it() -> None:
    """And not with `parameter("x", ...)`, which is what other symbols become."""
    with pytest.raises(BadName) as refused:
        parameter("x", "position")
    assert "`from derive import x`" in refused.value.message


@pytest.mark.parametrize("g", [x**2, x**2 / R + 1, R * cosh(x), phi], ids=str)
def test_a_profile_that_is_no_length_is_refused(g: Expr) -> None:
    with pytest.raises(DimensionMismatch) as caught:
        Geometry("body", g=g)
    assert "a number has no unit, so replace" in caught.value.message
    has_parameters = bool(g.free_symbols - {x})
    assert ("check the units of the parameters" in caught.value.message) == has_parameters


def test_numbers_that_have_a_name_are_written_by_their_roots() -> None:
    """Proofs compute sqrt(5) to any number of digits, and know no golden ratio."""
    radius = Symbol("R", positive=True)
    assert Geometry("body", g=GoldenRatio * x**2 / R).g == (1 + sqrt(5)) / 2 * x**2 / radius


def test_decimal_numbers_are_the_fractions_that_were_meant() -> None:
    """0.7 and 0.3 are no binary fractions: as such, pieces would not meet at the kink."""
    radius, place = (parameter(name, "length", unit="m") for name in ("R", "h_0"))
    decimal = 0.3 * x**2 / radius + Max(0, x - 0.7 * place) ** 2 / (2.5 * radius)
    fraction = 3 * x**2 / (10 * radius) + 2 * Max(0, x - 7 * place / 10) ** 2 / (5 * radius)
    found, wanted = (Geometry("body", g=g) for g in (decimal, fraction))
    assert found.g == wanted.g
    assert str(found.slope.kinks[0].position) == "7*h_0/10"
