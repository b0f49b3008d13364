"""Reads g(x): its pieces, where they meet, and what each kink adds.

In:  a SymPy expression of x and positive parameters, with Abs, sign, Max, Min, Heaviside and
     Piecewise in any nesting.
Out: a `Slope`: g'(x) as that of one reference piece plus a jump at each kink, its domain, and the
     conditions on parameters that make it convex.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from math import prod

from sympy import (
    Abs,
    AccumBounds,
    And,
    Dummy,
    E,
    Expr,
    Float,
    Function,
    Heaviside,
    Integer,
    Limit,
    Max,
    Min,
    Not,
    NumberSymbol,
    Or,
    Piecewise,
    Poly,
    Pow,
    Rational,
    S,
    Symbol,
    acos,
    acosh,
    asin,
    asinh,
    atan,
    atan2,
    atanh,
    cos,
    cosh,
    diff,
    exp,
    expand,
    factor,
    fraction,
    limit,
    log,
    nan,
    oo,
    pi,
    re,
    roots,
    sign,
    simplify,
    sin,
    sinh,
    tan,
    tanh,
    together,
)
from sympy.core.relational import Relational
from sympy.logic.boolalg import Boolean

from derive.convexity import REAL_AND_FINITE, convex_where, typical, value_beside
from derive.errors import BadProfile
from derive.piece import Piece, step, surpluses, with_surpluses
from derive.steep import gently
from derive.symbols import a, c, x

_BRANCHING = (Abs, sign, Max, Min, Heaviside, Piecewise)
_JUMPING = (sign, Heaviside, Piecewise)
"""Functions whose value at a branch point may differ from both sides."""
_SMOOTH = (exp, log, sinh, cosh, tanh, asinh, atan)
_FIXED = (*_BRANCHING, *_SMOOTH, sin, cos, tan, asin, acos, acosh, atanh, atan2)
"""Functions of parameters and numbers that proofs can compute to any number of digits."""


@dataclass(frozen=True)
class Kink:
    """A point where g' changes its formula.

    side = +1: `jump` is added to the slope for x > position, the kink lies right of the reference
    piece; side = -1: it is added for x < position.  `step` is by how much g' itself rises there.
    """

    number: int
    position: Expr
    side: int
    jump: Expr
    step: Expr

    @property
    def is_corner(self) -> bool:
        """Whether g' itself jumps here (an apex), not only a derivative of it."""
        return bool(self.step != 0)


@dataclass(frozen=True)
class Slope:
    """g'(x) = base + sum of the jumps of all kinks that x has passed, coming from the reference."""

    pieces: tuple[Piece, ...]
    base: Expr
    kinks: tuple[Kink, ...]
    domain: tuple[Expr, Expr] = (-oo, oo)
    demands: tuple[Boolean, ...] = ()

    @cached_property
    def is_polynomial(self) -> bool:
        """Whether g' is a polynomial on every piece: then every integral is elementary."""
        return all(piece.slope.is_polynomial(x) for piece in self.pieces)

    @cached_property
    def quadratics(self) -> tuple[Expr, ...]:
        """Quadratics in x whose square roots g' holds."""
        powers = {p for piece in self.pieces for p in exact(piece.slope).atoms(Pow)}
        found = {
            expand(p.base)
            for p in powers
            if (2 * p.exp).is_odd and p.base.is_polynomial(x) and Poly(p.base, x).degree() == 2
        }
        return tuple(sorted(found, key=str))

    @property
    def least(self) -> dict[Symbol, Expr]:
        """Lower bounds of parameters."""
        return {d.gts: d.lts for d in self.demands if d.lts.is_number}

    @cached_property
    def typical(self) -> dict[Symbol, Rational]:
        """Values of parameters that meet the conditions where 1 would not; above the bounds."""
        return typical(self.demands)

    @property
    def straight_pieces(self) -> tuple[Piece, ...]:
        """Pieces in which a contact would carry no load."""
        return tuple(piece for piece in self.pieces if piece.straight)

    @cached_property
    def limits(self) -> tuple[Expr, Expr]:
        """g' at both ends of the domain: the tilts -g' there bound those that the body can take."""
        if self.is_polynomial:
            return limit(self.pieces[0].slope, x, -oo), limit(self.pieces[-1].slope, x, oo)
        (low, high), (first, last) = self.domain, (self.pieces[0], self.pieces[-1])
        bounds = self._limit(first, low, "+", -oo), self._limit(last, high, "-", oo)
        rises = gently(simplify, bounds[1] - bounds[0]).is_extended_positive
        return bounds if rises else (-oo, oo)  # SymPy's limits of powers are not always right

    def _limit(self, piece: Piece, end: Expr, side: str, otherwise: Expr) -> Expr:
        """Limit of g' at an end; `otherwise`, which bounds nothing, if SymPy finds no limit."""
        try:
            slope = gently(simplify, with_surpluses(piece.slope, surpluses(self.demands)))
            found = limit(slope, x, end, side)
        except (NotImplementedError, ValueError, TypeError, RecursionError, AttributeError):
            return otherwise
        known = found in (oo, -oo) or not (found.atoms(Dummy) or found.has(Limit, AccumBounds))
        return found if known else otherwise


