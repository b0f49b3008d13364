"""Read g(x): its pieces, the points where they meet, and the contribution of each kink.

In:  a SymPy expression of x and positive parameters, with any nesting of Abs, sign, Max, Min,
     Heaviside and Piecewise.
Out: a `Slope`: g'(x) as that of one reference piece plus a jump at each kink, its domain, and the
     conditions on the parameters under which the body is convex.
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

from derive.body.convexity import REAL_AND_FINITE, convex_where, typical, value_beside
from derive.body.piece import Piece, step, surpluses, with_surpluses
from derive.body.steep import gently
from derive.command.errors import BadProfile
from derive.symbols import a, c, x

_BRANCHING = (Abs, sign, Max, Min, Heaviside, Piecewise)
_JUMPING = (sign, Heaviside, Piecewise)
"""Functions whose value at a branch point may differ from the values on both sides."""
_SMOOTH = (exp, log, sinh, cosh, tanh, asinh, atan)
_FIXED = (*_BRANCHING, *_SMOOTH, sin, cos, tan, asin, acos, acosh, atanh, atan2)
"""Functions of parameters and numbers that the proofs can compute to any number of digits."""


@dataclass(frozen=True)
class Kink:
    """A point where the formula of g' changes.

    side = +1: `jump` is added to the slope for x > position; the kink lies to the right of the
    reference piece.  side = -1: `jump` is added for x < position.  `step` is the discontinuity of
    g' at the kink.
    """

    number: int
    position: Expr
    side: int
    jump: Expr
    step: Expr

    @property
    def is_corner(self) -> bool:
        """Whether g' itself jumps here (a corner), and not only one of its derivatives."""
        return bool(self.step != 0)


@dataclass(frozen=True)
class Slope:
    """g'(x) = base + the sum of the jumps at all kinks between the reference piece and x."""

    pieces: tuple[Piece, ...]
    base: Expr
    kinks: tuple[Kink, ...]
    domain: tuple[Expr, Expr] = (-oo, oo)
    demands: tuple[Boolean, ...] = ()

    @cached_property
    def is_polynomial(self) -> bool:
        """Whether g' is a polynomial on every piece, so that all integrals are elementary."""
        return all(piece.slope.is_polynomial(x) for piece in self.pieces)

    @cached_property
    def quadratics(self) -> tuple[Expr, ...]:
        """Quadratics in x whose square roots occur in g'."""
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
        """Typical values for parameters without a lower bound, used if the value 1 does not satisfy
        the conditions."""
        return typical(self.demands)

    @property
    def straight_pieces(self) -> tuple[Piece, ...]:
        """Pieces in which a contact would carry no load."""
        return tuple(piece for piece in self.pieces if piece.straight)

    @cached_property
    def limits(self) -> tuple[Expr, Expr]:
        """Limits of g' at both ends of the domain; all tilts lie between their negatives."""
        if self.is_polynomial:
            return limit(self.pieces[0].slope, x, -oo), limit(self.pieces[-1].slope, x, oo)
        (low, high), (first, last) = self.domain, (self.pieces[0], self.pieces[-1])
        bounds = self._limit(first, low, "+", -oo), self._limit(last, high, "-", oo)
        rises = gently(simplify, bounds[1] - bounds[0]).is_extended_positive
        return bounds if rises else (-oo, oo)  # SymPy's limits of powers can be wrong

    def _limit(self, piece: Piece, end: Expr, side: str, otherwise: Expr) -> Expr:
        """Limit of g' at an end, or `otherwise`, which is not a bound, if SymPy cannot find it."""
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

    Raises BadProfile if g is not real, not continuous, not convex, or straight.
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
    """Split (lower, upper) where the innermost branch of g switches, and repeat for each part."""
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
    """Whether a piece is known to contain the origin or to end to the right of it.

    The first such piece contains the origin if the positions of the kinks are known.  Any other
    piece would also do.
    """
    return piece.upper == 0 or bool(_is_known_positive(piece.upper))


def _with_moduli(g: Expr) -> Expr:
    """Write roots of squares, which hide kinks, as moduli: sqrt((x - b)**2) is Abs(x - b)."""
    powers = [p for p in g.atoms(Pow) if not p.exp.is_Integer and p.base.is_rational_function(x)]
    found = {p: _without_squares(p) for p in powers if p.base.has(x) and not p.exp.has(x)}
    return g.xreplace({power: value for power, value in found.items() if value != power})


