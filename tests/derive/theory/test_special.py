"""The rules for special terms, each against quadrature of the term itself."""

from collections.abc import Callable
from functools import cache

import mpmath
import pytest
from mpmath import mpf
from sympy import Expr, Rational, S, Symbol, cosh, exp, lambdify, sinh

from derive.symbols import x
from derive.theory.frame import RootFrame
from derive.theory.special import Exponential, Power, Root, Special, X
from tests.derive.integrals import over_contact

pytestmark = pytest.mark.slow

p = Symbol("p", positive=True)
VALUES = {"p": "1.37"}
CONTACTS = [("1", "0.3"), ("0.4", "2"), ("-0.2", "1.5"), ("1.5", "-0.2")]
"""a and c; the last two have left the origin on either side."""

QUADRATICS = {
    "no real roots": x**2 + x / 2 + 1,
    "roots on both sides": 4 - x**2 + x / 4,
    "roots on one side": (x + 4) * (x + 5),
    "nearly a square": (x + 3) ** 2 + Rational(1, 100),
}


@cache
def compiled(expr: Expr) -> tuple[list[str], Callable[..., mpf]]:
    held = sorted(expr.free_symbols, key=str)
    return [s.name for s in held], lambdify(held, expr, modules="mpmath")


def number(expr: Expr, **given: mpf) -> mpf:
    held, function = compiled(expr)
    known = {name: mpf(value) for name, value in VALUES.items()} | given
    return mpf(function(*(known[name] for name in held)))


def sum_of(special: Special, polynomial: Expr, weight: Expr, order: int = 0) -> Expr:
    found = special.weighted(polynomial, {order: weight})
    return sum((k * value for value, k in found.items()), S.Zero)


def weighted(
    f: Callable[[mpf], mpf], left: mpf, right: mpf, weight: Callable[[mpf], mpf], cut: mpf
) -> mpf:
    """int f(s) weight(cos(theta)) dtheta."""
    middle, half = (right - left) / 2, (left + right) / 2
    return over_contact(
        lambda s: f(s) * weight((s - middle) / half), left, right, [cut], "tanh-sinh"
    )


def agree(found: mpf, wanted: mpf) -> bool:
    return bool(abs(found - wanted) < mpf(10) ** -30 * max(abs(wanted), mpf(1)))


@pytest.fixture(autouse=True)
def _digits() -> object:
    with mpmath.workdps(40):
        yield


@pytest.mark.parametrize(("left", "right"), CONTACTS)
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("n", [0, 1, 4])
def test_a_power_by_cosines(n: int, side: int, left: str, right: str) -> None:
    """(side (x - 1/8))**p on its side, and times 1 + x, which raises the exponent."""
    edges = {"a": mpf(left), "c": mpf(right)}
    power, place = Power(Rational(1, 8), side, p), mpf("0.125")
    for polynomial in (S.One, 1 + x):

        def term(s: mpf, times: Expr = polynomial) -> mpf:
            t = side * (s - place)
            return number(times, x=s) * t ** mpf(VALUES["p"]) if t > 0 else mpf(0)

        wanted = weighted(term, *edges.values(), lambda z: mpmath.chebyt(n, z), place)
        found = number(sum_of(power, polynomial, cosine(n)), **edges)
        assert agree(found, wanted)


def cosine(n: int) -> Expr:
    """cos(n theta) in X = cos(theta), by its recursion."""
    before, here = S.One, X
    for _ in range(n):
        before, here = here, (2 * X * here - before).expand()
    return before


