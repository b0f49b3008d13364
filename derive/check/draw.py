"""Choose the points at which a claim is evaluated: random, but the same on every machine.

All points satisfy the conditions of the claim.

    points    all variables of moderate size, or spread evenly over a declared range
    further   places where the claim may fail although it holds at these points: near ends of
              ranges, or over many decades; beside the zeros of a modulus, a logarithm, a root or
              the like, and beside numerical limits of integrals; and where such a thing, or a
              spike, is stationary
"""

import hashlib
import random
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from itertools import chain, islice, pairwise

import mpmath
from mpmath import mpf
from sympy import Expr, Integral, Symbol, exp
from sympy.functions.elementary.hyperbolic import HyperbolicFunction
from sympy.logic.boolalg import Boolean

from derive.check.claim import SCALE, Claim, Point, Range
from derive.check.intervals import ends, value_at
from derive.proof.balls import digits
from derive.proof.kinks import peaked, switches
from derive.proof.values import Undecided, program, zeros_between
from derive.sheet.notation import text_of

POINTS = 24
"""Number of points of moderate size at which both sides are compared."""
LEAST = 20
"""The same for claims with integrals; also the least number of points for any verdict."""
_TRIES = 300
"""Number of attempts to draw a point that meets the conditions of a claim."""
_EXTREME, _BESIDE, _STATIONARY = (48, 6), (36, 16), (24, 8)
"""Numbers of further points of each sort, and the same for claims with integrals."""
_CORNERS = 16
"""The largest number of corners, in which all variables are near ends of their ranges."""
_DECADES, _FEW_DECADES = 6, 2
"""The decades over which a variable without a range is spread; the same with integrals."""
_LOOKED_AT, _MOST_ZEROS = 10, 24
"""The largest number of expressions whose zeros are sought, and of zeros in one decade."""
_WORKING = 40
"""Digits with which zeros are found."""
_APART = 1e-9
"""Two zeros are different if they are this far apart, relative to their size."""

_FADED = 69
"""The exponential of minus this number is below the digits that two sides must share."""
_FAR = ((mpf(10) ** -30, mpf(10) ** -_DECADES), (mpf(10) ** _DECADES, mpf(10) ** 30))
"""Values below, at either end of, and above those of a variable without a range."""

# ------------------------------------------------------------------ variables and conditions


def _meanings(claim: Claim) -> list[Expr]:
    """Return the meanings of the symbols in both sides."""
    held = set().union(*(side.free_symbols for side in claim.meant.compared))
    return [claim.meant.meaning.get(symbol, symbol) for symbol in held]


def _integrals(claim: Claim) -> set[Integral]:
    exprs = (*claim.meant.compared, *_meanings(claim))
    return set().union(*(expr.atoms(Integral) for expr in exprs))


def has_integral(claim: Claim) -> bool:
    """Whether a side, or the meaning of one of its symbols, contains an integral."""
    return bool(_integrals(claim))


def variables(claim: Claim) -> list[Symbol]:
    """Return the variables that need a value at every point."""
    ranges = set(claim.meant.ranges)
    exprs = (*_meanings(claim), *claim.meant.conditions, *(claim.meant.toward or ()))
    bound = {limit[0] for over in _integrals(claim) for limit in over.limits}
    symbols = set().union(*(expr.free_symbols for expr in exprs)) - bound
    return sorted(ranges | symbols, key=in_order)


def ranges_of(claim: Claim) -> dict[Symbol, Range]:
    """Return the ranges of all variables."""
    return {symbol: claim.meant.ranges.get(symbol, SCALE) for symbol in variables(claim)}


def in_order(symbol: Symbol) -> tuple[str, str]:
    """Return a sort key that also distinguishes symbols with the same name."""
    return symbol.name, str(symbol.assumptions0)


def is_allowed(claim: Claim, point: Point) -> bool:
    """Whether a point meets the conditions of a claim."""
    return all(is_met(each, point) for each in claim.meant.conditions)


def is_met(condition: Boolean, point: Point) -> bool:
    """Whether a condition is true at a point, and not undefined there."""
    with digits(mpmath.mp.dps):
        try:
            return bool(program(condition)(point))
        except (KeyError, Undecided):
            return False


# ------------------------------------------------------------------ points


def points(claim: Claim, count: int = POINTS, seed: str = "") -> Iterator[Point]:
    """Yield the claim's own cases if it has any, or else points of moderate size."""
    if claim.meant.cases:
        yield from (
            {symbol: mpf(text) for symbol, text in case.items()} for case in claim.meant.cases
        )
        return
    drawn = _Drawn(claim, seed)
    if not drawn.symbols:
        yield {}
        return
    for _ in range(count if count < POINTS or not has_integral(claim) else LEAST):
        yield from drawn.allowed()


