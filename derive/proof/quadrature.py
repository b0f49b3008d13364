"""The defining integrals by quadrature, to any number of digits, without the theory's algebra.

In:  g(x) as the user wrote it, and numbers for its parameters and the contact.
Out: the integrals of theory.equilibrium and theory.pressure, on the pieces between kinks.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
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
    _known: dict[mpf, mpf] = field(default_factory=dict)

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

    @cached_property
    def root(self) -> Function:
        """w(s) = sqrt((a + s) (c - s))."""
        left, right = ball(self.a), ball(self.c)
        return remembered(lambda s: root((left + s) * (right - s)))

    def integral(self, integrand: Function, low: mpf, high: mpf, *also: mpf) -> mpf:
        """int integrand(s) ds from `low` to `high`, cut at the kinks and at the points `also`."""
        kinks = [kink for kink in self.kinks if low < kink < high]
        return number(integral(integrand, sorted({low, *kinks, *also, high})))

    def over_root(self, integrand: Function, *also: mpf) -> mpf:
        """int_{-a}^{c} integrand(s)/w(s) ds, likewise."""
        return self.integral(lambda s: integrand(s) / self.root(s), -self.a, self.c, *also)

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

    def pressure(self, place: mpf) -> mpf:
        """p(x)."""
        weight = mpmath.sqrt((self.a + place) * (self.c - place))
        return self.E_star / (2 * mpmath.pi) * weight * self._principal(place)

    def K_N(self, side: str) -> mpf:
        """The limit of p/sqrt(s) at an edge, s being the distance from it."""
        edge, _ = self._edge(side)
        return self.E_star / (2 * mpmath.pi) * mpmath.sqrt(self.h) * self._principal(edge)

    def L_N(self, side: str) -> mpf:
        """The limit of (p/sqrt(s) - K_N)/s; p = (E*/2 pi) sqrt(s) sqrt(h - s) F(x)."""
        edge, inward = self._edge(side)
        rate = inward * self._principal_rate(edge)
        growth = mpmath.sqrt(self.h) * rate - self._principal(edge) / (2 * mpmath.sqrt(self.h))
        return self.E_star / (2 * mpmath.pi) * growth

    def _edge(self, side: str) -> tuple[mpf, int]:
        """The place of an edge, and the sign of the direction into the contact."""
        return (-self.a, 1) if side == "left" else (self.c, -1)

    def _principal(self, place: mpf) -> mpf:
        """F(x) = PV int g'(s)/(w(s) (s - x)) ds, with the singularity subtracted."""
        if place not in self._known:
            here = ball(place)

            def quotient(s: Ball) -> Ball:
                return (self.slope(s) - self.slope(here)) / (s - here)

            self._known[place] = self.over_root(quotient)
        return self._known[place]

    def _principal_rate(self, edge: mpf) -> mpf:
        """F'(x) at an edge; a cut between the edge and the next kink keeps its digits."""
        here = ball(edge)
        slope = _slope_as_given(self.geometry.g)
        curvature = remembered(program(diff(slope, x), x).function(self.values))

        def quotient(s: Ball) -> Ball:
            distance = s - here
            rest = self.slope(s) - self.slope(here) - curvature(here) * distance
            return rest / (distance * distance)

        other = min([-self.a, *self.kinks, self.c], key=lambda k: abs(k - edge) or self.h)
        return self.over_root(quotient, (edge + other) / 2)


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
