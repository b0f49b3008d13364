"""Choose the points at which a claim is evaluated: random, but the same on every machine.

All points satisfy the conditions of the claim.

points    variables of moderate size, or spread evenly over a declared range
further   points over many decades, near the ends of ranges, and on both sides of the zeros of
          a modulus, a logarithm, a root or the like in the claim
"""

import hashlib
import random
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from typing import Any

import mpmath
import numpy as np
from mpmath import mpf
from sympy import Expr, Integral, Symbol, lambdify
from sympy.logic.boolalg import Boolean
from sympy.printing.codeprinter import PrintMethodNotImplementedError

from derive.check.claim import SCALE, Claim, Point, Range
from derive.proof.kinks import Switch, peaked, switches
from derive.reading.relation import Relation

POINTS = 24
"""Number of points of moderate size at which both sides are compared."""
LEAST = 20
"""The same for claims with integrals; also the least number of points for any verdict."""
DECADES = 6
"""At further points, a positive variable without a range is drawn from 10**-6 to 10**6."""
_FEWER_DECADES = 2
"""The same for claims with integrals."""
_WIDE, _AT_ENDS, _CHANGES = 8, 6, 12
_FEWER_WIDE, _FEWER_AT_ENDS, _FEWER_CHANGES = 3, 2, 4
_CORNERS, _FEWER_CORNERS = 16, 2
"""The largest number of corners of all ranges that are examined."""
_TRIES = 300
"""Number of attempts to draw a point that meets the conditions of a claim."""
_PAST = (0.5, 0.9, 1.1, 2, 6)
"""Values of other variables relative to a numerical limit of integration."""
_MOST_PAST = 15
_WIDE_PAST = 6
"""Number of points over many decades if a limit is a number, which sets an absolute scale."""
_CLOSEST = 6
"""Points approach an end of a range to within 10**-6 of the length of the range."""
_TOUCHING = 1e-10
"""Two sides touch if their gap is at most this fraction of the gaps next to it."""
_SWITCHES = 10
"""The largest number of switches of a claim that are examined."""
_GRID = 96
"""Number of grid points for the sign of a switch; an even number leaves out the middle."""


def points(claim: Claim, count: int = POINTS, seed: str = "") -> Iterator[Point]:
    """Yield the claim's own cases if it has any, or else points of moderate size."""
    if claim.meant.cases:
        yield from (
            {symbol: mpf(text) for symbol, text in case.items()} for case in claim.meant.cases
        )
        return
    symbols, rng = variables(claim), _random(claim, seed)
    if not symbols:
        yield {}
        return
    for _ in range(count if count < POINTS or not has_integral(claim) else LEAST):
        for _ in range(_TRIES if claim.meant.conditions else 1):
            point = {symbol: _drawn(_range(claim, symbol), rng) for symbol in symbols}
            if is_allowed(claim, point):
                yield point
                break


def is_allowed(claim: Claim, point: Point) -> bool:
    """Whether a point meets the conditions of a claim."""
    try:
        return all(is_met(each, point) for each in claim.meant.conditions)
    except (ArithmeticError, TypeError, ValueError):  # undefined, or not real
        return False


def is_met(condition: Boolean, point: Point) -> bool:
    """Whether a condition is true at a point."""
    met, held = _for_a_point(condition)
    return bool(met(*(point[symbol] for symbol in held)))


@cache
def _for_a_point(condition: Boolean) -> tuple[Callable[..., bool], list[Symbol]]:
    held = sorted(condition.free_symbols, key=in_order)
    return lambdify(held, condition, modules="mpmath"), held


def further(claim: Claim, exprs: Iterable[Expr]) -> Iterator[Point]:
    """Yield points at which a claim may fail although it holds at points of moderate size."""
    yield from (point for point in _further(claim, exprs) if is_allowed(claim, point))


