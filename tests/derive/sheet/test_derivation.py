"""Whole sheets: known bodies by hand, and what holds for every body whatever its profile."""

from importlib import import_module

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mpf
from sympy import Expr, Piecewise, Symbol, atan, log, pi, simplify, sqrt, sympify

from derive import Geometry, parameter, x
from derive.sheet.derivation import derive_sheet, slip_series
from derive.symbols import E_star, a, c
from tests.commands import done
from tests.derive.bodies import BODIES, VALUES, close, sheet, value

pytestmark = pytest.mark.slow

EDGES = ("K_N_left", "K_N_right", "L_N_left", "L_N_right")

R, C, phi, psi, b = (Symbol(name, positive=True) for name in ("R", "C", "phi", "psi", "b"))
A, B = Symbol("A", positive=True), Symbol("B", positive=True)  # a > 0 and c > 0


def at_positive_edges(name: str, formula: str) -> Expr:
    return sheet(name).flat(formula).subs({a: A, c: B})


# The classics, each worked out on paper.
#
# hertz: g' = x/R.  int s/w = pi mid, int s^2/w = pi (mid^2 + h^2/8), int s^3/w = pi (mid^3 +
#   3 mid h^2/8), so alpha = -mid/R;  P = (E*/2R)(I_2 - mid I_1) = pi E* h^2/(16 R);
#   M = -(E*/2R) [pi mid h^2/4 - mid pi h^2/8] = -P mid;  p = E* w/(2 R).
# wedge: with s = mid + (h/2) cos t the apex lies at cos t0 = -mid/(h/2), the right part is t < t0.
#   int g'/w = phi (t0 - (pi - t0)), so alpha = phi (1 - 2 t0/pi), tan(t0/2) = sqrt(c/a);
#   int s g'/w = mid phi (2 t0 - pi) + 2 phi (h/2) sin t0, (h/2) sin t0 = sqrt(ac), P = E* phi
#   sqrt(ac).  Its load acts half-way from the apex to mid: M = -P mid/2.
# quartic: g' = 4 x^3/C, alpha = -(4/C)(mid^3 + 3 mid h^2/8);  at a = c:
#   P = (E*/2)(4/C)(3 pi/8) a^4.
_KNOWN = {
    ("hertz", "tilt"): (A - B) / (2 * R),
    ("hertz", "load"): pi * E_star * (A + B) ** 2 / (16 * R),
    ("hertz", "moment"): pi * E_star * (A + B) ** 2 * (A - B) / (32 * R),
    ("hertz", "pressure"): E_star * sqrt((A + x) * (B - x)) / (2 * R),
    ("hertz", "edge_ratio"): 1,
    ("hertz", "load_rate"): pi * E_star * (A + B) / (4 * R),  # dP/dc + dP/da at a' = 1
    ("hertz", "punch"): E_star * (A + B) / (4 * R),
    ("hertz", "K_N_left"): E_star * sqrt(A + B) / (2 * R),
    ("hertz", "K_N_right"): E_star * sqrt(A + B) / (2 * R),
    ("hertz", "L_N_left"): -E_star / (4 * R * sqrt(A + B)),  # sqrt(h - s) = sqrt(h)(1 - s/2h)
    ("hertz", "L_N_right"): -E_star / (4 * R * sqrt(A + B)),
    ("wedge", "tilt"): phi * (1 - 4 * atan(sqrt(B / A)) / pi),
    ("wedge", "load"): E_star * phi * sqrt(A * B),
    ("wedge", "moment"): E_star * phi * sqrt(A * B) * (A - B) / 4,
    ("wedge", "edge_ratio"): A / B,  # alpha is a function of c/a
    ("wedge", "load_rate"): E_star * phi * sqrt(A / B),  # P = E* phi c sqrt(a/c), a/c fixed
    ("wedge", "punch"): E_star * phi * sqrt(A / B) / pi,
    ("wedge", "K_N_right"): 2 * E_star * phi / pi * sqrt(A / (B * (A + B))),
    ("wedge", "K_N_left"): 2 * E_star * phi / pi * sqrt(B / (A * (A + B))),
    ("unequal_wedge", "load"): E_star * (phi + psi) / 2 * sqrt(A * B),  # the tilt adds no load
    ("unequal_wedge", "moment"): E_star * (phi + psi) / 8 * sqrt(A * B) * (A - B),
    ("quartic", "tilt"): (A - B) * (5 * A**2 + 2 * A * B + 5 * B**2) / (4 * C),
}


@pytest.mark.parametrize(("name", "formula"), _KNOWN, ids="-".join)
def test_the_classics(name: str, formula: str) -> None:
    assert simplify(at_positive_edges(name, formula) - _KNOWN[name, formula]) == 0


def test_the_pressure_of_the_wedge() -> None:
    """(2 E* phi/pi) (1/2) log((sqrt u + sqrt v)/(sqrt u - sqrt v)), u = c (a + x), v = a (c - x).

    On the right of the apex; half the log is artanh sqrt(v/u).
    """
    u, v = B * (A + x), A * (B - x)
    expected = E_star * phi / pi * log((sqrt(u) + sqrt(v)) / (sqrt(u) - sqrt(v)))
    found = at_positive_edges("wedge", "pressure")
    for place in (mpf("0.125"), mpf("0.625"), mpf("0.99")):
        point = {A: 2, B: 1, x: place, E_star: 1, phi: 1}
        assert close(mpf(found.subs(point).evalf(30)), mpf(expected.subs(point).evalf(30)))


