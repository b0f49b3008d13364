"""Values to 30 digits that are known to be right.

Every value is computed twice, the second time with more digits; digits that both share are digits
of the value.  Where cancellation leaves too few of them the number of working digits is raised, and
if that does not help the value is unknown, which is not the same as zero.
"""

import hashlib
import random
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import TypeAlias

import mpmath
from mpmath import mpc, mpf
from sympy import (
    Abs,
    Add,
    Dummy,
    Expr,
    Integral,
    Mul,
    Pow,
    S,
    Symbol,
    lambdify,
    log,
    nan,
    oo,
    sign,
    zoo,
)
from sympy.printing.codeprinter import PrintMethodNotImplementedError

from derive.paper.claim import SCALE, Claim, Meaning, Point, Range
from derive.paper.quick import Unknown, approximately

DIGITS = 30
"""Digits to which both sides must agree."""
POINTS = 24
"""Points at which they are compared."""
LEAST = 20
"""Points where an integral is in it; below that nothing is decided."""
_WORKING = (36, 44, 80)
"""Working digits, tried in this order."""
_MORE = (160, 240)
"""Those after them, where no integral is to be computed."""
_NOISE = 12
"""Digits by which what is left of a sum that vanishes may exceed its last digit."""
_MODERATE = 30
"""Digits before or after the point that a part of a sum may have which is taken to vanish."""
_COARSE = (16, 24)
_FEW = 4
"""Digits: two sides that share no more of them differ."""
_QUICK = 16
"""Digits by which candidates are told apart at first."""
_INSIDE = 3
"""The ends of an integral are evaluated to so many times the digits of the integral."""

_GUARD = 10
"""Digits that an integrand has beyond its integral, where nothing cancels."""
_SPARE = 5
"""Digits of the working precision that an integral may lack."""

Value: TypeAlias = mpf | mpc


class Undecided(Exception):
    """Digits were lost faster than they could be added, or no number came out at all."""


@dataclass(frozen=True)
class Pair:
    """Both sides at one point, and how many digits of them are known to agree."""

    left: Value
    right: Value
    point: Point

    @property
    def digits(self) -> int:
        """Digits in which both agree."""
        return agreement(self.left, self.right)

    @property
    def agree(self) -> bool:
        """Whether they agree to as many digits as are asked for."""
        return self.digits >= DIGITS


def agreement(first: Value, second: Value) -> int:
    """Digits that two numbers share; two zeros share all of them."""
    size = max(abs(first), abs(second))
    gap = abs(first - second)
    if gap == 0:
        return 2 * DIGITS
    return max(0, int(-mpmath.log10(gap / size)))


def points(claim: Claim, count: int = POINTS, seed: str = "") -> Iterator[Point]:
    """Random points of a claim's assumptions, the same on every machine."""
    symbols = variables(claim)
    digest = hashlib.sha256(f"{claim.family or claim.label}{seed}".encode()).digest()
    rng = random.Random(int.from_bytes(digest[:8], "big"))
    for _ in range(count if count < POINTS or not has_integral(claim) else LEAST):
        yield {symbol: _drawn(claim.ranges.get(symbol, SCALE), rng) for symbol in symbols}


def has_integral(claim: Claim) -> bool:
    """Whether a side, or what a symbol of it means, is an integral."""
    exprs = [*claim.sides(claim.left, claim.right), *claim.meaning.values()]
    return any(expr.has(Integral) for expr in exprs)


def _drawn(span: Range, rng: random.Random) -> mpf:
    value = mpf(rng.uniform(span.low, span.high))
    return mpf(2) ** value if span.powers else value


def variables(claim: Claim) -> list[Symbol]:
    """Our symbols that a point must give a number to."""
    sides = claim.sides(claim.left, claim.right)
    held = set().union(*(side.free_symbols for side in sides))
    found: set[Symbol] = set(claim.ranges)
    for symbol in held:
        found |= claim.meaning.get(symbol, symbol).free_symbols
    return sorted(found - set(claim.samples) - _bound(claim), key=_order)


def _order(symbol: Symbol) -> tuple[str, str]:
    return symbol.name, str(symbol.assumptions0)


def _bound(claim: Claim) -> set[Symbol]:
    """Variables of integration; a sheet's own place x is one only where it is integrated over."""
    exprs = [*claim.sides(claim.left, claim.right), *claim.meaning.values()]
    integrals = {over for expr in exprs for over in expr.atoms(Integral)}
    return {limit[0] for over in integrals for limit in over.limits} - set(claim.ranges)


