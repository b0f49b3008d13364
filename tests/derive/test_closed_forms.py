"""Closed forms of bodies that are integrated: by hand, at limits, made up, in time."""

from dataclasses import replace
from functools import cache
from typing import Any

import mpmath
import pytest
from mpmath import mpf
from sympy import Abs, Max, Piecewise, Rational, atan, cosh, exp, log, sinh, sqrt

import derive.command.limit
import derive.proof.prove
import derive.sheet.derivation
from derive import Geometry, load_geometry, parameter
from derive.proof.numerical import numeric_proof
from derive.proof.points import contacts, numeric
from derive.proof.prove import prove_sheet
from derive.proof.verdict import DIGITS, POINTS, Proof, Verdict
from derive.sheet.derivation import derive_sheet, with_closed_forms
from derive.sheet.formulas import FormulaSheet
from derive.symbols import a, c, x

pytestmark = pytest.mark.slow

R = parameter("R", "radius")
L = parameter("L", "length")
b = parameter("b", "length")
A = parameter("A", "amplitude")
phi = parameter("phi", "slope", unit="rad")
k = parameter("k", "exponent", unit="-")

MADE_UP = {
    "power_of_three_halves": Abs(x) ** Rational(3, 2) / sqrt(L),
    "shifted_power_on_a_wedge": Abs(x - b) ** k / (k * L ** (k - 1)) + phi * Abs(x),
    "power_from_a_kink_on": Max(0, x - b) ** Rational(7, 3) / L ** Rational(4, 3) + phi * Abs(x),
    "exponential": A * exp(x / b) + x**2 / (2 * R),
    "x_sinh_on_a_wedge": A * x * sinh(x / b) / b + phi * Abs(x),
    "skew_hyperbola_on_a_wedge": phi * sqrt(x**2 + b * x + b**2) + phi * Abs(x - b),
    "root_of_a_line": L + x / 2 - L * sqrt(1 + x / L),
    "simple_pole": -L * log(1 - x / L),
    "double_pole": L**2 / (L - x),
    "powers_beyond_a_flat": L * (Max(0, Abs(x) - b) / L) ** k,
    "four_kinds": x**2 / (2 * R)
    + A * cosh(x / b)
    + Abs(x) ** Rational(7, 3) / L ** Rational(4, 3)
    + phi * Abs(x),
}
CLOSED = tuple(f"{name}_closed" for name in ("tilt", "load", "moment")) + tuple(
    f"{name}_{side}_closed" for name in ("K_N", "L_N") for side in ("left", "right")
)


@cache
def sheet(name: str) -> FormulaSheet:
    body = Geometry(name, g=MADE_UP[name]) if name in MADE_UP else load_geometry(name)
    return with_closed_forms(derive_sheet(body))


def value(of: FormulaSheet, name: str, **given: Any) -> mpf:
    """A closed form in numbers, at the working precision."""
    expr = of.flat(f"{name}_closed")
    point = {s: mpf(given[s.name]) for s in expr.free_symbols}
    return numeric(expr)(point)


# ------------------------------------------------------------------ by hand


@pytest.mark.parametrize("exponent", ["1.1", "1.5", "7.5"])
def test_a_power_law_under_a_centred_load(exponent: str) -> None:
    """P = (E*/2) 2 int_0^a (k-1) s^(k-2)/L^(k-1) sqrt(a^2 - s^2) ds, and s = a sqrt(u) makes it
    a beta function: int_0^a s^(k-2) sqrt(a^2 - s^2) ds = (a^k/2) B((k-1)/2, 3/2)."""
    with mpmath.workdps(40):
        k, L, a, E = mpf(exponent), mpf("1.25"), mpf("0.75"), mpf(2)
        wanted = E * (k - 1) / L ** (k - 1) * a**k / 2 * mpmath.beta((k - 1) / 2, mpf(3) / 2)
        found = value(sheet("power"), "load", a=a, c=a, k=k, L=L, E_star=E)
        assert abs(found / wanted - 1) < mpf(10) ** -35


@pytest.mark.parametrize("ratio", ["1e-6", "0.05"])
def test_a_small_arc_by_its_series(ratio: str) -> None:
    """g = x^2/(2R) + x^4/(8R^3) + x^6/(16R^5) + 5 x^8/(128R^7), and int s^(2j) sqrt(a^2 - s^2) ds
    over the contact is pi a^2/2, pi a^4/8, pi a^6/16, 5 pi a^8/128.  With e = a/R,

        g'' = (1/R) (1 + 3/2 (s/R)^2 + 15/8 (s/R)^4 + 35/16 (s/R)^6),
        P = pi E* a^2/(4R) (1 + 3/8 e^2 + 15/64 e^4 + 175/1024 e^6 + ...),

    Hertz and what the arc adds.  Its terms fall by less than e^2: the rest is below e^8/6.
    """
    with mpmath.workdps(80):
        e = mpf(ratio)
        hertz = mpmath.pi * e**2 / 4
        found = value(sheet("circular_arc"), "load", a=e, c=e, R=1, E_star=1) / hertz
        rest = found - (1 + 3 * e**2 / 8 + 15 * e**4 / 64 + 175 * e**6 / 1024)
        assert 0 < rest < e**8 / 6


