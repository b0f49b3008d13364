r"""Every convex body as a superposition of wedges: integrals for a body of any profile.

A corner at s where g' rises by J contributes the pressure (E*/pi) J L(x, s).  A curved piece is a
continuous row of corners with J = g''(s) ds.  With w = sqrt((a + xi)(c - xi)),

    P = (E*/2) int g'' w dxi,     M = -(E*/4) int g'' w (xi + mid) dxi,
    K_right = (E*/(pi sqrt(h))) int g'' w/(c - xi) dxi,     K_left likewise with (a + xi),
    L(x, xi) = asinh sqrt((a + xi)(c - x)/(h (x - xi))) for xi < x, its mirror image for xi > x.

For a convex body, nothing is subtracted in P, p and K.  The second coefficient is a finite part,

    L_right = -E* g''(c)/(4 sqrt(h))
              + (E*/(6 pi h**(3/2))) int (g''(xi) - g''(c)) w (3 h - (a + xi))/(c - xi)**2 dxi,

whose first term is that of a parabola.
"""

from collections.abc import Callable, Sequence

from sympy import (
    Add,
    Expr,
    Function,
    Integral,
    Max,
    Min,
    Piecewise,
    Rational,
    S,
    Symbol,
    asinh,
    oo,
    pi,
    piecewise_fold,
    sqrt,
)

from derive.body.profile import Slope
from derive.symbols import E_star, a, c, h, mid, x
from derive.theory.edges import Edge
from derive.theory.frame import KinkFrame

xi = Symbol("xi", real=True)
"""The variable of integration; x is the point at which the pressure is computed."""

slope, curvature = Function("g'"), Function("g''")

root = sqrt((a + xi) * (c - xi))
"""w at xi."""


def formulas(kinks: Sequence[KinkFrame] = ()) -> dict[str, Expr]:
    """All formulas for any profile with these kinks, by their names on the sheet.

    The integral of the pressure is split at x, where L has a logarithmic singularity.
    """
    before = asinh(sqrt((a + xi) * (c - x) / (h * (x - xi))))
    behind = asinh(sqrt((c - xi) * (a + x) / (h * (xi - x))))
    curved = _over(curvature(xi) * before, high=x) + _over(curvature(xi) * behind, low=x)
    found = {
        "tilt": -_over(slope(xi) / root) / pi,
        "load": E_star / 2 * _pressed(lambda s: S.One, kinks),
        "moment": -E_star / 4 * _pressed(lambda s: s + mid, kinks),
        "pressure": E_star / pi * (curved + _corners(lambda k: k.L, kinks)),
    }
    for edge in Edge:
        side = edge.name.lower()
        found[f"K_N_{side}"], found[f"L_N_{side}"] = _at_edge(edge, kinks)
    return found


def _at_edge(edge: Edge, kinks: Sequence[KinkFrame]) -> tuple[Expr, Expr]:
    """K_N and L_N."""
    here = curvature(edge.position)

    def to(place: Expr) -> Expr:
        return c - place if edge is Edge.RIGHT else a + place

    def weight(place: Expr) -> Expr:
        return (2 * h + to(place)) / to(place) ** 2

    first = E_star / (pi * sqrt(h)) * _pressed(lambda s: 1 / to(s), kinks)
    others = _over((curvature(xi) - here) * root * weight(xi))
    others += _corners(lambda k: k.w * weight(k.kink.position), kinks)
    return first, E_star * (others / (6 * pi * h ** Rational(3, 2)) - here / (4 * sqrt(h)))


def _pressed(weight: Callable[[Expr], Expr], kinks: Sequence[KinkFrame]) -> Expr:
    """int g'' w weight dxi, plus the corners' contributions."""
    corners = _corners(lambda k: k.w * weight(k.kink.position), kinks)
    return _over(curvature(xi) * root * weight(xi)) + corners


def _over(density: Expr, low: Expr = -a, high: Expr = c) -> Expr:
    return Integral(density, (xi, low, high))


def _corners(at: Callable[[KinkFrame], Expr], kinks: Sequence[KinkFrame]) -> Expr:
    """The sum of the jumps of g', each times a weight."""
    return Add(*(k.kink.step * at(k) for k in kinks if k.kink.is_corner))


def by_pieces(expr: Expr, of: Slope) -> Expr:
    """The expression with g' and g'' of a body: an integral over each piece that is not zero."""
    *others, last = of.pieces
    at_edges = {}
    for edge in Edge:
        place = edge.position
        branches = [(p.curvature.subs(x, place), place < p.upper) for p in others]
        at_edges[curvature(place)] = Piecewise(*branches, (last.curvature.subs(x, place), True))
    expr = expr.xreplace(at_edges)
    return expr.xreplace({over: _over_pieces(over, of) for over in expr.atoms(Integral)})


def _over_pieces(over: Integral, of: Slope) -> Expr:
    """An integral over all pieces, each limited to its interval."""
    ((_, low, high),) = over.limits
    total = S.Zero
    for piece in of.pieces:
        start = low if piece.lower == -oo else Max(low, Min(piece.lower, high))
        end = high if piece.upper == oo else Max(low, Min(piece.upper, high))
        held = {slope(xi): piece.slope.subs(x, xi), curvature(xi): piece.curvature.subs(x, xi)}
        value = piecewise_fold(over.function.xreplace(held))  # zero where g'' is that at the edge
        if value != 0:
            total += Integral(value, (xi, start, end))
    return total
