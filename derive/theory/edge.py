r"""An edge alone: slip and shear next to it, from the series of pressure and full stick.

At a distance s from the edge, far from the other one,

    p = sqrt(s) (K_N + L_N s + N_N s**2),   full-stick dq = (K_T + L_T s + N_T s**2)/sqrt(s).

Slip reaches D in.  With t = s - D the distance from there, the bounded change of shear is

    dq = f (p_1 + p_2) - sqrt(t) R(t),   R a polynomial:

both parts are free of strain where nothing slips.  Where s is large against D this must be the
full-stick change.  `matched` expands both in powers of 1/t.  Positive powers of t give R.  What
multiplies t**(-1/2) gives the slip zone.  Each contact of the half-cycle has its own D, so that an
edge which moves needs nothing more.

The pressure grows as the edge moves on: with K_N(b) that of the contact whose edge lies at b, the
pressure at x is int_x^edge K_N(b)/(2 sqrt(b - x)) db, so that K_N(b) follows from the series.

A contact of known width h whose other edge does not slip adds f K_N D**2/(8 h) to what drives slip:
theory.slip with one slip zone, `width_term`.
"""

from collections.abc import Sequence

from sympy import Expr, Rational, S, Symbol, binomial, expand, gamma, series, solve, sqrt

from derive.symbols import dsigma, f, h
from derive.theory import slip

HALF = Rational(1, 2)

t = Symbol("t", positive=True)


def beyond(power: Expr, D: Expr, terms: int) -> list[tuple[Expr, Expr]]:
    """(t + D)**power as (power of t, coefficient), where t is large against D."""
    return [(power - j, binomial(power, j) * D**j) for j in range(terms)]


def matched(
    pressures: Sequence[tuple[Sequence[Expr], Expr]], shear: Sequence[Expr]
) -> tuple[Expr, list[Expr]]:
    """What vanishes for the slip zone, over K_T's, and the coefficients of R(t).

    pressures: of each contact f times the coefficients K_N, L_N, ..., and the length of slip in it
    shear: coefficients K_T, L_T, ...; D is that of the first contact

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
    """The pressure's coefficients of the contact whose edge reaches less far by `move`.

    K_N(b) is a polynomial in how much less far the edge lies; each power of that, carried through
    the integral, gives one power of s.
    """
    share = [gamma(k + 1) * gamma(HALF) / gamma(k + 3 * HALF) / 2 for k in range(len(coefficients))]
    K_N = sum(
        C / b * (t + move) ** k for k, (C, b) in enumerate(zip(coefficients, share, strict=True))
    )
    return [expand(K_N).coeff(t, k) * share[k] for k in range(len(coefficients))]


def width_term() -> Expr:
    """What a width h adds to what drives slip, in the second order, over f K_N D**2.

    >>> width_term()
    1/(8*(a + c))
    """
    D, size, other = slip.d_left, Symbol("epsilon", positive=True), Symbol("K_T_other")
    K, L = slip.coefficients("left", 2)
    at_left, _ = (
        condition.subs({slip.kappa_left: 1, slip.kappa_right: 0, slip.d_right: 0})
        for condition in slip.conditions(2)
    )
    own = slip.K_T_left
    tension = 4 * (own - other) / sqrt(h)
    L_T = (2 * other - own) / (2 * h)
    by_edge, _ = matched([((f * K, f * L), D)] * 2, (own, L_T))
    width = Symbol("h", positive=True)
    missing = (by_edge - at_left.subs(dsigma, tension)).subs(h, width)
    small = {D: size * D, own: size * own, other: size * other}
    second = series(missing.xreplace(small), size, 0, 3).removeO().coeff(size, 2)
    (first,) = solve(by_edge.subs({L: 0, other: own / 2}), own)
    found = expand((second / (f * K * D**2)).subs(own, first).subs(width, h))
    return found.simplify()


def work(K_N: Expr, D: Expr, E_star: Expr) -> Expr:
    """Friction's work a cycle, per unit depth, to the first order; constant loads.

    2 int_0^D f p times the slip range ds.

    >>> from sympy import symbols
    >>> work(*symbols("K_N D E_star"))
    pi*D**3*K_N**2*f**2/(3*E_star)
    """
    _, (R,) = matched([((f * K_N,), D)] * 2, (Symbol("K_T"),))
    beta = gamma(3 * HALF) * gamma(5 * HALF) / gamma(4)
    return 2 * f * K_N * (2 / E_star) * R / (3 * HALF) * D**3 * beta