def _further(claim: Claim, exprs: Iterable[Expr]) -> Iterator[Point]:
    symbols = variables(claim)
    if claim.meant.cases or not symbols:
        return
    few = has_integral(claim)
    rng = _random(claim, "further")
    yield from _wide(claim, symbols, rng, few)
    yield from _at_ends(claim, symbols, rng, _FEWER_AT_ENDS if few else _AT_ENDS)
    yield from _corners(claim, symbols, _random(claim, "corners"), few)
    exprs = list(exprs)
    if few:
        yield from _past_limits(claim, symbols, _random(claim, "limits"), exprs)
    if claim.meant.is_inequality and not few:
        pairs = _closest(claim, symbols, rng, exprs[0] - exprs[1])
        yield from (point for point, _ in pairs)
    if not (few and claim.meant.family):
        most = _FEWER_CHANGES if few else _CHANGES
        yield from _changes(claim, symbols, rng, exprs, most)
        yield from _peaks(claim, symbols, rng, exprs, most)
        yield from _bottoms(claim, symbols, _random(claim, "bottoms"), exprs, most)


def _random(claim: Claim, seed: str) -> random.Random:
    digest = hashlib.sha256(f"{claim.meant.family or claim.printed.label}{seed}".encode()).digest()
    return random.Random(int.from_bytes(digest[:8], "big"))


def _range(claim: Claim, symbol: Symbol) -> Range:
    return claim.meant.ranges.get(symbol, SCALE)


def _drawn(span: Range, rng: random.Random) -> mpf:
    value = mpf(rng.uniform(span.low, span.high))
    return mpf(2) ** value if span.powers else value


def has_integral(claim: Claim) -> bool:
    """Whether a side, or the meaning of one of its symbols, contains an integral."""
    sides = claim.meant.sides(claim.meant.left, claim.meant.right)
    held = set().union(*(side.free_symbols for side in sides))
    meanings = [expr for symbol, expr in claim.meant.meaning.items() if symbol in held]
    return any(expr.has(Integral) for expr in (*sides, *meanings))


def _exprs(claim: Claim) -> list[Expr]:
    return [*claim.meant.sides(claim.meant.left, claim.meant.right), *claim.meant.meaning.values()]


def variables(claim: Claim) -> list[Symbol]:
    """Return the variables that need a value at every point."""
    sides = claim.meant.sides(claim.meant.left, claim.meant.right)
    held = set().union(*(side.free_symbols for side in sides))
    symbols: set[Symbol] = set(claim.meant.ranges)
    for condition in (*claim.meant.conditions, *(claim.meant.toward or ())):
        symbols |= condition.free_symbols
    for symbol in held:
        symbols |= claim.meant.meaning.get(symbol, symbol).free_symbols
    return sorted(symbols - _bound(claim), key=in_order)


def in_order(symbol: Symbol) -> tuple[str, str]:
    """Return a sort key that also distinguishes symbols with the same name."""
    return symbol.name, str(symbol.assumptions0)


def _bound(claim: Claim) -> set[Symbol]:
    """Return the variables of integration, except those for which the claim has a range."""
    integrals = {over for expr in _exprs(claim) for over in expr.atoms(Integral)}
    return {limit[0] for over in integrals for limit in over.limits} - set(claim.meant.ranges)


# ------------------------------------------------------------------ further points


def _wide(
    claim: Claim, symbols: Sequence[Symbol], rng: random.Random, few: bool
) -> Iterator[Point]:
    """Yield points with the variables that have no range spread over many decades."""
    decades = _FEWER_DECADES if few else DECADES
    free = [symbol for symbol in symbols if symbol not in claim.meant.ranges]
    for _ in range((_FEWER_WIDE if few else _WIDE) if free else 0):
        point = {symbol: _drawn(_range(claim, symbol), rng) for symbol in symbols}
        yield point | {symbol: mpf(10) ** rng.uniform(-decades, decades) for symbol in free}


def _at_ends(
    claim: Claim, symbols: Sequence[Symbol], rng: random.Random, count: int
) -> Iterator[Point]:
    """Yield points with variables near the ends of their ranges.

    All are near the upper ends first, then near the lower ends, and then near random ends.
    """
    limited = [symbol for symbol in symbols if symbol in claim.meant.ranges]
    for n in range(count if limited else 0):
        point = {symbol: _drawn(_range(claim, symbol), rng) for symbol in symbols}
        for symbol in limited:
            span = _range(claim, symbol)
            share = 10 ** rng.uniform(-_CLOSEST, -1)
            high = n == 0 or (n > 1 and rng.random() < 0.5)
            point[symbol] = _inside(span, share, high)
        yield point


