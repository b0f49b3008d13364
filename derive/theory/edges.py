r"""The pressure next to an edge: K_N, L_N and the further terms of its series.

Let s be the distance from the edge, inward, so that w = sqrt(s) sqrt(h - s).  From

    dL_j/dx = -w_j / (2 (x - x_j) w(x))

each logarithm is the integral of a binomial series, and no limit is needed.
"""

from enum import Enum
from functools import lru_cache

from sympy import Expr, Integer, Poly, Rational, S, binomial, cancel, pi, sqrt

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
    smooth = _taylor(smooth_part(frame).subs(x, at), terms)
    total = _product(smooth, _root_series(Rational(1, 2), terms), terms)
    for kink in frame.kinks:
        jump = _taylor(kink.kink.jump.subs(x, at), terms)
        logarithm = _logarithm_series(kink, edge, terms)
        sense = kink.kink.side * 2 / pi
        for i, term in enumerate(_product(jump, logarithm, terms)):
            total[i] += sense * term
    if not frame.is_long:
        total = [cancel(term) for term in total]
    return [tidy(E_star / 2 * sqrt(h) * term, frame) for term in total]


def _taylor(polynomial: Expr, terms: int) -> list[Expr]:
    powers = Poly(polynomial, s)
    return [powers.nth(n) for n in range(terms)]


def _product(first: list[Expr], second: list[Expr], terms: int) -> list[Expr]:
    return [sum((first[i] * second[n - i] for i in range(n + 1)), S.Zero) for n in range(terms)]


def _root_series(power: Expr, terms: int) -> list[Expr]:
    """(1 - s/h)**power."""
    return [binomial(power, n) * (-1 / h) ** n for n in range(terms)]


def _logarithm_series(kink: KinkFrame, edge: Edge, terms: int) -> list[Expr]:
    """L_j / (sqrt(h) sqrt(s)): int_0^s w_j / (2 (d - t) sqrt(t) sqrt(h - t)) dt.

    d is the distance from the edge to the kink.
    """
    distance = kink.right if edge is Edge.RIGHT else kink.left
    geometric = [distance ** -(n + 1) for n in range(terms)]
    integrand = _product(geometric, _root_series(Rational(-1, 2), terms), terms)
    return [
        kink.w / (2 * h) * term / (Integer(n) + Rational(1, 2)) for n, term in enumerate(integrand)
    ]
