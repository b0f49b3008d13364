r"""The defining integrals by quadrature, to any number of digits, without the theory's algebra.

In:  g(x) as the user wrote it, and numbers for its parameters and the contact.
Out: the integrals of theory.equilibrium and theory.pressure.  They are evaluated with
     x = mid + (h/2) cos(theta) on the pieces between kinks, so that every integrand is analytic up
     to the ends of its piece.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise

import mpmath
from mpmath import mpf
from sympy import Expr, Max, Min, Piecewise, Symbol, diff, nan, piecewise_fold, zoo

from derive.body.compiled import compiled
from derive.body.geometry import Geometry
from derive.proof.balls import Ball, ball, digits, function_of
from derive.proof.rule import CROWDED, SMOOTH, Function, integral, remembered
from derive.symbols import x

_LOST = 20
"""Additional digits for a difference divided by a distance, which may lose this many."""


@dataclass(frozen=True)
class Contact:
    """One contact [-a, c] of one body, in numbers; integrands take balls."""

    geometry: Geometry
    values: Mapping[Symbol, mpf]
    a: mpf
    c: mpf
    E_star: mpf

    @cached_property
    def slope(self) -> Function:
        """g'(x) from the original g, not from the pieces that the derivation uses."""
        symbols = sorted(self.values, key=str)
        function = _compiled(_slope_as_given(self.geometry.g), (x, *symbols))
        numbers = [ball(self.values[symbol]) for symbol in symbols]
        return remembered(lambda place: function(place, *numbers))

    @cached_property
    def kinks(self) -> list[mpf]:
        """Kinks inside the contact, from left to right."""
        places = [_number(k.position, self.values) for k in self.geometry.slope.kinks]
        return sorted(p for p in places if -self.a < p < self.c)

    @property
    def h(self) -> mpf:
        """Contact width."""
        return self.a + self.c

    @property
    def mid(self) -> mpf:
        """Midpoint of the contact."""
        return (self.c - self.a) / 2

    @cached_property
    def edges(self) -> tuple[Ball, Ball]:
        """a and c as balls."""
        return ball(self.a), ball(self.c)

    @cached_property
    def at(self) -> Function:
        """The x at the angle theta."""
        left, right = self.edges
        return remembered(lambda theta: ((right - left) + (left + right) * theta.cos()) / 2)

    def angle(self, place: mpf) -> mpf:
        """The angle of a point in the contact."""
        return mpmath.acos((place - self.mid) / (self.h / 2))

    def integral(
        self, integrand: Function, *also: mpf, singular: bool = False, inside: int = 0
    ) -> mpf:
        """int_{-a}^{c} integrand(s)/w(s) ds, split at the kinks and at the points `also`."""
        cuts = sorted({mpf(0), mpmath.pi, *(self.angle(p) for p in (*self.kinks, *also))})
        gentle = self.geometry.slope.is_polynomial and not singular
        method = SMOOTH if gentle else CROWDED
        return integral(lambda theta: integrand(self.at(theta)), cuts, method, inside)

    def outside(self, left: mpf, right: mpf, integrand: Function) -> mpf:
        """int integrand(s) ds over the contact outside [-left, right], where it may contain roots.

        The integrand is evaluated with twice as many digits, so that distances from the ends remain
        accurate.
        """
        total, twice = mpf(0), 2 * mpmath.mp.dps
        for edge, end in ((-self.a, -left), (self.c, right)):
            low, high = min(edge, end), max(edge, end)
            for start, stop in pairwise([low, *(k for k in self.kinks if low < k < high), high]):
                with mpmath.workdps(twice):
                    half, middle = ball((stop - start) / 2), ball((start + stop) / 2)

                def along(theta: Ball, half: Ball = half, middle: Ball = middle) -> Ball:
                    sine, cosine = theta.sin_cos()
                    return half * sine * integrand(middle + half * cosine)

                total += integral(along, [mpf(0), mpmath.pi], inside=twice)
        return total

    @cached_property
    def tilt(self) -> mpf:
        """alpha from I_0 = 0."""
        return -self.integral(self.slope) / mpmath.pi

    @cached_property
    def load(self) -> mpf:
        """(E*/2) I_1."""
        tilt = ball(self.tilt)
        return self.E_star / 2 * self.integral(lambda s: s * (self.slope(s) + tilt))

    @cached_property
    def moment(self) -> mpf:
        """-(E*/2) (I_2 - mid I_1)."""
        tilt, mid = ball(self.tilt), ball(self.mid)
        arm = self.integral(lambda s: s * (s - mid) * (self.slope(s) + tilt))
        return -self.E_star / 2 * arm

    def pressure(self, place: mpf, at_edge: bool = False) -> mpf:
        """p(x), with the singularity subtracted; the integral is split at x unless at an edge."""
        root = mpmath.sqrt((self.a + place) * (self.c - place))
        cuts = [] if at_edge else [place, *self._around(place)]
        inside = mpmath.mp.dps + _LOST
        with digits(inside):
            here = ball(place)
            level = self.slope(here)

        def quotient(s: Ball) -> Ball:
            return (self.slope(s) - level) / (s - here)

        principal = self.integral(quotient, *cuts, inside=inside)
        return self.E_star / (2 * mpmath.pi) * root * principal

    def edge_series(self, side: str) -> tuple[mpf, mpf]:
        """K_N and L_N from p/sqrt(s) at three points so close to the edge that a parabola fits."""
        if side not in self._series:
            with mpmath.workdps(mpmath.mp.dps + 30):
                s = self.h * mpf(10) ** -20
                places = [n * s - self.a if side == "left" else self.c - n * s for n in (1, 2, 3)]
                first, second, third = (
                    self.pressure(place, at_edge=True) / mpmath.sqrt(n * s)
                    for n, place in enumerate(places, start=1)
                )
                rate = (-5 * first + 8 * second - 3 * third) / 2
                self._series[side] = 3 * first - 3 * second + third, rate / s
        return self._series[side]

    @cached_property
    def _series(self) -> dict[str, tuple[mpf, mpf]]:
        return {}

    def _around(self, place: mpf) -> Iterator[mpf]:
        """Points of division around a kink close to `place`, for the kernel 1/(s - place)."""
        for kink in self.kinks:
            distance = abs(place - kink)
            while 0 < distance < self.h:
                yield from (s for s in (kink - distance, kink + distance) if -self.a < s < self.c)
                distance *= 8

    def resultant(self, pressure: Function, weight: Function | None = None) -> mpf:
        """int weight(s) p(s) ds of a given p, which may be logarithmically infinite at a kink."""
        left, right = self.edges

        def integrand(s: Ball) -> Ball:
            force = pressure(s) * ((left + s) * (right - s)).sqrt()
            return weight(s) * force if weight else force

        return self.integral(integrand, singular=True)


@cache
def _slope_as_given(g: Expr) -> Expr:
    """g'(x) by branches; each is differentiated alone if the whole would divide zero by zero."""
    branched = g.replace(Max, _larger).replace(Min, _smaller).rewrite(Piecewise)
    slope = diff(branched, x)
    if slope.has(zoo, nan):
        folded = piecewise_fold(branched)
        slope = Piecewise(*((diff(value, x), holds) for value, holds in folded.args))
    return slope


def _larger(first: Expr, *others: Expr) -> Expr:
    """Max by branches; SymPy may never finish comparing with values other than zero."""
    if not others:
        return first
    second = _larger(*others)
    return Piecewise((first, first - second >= 0), (second, True))


def _smaller(*args: Expr) -> Expr:
    return -_larger(*(-arg for arg in args))


@cache
def _compiled(expr: Expr, symbols: tuple[Symbol, ...]) -> Function:
    return function_of(symbols, expr)


def _number(expr: Expr, values: Mapping[Symbol, mpf]) -> mpf:
    symbols = sorted(values, key=str)
    function = compiled(symbols, expr, modules="mpmath")
    return mpf(function(*(values[symbol] for symbol in symbols)))
