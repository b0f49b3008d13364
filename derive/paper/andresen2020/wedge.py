"""Section 4: the shallow wedge, exactly and by its edge terms."""

from typing import Any

from sympy import Abs, Expr, Integral, S, Symbol, asin, log, pi, sin, sqrt

from derive.paper.andresen2020.consequences import (
    bound_of_tension,
    signs_of_moment,
    slip_of_a_tilted_wedge,
)
from derive.paper.andresen2020.symbols import (
    K_LHS,
    K_RHS,
    P_0,
    Delta_K_T,
    Delta_Q,
    Delta_sigma,
    Delta_sigma_th,
    M,
    P,
    a,
    alpha,
    alpha_0,
    alpha_1,
    alpha_2,
    c,
    d_LHS,
    d_RHS,
    gamma,
    gamma_t,
    m,
    n,
    p,
    phi,
    s,
    xi,
)
from derive.paper.bodies import between, formula, hertz, r, t, wedge
from derive.paper.claim import (
    FRACTION,
    SIGNED,
    Bound,
    Claim,
    Convention,
    Meaning,
    Range,
    Relation,
    Verdict,
)
from derive.symbols import E_star, dQ, dsigma, f, x
from derive.symbols import e as lever

_r1, _t1, _r2, _t2 = (Symbol(k, positive=True) for k in ("r_1", "t_1", "r_2", "t_2"))
_rs, _ts = Symbol("r_s", positive=True), Symbol("t_s", positive=True)
"""Sizes and skewness of the contact at both ends of the cycle, and of the stick zone."""
_part = Symbol("rho", positive=True)
"""1 - Delta Q/(2 f P): the part of the load that the stick zone carries."""
_size = Symbol("l", positive=True)
_share = Symbol("share", positive=True)
"""The part of the contact's right half that the stick zone reaches over."""

WEDGE: Meaning = {
    a: r / t,
    c: r * t,
    gamma: t**2,
    alpha: wedge("tilt"),
    P: wedge("load"),
    M: wedge("moment"),
}
"""The contact [-a, c] of size r and skewness t; M > 0 goes with alpha > 0."""

_lean = sin(pi * alpha / (2 * phi))
GAMMA = (1 - _lean) * (1 + _lean) ** (-1)
"""Eq. (22), right-hand side."""
_lean_t = sin(pi * (alpha_0 - Delta_sigma / (4 * f * E_star)) / (2 * phi))
GAMMA_T = (1 - _lean_t) * (1 + _lean_t) ** (-1)
"""Eq. (29), right-hand side."""

_SHEET = "the wedge's sheet, whose formulas are derived from g(x) and proven"
_OTHER_MOMENT = Convention(
    "the moment with the opposite sign, M = +int p x dx",
    {M: -wedge("moment")},
    "section 4.1, above eq. (21): M is positive when alpha is positive; eq. (1) agrees with that",
)


def claims() -> tuple[Claim, ...]:
    """Eqs. (21) to (34), and what the text says beside them."""
    return (*_contact(), *_equilibrium(), *_stick(), *_slip(), *_coefficients())


def _on_the_wedge(
    label: str,
    number: str,
    says: str,
    left: Expr,
    right: Expr,
    part: str = "",
    expected: Verdict = Verdict.HOLDS,
    **more: object,
) -> Claim:
    """An equation between quantities of one tilted contact."""
    section = "4.2" if number in ("(33)", "(34)") else "4.1"
    made: dict[str, Any] = {
        "meaning": WEDGE,
        "against": _SHEET,
        "swaps": (a, c),
        **more,
    }
    place = f"eq. {number}, section {section}" + (f", {part}" if part else "")
    return Claim(
        label=label,
        equation=number,
        place=place,
        says=says,
        left=left,
        right=right,
        expected=expected,
        **made,
    )


