"""Reads g(x): which pieces it has, where they meet, and what is switched on there.

In:  a SymPy expression of x and positive parameters, with Abs, sign, Max, Min, Heaviside and
     Piecewise in any nesting.
Out: a `Slope`, g'(x) as the polynomial of one reference piece plus a polynomial jump at each kink.
"""

import random
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from sympy import (
    Abs,
    And,
    Expr,
    Heaviside,
    Integer,
    Max,
    Min,
    Not,
    Or,
    Piecewise,
    Poly,
    Rational,
    S,
    Symbol,
    cancel,
    diff,
    expand,
    limit,
    oo,
    roots,
    sign,
    simplify,
)
from sympy.core.relational import Relational
from sympy.logic.boolalg import Boolean

from derive.errors import BadProfile
from derive.symbols import x

_BRANCHING = (Abs, sign, Max, Min, Heaviside, Piecewise)
_SAMPLES = 8
"""Sets of parameters for which a body is tested for convexity."""


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

    @property
    def straight(self) -> bool:
        """Whether the piece is a straight line, on which nothing presses by itself."""
        return bool(simplify(diff(self.profile, x, 2)) == 0)


@dataclass(frozen=True)
class Kink:
    """A point where g' changes its polynomial.

    side = +1: `jump` is added to the slope for x > position, the kink lies right of the reference
    piece; side = -1: it is added for x < position.
    """

    number: int
    position: Expr
    side: int
    jump: Expr

    @property
    def is_corner(self) -> bool:
        """Whether g' itself jumps here (an apex), not only a derivative of it."""
        return bool(simplify(self.jump.subs(x, self.position)) != 0)


@dataclass(frozen=True)
class Slope:
    """g'(x) = base + sum of the jumps of all kinks that x has passed, coming from the reference."""

    pieces: tuple[Piece, ...]
    base: Expr
    kinks: tuple[Kink, ...]

    @property
    def straight_pieces(self) -> tuple[Piece, ...]:
        """Pieces in which a contact would carry no load."""
        return tuple(piece for piece in self.pieces if piece.straight)

    @cached_property
    def limits(self) -> tuple[Expr, Expr]:
        """g' at minus and plus infinity: the tilts -g' there bound what the body can take."""
        return limit(self.pieces[0].slope, x, -oo), limit(self.pieces[-1].slope, x, oo)


def read_slope(name: str, g: Expr) -> Slope:
    """Read the profile of the body `name`.

    Raises BadProfile when g is no polynomial on its pieces, not continuous, not convex or straight.
    """
    pieces = _merged(_resolved(name, g, -oo, oo))
    for piece in pieces:
        if not piece.slope.is_polynomial(x):
            raise BadProfile(
                name,
                f"has the piece {piece.profile}, whose slope is no polynomial in x",
                "write it with polynomials in x on pieces (Abs, Piecewise, Max, ...)",
            )
    _demand_continuous(name, pieces)
    _demand_convex(name, pieces)
    reference = next(
        i for i, piece in enumerate(pieces) if piece.upper == 0 or _is_positive(name, piece.upper)
    )
    kinks = [
        Kink(
            number=i,
            position=right.lower,
            side=1 if i > reference else -1,
            jump=expand((right.slope - left.slope) * (1 if i > reference else -1)),
        )
        for i, (left, right) in enumerate(pairwise(pieces), start=1)
    ]
    return Slope(tuple(pieces), expand(pieces[reference].slope), tuple(kinks))


def _resolved(name: str, g: Expr, lower: Expr, upper: Expr) -> list[Piece]:
    """Split (lower, upper) at the switching points of the innermost branch of g, then again."""
    inner = _innermost(g)
    if inner is None:
        return [Piece(lower, upper, expand(g))]
    points = [lower, *_between(name, _switching_points(name, inner), lower, upper), upper]
    pieces = []
    for left, right in pairwise(points):
        value = _branch(name, inner, _inside(left, right))
        pieces += _resolved(name, g.xreplace({inner: value}), left, right)
    return pieces


