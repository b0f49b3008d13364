"""The outline of the theory page: its equations hold for a tilted cylinder.

The functions and symbols in them are taken from the cylinder's formula sheet, and the change in the
shear traction from the generated module.
"""

from collections.abc import Callable
from typing import Any

import pytest
from sympy import Expr, Float, Symbol, diff
from sympy.core.function import AppliedUndef

from derive import symbols as ours
from derive.reading.improper import proper
from derive.theory.moments import full_moment, slope_moment
from generated import hertz
from tests.derive.bodies import of_library
from tests.test_site import module

pytestmark = pytest.mark.slow

OUTLINE = module("outline")
SHEET = of_library("hertz")
g, ALPHA, LOAD = SHEET.geometry.g, SHEET.flat("tilt"), SHEET.flat("load")

BODY = {"E_star": 1.2, "R": 2.0}
CONTACT = {"a": 1.5, "c": 1.0}
CHANGES = {"dQ": 0.1, "dsigma": 0.05}
NUMBERS = BODY | CONTACT | CHANGES | {"f": 0.5, "kappa": 1}
"""Moderate tension: the stick zone is [-1.37, 0.954]."""

PLACES = {"slip": 0.97, "difference": 0.4}
"""Points in a slip zone and in the stick zone; for the other equations, x is 0.3."""


def at(formula: str) -> Callable[[Any], Expr]:
    """A formula of the sheet as a function of x."""
    return lambda place: SHEET.flat(formula).subs(ours.x, place)


def patch(expr: Expr) -> Expr:
    """A formula for the contact patch [-m, n]."""
    return expr.subs({ours.a: ours.m, ours.c: ours.n}, simultaneous=True)


def earlier(expr: Expr, c: Expr) -> Expr:
    """A formula for the earlier contact whose right edge is at c.

    At a fixed tilt of a cylinder the midpoint stays.
    """
    return expr.subs({ours.a: c + ours.a - ours.c, ours.c: c}, simultaneous=True)


def changed(place: float) -> Expr:
    """The change in the shear traction, by the generated module."""
    load = hertz.load(**CONTACT, **BODY)
    state = hertz.contact_at_tilt(load, (CONTACT["a"] - CONTACT["c"]) / (2 * BODY["R"]), **BODY)
    return Float(hertz.shear_change(place, state, state, **CHANGES, f=NUMBERS["f"], **BODY))


FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    **dict.fromkeys(("p", "p_1", "p_2"), at("pressure")),
    "p_s": lambda place: patch(at("pressure")(place)),
    "w": lambda place: ours.w.subs(ours.x, place),
    "g'": lambda place: diff(g, ours.x).subs(ours.x, place),
    "g''": lambda place: diff(g, ours.x, 2).subs(ours.x, place),
    "a": lambda c: earlier(ours.a, c),
    "F": lambda c: earlier(SHEET.flat("punch"), c),
}

SHEAR = {
    **dict.fromkeys(("stick", "full_stick"), at("full_stick_change")),
    "stick_zone": lambda place: 2 * ours.f * at("pressure")(place),  # the normal loads are constant
}
"""The change in the shear traction in some equations; in the others, it is that of `changed`."""

SYMBOLS: dict[str, Any] = {
    **{f"I_{k}": slope_moment(k, SHEET.frame) + ALPHA * full_moment(k) for k in (0, 1, 2)},
    **{"I_k": slope_moment(2, SHEET.frame) + ALPHA * full_moment(2), "k": 2},
    **{"P": LOAD, "M": SHEET.flat("moment"), "alpha": ALPHA, "h": ours.h, "mid": ours.mid},
    **{"P_prime": SHEET.flat("load_rate"), "a_prime": SHEET.flat("edge_ratio")},
    **{key: SHEET.flat(key) for key in ("K_N_left", "K_N_right")},
    **{"K_N": SHEET.flat("K_N_left"), "K_T": SHEET.flat("K_T_left"), "d": SHEET.flat("slip_left")},
    **{"P_s": patch(LOAD), "alpha_s": patch(ALPHA), "c_x": ours.x},
    **{"m": SHEET.flat("stick_m"), "n": SHEET.flat("stick_n")},
}


def value(expr: Expr, name: str) -> float:
    """The value of one side of an equation for the cylinder."""
    place = PLACES.get(name, 0.3)
    functions = FUNCTIONS | {r"\Delta q": SHEAR.get(name, lambda _: changed(place))}
    while calls := expr.atoms(AppliedUndef):
        call = min(calls, key=lambda each: (len(str(each)), str(each)))
        expr = expr.xreplace({call: functions[str(call.func)](*call.args)})
    expr = proper(expr)
    for table in (SYMBOLS, SYMBOLS, SYMBOLS, {"x": place}, NUMBERS):  # P_s: m: P: a
        free = (symbol for symbol in expr.free_symbols if isinstance(symbol, Symbol))
        expr = expr.subs({symbol: table.get(symbol.name, symbol) for symbol in free})
    result = complex(expr.evalf())
    assert abs(result.imag) < 1e-12
    return result.real


SLOW = ("bounded", "tilt", "stick", "stick_zone", "punches")
"""Equations with integrals that take many seconds."""

EACH = [
    pytest.param(name, marks=[pytest.mark.thorough] * (name in SLOW)) for name in OUTLINE.EQUATIONS
]


@pytest.mark.parametrize("name", EACH)
def test_an_equation_of_the_outline_holds_for_a_cylinder(name: str) -> None:
    for left, right in OUTLINE.EQUATIONS[name]:
        assert value(left, name) == pytest.approx(value(right, name), rel=1e-9, abs=1e-9)
