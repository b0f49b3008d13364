"""The equations of the outline of the theory, for any profile, as SymPy expressions.

pages.py prints them.  tests/test_site.py inserts a body and compares them with its formula sheet.
"""

import re

from sympy import Expr, Function, Integral, S, Symbol, pi, sqrt, symbols

from derive import symbols as theory
from derive.reading.improper import PrincipalValue
from derive.sheet.notation import latex_of
from derive.symbols import E_star, M, P, a, alpha, c, dQ, dsigma, f, m, n, s, x
from derive.theory import slip, stick, superposition
from derive.theory.superposition import slope, xi

p, p_1, p_2, p_s = map(Function, ("p", "p_1", "p_2", "p_s"))
w, F, left_of, dq = map(Function, ("w", "F", "a", r"\Delta q"))

I_0, I_1, I_2, I_k, k, b, first, d = symbols("I_0 I_1 I_2 I_k k b c_x d", real=True)
h, mid, kappa = Symbol("h", positive=True), Symbol("mid"), Symbol("kappa")
K_N, K_N_left, K_N_right, K_T = symbols("K_N K_N_left K_N_right K_T", real=True)
P_prime, a_prime, P_s, alpha_s = symbols("P_prime a_prime P_s alpha_s", real=True)

_SMOOTH = superposition.formulas()
"""The formulas of any profile without a kink."""


def _slipped(weight: Expr) -> Expr:
    """An integral of the change in the shear traction over both slip zones."""
    inside = dq(xi) * weight
    return Integral(inside, (xi, -a, -m)) + Integral(inside, (xi, n, c))


_PULL = pi * dsigma * (m + n) / 8
_STRAIN = slope(s) + alpha

EQUATIONS: dict[str, tuple[tuple[Expr, Expr], ...]] = {
    "half_plane": (
        (PrincipalValue(p(s) / (x - s), s, -a, c) / pi, E_star / 2 * (slope(x) + alpha)),
    ),
    "bounded": (
        (p(x), E_star / (2 * pi) * w(x) * PrincipalValue(_STRAIN / ((s - x) * w(s)), s, -a, c)),
    ),
    "moments": ((I_k, Integral(s**k * _STRAIN / w(s), (s, -a, c))),),
    "equilibrium": ((I_0, S.Zero), (P, E_star / 2 * I_1), (M, -E_star / 2 * (I_2 - mid * I_1))),
    "tilt": ((alpha, _SMOOTH["tilt"]),),
    "resultants": ((P, Integral(p(x), (x, -a, c))), (M, -Integral(x * p(x), (x, -a, c)))),
    "by_parts": ((P, _SMOOTH["load"]), (M, _SMOOTH["moment"])),
    "punches": (
        (p(x), Integral(F(b) / sqrt((left_of(b) + x) * (b - x)), (b, first, c))),
        (F(c), P_prime / pi),
    ),
    "edge_coefficients": (
        (K_N_right, 2 * P_prime / (pi * sqrt(h))),
        (K_N_left, K_N_right / a_prime),
    ),
    "stick": (
        (PrincipalValue(dq(xi) / (x - xi), xi, -a, c) / pi, dsigma / 4),
        (Integral(dq(x), (x, -a, c)), dQ),
    ),
    "full_stick": ((dq(x), stick.full_stick_change()),),
    "slip": ((dq(x), kappa * f * (p_1(x) + p_2(x))),),
    "stick_zone": (
        (_slipped(sqrt((xi + m) / (xi - n))), dQ - _PULL),
        (_slipped(sqrt((xi - n) / (xi + m))), dQ + _PULL),
    ),
    "first_order": ((d, slip.slip_zone(pi * sqrt(theory.h) * K_T, K_N).subs(theory.h, h)),),
    "difference": ((dq(x), f * (p_1(x) + p_2(x) - 2 * p_s(x))),),
    "moderate": ((P_s, stick.moderate(P)), (alpha_s, stick.moderate(alpha))),
}


def outlined(name: str) -> str:
    """One entry in LaTeX; the equations of an entry stand side by side, or one below the other."""
    rows = [(_latex(left), _latex(right)) for left, right in EQUATIONS[name]]
    side_by_side = r", \qquad ".join(" = ".join(row) for row in rows)
    if len(rows) == 1 or r"\int" not in side_by_side:
        return side_by_side
    below = " \\\\\n".join(" &= ".join(row) for row in rows)
    return f"\\begin{{aligned}}\n{below}\n\\end{{aligned}}"


def _latex(expr: Expr) -> str:
    return re.sub(r"\\operatorname{(g'+)}", r"\1", latex_of(expr))
