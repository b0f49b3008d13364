"""The integrals of the theory by quadrature, with nothing of the program in them.

s = mid + (h/2) cos(t) takes the root w = (h/2) sin(t) out of every integrand; the half circle is
cut wherever the integrand has a kink.
"""

from collections.abc import Callable, Iterable

import mpmath
from mpmath import mpf

Function = Callable[[mpf], mpf]

GENTLE = "gauss-legendre"
"""Enough for polynomials on pieces; "tanh-sinh" where a slope bends sharply."""


def over_contact(
    f: Function, a: mpf, c: mpf, cuts: Iterable[mpf] = (), method: str = GENTLE
) -> mpf:
    """int_{-a}^{c} f(s)/w(s) ds."""
    middle, half = mpf(c - a) / 2, mpf(a + c) / 2
    angles = {mpmath.acos((cut - middle) / half) for cut in cuts if -a < cut < c}
    return mpmath.quad(
        lambda t: f(middle + half * mpmath.cos(t)),
        sorted({mpf(0), +mpmath.pi, *angles}),
        method=method,
    )


def root(s: mpf, a: mpf, c: mpf) -> mpf:
    """w(s)."""
    return mpmath.sqrt((a + s) * (c - s))


def tilt(slope: Function, a: mpf, c: mpf, kinks: Iterable[mpf], method: str = GENTLE) -> mpf:
    """alpha from int (g' + alpha)/w ds = 0, where int 1/w ds = pi."""
    return -over_contact(slope, a, c, kinks, method) / mpmath.pi


def load(
    slope: Function,
    a: mpf,
    c: mpf,
    kinks: Iterable[mpf],
    E_star: mpf,
    method: str = GENTLE,
) -> mpf:
    """P = (E*/2) int s (g' + alpha)/w ds."""
    alpha = tilt(slope, a, c, kinks, method)
    return E_star / 2 * over_contact(lambda s: s * (slope(s) + alpha), a, c, kinks, method)


def moment(
    slope: Function,
    a: mpf,
    c: mpf,
    kinks: Iterable[mpf],
    E_star: mpf,
    method: str = GENTLE,
) -> mpf:
    """M = -(E*/2) int s (s - mid) (g' + alpha)/w ds."""
    alpha, middle = tilt(slope, a, c, kinks, method), mpf(c - a) / 2
    arm = over_contact(lambda s: s * (s - middle) * (slope(s) + alpha), a, c, kinks, method)
    return -E_star / 2 * arm


def pressure(
    slope: Function,
    x: mpf,
    a: mpf,
    c: mpf,
    kinks: Iterable[mpf],
    E_star: mpf,
    method: str = GENTLE,
    cut: bool = True,
) -> mpf:
    """p(x) = (E*/2 pi) w(x) int (g'(s) - g'(x)) / ((s - x) w(s)) ds, cut at x unless at an edge."""
    here = slope(x)

    def quotient(s: mpf) -> mpf:
        return (slope(s) - here) / (s - x) if s != x else mpf(0)

    principal = over_contact(quotient, a, c, (*kinks, *([x] if cut else [])), method)
    return E_star / (2 * mpmath.pi) * root(x, a, c) * principal


def resultant(weighted: Function, a: mpf, c: mpf, kinks: Iterable[mpf]) -> mpf:
    """int_{-a}^{c} weighted(s) ds of something that may be a logarithm at a kink."""

    def integrand(s: mpf) -> mpf:
        try:
            return weighted(s) * root(s, a, c)
        except ZeroDivisionError:  # a node that rounds to the kink itself carries no weight
            return mpf(0)

    return over_contact(integrand, a, c, kinks, method="tanh-sinh")


def principal_value(f: Function, x: mpf, a: mpf, c: mpf, kinks: Iterable[mpf]) -> mpf:
    """PV int_{-a}^{c} f(s)/(x - s) ds, by PV int ds/(x - s) = log((a + x)/(c - x))."""
    here = f(x)
    regular = resultant(lambda s: (f(s) - here) / (x - s), a, c, (*kinks, x))
    return regular + here * mpmath.log((a + x) / (c - x))