def _corners(
    claim: Claim, symbols: Sequence[Symbol], rng: random.Random, few: bool
) -> Iterator[Point]:
    """Yield points with all variables near ends of their ranges at once.

    For claims with integrals, the two corners that `_at_ends` already covers are left out.
    """
    limited = [symbol for symbol in symbols if symbol in claim.meant.ranges]
    if not limited or (few and len(limited) < 2):
        return
    count, most = 2 ** min(len(limited), 16), _FEWER_CORNERS if few else _CORNERS
    corners = range(1, count - 1) if few else range(count)
    chosen = corners if len(corners) <= most else rng.sample(corners, most)
    for corner in chosen:
        point = {symbol: _drawn(_range(claim, symbol), rng) for symbol in symbols}
        for n, symbol in enumerate(limited):
            share = 10 ** rng.uniform(-_CLOSEST, -4)
            point[symbol] = _inside(_range(claim, symbol), share, bool(corner >> n & 1))
        yield point


def _inside(span: Range, share: float, high: bool) -> mpf:
    """Return the point of a range at the relative distance `share` from one of its ends."""
    position = mpf(1 - share if high else share)
    value = span.low + position * (mpf(span.high) - span.low)
    return mpf(2) ** value if span.powers else value


def _past_limits(
    claim: Claim, symbols: Sequence[Symbol], rng: random.Random, exprs: Iterable[Expr]
) -> Iterator[Point]:
    """Yield points with variables of an integrand close to a numerical limit of integration."""
    known = set(symbols)
    wanted = set[tuple[float, Symbol]]()
    for over in set().union(*(expr.atoms(Integral) for expr in exprs)):
        numbers = [
            limit
            for limit in over.limits[-1][1:]
            if limit.is_real and limit.is_number and limit != 0
        ]
        held = (over.function.free_symbols - {over.limits[-1][0]}) & known
        wanted |= {(float(limit), symbol) for limit in numbers for symbol in held}
    values = [
        (symbol, part * limit)
        for limit, symbol in sorted(wanted, key=lambda each: (each[0], in_order(each[1])))
        for part in _PAST
        if _may_be(claim, symbol, part * limit)
    ]
    for symbol, value in values[:_MOST_PAST]:
        point = {each: _drawn(_range(claim, each), rng) for each in symbols}
        yield point | {symbol: mpf(value)}
    free = [symbol for symbol in symbols if symbol not in claim.meant.ranges]
    for _ in range(_WIDE_PAST if free and wanted else 0):
        point = {symbol: _drawn(_range(claim, symbol), rng) for symbol in symbols}
        yield point | {
            symbol: mpf(10) ** rng.uniform(-_FEWER_DECADES, _FEWER_DECADES) for symbol in free
        }


def _may_be(claim: Claim, symbol: Symbol, value: float) -> bool:
    """Whether a variable may take a value."""
    span = claim.meant.ranges.get(symbol)
    if span is None:
        return value > 0
    low, high = (2**span.low, 2**span.high) if span.powers else (span.low, span.high)
    return low < value < high


def _changes(
    claim: Claim, symbols: Sequence[Symbol], rng: random.Random, exprs: Iterable[Expr], most: int
) -> Iterator[Point]:
    """Yield pairs of points with a zero of a switch between them."""
    count = 0
    for switch in _looked_at(exprs, symbols):
        of, held = _for_arrays(switch.of)
        for variable in held:
            if of is None or count >= most:
                break
            point = {symbol: _drawn(_range(claim, symbol), rng) for symbol in symbols}
            grid = _grid(claim.meant.ranges.get(variable))
            between = _sign_change(of, held, variable, point, grid)
            if between is not None:
                count += 2
                yield from _either_side(of, held, variable, point, between, rng)