@lru_cache(maxsize=64)
def read_slope(name: str, g: Expr) -> Slope:
    """Read the profile of the body `name`.

    Raises BadProfile when g is not real, not continuous, not convex or straight.
    """
    pieces = _resolved(name, g, -oo, oo)
    _demand_no_point_apart(name, g, pieces)
    pieces = _merged(pieces)
    _demand_known_functions(name, pieces)
    _demand_known_numbers(name, pieces)
    domain = _domain(name, pieces)
    _demand_finite(name, pieces, domain)
    _demand_continuous(name, pieces)
    demands = convex_where(name, pieces, domain)
    reference = next(i for i, piece in enumerate(pieces) if _ends_beyond_origin(piece))
    kinks = [
        Kink(
            number=i,
            position=right.lower,
            side=1 if i > reference else -1,
            jump=expand((right.slope - left.slope) * (1 if i > reference else -1)),
            step=step(left, right, demands),
        )
        for i, (left, right) in enumerate(pairwise(pieces), start=1)
    ]
    return Slope(tuple(pieces), expand(pieces[reference].slope), tuple(kinks), domain, demands)


def _resolved(name: str, g: Expr, lower: Expr, upper: Expr) -> list[Piece]:
    """Split (lower, upper) at the switching points of the innermost branch of g, then again."""
    g = _with_moduli(g)
    inner = _innermost(g)
    if inner is None:
        g = expand(g)
        inner = _innermost(g)  # (x**2 cosh(x/b))**k becomes Abs(x)**(2 k) cosh(x/b)**k
    if inner is None:
        return [Piece(lower, upper, g)]
    points = [lower, *_between(name, _switching_points(name, inner), lower, upper), upper]
    pieces = []
    for left, right in pairwise(points):
        value = _branch(name, inner, left, right)
        pieces += _resolved(name, g.xreplace({inner: value}), left, right)
    return pieces


def _ends_beyond_origin(piece: Piece) -> bool:
    """Whether a piece is known to contain the origin or to end right of it, as the last one does.

    The first such piece holds the origin where the kinks' places tell; any other would serve.
    """
    return piece.upper == 0 or bool(_is_known_positive(piece.upper))


def _with_moduli(g: Expr) -> Expr:
    """g with roots of squares as moduli, since they hide kinks: sqrt(x**2 - 2 b x + b**2)."""
    powers = [p for p in g.atoms(Pow) if not p.exp.is_Integer and p.base.is_rational_function(x)]
    found = {p: _without_squares(p) for p in powers if p.base.has(x) and not p.exp.has(x)}
    return g.xreplace({power: value for power, value in found.items() if value != power})


def _without_squares(power: Pow) -> Expr:
    """(f^(2 n) r)^k, f and r quotients of polynomials, as |f|^(2 n k) r^k."""
    sides = [Poly(side, x).sqf_list() for side in fraction(together(power.base))]
    squares = [
        (abs(part.as_expr()), sense * (times - times % 2))
        for sense, (_, factors) in zip((1, -1), sides, strict=True)
        for part, times in factors
        if times > 1
    ]
    if not squares:
        return power
    rest = [
        constant * prod(part.as_expr() ** (times % 2) for part, times in factors)
        for constant, factors in sides
    ]
    moduli = prod(modulus ** (times * power.exp) for modulus, times in squares)
    return (rest[0] / rest[1]) ** power.exp * moduli


