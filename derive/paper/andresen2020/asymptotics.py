"""Section 3: edge terms of the tractions, and slip zones from them."""

from typing import Any

from sympy import Abs, Expr, Integral, S, Symbol, diff, pi, sqrt

from derive.paper.andresen2020.mossakovskii import _near_left
from derive.paper.andresen2020.symbols import (
    K_N,
    K_N1,
    K_N2,
    K_Q1,
    K_Q2,
    K_T,
    P_S,
    P_Z,
    Q_1,
    Q_2,
    Delta_a,
    Delta_K_T,
    Delta_Q,
    Delta_q,
    P,
    Q,
    Q_i,
    a,
    a_1,
    a_2,
    d_1,
    d_2,
    d_i,
    dp_dP,
    dP_dQ,
    m,
    p,
    p_S,
    p_Z,
    q,
    q_1,
    q_2,
    sigma,
    x_1,
)
from derive.paper.bodies import at, formula, hertz, r, t, wedge
from derive.paper.claim import SIGNED, Claim, Convention, Range, Relation, Verdict
from derive.symbols import a as edge
from derive.symbols import c as other
from derive.symbols import dQ, dsigma, f, w, x

_size = Symbol("l", positive=True)
_rate = Symbol("lambda", positive=True)
_grown = Symbol("delta", real=True)
"""How much further the edge reaches at end 2 than at end 1, signed."""
_SLIP = {d_1: Range(0.05, 0.3), d_2: Range(0.05, 0.3)}

CONTRADICTED = (
    "eq. (1), section 1, and eq. (32), section 4.2: with dQ > 0 a positive tension "
    "loads the left edge more"
)


def claims() -> tuple[Claim, ...]:
    """Eqs. (10) to (20), and what the text says beside them."""
    return (*_terms(), *_tangential(), *_tractions(), *_differences(), *_zones(), *_on_the_way())


def _terms() -> tuple[Claim, ...]:
    return (
        Claim(
            label="eq:normalasymptote/p",
            equation="(10)",
            place="eq. (10), section 3, first part",
            says="the pressure next to the left edge",
            left=p,
            right=K_N * sqrt(a + x),
            relation=Relation.LIKE,
            meaning={p: _near_left() * sqrt(r / t + x), a: r / t, K_N: wedge("K_N_left")},
            against="the limit of p(x)/sqrt(a + x) of a tilted wedge",
            ranges={x: Range(-0.1, 0.1)},
            expected=Verdict.HOLDS,
        ),
        Claim(
            label="eq:normalasymptote/q",
            equation="(10)",
            place="eq. (10), section 3, second part",
            says="the change of shear of a stuck contact next to the left edge",
            left=q,
            right=K_T / sqrt(a + x),
            relation=Relation.LIKE,
            meaning={
                q: _singular_term() / sqrt(r / t + x),
                a: r / t,
                K_T: wedge("K_T_left"),
            },
            against="the limit of sqrt(a + x) dq(x) in full stick",
            ranges={x: Range(-0.1, 0.1), dsigma: SIGNED},
            expected=Verdict.HOLDS,
        ),
    )


def _singular_term() -> Expr:
    """lim sqrt(a + x) dq of full stick at the left edge, which is the same for every body."""
    numerator = (formula("hertz", "full_stick_change") * w / sqrt(other - x)).subs(x, -edge)
    return at(numerator, r / t, r * t)


def _tangential() -> tuple[Claim, ...]:
    made = []
    for side, sign in (("left", 1), ("right", -1)):
        ours = hertz(f"K_T_{side}", _size, _size)
        flipped = Convention(
            "K_T with the opposite sign, as if shear were positive towards the edge",
            {K_T: -ours},
            "eq. (1), section 1, lower signs, where Q keeps its sign and the tension changes it; "
            "eq. (32), section 4.2, does the same",
        )
        made.append(
            Claim(
                label=f"section 3/K_T/{side}",
                equation="(11)",
                place=f"eq. (11), section 3, {'upper' if sign > 0 else 'lower'} sign",
                says=f"the coefficient of the stuck shear at the {side} edge",
                left=K_T,
                right=sign * Q / (pi * sqrt(2 * a)) + sigma / 4 * sqrt(a / 2),
                source=f"K_T = {'' if sign > 0 else '-'}Q/(pi*sqrt(2*a)) + (sigma/4)*sqrt(a/2)",
                meaning={K_T: ours, Q: dQ, sigma: dsigma, a: _size},
                against="the edge limit of full stick in a symmetric contact",
                ranges={dsigma: SIGNED},
                conventions=(flipped,),
                swaps=(Q, sigma),
                expected=Verdict.HOLDS if sign > 0 else Verdict.CONVENTION,
                consequence=None if sign > 0 else _sign_of_right_edge,
            )
        )
    return tuple(made)


