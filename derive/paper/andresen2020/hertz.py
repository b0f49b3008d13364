"""The appendix: two cylinders."""

from typing import Any

from sympy import (
    Expr,
    Integral,
    Rational,
    S,
    Symbol,
    elliptic_e,
    elliptic_k,
    elliptic_pi,
    pi,
    sqrt,
    symbols,
)

from derive.paper.andresen2020.consequences import modulus_read_as_parameter, shift_of_stick_zone
from derive.paper.andresen2020.large import conditions, opposite_tension
from derive.paper.andresen2020.symbols import (
    K_N,
    P_0,
    Delta_Q,
    Delta_sigma,
    P,
    R,
    a,
    d,
    e,
    m,
    n,
    p,
    p_0,
    s,
)
from derive.paper.bodies import hertz
from derive.paper.claim import FRACTION, Bound, Claim, Convention, Meaning, Range, Relation, Verdict
from derive.symbols import E_star, f, x

_size = Symbol("l", positive=True)
_first, _second, _stick = (Symbol(k, positive=True) for k in ("l_1", "l_2", "l_s"))
_part, _place = Symbol("rho", positive=True), Symbol("mu", real=True)
_share = Symbol("share", positive=True)
"""The part of the contact's right half that the stick zone reaches over."""
_mu, _nu = Symbol("mu_m", positive=True), Symbol("mu_n", positive=True)

chi, char_phi, char_omega = symbols("chi phi_c omega_c")
"""Modulus and characteristics of the elliptic integrals; phi_c is the paper's phi of eq. (46)."""
alpha_1, beta_1, gamma_1, delta_1 = symbols("alpha_1 beta_1 gamma_1 delta_1")
alpha_2, beta_2, gamma_2, delta_2 = symbols("alpha_2 beta_2 gamma_2 delta_2")

_root = sqrt((a + m) * (a + n))
_common = n**2 - 2 * m * n / 3 + m**2 - 4 * a**2 / 3
DEFINITIONS: dict[Symbol, Expr] = {
    char_phi: (m - a) / (m + a),
    char_omega: (a - n) / (a + m),
    alpha_1: -2 * _root,
    alpha_2: 3 * (m - n) / 2 * _root,
    beta_1: (n - m + 4 * a) * sqrt((a + m) / (a + n)),
    beta_2: Rational(-3, 2)
    * sqrt((a + m) / (a + n))
    * ((n / 3 + 2 * a) * m - (m**2 + n**2) / 2 - 2 * a / 3 * (a + n)),
    gamma_1: 2 * a * (n - m) / _root,
    gamma_2: 3 * a / (2 * _root) * _common,
    delta_1: (m**2 - n**2) / _root,
    delta_2: -3 * (m + n) / (4 * _root) * _common,
    chi: sqrt((a**2 - m**2) * (a**2 - n**2)) / ((a + m) * (a + n)),
}
_STRAIN, _FORCE = Delta_sigma * pi / 8, Delta_Q / 2 + (n - m) * Delta_sigma * pi / 16
"""Left-hand sides of eqs. (46) and (47)."""
_ZONE: Meaning = {a: _size, m: _size * _mu, n: _size * _nu}
_ELLIPTIC: dict[str, Any] = {
    "ranges": {_mu: FRACTION, _nu: FRACTION},
    "family": "large tension, cylinder",
}
"""What the claims on the large tension have in common: the stick zone's ends, parts of a."""


def bracket(order: int, parameter: Expr) -> Expr:
    """Right-hand side of eq. (46) or (47), by the parameter that SymPy and SciPy take."""
    first, second, third, fourth = (
        (alpha_1, beta_1, gamma_1, delta_1) if order == 1 else (alpha_2, beta_2, gamma_2, delta_2)
    )
    return (
        E_star
        * f
        / (2 * R)
        * (
            first * elliptic_e(parameter)
            + second * elliptic_k(parameter)
            + third * elliptic_pi(char_phi, parameter)
            + fourth * elliptic_pi(char_omega, parameter)
        )
    )


def claims() -> tuple[Claim, ...]:
    """Eqs. (40) to (48), and what the text says beside them."""
    return (*_normal(), *_moderate(), *_large(), *_definitions(), _coefficient())


