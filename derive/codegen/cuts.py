"""Closed formulas whose powers cancel, and where a body is cut for quadrature.

In:  a body's Slope.
Out: whether its formulas hold powers that cancel; the places where a body that is integrated is
     cut, so that each of its pieces is written about its own root.

The formulas are written about the origin.  Close to a root of g'' or to a kink that lies elsewhere,
powers of its place cancel: in (x - b)**3, a contact of width h loses the factor (b/h)**3.
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
    simplify,
)

from derive.piece import Piece
from derive.profile import Slope, breaks_of, lies_in
from derive.symbols import x

HARMLESS = 1
"""A g' of this degree loses no more than the rounding of the edges does anyway."""

_r = Symbol("x", positive=True)
"""A distance from the origin."""


def cancels(slope: Slope) -> bool:
    """Whether powers may cancel somewhere in the closed formulas.

    >>> from sympy import symbols
    >>> from derive.profile import read_slope
    >>> b = symbols("b", positive=True)
    >>> [cancels(read_slope("", g)) for g in (x**4 / b**3, (x - b) ** 4 / b**3)]
    [False, True]
    """
    if not slope.is_polynomial or all(_degree(part) <= HARMLESS for part in _parts(slope)):
        return False
    return bool(slope.kinks) or not all(map(_adds_up, slope.pieces))


def _parts(slope: Slope) -> tuple[Expr, ...]:
    """What the formulas are made of: one polynomial, and one more at each kink."""
    return (slope.base, *(kink.jump for kink in slope.kinks))


def _degree(polynomial: Expr) -> int:
    return int(max(Poly(polynomial, x).degree(), 0))


def _adds_up(piece: Piece) -> bool:
    """Whether the terms of g'' have one sign, on either side of the origin that the piece has."""
    sides = [sense for sense, end in ((1, piece.upper), (-1, piece.lower)) if end in (oo, -oo)]
    terms = [expand(piece.curvature.subs(x, sense * _r)) for sense in sides]
    return all(t.is_nonnegative for whole in terms for t in Add.make_args(whole))


@lru_cache(maxsize=16)
def cuts_of(slope: Slope) -> tuple[tuple[Expr, ...], tuple[Piece, ...]]:
    """Where quadrature cuts the body, and the pieces between.

    >>> from sympy import symbols
    >>> from derive.profile import read_slope
    >>> b = symbols("b", positive=True)
    >>> cuts_of(read_slope("", (x - b) ** 4 / b**3))[0]
    (b,)
    """
    pieces: list[Piece] = []
    if cancels(slope):
        for piece in slope.pieces:
            ends = [piece.lower, *_level_places(piece), piece.upper]
            pieces += [Piece(low, high, piece.profile) for low, high in pairwise(ends)]
    if len(pieces) <= 1:
        pieces = [*breaks_of(slope)[1]]
    pieces = [half for piece in pieces for half in _at_origin(piece, slope)]
    return tuple(piece.upper for piece in pieces[:-1]), tuple(pieces)


def _at_origin(piece: Piece, slope: Slope) -> list[Piece]:
    """Two pieces of one that is level, or not curved, at the origin inside it; else that piece.

    Small contacts lie there, and at a distance from another place g' is a small difference.
    """
    origin = Integer(0)
    if piece.straight or not lies_in(origin, piece, slope.domain):
        return [piece]
    if all(value.subs(x, origin) != 0 for value in (piece.slope, piece.curvature)):
        return [piece]
    ends = (piece.lower, origin, piece.upper)
    return [Piece(low, high, piece.profile) for low, high in pairwise(ends)]


def _level_places(piece: Piece) -> list[Expr]:
    """Where g'' is level or closest to it inside a piece, as far as their order is known.

    Of its linear and quadratic factors; roots of others are no numbers that code could be written
    about.
    """
    found: list[Expr] = []
    _, factors = factor_list(piece.curvature, x)
    for factor in (Poly(factor, x) for factor, _ in factors):
        if factor.degree() not in (1, 2):
            continue
        leading, next_to_it, *_ = factor.all_coeffs()
        place = simplify(-next_to_it / (factor.degree() * leading))
        ends = [piece.lower, *found, piece.upper]
        later = [_follows(end, place) for end in ends]
        sooner = [_follows(place, end) for end in ends]
        if all(up or down for up, down in zip(later, sooner, strict=True)) and later[0]:
            at = sum(later) - 1
            if sooner[-1]:
                found.insert(at, place)
    return found


def _follows(first: Expr, second: Expr) -> bool:
    """Whether the second place is known to lie beyond the first."""
    if first == -oo or second == oo:
        return True
    if first == oo or second == -oo:
        return False
    return bool(simplify(second - first).is_positive)
