"""Conditions on the parameters under which a body is convex: g'' >= 0 everywhere.

In:  the pieces of g(x), and the interval in which they are real.
Out: conditions on the parameters; BadProfile if no conditions are found that make the body convex.

A polynomial curvature is transformed to t >= 0.  There the least value of A t^n + B t^m + C t^k
follows from the weighted means of its outer terms, and that of a cubic from its discriminant.  Any
other curvature is evaluated at many points, for parameters whose ratios span twelve decades, and
the body is refused if the curvature is negative at any of them.
"""

import random
from collections.abc import Callable, Iterator
from itertools import chain, islice, pairwise, product
from math import gcd, prod

import mpmath
from mpmath import mpf
from sympy import (
    Dummy,
    Expr,
    Ge,
    Gt,
    Integer,
    Mul,
    Poly,
    Pow,
    Rational,
    Symbol,
    cancel,
    diff,
    discriminant,
    expand,
    factor,
    limit,
    nan,
    oo,
    root,
    simplify,
)
from sympy.core.relational import Relational
from sympy.logic.boolalg import Boolean

from derive.body.compiled import compiled
from derive.body.lows import Lows
from derive.body.piece import Piece, beside, step
from derive.body.steep import gently
from derive.command.errors import BadProfile
from derive.command.limit import LimitReached, within
from derive.symbols import x

_SAMPLES = 8
"""Number of parameter sets of similar size for which a body is tested."""
_WIDE = 48
"""Number of widely differing parameter sets used if no proof is found."""
_LEAST, _MOST = Rational(1, 1000), Integer(1000)
"""Smallest and largest value of those parameters."""
_DIGITS = 30
"""Digits to which a curvature is computed; three times as many where it seems to be negative."""
_ENOUGH = 10
"""If this many of 40 sets around typical parameters meet the conditions, no more are needed."""
_PATIENCE = 2.0
"""Seconds allowed for the limit of a curvature at infinity, or of a profile next to a point."""

REAL_AND_FINITE = (
    "g(x) must be real and finite on both sides of x = 0, and wherever else contact can occur; "
    "write it without this singularity, for example with Abs(x) instead of x, or shift it along x, "
    "for example with x + b instead of x, so that the singularity lies outside the contact"
)
"""Remedy for a profile that is not real and finite."""

Values = dict[Symbol, Rational]
Terms = dict[int, Expr]
"""Nonzero coefficients of a polynomial, by power."""


def convex_where(name: str, pieces: list[Piece], domain: tuple[Expr, Expr]) -> tuple[Boolean, ...]:
    """Conditions on the parameters under which the body is convex.

    Raises BadProfile.
    """
    if all(piece.straight for piece in pieces) and len(pieces) == 1:
        raise BadProfile(name, "is straight", "make it convex somewhere, such as x**2/(2*R)")
    found, doubtful = _demands(pieces)
    trial = _Trial(name, pieces, domain, doubtful)
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
            if before.is_finite and not before.has(nan):
                yield before


def _factored(expr: Expr) -> Expr:
    """Factor `expr`; an expression that is not a quotient of polynomials is simplified first."""
    return gently(factor, expr if expr.is_rational_function() else gently(simplify, expr))


# ------------------------------------------------------------------ signs of expressions without x


def _open(expr: Expr, sure: bool = True) -> Expr | None:
    """The factor that decides the sign of an expression without x.

    It is 1 if the expression is never negative, and None if it is never positive.

    sure: examine further any factor whose sign SymPy does not know.
    """
    decides, negative = Integer(1), False
    for part in Mul.make_args(_factored(expr)):
        if part.is_extended_nonnegative or (part.is_Pow and part.exp.is_even):
            continue
        if part.is_extended_nonpositive:
            negative = not negative
        elif not (sure and _is_sum_of_means(part)):
            decides *= part.base if part.is_Pow and part.exp.is_odd else part
    if negative:
        return None if decides == 1 else -decides
    return decides