def _innermost(g: Expr) -> Expr | None:
    found = [node for node in g.atoms(*_BRANCHING) if node.has(x)]
    simple = [n for n in found if not any(n is not other and n.has(other) for other in found)]
    return min(simple, key=str, default=None)


def _arguments(node: Expr) -> list[Expr]:
    """Expressions whose change of sign changes the branch of `node`."""
    if isinstance(node, Max | Min):
        first, *rest = node.args
        return [first - second for second in rest] + [
            p - q for i, p in enumerate(rest) for q in rest[i + 1 :]
        ]
    if isinstance(node, Piecewise):
        relations = {r for _, condition in node.args for r in condition.atoms(Relational)}
        return [r.lhs - r.rhs for r in sorted(relations, key=str)]
    return [node.args[0]]


def _switching_points(name: str, node: Expr) -> list[Expr]:
    points: list[Expr] = []
    for argument in _arguments(node):
        if not argument.has(x):
            continue
        if not argument.is_polynomial(x):
            raise BadProfile(
                name,
                f"branches on {argument}, which is no polynomial in x",
                "write the places where it branches as polynomials, such as Abs(x) - b",
            )
        points += _roots(name, Poly(argument, x))
    return list(dict.fromkeys(points))


def _roots(name: str, poly: Poly) -> list[Expr]:
    """All real roots, every one of them known."""
    found = roots(poly)
    remedy = "write each branch by Abs(x - b), Max(0, x - b) or conditions such as x < b"
    if sum(found.values()) < poly.degree():
        raise BadProfile(name, f"branches where {poly.as_expr()} changes sign", remedy)
    for root in found:
        if root.is_real is None:
            raise BadProfile(
                name, f"branches at {simplify(root)}, which may be real or not", remedy
            )
    return [simplify(root) for root in found if root.is_real]


def _between(name: str, points: list[Expr], lower: Expr, upper: Expr) -> list[Expr]:
    inside: list[Expr] = []
    for point in points:
        left = lower == -oo or _is_positive(name, point - lower)
        right = upper == oo or _is_positive(name, upper - point)
        if left and right:
            place = next(
                (i for i, other in enumerate(inside) if _is_positive(name, other - point)),
                len(inside),
            )
            inside.insert(place, point)
    return inside


def _is_positive(name: str, difference: Expr) -> bool:
    difference = simplify(difference)
    if difference.is_extended_positive:
        return True
    if difference.is_extended_nonpositive:
        return False
    raise BadProfile(
        name,
        f"has kinks whose order is open: the sign of {difference} depends on the parameters",
        "write one place as the other plus a positive parameter, such as b2 = b1 + d",
    )


def _inside(lower: Expr, upper: Expr) -> Expr:
    if lower == -oo:
        return upper - 1 if upper != oo else Integer(0)
    return lower + 1 if upper == oo else (lower + upper) / 2


def _branch(name: str, node: Expr, at: Expr) -> Expr:
    """What `node` is in the interval around `at`, as an expression without this branch."""

    def positive(expr: Expr) -> bool:
        value = simplify(expr.subs(x, at))
        return value != 0 and _is_positive(name, value)

    def holds(condition: Boolean) -> bool:
        if condition in (S.true, S.false):
            return bool(condition)
        if isinstance(condition, And | Or | Not):
            values = [holds(arg) for arg in condition.args]
            if isinstance(condition, Not):
                return not values[0]
            return all(values) if isinstance(condition, And) else any(values)
        if isinstance(condition, Relational):
            value = simplify((condition.lhs - condition.rhs).subs(x, at))
            return (
                bool(condition.func(value, 0))
                if value == 0
                else bool(condition.func(1 if _is_positive(name, value) else -1, 0))
            )
        raise BadProfile(name, f"has the condition {condition}", "use <, <=, >, >= and, or, not")

    match node:
        case Abs():
            return node.args[0] if positive(node.args[0]) else -node.args[0]
        case sign():
            return Integer(1) if positive(node.args[0]) else Integer(-1)
        case Heaviside():
            return Integer(1) if positive(node.args[0]) else Integer(0)
        case Max() | Min():
            best = node.args[0]
            for other in node.args[1:]:
                if positive(other - best) == isinstance(node, Max):
                    best = other
            return best
    for value, condition in node.args:
        if holds(condition):
            return value
    raise BadProfile(
        name, f"is not defined near x = {at}", "end the Piecewise with (expression, True)"
    )