def _without_squares(power: Pow) -> Expr:
    """Write (f^(2 n) r)^k as |f|^(2 n k) r^k, where f and r are quotients of polynomials."""
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
    """Expressions whose changes of sign switch the branch of `node`."""
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
                f"switches branches with {argument}, which is not a polynomial in x",
                "in conditions and in Abs, Max, Min, sign, Heaviside, use only polynomials in x, "
                "such as x - b",
            )
        points += _roots(name, Poly(argument, x))
    return list(dict.fromkeys(points))


def _roots(name: str, poly: Poly) -> list[Expr]:
    """All real roots; raises an error if any of them is not known."""
    found = roots(poly)
    remedy = "write each branch with Abs(x - b), Max(0, x - b) or a condition such as x < b"
    at_origin = sum(times for root, times in found.items() if root == 0)
    lowest = min(power for (power,), _ in poly.terms())
    if sum(found.values()) < poly.degree() or at_origin != lowest:  # roots near 1e-30 are not zero
        why = (
            f"switches branches where {poly.as_expr()} changes sign, but the x at which it does so "
            "cannot be found"
        )
        raise BadProfile(name, why, remedy)
    for root in found:
        if root.is_real is None:
            numerator, denominator = fraction(simplify(root))
            if numerator.is_real and denominator.is_real and not denominator.is_nonzero:
                why = f"the sign of {denominator} depends on the parameters"
                raise BadProfile(
                    name, f"has a kink at x = {simplify(root)}, but {why}", _order(denominator)
                )
            why = f"has a kink at x = {simplify(root)}, which is real only for some parameters"
            raise BadProfile(name, why, remedy)
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
            f"has kinks in an unknown order, as the sign of {difference} depends on the parameters",
            _order(difference),
        )
    return found


