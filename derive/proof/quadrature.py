"""The defining integrals by quadrature, to any number of digits, without the theory's algebra.

In:  g(x) as the user wrote it, and numbers for its parameters and the contact.
Out: the integrals of theory.equilibrium and theory.pressure, on the pieces between kinks.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, cached_property

import mpmath
from mpmath import mpf
from sympy import Expr, Max, Min, Piecewise, Symbol, diff, nan, piecewise_fold, zoo

from derive.body.geometry import Geometry
from derive.proof.balls import Ball, Function, ball, number, root
from derive.proof.rule import integral, remembered
from derive.proof.values import evaluated, program
from derive.symbols import x


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
        return remembered(program(_slope_as_given(self.geometry.g), x).function(self.values))

    @cached_property
    def kinks(self) -> list[mpf]:
        """Kinks inside the contact, from left to right."""
        places = [evaluated(k.position, self.values) for k in self.geometry.slope.kinks]
        return sorted(p for p in places if -self.a < p < self.c)

    @property
    def h(self) -> mpf:
        """Contact width."""
        return self.a + self.c

    @property
    def mid(self) -> mpf:
        """Midpoint of the contact."""
        return (self.c - self.a) / 2

    def root(self, s: Ball) -> Ball:
        """w(s) = sqrt((a + s) (c - s))."""
        return root((ball(self.a) + s) * (ball(self.c) - s))

    def integral(self, integrand: Function, *also: mpf) -> mpf:
        """int_{-a}^{c} integrand(s) ds, cut at the kinks and at the points `also`."""
        return number(integral(integrand, sorted({-self.a, *self.kinks, *also, self.c})))

    def over_root(self, integrand: Function, *also: mpf) -> mpf:
        """int_{-a}^{c} integrand(s)/w(s) ds, likewise."""
        return self.integral(lambda s: integrand(s) / self.root(s), *also)

    def outside(self, left: mpf, right: mpf, integrand: Function) -> mpf:
        """int integrand(s) ds over the contact outside [-left, right]."""
        total = mpf(0)
        for edge, end in ((-self.a, -left), (self.c, right)):
            low, high = min(edge, end), max(edge, end)
            cuts = [low, *(k for k in self.kinks if low < k < high), high]
            total += number(integral(integrand, cuts))
        return total

    @cached_property
    def tilt(self) -> mpf:
        """alpha from I_0 = 0."""
        return -self.over_root(self.slope) / mpmath.pi

    @cached_property
    def load(self) -> mpf:
        """(E*/2) I_1."""
        tilt = ball(self.tilt)
        return self.E_star / 2 * self.over_root(lambda s: s * (self.slope(s) + tilt))

    @cached_property
    def moment(self) -> mpf:
        """-(E*/2) (I_2 - mid I_1)."""
        tilt, mid = ball(self.tilt), ball(self.mid)
        arm = self.over_root(lambda s: s * (s - mid) * (self.slope(s) + tilt))
        return -self.E_star / 2 * arm

    def pressure(self, place: mpf, at_edge: bool = False) -> mpf:
        """p(x), with the singularity subtracted; the integral is cut at x unless at an edge."""
        weight = mpmath.sqrt((self.a + place) * (self.c - place))
        cuts = [] if at_edge else [place, *self._around(place)]
        here = ball(place)

        def quotient(s: Ball) -> Ball:
            return (self.slope(s) - self.slope(here)) / (s - here)

        return self.E_star / (2 * mpmath.pi) * weight * self.over_root(quotient, *cuts)

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
