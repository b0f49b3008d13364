"""Conditions on the parameters under which a body is convex: g'' >= 0 everywhere.

In:  the pieces of g(x), and the interval in which they are real.
Out: conditions on the parameters; BadProfile if no conditions are found that make the body convex.

A polynomial curvature is transformed to t >= 0.  There the least value of A t^n + B t^m + C t^k
follows from the weighted means of its outer terms, and that of a cubic from its discriminant.  The
conditions are then tested with numbers (trial.py), as is any other curvature.
"""

from collections.abc import Iterator
from itertools import pairwise
from math import gcd

from sympy import (
    Dummy,
    Expr,
    Ge,
    Gt,
    Integer,
    Mul,
    Poly,
    Pow,
    Symbol,
    cancel,
    diff,
    discriminant,
    expand,
    factor,
    limit,
    oo,
    root,
    simplify,
)
from sympy.core.relational import Relational
from sympy.logic.boolalg import Boolean

from derive.body.piece import Piece, beside, step
from derive.body.steep import gently
from derive.body.trial import Trial
from derive.command.errors import BadProfile
from derive.command.limit import LimitReached, within
from derive.symbols import x

_PATIENCE = 2.0
"""Seconds allowed for the limit of a curvature at infinity, or of a profile next to a point."""

Terms = dict[int, Expr]
"""Nonzero coefficients of a polynomial, by power."""


def convex_where(name: str, pieces: list[Piece], domain: tuple[Expr, Expr]) -> tuple[Boolean, ...]:
    """Conditions on the parameters under which the body is convex.

    Raises BadProfile.
    """
    if all(piece.straight for piece in pieces) and len(pieces) == 1:
        raise BadProfile(name, "is straight", "make it convex somewhere, such as x**2/(2*R)")
    found, doubtful = _demands(pieces)
    trial = Trial(name, pieces, domain, doubtful)
    first = trial.failure(found)
    if first is None:
        return found
    more = tuple(dict.fromkeys([*found, *_at_ends(doubtful)]))
    if more != found and trial.failure(more) is None:
        return more
    raise first


def _demands(pieces: list[Piece]) -> tuple[tuple[Boolean, ...], list[Piece]]:
    """Conditions, and the pieces that may still not be convex when the conditions are met.

    The jump of g' at a corner, and the factors of a curvature that do not contain x, must be
    positive.  Otherwise the body is convex for no parameter values, or only for some, such as
    k > 1 for Abs(x)**k.  If such a power is one of several terms, or is multiplied by a function,
    its coefficient at the root of the power decides.
    """
    found: dict[Boolean, None] = {}
    doubtful: list[Piece] = []
    for piece in pieces:
        if piece.curvature.is_polynomial(x):
            known = _of_polynomial(piece.curvature, piece.lower, piece.upper)
            if known is None:
                doubtful.append(piece)
            found |= dict.fromkeys(known or ())
            continue
        doubtful += [piece] if piece.curvature.is_nonnegative is None else []
        for expr in (piece.curvature, *_leading(piece)):
            found |= dict.fromkeys(_positive_factors(expr))
    for left, right in pairwise(pieces):
        found |= dict.fromkeys(_positive(step(left, right, tuple(found))) or ())
    return tuple(found), doubtful


def _positive_factors(expr: Expr) -> Iterator[Boolean]:
    """Conditions that factors without x, whose sign is unknown, be positive."""
    for part in Mul.make_args(_factored(expr)):
        if part.free_symbols and not part.has(x) and part.is_extended_nonnegative is None:
            yield _above(part)


def _leading(piece: Piece) -> Iterator[Expr]:
    """Coefficients in g'' of (x - r)^(k - 2), where k contains a parameter, at the root r."""
    curvature = expand(piece.curvature)
    for power in sorted(curvature.atoms(Pow), key=str):
        if power.exp.free_symbols and power.base.has(x) and not diff(power.base, x).has(x):
            place = x - power.base / diff(power.base, x)
            before = gently(simplify, curvature.coeff(power) * (x - place) ** 2).subs(x, place)
            if before.is_finite:
                yield before


def _factored(expr: Expr) -> Expr:
    """Factor `expr`; an expression that is not a quotient of polynomials is simplified first."""
    return gently(factor, expr if expr.is_rational_function() else gently(simplify, expr))


# ------------------------------------------------------------------ signs of expressions without x


def _open(expr: Expr) -> Expr | None:
    """The factor that decides the sign of an expression without x.

    It is 1 if the expression is never negative, and None if it is never positive.
    """
    decides, negative = Integer(1), False
    for part in Mul.make_args(_factored(expr)):
        if part.is_extended_nonnegative or (part.is_Pow and part.exp.is_even):
            continue
        if part.is_extended_nonpositive:
            negative = not negative
        else:
            decides *= part.base if part.is_Pow and part.exp.is_odd else part
    if negative:
        return None if decides == 1 else -decides
    return decides


def _positive(expr: Expr, relation: type[Relational] = Gt) -> list[Boolean] | None:
    """Conditions that make an expression without x positive; None if nothing does."""
    decides = _open(expr)
    if decides is None:
        return None
    return [_above(decides, relation)] if decides.free_symbols else []


