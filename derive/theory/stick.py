r"""Stick: the change in the shear traction where nothing slips, and the permanent stick zone.

For similar bodies, (1/pi) PV int dq(xi)/(x - xi) dxi = dsigma/4 where nothing slips, and
int dq = dQ.

Full stick.  In a fixed contact, for any body,

    dq(x) = [dQ/pi - (dsigma/4)(x - mid)] / w = K_T s**(-1/2) + L_T s**(1/2) + ...

at a distance s from an edge.  When all loads change by small amounts, an edge moves by dedge, with
K_N dedge = 2 lead/(pi sqrt(h)), and the shear traction behind it is 2 K_T sqrt(s)/dedge.  Nothing
slips as long as this is below f K_N sqrt(s), which means |pull| <= f |lead| with
pull = pi sqrt(h) K_T.

Slip at both edges leaves dq = kappa f (p1 + p2) outside [-m, n].  dq is bounded at both ends of the
stick zone if, with h_s = m + n,

    int_slip dq sqrt((xi + m)/(xi - n)) dxi = dQ - pi dsigma h_s/8,
    int_slip dq sqrt((xi - n)/(xi + m)) dxi = dQ + pi dsigma h_s/8.

If kappa = +1 at both edges (moderate tension), the stick zone is a contact patch of the same body.
Inside a contact, the strain due to the pressure is (E*/2)(g' + alpha).  With p_s the pressure of
the patch, f (p1 + p2 - 2 p_s) therefore has the strain (f E*/2)(alpha1 + alpha2 - 2 alpha_s) and
the force f (P1 + P2 - 2 P_s).
"""

from sympy import Abs, Expr, Rational, factor, pi, sqrt

from derive.symbols import E_star, P, a, alpha, c, dM, dP, dQ, dsigma, f, h, mid, w, x
from derive.theory.edges import Edge


def full_stick_change() -> Expr:
    """dq(x) under full stick."""
    return (dQ / pi - dsigma / 4 * (x - mid)) / w


def K_T(edge: Edge) -> Expr:
    """Signed coefficient of 1/sqrt(s) of the full-stick change at `edge`."""
    return (dQ / pi - dsigma / 4 * factor(edge.position - mid)) / sqrt(h)


def L_T(edge: Edge) -> Expr:
    """Signed coefficient of sqrt(s) of the full-stick change at `edge`."""
    return (dQ / pi - edge.inward * 3 * dsigma * h / 8) / (2 * h ** Rational(3, 2))


def pull(edge: Edge) -> Expr:
    """pi sqrt(h) K_T, the load by which shear and tension drive slip at `edge`."""
    return dQ + edge.inward * pi * h * dsigma / 8


def lead(edge: Edge) -> Expr:
    """(pi/2) sqrt(h) K_N dedge, the load by which the normal loads move the edge.

    It is dP +/- 4 (dM + mid dP)/h, with the upper sign on the left.
    """
    opposite, own = (c, a) if edge is Edge.LEFT else (a, c)
    return ((3 * opposite - own) * dP + edge.inward * 4 * dM) / h


def stick_margin(edge: Edge) -> Expr:
    """The margin against slip at `edge` as all loads begin to change."""
    return f * Abs(lead(edge)) - Abs(pull(edge))


def moderate(edge: Expr) -> Expr:
    """An end of the stick zone from contact_at_tilt; P and alpha are means over the cycle."""
    reduced = {P: P - dQ / (2 * f), alpha: alpha - dsigma / (4 * f * E_star)}
    return edge.subs(reduced, simultaneous=True)
