r"""Slip and shear traction next to a single edge, from the series of pressure and full stick.

At a distance s from the edge, far from the other one,

    p = sqrt(s) (K_N + L_N s + N_N s**2),   full-stick dq = (K_T + L_T s + N_T s**2)/sqrt(s).

The slip zone has the length D.  With t = s - D, the bounded change in the shear traction is

    dq = f (p_1 + p_2) - sqrt(t) R(t),   R a polynomial:

Neither part has a strain where nothing slips.  For s much larger than D, dq must equal the
full-stick change.  `matched` expands both in powers of 1/t: positive powers of t determine R, and
the coefficient of t**(-1/2) determines the slip zone.  Each contact of the half-cycle has its own
D, so that nothing more is needed for an edge that moves.

The pressure grows as the edge advances.  Let K_N(b) be that of the contact whose edge lies at b.
The pressure at x is int_x^edge K_N(b)/(2 sqrt(b - x)) db, so that K_N(b) follows from the series.

If the contact has the width h and its other edge does not slip, f K_N D**2/(8 h) is added to the
load that drives slip: `width_term`, from theory.slip with one slip zone.
"""

from collections.abc import Sequence

from sympy import Expr, Rational, S, Symbol, binomial, expand, gamma, series, solve, symbols

from derive.symbols import f, h
from derive.theory import slip

HALF = Rational(1, 2)

t = Symbol("t", positive=True)


def beyond(power: Expr, D: Expr, terms: int) -> list[tuple[Expr, Expr]]:
    """Terms of (t + D)**power for t much larger than D: (power of t, coefficient)."""
    return [(power - j, binomial(power, j) * D**j) for j in range(terms)]


def matched(
    pressures: Sequence[tuple[Sequence[Expr], Expr]], shear: Sequence[Expr]
) -> tuple[Expr, list[Expr]]:
    """The condition for the slip zone, an expression that vanishes, and the coefficients of R(t).

    pressures: for each contact, f times the coefficients K_N, L_N, ..., and its slip length
    shear: the coefficients K_T, L_T, ...; their D is that of the first contact

    >>> from sympy import symbols
    >>> K_N, K_T, D = symbols("K_N K_T D")
    >>> matched([((f * K_N,), D)] * 2, (K_T,))
    (D*K_N*f - K_T, [2*K_N*f])
    """
    order = len(shear)
    left_over = dict.fromkeys((k - HALF for k in range(order + 1)), S.Zero)
    for coefficients, D in pressures:
        for k, C in enumerate(coefficients):
            for power, term in beyond(k + HALF, D, k + 2):
                left_over[power] += C * term
    for k, V in enumerate(shear):
        for power, term in beyond(k - HALF, pressures[0][1], k + 1):
            left_over[power] -= V * term
    condition, *stuck = (expand(left_over[k - HALF]) for k in range(order + 1))
    return condition, stuck


def grown(coefficients: Sequence[Expr], move: Expr) -> list[Expr]:
    """Coefficients of the pressure of a contact whose edge has advanced less, by `move`.

    K_N(b) is a polynomial in the distance of this edge from the actual one.  The integral turns
    each power of this distance into one power of s.
    """
    share = [gamma(k + 1) * gamma(HALF) / gamma(k + 3 * HALF) / 2 for k in range(len(coefficients))]
    K_N = sum(
        C / b * (t + move) ** k for k, (C, b) in enumerate(zip(coefficients, share, strict=True))
    )
    return [expand(K_N).coeff(t, k) * share[k] for k in range(len(coefficients))]


def width_term() -> Expr:
    """Second-order contribution of a width h to the load that drives slip, divided by f K_N D**2.

    >>> width_term()
    1/(8*(a + c))
    """
    D, size, other = slip.d_left, Symbol("epsilon", positive=True), Symbol("K_T_other")
    K, L = symbols("K L", positive=True)
    own, (ratio,) = slip.K_T_left, slip.ratios("left", 2)
    loads = {slip.D_left: own / (f * K), slip.D_right: other / (f * K * slip.rho)}
    at_left = f * K * slip.conditions(2)[0].subs(loads | {slip.d_right: 0, ratio: L / K})
    L_T = (2 * other - own) / (2 * h)
    by_edge, _ = matched([((f * K, f * L), D)] * 2, (own, L_T))
    missing = by_edge.subs(h, slip.width) - at_left
    small = {D: size * D, own: size * own, other: size * other}
    second = series(missing.xreplace(small), size, 0, 3).removeO().coeff(size, 2)
    (first,) = solve(by_edge.subs({L: 0, other: own / 2}), own)
    found = expand((second / (f * K * D**2)).subs(own, first).subs(slip.width, h))
    return found.simplify()


def work(K_N: Expr, D: Expr, E_star: Expr) -> Expr:
    """Frictional work per cycle and unit depth, to first order, for constant loads.

    It is 2 int_0^D f p times the slip range ds.

    >>> from sympy import symbols
    >>> work(*symbols("K_N D E_star"))
    pi*D**3*K_N**2*f**2/(3*E_star)
    """
    _, (R,) = matched([((f * K_N,), D)] * 2, (Symbol("K_T"),))
    beta = gamma(3 * HALF) * gamma(5 * HALF) / gamma(4)
    return 2 * f * K_N * (2 / E_star) * R / (3 * HALF) * D**3 * beta