def _peaks(
    claim: Claim, symbols: Sequence[Symbol], rng: random.Random, exprs: Iterable[Expr], most: int
) -> Iterator[Point]:
    """Yield points where an exponent or a divisor is stationary, as at a spike."""
    known = set(symbols)
    inside = {n for expr in exprs for n in peaked(expr) if n.free_symbols <= known}
    count = 0
    for inner in sorted(inside, key=lambda n: (len(str(n)), str(n)))[:_SWITCHES]:
        for variable in sorted(inner.free_symbols, key=in_order):
            of, held = _for_arrays(inner.diff(variable))
            if of is None or variable not in held or count >= most:
                continue
            point = {symbol: _drawn(_range(claim, symbol), rng) for symbol in symbols}
            grid = _grid(claim.meant.ranges.get(variable))
            between = _sign_change(of, held, variable, point, grid)
            if between is not None:
                count += 1
                low, high = _narrowed(of, held, variable, point, between)
                yield point | {variable: mpf(float(low + high) / 2)}


def _bottoms(
    claim: Claim, symbols: Sequence[Symbol], rng: random.Random, exprs: Iterable[Expr], most: int
) -> Iterator[Point]:
    """Yield points where the argument of a modulus or a sign is stationary.

    Near such points it may change sign twice between two neighbouring points of a grid.  The
    variables are treated one after the other, and each keeps the value that was found for it.
    """
    count = 0
    for switch in _looked_at(exprs, symbols):
        if switch.kind != "kink" or switch.of.has(Integral):
            continue
        point = {symbol: _drawn(_range(claim, symbol), rng) for symbol in symbols}
        for variable in sorted(switch.of.free_symbols, key=in_order):
            of, held = _for_arrays(switch.of.diff(variable))
            if of is None or variable not in held or count >= most:
                continue
            grid = _grid(claim.meant.ranges.get(variable))
            between = _sign_change(of, held, variable, point, grid)
            if between is not None:
                count += 1
                low, high = _narrowed(of, held, variable, point, between)
                point = point | {variable: mpf(float(low + high) / 2)}
                yield point


def _looked_at(exprs: Iterable[Expr], symbols: Sequence[Symbol]) -> list[Switch]:
    """Return the switches that may change their sign, the shortest first."""
    known = set(symbols)
    candidates = {
        switch
        for expr in exprs
        for switch in switches(expr)
        if switch.of.free_symbols <= known and not switch.of.is_nonzero
    }
    return sorted(candidates, key=lambda s: (len(str(s.of)), str(s.of), s.kind))[:_SWITCHES]


def _grid(span: Range | None) -> Any:
    if span is None:
        return np.logspace(-DECADES, DECADES, _GRID)
    values = np.linspace(span.low, span.high, _GRID)
    return 2.0**values if span.powers else values


_OfArrays = Callable[..., Any]


def _for_arrays(expr: Expr) -> tuple[_OfArrays | None, list[Symbol]]:
    held = sorted(expr.free_symbols, key=in_order)
    try:
        return lambdify(held, expr, modules="numpy"), held
    except PrintMethodNotImplementedError:
        return None, held


def _values(
    of: _OfArrays, held: Sequence[Symbol], variable: Symbol, point: Point, along: Any
) -> Any:
    """Evaluate a switch along one variable in double precision, with NaN if that fails."""
    with np.errstate(all="ignore"):
        try:
            values = of(*(along if s == variable else float(point[s]) for s in held))
        except (ArithmeticError, NameError, TypeError, ValueError):
            return np.full(along.shape, np.nan)
    return np.broadcast_to(np.asarray(values), along.shape)


