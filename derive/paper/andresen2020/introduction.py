"""Section 1: when a contact stays fully stuck."""

from sympy import Expr, Symbol, pi

from derive.paper import anybody
from derive.paper.andresen2020.symbols import a, dM, dP, dQ, dsigma
from derive.paper.anybody import K_left, K_right, left, right
from derive.paper.bodies import hertz
from derive.paper.claim import SIGNED, Claim, Meaning, Relation, Verdict
from derive.symbols import dQ as change_of_shear
from derive.symbols import dsigma as change_of_tension
from derive.symbols import f

_u, _v = Symbol("u", positive=True), Symbol("v", positive=True)
"""How far the left and the right edge move outward."""

_STEPS = (
    "A symmetric body, edges that move by u and v: dP = P_a u + P_c v, dM = M_a u + M_c v.",
    "An edge that moves by u adds K u/(2 sqrt(s)) to the pressure at the old edge.",
    "Full stick adds K_T/sqrt(s) to the shear there; it slips when K_T reaches f K u/2.",
    "dQ is solved from that, and the printed quotient must then be f.",
)


def claims() -> tuple[Claim, ...]:
    """Both signs of eq. (1)."""
    anybody.demand_proven()
    return tuple(
        Claim(
            label=f"fullstickinequality/{side}",
            equation="(1)",
            place=f"eq. (1), section 1, {word} signs",
            says=f"no slip starts at the {side} edge of a symmetric contact",
            left=(4 * a * dQ + sign * pi * a**2 * dsigma) / (4 * a * dP + sign * 8 * dM),
            right=f,
            relation=Relation.BOUND,
            meaning=_meaning(side),
            against="the singular terms of full stick and of the growing pressure, for any body",
            ranges={change_of_tension: SIGNED},
            swaps=(dQ, dP, dM),
            steps=_STEPS,
            expected=Verdict.HOLDS,
        )
        for side, word, sign in (("left", "upper", 1), ("right", "lower", -1))
    )


def _meaning(side: str) -> Meaning:
    symmetric = {right: left, K_right: K_left}
    load = anybody.load_by(left) * _u + anybody.load_by(right) * _v
    moment = anybody.moment_by(left) * _u + anybody.moment_by(right) * _v
    moved = _u if side == "left" else _v
    return {
        a: left,
        dP: load.subs(symmetric),
        dM: moment.subs(symmetric),
        dsigma: change_of_tension,
        dQ: _shear_at_slip(side, f * K_left * moved / 2),
    }


def _shear_at_slip(side: str, strength: Expr) -> Expr:
    """The dQ at which K_T of a symmetric contact has a given value."""
    coefficient = hertz(f"K_T_{side}", left, left)
    rate = coefficient.diff(change_of_shear)
    return (strength - coefficient.subs(change_of_shear, 0)) / rate
