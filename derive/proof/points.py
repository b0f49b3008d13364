"""Random states that meet a formula's assumptions; they are the same on every machine.

A point assigns a number to each symbol.  Contacts are drawn alternately with a > c and a < c, and
loads alternately with moments and tilts of both signs if the body has such contacts.  A point that
violates an assumption is drawn again.
"""

import hashlib
import random
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache, lru_cache
from typing import TypeVar

import mpmath
from flint import ctx
from mpmath import mpf
from sympy import Add, Dummy, Expr, Integral, Mul, Piecewise, Pow, Symbol, count_ops
from sympy.logic.boolalg import Boolean

from derive.body.compiled import compiled
from derive.body.geometry import Geometry
from derive.body.profile import has_sharp_power
from derive.proof.balls import Ball, ball, digits, function_of, functions_of
from derive.proof.rule import Function, integral, remembered
from derive.proof.verdict import POINTS
from derive.sheet.formulas import Formula, FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c, dM, dP, dQ, dsigma, e, f, x

Point = dict[Symbol, mpf]
T = TypeVar("T")


def draws(
    name: str, draw: Callable[[random.Random, int], T | None], count: int = POINTS
) -> Iterator[T]:
    """Yield `count` results of `draw`, which returns None for a point outside the assumptions.

    The drawing stops after a hundred attempts per point.  With fewer points than `count`, the
    verdict is unknown.
    """
    digest = hashlib.sha256(name.encode()).digest()
    rng = random.Random(int.from_bytes(digest[:8], "big"))
    found = 0
    for _ in range(100 * count):
        point = draw(rng, found)
        if point is not None:
            yield point
            found += 1
            if found == count:
                return


def contacts(sheet: FormulaSheet) -> list[Point]:
    """Contacts [-a, c] of the body, each with a point x inside and with changes of all loads."""
    return _contacts(sheet.geometry, sheet["pressure"].conditions)


@lru_cache(maxsize=4)
def _contacts(body: Geometry, conditions: tuple[Boolean, ...]) -> list[Point]:
    places = [numeric(kink.position) for kink in body.slope.kinks]

    def draw(rng: random.Random, found: int) -> Point | None:
        point = _parameters(body, rng)
        size = max([abs(place(point)) for place in places], default=mpf(0)) or mpf(1)
        middle = abs(mpf(rng.gauss(0, 1))) * (-1 if found % 2 == 0 else 1)
        half = mpf(2) ** rng.uniform(-2, 2)
        point[a], point[c] = size * (half - middle), size * (half + middle)
        theta = mpmath.pi * mpf(rng.uniform(0.02, 0.98))
        point[x] = size * (middle + half * mpmath.cos(theta))
        point[dQ], point[dsigma] = mpf(rng.uniform(0, 2)), mpf(rng.uniform(-2, 2))
        point[dP], point[dM] = point[dsigma] / 2 + point[dQ] / 4, point[dQ] - point[dsigma] / 4
        point[f] = (1 + point[dQ]) / 4
        return point if holds(conditions, point) else None

    return list(draws(body.name, draw))


def loads(sheet: FormulaSheet, formula: Formula) -> Iterator[Point]:
    """Loads, moments and tilts for which `formula` gives a contact."""

    low, high = sheet.geometry.slope.limits
    missed = 0

    def draw(rng: random.Random, found: int) -> Point | None:
        nonlocal missed
        point = _parameters(sheet.geometry, rng)
        sign = 1 if found % 2 == 0 else -1
        point[P] = mpf(2) ** rng.uniform(-6, 6)
        point[M] = sign * point[P] * mpf(2) ** rng.uniform(-6, 3)
        point[alpha] = sign * mpf(2) ** rng.uniform(-6, 1)
        if missed >= _LEANING:
            point[alpha] = _tilt_between(numeric(low)(point), numeric(high)(point), rng)
        missed = 0 if holds(formula.conditions, point) else missed + 1
        return None if missed else point

    return draws(f"{sheet.geometry.name} {formula.name}", draw)


def _tilt_between(low: mpf, high: mpf, rng: random.Random) -> mpf:
    """A tilt at which a contact exists if the body's slope g' ranges from `low` to `high`."""
    if mpmath.isinf(low) or mpmath.isinf(high):
        beyond = mpf(2) ** rng.uniform(-6, 1)
        return -low - beyond if mpmath.isinf(high) else beyond - high
    return -low - (high - low) * mpf(rng.uniform(0.02, 0.98))


