"""Series of the slip zones: their integrals by quadrature, their terms put back, theory's form."""

from itertools import product

import mpmath
import pytest
from mpmath import mpf
from sympy import Rational, Symbol, lambdify, series, simplify, sqrt, symbols

from derive.symbols import E_star, a, c, dsigma, f, h
from derive.theory import slip
from derive.theory.edges import Edge, pressure_series
from generated.runtime.slip import series as runtime
from tests.derive.bodies import sheet
from tests.derive.partial_slip import integral

d, stuck = symbols("d stuck", positive=True)
SERIES = (mpf(2), mpf(-3) / 4, mpf(5) / 8)


def pressure(s: mpf, terms: int) -> mpf:
    return sum((C * s**k for k, C in enumerate(SERIES[:terms])), mpf(0)) * mpmath.sqrt(s)


def cut(of: str, order: int, length: mpf, width: mpf) -> mpf:
    """near or far of the series of p, cut behind `order`."""
    found = getattr(slip, of)(SERIES, d, stuck, order)
    return mpf(lambdify((d, stuck), found, modules="mpmath")(length, width))


def whole(of: str, length: mpf, width: mpf) -> mpf:
    """The integral itself; y = d - s is the distance from the stick zone."""
    if of == "near":
        return integral(lambda y: pressure(length - y, 3) * mpmath.sqrt(width + y), length)
    return integral(lambda y: pressure(length - y, 3) * y / mpmath.sqrt(width + y), length)


@pytest.mark.parametrize(("of", "order"), [*product(["near"], [1, 2, 3]), ("far", 2), ("far", 3)])
def test_what_an_order_leaves_out_is_of_the_next_order(of: str, order: int) -> None:
    """A quarter of the length: 4**-(order + 1) of the error."""
    errors = []
    for length in (mpf(1) / 256, mpf(1) / 1024):
        size = mpmath.sqrt(mpf(3)) ** (1 if of == "near" else -1)
        errors.append(abs(cut(of, order, length, mpf(3)) - whole(of, length, mpf(3))) / size)
    assert abs(mpmath.log(errors[0] / errors[1], 4) - (order + 1)) < 0.05


def test_the_table_of_the_kernels_is_that_of_the_theory() -> None:
    """Coefficient of C_i by powers of d, over pi."""
    for of, table, least in (("near", runtime.NEAR, 1), ("far", runtime.FAR, 2)):
        for i, row in enumerate(table):
            for j, number in enumerate(row):
                unit = [int(k == i) for k in range(3)]
                found = getattr(slip, of)(unit, d, stuck, 3).coeff(d, i + j + least)
                power = Rational(1, 2) - j if of == "near" else -Rational(1, 2) - j
                assert float(found / stuck**power / mpmath.pi) == pytest.approx(number, rel=1e-15)


@pytest.mark.enough("1")
@pytest.mark.parametrize("order", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_terms_put_back_leave_nothing_up_to_their_order(order: int) -> None:
    size, width = symbols("epsilon h", positive=True)
    left, right = slip.terms(order)
    small = {symbol: size * symbol for symbol in (slip.K_T_left, slip.K_T_right, dsigma)}
    powers = [size**k for k in range(1, order + 1)]
    zones = {
        slip.d_left: sum(t * p for t, p in zip(left, powers, strict=True)),
        slip.d_right: sum(t * p for t, p in zip(right, powers, strict=True)),
    }
    for condition in slip.conditions(order):
        off = condition.xreplace(small).subs(zones).subs(c, width - a)
        assert simplify(series(off, size, 0, order + 1).removeO()) == 0


@pytest.mark.parametrize("order", [1, 2])
def test_terms_seen_from_behind_are_those_of_the_other_edge(order: int) -> None:
    """The mirror exchanges left and right, a and c, and turns the sign of the tension."""
    edges = {slip.K_T_left: slip.K_T_right, slip.kappa_left: slip.kappa_right}
    edges |= dict(
        zip(slip.coefficients("left", order), slip.coefficients("right", order), strict=True)
    )
    mirror = {**edges, **{v: k for k, v in edges.items()}, dsigma: -dsigma, a: c, c: a}
    for left, right in zip(*slip.terms(order), strict=True):
        assert simplify(left.subs(mirror, simultaneous=True) - right) == 0


def test_second_order_is_that_of_theory() -> None:
    """f K d - (L_T/2) d + (3/4) f L d**2 = K_T + f K d**2/(8 h) + kappa f K' d'**2/(4 h).

    Both edges' K_T by their first terms: d = K_T/(f K) in what is of second order.  Left edge,
    forward slip at both (kappa = 1): kappa_left = kappa_right = 1.
    """
    K, L, other = symbols("K L K_other", positive=True)
    width = Symbol("h", positive=True)
    forward = {slip.kappa_left: 1, slip.kappa_right: 1}
    names = {"C_left_0": K, "C_left_1": L, "C_right_0": other}
    left, right = slip.terms(2)
    given = forward | {Symbol(n, positive=True): v for n, v in names.items()}
    first, second = (t.subs(given).subs(c, width - a) for t in left)
    opposite = right[0].subs(given)
    L_T = slip.K_T_left / (2 * width) - dsigma / (4 * sqrt(width))
    theory = (
        L_T / 2 * first
        - Rational(3, 4) * f * L * first**2
        + f * K * first**2 / (8 * width)
        + f * other * opposite**2 / (4 * width)
    ) / (f * K)
    # dsigma is the difference of both K_T: sqrt(h) dsigma/4 = K_T_left - K_T_right
    tension = {dsigma: 4 * (slip.K_T_left - slip.K_T_right) / sqrt(width)}
    assert simplify((second - theory).subs(tension)) == 0


@pytest.mark.parametrize("name", ["wedge", "hertz", "quartic", "unequal_wedge"])
@pytest.mark.parametrize("edge", Edge, ids=lambda edge: edge.name.lower())
def test_the_next_coefficient_of_the_pressure(name: str, edge: Edge) -> None:
    """From the rate of the last one, against the expansion of p."""
    frame = sheet(name).frame
    moving = a if edge is Edge.LEFT else c
    series_of_p = pressure_series(frame, edge, 3)
    for k in (0, 1):
        rate = frame.diff(series_of_p[k], moving)
        found = slip.pressure_next(rate, k, series_of_p[0])
        off = frame.flat(found - series_of_p[k + 1]).subs({E_star: 1, h: a + c})
        numbers = {s: Rational(k + 3, 7) for k, s in enumerate(sorted(off.free_symbols, key=str))}
        assert abs(off.subs(numbers).evalf(30)) < 1e-25
