"""Where a body is convex: what its parameters must meet, so that g'' >= 0 all over it.

In:  the pieces of g(x), and where they are real.
Out: demands on the parameters; BadProfile for a body that no demand found makes convex.

A polynomial curvature is carried to t >= 0, where the least value of A t^n + B t^m + C t^k follows
from the weighted means of its outer terms, and that of a cubic from its discriminant.  What has no
such form is tried at many places, for parameters whose ratios span twelve decades, and refused if
it fails at any.
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

from derive.compiled import compiled
from derive.errors import BadProfile
from derive.limit import LimitReached, within
from derive.lows import Lows
from derive.piece import Piece, beside, step
from derive.steep import gently
from derive.symbols import x

_SAMPLES = 8
"""Sets of parameters of like size for which a body is tested."""
_WIDE = 48
"""Sets of parameters far apart for which it is tested where no proof is found."""
_LEAST, _MOST = Rational(1, 1000), Integer(1000)
"""What those parameters lie between."""
_DIGITS = 30
"""Of a curvature at a place; three times as many where it seems to be negative."""
_ENOUGH = 10
"""Of 40 sets around typical parameters, how many meet the demands."""
_PATIENCE = 2.0
"""Seconds for the limit of a curvature at infinity, or of a profile beside a place."""

REAL_AND_FINITE = (
    "g(x) must be real and finite on both sides of x = 0, and wherever else it can touch: shift it "
    "along x, as by x + b in the place of x, or write it with Abs(x)"
)
"""What is to be done where it is not."""

Values = dict[Symbol, Rational]
Terms = dict[int, Expr]
"""Coefficients of a polynomial that are not zero, by power."""


def convex_where(name: str, pieces: list[Piece], domain: tuple[Expr, Expr]) -> tuple[Boolean, ...]:
    """What the parameters must meet, that the body be convex.

    Raises BadProfile.
    """
    if all(piece.straight for piece in pieces) and len(pieces) == 1:
        raise BadProfile(name, "is straight", "a body must be convex somewhere, or nothing presses")
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
    """Demands, and the pieces of which it is open whether they are convex where these are met.

    A corner's jump and the factors of a curvature that do not hold x are positive, or the body is
    convex for no or for some parameters only, such as k > 1 for Abs(x)**k.  Where such a power is
    one term of several, or multiplied by a function, what stands before it at its root decides.
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
    """Factors without x whose sign is open, each to be positive."""
    for part in Mul.make_args(_factored(expr)):
        if part.free_symbols and not part.has(x) and part.is_extended_nonnegative is None:
            yield _above(part)


def _leading(piece: Piece) -> Iterator[Expr]:
    """What stands in g'' before (x - r)^(k - 2), k a parameter, at the root r."""
    curvature = expand(piece.curvature)
    for power in sorted(curvature.atoms(Pow), key=str):
        if power.exp.free_symbols and power.base.has(x) and not diff(power.base, x).has(x):
            place = x - power.base / diff(power.base, x)
            before = gently(simplify, curvature.coeff(power) * (x - place) ** 2).subs(x, place)
            if before.is_finite and not before.has(nan):
                yield before


def _factored(expr: Expr) -> Expr:
    """`expr` in factors; what is no quotient of polynomials is simplified before."""
    return gently(factor, expr if expr.is_rational_function() else gently(simplify, expr))


# ------------------------------------------------------------------ signs of what holds no x


