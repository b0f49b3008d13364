"""Read g(x): its pieces, the points where they meet, and the contribution of each kink.

In:  a SymPy expression of x and positive parameters, with any nesting of Abs, sign, Max, Min,
     Heaviside and Piecewise.
Out: a `Slope`: g'(x) as that of one reference piece plus a jump at each kink, its domain, and the
     conditions on the parameters under which the body is convex.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise

from sympy import (
    AccumBounds,
    Dummy,
    E,
    Expr,
    Function,
    Heaviside,
    Integer,
    Limit,
    NumberSymbol,
    Piecewise,
    Poly,
    Pow,
    Rational,
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
    exp,
    expand,
    fraction,
    limit,
    log,
    nan,
    oo,
    pi,
    roots,
    sign,
    simplify,
    sin,
    sinh,
    tan,
    tanh,
    together,
)
from sympy.logic.boolalg import Boolean

from derive.body.branches import BRANCHING, is_known_positive, is_positive, merged, resolved
from derive.body.convexity import convex_where, value_beside
from derive.body.piece import Piece, step, surpluses, with_surpluses
from derive.body.steep import gently
from derive.body.trial import REAL_AND_FINITE, typical
from derive.command.errors import BadProfile
from derive.symbols import x

_JUMPING = (sign, Heaviside, Piecewise)
"""Functions whose value at a branch point may differ from the values on both sides."""
_SMOOTH = (exp, log, sinh, cosh, tanh, asinh, atan)
_FIXED = (*BRANCHING, *_SMOOTH, sin, cos, tan, asin, acos, acosh, atanh, atan2)
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
        powers = {p for piece in self.pieces for p in piece.slope.atoms(Pow)}
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
        bounds = self._limit(first, low, 1, -oo), self._limit(last, high, -1, oo)
        rises = gently(simplify, bounds[1] - bounds[0]).is_extended_positive
        return bounds if rises else (-oo, oo)  # SymPy's limits of powers can be wrong

    def _limit(self, piece: Piece, end: Expr, sense: int, otherwise: Expr) -> Expr:
        """Limit of g' at an end, or `otherwise`, which is not a bound, if SymPy cannot find it."""
        slope = gently(simplify, with_surpluses(piece.slope, surpluses(self.demands)))
        found = value_beside(slope, end, sense)
        if found is None or found.atoms(Dummy) or found.has(Limit, AccumBounds):
            return otherwise
        return found


@lru_cache(maxsize=64)
def read_slope(name: str, g: Expr) -> Slope:
    """Read the profile of the body `name`.

    Raises BadProfile if g is not real, not continuous, not convex, or straight.
    """
    pieces = resolved(name, g, -oo, oo)
    _demand_no_point_apart(name, g, pieces)
    pieces = merged(pieces)
    _demand_known(name, pieces)
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


def _ends_beyond_origin(piece: Piece) -> bool:
    """Whether a piece is known to contain the origin or to end to the right of it.

    The first such piece contains the origin if the positions of the kinks are known.  Any other
    piece would also do.
    """
    return piece.upper == 0 or bool(is_known_positive(piece.upper))


def _demand_known(name: str, pieces: list[Piece]) -> None:
    """Refuse functions of x that are not supported, and what the proofs cannot compute.

    A polynomial is never integrated numerically, so that it may contain any number.
    """
    polynomial = all(piece.profile.is_polynomial(x) for piece in pieces)
    kinds = (Function,) if polynomial else (Function, NumberSymbol)
    found = set().union(*(piece.profile.atoms(*kinds) for piece in pieces)) - {pi, E}
    for held in sorted(found, key=str):
        if held.has(x) and not isinstance(held, _SMOOTH):
            known = ", ".join(f.__name__ for f in (*BRANCHING, *_SMOOTH))
            why = f"contains {held}, a function of x that is not supported"
            raise BadProfile(name, why, f"use only powers and {known}")
        if not held.has(x) and not isinstance(held, _FIXED):
            remedy = (
                "replace it with a parameter and pass its value in the call, or with its numerical "
                "value, such as Rational('0.577')"
            )
            why = f"contains {held}, which the proofs cannot compute"
            raise BadProfile(name, why, remedy)


def _demand_finite(name: str, pieces: list[Piece], domain: tuple[Expr, Expr]) -> None:
    """Refuse a pole or a logarithmic singularity, except at the ends of the domain."""
    for piece in pieces:
        for place in branch_points(piece.profile):
            for sense, end in ((1, piece.upper), (-1, piece.lower)):
                if not place.is_real or place in (end, *domain):
                    continue
                if lies_in(place, piece, domain, strictly=False) and _is_infinite(
                    piece.profile, place, sense
                ):
                    raise BadProfile(name, f"is infinite at x = {place}", REAL_AND_FINITE)


def _is_infinite(profile: Expr, place: Expr, sense: int) -> bool:
    """Whether a profile is known to be infinite next to a point."""
    value = profile.subs(x, place)
    found = value_beside(profile, place, sense) if value is nan else value
    return found is not None and found.is_finite is False


def lies_in(place: Expr, piece: Piece, domain: tuple[Expr, Expr], strictly: bool = True) -> bool:
    """Whether a point is known to lie in a piece and inside the domain; or at an end of it."""
    ends = ((piece.lower, 1), (domain[0], 1), (piece.upper, -1), (domain[1], -1))
    distances = (simplify(sense * (place - end)) for end, sense in ends if end.is_finite)
    return all(bool(d.is_positive if strictly else d.is_nonnegative) for d in distances)


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
        if jump == 0 and apart != 0 and apart.is_real and not apart.has(*BRANCHING):
            raise BadProfile(
                name,
                f"has the value {here} at x = {right.lower}, but {near[0]} next to it",
                "remove the condition that holds only at this point, because a profile must be "
                "continuous",
            )


def _domain(name: str, pieces: list[Piece]) -> tuple[Expr, Expr]:
    """The interval in which the outermost pieces are real, up to zeros of bases of powers."""
    low, high = -oo, oo
    for point in branch_points(pieces[0].profile):
        if point.is_real and is_positive(name, _reach(pieces[0], upper=True) - point):
            low = point if low == -oo or is_positive(name, point - low) else low
    for point in branch_points(pieces[-1].profile):
        if point.is_real and is_positive(name, point - _reach(pieces[-1], upper=False)):
            high = point if high == oo or is_positive(name, high - point) else high
    return low, high


def _reach(piece: Piece, upper: bool) -> Expr:
    """The inner end of an outermost piece; the origin if there is none."""
    end = piece.upper if upper else piece.lower
    return end if end.is_finite else Integer(0)


def branch_points(profile: Expr) -> list[Expr]:
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


def _is_natural(exponent: Expr) -> bool:
    return bool(exponent.is_Integer and exponent.is_nonnegative)
