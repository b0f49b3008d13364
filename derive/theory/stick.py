r"""Stick: how the shear traction changes where nothing slips, and the permanent stick zone.

Similar bodies: where nothing slips, (1/pi) PV int dq(xi)/(x - xi) dxi = dsigma/4; and int dq = dQ.

Full stick.  In a fixed contact, whatever the body,

    dq(x) = [dQ/pi - (dsigma/4)(x - mid)] / w = K_T s**(-1/2) + L_T s**(1/2) + ...

at a distance s from an edge.  While all loads change a little, an edge moves by K_N dedge =
2 lead/(pi sqrt(h)); the shear that comes in behind it is 2 K_T sqrt(s)/dedge, and nothing slips as
long as that is below f K_N sqrt(s):  |pull| <= f |lead|,  pull = pi sqrt(h) K_T.

Slip at both edges leaves dq = kappa f (p1 + p2) outside [-m, n].  dq stays bounded at both ends of
the stick zone if, with h_s = m + n,

    int_slip dq sqrt((xi + m)/(xi - n)) dxi = dQ - pi dsigma h_s/8,
    int_slip dq sqrt((xi - n)/(xi + m)) dxi = dQ + pi dsigma h_s/8.

With kappa = +1 at both edges (moderate tension) the stick zone is a contact patch of the same body:
inside a contact the pressure's strain is (E*/2)(g' + alpha), so that f (p1 + p2 - 2 p_s), p_s the
pressure of the patch, has the strain (f E*/2)(alpha1 + alpha2 - 2 alpha_s) and the force
f (P1 + P2 - 2 P_s).
"""

from sympy import Abs, Expr, Rational, factor, pi, sqrt

from derive.symbols import E_star, P, a, alpha, c, dM, dP, dQ, dsigma, f, h, mid, w, x
from derive.theory.edges import Edge


def full_stick_change() -> Expr:
    """dq(x) in full stick."""
    return (dQ / pi - dsigma / 4 * (x - mid)) / w


def K_T(edge: Edge) -> Expr:
    """Coefficient of 1/sqrt(s) of the full-stick change at `edge`, signed."""
    return (dQ / pi - dsigma / 4 * factor(edge.position - mid)) / sqrt(h)


def L_T(edge: Edge) -> Expr:
    """Coefficient of sqrt(s) of the full-stick change at `edge`, signed."""
    return (dQ / pi - edge.inward * 3 * dsigma * h / 8) / (2 * h ** Rational(3, 2))


def pull(edge: Edge) -> Expr:
    """pi sqrt(h) K_T: by how much shear and tension drive slip."""
    return dQ + edge.inward * pi * h * dsigma / 8


def lead(edge: Edge) -> Expr:
    """(pi/2) sqrt(h) K_N dedge: by how much the normal loads drive the edge.

    dP +/- 4 (dM + mid dP)/h, the upper sign on the left.
    """
    opposite, own = (c, a) if edge is Edge.LEFT else (a, c)
    return ((3 * opposite - own) * dP + edge.inward * 4 * dM) / h


def stick_margin(edge: Edge) -> Expr:
    """The friction left at `edge` as all loads begin to change."""
    return f * Abs(lead(edge)) - Abs(pull(edge))


def moderate(edge: Expr) -> Expr:
    """What contact_at_tilt says of the stick zone; P and alpha are means of the cycle."""
    reduced = {P: P - dQ / (2 * f), alpha: alpha - dsigma / (4 * f * E_star)}
    return edge.subs(reduced, simultaneous=True)