def _is_sum_of_means(expr: Expr) -> bool:
    """Whether a polynomial of positive parameters is never negative, such as p^2 - p q + q^2."""
    for symbol in sorted(expr.free_symbols, key=str):
        if expr.is_polynomial(symbol) and Poly(expr, symbol).degree() > 1:
            return _at_least_zero(_terms(expr, symbol), sure=False) == []
    return False


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

    Factors that do not change sign between the points are removed first.
    """
    rest: list[Expr] = []
    constant = Integer(1)
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
    if not rest:
        return _positive(constant)
    if len(rest) > 1:
        return None
    return _between(constant * rest[0], lower, upper)


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
    return _everywhere(expr, t)


def _everywhere(expr: Expr, t: Symbol) -> list[Boolean] | None:
    """The same on the whole axis, split at the mean of the roots, or at the origin."""
    poly = Poly(expr, x)
    if poly.degree() % 2:
        return None
    for middle in (-poly.nth(poly.degree() - 1) / (poly.degree() * poly.LC()), Integer(0)):
        right, left = (_at_least_zero(_terms(expr.subs(x, middle + s * t), t)) for s in (1, -1))
        if right is not None and left is not None:
            return list(dict.fromkeys([*right, *left]))
    return None


def _terms(expr: Expr, t: Symbol) -> Terms:
    """Factored coefficients, by power."""
    found = {n: _factored(value) for (n,), value in Poly(expand(expr), t).terms()}
    return {n: value for n, value in found.items() if value != 0}


def _at_least_zero(terms: Terms, sure: bool = True) -> list[Boolean] | None:
    """Conditions that make a polynomial nonnegative for all t >= 0; None if none are found."""
    if not terms:
        return []
    signs = {n: _open(value, sure) for n, value in terms.items()}
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
    if len(doubtful) == 1 and signs[doubtful[0]] is None:
        middle = doubtful[0]
        for high, low in product(terms, repeat=2):
            if high > middle > low and signs[high] == signs[low] == 1:
                part = {n: terms[n] for n in (high, middle, low)}
                if _means(part, True) == []:
                    return []
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
    except (LimitReached, NotImplementedError, ValueError, TypeError, AttributeError):
        return None


# ------------------------------------------------------------------ typical parameters


def typical(demands: tuple[Boolean, ...]) -> Values:
    """Typical parameters that meet the conditions; empty if all parameters can equal one.

    The search covers powers of two farther and farther from one.
    """
    least = {d.gts: d.lts for d in demands if d.lts.is_number and d.gts.is_Symbol}
    symbols = sorted(set().union(*(d.free_symbols for d in demands)) - {*least}, key=str)
    rng = random.Random(3)

    def drawn(around: Values, spread: int) -> Values:
        return {p: v * Rational(2) ** rng.randint(-spread, spread) for p, v in around.items()}

    def met(values: Values) -> bool:
        given = {p: 1 + value for p, value in least.items()} | values
        return all(bool(demand.subs(given)) for demand in demands)

    def rank(values: Values) -> tuple[int, int]:
        """How many of 40 similar sets meet the conditions, up to a limit; then nearness to one."""
        near = sum(met(drawn(values, 1)) for _ in range(40))
        return min(near, _ENOUGH), -max(map(_size, values.values()))

    ones = dict.fromkeys(symbols, Integer(1))
    if not symbols or rank(ones)[0] == _ENOUGH:
        return {}
    found = (drawn(ones, spread) for spread in (2, 4, 8, 12) for _ in range(50))
    return max(filter(met, found), key=rank, default={})


def _size(power: Rational) -> int:
    """The magnitude of the exponent of a power of two."""
    return int(abs(power.p.bit_length() - power.q.bit_length()))


# ------------------------------------------------------------------ refusals


class _Fault(Exception):
    """A point where a body is not convex, or not real, for certain parameters."""

    def __init__(self, how: str, values: Values, real: bool = True) -> None:
        super().__init__(how)
        self.how, self.real = how, real
        self.given = ", ".join(f"{symbol} = {value}" for symbol, value in values.items())

    def always(self, name: str) -> BadProfile:
        """The error for a body that was not found to be convex for any parameters."""
        if not self.real:
            return BadProfile(name, self.how, REAL_AND_FINITE)
        remedy = "make g(x) convex, since the contact could otherwise split into several patches"
        return BadProfile(name, f"is not convex, because {self.how} for {self.given}", remedy)

    def sometimes(self, name: str) -> BadProfile:
        """The error for a body that was found to be convex for other parameters."""
        how = self.how if self.real else f"it {self.how}"
        why = f"is convex only for some values of its parameters, because {how} for {self.given}"
        remedy = (
            "no checkable condition on the parameters was found; make g(x) convex for all "
            "parameters, for example by replacing some with numbers or multiples of one length"
        )
        return BadProfile(name, why, remedy)


class _Trial:
    """The test of a body with many sets of parameters.

    doubtful: pieces that are also tested with widely differing parameters.
    """

    def __init__(
        self, name: str, pieces: list[Piece], domain: tuple[Expr, Expr], doubtful: list[Piece]
    ) -> None:
        self.name, self.pieces, self.doubtful = name, pieces, doubtful
        held = set().union(*(piece.profile.free_symbols for piece in pieces)) - {x}
        self.symbols = sorted(held, key=str)
        self._curvatures = {
            piece: _Curvature(piece, domain, self.symbols)
            for piece in pieces
            if not piece.curvature.is_polynomial(x)
        }

    def failure(self, demands: tuple[Boolean, ...]) -> BadProfile | None:
        """The error for a body that is not convex for all parameters that meet the conditions."""
        fault, passed = None, False
        for values, pieces in self._sets(demands):
            try:
                self._try(values, pieces)
                passed = True
            except _Fault as found:
                fault = fault or found
            if fault and passed:
                return fault.sometimes(self.name)
        if fault:
            return fault.always(self.name)
        if passed:
            return None
        needed = " and ".join(map(str, demands))
        return BadProfile(
            self.name,
            f"is convex only if {needed}, and no parameters were found that meet this condition",
            "make it convex for all parameter values, or for all values above a given number",
        )

    def _sets(self, demands: tuple[Boolean, ...]) -> Iterator[tuple[Values, list[Piece]]]:
        """Parameters that meet the conditions, and the pieces to be tested with them."""
        near = _meeting(demands, _samples(self.symbols), _SAMPLES)
        far = _meeting(demands, _far_apart(self.symbols, self._exponents), _WIDE)
        none_near = True
        for values in near:
            none_near = False
            yield values, self.pieces
        if none_near:
            yield from ((values, self.pieces) for values in islice(far, _SAMPLES))
        if self.doubtful and len(self.symbols) > 1:  # a single parameter is only a scale
            yield from ((values, self.doubtful) for values in far)

    @property
    def _exponents(self) -> set[Symbol]:
        powers = {p for piece in self.pieces for p in piece.profile.atoms(Pow)}
        return set().union(*(power.exp.free_symbols for power in powers))

    def _try(self, values: Values, pieces: list[Piece]) -> None:
        """Refuse a slope that decreases anywhere; the sign of polynomials is determined exactly."""
        if pieces is self.pieces:
            _demand_steps(pieces, values)
        for piece in pieces:
            if piece in self._curvatures:
                self._curvatures[piece].demand(values)
            else:
                _demand_rising(piece, values)


def _samples(symbols: list[Symbol]) -> Iterator[Values]:
    rng = random.Random(1)
    while True:
        yield {p: Rational(rng.randint(10, 99), 10) ** rng.choice((1, -1)) for p in symbols}


def _far_apart(symbols: list[Symbol], exponents: set[Symbol]) -> Iterator[Values]:
    """Random corners of the parameter space, then points between; exponents stay moderate."""
    rng = random.Random(2)
    few = [(_LEAST, Integer(1), _MOST) if p not in exponents else (Integer(2),) for p in symbols]
    corners = list(islice(product(*few), 3**6))
    rng.shuffle(corners)
    yield from (dict(zip(symbols, corner, strict=True)) for corner in corners[: _WIDE // 2])
    while True:
        yield {
            p: Rational(rng.randint(10, 99), 10)
            * (1 if p in exponents else Integer(10) ** rng.randint(-3, 2))
            for p in symbols
        }


def _meeting(demands: tuple[Boolean, ...], sets: Iterator[Values], count: int) -> Iterator[Values]:
    """Up to `count` sets that meet all conditions, from a limited number of candidates."""
    met = (v for v in islice(sets, 40 * count) if all(bool(d.subs(v)) for d in demands))
    return islice(met, count)


def _negative_at(place: Expr) -> str:
    return f"its curvature is negative near x = {float(place):.3g}"


def _demand_steps(pieces: list[Piece], values: Values) -> None:
    for left, right in pairwise(_at(piece, values) for piece in pieces):
        rise = right.slope - left.slope
        rise = rise.subs(x, right.lower) if rise.is_polynomial(x) else step(left, right)
        if not rise.is_extended_real or rise < 0:
            raise _Fault(f"its slope decreases at x = {right.lower}", values)


def _at(piece: Piece, values: Values) -> Piece:
    return Piece(*(expr.subs(values) for expr in (piece.lower, piece.upper, piece.profile)))


def _demand_rising(piece: Piece, values: Values) -> None:
    """Refuse a polynomial that is negative anywhere in the piece."""
    curvature = Poly(piece.curvature.subs(values), x)
    lower, upper = _ends(piece, values)
    odd = [_in_fractions(base) for base, power in curvature.sqf_list()[1] if power % 2]
    changing = prod(odd, start=Poly(_fraction(curvature.LC()), x))
    place = _inside(lower, upper)
    if odd and _roots_between(changing, lower, upper):
        raise _Fault(_negative_at(_least_between(changing, lower, upper)), values)
    if changing.eval(place) < 0:
        raise _Fault(_negative_at(place), values)


def _ends(piece: Piece, values: Values) -> tuple[Expr, Expr]:
    """Both ends as fractions; an irrational end is moved inward by a negligible amount."""

    def moved(end: Expr, inward: int) -> Expr:
        end = end.subs(values)
        if end.is_infinite or end.is_Rational:
            return end
        return _fraction(end) + inward * abs(Rational(str(end.evalf(5)))) / 10**40

    return moved(piece.lower, 1), moved(piece.upper, -1)


def _in_fractions(poly: Poly) -> Poly:
    """A polynomial with simple roots, made monic, with coefficients to more digits than needed.

    SymPy isolates roots only for fractional coefficients, and fails for sqrt(2) or for pi and E.
    """
    return Poly([_fraction(value) for value in poly.monic().all_coeffs()], x)


def _fraction(number: Expr) -> Rational:
    """The number itself if it is rational, otherwise its first 60 digits."""
    return number if number.is_Rational else Rational(str(number.evalf(60)))


def _inside(lower: Expr, upper: Expr) -> Rational:
    """A point between two ends, which may be infinite."""
    if lower == -oo:
        return upper - 1 if upper != oo else Integer(0)
    return lower + 1 if upper == oo else (lower + upper) / 2


def _roots_between(poly: Poly, lower: Expr, upper: Expr) -> int:
    """Number of roots of a polynomial with simple roots between two points, without these."""
    ends = [end for end in (lower, upper) if end.is_finite and poly.eval(end) == 0]
    low, high = (end if end.is_finite else None for end in (lower, upper))
    return int(poly.count_roots(low, high)) - len(ends)


def _least_between(poly: Poly, lower: Expr, upper: Expr) -> Rational:
    """Of one point in each interval between roots and ends, the one with the least value."""
    found = poly.intervals(eps=Rational(1, 10**9))
    roots = [(low + high) / 2 for (low, high), _ in found]
    marks = [end for end in (lower, *roots, upper) if lower <= end <= upper and end.is_finite]
    places = [_inside(p, q) for p, q in pairwise([-oo, *marks, oo])]
    return min((place for place in places if lower < place < upper), key=poly.eval)


class _Curvature:
    """A curvature that is not a polynomial, and its profile, compiled once for all parameters."""

    def __init__(self, piece: Piece, domain: tuple[Expr, Expr], symbols: list[Symbol]) -> None:
        self._at, self._profile = (
            compiled([x, *symbols], expr, modules="mpmath")
            for expr in (piece.curvature, piece.profile)
        )
        ends = [piece.lower, piece.upper, *domain]
        self._ends = compiled(symbols, ends, modules="mpmath")
        self._lows = None if piece.curvature.is_nonnegative else Lows(piece.curvature, symbols)

    def demand(self, values: Values) -> None:
        """Refuse a curvature that is negative, or not real, at any of many points.

        The profile must be real too: log(x) is not real for x < 0, but its curvature is.
        """
        with mpmath.workdps(_DIGITS):
            for place in chain(self._places(values), self._suspects(values)):
                value = self._value(self._at, place, values)
                if any(map(mpmath.im, (value, self._value(self._profile, place, values)))):
                    raise _Fault(f"is not real near x = {float(place):.3g}", values, real=False)
                if mpmath.re(value) < 0 and self._is_sure(place, value, values):
                    raise _Fault(_negative_at(place), values)

    def _value(self, function: Callable[..., mpf], place: mpf, values: Values) -> mpf:
        """The curvature or the profile; zero where it is undefined."""
        try:
            return function(place, *_numbers(values))
        except (ZeroDivisionError, OverflowError):
            return mpf(0)

    def _is_sure(self, place: mpf, value: mpf, values: Values) -> bool:
        """Whether the sign of a value is certain and not the result of cancellation."""
        with mpmath.workdps(3 * _DIGITS):
            again = self._value(self._at, place, values)
            return bool(abs(again - value) < abs(again) / 1000)

    def _places(self, values: Values) -> Iterator[mpf]:
        """Points in the piece and the domain, close to its ends and far from them."""
        given = _numbers(values)
        lower, upper, *domain = map(mpf, self._ends(*given))
        least = min([*given, mpf(1)]) / 1000
        steps = 3 * int(mpmath.log10(max([*given, mpf(1)]) * 1000 / least)) + 1
        for distance in (least * mpf(10) ** (mpf(k) / 3) for k in range(steps)):
            if mpmath.isinf(lower) and mpmath.isinf(upper):
                found = [-distance, distance]
            else:
                found = [lower + distance] if mpmath.isfinite(lower) else []
                found += [upper - distance] if mpmath.isfinite(upper) else []
            for place in found:
                if lower < place < upper and domain[0] < place < domain[1]:
                    yield place

    def _suspects(self, values: Values) -> Iterator[mpf]:
        """Points in the piece and the domain where the curvature may be negative or undefined."""
        if self._lows is None:
            return
        given = _numbers(values)
        lower, upper, first, last = map(mpf, self._ends(*given))
        lower, upper = max(lower, first), min(upper, last)
        found = self._lows.places([*map(float, given)], float(lower), float(upper))
        yield from (place for place in map(mpf, found) if lower < place < upper)


def _numbers(values: Values) -> list[mpf]:
    return [mpf(value.p) / value.q for value in values.values()]
