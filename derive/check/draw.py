"""Choose the points at which a claim is evaluated: random, but the same on every machine.

All points satisfy the conditions of the claim.  Each of them is a point of moderate size, of which
some variables are then moved to a place where the claim may fail:

    points    nowhere: variables of moderate size, or spread evenly over a declared range
    further   over many decades; near the ends of ranges; past a numerical limit of integration;
              to both sides of a zero of a modulus, a logarithm, a root or the like; between two
              such zeros; and to where such a thing, or a spike, is stationary
"""

import hashlib
import random
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from itertools import chain, islice, pairwise
from math import nan
from typing import Any, NamedTuple

import mpmath
import numpy as np
from mpmath import mpf
from sympy import Expr, Integral, Symbol, exp, lambdify
from sympy.functions.elementary.hyperbolic import HyperbolicFunction
from sympy.logic.boolalg import Boolean
from sympy.printing.codeprinter import PrintMethodNotImplementedError

from derive.check.claim import SCALE, Claim, Point, Range
from derive.proof.balls import digits
from derive.proof.kinks import peaked, switches
from derive.proof.values import Undecided, program
from derive.sheet.notation import text_of

POINTS = 24
"""Number of points of moderate size at which both sides are compared."""
LEAST = 20
"""The same for claims with integrals; also the least number of points for any verdict."""
_TRIES = 300
"""Number of attempts to draw a point that meets the conditions of a claim."""
_CLOSEST = 6
"""Points approach an end of a range to within 10**-6 of the length of the range."""
_PAST = (0.5, 0.9, 1.1, 2, 6)
"""Values of other variables relative to a numerical limit of integration."""
_MOST_PAST, _WIDE_PAST = 15, 6
"""The largest number of such points, and of further points over many decades in such a case."""
_LOOKED_AT = 10
"""The largest number of expressions of a claim whose zeros are sought."""
_DECADES = 6
"""The decades over which a variable without a range is spread."""
_APART = 1e-9
"""Two zeros are different if they are this far apart, relative to their size."""
_GRID = 96
"""Number of grid points for the sign of an expression; an even number leaves out the middle."""

_FADED = 69
"""The exponential of minus this number is below the digits that two sides must share."""
_FAR = np.array([1e-30, 10.0**-_DECADES, 10.0**_DECADES, 1e30])
"""Values below, at either end of, and above those of a variable without a range."""


class _Numbers(NamedTuple):
    """The numbers of further points, and the decades over which variables are spread."""

    wide: int
    ends: int
    corners: int
    special: int
    decades: int


_MANY, _FEW = _Numbers(8, 6, 16, 12, _DECADES), _Numbers(3, 2, 2, 4, 2)
"""For claims without integrals, and for claims with integrals."""


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


@cache
def _compiled(expr: Expr) -> tuple[Callable[..., Any], list[Symbol]]:
    """Return an expression as a function of its symbols, which gives NaN if it has no rule."""
    held = sorted(expr.free_symbols, key=in_order)
    try:
        return lambdify(held, expr, modules="numpy"), held
    except PrintMethodNotImplementedError:
        return lambda *_: nan, held


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
        tries = (drawn.point() for _ in range(_TRIES if claim.meant.conditions else 1))
        yield from islice((point for point in tries if is_allowed(claim, point)), 1)


def further(claim: Claim, exprs: Sequence[Expr]) -> Iterator[Point]:
    """Yield points at which a claim may fail although it holds at points of moderate size."""
    few = has_integral(claim)
    numbers, drawn = _FEW if few else _MANY, _Drawn(claim, "further")
    if claim.meant.cases or not drawn.symbols:
        return
    past = list(drawn.past_limits(exprs)) if few else []
    groups = [
        drawn.wide(numbers.wide + _WIDE_PAST * bool(past), numbers.decades),
        drawn.near_ends(numbers),
        past,
    ]
    if not (few and claim.entry.family):
        found = {switch for expr in exprs for switch in switches(expr) if not switch.of.is_nonzero}
        kinks = [switch.of for switch in found if switch.kind == "kink"]
        peaks = [inner for expr in exprs for inner in peaked(expr)]
        either_side = drawn.either_side(switch.of for switch in found)
        stationary = islice(drawn.stationary([*kinks, *peaks]), 2 * numbers.special)
        between = islice(drawn.between([switch.of for switch in found]), numbers.special)
        groups += [islice(either_side, numbers.special), stationary, between]
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
    for expr, variable in drawn.along(found):
        below, low, high, above = np.sign(along(expr, variable, point, _FAR))
        if variable not in drawn.ranges and -1 in (below * low, high * above):
            values = _values(expr, variable, examined)
            if not min(values) < 0 < max(values):
                where = f"beyond the values of {variable} that are examined"
                return f"{text_of(expr)} changes its sign {where}"
    for expr, variable in drawn.along(fading):
        if min(map(abs, _values(expr, variable, examined))) > _FADED:
            return f"an exponential of {text_of(expr)} has its limit at all examined points"
    return ""