def _normal() -> tuple[Claim, ...]:
    at_place = {x: _size * _place}
    body = {a: _size, P: hertz("load", _size, _size), p_0: E_star / (2 * R)}
    sheet = "the cylinder's sheet, whose formulas are derived from g(x) and proven"
    return (
        Claim(
            label="pressure_distribution_Hertz",
            equation="(40)",
            place="eq. (40), appendix, with p_0 = E*/(2 R)",
            says="the pressure under a cylinder",
            left=p,
            right=p_0 * sqrt(a**2 - x**2),
            meaning=body | at_place | {p: hertz("pressure", _size, _size).subs(at_place)},
            against=sheet,
            ranges={_place: Range(-0.95, 0.95)},
            expected=Verdict.HOLDS,
        ),
        Claim(
            label="Hertz_contactlaw/integral",
            equation="(41)",
            place="eq. (41), appendix, first part",
            says="the load is the integral of the pressure",
            left=P,
            right=Integral(p, (s, -a, a)),
            meaning=body | {p: hertz("pressure", _size, _size).subs(x, s)},
            against=sheet,
            expected=Verdict.NUMERICAL,
        ),
        Claim(
            label="Hertz_contactlaw/value",
            equation="(41)",
            place="eq. (41), appendix, second part",
            says="the load in closed form",
            left=P,
            right=a**2 * pi * E_star / (4 * R),
            meaning=body,
            against=sheet,
            expected=Verdict.HOLDS,
        ),
        Claim(
            label="appendix/a",
            equation="(42)",
            place="eq. (42), appendix",
            says="the half-width from the load",
            left=a**2,
            right=4 * P * R / (pi * E_star),
            meaning=body,
            against=sheet,
            expected=Verdict.HOLDS,
        ),
    )


def _moderate() -> tuple[Claim, ...]:
    mean = (hertz("load", _first, _first) + hertz("load", _second, _second)) / 2
    ours = -4 * f * E_star * hertz("tilt", _mu, _nu)
    shift = (_nu - _mu) / 2
    opposite = Convention(
        "the tension with the opposite sign",
        {Delta_sigma: -ours},
        "eq. (1), section 1, eq. (29), section 4.1, and eq. (32), section 4.2, where a positive "
        "tension loads the left edge more, so that the stick zone moves to the right",
    )
    return (
        Claim(
            label="Hertz_permanent_stick_zone",
            equation="(43)",
            place="eq. (43), appendix",
            says="the half-width of the permanent stick zone",
            left=d**2,
            right=4 * R / (pi * E_star) * (P_0 - Delta_Q / (2 * f)),
            meaning={
                d: _stick,
                P_0: mean,
                Delta_Q: 2 * f * (mean - hertz("load", _stick, _stick)),
            },
            against="the contact of the same body at load P_0 - Delta Q/(2 f)",
            expected=Verdict.HOLDS,
        ),
        Claim(
            label="Hertz_shift_stick_zone",
            equation="(44)",
            place="eq. (44), appendix",
            says="the middle of the permanent stick zone",
            left=e,
            right=-R * Delta_sigma / (4 * f * E_star),
            meaning={e: shift, Delta_sigma: ours},
            against="the contact of the same body at tilt -Delta sigma/(4 f E*)",
            conventions=(opposite,),
            steps=(
                "An untilted cylinder's stick zone [-m, n] is its contact at tilt "
                "-Delta sigma/(4 f E*) = (m - n)/(2 R), as for eq. (28).",
            ),
            expected=Verdict.CONVENTION,
            consequence=shift_of_stick_zone,
        ),
        *(
            Claim(
                label=f"appendix/{name}",
                place="appendix, below eq. (44)",
                says=f"the {side} end of the permanent stick zone",
                left=left,
                right=right,
                meaning={m: _mu, n: _nu, d: (_mu + _nu) / 2, e: shift},
                against="the middle and the half-width of [-m, n]",
                swaps=(d, e),
                expected=Verdict.HOLDS,
            )
            for name, side, left, right in (("m", "left", -m, -d + e), ("n", "right", n, d + e))
        ),
        Claim(
            label="inequality",
            equation="(45)",
            place="eq. (45), appendix",
            says="the tension at which the slip zone of the right edge closes",
            left=Delta_sigma,
            relation=Relation.AT_MOST,
            reached=Bound(
                {Delta_sigma: _tension_at(_share)}, {Delta_sigma: _tension_at(1 / _share)}
            ),
            right=4 * E_star * f / R * (a - sqrt(a**2 - 2 * R * Delta_Q / (pi * E_star * f))),
            meaning={
                a: _size,
                Delta_Q: 2
                * f
                * (hertz("load", _size, _size) - hertz("load", _part * _size, _part * _size)),
                Delta_sigma: _tension_at(S.One),
            },
            against="eqs. (43) and (44), as corrected, at n = a, where the bound is reached, and "
            "with n inside and outside the contact",
            ranges={_part: FRACTION, _share: FRACTION},
            expected=Verdict.HOLDS,
        ),
    )


