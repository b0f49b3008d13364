"""Expressions in balls: exact ways in and out, every function, and no digit that is not certain."""

import mpmath
import pytest
from flint import acb
from mpmath import mpc, mpf
from sympy import (
    ITE,
    And,
    E,
    Expr,
    Float,
    Function,
    Heaviside,
    Integral,
    Max,
    Min,
    Not,
    Or,
    Piecewise,
    Rational,
    S,
    Symbol,
    acos,
    acosh,
    asin,
    asinh,
    atan,
    atan2,
    atanh,
    cos,
    cosh,
    elliptic_e,
    elliptic_f,
    elliptic_k,
    elliptic_pi,
    exp,
    gamma,
    log,
    pi,
    sign,
    sin,
    sinh,
    sqrt,
    symbols,
    tan,
    tanh,
)

from derive.proof.balls import ball, digits, hull, known_digits, number, power, root
from derive.proof.values import Undecided, Undefined, evaluated, program
from derive.symbols import x

y, n = symbols("y n", positive=True)
AT = {y: Rational(3, 10), n: Rational(7, 5)}


@pytest.mark.parametrize(
    "expr",
    [
        *(pi * y, E + y, Rational(1, 3) * y, sqrt(2) * y, Float("0.1") * y, log(2) + y),
        *(y**n, y ** Rational(3, 2), y**-2, y**70, sqrt(y), 1 / sqrt(y), exp(-y), log(y)),
        *(sin(y), cos(y), tan(y), asin(y), acos(y), atan(y), atan2(y, -n), abs(y - 1)),
        *(sinh(y), cosh(y), tanh(y), asinh(y), acosh(y + 1), atanh(y), gamma(y)),
        *(elliptic_k(y), elliptic_e(y), elliptic_f(y, y), elliptic_pi(y / 2, y)),
        *(sign(y - n), Heaviside(y - n), Max(y, n, 1), Min(y, n)),
        Piecewise((y, y > 1), (y**2, True)),
        Piecewise((sqrt(y - 1), And(y > 1, n > 1)), (y, Or(y >= 1, Not(n < 1))), (n, True)),
        Piecewise((n, ITE(n > 1, y > 1, y < 1)), (y, True)),
        *(sqrt(-y), log(-y), (-y) ** n, asin(n)),
    ],
)
@pytest.mark.parametrize("count", [30, 90])
def test_every_function_is_what_sympy_says(expr: Expr, count: int) -> None:
    with mpmath.workdps(count), digits(3 * count):
        values = {s: ball(mpf(v.p)) / v.q for s, v in AT.items()}
        wanted = mpmath.mpmathify(
            expr.replace(lambda n: n.is_Float, Rational).subs(AT).evalf(count + 10)
        )
        whole, along = evaluated(expr, values), program(expr, y).function(values)(values[y])
        for found in (whole, number(along)):
            assert abs(found - wanted) <= mpf(10) ** (2 - count) * abs(wanted)


@pytest.mark.parametrize("exponent", [1, 2, 3, 4, Rational(1, 2), Rational(3, 2), n])
def test_a_power_of_a_ball_about_zero_is_one_about_zero(exponent: Expr) -> None:
    """x + |x| at x < 0: zero, but for rounding, whose middle is zero, too."""
    with mpmath.workdps(30), digits(40):
        at = {x: -ball(mpf(1)) / 3, n: ball(mpf(7)) / 5}
        value = program((x + abs(x)) ** S(exponent))(at)
        assert value.contains(0)
        assert value.abs_upper() < 1e-15
        assert known_digits(value) == 0
        assert mpmath.isnan(number(1 / value))


def test_what_is_not_real_is_complex_and_a_root_of_rounding_is_real() -> None:
    with mpmath.workdps(30), digits(40):
        assert number(root(ball(mpf(-4)))) == mpc(0, 2)
        assert number(power(ball(mpf(-8)), ball(mpf(2)))) == 64
        assert isinstance(number(root((ball(mpf(1)) / 3) * 3 - 1)), mpf)


@pytest.mark.parametrize("exponent", [1, 2, 3, -1, -2, -3, 0.5])
@pytest.mark.parametrize("ends", [(-2, -1), (-1, 2), (1, 3)])
def test_over_a_box_a_power_has_the_values_of_all_its_numbers_and_no_larger_ones(
    ends: tuple[int, int], exponent: float
) -> None:
    with digits(30):
        low, high = (ball(mpf(end)) for end in ends)
        found = program(x ** Rational(exponent), boxes=True)({x: hull(low, high)})
        if exponent < 0 and ends == (-1, 2):
            assert not found.is_finite()
            return
        values = [acb(low + share * (high - low)) ** exponent for share in (0, 0.25, 1)]
        assert all(acb(found).contains(value) for value in values)
        assert abs(found).upper() < 1.3 * max(abs(value).upper() for value in values)
        assert exponent % 2 != 1 or ends != (-2, -1) or found < 0


@pytest.mark.parametrize("name", ["raised", "sqrt", "abs", "x0", "mpf"])
def test_a_parameter_may_bear_the_name_of_a_function(name: str) -> None:
    named = Symbol(name, positive=True)
    expr = sqrt(named) + abs(y - named) / Rational(3, 2) + named**3
    assert evaluated(expr, {y: mpf(1), named: mpf(4)}) == 68