def _innermost(g: Expr) -> Expr | None:
    found = [node for node in g.atoms(*_BRANCHING) if node.has(x)]
    simple = [n for n in found if not any(n is not other and n.has(other) for other in found)]
    return min(simple, key=str, default=None)


def _arguments(node: Expr) -> list[Expr]:
    """Expressions at whose change of sign the branch of `node` changes."""
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
    """All real roots; an error if any of them is unknown."""
    found = roots(poly)
    remedy = "write each branch by Abs(x - b), Max(0, x - b) or conditions such as x < b"
    at_origin = sum(times for root, times in found.items() if root == 0)
    lowest = min(power for (power,), _ in poly.terms())
    if sum(found.values()) < poly.degree() or at_origin != lowest:  # 1e-30 is not taken for zero
        raise BadProfile(name, f"branches where {poly.as_expr()} changes sign", remedy)
    for root in found:
        if root.is_real is None:
            numerator, denominator = fraction(simplify(root))
            if numerator.is_real and denominator.is_real and not denominator.is_nonzero:
                why = f"branches at {simplify(root)}, where {denominator} may be zero"
                raise BadProfile(name, f"{why}, or of either sign", _order(denominator))
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
    found = _is_known_positive(difference)
    if found is None:
        difference = simplify(difference)
        raise BadProfile(
            name,
            f"has kinks whose order is open: the sign of {difference} depends on the parameters",
            _order(difference),
        )
    return found


def _is_known_positive(difference: Expr) -> bool | None:
    """Whether it is positive; None where that depends on the parameters."""
    difference = simplify(difference)
    if difference.is_extended_positive:
        return True
    if difference.is_extended_nonpositive:
        return False
    squares = _squares(difference)
    if squares is not None and squares.is_extended_nonzero:
        return bool(squares.is_extended_positive)
    return None


def _squares(difference: Expr) -> Expr | None:
    """p^2 - q^2 r with the sign of p + q sqrt(r), where one of both terms is known to be negative.

    None where there are more roots of sums, or unknown signs.
    """
    roots = [p for p in difference.atoms(Pow) if p.exp == S.Half and p.base.is_Add]
    if len(roots) != 1:
        return None
    inner = Dummy("r", positive=True)
    numerator, denominator = fraction(together(difference).xreplace({roots[0]: inner}))
    if denominator.has(inner) or not numerator.is_polynomial(inner):
        return None
    poly = Poly(numerator, inner)
    if poly.degree() != 1:
        return None
    outer, beside = poly.nth(1), poly.nth(0)
    if not denominator.is_positive or not (outer * beside).is_negative:
        return None
    return factor((beside**2 - outer**2 * roots[0].base) * (1 if beside.is_positive else -1))


def _order(difference: Expr) -> str:
    """How a user can say which of two places lies further right."""
    held = {symbol.name for symbol in difference.free_symbols}
    gap = next(word for word in ("gap", "excess", "further") if word not in held)
    for symbol in sorted(difference.free_symbols, key=str, reverse=True):
        rate = diff(difference, symbol)
        if rate.is_number:
            other = expand(symbol - difference / rate)
            return (
                f"say which is larger, by a positive parameter {gap} in place of one of them, such "
                f"as {symbol} = {other} + {gap}"
            )
    return f"write one of them as the other plus a positive parameter {gap}"


def _inside(lower: Expr, upper: Expr) -> Expr:
    if lower == -oo:
        return upper - 1 if upper != oo else Integer(0)
    return lower + 1 if upper == oo else (lower + upper) / 2


def _in_between(expr: Expr, lower: Expr, upper: Expr) -> Expr:
    """What has the sign of a polynomial between two places, where it has no root.

    Its leading coefficient far out, else its value in the middle: no length is compared with 1 m.
    """
    if not expr.has(x) or (lower == -oo and upper == oo):
        return simplify(expr.subs(x, 0))
    if lower.is_finite and upper.is_finite:
        return simplify(expr.subs(x, (lower + upper) / 2))
    return simplify(Poly(expr if upper == oo else expr.subs(x, -x), x).LC())