def _sign_of_right_edge() -> str:
    return (
        "used in eq. (20) it gives a negative slip zone at the right edge for shear alone; by size "
        "it is right"
    )


# ------------------------------------------------------------------ tractions by superposition

_accumulated = Integral(dp_dP * dP_dQ, (P, 0, P_Z))
_load, _current, _permanent = (Symbol(n, positive=True) for n in ("P", "P_S", "P_Z"))


def _tractions() -> tuple[Claim, ...]:
    resultants = {
        p: _load,
        p_S: _current,
        p_Z: _permanent,
        P_S: _current,
        P_Z: _permanent,
        dp_dP: S.One,
        dP_dQ: 1 / _rate,
    }
    steps = (
        "Both sides are integrated over the contact: int p dx = P, int dp/dP dx = 1.",
        "On the loading path Q = lambda P, so the stuck shear up to P_Z carries lambda P_Z, and "
        "each later term f times its load.",
        "dP/dQ = 1/lambda makes the stuck part P_Z/lambda; dQ/dP makes it lambda P_Z.",
    )
    forms = (
        ("eq:CJshear", "(12)", q_1, _accumulated + f * p - 2 * f * p_S + f * p_Z),
        ("eq:CJshear2", "(14)", q_2, _accumulated - f * p + f * p_Z),
    )
    totals = {
        q_1: _rate * _permanent + f * (_load - 2 * _current + _permanent),
        q_2: _rate * _permanent - f * (_load - _permanent),
    }
    made = [
        Claim(
            label=label,
            equation=number,
            place=f"eq. {number}, section 3.1",
            says="the shear traction by superposed pressures",
            left=left,
            right=right,
            meaning=resultants | {left: totals[left]},
            against="tangential equilibrium on the loading path Q = lambda P",
            swaps=(dP_dQ,),
            steps=steps,
            expected=Verdict.FAILS,
            consequence=lambda: (
                "the locked-in shear is wrong by the square of the load path's slope: for "
                f"Q = 0.3 P it is {1 / 0.3**2:.1f} times too large; the permanent stick zone does "
                "not depend on it"
            ),
        )
        for label, number, left, right in forms
    ]
    return (*made, _sense(), *_asymptotic_tractions())


def _sense() -> Claim:
    first, second = (Symbol(f"P_{i}", positive=True) for i in (1, 2))
    locked = Symbol("Q_Z", real=True)
    larger = locked + f * (first - _permanent)
    smaller = locked - f * (second - _permanent)
    return Claim(
        label="eq:CJshear/sense",
        place="section 3.1, eqs. (12) and (14), with the ends named as in figure 2",
        says="Q_2 - Q_1, the resultants of the two tractions, is the range of the shear load",
        left=q_2 - q_1,
        right=Delta_Q,
        meaning={
            q_1: larger,
            q_2: smaller,
            Delta_Q: 2 * f * ((first + second) / 2 - _permanent),
        },
        against="eq. (28): the permanent stick zone carries P_0 - Delta Q/(2 f)",
        ranges={locked: SIGNED},
        conventions=(
            Convention(
                "the tractions of ends 1 and 2 exchanged, or shear with the opposite sign",
                {q_1: smaller, q_2: larger},
                "section 1 and figure 2, where 2 is the end of the largest loads",
            ),
        ),
        steps=(
            "At both ends P_S = P_Z: the resultants are Q_Z + f (P_1 - P_Z) by eq. (12) and "
            "Q_Z - f (P_2 - P_Z) by eq. (14), Q_Z what is locked in.",
            "They differ by f (P_1 + P_2 - 2 P_Z) = Delta Q > 0: the traction called q_1 is that "
            "of the larger shear load.",
        ),
        expected=Verdict.CONVENTION,
        consequence=lambda: "the plotted shear traction has the wrong sign; slip zones keep theirs",
    )


