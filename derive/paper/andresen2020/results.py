"""Section 5: what the comparison of exact and asymptotic solutions is said to show."""

from collections.abc import Callable
from typing import Any

from mpmath import mpf
from sympy import Abs, Expr, Integral, S, Symbol, pi, sqrt
from sympy import sign as sgn

from derive.paper import exact
from derive.paper.andresen2020.consequences import (
    slip_of_a_tilted_wedge,
    tilt_at_mean_loads,
    validity_of_the_bound,
    varying_moment,
)
from derive.paper.andresen2020.large import conditions, opposite_tension
from derive.paper.andresen2020.symbols import (
    K_N,
    P_0,
    Delta_K_T,
    Delta_Q,
    Delta_sigma,
    Delta_sigma_th,
    a,
    alpha_0,
    d,
    d_1,
    d_2,
    d_LHS,
    d_RHS,
    m,
    n,
    p,
    phi,
    xi,
)
from derive.paper.andresen2020.wedge import direction_claim, edge_printed, stuck, threshold_claim
from derive.paper.bodies import formula, r, t, wedge
from derive.paper.claim import FRACTION, SIGNED, Claim, Point, Range, Relation, Verdict
from derive.symbols import E_star, M, P, dQ, dsigma, e, f, x

_rs = Symbol("r_s", positive=True)
_r1, _r2 = Symbol("r_1", positive=True), Symbol("r_2", positive=True)
_mu, _nu = Symbol("mu_m", positive=True), Symbol("mu_n", positive=True)
_part = Symbol("rho", positive=True)
_exact = {side: Symbol(f"d_exact_{side}", positive=True) for side in ("left", "right")}
_small, _large = Symbol("error_1", real=True), Symbol("error_2", real=True)

_SHEAR = mpf("0.3")
_CARRIED = S(17) / 20
"""1 - 0.3/2: the part of the load that the stick zone carries at Delta Q = 0.3 f P."""


def claims() -> tuple[Claim, ...]:
    """Eqs. (35) to (39), and what the text concludes."""
    return (
        _one_end_at_a_time(),
        *_constant_load(),
        *_varying_load(),
        direction_claim(),
        threshold_claim(),
        *_conditions_of_large_tension(),
        *_text_on_tension(),
        *_text_on_tilt(),
    )


# ------------------------------------------------------------------ 5, before 5.1


def _one_end_at_a_time() -> Claim:
    """Eq. (20) where tension has turned the sense of slip: K_T is negative there."""
    turned = Symbol("sense", real=True)
    slip, pressed = Symbol("l_d", positive=True), Symbol("K", positive=True)
    return Claim(
        label="section 5/one end at a time",
        place="section 5, before section 5.1, on eq. (20)",
        says="whether the tension is moderate or large is irrelevant to the edge terms (constant "
        "normal load)",
        left=d,
        right=Delta_K_T / (f * K_N),
        meaning={d: slip, Delta_K_T: sgn(turned) * f * pressed * slip, K_N: pressed},
        against="the edge terms for slip of either sense, |K_T| = f K_N d",
        ranges={turned: SIGNED},
        steps=(
            "Slip changes its sign with K_T; the zone where f K_N sqrt(s) is reached does not.",
            "Where the tension is large K_T is negative at one edge.",
        ),
        expected=Verdict.FAILS,
        consequence=lambda: (
            "with eqs. (20) and (32) as printed the slip zone is negative at the edge where a "
            "large tension turns the slip; its modulus is right to first order"
        ),
    )


# ------------------------------------------------------------------ 5.1 constant normal load

_SHARED = 1 / (E_star * phi) * (Delta_Q / (2 * f))


def _constant_load() -> tuple[Claim, ...]:
    shear = 2 * f * (wedge("load", r, S.One) - wedge("load", _rs, S.One))
    straight = {
        d: r - _rs,
        a: r,
        m: _rs,
        Delta_Q: shear,
        Delta_K_T: wedge("K_T_left", r, S.One).subs({dQ: shear, dsigma: 0}),
        K_N: wedge("K_N_left", r, S.One),
    }
    edges = Delta_K_T / (f * K_N)
    made = [
        Claim(
            label=label,
            equation=number,
            place=f"eq. {number}, section 5.1, {part}",
            says=says,
            left=left,
            right=right,
            meaning=straight,
            against=against,
            swaps=swaps,
            expected=Verdict.HOLDS,
        )
        for label, number, part, says, left, right, against, swaps in (
            (
                "am/zone",
                "(35)",
                "first part",
                "slip zone of an untilted wedge",
                d,
                a - m,
                _EXACT,
                (a, m),
            ),
            (
                "am/value",
                "(35)",
                "second part",
                "its length in closed form",
                a - m,
                _SHARED,
                _EXACT,
                (a, m),
            ),
            ("d/zone", "(36)", "first part", "the same by edge terms", d, edges, _EXACT, ()),
            (
                "d/value",
                "(36)",
                "second part",
                "the same in closed form",
                edges,
                _SHARED,
                _EDGES,
                (),
            ),
        )
    ]
    return (*made, _reason(), _exact_when_tilted())