def _open(expr: Expr, sure: bool = True) -> Expr | None:
    """What decides the sign of an expression without x: 1 if it is never negative, None if always.

    sure: look further where SymPy does not know the sign of a factor.
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
    """Whether a polynomial of positive parameters is never negative, as p^2 - p q + q^2."""
    for symbol in sorted(expr.free_symbols, key=str):
        if expr.is_polynomial(symbol) and Poly(expr, symbol).degree() > 1:
            return _at_least_zero(_terms(expr, symbol), sure=False) == []
    return False


def _positive(expr: Expr, relation: type[Relational] = Gt) -> list[Boolean] | None:
    """What makes an expression without x positive; None if nothing does."""
    decides = _open(expr)
    if decides is None:
        return None
    return [_above(decides, relation)] if decides.free_symbols else []


def _above(expr: Expr, relation: type[Relational] = Gt) -> Boolean:
    """expr > 0, with a symbol alone on its side if it has one."""
    for symbol in sorted(expr.free_symbols, key=str):
        rate = diff(expr, symbol)
        if rate.is_number and rate.is_positive:
            return relation(symbol, expand(symbol - expr / rate))
    return relation(expr, 0)


# ------------------------------------------------------------------ polynomials


def _of_polynomial(curvature: Expr, lower: Expr, upper: Expr) -> list[Boolean] | None:
    """What makes a polynomial at least zero between two places; None if that is not found.

    Factors that are nowhere negative there, or nowhere positive, are set aside first.
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
    """What makes a polynomial at least zero between two places, carried to t >= 0."""
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
    """The same on the whole axis, on both sides of the roots' mean, or of the origin."""
    poly = Poly(expr, x)
    if poly.degree() % 2:
        return None
    for middle in (-poly.nth(poly.degree() - 1) / (poly.degree() * poly.LC()), Integer(0)):
        right, left = (_at_least_zero(_terms(expr.subs(x, middle + s * t), t)) for s in (1, -1))
        if right is not None and left is not None:
            return list(dict.fromkeys([*right, *left]))
    return None


def _terms(expr: Expr, t: Symbol) -> Terms:
    """Coefficients in factors, by power."""
    found = {n: _factored(value) for (n,), value in Poly(expand(expr), t).terms()}
    return {n: value for n, value in found.items() if value != 0}


def _at_least_zero(terms: Terms, sure: bool = True) -> list[Boolean] | None:
    """What makes a polynomial at least zero for all t >= 0; None if that is not found."""
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
    """A t^n + B t^m + C t^k with A, C > 0: B is at least minus the weighted mean of the others.

    With u = (m - k)/(n - k) and v = 1 - u its least value is zero at
    B = -(A/u)^u (C/v)^v, which is raised to a power without roots where B is known to be negative.
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


# ------------------------------------------------------------------ at places


def _at_ends(pieces: list[Piece]) -> Iterator[Boolean]:
    """That the curvature be at least zero at the ends of pieces, and at the origin inside one."""
    for piece in pieces:
        places = [(piece.lower, 1), (piece.upper, -1)]
        if piece.lower.is_extended_negative and piece.upper.is_extended_positive:
            places.append((Integer(0), 1))
        for place, sense in places:
            value = value_beside(piece.curvature, place, sense)
            if value is not None and value.is_real and value.free_symbols:
                yield from _positive(value, Ge) or ()


def value_beside(expr: Expr, place: Expr, sense: int) -> Expr | None:
    """An expression next to a place, on its right (+1) or left (-1); None if not found in time."""
    try:
        with within(_PATIENCE):
            found = limit(expr, x, place) if place in (oo, -oo) else None
            return beside(expr, place, sense) if found is None else found
    except (LimitReached, NotImplementedError, ValueError, TypeError, AttributeError):
        return None


# ------------------------------------------------------------------ typical parameters


def typical(demands: tuple[Boolean, ...]) -> Values:
    """Parameters around which the demands are met; those that may be one are left out.

    Searched among powers of two, further and further apart.
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
        """How many of 40 sets of like size meet the demands, up to enough; nearness to one."""
        near = sum(met(drawn(values, 1)) for _ in range(40))
        return min(near, _ENOUGH), -max(map(_size, values.values()))

    ones = dict.fromkeys(symbols, Integer(1))
    if not symbols or rank(ones)[0] == _ENOUGH:
        return {}
    found = (drawn(ones, spread) for spread in (2, 4, 8, 12) for _ in range(50))
    return max(filter(met, found), key=rank, default={})


