r"""p(x) inside the contact.

p(x) = (E*/2 pi) w(x) int (g'(s) - g'(x)) / ((s - x) w(s)) ds.  Dividing each polynomial by (s - x)
leaves moments, which are collected in R(x), and one principal value for each kink,

    w(x) PV int_{x_j}^{c} ds / ((s - x) w(s)) = 2 L_j(x),

so that p(x) = (E*/2) [ w(x) R(x) + (2/pi) sum_j side_j D_j(x) L_j(x) ], where D_j is the jump.
"""

from functools import lru_cache

from sympy import Expr, Poly, S, Symbol, cancel, factor, pi

from derive.symbols import E_star, w, x
from derive.theory.frame import Frame
from derive.theory.moments import weighted

_at = Symbol("x_at", real=True)


@lru_cache(maxsize=16)
def smooth_part(frame: Frame) -> Expr:
    """R(x), a polynomial in x whose coefficients contain the kinks' angles and roots."""
    total = _divided(frame.slope.base, None)
    for kink in frame.kinks:
        total += _divided(kink.kink.jump, kink)
    return factor(total / pi)


def _divided(polynomial: Expr, kink: object) -> Expr:
    """int (G(s) - G(x)) / ((s - x) w(s)) ds for the polynomial G."""
    quotient = Poly(cancel((polynomial - polynomial.subs(x, _at)) / (x - _at)), x)
    return weighted(quotient.as_expr(), kink).subs(_at, x)  # type: ignore[arg-type]


def logarithmic_part(frame: Frame) -> Expr:
    """sum_j side_j D_j(x) L_j(x)."""
    return sum((k.kink.side * factor(k.kink.jump) * k.L for k in frame.kinks), S.Zero)


def pressure(frame: Frame) -> Expr:
    """p(x) for -a < x < c."""
    smooth, logarithms = smooth_part(frame), logarithmic_part(frame)
    return E_star / 2 * w * smooth + E_star / pi * logarithms