def _contact() -> tuple[Claim, ...]:
    inside = between(r / t, r * t)
    root = sqrt((gamma * a - x) / (x + a))
    pressure = E_star * phi / pi * log(Abs((sqrt(gamma) + root) / (sqrt(gamma) - root)))
    arm = 2 * E_star * phi * M / sqrt(4 * (E_star * phi * M) ** 2 + P**4)
    return (
        _on_the_wedge(
            "pressure_distribution_wedge",
            "(21)",
            "the pressure under a tilted wedge",
            p,
            pressure,
            meaning={**WEDGE, x: inside, p: wedge("pressure").subs(x, inside)},
            steps=("x is written by y = sqrt((c - x)/(a + x)), so that every root comes out.",),
        ),
        _on_the_wedge(
            "gamma",
            "(22)",
            "the ratio c/a from the tilt",
            gamma,
            GAMMA,
            steps=("alpha(a, c) = phi (1 - (4/pi) atan sqrt(c/a)) from I_0 = 0.",),
        ),
        _on_the_wedge(
            "alpha",
            "(23)",
            "the tilt from load and moment",
            alpha,
            -2 * phi / pi * asin(arm),
            conventions=(_OTHER_MOMENT,),
            expected=Verdict.CONVENTION,
            consequence=signs_of_moment,
            steps=("M = (E* phi/4) sqrt(a c) (a - c): the sheet's, positive with alpha.",),
        ),
        _on_the_wedge(
            "section 4.1/c",
            "(24)",
            "the two edges have the ratio gamma",
            c,
            gamma * a,
            meaning={**WEDGE, gamma: GAMMA.subs(alpha, wedge("tilt"))},
            against=f"eq. (22), and {_SHEET}",
        ),
    )


def _equilibrium() -> tuple[Claim, ...]:
    pressed = {**WEDGE, p: wedge("pressure").subs(x, s)}
    family = "resultants of the wedge"
    return (
        _on_the_wedge(
            "normal_equilrbium_wedge/integral",
            "(25)",
            "the load is the integral of the pressure",
            P,
            Integral(p, (s, -a, c)),
            part="first part",
            meaning=pressed,
            family=family,
            expected=Verdict.NUMERICAL,
        ),
        _on_the_wedge(
            "normal_equilrbium_wedge/value",
            "(25)",
            "the load in closed form",
            P,
            E_star * phi * sqrt(gamma * a**2),
            part="second part",
        ),
        _on_the_wedge(
            "ca/a",
            "(26)",
            "the left edge from load and tilt",
            a,
            P / (E_star * phi) * sqrt(1 / gamma),
            part="first part",
        ),
        _on_the_wedge(
            "ca/c",
            "(26)",
            "the right edge from load and tilt",
            c,
            P / (E_star * phi) * sqrt(gamma),
            part="second part",
        ),
        _on_the_wedge(
            "section 4.1/M/integral",
            "(27)",
            "the moment is the integral of p x",
            M,
            Integral(p * s, (s, -a, c)),
            part="first part",
            meaning=pressed,
            family=family,
            conventions=(_OTHER_MOMENT,),
            expected=Verdict.CONVENTION,
            consequence=signs_of_moment,
        ),
        _on_the_wedge(
            "section 4.1/M/value",
            "(27)",
            "the moment in closed form",
            M,
            E_star * phi / 4 * sqrt(gamma) * (1 - gamma) * a**2,
            part="second part",
        ),
        _on_the_wedge(
            "section 4.1/M/sides",
            "(27)",
            "the integral of p x, whatever the moment is, in closed form",
            Integral(p * s, (s, -a, c)),
            E_star * phi / 4 * sqrt(gamma) * (1 - gamma) * a**2,
            part="its two sides beside M",
            meaning=pressed,
            family=family,
            swaps=(),
            expected=Verdict.FAILS,
            consequence=lambda: (
                "no sense of M makes both equations of (27) true: the pressure of a contact with "
                "a > c has its resultant left of the apex"
            ),
        ),
        *_limits(),
    )


def _limits() -> tuple[Claim, ...]:
    """What the text says of the contact without a moment."""
    straight = formula("wedge", "contact_alpha")
    return tuple(
        Claim(
            label=f"section 4.1/no moment/{name}",
            place="section 4.1, below eq. (27)",
            says=f"without a moment {words}",
            left=left,
            right=right,
            meaning=meaning,
            against="the contact of the sheet under (P, M) at M = 0",
            expected=Verdict.HOLDS,
        )
        for name, words, left, right, meaning in (
            ("alpha", "the tilt is zero", alpha, S.Zero, {alpha: _at_no_moment(straight)}),
            (
                "gamma",
                "gamma is one",
                gamma,
                S.One,
                {gamma: GAMMA.subs(alpha, _at_no_moment(straight))},
            ),
            (
                "edges",
                "both edges are as far",
                a,
                c,
                {
                    a: _at_no_moment(formula("wedge", "contact_a")),
                    c: _at_no_moment(formula("wedge", "contact_c")),
                },
            ),
        )
    )


def _at_no_moment(expr: Expr) -> Expr:
    return expr.subs(lever, 0)


# ------------------------------------------------------------------ the permanent stick zone