_EXACT = "the stick zone is the wedge's contact at load P - Delta Q/(2 f)"
_EDGES = "K_T and K_N of the untilted wedge, from its sheet"


def _reason() -> Claim:
    """d = Delta Q/(2 f P'(a)) on any symmetric body; exact where the load is linear in a."""
    rate, curve = Symbol("P_1", positive=True), Symbol("P_2", positive=True)
    width, slip = Symbol("l", positive=True), Symbol("d", positive=True)

    def load(half: Expr) -> Expr:
        return rate * half + curve * half**2

    shear = 2 * f * (load(width) - load(width - slip))
    return Claim(
        label="section 5.1/reason",
        place="section 5.1, below eq. (36)",
        says="edge terms are exact because load and contact size are proportional",
        left=d,
        right=Delta_Q / (2 * f * K_N),
        meaning={
            d: slip,
            Delta_Q: shear.subs(curve, 0),
            K_N: load(width).diff(width).subs(curve, 0),
        },
        against="any symmetric body, K_T/(f K_N) = Delta Q/(2 f P'(a)), here with P = P_1 a "
        "(K_N stands for P')",
        steps=(
            "K_T = dQ/(pi sqrt(2 a)), K_N = (2/pi) P'(a)/sqrt(2 a), so d = dQ/(2 f P'(a)).",
            "Exactly P(a) - P(a - d) = dQ/(2 f); with P = P_1 a + P_2 a**2 edge terms give "
            "d - d**2 P_2/(P_1 + 2 P_2 a): too little, unless P_2 = 0.",
        ),
        expected=Verdict.HOLDS,
    )


def _exact_when_tilted() -> Claim:
    """Not said in the paper: with the right K_T the tilted wedge is exact, too."""
    shear = 2 * f * (wedge("load") - wedge("load", _rs, t))
    stuck_left = wedge("K_T_left").subs({dQ: shear, dsigma: 0})
    return Claim(
        label="section 5.1/tilted",
        place="section 5.4 with K_T as corrected below eq. (32)",
        says="edge terms are exact for a tilted wedge without tension, left edge",
        left=d_LHS,
        right=Delta_K_T / (f * K_N),
        meaning={d_LHS: (r - _rs) / t, Delta_K_T: stuck_left, K_N: wedge("K_N_left")},
        against="the stick zone is the wedge's contact at load P - Delta Q/(2 f) and the same tilt",
        expected=Verdict.HOLDS,
    )


# ------------------------------------------------------------------ 5.2 varying normal load


def _varying_load() -> tuple[Claim, ...]:
    """Edge terms against exact at both ends, with Delta a signed as it must be."""
    mean = (_r1 + _r2) / 2
    shear = 2 * f * (wedge("load", mean, S.One) - wedge("load", _rs, S.One))
    made = []
    for end, size, zone, sign in ((1, _r1, d_1, -1), (2, _r2, d_2, 1)):
        stuck_here = wedge("K_T_left", size, S.One).subs({dQ: shear, dsigma: 0})
        asymptotic = stuck_here / (f * wedge("K_N_left", size, S.One)) + sign * (_r2 - _r1) / 2
        where, word, relation = (
            ("minimum", "under", Relation.BELOW)
            if end == 1
            else ("maximum", "over", Relation.ABOVE)
        )
        made.append(
            Claim(
                label=f"section 5.2/{word}estimated",
                place="section 5.2, on figure 8",
                says=f"edge terms {word}estimate the slip zone at the {where} load",
                left=zone,
                right=_exact["left"],
                relation=relation,
                meaning={zone: asymptotic, _exact["left"]: size - _rs},
                against="eq. (20), as corrected, with K_T and K_N at that end, and a - m",
                steps=(
                    "On a wedge K_T/(f K_N) is Delta Q/(2 f E* phi) at either end, and a is "
                    "proportional to P: both ends are exact, for any Delta P.",
                ),
                expected=Verdict.FAILS,
                consequence=lambda: "none: the result is better than is said, error 0",
            )
        )
    made.append(
        Claim(
            label="section 5.2/error",
            place="section 5.2: the error is below 5 %",
            says="relative error of the slip zone at Delta Q = f P, Delta P = 0.15 P, minimum load",
            left=_large,
            right=S(5) / 100,
            relation=Relation.BELOW,
            meaning={_large: _error_of_varying()},
            against="eq. (20), as corrected, and a - m; the error is in fact zero",
            expected=Verdict.NUMERICAL,
        )
    )
    made.append(_independent_of_variation())
    return tuple(made)


