"""The functions of one body in many digits, by what defines them.

Where g'(x) is a polynomial on pieces they are the sheet's formulas, which are proven; else the
defining integrals, from g'(x) alone and in no form that the program shares:

    alpha = -mean g',  P = (pi E*/2) mean (s - mid) g',
    p(x) = (E*/2) w(x) mean (g'(s) - g'(x))/(s - x)

and so on, mean that over the half-circle s = mid + (h/2) cos(theta).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache

import mpmath
from mpmath import mpf
from sympy import diff, powsimp

from derive.proof.balls import Ball, ball, number
from derive.proof.points import Point, numeric_along
from derive.proof.rule import remembered
from derive.symbols import x
from tests.accuracy.quadrature import DIFFERENCES, SECOND_DIFFERENCES, over_contact
from tests.accuracy.reference import function_of as in_mpmath
from tests.accuracy.reference import sheet_of

Formula = Callable[..., mpf]
"""By keywords; what it does not hold is left aside."""

Given = Mapping[str, mpf]


@cache
def formula(body: str, name: str) -> Formula:
    """One formula of a body's sheet."""
    sheet = sheet_of(body)
    if sheet.geometry.slope.is_polynomial:
        names, function = in_mpmath(sheet.flat(name))
        return lambda **given: mpmath.re(function(*(given[n] for n in names)))
    of = _INTEGRALS[name]
    return lambda **given: of(_Slope.of(body, given), given)


@cache
def _pressure_along(body: str) -> Callable[..., Callable[[Ball], Ball]]:
    expr = sheet_of(body).flat("pressure")
    along, held = numeric_along(expr, x), expr.free_symbols - {x}
    return lambda given: along({s: given[str(s)] for s in held})


def pressure_along(body: str, given: Given) -> Callable[[Ball], Ball]:
    """The pressure of a body at a place, in balls."""
    if sheet_of(body).geometry.slope.is_polynomial:
        return _pressure_along(body)(given)
    slope = _Slope.of(body, given)
    return lambda s: ball(_pressure(slope, {**given, "x": number(s)}))


def kinks_of(body: str, given: Given) -> list[mpf]:
    """Where a body's kinks are."""
    places = [in_mpmath(kink.position) for kink in sheet_of(body).geometry.slope.kinks]
    return [mpf(place(*(given[n] for n in names))) for names, place in places]


# ------------------------------------------------------------------ bodies that are integrated


@dataclass(frozen=True)
class _Slope:
    """g' and g'' of a body in balls, at its parameters."""

    body: str
    parameters: tuple[mpf, ...]

    @staticmethod
    def of(body: str, given: Given) -> "_Slope":
        """At what is given."""
        names = (q.name for q in sheet_of(body).geometry.parameters)
        return _Slope(body, tuple(mpf(given[n]) for n in names))

    @property
    def kinks(self) -> list[mpf]:
        """Where they are not smooth."""
        names = (q.name for q in sheet_of(self.body).geometry.parameters)
        return kinks_of(self.body, dict(zip(names, self.parameters, strict=True)))

    def derivative(self, order: int) -> Callable[[Ball], Ball]:
        """Of g; order 1 or 2."""
        symbols = (q.symbol for q in sheet_of(self.body).geometry.parameters)
        point = dict(zip(symbols, self.parameters, strict=True))
        pieces = [along(point) for along in _derivatives(self.body, order)]
        return lambda s: pieces[0 if s < 0 else -1](s)


@cache
def _derivatives(body: str, order: int) -> list[Callable[[Point], Callable[[Ball], Ball]]]:
    """Piece by piece; there are one or two, that meet at 0."""
    pieces = sheet_of(body).geometry.slope.pieces
    return [numeric_along(powsimp(diff(piece.profile, x, order)), x) for piece in pieces]


@lru_cache(maxsize=1000)
def _moments(slope: _Slope, a: mpf, c: mpf, count: int) -> list[mpf]:
    """Means of g', (s - mid) g' and s (s - mid) g' over the half-circle."""
    rise, middle = slope.derivative(1), ball((c - a) / 2)

    def values(s: Ball, _: Ball) -> list[Ball]:
        here, arm = rise(s), s - middle
        return [here, here * arm, here * arm * s]

    return [v / mpmath.pi for v in over_contact(values, a, c, slope.kinks, count)]


@lru_cache(maxsize=1000)
def _quotient(slope: _Slope, a: mpf, c: mpf, place: mpf, count: int) -> mpf:
    """Mean of (g'(s) - g'(x))/(s - x)."""
    rise, at = slope.derivative(1), ball(place)
    here = remembered(lambda _: rise(at))

    def values(s: Ball, away: Ball) -> list[Ball]:
        return [(rise(s) - here(at)) / away]

    found = over_contact(values, a, c, slope.kinks, count, place, DIFFERENCES)
    return found[0] / mpmath.pi


@lru_cache(maxsize=1000)
def _rate(slope: _Slope, a: mpf, c: mpf, place: mpf, count: int) -> mpf:
    """Its derivative by x."""
    rise, at = slope.derivative(1), ball(place)
    bend = slope.derivative(2)
    here = remembered(lambda _: (rise(at), bend(at)))

    def values(s: Ball, away: Ball) -> list[Ball]:
        risen, bent = here(at)
        return [(rise(s) - risen - bent * away) / away**2]

    found = over_contact(values, a, c, slope.kinks, count, place, SECOND_DIFFERENCES)
    return found[0] / mpmath.pi


def _at_edge(sense: int, order: int) -> Callable[[_Slope, Given], mpf]:
    """K_N (order 0) or L_N (1) at the left (-1) or the right edge: p/sqrt(s), expanded in s."""

    def of(slope: _Slope, given: Given) -> mpf:
        a, c = given["a"], given["c"]
        at = slope, a, c, c if sense > 0 else -a, mpmath.mp.dps
        scale, value = given["E_star"] / 2 * mpmath.sqrt(a + c), _quotient(*at)
        return scale * (-value / (2 * (a + c)) - sense * _rate(*at) if order else value)

    return of


def _tilt(slope: _Slope, given: Given) -> mpf:
    return -_moments(slope, given["a"], given["c"], mpmath.mp.dps)[0]


def _load(slope: _Slope, given: Given) -> mpf:
    arm = _moments(slope, given["a"], given["c"], mpmath.mp.dps)[1]
    return mpmath.pi * given["E_star"] / 2 * arm


def _moment(slope: _Slope, given: Given) -> mpf:
    a, c = given["a"], given["c"]
    level, _, arm = _moments(slope, a, c, mpmath.mp.dps)
    return -mpmath.pi * given["E_star"] / 2 * (arm - level * (a + c) ** 2 / 8)


def _pressure(slope: _Slope, given: Given) -> mpf:
    a, c, place = given["a"], given["c"], given["x"]
    value = _quotient(slope, a, c, place, mpmath.mp.dps)
    return given["E_star"] / 2 * mpmath.sqrt((a + place) * (c - place)) * value


_INTEGRALS: dict[str, Callable[[_Slope, Given], mpf]] = {
    "tilt": _tilt,
    "load": _load,
    "moment": _moment,
    "pressure": _pressure,
    "K_N_left": _at_edge(-1, 0),
    "K_N_right": _at_edge(1, 0),
    "L_N_left": _at_edge(-1, 1),
    "L_N_right": _at_edge(1, 1),
}