STICK: Meaning = {
    P_0: (wedge("load", _r1, _t1) + wedge("load", _r2, _t2)) / 2,
    alpha_0: (wedge("tilt", _r1, _t1) + wedge("tilt", _r2, _t2)) / 2,
    alpha_1: wedge("tilt", _r1, _t1),
    alpha_2: wedge("tilt", _r2, _t2),
    gamma_t: _ts**2,
    m: _rs / _ts,
    n: _rs * _ts,
}
_CHANGES = {
    Delta_Q: 2 * f * (STICK[P_0] - wedge("load", _rs, _ts)),
    Delta_sigma: 4 * f * E_star * (STICK[alpha_0] - wedge("tilt", _rs, _ts)),
}
"""Any change of shear and tension, written by the stick zone that it leaves."""
_SUPERPOSED = (
    "dq = f (p_1 + p_2) - 2 f p_t, p_t the pressure of the same body on [-m, n], is f (p_1 + p_2) "
    "in the slip zones.",
    "Its resultant is f (P_1 + P_2 - 2 P_t) = Delta Q, so P_t = P_0 - Delta Q/(2 f).",
    "In the stick zone its strain is f E* (alpha_0 - alpha_t) = Delta sigma/4, so "
    "alpha_t = alpha_0 - Delta sigma/(4 f E*).",
)


def _stick() -> tuple[Claim, ...]:
    return (
        *(
            Claim(
                label=label,
                equation=number,
                place=f"eq. {number}, section 4.1{part}",
                says=says,
                left=left,
                right=right,
                meaning={**STICK, **_CHANGES},
                against="the contact of the same body at load P_0 - Delta Q/(2 f) and tilt alpha_t",
                swaps=swaps,
                steps=_SUPERPOSED,
                expected=Verdict.HOLDS,
            )
            for label, number, part, says, left, right, swaps in (
                (
                    "m/m",
                    "(28)",
                    ", first part",
                    "the left end of the permanent stick zone",
                    m,
                    edge_printed(m, gamma_t),
                    (m, n),
                ),
                (
                    "m/n",
                    "(28)",
                    ", second part",
                    "the right end of the permanent stick zone",
                    n,
                    edge_printed(n, gamma_t),
                    (m, n),
                ),
                (
                    "gamma_2",
                    "(29)",
                    "",
                    "the ratio n/m from mean tilt and tension",
                    gamma_t,
                    GAMMA_T,
                    (),
                ),
            )
        ),
        Claim(
            label="section 4.1/alpha_0",
            place="section 4.1, below eq. (29)",
            says="alpha_0 is the mean of the two tilts",
            left=alpha_0,
            right=(alpha_1 + alpha_2) / 2,
            meaning={
                alpha_1: wedge("tilt", _r1, _t1),
                alpha_2: wedge("tilt", _r2, _t2),
                alpha_0: wedge("tilt", _rs, _ts) + _CHANGES[Delta_sigma] / (4 * f * E_star),
            },
            against="eq. (29) and the conditions of stick: alpha_t + Delta sigma/(4 f E*)",
            swaps=(alpha_1, alpha_2),
            expected=Verdict.HOLDS,
        ),
        *_conditions(),
    )


def _conditions() -> tuple[Claim, ...]:
    """Both conditions of the stick zone, by quadrature, for eqs. (28) and (29) together."""
    wide, turned = _WIDE
    ends = ((_rs * wide[0], _ts * turned[0]), (_rs * wide[1], _ts * turned[1]))
    swapped = {_r1: ends[0][0], _t1: ends[0][1], _r2: ends[1][0], _t2: ends[1][1]}
    changes = {k: v.subs(swapped, simultaneous=True) for k, v in _CHANGES.items()}
    stick = {k: v.subs(swapped, simultaneous=True) for k, v in STICK.items()}
    given = {**stick, **changes}
    edges = {m: edge_printed(m).subs(given), n: edge_printed(n).subs(given)}
    ranges = {s_: Range(1.5, 3) for s_ in wide} | {s_: Range(0.8, 1.25) for s_ in turned}
    made = []
    for name, power, right in (
        ("strain", 0, -pi * Delta_sigma / 4),
        ("force", 1, Delta_Q + pi * Delta_sigma * (m - n) / 8),
    ):
        left = sum((_over_slip(power, *end) for end in ends), S.Zero)
        made.append(
            Claim(
                label=f"m and gamma_2/{name}",
                place="eqs. (28) and (29), section 4.1, together",
                source="m, n = (P_0 - Delta_Q/(2*f))*(sqrt(1/gamma_t), sqrt(gamma_t))/(E_star*phi) "
                "with gamma_t = (1 - sin(beta))/(1 + sin(beta)), "
                "beta = pi*(alpha_0 - Delta_sigma/(4*f*E_star))/(2*phi)",
                says=f"the printed stick zone meets the condition of {name}",
                left=left,
                right=right,
                meaning={**changes, **edges},
                against=(
                    "int r/w dxi = -pi dsigma/4"
                    if power == 0
                    else "int r xi/w dxi = dQ + pi dsigma (m - n)/8"
                )
                + " over the slip zones, r = f (p_1 + p_2), both ends different",
                ranges=ranges,
                family="the printed stick zone",
                expected=Verdict.NUMERICAL,
            )
        )
    return tuple(made)