def _edge_terms() -> dict[Symbol, Expr]:
    """q_1 and q_2 with every pressure replaced by its term at its own edge."""
    outer_1, outer_2 = sqrt(x + a_1), sqrt(x + a_2)
    inner_1, inner_2 = sqrt(x + a_1 - d_1), sqrt(x + a_2 - d_2)
    return {
        q_1: K_Q1 * inner_1 + f * K_N1 * (outer_1 - 2 * inner_1 + inner_2),
        q_2: K_Q2 * inner_2 - f * K_N2 * (outer_2 - inner_2),
    }


def _asymptotic_tractions() -> tuple[Claim, ...]:
    against = "the traction that it replaces, every pressure by K sqrt(distance to its own edge)"
    first = (
        K_Q1 * sqrt(x + a_1 - d_1)
        + f * K_N1 * sqrt(x + a_1)
        - 2 * f * K_N1 * sqrt(x_1 + a_1 - d_1)
        + f * K_N1 * sqrt(x + a_2 - d_2)
    )
    second = K_Q2 * sqrt(x + a_2 - d_2) - f * K_N2 * sqrt(x + a_2) + f * K_N2 * sqrt(x + a_2 - d_2)
    shared: dict[str, Any] = {"against": against, "ranges": {**_SLIP, x: Range(0.1, 2)}}
    return (
        Claim(
            label="eq:asymTan1",
            equation="(13)",
            place="eq. (13), section 3.1",
            says="the edge terms of the first traction",
            left=q_1,
            right=first,
            meaning={q_1: _edge_terms()[q_1]},
            swaps=(x_1, x),
            expected=Verdict.FAILS,
            consequence=lambda: "none: eq. (16) has the right letter",
            **shared,
        ),
        Claim(
            label="eq:asymTan2",
            equation="(15)",
            place="eq. (15), section 3.1",
            says="the edge terms of the second traction",
            left=q_2,
            right=second,
            meaning={q_2: _edge_terms()[q_2]},
            swaps=(a_1, a_2, d_1, d_2),
            expected=Verdict.HOLDS,
            **shared,
        ),
    )


# ------------------------------------------------------------------ their difference


def _differences() -> tuple[Claim, ...]:
    terms = _edge_terms()
    root = {n: sqrt(x + edge_) for n, edge_ in ((1, a_1), (2, a_2))}
    inner = {1: sqrt(x + a_1 - d_1), 2: sqrt(x + a_2 - d_2)}
    full = (
        K_Q1 * inner[1]
        + f * K_N1 * root[1]
        - 2 * f * K_N1 * inner[1]
        + f * K_N1 * inner[2]
        - (K_Q2 * inner[2] - f * K_N2 * root[2] + f * K_N2 * inner[2])
    )
    limit = f * K_N * (root[1] - 2 * inner[1] + inner[2] + root[2] - inner[2])
    one = {K_N1: K_N, K_N2: K_N, K_Q2: K_Q1, d_1: a_1 - m, d_2: a_2 - m}
    return (
        Claim(
            label="section 3.2/difference",
            equation="(16)",
            place="eq. (16), section 3.2, both parts",
            says="the difference of the two tractions, written out",
            left=Delta_q,
            right=full,
            source="Delta_q = K_Q1*sqrt(x + a_1 - d_1) + f*K_N1*sqrt(x + a_1) "
            "- 2*f*K_N1*sqrt(x + a_1 - d_1) + f*K_N1*sqrt(x + a_2 - d_2) "
            "- (K_Q2*sqrt(x + a_2 - d_2) - f*K_N2*sqrt(x + a_2) + f*K_N2*sqrt(x + a_2 - d_2))",
            meaning={Delta_q: terms[q_1] - terms[q_2]},
            against="eq. (13), as corrected, less eq. (15)",
            ranges={**_SLIP, x: Range(0.1, 2)},
            swaps=(a_1, a_2, d_1, d_2),
            expected=Verdict.HOLDS,
        ),
        Claim(
            label="section 3.2/limit",
            equation="(17)",
            place="eq. (17), section 3.2",
            says="the difference once the coefficients of both ends are taken as one",
            left=Delta_q,
            right=limit,
            meaning={Delta_q: full.subs(one), d_1: a_1 - m, d_2: a_2 - m},
            against="eq. (16) with K_N1 = K_N2, K_Q1 = K_Q2 and one permanent stick zone, "
            "a_1 - d_1 = a_2 - d_2 = m",
            source="Delta_q = f*K_N*(sqrt(x + a_1) - 2*sqrt(x + a_1 - d_1) + sqrt(x + a_2 - d_2) "
            "+ sqrt(x + a_2) - sqrt(x + a_2 - d_2))",
            ranges={m: Range(0.05, 0.3), x: Range(0.1, 2)},
            swaps=(a_1, a_2, d_1, d_2),
            expected=Verdict.HOLDS,
        ),
    )


