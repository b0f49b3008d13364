"""Section 1: when a contact stays fully stuck."""

from sympy import Expr, Integral, S, Symbol, log, pi, symbols
from sympy import sign as sgn

from derive.paper import anybody
from derive.paper.andresen2020.symbols import R, a, dM, dP, dQ, dsigma, xi
from derive.paper.anybody import K_left, K_right, left, right
from derive.paper.bodies import hertz
from derive.paper.claim import FRACTION, SIGNED, Bound, Claim, Meaning, Range, Relation, Verdict
from derive.symbols import E_star, f, x
from derive.symbols import dQ as change_of_shear
from derive.symbols import dsigma as change_of_tension

_u, _v = Symbol("u", positive=True), Symbol("v", positive=True)
"""How far the left and the right edge move outward."""
_sense = Symbol("sense", real=True)
_share = Symbol("share", positive=True)
"""The part of f K u/2 that K_T is where nothing slips yet."""

_STEPS = (
    "A symmetric body, edges that move by u and v: dP = P_a u + P_c v, dM = M_a u + M_c v.",
    "An edge that moves by u adds K u/(2 sqrt(s)) to the pressure at the old edge.",
    "Full stick adds K_T/sqrt(s) to the shear there; it slips when K_T reaches f K u/2.",
    "dQ is solved from that, and the printed quotient must then be f; for a part of that K_T it "
    "must be less, for a multiple more.",
)


def claims() -> tuple[Claim, ...]:
    """Both signs of eq. (1)."""
    anybody.demand_proven()
    return (*_in_the_sense_of_shear(), *_in_either_sense(), _linear_strain())


def _in_the_sense_of_shear() -> tuple[Claim, ...]:
    return tuple(
        Claim(
            label=f"fullstickinequality/{side}",
            equation="(1)",
            place=f"eq. (1), section 1, {word} signs",
            says=f"no slip starts at the {side} edge of a symmetric contact",
            left=_quotient(sign),
            right=f,
            relation=Relation.BELOW,
            reached=_bound(side),
            meaning=_meaning(side),
            against="the singular terms of full stick and of the growing pressure, for any body",
            ranges={change_of_tension: SIGNED, _share: FRACTION},
            swaps=(dQ, dP, dM),
            steps=_STEPS,
            expected=Verdict.HOLDS,
        )
        for side, word, sign in (("left", "upper", 1), ("right", "lower", -1))
    )


def _in_either_sense() -> tuple[Claim, ...]:
    """The same taken as sufficient, as it must be where tension reverses slip at one edge."""
    return tuple(
        Claim(
            label=f"fullstickinequality/either sense/{side}",
            place=f"eq. (1), section 1, {word} signs, taken as sufficient",
            says=f"no slip of either sense starts at the {side} edge",
            left=_quotient(sign),
            right=f,
            relation=Relation.BELOW,
            reached=_bound(side, sense=sgn(_sense)),
            meaning=_meaning(side, sense=sgn(_sense)),
            against="the singular terms as before, slip of either sense",
            ranges={change_of_tension: SIGNED, _sense: SIGNED, _share: FRACTION},
            steps=(*_STEPS, "For slip of the other sense K_T is -f K u/2, and the quotient -f."),
            expected=Verdict.FAILS,
            consequence=lambda: (
                "where tension outweighs shear the quotient is negative and the inequality is met "
                "however large the tension is: slip of the reversed sense goes unseen"
            ),
        )
        for side, word, sign in (("left", "upper", 1), ("right", "lower", -1))
    )


def _quotient(sign: int) -> Expr:
    """Eq. (1), left-hand side."""
    return (4 * a * dQ + sign * pi * a**2 * dsigma) / (4 * a * dP + sign * 8 * dM)


def _bound(side: str, sense: Expr = S.One) -> Bound:
    """A change of shear at which K_T is a part of f K u/2, and one at which it is more."""
    moved = _u if side == "left" else _v
    allowed, beyond = (
        {dQ: _shear_at_slip(side, sense * f * K_left * moved / 2 * share)}
        for share in (_share, 1 / _share)
    )
    return Bound(allowed, beyond)


def _meaning(side: str, sense: Expr = S.One) -> Meaning:
    symmetric = {right: left, K_right: K_left}
    load = anybody.load_by(left) * _u + anybody.load_by(right) * _v
    moment = anybody.moment_by(left) * _u + anybody.moment_by(right) * _v
    moved = _u if side == "left" else _v
    return {
        a: left,
        dP: load.subs(symmetric),
        dM: moment.subs(symmetric),
        dsigma: change_of_tension,
        dQ: _shear_at_slip(side, sense * f * K_left * moved / 2),
    }


def _shear_at_slip(side: str, strength: Expr) -> Expr:
    """The dQ at which K_T of a symmetric contact has a given value."""
    coefficient = hertz(f"K_T_{side}", left, left)
    rate = coefficient.diff(change_of_shear)
    return (strength - coefficient.subs(change_of_shear, 0)) / rate


_half, _place = Symbol("l", positive=True), Symbol("mu", real=True)
_strain, _gradient = symbols("strain gradient")


def _linear_strain() -> Claim:
    """What is said of Cattaneo's solution: (1/pi) PV int f p/(x - xi) dxi is proportional to x.

    The singularity is taken off: PV int dxi/(x - xi) over [-l, l] is log((l + x)/(l - x)).
    """
    here, there = (
        f * hertz("pressure", _half, _half).subs(x, place) for place in (_half * _place, xi)
    )
    regular = Integral((there - here) / (_half * _place - xi), (xi, -_half, _half))
    singular = here * log((1 + _place) / (1 - _place))
    return Claim(
        label="section 1/Cattaneo",
        place="section 1, second paragraph",
        says="sliding of a cylinder strains the surface in proportion to x",
        left=_strain,
        right=_gradient * x,
        meaning={
            _strain: (regular + singular) / pi,
            _gradient: f * E_star / (2 * R),
            x: _half * _place,
        },
        against="(1/pi) PV int f p/(x - xi) dxi of the cylinder's pressure, by quadrature",
        ranges={_place: Range(-0.9, 0.9)},
        expected=Verdict.NUMERICAL,
    )