_WIDE = tuple(
    tuple(Symbol(f"{name}_{i}", positive=True) for i in (1, 2)) for name in ("wide", "turned")
)


def edge_printed(which: Symbol, ratio: Expr = GAMMA_T) -> Expr:
    """Eq. (28), right-hand side, the ratio n/m by eq. (29) if it is not given."""
    carried = (P_0 - Delta_Q / (2 * f)) / (E_star * phi)
    return carried * sqrt(1 / ratio if which == m else ratio)


def _over_slip(power: int, size: Expr, skew: Expr) -> Expr:
    """int f p xi**power/w over both slip zones of one end; w > 0 on the right, < 0 on the left."""
    pressure = wedge("pressure", size, skew).subs(x, xi)
    root = sqrt((xi - n) * (xi + m))
    right = Integral(f * pressure * xi**power / root, (xi, n, size * skew))
    left = Integral(-f * pressure * xi**power / root, (xi, -size / skew, -m))
    return left + right


def _slip() -> tuple[Claim, ...]:
    return tuple(
        Claim(
            label=label,
            equation=number,
            place=f"eq. {number}, section 4.2",
            says=f"the slip zone at the {side} edge",
            left=zone,
            right=right,
            meaning={zone: length, a: r / t, c: r * t, m: _rs / _ts, n: _rs * _ts},
            against="the length between the edge and the stick zone",
            swaps=(a, c, m, n),
            expected=Verdict.HOLDS,
        )
        for label, number, side, zone, right, length in (
            ("slipzones_LHS", "(30)", "left", d_LHS, a - m, -_rs / _ts - (-r / t)),
            ("slipzones_RHS", "(31)", "right", d_RHS, c - n, r * t - _rs * _ts),
        )
    )


# ------------------------------------------------------------------ coefficients at the edges


def stuck(half: Expr, sign: int) -> Expr:
    """Eq. (32), right-hand side."""
    return Delta_Q / (pi * sqrt(2 * half)) + sign * Delta_sigma / 4 * sqrt(half / 2)


def _stuck_as_printed(half: Expr, sign: int) -> str:
    """Eq. (32) as text: SymPy gathers the roots."""
    between = "+" if sign > 0 else "-"
    first = f"Delta_Q/(pi*sqrt(2*{half}))"
    return f"Delta_K_T = {first} {between} (Delta_sigma/4)*sqrt({half}/2)"


def _coefficients() -> tuple[Claim, ...]:
    made = []
    for side, sign, own in (("left", 1, a), ("right", -1, c)):
        word = "upper" if sign > 0 else "lower"
        load = {Delta_Q: dQ, Delta_sigma: dsigma}
        made += [
            Claim(
                label=f"K_T/{side}",
                equation="(32)",
                place=f"eq. (32), section 4.2, {word} sign",
                says=f"the coefficient of the stuck shear at the {side} edge, half-width a",
                left=Delta_K_T,
                right=stuck(a, sign),
                source=_stuck_as_printed(a, sign),
                meaning={**load, Delta_K_T: hertz(f"K_T_{side}", _size, _size), a: _size},
                against="the edge limit of full stick in a symmetric contact",
                ranges={dsigma: SIGNED},
                swaps=(Delta_Q, Delta_sigma),
                expected=Verdict.HOLDS,
            ),
            Claim(
                label=f"K_T/tilted/{side}",
                place=f"section 4.2, below eq. (32): {own} is used at the {side} edge",
                says=f"the same at the {side} edge of a tilted contact, with {own} for half the "
                "width",
                left=Delta_K_T,
                right=stuck(own, sign),
                source=_stuck_as_printed(own, sign),
                meaning={**load, Delta_K_T: wedge(f"K_T_{side}"), a: r / t, c: r * t},
                against="the edge limit of full stick in the contact [-a, c]",
                ranges={dsigma: SIGNED, t: Range(0.4, 0.9)},
                swaps=(a, c),
                steps=(
                    "Full stick in [-a, c]: dq = (dQ/pi - (dsigma/4)(x - mid))/sqrt((a+x)(c-x)).",
                    "At either edge the other root is sqrt(a + c): half the width is (a + c)/2, "
                    "one number for both edges.",
                    "The printed rule uses the coefficient of a symmetric contact of half-width a "
                    "at one edge and of one of half-width c at the other.",
                ),
                expected=Verdict.FAILS,
                consequence=slip_of_a_tilted_wedge,
            ),
        ]
    return (*made, *_normal_coefficients())


