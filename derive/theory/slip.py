r"""The length of the slip zones, order by order, from the pressure next to the edges.

The two conditions of stick.py hold for any p1 and p2.  At a distance s from the edge,
p = K s**(1/2) + L s**(3/2) + ...  Over a slip zone of length d, the integrals in the conditions are
series in d/h_s, where h_s is the width of the stick zone:

    near = int_0^d p sqrt((h_s + d - s)/(d - s)) ds = sqrt(h_s) pi (K d/2 + 3 L d**2/8 + ...) + ...
    far  = int_0^d p sqrt((d - s)/(h_s + d - s)) ds = pi K d**2/(8 sqrt(h_s)) + ...,

Each term follows from int_0^d s**(i + 1/2) (d - s)**(j - 1/2) ds, a beta function.  Each contact of
the cycle has its own edges, d and K, L, ..., so that nothing more is needed for varying loads.

The slip zones of first order are D = K_T/(f kappa K), with K_T of full stick, and the loads enter
only through them: dsigma = 4 (K_T_left - K_T_right)/sqrt(h).  The order counts powers of the load
changes: d, D and the motion of the edges are of order one.  `conditions` truncates the integrals
after an order.  Solving these is more accurate than using the explicit powers, which `terms` gives
for constant loads.
"""

from collections.abc import Sequence
from functools import cache

from sympy import Abs, Expr, Poly, Rational, S, Symbol, binomial, expand, gamma, pi, sqrt, symbols

from derive.symbols import f, h
from derive.theory.edges import Edge

HALF = Rational(1, 2)

d_left, d_right = symbols("d_left d_right", positive=True)
K_T_left, K_T_right = symbols("K_T_left K_T_right", real=True)
senses = symbols("kappa_left kappa_right", real=True)
"""Directions of slip: +1 forward, -1 backward."""
D_left, D_right, rho, width = symbols("D_left D_right rho h", positive=True)
"""Slip zones of order 1; K_N kappa at the right edge divided by that at the left; contact width."""


def stuck_edge(edge: Edge) -> Symbol:
    """K_T of full stick at an edge."""
    return K_T_left if edge is Edge.LEFT else K_T_right


def ratios(side: str, order: int) -> tuple[Symbol, ...]:
    """Second and following coefficients of the pressure at one edge, divided by its K_N."""
    return symbols(f"c_{side}_1:{order}", real=True)


def near(pressure: Sequence[Expr], d: Expr, stuck: Expr, order: int) -> Expr:
    """int_0^d p sqrt((stuck + d - s)/(d - s)) ds without powers of d above `order`."""
    return _series(pressure, d, stuck, order, 0)


def far(pressure: Sequence[Expr], d: Expr, stuck: Expr, order: int) -> Expr:
    """int_0^d p sqrt((d - s)/(stuck + d - s)) ds without powers of d above `order`."""
    return _series(pressure, d, stuck, order, 1)


def _series(pressure: Sequence[Expr], d: Expr, stuck: Expr, order: int, shift: int) -> Expr:
    """int_0^d p (stuck + d - s)**(1/2 - shift) (d - s)**(shift - 1/2) ds, truncated after `order`.

    The first power is expanded as a binomial series in (d - s)/stuck.
    """
    power = HALF - shift
    return sum(
        (
            pressure[i]
            * binomial(power, j)
            * stuck ** (power - j)
            * _beta(i, j + shift)
            * d ** (i + j + shift + 1)
            for i in range(order - shift)
            for j in range(order - shift - i)
        ),
        S.Zero,
    )


def _beta(i: int, j: int) -> Expr:
    """int_0^1 t**(i + 1/2) (1 - t)**(j - 1/2) dt."""
    return gamma(i + 3 * HALF) * gamma(j + HALF) / gamma(i + j + 2)


def conditions(order: int) -> tuple[Expr, Expr]:
    """Expressions that vanish at the left and right end of the stick zone, for constant loads.

    Each is divided by pi sqrt(h) f kappa K_N/2 of its own edge.
    """
    left, right = ((S.One, *ratios(side, order)) for side in ("left", "right"))
    stuck = width - d_left - d_right
    shrunk = (D_left - rho * D_right) * (d_left + d_right) / (2 * width)
    at_left = near(left, d_left, stuck, order) + rho * far(right, d_right, stuck, order)
    at_right = near(right, d_right, stuck, order) + far(left, d_left, stuck, order) / rho
    scale = 2 / (pi * sqrt(width))
    return scale * at_left - D_left + shrunk, scale * at_right - D_right - shrunk / rho


@cache
def terms(order: int) -> tuple[tuple[Expr, ...], tuple[Expr, ...]]:
    """Terms of order 1, 2, ... of the slip zones at constant loads, at the left and the right edge.

    A condition is d - D plus products of higher order.  With d inserted up to order k - 1, the
    terms of order k of the condition are therefore those of -d.

    >>> first, second = terms(2)[0]
    >>> first
    D_left
    >>> second.coeff(D_right**2)
    rho/(4*h)
    """
    shrunk = (d_left + d_right) / width
    stuck = width - d_left - d_right

    def stuck_to(power: Expr) -> Expr:
        powers = (binomial(power, k) * (-shrunk) ** k for k in range(order))
        return width**power * sum(powers, S.Zero)

    nothing = [S.Zero] * (order + 1)
    series = {d_left: nothing[:], d_right: nothing[:]}
    series |= {D: [S.Zero, D, *nothing[2:]] for D in (D_left, D_right)}
    products = [
        Poly(
            condition.replace(lambda e: e.is_Pow and e.base == stuck, lambda e: stuck_to(e.exp)),
            *series,
        ).terms()
        for condition in conditions(order)
    ]
    for k in range(1, order + 1):
        found = [
            expand(sum(-factor * _product(series, powers, k) for powers, factor in of))
            for of in products
        ]
        series[d_left][k], series[d_right][k] = found
    return tuple(series[d_left][1:]), tuple(series[d_right][1:])


def _product(series: dict[Symbol, list[Expr]], powers: Sequence[int], order: int) -> Expr:
    """The term of one order of a product of powers of series, which begin at order one."""
    if sum(powers) > order:
        return S.Zero
    total = [S.One, *[S.Zero] * order]
    for factor, power in zip(series.values(), powers, strict=True):
        for _ in range(power):
            total = [
                expand(sum((total[i] * factor[k - i] for i in range(k + 1)), S.Zero))
                for k in range(order + 1)
            ]
    return total[order]


def slip_zone(pull: Expr, K_N: Expr) -> Expr:
    """The slip zone to first order, for either direction of slip.

    pull: pi sqrt(h) K_T, the load that drives slip.
    """
    return Abs(pull) / (pi * sqrt(h) * f * K_N)


def pressure_next(rate: Expr, order: int, K: Expr) -> Expr:
    r"""The coefficient after C_order; `rate` is the derivative of C_order as only the edge moves.

    An edge that moves by dc adds K sqrt(h - s)/(2 sqrt(h) sqrt(s)) dc to the pressure.  Comparing
    powers of s gives C_k' + (k + 3/2) C_(k+1) = (K/2) binomial(1/2, k + 1) (-1/h)**(k + 1).
    """
    k = order
    grown = K / 2 * binomial(HALF, k + 1) * (-1 / h) ** (k + 1)
    return (grown - rate) / (k + 3 * HALF)