class _Numbers(dict[Symbol, mpf]):
    """Numbers for our symbols, and for the source's once they are asked for."""

    def __init__(self, known: Point, meaning: Meaning) -> None:
        super().__init__(known)
        self._known, self.meaning = known, meaning

    def __missing__(self, symbol: Symbol) -> Value:
        if symbol not in self.meaning:
            raise Undecided(f"nothing says what {symbol} is")
        self[symbol] = evaluated(self.meaning[symbol], self._known)
        return self[symbol]


def numbers(claim: Claim, meaning: Meaning, point: Point) -> Point:
    """Numbers for our symbols and for the source's at one point."""
    known = dict(point)
    for symbol, sample in claim.samples.items():
        known[symbol] = sample(point)
    return _Numbers(_Numbers(known, {}), meaning)


def _sides(
    left: Expr, right: Expr, value: Callable[[], Point], working: int
) -> tuple[Value, Value]:
    """Both sides, and what they are made of, with so many digits."""
    with mpmath.workdps(working):
        numbers = value()
        return evaluated(left, numbers), evaluated(right, numbers)


def apart(left: Expr, right: Expr, value: Callable[[], Point], point: Point) -> Pair | None:
    """Both sides where a few digits, that do not change with more of them, tell them apart."""
    found = []
    for working in _COARSE:
        found.append(_sides(left, right, value, working))
        if not all(mpmath.isfinite(number) for number in found[-1]) or agreement(*found[-1]) > _FEW:
            return None
    if any(map(_may_be_lost, (left, right), found[-1])):
        return None
    stable = all(agreement(*values) > 2 * _FEW for values in zip(*found, strict=True))
    return Pair(*found[-1], point) if stable else None


def both(left: Expr, right: Expr, value: Callable[[], Point], point: Point) -> Pair:
    """Both sides with digits that are known to be right; raises Undecided."""
    sides, found = (left, right), list[tuple[Value, Value]]()
    steps = _WORKING if left.has(Integral) or right.has(Integral) else _WORKING + _MORE
    for working in steps:
        found.append(_sides(left, right, value, working))
        if not all(mpmath.isfinite(number) for number in found[-1]):
            raise Undecided("no finite number")
        if found[1:] and all(map(_is_known, sides, *found[-2:])):
            return Pair(*found[-1], point)
    left_found, right_found = zip(*found, strict=True)
    values = (
        _settled(left, left_found, steps, value),
        _settled(right, right_found, steps, value),
    )
    return Pair(*values, point)


def _is_known(side: Expr, before: Value, now: Value) -> bool:
    """Whether enough digits of a side are right."""
    return agreement(before, now) >= DIGITS and not _may_be_lost(side, now)


def _may_be_lost(side: Expr, now: Value) -> bool:
    """Whether a zero may be all that cancellation left of a number."""
    return bool(now == 0) and side.has(Add, Integral, Symbol)


def _settled(
    side: Expr, found: tuple[Value, ...], steps: tuple[int, ...], value: Callable[[], Point]
) -> Value:
    """The last of the values if it is known, zero if the side vanishes; raises Undecided."""
    if _is_known(side, *found[-2:]):
        return found[-1]
    shrinks = all(abs(v) < mpf(10) ** (_NOISE - d) for v, d in zip(found, steps, strict=True))
    if not shrinks or _is_extreme(side, value):
        raise Undecided(f"cancellation leaves fewer than {DIGITS} digits of {steps[-1]}")
    return mpf(0)


def _is_extreme(side: Expr, value: Callable[[], Point]) -> bool:
    """Whether a part is so large, or so small, that a number could be lost beside it."""
    less, more = (_sizes(side, value, working) for working in _WORKING[:2])
    floor = mpf(10) ** (_NOISE - _WORKING[0])
    return any(
        size != 0
        and abs(mpmath.log10(size)) > _MODERATE
        and not (size <= floor and agreement(size, again) < _FEW)  # noise, and no number
        for size, again in zip(less, more, strict=True)
    )


def _sizes(side: Expr, value: Callable[[], Point], working: int) -> list[mpf]:
    with mpmath.workdps(working):
        numbers = value()
        if isinstance(numbers, _Numbers):
            side = side.xreplace(dict(numbers.meaning))
        return list(_parts(side, {s: numbers[s] for s in _free(side)}))


def _free(side: Expr) -> list[Symbol]:
    return sorted(side.free_symbols, key=_order)