def _normal_coefficients() -> tuple[Claim, ...]:
    body = {**WEDGE, K_LHS: wedge("K_N_left"), K_RHS: wedge("K_N_right")}
    return (
        _on_the_wedge(
            "K_N",
            "(33)",
            "the coefficient of the pressure at the left edge of a tilted wedge",
            K_LHS,
            2 * E_star * phi / pi * sqrt(gamma / (a * (1 + gamma))),
            meaning=body,
        ),
        _on_the_wedge(
            "section 4.2/K_N_RHS",
            "(34)",
            "the coefficient at the right edge from that at the left",
            K_RHS,
            K_LHS / gamma,
            meaning=body,
        ),
    )


def direction_claim() -> Claim:
    """Eq. (37), its sign: slip of one sign asks for a tension below the threshold, not above."""

    def tension_at(share: Expr) -> Expr:
        return 4 * f * E_star * (wedge("tilt") - wedge("tilt", r, share * t / _part))

    return Claim(
        label="inequalitywedge/direction",
        equation="(37)",
        place="eq. (37), section 5.3, first part",
        says="slip has the same sign at both edges up to a tension, not from there on",
        left=Delta_sigma,
        relation=Relation.AT_MOST,
        right=Delta_sigma_th,
        reached=Bound(
            {Delta_sigma: tension_at(_share)},
            {Delta_sigma: tension_at(1 / _share)},
        ),
        meaning={Delta_sigma: tension_at(S.One), Delta_sigma_th: tension_at(S.One)},
        against="eqs. (28) and (29) with n inside and outside the contact",
        ranges={_part: FRACTION, _share: FRACTION},
        steps=(
            "The stick zone has size rho r, rho = 1 - Delta Q/(2 f P); n = share c.",
            "A slip zone of the printed sign is there at the right edge if n < c.",
        ),
        expected=Verdict.HOLDS,
    )


def threshold_claim() -> Claim:
    """Eq. (37): the tension at which slip stops at the right edge."""
    inner = Delta_Q * gamma * (-4 * f * P + Delta_Q) + (1 + gamma) * 4 * f**2 * P**2
    lean = asin(8 * f**2 * P**2 / inner - 1)
    return Claim(
        label="inequalitywedge",
        equation="(37)",
        place="eq. (37), section 5.3, second part",
        says="the tension at which the slip zone of one edge closes",
        left=Delta_sigma_th,
        right=4 * E_star * f / pi * (pi * alpha_0 - 2 * phi * lean),
        source="Delta_sigma_th = 4*E_star*f/pi*(pi*alpha_0 - 2*phi*asin("
        "8*f**2*P**2/(Delta_Q*gamma*(-4*f*P + Delta_Q) + (1 + gamma)*4*f**2*P**2) - 1))",
        meaning={
            P: wedge("load"),
            gamma: t**2,
            alpha_0: wedge("tilt"),
            Delta_Q: 2 * f * wedge("load") * (1 - _part),
            Delta_sigma_th: 4 * f * E_star * (wedge("tilt") - wedge("tilt", r, t / _part)),
        },
        against="eqs. (28) and (29) at n = c",
        ranges={_part: FRACTION},
        swaps=(gamma,),
        steps=(
            "At n = c the stick zone has size rho r and skewness t/rho, rho = 1 - Delta Q/(2 f P).",
            "Eq. (29): Delta sigma = 4 f E* (alpha_0 - alpha_t), alpha_t its tilt.",
            "As printed it is the bound at the other edge, m = a, skewness t rho: for an untilted "
            "wedge a negative number, which no positive tension satisfies.",
        ),
        expected=Verdict.FAILS,
        consequence=bound_of_tension,
    )