def test_digits_that_cancel_are_made_up_for_or_there_is_no_value() -> None:
    """(1 + x) - 1: at 15 digits nothing is left of 1e-20, but at 60 is; of 1e-400 nothing is."""
    lost = (1 + x) ** 2 / (1 + x) ** Rational(3, 2) - sqrt(1 + x) + sqrt((1 + x) ** 2) - 1
    assert mpmath.almosteq(evaluated(lost, {x: mpf(10) ** -20}), mpf(10) ** -20)
    assert evaluated(lost, {x: mpf(10) ** -400}) == 0
    with pytest.raises(Undecided, match="cancellation"):
        evaluated(lost * 10**300, {x: mpf(10) ** -400})
    with digits(15):
        rest = (1 + ball(mpf(10) ** -20)) - 1
    assert rest.rad() > abs(rest.mid())


@pytest.mark.parametrize("expr", [1 / (sqrt((1 + x) ** 2) - 1), log(x), 1 / x])
def test_where_there_is_no_value_it_is_undefined(expr: Expr) -> None:
    with pytest.raises(Undefined):
        evaluated(expr, {x: mpf(0)})


@pytest.mark.parametrize("expr", [Function("F")(y), exp(exp(exp(exp(10 * y)))), 10 ** (10**7 * y)])
def test_what_cannot_be_computed_is_undecided(expr: Expr) -> None:
    with pytest.raises(Undecided):
        evaluated(expr, {y: mpf(1)})


def test_integrals_are_cut_where_their_integrand_is_not_smooth() -> None:
    """int_0^3 |s - y| ds = (y**2 + (3 - y)**2)/2; over y and s from 0 to 1 |s - y| gives 1/3."""
    s = Symbol("s", real=True)
    with mpmath.workdps(40):
        one = Integral(abs(s - y), (s, 0, 3))
        assert mpmath.almosteq(evaluated(one, {y: mpf(1) / 8}), mpf(265) / 64)
        two = Integral(abs(s - y), (s, 0, 1), (y, 0, 1))
        assert mpmath.almosteq(evaluated(two, {}), mpf(1) / 3)
        assert evaluated(Integral(s**2, (s, 1, 0)), {}) == -mpf(1) / 3


def test_of_a_function_by_branches_only_the_branch_taken_is_computed() -> None:
    """A branch that is not taken may have no value; what it shares with others is computed."""
    s = Symbol("s", real=True)
    diverges = Integral(1 / s, (s, -1, 1))
    apart = Piecewise((diverges + sqrt(s), n < 1), (sqrt(s) + n, True)) + sqrt(s)
    inner = Piecewise((Piecewise((sqrt(s) * n, s > 2), (s**2, True)), s > 1), (sqrt(s), True))
    with mpmath.workdps(30), digits(40):
        four = program(apart)({s: mpf(4), n: mpf(2)})
        nested = [program(inner, s).function({n: mpf(3)})(ball(mpf(v))) for v in (0.25, 1.5, 4)]
        assert number(four) == 6
        assert [number(value) for value in nested] == [0.5, 2.25, 6]
        assert mpmath.isnan(number(program(Piecewise((s, s > 1)))({s: mpf(0)})))


ALONG = Symbol("s", real=True)


@pytest.mark.parametrize(
    ("inside", "low", "high", "wanted"),
    [
        (abs(sin(3 * ALONG)), 0, pi, S(2)),
        (abs(exp(ALONG) - 2), 0, 2, E**2 - 7 + 4 * log(2)),
        # 1/2 - sqrt(s) to 1/4, sqrt(s) - 1/2 beyond: 1/24 + 5/24
        (abs(sqrt(ALONG) - Rational(1, 2)), 0, 1, Rational(1, 4)),
        # |s - 1|: a root of second order
        (sqrt(ALONG**2 - 2 * ALONG + 1), 0, 3, Rational(5, 2)),
        # u**2 |u - 1|, u = s - 1: 2/3 for u in [-1, 1] and 15/4 - 7/3 in [1, 2]
        (abs(ALONG**3 - 4 * ALONG**2 + 5 * ALONG - 2), 0, 3, Rational(25, 12)),
        (abs(abs(ALONG - 1) - sqrt(2)), 1, 4, Rational(13, 2) - 3 * sqrt(2)),
        (log(abs(ALONG**2 - 1)), -1, 1, 4 * log(2) - 4),
        (sign(sign(ALONG) + ALONG - 2), -1, 3, S(0)),
        # a narrow peak
        (1 / (10**12 * (ALONG - 1) ** 2 + 1), 0, 2, 2 * atan(10**6) / 10**6),
    ],
)
def test_integrals_of_what_is_not_smooth_at_places_that_must_be_found(
    inside: Expr, low: Expr, high: Expr, wanted: Expr
) -> None:
    with mpmath.workdps(40):
        found = evaluated(Integral(inside, (ALONG, low, high)), {})
        assert abs(found - mpmath.mpmathify(S(wanted).evalf(50))) < mpf(10) ** -36