def _parameters(body: Geometry, rng: random.Random) -> Point:
    """Parameters close to typical ones that meet the body's conditions."""
    made = [E_star, *(q.symbol for q in body.parameters)]
    least, around = body.slope.least, {p: mpf(v.p) / v.q for p, v in body.slope.typical.items()}
    return {
        symbol: mpf(2) ** rng.uniform(-1.5, 1.5) * around.get(symbol, 1) + mpf(least.get(symbol, 0))
        for symbol in made
    }


@cache
def numeric(expr: Expr) -> Callable[[Point], mpf]:
    """`expr` as a function of a point, in mpmath; integrals over the contact by quadrature."""
    expr = expr.subs(e, M / P)
    held = sorted(expr.free_symbols, key=str)
    integrals = {found: Dummy("I") for found in sorted(expr.atoms(Integral), key=str)}
    values = [over_contact(found) for found in integrals]
    symbols = [*held, *integrals.values()]
    function = _compiled(symbols, expr.xreplace(integrals), count_ops(expr) > _LONG)

    def at(point: Point) -> mpf:
        given = [point[symbol] for symbol in held]
        return mpf(function(*given, *(value(point) for value in values)))

    return at


def numeric_by_steps(steps: Iterable[tuple[Symbol, Expr]], expr: Expr) -> Callable[[Point], mpf]:
    """`expr` as a function of a point; the symbols it contains are computed one after another."""
    needed: list[tuple[Symbol, Callable[[Point], mpf]]] = []
    wanted = set(expr.free_symbols)
    for symbol, value in reversed([*steps]):
        if symbol in wanted:
            needed.insert(0, (symbol, numeric(value)))
            wanted |= value.free_symbols
    last = numeric(expr)

    def at(point: Point) -> mpf:
        known = dict(point)
        for symbol, value in needed:
            known[symbol] = value(known)
        return last(known)

    return at


@cache
def numeric_along(expr: Expr, variable: Symbol) -> Callable[[Point], Function]:
    """`expr` at a point as a function of one variable, in balls for quadrature.

    Parts without the variable are computed once per point; other terms are collected by the factors
    that contain it.  Not for expressions with branches, because a branch that is not taken may have
    no value.
    """
    fixed: dict[Expr, Symbol] = {}
    moving = _collected(expr.subs(e, M / P), variable, fixed)
    held = sorted(set().union(*(value.free_symbols for value in fixed)), key=str)
    constants = functions_of(held, [*fixed])
    function = function_of([variable, *fixed.values()], moving, shared=True)

    def at(point: Point) -> Function:
        given = [ball(point[symbol]) for symbol in held]
        known: dict[int, Sequence[Ball]] = {}

        def along(place: Ball) -> Ball:
            if ctx.prec not in known:
                known[ctx.prec] = constants(*given)
            return function(place, *known[ctx.prec])

        return along

    return at


def _collected(expr: Expr, variable: Symbol, fixed: dict[Expr, Symbol]) -> Expr:
    """`expr` with a symbol for each part without the variable; `fixed` receives these symbols."""
    if not expr.has(variable):
        return expr if expr.is_Rational else fixed.setdefault(expr, Dummy("C"))
    if expr == variable:
        return expr
    if expr.is_Mul:
        apart, moving = expr.as_independent(variable, as_Add=False)
        factors = [_collected(factor, variable, fixed) for factor in Mul.make_args(moving)]
        return Mul(_collected(apart, variable, fixed), *factors)
    if expr.is_Add:
        terms: dict[Expr, list[Expr]] = {}
        for term in expr.args:
            apart, moving = term.as_independent(variable, as_Add=False)
            terms.setdefault(moving, []).append(apart)
        return Add(
            *(
                _collected(Add(*apart), variable, fixed)
                * (_collected(moving, variable, fixed) if moving.has(variable) else moving)
                for moving, apart in terms.items()
            )
        )
    return expr.func(*(_collected(arg, variable, fixed) for arg in expr.args))