# What holds for every body.

FEW = settings(max_examples=10)
"""Contacts a body: an identity of analytic functions that fails, fails at nearly every one."""

number = st.floats(0.125, 8, allow_nan=False, width=32)
_at = st.floats(0.03125, 0.96875, width=32)


def contact(name: str, left: float, right: float) -> dict[str, mpf]:
    """A contact of the body: left of its leftmost kink, right of its rightmost."""
    kinks = BODIES[name].kinks or (0.0,)
    return {"a": left - mpf(min(kinks)), "c": right + mpf(max(kinks))}


def inside(edges: dict[str, mpf], share: float) -> mpf:
    """An x at a share of the width, never a kink of BODIES."""
    place = -edges["a"] + mpf(share) * (edges["a"] + edges["c"])
    return place + mpf("1e-7") if any(place == k for k in (0, 0.5, -0.5)) else place


_POWERS = {  # of length, with E* kept
    **{"tilt": 0, "load": 1, "moment": 2, "pressure": 0, "edge_ratio": 0, "load_rate": 0},
    **{"punch": 0, "K_N_left": -0.5, "K_N_right": -0.5, "L_N_left": -1.5, "L_N_right": -1.5},
}
_LENGTHS = {"R": 1, "R1": 1, "b": 1, "C": 3, "phi": 0, "psi": 0}


@pytest.mark.parametrize("name", ["wedge", "flat_rounded", "quartic", "two_radii", "spline"])
@FEW
@given(number, number, _at, st.floats(0.01, 100), st.floats(0.01, 100))
def test_lengths_and_the_modulus_scale_every_formula_by_its_power(
    name: str, left: float, right: float, share: float, factor: float, stiffer: float
) -> None:
    k, here = mpf(factor), contact(name, left, right)
    there = {key: k * edge for key, edge in here.items()}
    there |= {key: k**power * VALUES[key] for key, power in _LENGTHS.items()}
    there["E_star"] = mpf(stiffer) * VALUES["E_star"]
    place = inside(here, share)
    for formula, power in _POWERS.items():
        by = k**power * (1 if formula in ("tilt", "edge_ratio") else mpf(stiffer))
        first = value(name, formula, x=place, **here) * by
        second = value(name, formula, x=k * place, **there)
        assert close(first, second, digits=18, scale=1e-6 * by), formula


@pytest.mark.enough("rounded_wedge*")
@pytest.mark.parametrize(
    ("name", "own", "dsigma", "senses"),
    [
        ("wedge", {"phi": 0.05}, 0.0, (1, 1)),
        ("rounded_wedge", {"b": 4e-4, "phi": 0.05}, 2e6, (1, -1)),
    ],
)
def test_the_printed_series_are_the_slip_zones(
    name: str, own: dict[str, float], dsigma: float, senses: tuple[int, int]
) -> None:
    """What `derive show --slip` prints, by its own definitions, against the module, which solves
    the conditions to the second order as they stand: of zones of 1e-4 of the width the second term
    is 1e-4, and the third, by which both differ, 1e-8."""
    a_, c_, dQ, friction = 1.1e-3, 0.9e-3, 5e2, 0.5
    numbers = {"a": a_, "c": c_, "dQ": dQ, "dsigma": dsigma, "f": friction, "E_star": 60e9, **own}
    numbers |= {"kappa_left": senses[0], "kappa_right": senses[1]}
    printed = done("show", name, "--slip", "2")
    assert max(map(len, printed.splitlines())) <= 96
    shown = printed.replace("\n    ", " ").splitlines()
    for line in reversed([line for line in shown if " = " in line]):
        symbol, _, text = line.partition(" = ")
        numbers[symbol] = float(sympify(text, numbers))
    module = import_module(f"generated.{name}")
    zones = module.slip_zones(a_, c_, dQ, dsigma, f=friction, E_star=60e9, **own, order=2)
    for side in ("left", "right"):
        terms = [line.partition(": ")[2] for line in shown if line.startswith(f"d_{side}, order")]
        total = sum(float(sympify(term, numbers)) for term in terms)
        assert len(terms) == 2 and total == pytest.approx(float(getattr(zones, side)), rel=1e-6)


def test_ratios_of_the_series_have_other_names_than_the_body_s_parameters() -> None:
    rho, D_left = parameter("rho", "radius", unit="m"), parameter("D_left", "radius", unit="m")
    body = Geometry("own", g=Piecewise((x**2 / (2 * D_left), x < 0), (x**2 / (2 * rho), True)))
    terms, known = slip_series(derive_sheet(body), 2)
    assert {"rho_ratio", "D_left_ratio"} <= {s.name for s in known}
    assert not {s.name for s in known} & {"rho", "D_left"}
    assert not {s.name for found in terms.values() for t in found for s in t.free_symbols} & {
        "rho",
        "D_left",
    }