def _error_of_varying() -> Expr:
    """The modulus of d/(a - m) - 1 at the minimum load, Delta Q = f P_0, Delta P = 0.15 P_0."""
    size = r * (1 - S(15) / 200)
    shear = f * wedge("load", r, S.One)
    zone = wedge("K_T_left", size, S.One).subs({dQ: shear, dsigma: 0})
    zone = zone / (f * wedge("K_N_left", size, S.One)) - r * S(15) / 200
    return Abs(zone / (size - r / 2) - 1)


def _independent_of_variation() -> Claim:
    """alpha_0 is the mean of two tilts, which is not the tilt at the mean of the loads."""
    ends = [tuple(Symbol(f"{k}_{i}", positive=True) for k in ("P", "M")) for i in (1, 2)]
    tilt = formula("wedge", "contact_alpha")

    def at_loads(load: Expr, moment: Expr) -> Expr:
        return tilt.subs(e, moment / load).subs({P: load, M: moment}, simultaneous=True)

    (p1, m1), (p2, m2) = ends
    return Claim(
        label="section 4.1/alpha_0(M_0, P_0)",
        place="section 4.1, below eq. (29): the stick zone does not depend on Delta P and Delta M",
        says="alpha_0 is the tilt at the mean load and the mean moment",
        left=alpha_0,
        right=Symbol("alpha_of_means"),
        meaning={
            alpha_0: (at_loads(p1, m1) + at_loads(p2, m2)) / 2,
            Symbol("alpha_of_means"): at_loads((p1 + p2) / 2, (m1 + m2) / 2),
        },
        against="the mean of the tilts of the sheet under both loads, eq. (29)",
        steps=("The tilt is no linear function of P and M, so its mean depends on their ranges.",),
        expected=Verdict.FAILS,
        consequence=tilt_at_mean_loads,
    )


# ------------------------------------------------------------------ 5.3 bulk tension


def _conditions_of_large_tension() -> tuple[Claim, ...]:
    pressure = wedge("pressure", r, S.One)
    place = {a: r, m: r * _mu, n: r * _nu}
    meaning = {**place, **conditions(pressure, r, place[m], place[n]), p: pressure.subs(x, xi)}
    root = sqrt((xi - n) * (xi + m))

    def printed(power: int) -> Expr:
        over = xi**power * f * p * sgn(xi) / root
        return -Integral(over, (xi, -a, -m)) + Integral(over, (xi, n, a))

    shared: dict[str, Any] = {
        "meaning": meaning,
        "against": "the two conditions of stick in similar bodies, slip of opposite signs",
        "ranges": {_mu: FRACTION, _nu: FRACTION},
        "conventions": (opposite_tension(pressure, r, place[m], place[n]),),
        "family": "large tension, wedge",
        "swaps": (m, n),
        "steps": (
            "In the stick zone (1/pi) PV int dq/(x - xi) dxi = dsigma/4, int dq = dQ.",
            "Bounded at both ends of the stick zone: int r/w = -pi dsigma/4, "
            "int r xi/w = dQ + pi dsigma (m - n)/8.",
            "r = +2 f p at the left and -2 f p at the right edge, if dsigma loads the left more.",
        ),
    }
    return (
        Claim(
            label="eq17",
            equation="(38)",
            place="eq. (38), section 5.3",
            says="the condition of strain under large tension",
            left=Delta_sigma * pi / 8,
            right=printed(0),
            expected=Verdict.NUMERICAL,
            **shared,
        ),
        Claim(
            label="eq18",
            equation="(39)",
            place="eq. (39), section 5.3",
            says="the condition of force under large tension",
            left=Delta_Q / 2 + (n - m) * Delta_sigma * pi / 16,
            right=printed(1),
            expected=Verdict.CONVENTION,
            consequence=lambda: (
                "m and n come out exchanged: the longer slip zone is at the right edge for a "
                "tension that by eq. (32) loads the left edge more"
            ),
            **shared,
        ),
    )