def _sign_change(
    of: _OfArrays, held: Sequence[Symbol], variable: Symbol, point: Point, grid: Any
) -> tuple[float, float] | None:
    """Return two values of a variable between which a switch changes its sign."""
    values = _values(of, held, variable, point, grid)
    if np.iscomplexobj(values):
        return None
    with np.errstate(all="ignore"):
        changes = np.nonzero(values[:-1] * values[1:] < 0)[0]
    if not len(changes):
        return None
    n = int(changes[len(changes) // 2])
    return float(grid[n]), float(grid[n + 1])


def _either_side(
    of: _OfArrays,
    held: Sequence[Symbol],
    variable: Symbol,
    point: Point,
    between: tuple[float, float],
    rng: random.Random,
) -> Iterator[Point]:
    """Yield a point on each side of the zero, between the zero and the given values."""
    low, _ = _narrowed(of, held, variable, point, between)
    for end in between:
        share = 10 ** rng.uniform(-4, 0)
        yield point | {variable: mpf(low) + (mpf(end) - mpf(low)) * mpf(share)}


def _narrowed(
    of: _OfArrays,
    held: Sequence[Symbol],
    variable: Symbol,
    point: Point,
    between: tuple[float, float],
) -> tuple[float, float]:
    """Return two neighbouring values with a change of sign between them, by bisection."""
    low, high = between
    for _ in range(60):
        middle = (low + high) / 2
        ends = _values(of, held, variable, point, np.array([low, middle]))
        low, high = (low, middle) if ends[0] * ends[1] <= 0 else (middle, high)
    return low, high


def _closest(
    claim: Claim, symbols: Sequence[Symbol], rng: random.Random, difference: Expr
) -> Iterator[tuple[Point, tuple[Point, ...]]]:
    """Yield points where the sides of an inequality are closest along one variable, or cross.

    If the sides appear to touch there, inside the range, in double precision, each point comes
    with one nearby point on either side.
    """
    of, held = _for_arrays(difference)
    if of is None or not set(held) <= set(symbols):
        return
    sense = 1 if claim.meant.relation in (Relation.BELOW, Relation.AT_MOST) else -1
    for variable in held[:_SWITCHES]:
        point = {symbol: _drawn(_range(claim, symbol), rng) for symbol in symbols}
        grid = _grid(claim.meant.ranges.get(variable))
        heights = _values(of, held, variable, point, grid)
        if np.iscomplexobj(heights) or not np.any(np.isfinite(heights)):
            continue
        heights = sense * np.where(np.isfinite(heights), heights, np.nan)
        n = int(np.nanargmax(heights))
        low, high = grid[max(n - 1, 0)], grid[min(n + 1, len(grid) - 1)]
        best = float(heights[n])
        for _ in range(30):
            finer = np.linspace(low, high, 9)
            finer_heights = _values(of, held, variable, point, finer) * sense
            if not np.all(np.isfinite(finer_heights)):
                break
            m = int(np.argmax(finer_heights))
            low, high, best = finer[max(m - 1, 0)], finer[min(m + 1, 8)], float(finer_heights[m])
        inside = 0 < n < len(grid) - 1
        around = np.abs(heights[n - 1 : n + 2]) if inside else np.zeros(1)
        position = float(low + high) / 2
        beside = tuple[Point, ...]()
        if inside and abs(best) <= _TOUCHING * np.max(around):
            steps = [(float(grid[other]) - position) / 1000 for other in (n - 1, n + 1)]
            beside = tuple(point | {variable: mpf(position + step)} for step in steps)
        yield point | {variable: mpf(position)}, beside


def touching(claim: Claim, exprs: Sequence[Expr]) -> Iterator[tuple[Point, tuple[Point, ...]]]:
    """Yield points where the sides of an inequality seem to touch, with the points beside them."""
    if claim.meant.cases or has_integral(claim) or not variables(claim):
        return
    rng = _random(claim, "touching")
    pairs = _closest(claim, variables(claim), rng, exprs[0] - exprs[1])
    yield from ((point, beside) for point, beside in pairs if beside)


# ------------------------------------------------------------------ in words


def spread(drawn: Sequence[Point]) -> str:
    """Return the ranges that the points cover, with variables of equal range grouped together."""
    names_by_span: dict[str, list[str]] = {}
    for symbol in sorted(set().union(*drawn) if drawn else set(), key=in_order):
        values = [point[symbol] for point in drawn if symbol in point]
        span = f"{_short(min(values))} to {_short(max(values))}"
        names_by_span.setdefault(span, []).append(symbol.name)
    return "; ".join(f"{', '.join(names)} from {span}" for span, names in names_by_span.items())


def _short(value: mpf) -> str:
    return str(mpmath.nstr(value, 2))
