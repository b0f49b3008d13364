r"""Every convex body as a superposition of wedges: integrals for a body of any profile.

A corner at s where g' rises by J contributes the pressure (E*/pi) J L(x, s).  A curved piece is a
continuous row of corners with J = g''(s) ds.  With w = sqrt((a + xi)(c - xi)),

    P = (E*/2) int g'' w dxi,     M = -(E*/4) int g'' w (xi + mid) dxi,
    K_right = (E*/(pi sqrt(h))) int g'' w/(c - xi) dxi,     K_left likewise with (a + xi).

For a convex body, nothing is subtracted in P, p and K.  The second coefficient is a finite part,

    L_right = -E* g''(c)/(4 sqrt(h))
              + (E*/(6 pi h**(3/2))) int (g''(xi) - g''(c)) w (3 h - (a + xi))/(c - xi)**2 dxi,

whose first term is that of a parabola.
"""

from collections.abc import Callable

from sympy import Abs, Expr, Integral, Max, Min, Piecewise, Rational, S, Symbol, log, oo, pi, sqrt

from derive.body.piece import Piece
from derive.symbols import E_star, a, c, h, mid, x
from derive.theory.edges import Edge
from derive.theory.frame import Frame, KinkFrame

xi = Symbol("xi", real=True)
"""The variable of integration; x is the point at which the pressure is computed."""

root = sqrt((a + xi) * (c - xi))
"""w at xi."""

_u, _v = sqrt((c - xi) * (a + x)), sqrt((a + xi) * (c - x))

kernel = log(Abs((_u + _v) / (_u - _v)))
"""2 L of a corner at xi."""


def tilt(frame: Frame) -> Expr:
    """alpha from I_0 = 0."""
    return -_over(frame, lambda piece: piece.slope.subs(x, xi) / root) / pi


def load(frame: Frame) -> Expr:
    """(E*/2) int g'' w dxi."""
    return E_star / 2 * _pressed(frame, root, lambda k: k.w)


def moment(frame: Frame) -> Expr:
    """-(E*/4) int g'' w (xi + mid) dxi."""
    return -E_star / 4 * _pressed(frame, root * (xi + mid), lambda k: k.w * (k.kink.position + mid))


def pressure(frame: Frame) -> Expr:
    """(E*/pi) int g'' L dxi, split at x, where L has a logarithmic singularity."""
    left = _pressed(frame, kernel / 2, lambda k: k.L, high=x)
    return E_star / pi * (left + _pressed(frame, kernel / 2, lambda k: S.Zero, low=x))


def edge_coefficient(frame: Frame, edge: Edge) -> Expr:
    """K_N at one edge."""
    total = _pressed(frame, root / _to(edge, xi), lambda k: k.w / _to(edge, k.kink.position))
    return E_star / (pi * sqrt(h)) * total


def second_coefficient(frame: Frame, edge: Edge) -> Expr:
    """L_N at one edge."""
    here = _curvature_at(frame, edge)

    def weight(place: Expr) -> Expr:
        return (2 * h + _to(edge, place)) / _to(edge, place) ** 2

    total = _over(frame, lambda p: (p.curvature.subs(x, xi) - here) * root * weight(xi))
    total += _steps(frame, lambda k: k.w * weight(k.kink.position))
    return E_star * (total / (6 * pi * h ** Rational(3, 2)) - here / (4 * sqrt(h)))


def _to(edge: Edge, place: Expr) -> Expr:
    """Distance from an edge to a point."""
    return c - place if edge is Edge.RIGHT else a + place


def _curvature_at(frame: Frame, edge: Edge) -> Expr:
    """g'' at an edge."""
    *others, last = frame.slope.pieces
    place = edge.position
    branches = [(p.curvature.subs(x, place), place < p.upper) for p in others]
    return Piecewise(*branches, (last.curvature.subs(x, place), True))


def _pressed(
    frame: Frame,
    weight: Expr,
    at: Callable[[KinkFrame], Expr],
    low: Expr = -a,
    high: Expr = c,
) -> Expr:
    """int g'' weight dxi from low to high, plus the corners' contributions."""
    curved = _over(frame, lambda p: p.curvature.subs(x, xi) * weight, low, high)
    return curved + _steps(frame, at)


def _steps(frame: Frame, at: Callable[[KinkFrame], Expr]) -> Expr:
    """The sum of the corners' jumps, each times a weight."""
    return sum((k.kink.step * at(k) for k in frame.kinks if k.kink.is_corner), S.Zero)


def _over(frame: Frame, integrand: Callable[[Piece], Expr], low: Expr = -a, high: Expr = c) -> Expr:
    """An integral over all pieces, each limited to the interval from low to high."""
    total = S.Zero
    for piece in frame.slope.pieces:
        start = low if piece.lower == -oo else Max(low, Min(piece.lower, high))
        end = high if piece.upper == oo else Max(low, Min(piece.upper, high))
        value = integrand(piece)
        if value != 0:
            total += Integral(value, (xi, start, end))
    return total
