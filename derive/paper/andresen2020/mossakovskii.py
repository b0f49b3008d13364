"""Section 2: the pressure from flat punches, and its coefficient at the edges."""

from typing import Any

from sympy import And, Expr, Integral, Piecewise, S, Symbol, diff, pi, sign, simplify, sqrt

from derive.paper import anybody
from derive.paper.andresen2020.symbols import (
    E,
    F,
    K_Na,
    K_Nc,
    P,
    P_prime,
    R,
    a,
    a_prime,
    c,
    g_prime,
    h,
    nu,
    p,
    phi,
    s,
    x_1,
)
from derive.paper.bodies import between, hertz, r, t, wedge, without_modulus, y
from derive.paper.claim import FRACTION, Claim, Range, Relation, Verdict
from derive.symbols import E_star, x

_mu = Symbol("mu", positive=True)
_size = Symbol("l", positive=True)
_SKEW = {t: Range(0.55, 0.9)}
"""A wedge that leans to the left, a > c."""

_PUNCH = Piecewise((1 / sqrt((a + x) * (s - x)), And(x > -a, x < s)), (0, True))
"""h(x, s) as printed, c called s as it is in the integral over it."""


def claims() -> tuple[Claim, ...]:
    """Eqs. (2) to (9), and what the text says beside them."""
    anybody.demand_proven()
    return (_consistency(), *_superposition(), *_abel(), *_loads(), *_edges(), *_text())


def _consistency() -> Claim:
    return Claim(
        label="eqn:consistencyab",
        equation="(2)",
        place="eq. (2), section 2",
        says="the tilt leaves the pressure bounded at both edges of [-a, c]",
        left=S.Zero,
        right=Integral(g_prime / sqrt((a - s) * (s + c)), (s, -a, c)),
        meaning={a: r / t, c: r * t, g_prime: phi * sign(s) + wedge("tilt")},
        against="a tilted wedge, whose tilt is proven on its sheet",
        ranges=_SKEW,
        swaps=(a, c),
        steps=(
            "g' of the tilted wedge is phi sign(s) + alpha, alpha(a, c) from the sheet.",
            "The integral is done by quadrature; under the printed root it is not even real.",
        ),
        expected=Verdict.FAILS,
        consequence=lambda: (
            "a and c change places under the root: for an unsymmetric contact the integrand is "
            "imaginary over a part of [-a, c], and no tilt satisfies the condition"
        ),
    )


def _punches(place: Expr, first: Expr) -> dict[Symbol, Expr]:
    """A wedge of fixed tilt: a(s) = s/t**2, F constant.

    first: the s from which on a punch reaches as far as the place.
    """
    root = sqrt((s / t**2 + place) * (s - place))
    return {
        F: wedge("punch"),
        h: Piecewise((1 / root, s > first), (0, True)),
        p: wedge("pressure").subs(x, place),
        c: r * t,
        x: place,
    }


def _superposition() -> tuple[Claim, ...]:
    """Eqs. (3) and (4) on either side of the apex."""
    sides = (p, Integral(F * h, (s, 0, c)))
    against = "p(x) and F of a tilted wedge, proven on its sheet"
    made = []
    for half, place in (("right", r * t * _mu), ("left", -r / t * _mu)):
        name, where = ("", "") if half == "right" else ("/left", ", x < 0")
        meaning = _punches(place, r * t * _mu)
        made += [
            Claim(
                label=f"eqn:PressureSuperposition{name}",
                equation="(3)",
                place=f"eq. (3), section 2{where}",
                says=f"the pressure is a superposition of flat punches, {half} of the apex",
                left=sides[0],
                right=sides[1],
                meaning=meaning,
                against=against,
                ranges={_mu: FRACTION},
                expected=Verdict.NUMERICAL,
            ),
            Claim(
                label=f"eqn:FlatPunchCP{name}",
                equation="(4)",
                place=f"eq. (4), section 2{where}",
                says=f"the pressure of one flat punch on [-a(s), s], {half} of the apex",
                left=h,
                right=_PUNCH,
                source="h(x, c) = 1/sqrt((a(c) + x)*(c - x)) for -a(c) < x < c, 0 otherwise",
                through=sides,
                meaning={k: v for k, v in meaning.items() if k != h} | {a: s / t**2},
                against=f"eq. (3) with {against}",
                ranges={_mu: FRACTION},
                swaps=(a, s),
                expected=Verdict.NUMERICAL,
            ),
        ]
    return tuple(made)


def _abel() -> tuple[Claim, ...]:
    place = r * t * _mu
    printed: dict[str, Any] = {
        "left": E_star * g_prime * pi / 2,
        "right": Integral(F / sqrt((x - s) * (x + a)), (s, 0, x)),
    }
    shared: dict[str, Any] = {
        "equation": "(5)",
        "says": "Abel's equation for the weight F of the punches",
        "ranges": {_mu: FRACTION},
        "expected": Verdict.FAILS,
        "steps": (
            "Eq. (4) has the resultant pi, so eq. (6) with eq. (3) makes F = P'/pi, eq. (7).",
            "With that F the integral is E* g'/2 on any body; eqs. (5) and (7) contradict.",
        ),
    }
    return (
        Claim(
            label="eqn:FIE",
            place="eq. (5), section 2",
            meaning={
                g_prime: phi + wedge("tilt"),
                F: wedge("punch"),
                a: s / t**2,
                x: place,
            },
            against="a tilted wedge, whose F follows from its load by eq. (7)",
            consequence=lambda: (
                "F, and with it P and p, comes out pi times too large if eq. (5) is solved for it "
                "as printed"
            ),
            **printed,
            **shared,
        ),
        Claim(
            label="eqn:FIE/cylinder",
            place="eq. (5), section 2, on a cylinder",
            meaning={
                g_prime: _size * _mu / R,
                F: hertz("punch", s, s),
                a: s,
                x: _size * _mu,
            },
            against="a cylinder, whose F follows from its load by eq. (7)",
            **printed,
            **shared,
        ),
    )