def _values(expr: Expr, variable: Symbol, where: Sequence[Point]) -> list[float]:
    return [float(along(expr, variable, p, np.array([float(p[variable])]))[0]) for p in where]


class _Drawn:
    """Random points of one claim, some variables of which are moved."""

    def __init__(self, claim: Claim, seed: str) -> None:
        digest = hashlib.sha256(
            f"{claim.entry.family or claim.entry.label}{seed}".encode()
        ).digest()
        self.rng = random.Random(int.from_bytes(digest[:8], "big"))
        self.symbols = variables(claim)
        self.ranges = {s: claim.meant.ranges[s] for s in self.symbols if s in claim.meant.ranges}

    def point(self, moved: dict[Symbol, float] | None = None) -> Point:
        """Return a point of moderate size, with other values of some variables."""
        values = {s: _at(self.ranges.get(s, SCALE), self.rng.random()) for s in self.symbols}
        return {symbol: mpf(value) for symbol, value in (values | (moved or {})).items()}

    def wide(self, count: int, decades: int) -> Iterator[Point]:
        """Yield points with the variables that have no range spread over many decades."""
        free = [symbol for symbol in self.symbols if symbol not in self.ranges]
        for _ in range(count if free else 0):
            yield self.point({s: 10 ** self.rng.uniform(-decades, decades) for s in free})

    def near_ends(self, numbers: _Numbers) -> Iterator[Point]:
        """Yield points with all variables near ends of their ranges.

        Some are close to random corners, others within a tenth of the upper, the lower, and then
        random ends.
        """
        full = 2 ** len(self.ranges) - 1
        some = [full, 0, *(self.rng.randint(0, full) for _ in range(numbers.ends - 2))]
        corners = self.rng.sample(range(full + 1), min(full + 1, numbers.corners))
        for n, corner in enumerate([*some, *corners] if self.ranges else []):
            farthest = -1 if n < numbers.ends else -4
            shares = [10 ** self.rng.uniform(-_CLOSEST, farthest) for _ in self.ranges]
            yield self.point(
                {
                    symbol: _at(span, 1 - share if corner >> k & 1 else share)
                    for k, ((symbol, span), share) in enumerate(
                        zip(self.ranges.items(), shares, strict=True)
                    )
                }
            )

    def past_limits(self, exprs: Sequence[Expr]) -> Iterator[Point]:
        """Yield points with variables of an integrand close to a numerical limit."""
        near = set[tuple[Symbol, float]]()
        for over in set().union(*(expr.atoms(Integral) for expr in exprs)):
            held = over.function.free_symbols & set(self.symbols) - {over.limits[-1][0]}
            ends = [end for end in over.limits[-1][1:] if end.is_real and end.is_number and end]
            near |= {(each, part * float(end)) for each in held for end in ends for part in _PAST}
        within = [(s, value) for s, value in near if self._grid(s)[0] < value < self._grid(s)[-1]]
        for symbol, value in sorted(within, key=lambda e: (in_order(e[0]), e[1]))[:_MOST_PAST]:
            yield self.point({symbol: value})

    def either_side(self, exprs: Iterable[Expr]) -> Iterator[Point]:
        """Yield pairs of points with a zero of an expression between them."""
        for expr, variable in self.along(exprs):
            point = self.point()
            for zero, ends in zeros(expr, variable, point, self._grid(variable))[:1]:
                for end in ends:
                    share = 10 ** self.rng.uniform(-4, 0)
                    yield point | {variable: mpf(zero + (end - zero) * share)}

    def between(self, exprs: Iterable[Expr]) -> Iterator[Point]:
        """Yield points between neighbouring zeros along one variable, closest pairs first.

        Between the zeros of two switches, a claim may be false in a very small range.
        """
        point, places = self.point(), dict[Symbol, list[float]]()
        for expr, variable in self.along(exprs):
            found = zeros(expr, variable, point, self._grid(variable))
            places.setdefault(variable, []).extend(zero for zero, _ in found)
        pairs = [(s, *ends) for s, each in places.items() for ends in pairwise(sorted(each))]
        for symbol, low, high in sorted(pairs, key=lambda pair: pair[2] - pair[1]):
            if high - low > _APART * abs(high):
                yield point | {symbol: mpf(low + (high - low) * self.rng.uniform(0.2, 0.8))}

    def stationary(self, exprs: Iterable[Expr]) -> Iterator[Point]:
        """Yield points where an expression is stationary.

        Near such points it may change sign twice between two neighbouring points of a grid.  The
        variables are treated one after the other, and each keeps the value that was found for it.
        """
        points_ = dict[Expr, Point]()
        for expr, variable in self.along(exprs):
            point = points_.setdefault(expr, self.point())
            grid = self._grid(variable)
            for zero, _ in zeros(expr.diff(variable), variable, point, grid)[:1]:
                points_[expr] = point | {variable: mpf(zero)}
                yield points_[expr]

    def along(self, exprs: Iterable[Expr]) -> Iterator[tuple[Expr, Symbol]]:
        """Yield the expressions in the variables, the shortest first, with each variable."""
        known = set(self.symbols)
        chosen = {each for each in exprs if each.free_symbols <= known and not each.has(Integral)}
        for expr in sorted(chosen, key=lambda each: (len(str(each)), str(each)))[:_LOOKED_AT]:
            yield from ((expr, variable) for variable in sorted(expr.free_symbols, key=in_order))

    def _grid(self, symbol: Symbol) -> Any:
        """Return values of a variable over its whole range."""
        if symbol not in self.ranges:
            return np.logspace(-_DECADES, _DECADES, _GRID)
        return np.array([_at(self.ranges[symbol], n / (_GRID - 1)) for n in range(_GRID)])


