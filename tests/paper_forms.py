"""The paper's printed formulas, in its own form, for comparisons of speed and accuracy.

Andresen, Fleury, Moore & Hills 2020: eqs. (pressure_distribution_wedge), (gamma), (alpha), (ca),
(normal_equilrbium_wedge), (K_N) of section 4 and the appendix on the Hertz contact.  Where the
paper prints the symmetric Hertz contact alone, its middle is shifted.  The signs are ours.
"""

from collections.abc import Mapping

from sympy import Abs, Expr, asin, log, pi, sin, sqrt, symbols

x, a, c, P, M, alpha, E_star, phi, R = symbols("x a c P M alpha E_star phi R")

_half, _mid = (a + c) / 2, (c - a) / 2
_gamma = c / a


def _wedge_gamma(tilt: Expr) -> Expr:
    lean = sin(pi * tilt / (2 * phi))
    return (1 - lean) / (1 + lean)


def _wedge_edges(gamma: Expr) -> dict[str, Expr]:
    return {"a": P / (E_star * phi) * sqrt(1 / gamma), "c": P / (E_star * phi) * sqrt(gamma)}


def _wedge_pressure() -> Expr:
    first, second = sqrt(_gamma), sqrt((_gamma * a - x) / (x + a))
    return E_star * phi / pi * log(Abs((first + second) / (first - second)))


_TILT = 2 * phi / pi * asin(2 * E_star * phi * M / sqrt(4 * (E_star * phi * M) ** 2 + P**4))
_LEFT = 2 * E_star * phi / pi * sqrt(_gamma / (a * (1 + _gamma)))
_HERTZ = sqrt(4 * P * R / (pi * E_star))

FORMS: Mapping[str, Mapping[str, Mapping[str, Expr]]] = {
    "wedge": {
        "contact": _wedge_edges(_wedge_gamma(_TILT)) | {"alpha": _TILT},
        "contact_at_tilt": _wedge_edges(_wedge_gamma(alpha)),
        "load": {"": E_star * phi * sqrt(_gamma * a**2)},
        "moment": {"": E_star * phi / 4 * sqrt(_gamma) * (1 - _gamma) * a**2},
        "pressure": {"": _wedge_pressure()},
        "K_N": {"left": _LEFT, "right": _LEFT / _gamma},
    },
    "hertz": {
        "contact": {"a": _HERTZ + M / P, "c": _HERTZ - M / P, "alpha": M / (P * R)},
        "contact_at_tilt": {"a": _HERTZ + R * alpha, "c": _HERTZ - R * alpha},
        "load": {"": _half**2 * pi * E_star / (4 * R)},
        "pressure": {"": E_star / (2 * R) * sqrt(_half**2 - (x - _mid) ** 2)},
        "K_N": dict.fromkeys(("left", "right"), E_star / (2 * R) * sqrt(2 * _half)),
    },
}
"""body -> function -> field -> expression; "" where the function returns one array."""
