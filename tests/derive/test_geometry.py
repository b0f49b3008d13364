"""Parameters and bodies: what is accepted, and what is refused in which words."""

import copy
import pickle

import pytest
from sympy import Abs, GoldenRatio, I, Integral, Max, Symbol, cosh, nan, oo, sqrt

from derive import Geometry, parameter, x
from derive.errors import (
    BadName,
    BadProfile,
    BadUnit,
    DimensionMismatch,
    UnknownSymbol,
    UserError,
)
from derive.symbols import QUANTITIES, RESERVED
from derive.units import parse_unit

R = parameter("R", "radius", unit="m")
phi = parameter("phi", "slope", unit="rad")


def test_a_parameter_is_positive_and_remembers_what_it_means() -> None:
    assert R.is_positive
    assert R.is_real
    assert (R.name, R.meaning, R.unit) == ("R", "radius", "m")


def test_a_parameter_survives_copy_and_pickle() -> None:
    for twin in (copy.copy(R), copy.deepcopy(R), pickle.loads(pickle.dumps(R))):
        assert (twin.name, twin.meaning, twin.unit) == ("R", "radius", "m")
        assert twin.is_positive


@pytest.mark.parametrize(
    "name",
    ["alpha", "E_star", "theta_1", "w_12", "L_3", "u_1", "v_2", "q_left_1", "m_2", "np", "pi", "E"],
)
def test_a_name_of_the_theory_is_refused(name: str) -> None:
    with pytest.raises(BadName) as caught:
        parameter(name, "something")
    assert caught.value == BadName("parameter", name, "is taken by the theory")
    assert "choose another" in caught.value.message


@pytest.mark.parametrize("name", sorted(RESERVED))
def test_no_reserved_name_gets_through(name: str) -> None:
    with pytest.raises(BadName):
        parameter(name, "something")


@pytest.mark.parametrize(
    "name", ["", "2b", "b b", "b-1", "_b", "é", "lambda", "for", "None", "φ", "b\n", 3, None]
)
def test_what_is_no_identifier_is_refused(name: str) -> None:
    with pytest.raises(BadName) as caught:
        parameter(name, "something")
    assert repr(str(name)) in caught.value.message
    assert "letters, digits and _" in caught.value.message


@pytest.mark.parametrize("name", ["R2", "b_1", "phi", "radius"])
def test_an_ordinary_name_is_accepted(name: str) -> None:
    assert parameter(name, "something").name == name


@pytest.mark.parametrize("unit", ["kg", "m + m", "2*m", "mm", "m**0.5"])
def test_a_bad_unit_is_refused(unit: str) -> None:
    with pytest.raises(BadUnit) as caught:
        parameter("R", "radius", unit=unit)
    assert caught.value.given == unit


@pytest.mark.parametrize("name", ["", "2b", "my body", "class", "_private", "hertz.py", "a/b", 7])
def test_a_geometry_needs_the_name_of_a_module(name: str) -> None:
    with pytest.raises(BadName) as caught:
        Geometry(name, g=x**2 / R)
    assert caught.value.what == "geometry"


def test_a_geometry_lists_its_parameters_in_alphabetical_order() -> None:
    R2 = parameter("R2", "another radius", unit="m")
    body = Geometry("body", g=phi * Abs(x) + x**2 / R + x**2 / R2)
    assert [q.name for q in body.parameters] == ["R", "R2", "phi"]
    assert [q.unit for q in body.parameters] == ["m", "m", "rad"]
    assert body.parameters[0].meaning == "radius"


def test_a_geometry_holds_plain_symbols_only() -> None:
    body = Geometry("body", g=x**2 / R)
    assert {type(symbol) for symbol in body.g.free_symbols} == {Symbol}
    assert body.g == x**2 / Symbol("R", positive=True)


def test_a_geometry_knows_all_quantities_and_dimensions() -> None:
    body = Geometry("body", g=x**2 / R)
    assert set(body.quantities) == set(QUANTITIES) | {"R"}
    assert body.dimensions[Symbol("R", positive=True)] == parse_unit("m")
    assert body.dimensions[QUANTITIES["P"].symbol].agrees(parse_unit("N/m"))


def test_described_is_the_same_body_with_words() -> None:
    body = Geometry("body", g=x**2 / R)
    twin = body.described("A cylinder.")
    assert twin.description == "A cylinder."
    assert body.description == ""
    assert (twin.name, twin.g, twin.parameters) == (body.name, body.g, body.parameters)


def test_a_parameter_used_twice_means_what_its_last_maker_said() -> None:
    """Two files may use one name; SymPy's cache must not bring back the first one's meaning."""
    first = parameter("q1", "first", unit="m")
    Geometry("first", g=x**2 / (2 * first))
    second = parameter("q1", "second", unit="m")
    assert Geometry("second", g=x**2 / (2 * second)).parameters[0].meaning == "second"


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
        (Symbol("y"), "y"),
        (Symbol("R"), "R"),
        (Symbol("R", positive=True), "R"),
        (QUANTITIES["alpha"].symbol, "alpha0"),
        (QUANTITIES["E_star"].symbol, "E_star0"),
        (Symbol("a"), "a0"),
        (Symbol("b1"), "b10"),
        (Symbol("lambda"), "lambda0"),
        (Symbol("w_1"), "my_w_1"),
        (Symbol("_r"), "my__r"),
        (Symbol("my radius"), "R0"),
        (Symbol("2b"), "my_2b"),
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
    """A parameter named x, which is what other symbols become, would be refused in turn."""
    with pytest.raises(UnknownSymbol) as caught:
        Geometry("body", g=Symbol("x") ** 2 / R)
    assert "`from derive import x`" in caught.value.message
    assert "parameter(" not in caught.value.message
    with pytest.raises(BadName) as refused:
        parameter("x", "position")
    assert "`from derive import x`" in refused.value.message


def test_a_symbol_of_the_theory_is_refused_with_what_it_means() -> None:
    with pytest.raises(UnknownSymbol) as caught:
        Geometry("body", g=x**2 / QUANTITIES["a"].symbol)
    assert "taken by the theory, for the left edge of the contact" in caught.value.message


@pytest.mark.parametrize(
    "g",
    [x**2, x**2 / R**2, x**2 / R + 1, phi * x**2, R * cosh(x), Abs(x - 1) * phi, phi],
    ids=str,
)
def test_a_profile_that_is_no_length_is_refused(g: object) -> None:
    with pytest.raises(DimensionMismatch) as caught:
        Geometry("body", g=g)
    assert "a number has no unit: write it as a parameter" in caught.value.message
    has_parameters = bool(getattr(g, "free_symbols", set()) - {x})
    assert ("check the units of the parameters" in caught.value.message) == has_parameters


@pytest.mark.parametrize(
    "g", ["x**2/R", None, [x], {"g": x}, object()], ids=lambda g: type(g).__name__
)
def test_what_is_no_expression_is_refused(g: object) -> None:
    with pytest.raises(UserError):
        Geometry("body", g=g)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "g",
    [I * x**2 / R, nan * x, oo * x, x > 0, Integral(x / R, x), x**2 / R > 0],
    ids=str,
)
def test_what_is_no_real_profile_is_refused(g: object) -> None:
    with pytest.raises(UserError):
        Geometry("body", g=g)


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


def test_a_refused_profile_names_the_body() -> None:
    with pytest.raises(BadProfile) as caught:
        Geometry("my_body", g=phi * x)
    assert "'my_body'" in str(caught.value)
