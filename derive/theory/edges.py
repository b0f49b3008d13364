r"""The pressure next to an edge: K_N, L_N and the further terms of its series.

Let s be the distance from the edge, inward, so that w = sqrt(s) sqrt(h - s).  From

    dL_j/dx = -w_j / (2 (x - x_j) w(x))

each logarithm is the integral of a binomial series, and no limit is needed.
"""

from enum import Enum
from functools import lru_cache

from sympy import Add, Expr, Rational, binomial, cancel, expand, pi, sqrt

from derive.symbols import E_star, a, c, h, s, x
from derive.theory.algebra import tidy
from derive.theory.equilibrium import load, moment, tilt
from derive.theory.frame import Frame, KinkFrame
from derive.theory.pressure import pressure, smooth_part


class Edge(Enum):
    """An edge of the contact: its position, and the inward direction."""

    LEFT = (-a, 1)
    RIGHT = (c, -1)

    @property
    def position(self) -> Expr:
        """x of the edge."""
        return self.value[0]

    @property
    def inward(self) -> int:
        """+1 if inward is to the right, -1 if it is to the left."""
        return int(self.value[1])


def contact_formula(frame: Frame, name: str) -> Expr:
    """Tilt, load, moment, pressure, or a coefficient such as K_N_left, if g' is a polynomial."""
    for edge in Edge:
        names = [f"{stem}_{edge.name.lower()}" for stem in ("K_N", "L_N")]
        if name in names:
            return pressure_series(frame, edge, 2)[names.index(name)]
    theory = {"pressure": pressure, "tilt": tilt, "load": load, "moment": moment}
    return theory[name](frame)


@lru_cache(maxsize=16)
def pressure_series(frame: Frame, edge: Edge, terms: int) -> list[Expr]:
    """[K_N, L_N, ...], where p = sqrt(s) (K_N + L_N s + ...) at a distance s from `edge`."""
    at = edge.position + edge.inward * s
    total = smooth_part(frame).subs(x, at) * _root_series(Rational(1, 2), terms)
    for kink in frame.kinks:
        sense = kink.kink.side * 2 / pi
        total += sense * kink.kink.jump.subs(x, at) * _logarithm_series(kink, edge, terms)
    found = [expand(total).coeff(s, n) for n in range(terms)]
    if not frame.is_long:
        found = [cancel(term) for term in found]
    return [tidy(E_star / 2 * sqrt(h) * term, frame) for term in found]


def _root_series(power: Expr, terms: int) -> Expr:
    """(1 - s/h)**power."""
    return Add(*(binomial(power, n) * (-s / h) ** n for n in range(terms)))


def _logarithm_series(kink: KinkFrame, edge: Edge, terms: int) -> Expr:
    """L_j / (sqrt(h) sqrt(s)): int_0^s w_j / (2 (d - t) sqrt(t) sqrt(h - t)) dt.

    d is the distance from the edge to the kink.
    """
    distance = kink.right if edge is Edge.RIGHT else kink.left
    geometric = Add(*(s**n / distance ** (n + 1) for n in range(terms)))
    integrand = expand(geometric * _root_series(Rational(-1, 2), terms))
    powers = (integrand.coeff(s, n) * s**n / (n + Rational(1, 2)) for n in range(terms))
    return kink.w / (2 * h) * Add(*powers)