def _loads() -> tuple[Claim, ...]:
    left, right = anybody.left, anybody.right
    inside = between(left, right)
    root = sqrt((left + inside) * (right - inside))
    return (
        Claim(
            label="eqn:NormalEquilibrium",
            equation="(6)",
            place="eq. (6), section 2",
            says="the load is the integral of the pressure",
            left=P,
            right=Integral(p, (s, -a, c)),
            meaning={
                P: wedge("load"),
                p: wedge("pressure").subs(x, s),
                a: r / t,
                c: r * t,
            },
            family="resultants of the wedge",
            against="load and pressure of a tilted wedge, proven on its sheet",
            swaps=(a, c),
            expected=Verdict.NUMERICAL,
        ),
        Claim(
            label="eqn:PFRelation",
            equation="(7)",
            place="eq. (7), section 2",
            says="the weight of the punches is the contact law's slope over pi",
            left=F,
            right=P_prime / pi,
            meaning={F: root * anybody.pressure_rate(inside), P_prime: anybody.load_rate()},
            against="the growth of p and P of any body at fixed tilt",
            steps=("By eq. (3) dp/dc = F(c) h(x, c), so F = sqrt((a + x)(c - x)) dp/dc.",),
            expected=Verdict.HOLDS,
        ),
    )


def _edges() -> tuple[Claim, ...]:
    rate, ratio = anybody.load_rate(), anybody.edge_ratio()
    body = {a: anybody.left, c: anybody.right, P_prime: rate, a_prime: ratio}
    wedge_body = {
        a: r / t,
        c: r * t,
        P_prime: wedge("load_rate"),
        a_prime: wedge("edge_ratio"),
    }
    right = 2 / pi * P_prime / sqrt(c + a)
    left = 2 / pi * P_prime / (a_prime * sqrt(c + a))
    made = []
    for number, label, coefficient, root, K, ours, near in (
        ("(8)", "eqn:Knc", right, sqrt(c - x), K_Nc, anybody.K_right, _near_right()),
        ("(9)", "eqn:Kna", left, sqrt(a + x), K_Na, anybody.K_left, _near_left()),
    ):
        edge = "right" if number == "(8)" else "left"
        made += [
            Claim(
                label=f"{label}/pressure",
                equation=number,
                place=f"eq. {number}, section 2, first part",
                says=f"the pressure next to the {edge} edge",
                left=p,
                right=coefficient * root,
                relation=Relation.LIKE,
                meaning=wedge_body | {p: near * root.subs({a: r / t, c: r * t})},
                against=f"the limit of p(x)/{root} of a tilted wedge",
                ranges={x: Range(-0.1, 0.1)},
                swaps=(a, c),
                expected=Verdict.HOLDS,
            ),
            Claim(
                label=f"{label}/coefficient",
                equation=number,
                place=f"eq. {number}, section 2, second part",
                says=f"the coefficient at the {edge} edge from the contact law",
                left=K,
                right=coefficient,
                meaning=body | {K: ours},
                against="any body: P' and a' at fixed tilt from the rates at both edges",
                swaps=(a, c),
                steps=(
                    "P_a and P_c are (pi sqrt(h)/4) K at that edge, alpha_a and alpha_c +/- "
                    "K/(E* sqrt(h)); both are proven for one corner, of which any body is a row.",
                    "Fixed tilt: a'(c) = K_c/K_a and P'(c) = P_c + P_a a'(c) = (pi sqrt(h)/2) K_c.",
                ),
                expected=Verdict.HOLDS,
            ),
        ]
    return tuple(made)


def _near_right() -> Expr:
    """lim p/sqrt(c - x), both vanishing with y = sqrt((c - x)/(a + x))."""
    p_of_y = without_modulus(wedge("pressure")).subs(x, between(r / t, r * t))
    return simplify(simplify(diff(p_of_y, y)).subs(y, 0) / sqrt(r * t + r / t))


def _near_left() -> Expr:
    """lim p/sqrt(a + x), both vanishing with 1/y."""
    p_of_y = without_modulus(wedge("pressure")).subs(x, between(r / t, r * t))
    by_inverse = diff(p_of_y.subs(y, 1 / y), y)
    return simplify(simplify(by_inverse).subs(y, 0) / sqrt(r * t + r / t))


def _text() -> tuple[Claim, ...]:
    return (
        Claim(
            label="section 2/E_star",
            place="section 2, below eq. (5)",
            says="the composite modulus of two equal bodies",
            left=E_star,
            right=E / (2 * (1 - nu**2)),
            meaning={E_star: 2 / (2 * 2 * (1 - nu**2) / E)},
            against="plane strain: each body's surface slopes by 2 (1 - nu^2)/(pi E) a unit load; "
            "both together by 2/(pi E*)",
            ranges={nu: Range(0, 0.5)},
            expected=Verdict.HOLDS,
        ),
        Claim(
            label="section 2/h",
            place="section 2, above eq. (4): h(x, a)",
            says="the argument by which a flat punch is named (x_1 in h(x, x_1))",
            left=x_1,
            right=a,
            meaning={x_1: r * t, a: r / t, c: r * t},
            against="eqs. (3) and (4), where it is the right edge",
            ranges=_SKEW,
            swaps=(a, c),
            expected=Verdict.FAILS,
            consequence=lambda: "none: eq. (4) itself is right",
        ),
    )