def _above(expr: Expr, relation: type[Relational] = Gt) -> Boolean:
    """The relation expr > 0, solved, if possible, for a symbol in which `expr` rises linearly."""
    for symbol in sorted(expr.free_symbols, key=str):
        rate = diff(expr, symbol)
        if rate.is_number and rate.is_positive:
            return relation(symbol, expand(symbol - expr / rate))
    return relation(expr, 0)


# ------------------------------------------------------------------ polynomials


def _of_polynomial(curvature: Expr, lower: Expr, upper: Expr) -> list[Boolean] | None:
    """Conditions that make a polynomial nonnegative between two points; None if none are found.

    Even powers never change sign, and of odd ones the base decides.  Factors that do not change
    sign between the points are removed first.
    """
    rest, constant = list[Expr](), Integer(1)
    for part in Mul.make_args(_factored(curvature)):
        base, power = part.as_base_exp() if part.has(x) else (part, Integer(1))
        if not part.has(x):
            constant *= part
        elif not power.is_even:
            rest.append(base)
    for part in [*rest]:
        for signed, turned in ((part, 1), (-part, -1)):
            if part in rest and _between(signed, lower, upper) == []:
                rest.remove(part)
                constant *= turned
    return _between(Mul(constant, *rest), lower, upper) if rest else _positive(constant)


def _between(expr: Expr, lower: Expr, upper: Expr) -> list[Boolean] | None:
    """Conditions that make a polynomial nonnegative between two points, transformed to t >= 0."""
    t = Dummy("t", positive=True)
    if lower != -oo and upper != oo:
        degree = Poly(expr, x).degree()
        inside = cancel(expr.subs(x, (lower + upper * t) / (1 + t)) * (1 + t) ** degree)
        return _at_least_zero(_terms(inside, t))
    if lower != -oo:
        return _at_least_zero(_terms(expr.subs(x, lower + t), t))
    if upper != oo:
        return _at_least_zero(_terms(expr.subs(x, upper - t), t))
    poly = Poly(expr, x)
    mean = -poly.nth(poly.degree() - 1) / (poly.degree() * poly.LC())  # of the roots
    moved = expr.subs(x, x + mean)
    right, left = _between(moved, Integer(0), oo), _between(moved, -oo, Integer(0))
    return None if right is None or left is None else list(dict.fromkeys([*right, *left]))


def _terms(expr: Expr, t: Symbol) -> Terms:
    """Factored coefficients, by power."""
    found = {n: _factored(value) for (n,), value in Poly(expand(expr), t).terms()}
    return {n: value for n, value in found.items() if value != 0}


def _at_least_zero(terms: Terms) -> list[Boolean] | None:
    """Conditions that make a polynomial nonnegative for all t >= 0; None if none are found."""
    if not terms:
        return []
    signs = {n: _open(value) for n, value in terms.items()}
    ends, inner = {max(terms), min(terms)}, [n for n in terms if n not in (max(terms), min(terms))]
    if any(signs[n] is None for n in ends):
        return None
    doubtful = [n for n in inner if signs[n] is None or signs[n] != 1]
    if not doubtful:
        found = [_positive(terms[n], Ge) or [] for n in sorted(ends, reverse=True)]
        return list(dict.fromkeys(demand for each in found for demand in each))
    if any(signs[n] != 1 for n in ends):
        return None
    if len(terms) == 3:
        return _means(terms, signs[doubtful[0]] is None)
    if max(terms) - min(terms) == 3 and any(signs[n] is None for n in doubtful):
        t = Dummy("t", positive=True)
        cubic = sum(value * t ** (n - min(terms)) for n, value in terms.items())
        return _positive(-discriminant(cubic, t), Ge)
    return None


def _means(terms: Terms, negative: bool) -> list[Boolean] | None:
    """Conditions for A t^n + B t^m + C t^k >= 0 with A, C > 0.

    B must be at least minus the weighted mean of the others.  With u = (m - k)/(n - k) and
    v = 1 - u, the least value is zero for B = -(A/u)^u (C/v)^v.  If B is known to be negative, both
    sides are raised to a power that removes the roots.
    """
    n, m, k = sorted(terms, reverse=True)
    outer, inner = m - k, n - m
    common = gcd(outer, inner)
    outer, inner = outer // common, inner // common
    whole = outer + inner
    mean = (terms[n] * whole / outer) ** outer * (terms[k] * whole / inner) ** inner
    if negative:
        return _positive(mean - (-terms[m]) ** whole, Ge)
    return [Ge(terms[m] + root(simplify(mean), whole), 0)]


# ------------------------------------------------------------------ at single points


def _at_ends(pieces: list[Piece]) -> Iterator[Boolean]:
    """Conditions that the curvature be nonnegative at the ends of pieces, and at the origin."""
    for piece in pieces:
        places = [(piece.lower, 1), (piece.upper, -1)]
        if piece.lower.is_extended_negative and piece.upper.is_extended_positive:
            places.append((Integer(0), 1))
        for place, sense in places:
            value = value_beside(piece.curvature, place, sense)
            if value is not None and value.is_real and value.free_symbols:
                yield from _positive(value, Ge) or ()


def value_beside(expr: Expr, place: Expr, sense: int) -> Expr | None:
    """Value next to a point, on its right (+1) or left (-1); None if it is not found in time."""
    try:
        with within(_PATIENCE):
            found = limit(expr, x, place) if place in (oo, -oo) else None
            return beside(expr, place, sense) if found is None else found
    except (LimitReached, RuntimeError, ValueError, TypeError, AttributeError):
        return None