def over_contact(over: Integral) -> Callable[[Point], mpf]:
    """An integral over a part of the contact as a function of a point.

    The variable of integration is the angle of the half circle, so that roots that vanish at the
    edges do no harm.  Nodes are dense at the ends of the part; if a power is infinite there, they
    are concentrated further by t**3/(t**3 + (1 - t)**3).  The integrand is evaluated with so many
    digits that differences next to an end remain accurate.  Rounding cannot move a node out of the
    part, where a power may have no real value.
    """
    variable, low, high = over.limits[0]
    held = sorted(over.free_symbols, key=str)
    fixed = {
        p: Dummy("C") for p in sorted(over.function.atoms(Pow), key=str) if _is_fixed(p, variable)
    }
    taken = [variable, *held, *fixed.values()]
    integrand = function_of(taken, over.function.xreplace(fixed), shared=True)
    constants = functions_of(held, [*fixed])
    power = 3 if has_sharp_power(over.function, variable) else 1
    ends = compiled(held, [low, high], modules="mpmath")
    known: dict[tuple[mpf, ...], mpf] = {}

    def at(point: Point) -> mpf:
        given = tuple(point[symbol] for symbol in held)
        if given not in known:
            with mpmath.workdps(_INSIDE):
                start, end = ends(*given)
            known[given] = integrated(point[a], point[c], start, end, given)
        return known[given]

    def integrated(left: mpf, right: mpf, start: mpf, end: mpf, given: tuple[mpf, ...]) -> mpf:
        if end <= start:
            return mpf(0)
        width, node = _nodes(left, right, start, end, power)
        balls = [ball(value) for value in given]
        with digits(_INSIDE):
            numbers = (*balls, *constants(*balls))

        def along(t: Ball) -> Ball:
            place, weight = node(t)
            return integrand(place, *numbers) * weight

        with mpmath.workdps(_OUTSIDE):
            return power * width * integral(along, [mpf(0), mpf(1)], inside=_INSIDE)

    return at


def _compiled(symbols: list[Symbol], expr: Expr, shared: bool) -> Callable[..., mpf]:
    """`expr` in mpmath; with `shared`, repeated subexpressions are computed once.

    This is not done for expressions with branches, because a branch that is not taken may be
    undefined.
    """
    once = shared and not expr.has(Piecewise)
    return compiled(symbols, expr, modules="mpmath", shared=once)


def _is_fixed(power: Pow, variable: Symbol) -> bool:
    """Whether a power needs a logarithm and is constant over the contact."""
    return not power.has(variable) and not power.exp.is_Rational


@lru_cache(maxsize=128)
def _nodes(
    left: mpf, right: mpf, start: mpf, end: mpf, power: int
) -> tuple[mpf, Callable[[Ball], tuple[Ball, Ball]]]:
    """Width of a part in theta; point and weight for each t in [0, 1], shared by all integrals."""
    with mpmath.workdps(_INSIDE):
        angles = [mpmath.acos(max(-1, min(1, _cosine(p, left, right)))) for p in (end, start)]
    low, high, first, last = map(ball, (*angles, start, end))
    with digits(_INSIDE):
        half, middle = (ball(left) + ball(right)) / 2, (ball(right) - ball(left)) / 2

    @remembered
    def node(t: Ball) -> tuple[Ball, Ball]:
        near, far = t**power, (1 - t) ** power
        theta = (low * far + high * near) / (near + far)
        rate = (t * (1 - t)) ** (power - 1) / (near + far) ** 2
        sine, cosine = theta.sin_cos()
        place = first.max(last.min(middle + half * cosine))
        return place, half * sine * rate

    with mpmath.workdps(_OUTSIDE):
        return angles[1] - angles[0], node


def _cosine(place: mpf, left: mpf, right: mpf) -> mpf:
    """Cosine of the angle of a point in the contact."""
    return (2 * place + left - right) / (left + right)


_LONG = 200
"""Number of operations of a formula above which it pays to look for repeated subexpressions."""

_LEANING = 40
"""Number of failed attempts after which a tilt is drawn between its limits, as some bodies need."""

_INSIDE, _OUTSIDE = 160, 40
"""Digits of an integrand, and digits of the integral."""


def holds(conditions: Iterable[Boolean], point: Point) -> bool:
    """Whether a point meets all conditions."""
    return all(bool(condition.subs(point)) for condition in conditions)


def named(point: Point) -> str:
    """The point as text."""
    return ", ".join(f"{symbol} = {mpmath.nstr(value, 8)}" for symbol, value in point.items())