@pytest.mark.parametrize(("left", "right"), CONTACTS)
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("edge", [1, -1])
def test_the_rate_of_a_power_next_to_an_edge(edge: int, side: int, left: str, right: str) -> None:
    """int (1 +- X) d/dx t**p; t**(p - 1) is integrable at the place."""
    edges = {"a": mpf(left), "c": mpf(right)}
    place, exponent = mpf("0.125"), mpf(VALUES["p"])

    def rate(s: mpf) -> mpf:
        t = side * (s - place)
        return side * exponent * t ** (exponent - 1) if t > 0 else mpf(0)

    found = number(sum_of(Power(Rational(1, 8), side, p), S.One, 1 + edge * X, 1), **edges)
    middle, half = (edges["c"] - edges["a"]) / 2, (edges["a"] + edges["c"]) / 2
    turn = mpmath.acos(max(-1, min(1, (place - middle) / half)))
    low, high = (mpf(0), turn) if side > 0 else (turn, +mpmath.pi)

    def along(u: mpf) -> mpf:
        """theta = turn -+ u**4: the power's cusp is smooth in u."""
        with mpmath.workdps(120):
            theta = turn - side * u**4
            weight = 1 + edge * mpmath.cos(theta)
            return rate(middle + half * mpmath.cos(theta)) * weight * 4 * u**3

    if high == low:
        assert found == 0
        return
    wanted = mpmath.quad(along, [0, (high - low) ** mpf("0.25")])
    assert abs(found - wanted) < mpf(10) ** -15 * abs(wanted)


@pytest.mark.parametrize(("left", "right"), CONTACTS[2:])
@pytest.mark.parametrize("side", [1, -1])
def test_the_second_rate_of_a_root_is_the_limit_of_powers(side: int, left: str, right: str) -> None:
    """Next to the place, t**(1/2) has a form of its own, because a gamma function is infinite."""
    edges, weight = {"a": mpf(left), "c": mpf(right)}, (1 + X) ** 2
    place = Rational(-1, 4) if side > 0 else Rational(1, 4)
    root = number(sum_of(Power(place, side, S.Half), S.One, weight, 2), **edges)
    power = sum_of(Power(place, side, p), S.One, weight, 2)
    nearly = number(power, p=mpf("0.5") + mpf(10) ** -25, **edges)
    assert abs(root - nearly) < mpf(10) ** -22 * abs(root)
    assert root != 0


@pytest.mark.parametrize(("left", "right"), CONTACTS[1:3])
@pytest.mark.parametrize("kind", [exp, sinh, cosh])
@pytest.mark.parametrize("order", range(3))
def test_exponentials(order: int, kind: type, left: str, right: str) -> None:
    edges = {"a": mpf(left), "c": mpf(right)}
    argument = Rational(1, 2) - 3 * x / 4
    term, special = kind(argument), Exponential(kind, argument)
    polynomial, weight = 1 + x - x**2, 1 + X / 2 - X**3
    whole = lambdify(x, (polynomial * term).diff(x, order), modules="mpmath")
    along = lambdify(X, weight, modules="mpmath")
    wanted = weighted(whole, *edges.values(), along, mpf(0))
    assert agree(number(sum_of(special, polynomial, weight, order), **edges), wanted)


@pytest.mark.enough("0-*", "2-no real roots-0.4-2")
@pytest.mark.parametrize(("left", "right"), CONTACTS)
@pytest.mark.parametrize("quadratic", QUADRATICS.values(), ids=QUADRATICS)
@pytest.mark.parametrize("order", [0, 1, 2])
def test_roots_of_quadratics(order: int, quadratic: Expr, left: str, right: str) -> None:
    edges = {"a": mpf(left), "c": mpf(right)}
    frame = RootFrame(quadratic.expand(), 1)
    polynomial, weight = 1 + x - x**2, 1 + X / 2 - X**3
    whole = lambdify(x, (polynomial / quadratic**S.Half).diff(x, order), modules="mpmath", cse=True)
    along = lambdify(X, weight, modules="mpmath")
    wanted = weighted(whole, *edges.values(), along, mpf(0))
    found = sum_of(Root(frame), polynomial, weight, order)
    ends = {s: d for s, d in frame.definitions.items() if s in (frame.left, frame.right)}
    found = found.xreplace({s: d.xreplace(ends) for s, d in frame.definitions.items()})
    assert abs(number(found, **edges) - wanted) < mpf(10) ** -25 * max(abs(wanted), mpf(1))