# ------------------------------------------------------------------ limits


@pytest.mark.parametrize(
    ("body", "own"),
    [
        ("catenary", {"R": 1, "b": mpf(10) ** 20}),
        ("hyperbola", {"phi": mpf(10) ** 20, "b": mpf(10) ** 20}),
        ("power", {"k": 2, "L": 1}),
    ],
)
def test_at_its_limit_a_body_is_a_cylinder_of_radius_one(body: str, own: dict[str, Any]) -> None:
    """alpha = -mid, P = pi E* h^2/16, M = -mid P, K_N = E* sqrt(h)/2, L_N = -E*/(4 sqrt(h))."""
    with mpmath.workdps(200):
        for left, right in ((mpf("0.75"), mpf("0.5")), (mpf("-0.25"), mpf("1.5"))):
            h, mid = left + right, (right - left) / 2
            load = mpmath.pi * h**2 / 16
            wanted = {"tilt": -mid, "load": load, "moment": -mid * load}
            wanted |= {f"K_N_{side}": mpmath.sqrt(h) / 2 for side in ("left", "right")}
            wanted |= {f"L_N_{side}": -1 / (4 * mpmath.sqrt(h)) for side in ("left", "right")}
            for name, right_value in wanted.items():
                found = value(sheet(body), name, a=left, c=right, E_star=1, **own)
                assert abs(found - right_value) < mpf(10) ** -30, name


# ------------------------------------------------------------------ against the defining integrals


@pytest.mark.enough("power_of_three_halves", "exponential", "skew_hyperbola*", "simple_pole")
@pytest.mark.parametrize("name", MADE_UP)
def test_every_form_is_proven(name: str) -> None:
    """It is there, and no other."""
    of = sheet(name)
    assert [key for key in of if of[key].closes] == sorted(CLOSED, key=[*of].index)
    assert {point[a] < point[c] for point in contacts(of)} == {True, False}
    for closed in CLOSED:
        proof = numeric_proof(of, closed)
        assert proof is not None and proof.digits >= DIGITS
        assert (proof.verdict, proof.points) == (Verdict.NUMERICAL, POINTS), f"{closed}: {proof}"


def test_what_is_not_proven_is_not_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """One form refuted, one without a value somewhere; the integrals stand as they were."""
    good = Proof(Verdict.NUMERICAL, "a test's", POINTS, DIGITS)

    def proof(_: FormulaSheet, name: str) -> Proof:
        if name == "load_closed":
            return replace(good, verdict=Verdict.REFUTED)
        if name == "tilt_closed":
            raise ZeroDivisionError
        return good

    monkeypatch.setattr(derive.proof.prove, "numeric_proof", proof)
    proven = prove_sheet(sheet("catenary")).demand_proven()
    assert {*sheet("catenary")} - {*proven} == {"load_closed", "tilt_closed"}
    assert "left out: tilt_closed, load_closed" in proven.remark


# ------------------------------------------------------------------ none


NO_RULE = {
    "arctangent": (x**2 / (2 * R) + phi * x * atan(x / b), "phi*atan(x/b)"),
    "cosh on one side alone": (
        Piecewise((x**2 / (2 * R), x < 0), (b**2 / R * (cosh(x / b) - 1), True)),
        "sinh(x/b), which changes at a kink",
    ),
    "two kinds in one term": (A * Abs(x / b) ** Rational(5, 2) * cosh(x / b), "sinh(x/b)"),
    "logarithm of cosh": (b * phi * log(cosh(x / b)), "sinh(x/b)/cosh(x/b)"),
    "root that ends at a kink": (
        Piecewise((phi * Abs(x), x < 0), (phi * sqrt(x**2 + b**2) - phi * b, True)),
        "which changes at a kink",
    ),
}


@pytest.mark.enough("arctangent", "cosh*", "logarithm*")
@pytest.mark.parametrize("name", NO_RULE)
def test_a_term_without_a_rule_leaves_the_integrals(name: str) -> None:
    profile, told = NO_RULE[name]
    given = derive_sheet(Geometry("body", g=profile))
    found = with_closed_forms(given)
    assert {*found} == {*given}
    assert "no rule for " in found.remark and told in found.remark
