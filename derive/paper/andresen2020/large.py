"""The two conditions of the stick zone under large tension, written as the changes they ask for.

Slip has the sign kappa f (p_1 + p_2), +1 at one edge and -1 at the other.  With w > 0 right of n
and w < 0 left of -m,

    int r/w dxi = -pi dsigma/4,    int r xi/w dxi = dQ + pi dsigma (m - n)/8,

so that any m and n are the stick zone of one dsigma and one dQ.
"""

from sympy import Expr, Integral, S, Symbol, pi, sqrt

from derive.paper.andresen2020.asymptotics import CONTRADICTED
from derive.paper.andresen2020.symbols import Delta_Q, Delta_sigma, xi
from derive.paper.claim import Convention, Meaning
from derive.symbols import f, x


def conditions(pressure: Expr, half: Symbol, m: Expr, n: Expr, sense: int = 1) -> Meaning:
    """Delta sigma and Delta Q that leave [-m, n] stuck in the contact [-half, half].

    sense: +1 where slip at the left edge has the sign of the shear, -1 where it is the right one.
    """
    strain = sum(_parts(pressure, half, m, n, 0, sense), S.Zero)
    force = sum(_parts(pressure, half, m, n, 1, sense), S.Zero)
    tension = -4 / pi * strain
    return {Delta_sigma: tension, Delta_Q: force - pi * tension * (m - n) / 8}


def _parts(
    pressure: Expr, half: Symbol, m: Expr, n: Expr, power: int, sense: int
) -> tuple[Expr, Expr]:
    """int r xi**power/w over the left and over the right slip zone."""
    total = 2 * f * pressure.subs(x, xi) * xi**power
    root = sqrt((xi - n) * (xi + m))
    left = Integral(sense * total / -root, (xi, -half, -m))
    return left, Integral(-sense * total / root, (xi, n, half))


def opposite_tension(pressure: Expr, half: Symbol, m: Expr, n: Expr) -> Convention:
    """The same stick zone with slip of the other sign at both edges: Delta sigma is minus ours."""
    ours = conditions(pressure, half, m, n, sense=-1)
    changes = {Delta_sigma: -ours[Delta_sigma], Delta_Q: ours[Delta_Q]}
    return Convention("the tension with the opposite sign", changes, CONTRADICTED)