def _tension_at(share: Expr) -> Expr:
    """The tension that leaves a stick zone of half-width rho l with its right end at share l."""
    right = share * _size
    return -4 * f * E_star * hertz("tilt", 2 * _part * _size - right, right)


def _large() -> tuple[Claim, ...]:
    pressure = hertz("pressure", _size, _size)
    printed = {symbol: value.subs(_ZONE) for symbol, value in DEFINITIONS.items()}
    shared: dict[str, Any] = {
        "meaning": {**_ZONE, **printed, **conditions(pressure, _size, _ZONE[m], _ZONE[n])},
        "against": "the two conditions of stick with the cylinder's pressure, by quadrature",
        **_ELLIPTIC,
    }
    of_strain = {"says": "the condition of strain in elliptic integrals", "left": _STRAIN}
    return (
        Claim(
            label="eq25",
            equation="(46)",
            place="eq. (46), appendix, chi read as the modulus k",
            right=bracket(1, chi**2),
            swaps=(alpha_1, beta_1, gamma_1, delta_1),
            expected=Verdict.NUMERICAL,
            **of_strain,
            **shared,
        ),
        Claim(
            label="eq25/parameter",
            place="eq. (46), appendix, chi read as the parameter m = k^2, as SciPy and SymPy take",
            right=bracket(1, chi),
            expected=Verdict.FAILS,
            consequence=modulus_read_as_parameter,
            **of_strain,
            **shared,
        ),
        Claim(
            label="eq26",
            equation="(47)",
            place="eq. (47), appendix, chi read as the modulus k",
            says="the condition of force in elliptic integrals",
            left=_FORCE,
            right=bracket(2, chi**2),
            conventions=(opposite_tension(pressure, _size, _ZONE[m], _ZONE[n]),),
            swaps=(m, n),
            expected=Verdict.CONVENTION,
            consequence=shift_of_stick_zone,
            **shared,
        ),
    )


_WORDS = {
    char_phi: "the first characteristic",
    char_omega: "the second characteristic",
    chi: "the modulus",
}


def _definitions() -> tuple[Claim, ...]:
    """Each of the eleven definitions in its own condition, the others as printed."""
    pressure = hertz("pressure", _size, _size)
    changes = opposite_tension(pressure, _size, _ZONE[m], _ZONE[n]).meaning
    made = []
    for symbol, value in DEFINITIONS.items():
        order = 2 if symbol in (alpha_2, beta_2, gamma_2, delta_2) else 1
        others = {k: v.subs(_ZONE) for k, v in DEFINITIONS.items() if k != symbol}
        made.append(
            Claim(
                label=f"appendix/definitions/{symbol}",
                equation="(47a)",
                place="definitions below eq. (47), appendix",
                says=f"{_WORDS.get(symbol, 'a coefficient')} of eq. ({45 + order})",
                left=symbol,
                right=value,
                through=(_STRAIN if order == 1 else _FORCE, bracket(order, chi**2)),
                meaning={**_ZONE, **others, **changes},
                against=f"eq. ({45 + order}) in the paper's sign of tension, the other definitions "
                "as printed",
                swaps=(m, n),
                expected=Verdict.NUMERICAL,
                **_ELLIPTIC,
            )
        )
    return tuple(made)


def _coefficient() -> Claim:
    return Claim(
        label="appendix/K_N",
        equation="(48)",
        place="eq. (48), appendix",
        says="the coefficient of the pressure at either edge of a cylinder",
        left=K_N,
        right=E_star / (2 * R) * sqrt(2 * a),
        source="K_N = E_star/(2*R)*sqrt(2*a)",
        meaning={a: _size, K_N: hertz("K_N_left", _size, _size)},
        against="the cylinder's sheet, by the expansion of p(x)",
        expected=Verdict.HOLDS,
    )
