"""Random states that meet a formula's assumptions; they are the same on every machine.

A point assigns a number to each symbol.  Contacts are drawn alternately with a > c and a < c, and
loads alternately with moments and tilts of both signs if the body has such contacts.  A point that
violates an assumption is drawn again.
"""

import hashlib
import random
from collections.abc import Callable, Iterable, Iterator
from functools import cache, lru_cache

import mpmath
from mpmath import mpf
from sympy import Expr, Symbol
from sympy.logic.boolalg import Boolean

from derive.body.geometry import Geometry
from derive.proof.balls import digits
from derive.proof.values import Defined, Undefined, evaluated, program
from derive.proof.verdict import POINTS
from derive.sheet.formulas import Formula, FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c, dM, dP, dQ, dsigma, e, f, x

Point = dict[Symbol, mpf]


def _draws(name: str, draw: Callable[[random.Random, int], Point | None]) -> Iterator[Point]:
    """Yield POINTS results of `draw`, which returns None for a point outside the assumptions.

    The drawing stops after a hundred attempts per point.  With fewer points, the verdict is
    unknown.
    """
    digest = hashlib.sha256(name.encode()).digest()
    rng = random.Random(int.from_bytes(digest[:8], "big"))
    found = 0
    for _ in range(100 * POINTS):
        point = draw(rng, found)
        if point is not None:
            yield point
            found += 1
            if found == POINTS:
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

    return list(_draws(body.name, draw))


def loads(sheet: FormulaSheet, formula: Formula) -> Iterator[Point]:
    """Loads, moments and tilts for which `formula` gives a contact.

    A tilt is drawn between the slopes of straight flanks, which may be as flat as they like.
    """

    low, high = sheet.geometry.slope.limits

    def draw(rng: random.Random, found: int) -> Point | None:
        point = _parameters(sheet.geometry, rng)
        sign = 1 if found % 2 == 0 else -1
        point[P] = mpf(2) ** rng.uniform(-6, 6)
        point[M] = sign * point[P] * mpf(2) ** rng.uniform(-6, 3)
        point[alpha] = sign * mpf(2) ** rng.uniform(-6, 1)
        if (high - low).is_finite:
            least, most = numeric(low)(point), numeric(high)(point)
            point[alpha] = -least - (most - least) * mpf(rng.uniform(0.02, 0.98))
        return point if holds(formula.conditions, point) else None

    return _draws(f"{sheet.geometry.name} {formula.name}", draw)


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
    """`expr` as a function of a point, to the working digits of mpmath; NaN if it is not real."""
    expr = expr.subs(e, M / P)
    if expr.is_infinite:
        return lambda point: mpmath.inf * (1 if expr.is_extended_positive else -1)

    def at(point: Point) -> mpf:
        try:
            found = evaluated(expr, point, twice=False)
        except Undefined:
            return mpf("nan")
        return found if isinstance(found, mpf) else mpf("nan")

    return at


def numeric_by_steps(steps: Iterable[tuple[Symbol, Expr]], expr: Expr) -> Callable[[Point], mpf]:
    """`expr` as a function of a point; the symbols it contains are computed by the steps."""
    definitions, last = {e: M / P, **dict(steps)}, numeric(expr)
    return lambda point: last(Defined(point, definitions))


def holds(conditions: Iterable[Boolean], point: Point) -> bool:
    """Whether a point meets all conditions."""
    with digits(mpmath.mp.dps):
        return all(program(condition)(point) for condition in conditions)


def named(point: Point) -> str:
    """The point as text."""
    return ", ".join(f"{symbol} = {mpmath.nstr(value, 8)}" for symbol, value in point.items())