def _branch(name: str, node: Expr, lower: Expr, upper: Expr) -> Expr:
    """What `node` is between two places, as an expression without this branch."""

    def positive(expr: Expr) -> bool:
        value = _in_between(expr, lower, upper)
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
            value = _in_between(condition.lhs - condition.rhs, lower, upper)
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
    where = f"x = {_inside(lower, upper)}"
    raise BadProfile(
        name, f"is not defined near {where}", "end the Piecewise with (expression, True)"
    )


def _merged(pieces: list[Piece]) -> list[Piece]:
    merged = pieces[:1]
    for piece in pieces[1:]:
        last = merged[-1]
        if gently(simplify, piece.profile - last.profile) == 0:
            merged[-1] = Piece(last.lower, piece.upper, last.profile)
        else:
            merged.append(piece)
    return merged


def _demand_known_functions(name: str, pieces: list[Piece]) -> None:
    known = ", ".join(f.__name__ for f in (*_BRANCHING, *_SMOOTH))
    for piece in pieces:
        for held in sorted(piece.profile.atoms(Function), key=str):
            if held.has(x) and not isinstance(held, _SMOOTH):
                why = f"holds {held}, a function of x that cannot be derived with"
                raise BadProfile(name, why, f"write it with powers and {known}")
            if not held.has(x) and not isinstance(held, _FIXED):
                raise _not_computed(name, held)


def _demand_known_numbers(name: str, pieces: list[Piece]) -> None:
    """Refuse numbers such as EulerGamma in a profile that the proofs integrate."""
    if all(piece.profile.is_polynomial(x) for piece in pieces):
        return
    held = set().union(*(piece.profile.atoms(NumberSymbol) for piece in pieces)) - {pi, E}
    for number in sorted(held, key=str):
        raise _not_computed(name, number)


def _not_computed(name: str, held: Expr) -> BadProfile:
    """The error for what proofs cannot compute to any number of digits."""
    remedy = (
        "write a parameter in its place and give its value in the call, or the number itself, such "
        "as Rational('0.577')"
    )
    return BadProfile(name, f"holds {held}, which the proofs cannot compute", remedy)


def _demand_finite(name: str, pieces: list[Piece], domain: tuple[Expr, Expr]) -> None:
    """Refuse a pole or a logarithmic singularity anywhere but at the ends of the domain."""
    for piece in pieces:
        for place in _branch_points(piece.profile):
            for sense, end in ((1, piece.upper), (-1, piece.lower)):
                if place == end or not _is_held(place, piece, domain):
                    continue
                if _is_infinite(piece.profile, place, sense):
                    raise BadProfile(name, f"is infinite at x = {place}", REAL_AND_FINITE)


def _is_infinite(profile: Expr, place: Expr, sense: int) -> bool:
    """Whether a profile is known to be infinite beside a place."""
    value = profile.subs(x, place)
    found = value_beside(profile, place, sense) if value is nan else value
    return found is not None and found.is_finite is False


def _is_held(place: Expr, piece: Piece, domain: tuple[Expr, Expr]) -> bool:
    """Whether a place is known to lie in a piece or at its ends, and inside the domain."""
    (lower, upper), (low, high) = (piece.lower, piece.upper), domain
    if not place.is_real or place in domain:
        return False
    inward = [place - end for end in (lower, low)] + [end - place for end in (upper, high)]
    return all(distance == oo or bool(simplify(distance).is_nonnegative) for distance in inward)


def _demand_continuous(name: str, pieces: list[Piece]) -> None:
    for left, right in pairwise(pieces):
        step = gently(simplify, (right.profile - left.profile).subs(x, right.lower))
        if step is nan:
            raise BadProfile(name, f"has no value at x = {right.lower}", REAL_AND_FINITE)
        if step != 0:
            raise BadProfile(
                name,
                f"jumps by {step} at x = {right.lower}",
                "a profile is continuous: shift one piece so that both meet",
            )


