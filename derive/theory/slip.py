r"""The length of the slip zones, order by order, from the pressure next to the edges.

The two conditions of stick.py hold for any p1 and p2.  At a distance s from the edge,
p = K s**(1/2) + L s**(3/2) + ...  Over a slip zone of length d, the integrals in the conditions are
series in d/h_s, where h_s is the width of the stick zone:

    near = int_0^d p sqrt((h_s + d - s)/(d - s)) ds = sqrt(h_s) pi (K d/2 + 3 L d**2/8 + ...) + ...
    far  = int_0^d p sqrt((d - s)/(h_s + d - s)) ds = pi K d**2/(8 sqrt(h_s)) + ...,

Each term follows from int_0^d s**(i + 1/2) (d - s)**(j - 1/2) ds, a beta function.  Each contact of
the cycle has its own edges, d and K, L, ..., so that nothing more is needed for varying loads.  The
order counts powers of the load changes: d, dQ, dsigma and the motion of the edges are of order one.
`conditions` truncates both conditions after an order.  Solving these is more accurate than using
the explicit powers, which `terms` gives for constant loads.
"""

from collections.abc import Sequence
from functools import cache

from sympy import (
    Abs,
    Expr,
    Rational,
    S,
    Symbol,
    binomial,
    expand,
    gamma,
    pi,
    series,
    simplify,
    solve,
    sqrt,
    symbols,
)

from derive.symbols import a, c, dsigma, f, h
from derive.theory.edges import Edge

HALF = Rational(1, 2)

d_left, d_right = symbols("d_left d_right", positive=True)
K_T_left, K_T_right = symbols("K_T_left K_T_right", real=True)
kappa_left, kappa_right = symbols("kappa_left kappa_right", real=True)
senses = kappa_left, kappa_right
"""Directions of slip: +1 forward, -1 backward."""
D_left, D_right, rho, width = symbols("D_left D_right rho h", positive=True)
"""Slip zones of order 1; K_N kappa at the right edge over that at the left edge; contact width."""


def coefficients(side: str, order: int) -> tuple[Symbol, ...]:
    """K_N, L_N and the following coefficients of the pressure at one edge."""
    return symbols(f"C_{side}_0:{order}", positive=True)


def stuck_edge(edge: Edge) -> Symbol:
    """K_T of full stick at an edge, as it appears in the series."""
    return K_T_left if edge is Edge.LEFT else K_T_right


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

    Both are divided by pi sqrt(h), so that the loads enter only through K_T and dsigma.
    """
    left, right = coefficients("left", order), coefficients("right", order)
    stuck = h - d_left - d_right
    shrunk = dsigma * (d_left + d_right) / (8 * sqrt(h))
    at_left = kappa_left * near(left, d_left, stuck, order)
    at_left += kappa_right * far(right, d_right, stuck, order)
    at_right = kappa_right * near(right, d_right, stuck, order)
    at_right += kappa_left * far(left, d_left, stuck, order)
    scale = 2 * f / (pi * sqrt(h))
    return scale * at_left - K_T_left + shrunk, scale * at_right - K_T_right - shrunk


@cache
def terms(order: int) -> tuple[tuple[Expr, ...], tuple[Expr, ...]]:
    """Terms of order 1, 2, ... of the slip zones at constant loads, at the left and the right edge.

    >>> from derive.theory.slip import terms
    >>> terms(1)
    ((K_T_left/(C_left_0*f*kappa_left),), (K_T_right/(C_right_0*f*kappa_right),))
    """
    size = Symbol("epsilon", positive=True)
    unknown = [(Symbol(f"l_{k}"), Symbol(f"r_{k}")) for k in range(1, order + 1)]
    lefts, rights = ([pair[i] * size**k for k, pair in enumerate(unknown, 1)] for i in (0, 1))
    small = {d_left: sum(lefts), d_right: sum(rights)}
    small |= {symbol: symbol * size for symbol in (K_T_left, K_T_right, dsigma)}
    both = [
        series(condition.subs(h, width).xreplace(small), size, 0, order + 1).removeO()
        for condition in conditions(order)
    ]
    known: dict[Symbol, Expr] = {}
    for k, pair in enumerate(unknown, 1):
        equations = [expand(condition).coeff(size, k).subs(known) for condition in both]
        (found,) = solve(equations, pair, dict=True)
        known |= {symbol: value.subs(width, h).factor() for symbol, value in found.items()}
    return tuple(known[pair[0]] for pair in unknown), tuple(known[pair[1]] for pair in unknown)


def ratios(side: str, order: int) -> tuple[Symbol, ...]:
    """Second and following coefficients of the pressure at one edge, divided by its K_N."""
    return symbols(f"c_{side}_1:{order}", real=True)


def terms_in_ratios(order: int) -> tuple[tuple[Expr, ...], tuple[Expr, ...]]:
    """`terms` in terms of the slip zones of order 1.

    The terms are short because the tension follows from both K_T:
    K_T_left - K_T_right = dsigma sqrt(h)/4.

    >>> first, second = terms_in_ratios(2)[0]
    >>> first
    D_left
    >>> second.coeff(D_right**2)
    rho/(4*h)
    """
    K = Symbol("K", positive=True)
    stuck = {K_T_left: D_left * f * K, K_T_right: D_right * f * K * rho}
    pressed: dict[Expr, Expr] = {}
    for side, sense, first in (("left", kappa_left, K), ("right", kappa_right, K * rho)):
        names = coefficients(side, order)
        both = zip(names, (S.One, *ratios(side, order)), strict=True)
        pressed |= {name: ratio * first / sense for name, ratio in both}
    tension = {dsigma: 4 * (K_T_left - K_T_right) / sqrt(width)}

    def shortened(term: Expr) -> Expr:
        by_width = term.subs(c, width - a).xreplace(tension)
        return expand(simplify(by_width.xreplace(stuck | pressed)))

    left, right = (tuple(map(shortened, found)) for found in terms(order))
    return left, right


def slip_zone(edge: Edge, pull: Expr, K_N: Expr) -> Expr:
    """The slip zone at `edge` to first order, for either direction of slip.

    pull: pi sqrt(h) K_T, the load that drives slip.
    """
    kappa = senses[edge is Edge.RIGHT]
    (first,) = terms(1)[edge is Edge.RIGHT]
    (K_N_edge,) = coefficients(edge.name.lower(), 1)
    return first.subs({stuck_edge(edge): Abs(pull) / (pi * sqrt(h)), kappa: S.One, K_N_edge: K_N})


def pressure_next(rate: Expr, order: int, K: Expr) -> Expr:
    r"""The coefficient after C_order; `rate` is the derivative of C_order as only the edge moves.

    An edge that moves by dc adds K sqrt(h - s)/(2 sqrt(h) sqrt(s)) dc to the pressure.  Comparing
    powers of s gives C_k' + (k + 3/2) C_(k+1) = (K/2) binomial(1/2, k + 1) (-1/h)**(k + 1).
    """
    k = order
    grown = K / 2 * binomial(HALF, k + 1) * (-1 / h) ** (k + 1)
    return (grown - rate) / (k + 3 * HALF)
