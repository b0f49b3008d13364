"""Random states drawn from a formula's assumptions; the same on every machine.

A point gives a number to each symbol.  Contacts are drawn with a > c and a < c in turn, loads with
moments and tilts of both signs in turn; a point that breaks an assumption is drawn again.
"""

import hashlib
import random
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from typing import TypeVar

import mpmath
from mpmath import mpf
from sympy import Expr, Symbol, lambdify
from sympy.logic.boolalg import Boolean

from derive.proof.verdict import POINTS
from derive.sheet import Formula, FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c, dQ, dsigma, e, x

Point = dict[Symbol, mpf]
T = TypeVar("T")


def draws(
    name: str, draw: Callable[[random.Random, int], T | None], count: int = POINTS
) -> Iterator[T]:
    """`count` results of `draw`, which returns None for a point outside the assumptions.

    Gives up after a hundred tries a point; fewer points than asked make the verdict unknown.
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
    """Contacts [-a, c] of the body, with an x inside each and changes of shear and tension."""
    places = [numeric(kink.position) for kink in sheet.geometry.slope.kinks]

    def draw(rng: random.Random, found: int) -> Point | None:
        point = _parameters(sheet, rng)
        size = max([abs(place(point)) for place in places], default=mpf(0)) or mpf(1)
        middle = abs(mpf(rng.gauss(0, 1))) * (-1 if found % 2 == 0 else 1)
        half = mpf(2) ** rng.uniform(-2, 2)
        point[a], point[c] = size * (half - middle), size * (half + middle)
        theta = mpmath.pi * mpf(rng.uniform(0.02, 0.98))
        point[x] = size * (middle + half * mpmath.cos(theta))
        point[dQ], point[dsigma] = mpf(rng.uniform(0, 2)), mpf(rng.uniform(-2, 2))
        return point if holds(sheet["pressure"].conditions, point) else None

    return list(draws(sheet.geometry.name, draw))


def loads(sheet: FormulaSheet, formula: Formula) -> Iterator[Point]:
    """Loads, moments and tilts under which `formula` gives a contact."""

    def draw(rng: random.Random, found: int) -> Point | None:
        point = _parameters(sheet, rng)
        sign = 1 if found % 2 == 0 else -1
        point[P] = mpf(2) ** rng.uniform(-6, 6)
        point[M] = sign * point[P] * mpf(2) ** rng.uniform(-6, 3)
        point[alpha] = sign * mpf(2) ** rng.uniform(-6, 1)
        return point if holds(formula.conditions, point) else None

    return draws(f"{sheet.geometry.name} {formula.name}", draw)


def _parameters(sheet: FormulaSheet, rng: random.Random) -> Point:
    made = [E_star, *(q.symbol for q in sheet.geometry.parameters)]
    return {symbol: mpf(2) ** rng.uniform(-1.5, 1.5) for symbol in made}


@cache
def numeric(expr: Expr) -> Callable[[Point], mpf]:
    """`expr` as a function of a point, in mpmath."""
    expr = expr.subs(e, M / P)
    held = sorted(expr.free_symbols, key=str)
    function = lambdify(held, expr, modules="mpmath")
    return lambda point: mpf(function(*(point[symbol] for symbol in held)))


def holds(conditions: Iterable[Boolean], point: Point) -> bool:
    """Whether a point meets all assumptions."""
    return all(bool(condition.subs(point)) for condition in conditions)


def named(point: Point) -> str:
    """The point in words."""
    return ", ".join(f"{symbol} = {mpmath.nstr(value, 8)}" for symbol, value in point.items())
