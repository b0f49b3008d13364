r"""A fully stuck contact: how the shear changes when Q and sigma do.

Similar bodies and no slip anywhere in a fixed contact: (1/pi) PV int dq(xi)/(x - xi) dxi = dsigma/4
and int dq = dQ.  With t = (x - mid)/(h/2) the two are met by

    dq(x) = [dQ/pi - (dsigma/4)(x - mid)] / sqrt((a + x)(c - x)),

whatever the body.  K_T is the coefficient of 1/sqrt(s) at an edge.
"""

from sympy import Expr, factor, pi, sqrt

from derive.symbols import dQ, dsigma, h, mid, w, x
from derive.theory.edges import Edge


def full_stick_change() -> Expr:
    """dq(x) in full stick."""
    return (dQ / pi - dsigma / 4 * (x - mid)) / w


def K_T(edge: Edge) -> Expr:
    """Coefficient of 1/sqrt(s) of the full-stick change at `edge`, signed."""
    return (dQ / pi - dsigma / 4 * factor(edge.position - mid)) / sqrt(h)