def _merged(pieces: list[Piece]) -> list[Piece]:
    merged = pieces[:1]
    for piece in pieces[1:]:
        last = merged[-1]
        if simplify(piece.profile - last.profile) == 0:
            merged[-1] = Piece(last.lower, piece.upper, last.profile)
        else:
            merged.append(piece)
    return merged


def _demand_continuous(name: str, pieces: list[Piece]) -> None:
    for left, right in pairwise(pieces):
        step = simplify((right.profile - left.profile).subs(x, right.lower))
        if step != 0:
            raise BadProfile(
                name,
                f"jumps by {step} at x = {right.lower}",
                "a profile is continuous: shift one piece so that both meet",
            )


def _demand_convex(name: str, pieces: list[Piece]) -> None:
    """Refuse a slope that falls anywhere, by its exact sign at many rational samples."""
    if all(piece.straight for piece in pieces) and len(pieces) == 1:
        raise BadProfile(name, "is straight", "a body must be convex somewhere, or nothing presses")
    symbols = sorted(set().union(*(p.profile.free_symbols for p in pieces)) - {x}, key=str)
    rng = random.Random(1)
    for _ in range(_SAMPLES):
        values = {p: Rational(rng.randint(10, 99), 10) ** rng.choice((1, -1)) for p in symbols}
        _demand_rising(name, [_at(piece, values) for piece in pieces], values)


def _at(piece: Piece, values: dict[Symbol, Rational]) -> Piece:
    return Piece(*(expr.subs(values) for expr in (piece.lower, piece.upper, piece.profile)))


def _demand_rising(name: str, pieces: list[Piece], values: dict[Symbol, Rational]) -> None:
    given = ", ".join(f"{k} = {v}" for k, v in values.items())
    remedy = f"the contact could break into several patches (seen with {given}); make it convex"
    for left, right in pairwise(pieces):
        if (right.slope - left.slope).subs(x, right.lower) < 0:
            raise BadProfile(name, f"is not convex: its slope falls at x = {right.lower}", remedy)
    for piece in pieces:
        curvature = Poly(diff(piece.profile, x, 2), x)
        lower = piece.lower if piece.lower != -oo else None
        upper = piece.upper if piece.upper != oo else None
        for at in _probes(curvature, lower, upper):
            if curvature.eval(at) < 0:
                raise BadProfile(
                    name,
                    f"is not convex: its curvature is negative near x = {float(at):.3g}",
                    remedy,
                )


def _probes(curvature: Poly, lower: Expr | None, upper: Expr | None) -> list[Rational]:
    """One point between every two neighbouring roots of the curvature, which decide its sign."""
    if curvature.is_ground:
        return [Integer(0)]
    marks = [end for interval, _ in curvature.intervals() for end in interval]
    marks = [r for r in marks if (lower is None or r > lower) and (upper is None or r < upper)]
    inner = [*([] if lower is None else [lower]), *marks, *([] if upper is None else [upper])]
    inner = inner or [Integer(0)]
    points = [inner[0] - 1, *inner] if lower is None else inner
    points = [*points, inner[-1] + 1] if upper is None else points
    return [cancel((p + q) / 2) for p, q in pairwise(points)]