def _is_known_positive(difference: Expr) -> bool | None:
    """Whether a difference is positive; None if this depends on the parameters."""
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
    """+-(p^2 - q^2 r), which has the sign of p + q sqrt(r), if exactly one of the two terms is
    negative.

    None if there are several roots of sums, or if signs are not known.
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
    """The advice to a user who must fix the sign of a difference."""
    held = {symbol.name for symbol in difference.free_symbols}
    gap = next(word for word in ("gap", "excess", "further") if word not in held)
    for symbol in sorted(difference.free_symbols, key=str, reverse=True):
        rate = diff(difference, symbol)
        if rate.is_number:
            other = expand(symbol - difference / rate)
            return (
                f"fix this sign with a new positive parameter {gap}, for example by writing "
                f"{symbol} = {other} + {gap}"
            )
    return f"fix this sign by writing one term as another plus a new positive parameter {gap}"


def _inside(lower: Expr, upper: Expr) -> Expr:
    if lower == -oo:
        return upper - 1 if upper != oo else Integer(0)
    return lower + 1 if upper == oo else (lower + upper) / 2


def _in_between(expr: Expr, lower: Expr, upper: Expr) -> Expr:
    """A number with the sign that a polynomial without roots between two points has there.

    This is the leading coefficient if an end is infinite, otherwise the value in the middle.  No
    length is compared with 1 m.
    """
    if not expr.has(x) or (lower == -oo and upper == oo):
        return simplify(expr.subs(x, 0))
    if lower.is_finite and upper.is_finite:
        return simplify(expr.subs(x, (lower + upper) / 2))
    return simplify(Poly(expr if upper == oo else expr.subs(x, -x), x).LC())


def _branch(name: str, node: Expr, lower: Expr, upper: Expr) -> Expr:
    """The value of `node` between two points, as an expression without this branching function."""

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
        why = f"uses the condition {condition}, which is not supported"
        raise BadProfile(name, why, "use <, <=, > or >=, combined with and, or, not")

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
                why = f"contains {held}, a function of x that is not supported"
                raise BadProfile(name, why, f"use only powers and {known}")
            if not held.has(x) and not isinstance(held, _FIXED):
                raise _not_computed(name, held)


def _demand_known_numbers(name: str, pieces: list[Piece]) -> None:
    """Refuse numbers such as EulerGamma in a profile that the proofs must integrate."""
    if all(piece.profile.is_polynomial(x) for piece in pieces):
        return
    held = set().union(*(piece.profile.atoms(NumberSymbol) for piece in pieces)) - {pi, E}
    for number in sorted(held, key=str):
        raise _not_computed(name, number)


def _not_computed(name: str, held: Expr) -> BadProfile:
    """The error for an expression that the proofs cannot compute to any number of digits."""
    remedy = (
        "replace it with a parameter and pass its value in the call, or with its numerical value, "
        "such as Rational('0.577')"
    )
    return BadProfile(name, f"contains {held}, which the proofs cannot compute", remedy)


def _demand_finite(name: str, pieces: list[Piece], domain: tuple[Expr, Expr]) -> None:
    """Refuse a pole or a logarithmic singularity, except at the ends of the domain."""
    for piece in pieces:
        for place in _branch_points(piece.profile):
            for sense, end in ((1, piece.upper), (-1, piece.lower)):
                if place == end or not _is_held(place, piece, domain):
                    continue
                if _is_infinite(piece.profile, place, sense):
                    raise BadProfile(name, f"is infinite at x = {place}", REAL_AND_FINITE)


def _is_infinite(profile: Expr, place: Expr, sense: int) -> bool:
    """Whether a profile is known to be infinite next to a point."""
    value = profile.subs(x, place)
    found = value_beside(profile, place, sense) if value is nan else value
    return found is not None and found.is_finite is False


def _is_held(place: Expr, piece: Piece, domain: tuple[Expr, Expr]) -> bool:
    """Whether a point is known to lie in a piece or at its ends, and inside the domain."""
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
                "shift one piece so that both meet, because a profile must be continuous",
            )


def _demand_no_point_apart(name: str, g: Expr, pieces: list[Piece]) -> None:
    """Refuse a value at a single point, such as Piecewise((-b, Eq(x, 0)), (x**2/R, True))."""
    if not any(node.has(x) for node in g.atoms(*_JUMPING)):
        return
    for left, right in pairwise(pieces):
        here = g.subs(x, right.lower)
        near = [piece.profile.subs(x, right.lower) for piece in (left, right)]
        apart, jump = (gently(simplify, value - near[0]) for value in (here, near[1]))
        if jump == 0 and apart != 0 and apart.is_real and not apart.has(*_BRANCHING):
            raise BadProfile(
                name,
                f"has the value {here} at x = {right.lower}, but {near[0]} next to it",
                "remove the condition that holds only at this point, because a profile must be "
                "continuous",
            )


def _domain(name: str, pieces: list[Piece]) -> tuple[Expr, Expr]:
    """The interval in which the outermost pieces are real, up to zeros of bases of powers."""
    low, high = -oo, oo
    for point in _branch_points(pieces[0].profile):
        if point.is_real and _is_positive(name, _reach(pieces[0], upper=True) - point):
            low = point if low == -oo or _is_positive(name, point - low) else low
    for point in _branch_points(pieces[-1].profile):
        if point.is_real and _is_positive(name, point - _reach(pieces[-1], upper=False)):
            high = point if high == oo or _is_positive(name, high - point) else high
    return low, high


def _reach(piece: Piece, upper: bool) -> Expr:
    """The inner end of an outermost piece; the origin if there is none."""
    end = piece.upper if upper else piece.lower
    return end if end.is_finite else Integer(0)


def _branch_points(profile: Expr) -> list[Expr]:
    """Real and complex zeros of the arguments of log, of 1 + z**2 for atan(z), and of the bases of
    powers whose exponent is not a natural number."""
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
    """Whether a power in `expr` is infinite or not smooth at a point fixed by parameters alone.

    Roots that vanish at the edges of a contact contain a and c; they are not features of the body.
    """
    powers = (p for p in expr.atoms(Pow) if p.base.has(place) and not p.base.has(a, c))
    return any(not p.exp.is_Integer and diff(p.base, place, 2) == 0 for p in powers)


def exact(expr: Expr) -> Expr:
    """`expr` with every float replaced by its exact binary fraction."""
    return expr.xreplace({number: Rational(number) for number in expr.atoms(Float)})


def _is_natural(exponent: Expr) -> bool:
    return bool(exponent.is_Integer and exponent.is_nonnegative)


def breaks_of(slope: Slope) -> tuple[tuple[Expr, ...], tuple[Piece, ...]]:
    """Points where quadrature must split the body, and the pieces between them.

    These are the kinks and the real parts of complex singularities.  A smooth body is split at the
    origin.
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
    """Whether a point is known to lie strictly inside a piece and inside the domain."""
    ends = ((piece.lower, 1), (domain[0], 1), (piece.upper, -1), (domain[1], -1))
    return all(
        end in (oo, -oo) or bool(simplify(sense * (point - end)).is_positive) for end, sense in ends
    )
