"""Series of the slip zones: their integrals by quadrature, their terms put back, theory's form."""

from collections.abc import Callable
from itertools import product

import mpmath
import pytest
from mpmath import mpf
from sympy import Rational, Symbol, lambdify, symbols

from derive.symbols import E_star, a, c, h
from derive.theory import slip
from derive.theory.edges import Edge, pressure_series
from tests.derive.bodies import sheet

d, stuck = symbols("d stuck", positive=True)
SERIES = (mpf(2), mpf(-3) / 4, mpf(5) / 8)


def integral(integrand: Callable[[mpf], mpf], length: mpf) -> mpf:
    """int_0^length integrand(y)/sqrt(y) dy, by y = length sin(t)**2."""

    def along(t: mpf) -> mpf:
        return 2 * mpmath.sqrt(length) * mpmath.cos(t) * integrand(length * mpmath.sin(t) ** 2)

    return mpmath.quad(along, [0, mpmath.pi / 2])


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


@pytest.mark.parametrize("order", [1, 2, 3])
def test_terms_put_back_leave_what_is_of_the_next_order(order: int) -> None:
    """A quarter of the loads: 4**-(order + 1) of what is left of both conditions."""
    values = dict(
        zip(("c_left_1", "c_left_2", "c_right_1", "c_right_2"), (3, -2, 1, 4), strict=True)
    )
    numbers = {Symbol(name, real=True): Rational(v, 5) for name, v in values.items()}
    numbers |= {slip.rho: Rational(-3, 2), slip.width: Rational(7, 3)}
    left = []
    for size in (Rational(1, 256), Rational(1, 1024)):
        here = numbers | {slip.D_left: 2 * size, slip.D_right: 3 * size}
        zones = (sum(found).xreplace(here) for found in slip.terms(order))
        here |= dict(zip((slip.d_left, slip.d_right), zones, strict=True))
        left.append([abs(found.xreplace(here).evalf(40)) for found in slip.conditions(order)])
    for first, second in zip(*left, strict=True):
        assert abs(mpmath.log(first / second, 4) - (order + 1)) < 0.05


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