def _size(power: Rational) -> int:
    """How far a power of two is from one."""
    return int(abs(power.p.bit_length() - power.q.bit_length()))


# ------------------------------------------------------------------ refusals


class _Fault(Exception):
    """A place where a body is not convex, or not real, for some parameters."""

    def __init__(self, how: str, values: Values, real: bool = True) -> None:
        super().__init__(how)
        self.how, self.real = how, real
        self.given = ", ".join(f"{symbol} = {value}" for symbol, value in values.items())

    def always(self, name: str) -> BadProfile:
        """The refusal of a body that was found convex for no parameters."""
        if not self.real:
            return BadProfile(name, self.how, REAL_AND_FINITE)
        remedy = f"the contact could break into several patches (seen with {self.given})"
        return BadProfile(name, f"is not convex: {self.how}", f"{remedy}; make it convex")

    def sometimes(self, name: str) -> BadProfile:
        """The refusal of a body that was found convex for other parameters."""
        how = self.how if self.real else f"it {self.how}"
        why = f"is convex only for some values of its parameters: {how} with {self.given}"
        remedy = (
            "no condition on them was found that could be checked; make it convex for all of them, "
            "as by numbers, or multiples of one length, in their place"
        )
        return BadProfile(name, why, remedy)


class _Trial:
    """A body tried at many sets of parameters.

    doubtful: pieces that are tried for parameters far apart, too.
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
        """Why the body is not convex for all parameters that meet the demands."""
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
            f"is convex only if {needed}, which no parameters were found to meet",
            "make it convex for all parameters, or for all above a number",
        )

    def _sets(self, demands: tuple[Boolean, ...]) -> Iterator[tuple[Values, list[Piece]]]:
        """Parameters that meet the demands, and the pieces to be tried with them."""
        near = _meeting(demands, _samples(self.symbols), _SAMPLES)
        far = _meeting(demands, _far_apart(self.symbols, self._exponents), _WIDE)
        none_near = True
        for values in near:
            none_near = False
            yield values, self.pieces
        if none_near:
            yield from ((values, self.pieces) for values in islice(far, _SAMPLES))
        if self.doubtful and len(self.symbols) > 1:  # one parameter alone is but a scale
            yield from ((values, self.doubtful) for values in far)

    @property
    def _exponents(self) -> set[Symbol]:
        powers = {p for piece in self.pieces for p in piece.profile.atoms(Pow)}
        return set().union(*(power.exp.free_symbols for power in powers))

    def _try(self, values: Values, pieces: list[Piece]) -> None:
        """Refuse a slope that falls anywhere: polynomials by their exact sign."""
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
    """The corners first, in an order by chance, then anything between; exponents stay moderate."""
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
    """So many sets that meet all demands, out of not too many."""
    met = (v for v in islice(sets, 40 * count) if all(bool(d.subs(v)) for d in demands))
    return islice(met, count)


def _negative_at(place: Expr) -> str:
    return f"its curvature is negative near x = {float(place):.3g}"


def _demand_steps(pieces: list[Piece], values: Values) -> None:
    for left, right in pairwise(_at(piece, values) for piece in pieces):
        rise = right.slope - left.slope
        rise = rise.subs(x, right.lower) if rise.is_polynomial(x) else step(left, right)
        if not rise.is_extended_real or rise < 0:
            raise _Fault(f"its slope falls at x = {right.lower}", values)


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
    """Both ends as fractions; one that is none is moved inward by less than could matter."""

    def moved(end: Expr, inward: int) -> Expr:
        end = end.subs(values)
        if end.is_infinite or end.is_Rational:
            return end
        return _fraction(end) + inward * abs(Rational(str(end.evalf(5)))) / 10**40

    return moved(piece.lower, 1), moved(piece.upper, -1)


def _in_fractions(poly: Poly) -> Poly:
    """A polynomial with simple roots, and 1 before its highest power, to more digits than matter.

    SymPy isolates roots between fractions alone, and not where sqrt(2) or pi and E are held.
    """
    return Poly([_fraction(value) for value in poly.monic().all_coeffs()], x)


def _fraction(number: Expr) -> Rational:
    """A number as it is, or 60 digits of one that is no quotient of whole numbers."""
    return number if number.is_Rational else Rational(str(number.evalf(60)))


def _inside(lower: Expr, upper: Expr) -> Rational:
    """A place between two ends, which may be infinite."""
    if lower == -oo:
        return upper - 1 if upper != oo else Integer(0)
    return lower + 1 if upper == oo else (lower + upper) / 2


def _roots_between(poly: Poly, lower: Expr, upper: Expr) -> int:
    """How many roots a polynomial without double ones has between two places, these left out."""
    ends = [end for end in (lower, upper) if end.is_finite and poly.eval(end) == 0]
    low, high = (end if end.is_finite else None for end in (lower, upper))
    return int(poly.count_roots(low, high)) - len(ends)


def _least_between(poly: Poly, lower: Expr, upper: Expr) -> Rational:
    """Where a polynomial is least, of one place between each two of its roots and the ends."""
    found = poly.intervals(eps=Rational(1, 10**9))
    roots = [(low + high) / 2 for (low, high), _ in found]
    marks = [end for end in (lower, *roots, upper) if lower <= end <= upper and end.is_finite]
    places = [_inside(p, q) for p, q in pairwise([-oo, *marks, oo])]
    return min((place for place in places if lower < place < upper), key=poly.eval)


class _Curvature:
    """A curvature that is no polynomial, and its profile, compiled once for all parameters."""

    def __init__(self, piece: Piece, domain: tuple[Expr, Expr], symbols: list[Symbol]) -> None:
        self._at, self._profile = (
            compiled([x, *symbols], expr, modules="mpmath")
            for expr in (piece.curvature, piece.profile)
        )
        ends = [piece.lower, piece.upper, *domain]
        self._ends = compiled(symbols, ends, modules="mpmath")
        self._lows = None if piece.curvature.is_nonnegative else Lows(piece.curvature, symbols)

    def demand(self, values: Values) -> None:
        """Refuse a curvature that is negative or not real at any of many places.

        log(x) is not real for x < 0, though its curvature is.
        """
        with mpmath.workdps(_DIGITS):
            for place in chain(self._places(values), self._suspects(values)):
                value = self._value(self._at, place, values)
                if any(map(mpmath.im, (value, self._value(self._profile, place, values)))):
                    raise _Fault(f"is not real near x = {float(place):.3g}", values, real=False)
                if mpmath.re(value) < 0 and self._is_sure(place, value, values):
                    raise _Fault(_negative_at(place), values)

    def _value(self, function: Callable[..., mpf], place: mpf, values: Values) -> mpf:
        """The curvature or the profile; zero where it has no value."""
        try:
            return function(place, *_numbers(values))
        except (ZeroDivisionError, OverflowError):
            return mpf(0)

    def _is_sure(self, place: mpf, value: mpf, values: Values) -> bool:
        """Whether a value is more than what rounding leaves of differences."""
        with mpmath.workdps(3 * _DIGITS):
            again = self._value(self._at, place, values)
            return bool(abs(again - value) < abs(again) / 1000)

    def _places(self, values: Values) -> Iterator[mpf]:
        """Places in the piece and the domain, near to its ends and far from them."""
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
        """Places in the piece and the domain where it seems to be negative, or to have no value."""
        if self._lows is None:
            return
        given = _numbers(values)
        lower, upper, first, last = map(mpf, self._ends(*given))
        lower, upper = max(lower, first), min(upper, last)
        found = self._lows.places([*map(float, given)], float(lower), float(upper))
        yield from (place for place in map(mpf, found) if lower < place < upper)


def _numbers(values: Values) -> list[mpf]:
    return [mpf(value.p) / value.q for value in values.values()]
