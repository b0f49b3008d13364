"""Finds closed formulas whose powers cancel, and the points at which a body is cut for quadrature.

In:  the Slope of a body.
Out: whether its formulas contain powers that cancel; the points at which a body is cut for
     quadrature, so that each piece is written about its own root.

The formulas are written about the origin.  Close to a root of g'', or to a kink, that lies away
from the origin, powers of its position cancel: with (x - b)**3, a contact of width h loses
accuracy by the factor (b/h)**3.
"""

from functools import lru_cache
from itertools import pairwise

from sympy import (
    Add,
    Expr,
    Integer,
    Poly,
    Symbol,
    expand,
    factor_list,
    oo,
    re,
    simplify,
)

from derive.body.piece import Piece
from derive.body.profile import Slope, branch_points, lies_in
from derive.symbols import x

HARMLESS = 1
"""Highest degree of g' at which cancellation costs no more than the rounding of the edges."""

_r = Symbol("x", positive=True)
"""A distance from the origin."""


def cancels(slope: Slope) -> bool:
    """Whether powers of x in the closed formulas may nearly cancel, so that digits are lost.

    >>> from sympy import symbols
    >>> from derive.body.profile import read_slope
    >>> b = symbols("b", positive=True)
    >>> [cancels(read_slope("", g)) for g in (x**4 / b**3, (x - b) ** 4 / b**3)]
    [False, True]
    """
    if not slope.is_polynomial or all(_degree(part) <= HARMLESS for part in _parts(slope)):
        return False
    return bool(slope.kinks) or not all(map(_adds_up, slope.pieces))


def _parts(slope: Slope) -> tuple[Expr, ...]:
    """The polynomials that make up the formulas: the base, and the jump at each kink."""
    return (slope.base, *(kink.jump for kink in slope.kinks))


def _degree(polynomial: Expr) -> int:
    return int(max(Poly(polynomial, x).degree(), 0))


def _adds_up(piece: Piece) -> bool:
    """Whether no term of g'' is negative on any side of the origin where the piece is unbounded."""
    sides = [sense for sense, end in ((1, piece.upper), (-1, piece.lower)) if end in (oo, -oo)]
    terms = [expand(piece.curvature.subs(x, sense * _r)) for sense in sides]
    return all(t.is_nonnegative for whole in terms for t in Add.make_args(whole))


@lru_cache(maxsize=16)
def cuts_of(slope: Slope) -> tuple[tuple[Expr, ...], tuple[Piece, ...]]:
    """The points at which quadrature cuts the body, and the pieces between them.

    >>> from sympy import symbols
    >>> from derive.body.profile import read_slope
    >>> b = symbols("b", positive=True)
    >>> cuts_of(read_slope("", (x - b) ** 4 / b**3))[0]
    (b,)
    """
    cancelling, pieces = cancels(slope), []
    for piece in slope.pieces:
        places = _level_points(piece, slope) if cancelling else _beside_singularities(piece, slope)
        for part in _cut(piece, *places):
            pieces += _cut(part, _ORIGIN) if _is_level(part, slope) else [part]
    if len(pieces) == 1:
        pieces = _cut(pieces[0], _ORIGIN)
    return tuple(piece.upper for piece in pieces[:-1]), tuple(pieces)


_ORIGIN = Integer(0)


def _cut(piece: Piece, *places: Expr) -> list[Piece]:
    ends = pairwise([piece.lower, *places, piece.upper])
    return [Piece(low, high, piece.profile) for low, high in ends]


def _is_level(piece: Piece, slope: Slope) -> bool:
    """Whether the origin is inside a curved piece, and g' or g'' is zero there.

    Small contacts lie at such an origin.  Written about any other point, g' would be a small
    difference of large terms there.
    """
    if piece.straight or not lies_in(_ORIGIN, piece, slope.domain):
        return False
    return any(value.subs(x, _ORIGIN) == 0 for value in (piece.slope, piece.curvature))


def _beside_singularities(piece: Piece, slope: Slope) -> list[Expr]:
    """The real part of a complex singularity beside a piece, if there is one."""
    beside = {simplify(re(point)) for point in branch_points(piece.profile)}
    return sorted((p for p in beside if lies_in(p, piece, slope.domain)), key=str)[:1]


def _level_points(piece: Piece, slope: Slope) -> list[Expr]:
    """Points inside a piece at which a factor of g'' is zero or smallest, in order of position.

    Only linear and quadratic factors are considered, because the roots of other factors have no
    simple expression.  Points whose order is not known are left out.
    """
    points: list[Expr] = []
    _, factors = factor_list(piece.curvature, x)
    for factor in (Poly(factor, x) for factor, _ in factors):
        if factor.degree() in (1, 2):
            leading, next_to_it, *_ = factor.all_coeffs()
            point = simplify(-next_to_it / (factor.degree() * leading))
            gaps = [simplify(point - other) for other in points]
            if lies_in(point, piece, slope.domain) and all(
                g.is_positive or g.is_negative for g in gaps
            ):
                points.insert(sum(bool(gap.is_positive) for gap in gaps), point)
    return points