def further(claim: Claim, exprs: Sequence[Expr]) -> Iterator[Point]:
    """Yield points at which a claim may fail although it holds at points of moderate size."""
    drawn, few = _Drawn(claim, "further"), has_integral(claim)
    if claim.meant.cases or not drawn.symbols:
        return
    extreme, beside, stationary = (number[few] for number in (_EXTREME, _BESIDE, _STATIONARY))
    zero, level = set(drawn.past_limits(exprs)), list[Expr]()
    if not (few and claim.entry.family):
        found = {switch for expr in exprs for switch in switches(expr) if not switch.of.is_nonzero}
        zero |= {switch.of for switch in found}
        level += [switch.of for switch in found if switch.kind == "kink"]
        level += [inner for expr in exprs for inner in peaked(expr)]
    groups = (
        drawn.extreme(extreme, _FEW_DECADES if few else _DECADES),
        islice(drawn.beside(zero), beside),
        islice(drawn.stationary(level), stationary),
    )
    yield from (point for point in chain.from_iterable(groups) if is_allowed(claim, point))


def unseen(claim: Claim, exprs: Sequence[Expr], examined: Sequence[Point]) -> str:
    """Describe what the examined points do not show; empty if nothing was found.

    A switch, or the difference of an inequality, may have another sign beyond them all, and a
    function that fades may differ from its limit in no digit.
    """
    drawn = _Drawn(claim, "unseen")
    if claim.meant.cases or not drawn.symbols:
        return ""
    point = drawn.point()
    found = {each.of for side in exprs for each in switches(side)}
    found |= {exprs[0] - exprs[1]} if claim.meant.is_inequality else set()
    fading = {each.args[0] for side in exprs for each in side.atoms(exp, HyperbolicFunction)}
    with digits(_WORKING):
        for expr, variable in drawn.along(found):
            values = [value_at(expr, where) for where in examined]
            is_seen = any(value < 0 for value in values) and any(value > 0 for value in values)
            if variable in drawn.ranges or is_seen:
                continue
            for pair in _FAR:
                low, high = (value_at(expr, point | {variable: value}) for value in pair)
                if low * high < 0:
                    where = f"beyond the values of {variable} that are examined"
                    return f"{text_of(expr)} changes its sign {where}"
        for expr, _ in drawn.along(fading):
            if all(abs(value_at(expr, where)) > _FADED for where in examined):
                return f"an exponential of {text_of(expr)} has its limit at all examined points"
    return ""