def far_term() -> Expr:
    """lim sqrt(x + a_1) Delta q of eq. (17) far from the edge, by z = 1/sqrt(x + a_1).

    Delta q = (f K_N/z) (1 - 2 sqrt(1 - d_1 z**2) + sqrt(1 + delta z**2)); over z, with v = z**2.
    """
    v = Symbol("v", positive=True)
    bracket = 1 - 2 * sqrt(1 - d_1 * v) + sqrt(1 + _grown * v)
    return f * K_N * diff(bracket, v).subs(v, 0)


def _zones() -> tuple[Claim, ...]:
    far = far_term()
    zones = {d_2: d_1 + _grown, Delta_a: _grown}
    grows = {_grown: Range(0.01, 0.3), d_1: Range(0.05, 0.3)}
    printed = f * K_N * (2 * (d_2 / (2 * sqrt(x + a_1))) + Delta_a / (2 * sqrt(x + a_1)))
    opposite = Convention(
        "Delta K_T with the opposite sign in this part alone",
        {Delta_K_T: -far},
        "eq. (19), section 3.2, which gives Delta K_T one sign for both ends",
    )
    shared: dict[str, Any] = {"equation": "(20)", "ranges": grows, "swaps": (d_1, d_2)}
    first = -Delta_K_T / (f * K_N) - Delta_a / 2
    second = Delta_K_T / (f * K_N) + Delta_a / 2
    balance = "eq. (17) far from the edge: Delta K_T = f K_N (d_1 + (a_2 - a_1)/2)"
    return (
        Claim(
            label="eq:DeltaQApprox",
            equation="(18)",
            place="eq. (18), section 3.2",
            says="the difference far from the edge",
            left=Delta_q,
            right=printed,
            relation=Relation.LIKE,
            source="Delta_q ~ f*K_N*(2*(d_2/(2*sqrt(x + a_1)) + ...) + Delta_a/(2*sqrt(x + a_1)))",
            meaning=zones | {Delta_q: far / sqrt(x + a_1)},
            against="the limit of sqrt(x + a_1) times eq. (17)",
            ranges={**grows, x: Range(0.1, 2)},
            swaps=(d_1, d_2),
            steps=(
                "One permanent stick zone: d_2 = d_1 + a_2 - a_1, so two terms of eq. (17) cancel.",
                "sqrt(X) - 2 sqrt(X - d_1) + sqrt(X + Delta a) = (d_1 + Delta a/2)/sqrt(X) + ...",
            ),
            expected=Verdict.FAILS,
            consequence=lambda: (
                "solved for d_2 as printed it gives K_T/(f K_N) - Delta a/2, which contradicts "
                "eq. (20): with a varying load the slip zone at end 2 is too short by Delta a"
            ),
        ),
        Claim(
            label="eq:DeltaQKT",
            equation="(19)",
            place="eq. (19), section 3.2",
            says="the same as the singular term of full stick",
            left=Delta_q,
            right=Delta_K_T / sqrt(x + a_1),
            relation=Relation.LIKE,
            meaning={
                Delta_q: _singular_term() / sqrt(x + r / t),
                Delta_K_T: wedge("K_T_left"),
                a_1: r / t,
            },
            against="the limit of sqrt(a + x) dq(x) in full stick",
            ranges={x: Range(-0.1, 0.1), dsigma: SIGNED},
            expected=Verdict.HOLDS,
        ),
        Claim(
            label="eq:slipAsymptotes/1",
            place="eq. (20), section 3.2, first part",
            says="the slip zone at end 1",
            left=d_1,
            right=first,
            meaning={Delta_K_T: far, Delta_a: _grown},
            against=balance,
            conventions=(opposite,),
            expected=Verdict.CONVENTION,
            consequence=lambda: (
                "with Delta K_T of eq. (32), in which Delta Q is a range, the printed slip zone at "
                "end 1 is negative"
            ),
            **shared,
        ),
        Claim(
            label="eq:slipAsymptotes/2",
            place="eq. (20), section 3.2, second part",
            says="the slip zone at end 2",
            left=d_2,
            right=second,
            meaning=zones | {Delta_K_T: far},
            against=balance,
            expected=Verdict.HOLDS,
            **shared,
        ),
        Claim(
            label="section 3.2/Delta_a",
            place="section 3.2, below eq. (19)",
            says="the change of contact size is a modulus",
            left=Delta_a,
            right=Abs(a_2 - a_1),
            through=(d_2, second),
            meaning={
                d_2: d_1 + _grown,
                Delta_K_T: far,
                a_1: _size,
                a_2: _size + _grown,
            },
            against=f"{balance}, with edges that may also draw back",
            ranges={_grown: Range(-0.3, 0.3), d_1: Range(0.35, 0.6)},
            swaps=(a_1, a_2),
            expected=Verdict.FAILS,
            consequence=_edge_that_draws_back,
        ),
    )