def _demand_no_point_apart(name: str, g: Expr, pieces: list[Piece]) -> None:
    """Refuse a value at a single place, such as Piecewise((-b, Eq(x, 0)), (x**2/R, True))."""
    if not any(node.has(x) for node in g.atoms(*_JUMPING)):
        return
    for left, right in pairwise(pieces):
        here = g.subs(x, right.lower)
        near = [piece.profile.subs(x, right.lower) for piece in (left, right)]
        apart, jump = (gently(simplify, value - near[0]) for value in (here, near[1]))
        if jump == 0 and apart != 0 and apart.is_real and not apart.has(*_BRANCHING):
            raise BadProfile(
                name,
                f"has the value {here} at x = {right.lower} alone, {near[0]} beside it",
                "a profile is continuous: leave out the condition that holds at this place only",
            )


def _domain(name: str, pieces: list[Piece]) -> tuple[Expr, Expr]:
    """Where the outermost pieces stay real: up to the nearest root under a fractional power."""
    low, high = -oo, oo
    for point in _branch_points(pieces[0].profile):
        if point.is_real and _is_positive(name, _reach(pieces[0], upper=True) - point):
            low = point if low == -oo or _is_positive(name, point - low) else low
    for point in _branch_points(pieces[-1].profile):
        if point.is_real and _is_positive(name, point - _reach(pieces[-1], upper=False)):
            high = point if high == oo or _is_positive(name, high - point) else high
    return low, high


def _reach(piece: Piece, upper: bool) -> Expr:
    """The inner end of an outermost piece, the origin where it has none."""
    end = piece.upper if upper else piece.lower
    return end if end.is_finite else Integer(0)


def _branch_points(profile: Expr) -> list[Expr]:
    """Zeros, complex ones too, of what log takes and of bases whose power is no natural number."""
    bases = {p.base for p in profile.atoms(Pow) if p.base.has(x) and not _is_natural(p.exp)}
    bases |= {p.args[0] for p in profile.atoms(log) if p.args[0].has(x)}
    bases |= {1 + p.args[0] ** 2 for p in profile.atoms(atan) if p.args[0].has(x)}
    found: dict[Expr, None] = {}
    for base in sorted(bases, key=str):
        numerator = fraction(together(base))[0]
        if numerator.is_polynomial(x):
            found |= dict.fromkeys(simplify(root) for root in roots(Poly(numerator, x)))
    return list(found)


def has_sharp_power(expr: Expr, place: Symbol) -> bool:
    """Whether a power in it is infinite or not smooth at a place fixed by parameters alone.

    Roots that vanish at the edges of a contact contain a and c; they are no feature of the body.
    """
    powers = (p for p in expr.atoms(Pow) if p.base.has(place) and not p.base.has(a, c))
    return any(not p.exp.is_Integer and diff(p.base, place, 2) == 0 for p in powers)


def exact(expr: Expr) -> Expr:
    """`expr` with every float as its exact binary fraction."""
    return expr.xreplace({number: Rational(number) for number in expr.atoms(Float)})


def _is_natural(exponent: Expr) -> bool:
    return bool(exponent.is_Integer and exponent.is_nonnegative)


def breaks_of(slope: Slope) -> tuple[tuple[Expr, ...], tuple[Piece, ...]]:
    """Where quadrature must split the body, and the pieces between.

    Kinks, and the real parts of complex singularities; a smooth body is split at the origin.
    """
    pieces: list[Piece] = []
    for piece in slope.pieces:
        beside = {simplify(re(point)) for point in _branch_points(piece.profile)}
        inner = sorted((p for p in beside if lies_in(p, piece, slope.domain)), key=str)
        ends = [piece.lower, *inner[:1], piece.upper]
        pieces += [Piece(low, high, piece.profile) for low, high in pairwise(ends)]
    if len(pieces) == 1:
        (piece,) = pieces
        pieces = [Piece(-oo, Integer(0), piece.profile), Piece(Integer(0), oo, piece.profile)]
    return tuple(piece.upper for piece in pieces[:-1]), tuple(pieces)


def lies_in(point: Expr, piece: Piece, domain: tuple[Expr, Expr]) -> bool:
    """Whether a place is known to lie inside a piece and inside the domain, not at an end."""
    ends = ((piece.lower, 1), (domain[0], 1), (piece.upper, -1), (domain[1], -1))
    return all(
        end in (oo, -oo) or bool(simplify(sense * (point - end)).is_positive) for end, sense in ends
    )