def _at(span: Range, share: float) -> float:
    """Return the value at a fraction of a range."""
    value = span.low + share * (span.high - span.low)
    return float(2.0**value if span.powers else value)


def along(expr: Expr, variable: Symbol, point: Point, values: Any) -> Any:
    """Evaluate an expression along a variable in double precision, with NaN if that fails."""
    of, held = _compiled(expr)
    with np.errstate(all="ignore"):
        try:
            found = of(*(values if s == variable else float(point[s]) for s in held))
        except (ArithmeticError, NameError, TypeError, ValueError):
            found = nan
    found = np.broadcast_to(np.asarray(found), values.shape)
    return np.full(values.shape, nan) if np.iscomplexobj(found) else found


def _products(expr: Expr, variable: Symbol, point: Point, values: Any) -> Any:
    """Return the products of neighbouring values, which are negative where the sign changes."""
    found = along(expr, variable, point, values)
    with np.errstate(all="ignore"):
        return found[:-1] * found[1:]


def zeros(
    expr: Expr, variable: Symbol, point: Point, grid: Any
) -> list[tuple[float, tuple[float, float]]]:
    """Return changes of sign along a variable, each between two neighbouring values of a grid.

    The one in the middle comes first.
    """
    changes = np.flatnonzero(_products(expr, variable, point, grid) < 0)
    found = []
    for n in np.roll(changes, -(len(changes) // 2)):
        low, high = grid[n], grid[n + 1]
        for _ in range(20):  # narrow the interval by repeated division
            parts = np.linspace(low, high, 9)
            k = int(np.argmax(_products(expr, variable, point, parts) <= 0))
            low, high = parts[k], parts[k + 1]
        found.append((float(low + high) / 2, (float(grid[n]), float(grid[n + 1]))))
    return found


# ------------------------------------------------------------------ in words


def spread(drawn: Sequence[Point]) -> str:
    """Return the ranges that the points cover, with variables of equal range grouped together."""
    names_by_span: dict[str, list[str]] = {}
    for symbol in sorted(set().union(*drawn) if drawn else set(), key=in_order):
        values = [point[symbol] for point in drawn if symbol in point]
        span = " to ".join(mpmath.nstr(end, 2) for end in (min(values), max(values)))
        names_by_span.setdefault(span, []).append(symbol.name)
    return "; ".join(f"{', '.join(names)} from {span}" for span, names in names_by_span.items())