def _parts(side: Expr, numbers: Point) -> Iterator[mpf]:
    """Sizes of an expression and all parts of it; under an integral, at one place inside."""
    yield abs(evaluated(side, numbers))
    if not isinstance(side, Integral):
        for part in side.args:
            yield from _parts(part, numbers)
        return
    variable, low, high = side.limits[0]
    yield from (*_parts(low, numbers), *_parts(high, numbers))
    ends = evaluated(low, numbers), evaluated(high, numbers)
    place = ends[0] + (ends[1] - ends[0]) * mpf(3) / 8
    yield from _parts(side.function, {**numbers, variable: place})


def near(left: Expr, right: Expr, value: Callable[[], Point]) -> bool:
    """Whether both sides may be equal, by a few digits."""
    with mpmath.workdps(_QUICK):
        numbers = value()
        try:
            held = left.free_symbols | right.free_symbols
            plain = {symbol: complex(numbers[symbol]) for symbol in held}
            first, second = approximately(left, plain), approximately(right, plain)
        except Unknown:
            first, second = evaluated(left, numbers), evaluated(right, numbers)
        if not (mpmath.isfinite(first) and mpmath.isfinite(second)):
            return False
        scale = max(abs(first), abs(second), mpf(10) ** -2)
        return bool(abs(first - second) < scale * mpf(10) ** -7)


def evaluated(expr: Expr, numbers: Mapping[Symbol, mpf]) -> Value:
    """`expr` at the working precision, its integrals by quadrature."""
    function, held, integrals = _compiled(expr)
    given = [numbers[symbol] for symbol in held]
    try:
        found = [_quadrature(each, numbers) for each in integrals]
        return mpmath.mpmathify(function(*given, *found))
    except (ArithmeticError, MemoryError, ValueError, TypeError) as error:
        raise Undecided(f"no number comes out ({type(error).__name__}: {error})") from error


@cache
def _compiled(expr: Expr) -> tuple[Callable[..., Value], list[Symbol], list[Integral]]:
    if expr.has(zoo, nan, oo):
        raise Undecided(f"{expr} is no number")
    if any(len(over.limits) > 1 for over in expr.atoms(Integral)):
        raise Undecided("an integral over several variables is not computed")
    outer = [i for i in expr.atoms(Integral) if not _is_inner(i, expr)]
    integrals = sorted(outer, key=str)
    stand_ins = {found: Dummy("I") for found in integrals}
    plain = expr.xreplace(stand_ins)
    held = sorted(plain.free_symbols - set(stand_ins.values()), key=str)
    try:
        function = lambdify([*held, *stand_ins.values()], plain, modules="mpmath")
    except PrintMethodNotImplementedError as error:
        raise Undecided(f"no way is known to compute {expr}") from error
    return function, held, integrals


def _is_inner(integral: Integral, expr: Expr) -> bool:
    return any(integral in other.function.atoms(Integral) for other in expr.atoms(Integral))


def _quadrature(over: Integral, numbers: Mapping[Symbol, mpf]) -> Value:
    """An integral, kept by what it depends on; factors free of the variable stand outside."""
    variable, low, high = over.limits[0]
    factor, core = _separated(over)
    held = sorted(core.free_symbols, key=str)
    key = (core, tuple(numbers[symbol] for symbol in held), mpmath.mp.dps)
    if key not in _KNOWN:
        with mpmath.workdps(_INSIDE * mpmath.mp.dps):  # or a root would not vanish at its end
            start, end = evaluated(low, numbers), evaluated(high, numbers)
            inside = [evaluated(place, numbers) for place in _singular(core)]
        cuts = [start, *sorted({place for place in inside if start < place < end}), end]
        along = _integrand(core.function, variable, numbers)
        steep = _is_steep(core.function)
        _KNOWN[key] = sum(_part(along, *ends, inside, steep) for ends in pairwise(cuts))
    return evaluated(factor, numbers) * _KNOWN[key]


_KNOWN: dict[tuple[Integral, tuple[mpf, ...], int], Value] = {}


@cache
def _is_steep(integrand: Expr) -> bool:
    """Whether it holds one over a root."""
    return any(p.exp.is_Rational and p.exp.q == 2 and p.exp < 0 for p in integrand.atoms(Pow))


@cache
def _separated(over: Integral) -> tuple[Expr, Integral]:
    variable = over.limits[0][0]
    factor, core = over.function.as_independent(variable, as_Add=False)
    return factor, Integral(core, over.limits[0])


