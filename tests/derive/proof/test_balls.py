"""Ball arithmetic under integrals: exact ways in and out, and constants with all their digits."""

import mpmath
import pytest
from mpmath import mpf
from sympy import (
    E,
    Expr,
    Float,
    Piecewise,
    Rational,
    Symbol,
    acosh,
    asinh,
    atan,
    atan2,
    cosh,
    exp,
    log,
    pi,
    sign,
    sinh,
    sqrt,
    symbols,
    tanh,
)

from derive.body.profile import exact
from derive.proof.balls import ball, digits, function_of, functions_of, number
from derive.symbols import x

y, n = symbols("y n", positive=True)
AT = {y: Rational(3, 10), n: Rational(7, 5)}


@pytest.mark.parametrize("text", ["0.1", "-3", "0", "1e-400", "1e300", "-7.25e-9"])
def test_there_and_back_no_bit_is_lost(text: str) -> None:
    with mpmath.workdps(60):
        value = mpf(text)
    assert number(ball(value)) == value


@pytest.mark.parametrize(
    "expr",
    [
        *(pi * y, E + y, Rational(1, 3) * y, sqrt(2) * y, Float("0.1") * y, log(2) + y),
        *(y**n, y ** Rational(3, 2), y**-2, sqrt(y), exp(-y), log(y), abs(y - 1)),
        *(sinh(y), cosh(y), tanh(y), asinh(y), acosh(y + 1), atan(y), atan2(y, -n)),
        *(sign(y - n), Piecewise((y, y > 1), (y**2, True))),
    ],
)
@pytest.mark.parametrize("count", [30, 90])
def test_every_function_is_what_sympy_says(expr: Expr, count: int) -> None:
    function = function_of([y, n], expr)
    with mpmath.workdps(count), digits(count + 10):
        values = (ball(mpf(v.p)) / v.q for v in AT.values())
        wanted = exact(expr).subs(AT).evalf(count + 10)
        assert abs(number(function(*values)) - mpf(wanted)) < mpf(10) ** (2 - count)


@pytest.mark.parametrize("power", [1, 2, 3, 4, Rational(1, 2), Rational(3, 2), Rational(5, 2), n])
def test_a_power_of_a_ball_about_zero_is_one_about_zero(power: Expr) -> None:
    """x + |x| at x < 0: zero, but for rounding, whose middle is zero, too."""
    function = function_of([x, n], (x + abs(x)) ** power)
    with mpmath.workdps(30), digits(40):
        value = function(-ball(mpf(1)) / 3, ball(mpf(7)) / 5)
        assert value.contains(0)
        assert value.abs_upper() < 1e-15
        assert mpmath.isnan(number(1 / value))


@pytest.mark.parametrize("name", ["raised", "quotient", "exactly", "sqrt", "abs", "x0", "mpf"])
def test_a_parameter_may_bear_the_name_of_a_function(name: str) -> None:
    named = Symbol(name, positive=True)
    expr = sqrt(named) + abs(y - named) / Rational(3, 2) + named**3
    with digits(30):
        pair = functions_of([y, named], [expr, expr + sqrt(named)])(ball(mpf(1)), ball(mpf(4)))
        alone = function_of([y, named], expr)(ball(mpf(1)), ball(mpf(4)))
    assert [number(value) for value in (*pair, alone)] == pytest.approx([68, 70, 68])


def test_a_ball_knows_what_rounding_left_of_it() -> None:
    """(1 + 1e-20) - 1 at 15 digits: nothing is left, and the ball says so."""
    with digits(15):
        rest = (1 + ball(mpf(10) ** -20)) - 1
    assert rest.rad() > abs(rest.mid())