def _bound(skew: Expr = S.One) -> Expr:
    """Delta sigma_th, eq. (37) as corrected, at Delta Q = 0.3 f P."""
    return 4 * f * E_star * (wedge("tilt", r, skew) - wedge("tilt", r, skew / _CARRIED))


def _text_on_tension() -> tuple[Claim, ...]:
    shear = 2 * f * wedge("load", r, S.One) * (1 - _CARRIED)
    loads = {dQ: shear, dsigma: 2 * _bound()}
    made = []
    for side, sign in (("left", 1), ("right", -1)):
        stuck_here = sign * wedge(f"K_T_{side}", r, S.One).subs(loads, simultaneous=True)
        zone = stuck_here / (f * wedge(f"K_N_{side}", r, S.One))
        made.append(
            Claim(
                label=f"section 5.3/overestimated/{side}",
                place="section 5.3, on figure 9 b): Delta sigma is twice the threshold",
                says=f"edge terms overestimate the slip zone at the {side} edge",
                left=d,
                right=_exact[side],
                relation=Relation.ABOVE,
                meaning={d: zone},
                samples={_exact[side]: _exact_large(side, 2)},
                against="both conditions of stick solved at 20 digits, Delta Q = 0.3 f P: one "
                "number, as both sides are proportional to the contact",
                cases=(dict.fromkeys((r, phi, E_star, f), "1"),),
                expected=Verdict.NUMERICAL,
            )
        )
    return (*made, *_accuracy_falls(), _end_of_exactness())


def _exact_large(side: str, factor: float) -> Callable[[Point], mpf]:
    """The exact slip zone of an untilted wedge at `factor` times the threshold."""

    def sample(point: Point) -> mpf:
        tension = factor * exact.threshold(mpf(1), _SHEAR)
        zones = dict(zip(("left", "right"), exact.large(mpf(1), _SHEAR, tension), strict=True))
        return point[r] * (1 - zones[side])

    return sample


def _error(side: str, factor: str, relative: bool) -> Callable[[Point], mpf]:
    """Modulus of the error of edge terms, as a part of the exact slip zone or of the half-width."""

    def sample(point: Point) -> mpf:
        tension = mpf(factor) * exact.threshold(mpf(1), _SHEAR)
        place = ("left", "right").index(side)
        zone = 1 - exact.large(mpf(1), _SHEAR, tension)[place]
        error = abs(exact.leading(mpf(1), _SHEAR, tension)[place] - zone)
        return error / zone if relative else error

    return sample


def _accuracy_falls() -> tuple[Claim, ...]:
    """The sentence at both edges, for the error itself and as a part of the slip zone."""
    made = []
    for side in ("left", "right"):
        for relative in (False, True):
            fails = side == "right" and relative
            measure = "relative to the slip zone" if relative else "relative to the half-width"
            made.append(
                Claim(
                    label=f"section 5.3/accuracy/{side}/{'relative' if relative else 'absolute'}",
                    place="section 5.3, end: the larger the slip zones, the less accurate",
                    says=f"the error at the {side} edge, {measure}, is larger at twice the "
                    "threshold than at 1.2 times it",
                    left=_small,
                    right=_large,
                    relation=Relation.BELOW,
                    samples={
                        _small: _error(side, "1.2", relative),
                        _large: _error(side, "2", relative),
                    },
                    against="both conditions of stick solved at 20 digits, untilted wedge, "
                    "Delta Q = 0.3 f P: one number",
                    cases=({},),
                    steps=(
                        "Both slip zones are larger at twice the threshold.",
                        "At the right edge the zone has just opened at 1.2 times the threshold; "
                        "the error grows more slowly than that zone does.",
                    ),
                    expected=Verdict.FAILS if fails else Verdict.NUMERICAL,
                    consequence=_next_to_the_threshold if fails else None,
                )
            )
    return tuple(made)


def _next_to_the_threshold() -> str:
    return (
        "a small slip zone is no sign of a small relative error: next to the threshold the "
        "zone at the edge that reverses is the worst known"
    )