def _integrand(
    expr: Expr, variable: Symbol, numbers: Mapping[Symbol, mpf]
) -> Callable[[mpf], Value]:
    function, held, inner = _compiled(expr)
    if inner:
        return lambda place: evaluated(expr, {**numbers, variable: place})
    given = [None if symbol == variable else numbers[symbol] for symbol in held]
    spot = held.index(variable) if variable in held else None

    def at(place: mpf) -> Value:
        if spot is not None:
            given[spot] = place
        return function(*given)

    return at


def _part(
    along: Callable[[mpf], Value], start: mpf, end: mpf, singular: list[mpf], steep: bool
) -> Value:
    """From end to end with s = start + (end - start) sin(t)**2.

    Where roots vanish or are infinite at both ends, the integrand is then even and periodic, and
    plain midpoints converge geometrically; else Gauss's nodes, or those that crowd at the ends.
    """
    ends = sum(
        any(abs(place - end_) < _SAME * (end - start) for place in singular)
        for end_ in (start, end)
    )
    if ends == 2 and mpf(0) not in (start, end):
        value = _midpoints(along, start, end)
        if value is not None:
            return value
    if mpf(0) not in (start, end) or ends < 2:
        value = _gauss(along, start, end)
        if value is not None:
            return value
    return _crowded(along, start, end, steep)


_SAME = mpf(10) ** -12


def _midpoints(along: Callable[[mpf], Value], start: mpf, end: mpf) -> Value | None:
    digits, previous = mpmath.mp.dps, None
    for count in (16, 32, 64, 128, 256):
        with mpmath.workdps(digits + _GUARD):
            value = sum(
                along(start + (end - start) * square) * weight
                for square, weight in _nodes(count, digits)
            ) * (end - start)
        if previous is not None and agreement(previous, value) > 0.55 * digits:
            return value
        previous = value
    return None


@cache
def _nodes(count: int, digits: int) -> list[tuple[mpf, mpf]]:
    """sin(t)**2 and 2 sin(t) cos(t) dt at midpoints of [0, pi/2]."""
    with mpmath.workdps(digits + _GUARD):
        step = mpmath.pi / (2 * count)
        angles = [(k + mpf(1) / 2) * step for k in range(count)]
        return [(mpmath.sin(t) ** 2, mpmath.sin(2 * t) * step) for t in angles]


def _gauss(along: Callable[[mpf], Value], start: mpf, end: mpf) -> Value | None:
    digits = mpmath.mp.dps
    value, error = mpmath.quad(
        _by_angle(along, start, end, digits + _GUARD),
        [mpf(0), mpmath.pi / 2],
        method="gauss-legendre",
        error=True,
    )
    return value if error <= abs(value) * mpf(10) ** (_SPARE - digits) else None


def _crowded(along: Callable[[mpf], Value], start: mpf, end: mpf, steep: bool) -> Value:
    """Nodes that crowd at both ends; twice the digits where the integrand is infinite there."""
    digits = mpmath.mp.dps * (2 if steep else 1) + _GUARD
    around = _by_angle(along, start, end, digits)
    return mpmath.quad(around, [mpf(0), mpmath.pi / 2], method="tanh-sinh")


def _by_angle(
    along: Callable[[mpf], Value], start: mpf, end: mpf, digits: int
) -> Callable[[mpf], Value]:
    def around(t: mpf) -> Value:
        with mpmath.workdps(digits):
            sine, cosine = mpmath.sin(t), mpmath.cos(t)
            try:
                value = along(start + (end - start) * sine**2)
            except (ZeroDivisionError, ValueError):
                value = mpmath.inf
            if not mpmath.isfinite(value):
                return mpf(0)  # the very end, where the node has no weight
            return 2 * (end - start) * sine * cosine * value

    return around


@cache
def _singular(over: Integral) -> tuple[Expr, ...]:
    """Where the integrand may be infinite or bend: the corner of a body, and zeros of radicands."""
    variable = over.limits[0][0]
    found: set[Expr] = {S.Zero} if over.function.has(log, sign, Abs) else set()
    for power in over.function.atoms(Pow):
        if power.exp.is_Rational and power.exp.q == 2:
            for factor in Mul.make_args(power.base):
                slope = factor.diff(variable)
                if slope != 0 and not slope.has(variable):
                    found.add(-factor.subs(variable, 0) / slope)
    return tuple(sorted(found, key=str))