class _Drawn:
    """Random points of one claim, some variables of which are moved."""

    def __init__(self, claim: Claim, seed: str) -> None:
        digest = hashlib.sha256(
            f"{claim.entry.family or claim.entry.label}{seed}".encode()
        ).digest()
        self.claim, self.rng = claim, random.Random(int.from_bytes(digest[:8], "big"))
        self.symbols = variables(claim)
        self.ranges = {s: claim.meant.ranges[s] for s in self.symbols if s in claim.meant.ranges}

    def point(self, moved: dict[Symbol, float] | None = None) -> Point:
        """Return a point of moderate size, with other values of some variables."""
        values = {s: _at(self.ranges.get(s, SCALE), self.rng.random()) for s in self.symbols}
        return {symbol: mpf(value) for symbol, value in (values | (moved or {})).items()}

    def allowed(self) -> Iterator[Point]:
        """Yield one point of moderate size that meets the conditions, if it is found."""
        tries = (self.point() for _ in range(_TRIES if self.claim.meant.conditions else 1))
        yield from islice((point for point in tries if is_allowed(self.claim, point)), 1)

    def extreme(self, count: int, decades: int) -> Iterator[Point]:
        """Yield points in corners, in which all variables are near ends of their ranges.

        In turn, they are close to a corner, or within a tenth of it, or variables without a range
        are spread over many decades instead.
        """
        full = 2 ** len(self.ranges) - 1
        corners = self.rng.sample(range(full + 1), min(full + 1, _CORNERS))
        corners = [*dict.fromkeys((full, 0, *corners))]
        free = [symbol for symbol in self.symbols if symbol not in self.ranges]
        for n in range(count):
            if n % 3 == 2 or not self.ranges:
                yield self.point({s: 10 ** self.rng.uniform(-decades, decades) for s in free})
                continue
            moved, corner = dict[Symbol, float](), corners[n // 3 % len(corners)]
            for k, (symbol, span) in enumerate(self.ranges.items()):
                share = 10 ** self.rng.uniform(-6, (-4, -1)[n % 3])
                moved[symbol] = _at(span, 1 - share if corner >> k & 1 else share)
            yield self.point(moved)

    def past_limits(self, exprs: Sequence[Expr]) -> Iterator[Expr]:
        """Yield what is zero where a variable of an integrand is at a numerical limit."""
        for over in set().union(*(expr.atoms(Integral) for expr in exprs)):
            held = over.function.free_symbols & set(self.symbols) - {over.limits[-1][0]}
            numbers = (n for n in over.limits[-1][1:] if n.is_real and n.is_number and n.is_finite)
            yield from (symbol - end for end in numbers if end for symbol in held)

    def beside(self, exprs: Iterable[Expr]) -> Iterator[Point]:
        """Yield points on either side of zeros along one variable, the closest zeros first.

        Each is nearer to its zero than to the next one, because a claim may be false in a very
        small range between the zeros of two switches.
        """
        lines, pairs = dict[Symbol, set[mpf]](), list[tuple[mpf, Symbol, mpf, mpf]]()
        for point in self.allowed():
            for expr, variable in self.along(exprs):
                lines.setdefault(variable, set()).update(self._zeros(expr, variable, point))
            for variable, places in lines.items():
                for one, other in pairwise(sorted({*self._ends(variable), *places})):
                    pairs += [(other - one, variable, one, other)] * (one in places)
                    pairs += [(other - one, variable, other, one)] * (other in places)
            for gap, variable, place, other in sorted(pairs, key=lambda pair: pair[0]):
                share = 10 ** self.rng.uniform(-3, -0.3)
                if gap <= _APART * abs(place):
                    continue
                if variable in self.ranges:
                    yield point | {variable: place + (other - place) * share}
                else:
                    yield point | {variable: place * (other / place) ** share}

    def stationary(self, exprs: Iterable[Expr]) -> Iterator[Point]:
        """Yield points where an expression is stationary.

        The variables are treated one after the other, and each keeps the value that was found.
        """
        reached = dict[Expr, Point]()
        for expr, variable in self.along(exprs):
            point = reached.setdefault(expr, self.point())
            if places := self._zeros(expr.diff(variable), variable, point):
                reached[expr] = point | {variable: places[len(places) // 2]}
                yield reached[expr]

    def along(self, exprs: Iterable[Expr]) -> Iterator[tuple[Expr, Symbol]]:
        """Yield the expressions in the variables, the shortest first, with each variable."""
        known = set(self.symbols)
        chosen = {each for each in exprs if each.free_symbols <= known and not each.has(Integral)}
        for expr in sorted(chosen, key=lambda each: (len(str(each)), str(each)))[:_LOOKED_AT]:
            yield from ((expr, variable) for variable in sorted(expr.free_symbols, key=in_order))

    def _ends(self, variable: Symbol) -> tuple[mpf, mpf]:
        low, high = ends(self.ranges.get(variable, SCALE))
        return mpf(low.numerator) / low.denominator, mpf(high.numerator) / high.denominator

    def _zeros(self, expr: Expr, variable: Symbol, point: Point) -> list[mpf]:
        """Return the zeros of an expression along a variable, over its whole range."""
        with mpmath.workdps(_WORKING):
            return zeros(expr, variable, point, *self._ends(variable))


def zeros(expr: Expr, variable: Symbol, point: Point, low: mpf, high: mpf) -> list[mpf]:
    """Return zeros of an expression along a variable to the working digits, in their order.

    Each decade is searched by itself: far out, a growing exponential has no certain sign.
    """
    cuts, found = [low], set[mpf]()
    while 0 < 10 * cuts[-1] < high:
        cuts.append(10 * cuts[-1])
    for one, other in pairwise([*cuts, high]):
        with digits(mpmath.mp.dps), suppress(Undecided, NameError):  # no value, as DiracDelta
            found.update(islice(zeros_between(expr, variable, point, one, other), _MOST_ZEROS))
    return sorted(zero for zero in found if low <= zero <= high)


def _at(span: Range, share: float) -> float:
    """Return the value at a fraction of a range."""
    value = span.low + share * (span.high - span.low)
    return float(2.0**value if span.powers else value)


# ------------------------------------------------------------------ in words


def spread(drawn: Sequence[Point]) -> str:
    """Return the ranges that the points cover, with variables of equal range grouped together."""
    names_by_span: dict[str, list[str]] = {}
    for symbol in sorted(set().union(*drawn) if drawn else set(), key=in_order):
        values = [point[symbol] for point in drawn if symbol in point]
        span = " to ".join(mpmath.nstr(end, 2) for end in (min(values), max(values)))
        names_by_span.setdefault(span, []).append(symbol.name)
    return "; ".join(f"{', '.join(names)} from {span}" for span, names in names_by_span.items())