def _edge_that_draws_back() -> str:
    return (
        "at an edge that draws back while Q grows, as one edge of a contact does when the moment "
        "varies, half the change is added where it must be taken off: the slip zone is too long "
        "there by |a_2 - a_1|"
    )


# ------------------------------------------------------------------ on the way from end to end

_smaller, _stick = Symbol("l", positive=True), Symbol("l_s", positive=True)
_growth = Symbol("l_more", positive=True)
_rest = Symbol("q_rest", positive=True)
"""By how much Q grows from the instant i to the end 2."""


def _on_the_way() -> tuple[Claim, ...]:
    """The last paragraph of section 3.2: the slip zone at an instant i of the cycle.

    An untilted wedge, P = E* phi a, on which edge terms are exact.  Since the last end of the cycle
    slip is f (P_e + P_i) - 2 f P_s in all, P_s the load whose contact is the stick zone.
    """

    larger = _smaller + _growth
    shear = f * (_carried(_smaller) + _carried(larger)) - 2 * f * _carried(_stick)

    def stuck(half: Expr) -> Expr:
        return wedge("K_T_left", half, S.One).subs({dQ: Delta_Q, dsigma: 0})

    from_the_end = stuck(larger) / (f * wedge("K_N_left", larger, S.One)) + Delta_a / 2
    falling = Claim(
        label="section 3.2/instant/from 2 to 1",
        place="section 3.2, last paragraph, while the loads fall from end 2",
        says="the slip zone at any instant, by Delta Q = Q_2 - Q_i, K_N of that instant and "
        "Delta a = |a_2 - a_i|",
        left=d_i,
        right=Delta_K_T / (f * K_N) - Delta_a / 2,
        meaning={
            d_i: _smaller - _stick,
            Delta_K_T: stuck(_smaller).subs(Delta_Q, shear),
            K_N: wedge("K_N_left", _smaller, S.One),
            Delta_a: _growth,
        },
        against="an untilted wedge: the shear since end 2 is f (P_2 + P_i) - 2 f P_s, slip of one "
        "sense over the whole way",
        steps=(
            "Eq. (20), first part, as corrected, with a_i and Q_i in the place of a_1 and Q_1.",
        ),
        expected=Verdict.HOLDS,
    )
    rising = Claim(
        label="section 3.2/instant/from 1 to 2",
        place="section 3.2, last paragraph, while the loads grow from end 1",
        says="at every point of the cycle the shear that counts is Q_2 - Q_i",
        left=Delta_Q,
        right=Q_2 - Q_i,
        through=(d_i, from_the_end),
        meaning={
            d_i: larger - _stick,
            Q_1: _rate,
            Q_i: _rate + shear,
            Q_2: _rate + shear + _rest,
            Delta_a: _growth,
        },
        against="an untilted wedge: the shear since end 1 is f (P_1 + P_i) - 2 f P_s, and "
        "eq. (20), second part",
        swaps=(Q_1, Q_2, Q_i),
        steps=(
            "Slip turns round at both ends of the cycle: loads count from the last one passed.",
            "At end 2 itself Q_2 - Q_i is zero, where eq. (20) has its largest slip zone.",
        ),
        expected=Verdict.FAILS,
        consequence=lambda: (
            "read so, the slip zone shrinks while Q grows, down to Delta a/2 at end 2, where it is "
            "largest; counted from the last end of the cycle it is right on both ways"
        ),
    )
    return (falling, rising)


def _carried(half: Expr) -> Expr:
    return wedge("load", half, S.One)
