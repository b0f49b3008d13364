"""The defining integrals of a contact, by quadrature of g(x) as the user wrote it.

In:  g(x), and numbers for the parameters and the contact.
Out: the integrals of theory.equilibrium and theory.pressure, before anything was done with them.
"""

from functools import cache

import mpmath
from mpmath import mpf
from sympy import Expr, Integral, Max, Min, Piecewise, Symbol, diff, nan, piecewise_fold, zoo

from derive.proof.balls import digits, number
from derive.proof.values import Numbers, Undecided, enclosed
from derive.symbols import E_star, a, alpha, c, mid, w, x

_s = Symbol("xi", real=True)
"""The variable of integration."""


@cache
def _integrals(g: Expr) -> dict[str, Expr]:
    """The integrals over a contact, which are divided by w; I_1 and I_2 contain the tilt.

    PV int g'(s)/(w(s) (s - x)) ds is taken with its singularity subtracted: F(x).  Its rate of
    change at an edge is F' there.
    """
    slope = slope_as_given(g)
    at = slope.subs(x, _s)
    integrands = {
        "I_0": at,
        "I_1": _s * (at + alpha),
        "I_2 - mid I_1": _s * (_s - mid) * (at + alpha),
        "F": (at - slope) / (_s - x),
    }
    for side, edge in (("left", -a), ("right", c)):
        rise, distance = at - slope.subs(x, edge), _s - edge
        bent = rise - diff(slope, x).subs(x, edge) * distance
        integrands |= {f"F {side}": rise / distance, f"F' {side}": bent / distance**2}
    root = w.subs(x, _s)
    return {name: Integral(each / root, (_s, -a, c)) for name, each in integrands.items()}


class Contact:
    """One contact [-a, c] of one body, in numbers; a value that is not obtained is NaN."""

    def __init__(self, g: Expr, numbers: Numbers) -> None:
        self.g, self.numbers = g, numbers
        self.a, self.c, self.E_star = (numbers[symbol] for symbol in (a, c, E_star))
        self.h = self.a + self.c

    def _integral(self, name: str, numbers: Numbers) -> mpf:
        try:
            with digits(3 * mpmath.mp.dps):
                return number(enclosed(_integrals(self.g)[name], numbers, twice=False))
        except Undecided:
            return mpf("nan")

    @property
    def tilt(self) -> mpf:
        """alpha from I_0 = 0."""
        return -self._integral("I_0", self.numbers) / mpmath.pi

    @property
    def load(self) -> mpf:
        """(E*/2) I_1."""
        return self.E_star / 2 * self._integral("I_1", self._tilted)

    @property
    def moment(self) -> mpf:
        """-(E*/2) (I_2 - mid I_1)."""
        return -self.E_star / 2 * self._integral("I_2 - mid I_1", self._tilted)

    @property
    def _tilted(self) -> Numbers:
        return {**self.numbers, alpha: self.tilt}

    @property
    def pressure(self) -> mpf:
        """p at x."""
        weight = mpmath.sqrt((self.a + self.numbers[x]) * (self.c - self.numbers[x]))
        return self.E_star / (2 * mpmath.pi) * weight * self._integral("F", self.numbers)

    def K_N(self, side: str) -> mpf:
        """The limit of p/sqrt(s) at an edge, s being the distance from it."""
        principal = self._integral(f"F {side}", self.numbers)
        return self.E_star / (2 * mpmath.pi) * mpmath.sqrt(self.h) * principal

    def L_N(self, side: str) -> mpf:
        """The limit of (p/sqrt(s) - K_N)/s; p = (E*/2 pi) sqrt(s) sqrt(h - s) F(x)."""
        rate = self._integral(f"F' {side}", self.numbers) * (1 if side == "left" else -1)
        principal = self._integral(f"F {side}", self.numbers)
        growth = mpmath.sqrt(self.h) * rate - principal / (2 * mpmath.sqrt(self.h))
        return self.E_star / (2 * mpmath.pi) * growth


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
