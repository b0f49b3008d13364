r"""What is true of every convex body, in terms of its two edge coefficients alone.

A convex body is a row of corners.  One corner at xi, of unit strength, has with w = w(xi)

    P = (E*/2) w,   M = -(E*/4) w (xi + mid),   alpha = -theta/pi,
    K_left = (E*/(pi sqrt(h))) w/(a + xi),      K_right = (E*/(pi sqrt(h))) w/(c - xi),

and all are linear in the corners, so that what holds between them for one corner holds for any
body: the rates at which load, moment and tilt grow as one edge moves are multiples of that edge's
coefficient.  `demand_proven` differentiates the one corner.
"""

from functools import cache

from sympy import Expr, Symbol, acos, pi, simplify, sqrt

from derive.errors import NotProven
from derive.symbols import E_star

left = Symbol("l", positive=True)
"""The left edge is at x = -left."""
right = Symbol("r_e", positive=True)
"""The right edge is at x = right."""
K_left = Symbol("K_left", positive=True)
K_right = Symbol("K_right", positive=True)

h = left + right
mid = (right - left) / 2


def load_by(edge: Symbol) -> Expr:
    """dP/da or dP/dc: (pi sqrt(h)/4) K at that edge."""
    return pi * sqrt(h) / 4 * (K_left if edge == left else K_right)


def moment_by(edge: Symbol) -> Expr:
    """dM/da or dM/dc: the load added acts a quarter of the width inward of that edge."""
    return -load_by(edge) * (mid - h / 4 if edge == left else mid + h / 4)


def tilt_by(edge: Symbol) -> Expr:
    """dalpha/da or dalpha/dc."""
    return (1 if edge == left else -1) * 4 * load_by(edge) / (pi * E_star * h)


def edge_ratio() -> Expr:
    """a'(c) at fixed tilt."""
    return -tilt_by(right) / tilt_by(left)


def load_rate() -> Expr:
    """P'(c) at fixed tilt."""
    return load_by(right) + load_by(left) * edge_ratio()


def pressure_rate(x: Expr) -> Expr:
    """dp/dc at fixed tilt: each edge that moves adds half its coefficient over a root."""
    root = 2 * sqrt(h) * sqrt((left + x) * (right - x))
    return (K_right * (left + x) + K_left * (right - x) * edge_ratio()) / root


@cache
def demand_proven() -> None:
    """Nothing, or NotProven: the rates of one corner by differentiation."""
    xi = Symbol("xi", real=True)
    w = sqrt((left + xi) * (right - xi))
    own = {
        K_left: E_star / (pi * sqrt(h)) * w / (left + xi),
        K_right: E_star / (pi * sqrt(h)) * w / (right - xi),
    }
    load, moment = E_star / 2 * w, -E_star / 4 * w * (xi + mid)
    tilt = -acos((xi - mid) / (h / 2)) / pi
    for edge in (left, right):
        for of, rate in ((load, load_by), (moment, moment_by), (tilt, tilt_by)):
            gap = of.diff(edge) - rate(edge).subs(own, simultaneous=True)
            if simplify(gap.subs(xi, _inside)) != 0:
                raise NotProven(f"rate of {of} by {edge}")


_u = Symbol("u", positive=True)
_inside = (right * _u**2 - left) / (1 + _u**2)
"""Any place of the contact, written so that its root comes out."""