def _end_of_exactness() -> Claim:
    """Slip at the right edge must have one sign throughout the half-cycle, from its start on."""
    width = 2 * r
    first = 8 * 2 * f * wedge("load", r, S.One) * (1 - _part) / (pi * width)
    bound = 4 * f * E_star * (wedge("tilt", r, S.One) - wedge("tilt", r, 1 / _part))
    return Claim(
        label="section 5.3/validity",
        place="section 5.3, above and below eq. (37)",
        says="the moderate solution is exact up to the threshold",
        left=Delta_sigma_th,
        right=Symbol("Delta_sigma_1"),
        meaning={Delta_sigma_th: bound, Symbol("Delta_sigma_1"): first},
        against="the tension at which K_T of the right edge changes sign, 8 dQ/(pi (a + c)): from "
        "there on slip reverses inside the half-cycle",
        ranges={_part: FRACTION},
        steps=(
            "Over a first part lambda of the half-cycle, dn/dlambda at 0 has the sign of -K_T.",
            "It must be negative for the stick zone to shrink; that ends before n reaches c.",
        ),
        expected=Verdict.FAILS,
        consequence=validity_of_the_bound,
    )


# ------------------------------------------------------------------ 5.4 and 5.5 tilt


def _text_on_tilt() -> tuple[Claim, ...]:
    shear = 2 * f * (wedge("load") - wedge("load", _CARRIED * r, t))
    made = []
    for side, size, half, word, relation in (
        ("left", r / t, a, "under", Relation.BELOW),
        ("right", r * t, a, "over", Relation.ABOVE),
    ):
        zone = d_LHS if side == "left" else d_RHS
        edge_terms = wedge(f"K_T_{side}").subs({dQ: shear, dsigma: 0})
        as_printed = stuck(half, 1).subs({Delta_sigma: 0})
        for name, coefficient, expected in (
            ("as printed", as_printed.subs({half: size, Delta_Q: shear}), Verdict.NUMERICAL),
            ("as corrected", edge_terms, Verdict.FAILS),
        ):
            made.append(
                Claim(
                    label=f"section 5.4/{word}estimated/{name}",
                    place=f"section 5.4, on figure 10 b), K_T {name}",
                    says=f"edge terms {word}estimate the slip zone at the {side} edge of a wedge "
                    "tilted to the left",
                    left=zone,
                    right=_exact[side],
                    relation=relation,
                    meaning={
                        zone: coefficient / (f * wedge(f"K_N_{side}")),
                        _exact[side]: (1 - _CARRIED) * size,
                    },
                    against="the stick zone is the wedge's contact at load P - Delta Q/(2 f)",
                    ranges={t: Range(0.42, 0.97)},
                    steps=(
                        "With K_T of the contact itself both ends are exact, whatever the tilt.",
                        "The printed K_T is sqrt((1 + c/a)/2) and sqrt((1 + a/c)/2) times that: "
                        "the under- and overestimate are of its making.",
                    ),
                    expected=expected,
                    consequence=None if name == "as printed" else slip_of_a_tilted_wedge,
                )
            )
    return (*made, _symmetry(), _no_exact_solution())


def _symmetry() -> Claim:
    upright = {alpha_0: S.Zero, Delta_sigma: S.Zero}
    load = wedge("load", r, S.One)
    return Claim(
        label="section 5.4/no tilt",
        place="section 5.4, on figure 10 b)",
        says="without mean tilt and tension the stick zone is symmetric",
        left=m,
        right=n,
        meaning={
            edge: edge_printed(edge)
            .subs(upright)
            .subs({P_0: load, Delta_Q: 2 * f * load * (1 - _part)})
            for edge in (m, n)
        },
        against="eqs. (28) and (29) at alpha_0 = 0, Delta sigma = 0",
        ranges={_part: FRACTION},
        steps=("Eq. (29) gives gamma_t = 1 there, and m/n = 1/gamma_t by eq. (28).",),
        expected=Verdict.HOLDS,
    )


def _no_exact_solution() -> Claim:
    return Claim(
        label="section 5.5/no exact solution",
        place="abstract, sections 1 and 5.5, conclusions",
        says="no exact solution exists for a varying moment under large tension",
        unchecked=(
            "that a solution does not exist is no equation; the two conditions of stick, with "
            "p_1 + p_2 for varying loads, are one where slip grows steadily over each half-cycle, "
            "a premise that this check does not prove"
        ),
        expected=Verdict.UNCHECKED,
        consequence=varying_moment,
    )
