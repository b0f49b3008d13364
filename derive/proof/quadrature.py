"""The defining integrals of a contact, by quadrature of g(x) as the user wrote it.

In:  g'(x), and numbers for the parameters and the contact.
Out: the integrals of theory.equilibrium and theory.pressure, before anything was done with them.
"""

from functools import cache, cached_property

import mpmath
from mpmath import mpf
from sympy import Expr, Integral, Max, Min, Piecewise, Symbol, diff, nan, piecewise_fold, zoo

from derive.proof.balls import digits, number
from derive.proof.values import Numbers, Undecided, enclosed
from derive.symbols import E_star, a, alpha, c, mid, w, x

_s = Symbol("xi", real=True)
"""The variable of integration."""


class Contact:
    """One contact [-a, c] of one body, in numbers; a value that is not obtained is NaN."""

    def __init__(self, slope: Expr, numbers: Numbers) -> None:
        self.numbers, self.at_x, self.slope = numbers, slope, slope.subs(x, _s)
        self.rise = diff(slope, x)
        self.a, self.c, self.E_star = (numbers[symbol] for symbol in (a, c, E_star))
        self.h = self.a + self.c

    def _over_root(self, integrand: Expr) -> mpf:
        """int_{-a}^{c} integrand/w ds."""
        try:
            with digits(3 * mpmath.mp.dps):
                integral = Integral(integrand / w.subs(x, _s), (_s, -a, c))
                return number(enclosed(integral, self.numbers, twice=False))
        except Undecided:
            return mpf("nan")

    @cached_property
    def tilt(self) -> mpf:
        """alpha from I_0 = 0."""
        return -self._over_root(self.slope) / mpmath.pi

    @property
    def load(self) -> mpf:
        """(E*/2) I_1."""
        return self.E_star / 2 * self._over_root(_s * self._tilted)

    @property
    def moment(self) -> mpf:
        """-(E*/2) (I_2 - mid I_1)."""
        return -self.E_star / 2 * self._over_root(_s * (_s - mid) * self._tilted)

    @property
    def _tilted(self) -> Expr:
        """g' + alpha."""
        self.numbers = {**self.numbers, alpha: self.tilt}
        return self.slope + alpha

    @property
    def pressure(self) -> mpf:
        """p at x."""
        weight = mpmath.sqrt((self.a + self.numbers[x]) * (self.c - self.numbers[x]))
        return self.E_star / (2 * mpmath.pi) * weight * self._principal(x)

    def K_N(self, side: str) -> mpf:
        """The limit of p/sqrt(s) at an edge, s being the distance from it."""
        edge = -a if side == "left" else c
        return self.E_star / (2 * mpmath.pi) * mpmath.sqrt(self.h) * self._principal(edge)

    def L_N(self, side: str) -> mpf:
        """The limit of (p/sqrt(s) - K_N)/s; p = (E*/2 pi) sqrt(s) sqrt(h - s) F(x)."""
        edge, inward = (-a, 1) if side == "left" else (c, -1)
        distance, rise = _s - edge, self.rise.subs(x, edge)
        bent = (self._from(edge) - rise * distance) / distance**2
        rate, principal = inward * self._over_root(bent), self._principal(edge)
        growth = mpmath.sqrt(self.h) * rate - principal / (2 * mpmath.sqrt(self.h))
        return self.E_star / (2 * mpmath.pi) * growth

    def _principal(self, place: Expr) -> mpf:
        """F(x) = PV int g'(s)/(w(s) (s - x)) ds, with the singularity subtracted."""
        return self._over_root(self._from(place) / (_s - place))

    def _from(self, place: Expr) -> Expr:
        """g' less its value at a place."""
        return self.slope - self.at_x.subs(x, place)


@cache
def slope_as_given(g: Expr) -> Expr:
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
