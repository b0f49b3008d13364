"""One piece of a profile, and the jump of g' where two pieces meet.

In:  g(x) between two kinks.
Out: its slope and curvature, the jump of the slope at a kink, and whether the piece is straight.
"""

from dataclasses import dataclass
from functools import cached_property

from sympy import (
    AccumBounds,
    Dummy,
    Expr,
    Pow,
    Rational,
    Symbol,
    diff,
    limit,
    nan,
    oo,
    simplify,
    zoo,
)
from sympy.logic.boolalg import Boolean

from derive.body.steep import gently
from derive.symbols import x


@dataclass(frozen=True)
class Piece:
    """g(x) = `profile` for `lower` < x < `upper`."""

    lower: Expr
    upper: Expr
    profile: Expr

    @property
    def slope(self) -> Expr:
        """g'(x) of this piece."""
        return diff(self.profile, x)

    @cached_property
    def curvature(self) -> Expr:
        """g''(x) of this piece."""
        return diff(self.profile, x, 2)

    @cached_property
    def straight(self) -> bool:
        """Whether the piece is a straight line, which carries no load by itself."""
        return vanishes(self.curvature)


def surpluses(demands: tuple[Boolean, ...]) -> dict[Symbol, tuple[Expr, Symbol]]:
    """Parameters with a lower bound, each with its bound and a positive symbol for the excess."""
    return {d.gts: (d.lts, Dummy("above", positive=True)) for d in demands if d.gts.is_Symbol}


def with_surpluses(expr: Expr, found: dict[Symbol, tuple[Expr, Symbol]]) -> Expr:
    """`expr` with each such parameter written as its bound plus the excess."""
    return expr.subs({p: least + above for p, (least, above) in found.items()})


def step(left: Piece, right: Piece, demands: tuple[Boolean, ...] = ()) -> Expr:
    """The jump of g' where two pieces meet."""
    found = surpluses(demands)
    before, beyond = (
        beside(with_surpluses(piece.slope, found), with_surpluses(right.lower, found), sense)
        for piece, sense in ((left, -1), (right, 1))
    )
    rise = (beyond - before).subs({up: p - least for p, (least, up) in found.items()})
    return gently(simplify, rise)


def beside(expr: Expr, place: Expr, sense: int) -> Expr:
    """The value of `expr` next to a point, on its right (+1) or left (-1).

    This is the value at the point itself if there is one, otherwise the value of a simplified
    form, or the limit.
    """
    at_once = expr.subs(x, place)
    if not (at_once.has(nan, zoo, oo, AccumBounds) or any(p.base == 0 for p in at_once.atoms(Pow))):
        return at_once
    distance = Dummy("t", positive=True)
    near = gently(simplify, expr.subs(x, place + sense * distance))
    value = near.subs(distance, 0)
    return value if value.is_finite is not False and value is not nan else limit(near, distance, 0)


def vanishes(expr: Expr) -> bool:
    """Whether an expression is zero everywhere; one number usually shows that it is not."""
    symbols = sorted(expr.free_symbols, key=str)
    value = expr.xreplace({symbol: Rational(3 * i + 5, 7) for i, symbol in enumerate(symbols)})
    return bool(abs(value.evalf(30, maxn=100)) < 1e-15 and gently(simplify, expr) == 0)
