r"""Tilt, load and moment of the contact [-a, c].

I_0 = 0 keeps the pressure bounded at both edges.  It is linear in the tilt, so that alpha is given
explicitly.  I_1 - mid I_0 does not contain the tilt, so that the load does not need it.  The moment
needs the tilt once.
"""

from sympy import Expr, pi

from derive.symbols import E_star, mid
from derive.theory.algebra import tidy
from derive.theory.frame import Frame
from derive.theory.moments import full_moment, slope_moment


def tilt(frame: Frame) -> Expr:
    """alpha(a, c) from I_0 = 0."""
    return tidy(-slope_moment(0, frame) / pi, frame)


def load(frame: Frame) -> Expr:
    """P(a, c) = (E*/2) (I_1 - mid I_0)."""
    return tidy(E_star / 2 * (slope_moment(1, frame) - mid * slope_moment(0, frame)), frame)


def moment(frame: Frame) -> Expr:
    """M(a, c) = -(E*/2) (I_2 - mid I_1), including the tilt."""
    alpha = -slope_moment(0, frame) / pi
    first, second = (slope_moment(k, frame) + alpha * full_moment(k) for k in (1, 2))
    return tidy(-E_star / 2 * (second - mid * first), frame)
