"""The curve of a body that is integrated: g', g'' and g''' as code, close to a break and far."""

from collections.abc import Callable
from pathlib import Path
from runpy import run_path
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Rational, cosh, log, sqrt
from sympy import exp as sympy_exp

from derive import Geometry, parameter, x
from derive.codegen.integrated import curve_text
from derive.derivation import derive_sheet
from generated._quadrature import Curve, Piece, Profile

b = parameter("b", "width", unit="m")
k = parameter("k", "exponent", unit="-")
L = parameter("L", "length", unit="m")
phi = parameter("phi", "slope", unit="rad")

OWN = {"b": 0.5, "L": 1.5, "phi": 0.125}
DISTANCES = np.concatenate([np.geomspace(1e-120, 1e-3, 25), np.linspace(0.01, 3, 10)])


def product(t: mpf, k: mpf) -> list[list[mpf]]:
    """Terms of g', g'' and g''' for g = b u**k cosh u, u = t/b, by the rule for products."""
    width = mpf(OWN["b"])
    u = t / width
    cosh_u, sinh_u = mpmath.cosh(u), mpmath.sinh(u)
    first = [k * u ** (k - 1) * cosh_u, u**k * sinh_u]
    second = [k * (k - 1) * u ** (k - 2) * cosh_u, 2 * k * u ** (k - 1) * sinh_u, u**k * cosh_u]
    third = [
        k * (k - 1) * (k - 2) * u ** (k - 3) * cosh_u,
        3 * k * (k - 1) * u ** (k - 2) * sinh_u,
        3 * k * u ** (k - 1) * cosh_u,
        u**k * sinh_u,
    ]
    return [first, [term / width for term in second], [term / width**2 for term in third]]


def summed(t: mpf, k: mpf) -> list[list[mpf]]:
    """The same for g = b u**k + t**(7/3)/L**(4/3) + phi sqrt(t**2 + b**2), term by term."""
    width, slope, third = mpf(OWN["b"]), mpf(OWN["phi"]), mpf(1) / 3
    scale = mpf(OWN["L"]) ** (-4 * third)
    u, root = t / width, mpmath.sqrt(t**2 + width**2)
    return [
        [k * u ** (k - 1), 7 * third * t ** (4 * third) * scale, slope * t / root],
        [
            k * (k - 1) * u ** (k - 2) / width,
            28 * third**2 * t**third * scale,
            slope * width**2 / root**3,
        ],
        [
            k * (k - 1) * (k - 2) * u ** (k - 3) / width**2,
            28 * third**3 * t ** (-2 * third) * scale,
            -3 * slope * width**2 * t / root**5,
        ],
    ]


NAMES = {"Array": Any, "np": np, "Curve": Curve, "Piece": Piece, "Profile": Profile}
"""What a module imports that holds a curve."""

power = b * (Abs(x) / b) ** k
BODIES: dict[str, tuple[Expr, Callable[[mpf, mpf], list[list[mpf]]]]] = {
    "times cosh": (power * cosh(x / b), product),
    "beside a root": (
        power + Abs(x) ** Rational(7, 3) / L ** Rational(4, 3) + phi * sqrt(x**2 + b**2),
        summed,
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", BODIES)
def test_a_power_with_an_open_exponent_beside_other_terms_keeps_its_digits(
    name: str, tmp_path: Path
) -> None:
    """No common denominator, and t**k/t**2 as one power: apart, both leave float64 at small t.

    Rounding of the exponent alone moves t**(k - 3) by log(1e120) units in the last place."""
    g, terms = BODIES[name]
    sheet = derive_sheet(Geometry("body", g=g))
    text = curve_text(sheet)
    (tmp_path / "curve.py").write_text(text)
    body = run_path(str(tmp_path / "curve.py"), NAMES)
    given = {p.name: OWN[p.name] for p in sheet.geometry.parameters if p.name != "k"}
    assert len(text) < 4000
    for exponent in (1.75, 3.25):
        right = body["_piece_1_from_left"](DISTANCES, k=exponent, **given)
        left = body["_piece_0_from_right"](DISTANCES, k=exponent, **given)
        for i, t in enumerate(DISTANCES):
            with mpmath.workdps(40):
                wanted = terms(mpf(float(t)), mpf(exponent))
                totals = [(sum(each), sum(map(abs, each))) for each in wanted]
            pairs = [(left[n], right[n]) for n in (0, 1)] + [(left.change(), right.change())]
            for sides, (total, size) in zip(pairs, totals, strict=True):
                for value in sides:
                    assert abs(abs(mpf(float(value[i]))) - abs(total)) <= 1e-13 * size, t


@pytest.mark.parametrize(
    ("g", "rate"),
    [
        (phi * L * (sympy_exp(x / L) - x / L), 1.0),
        (phi * L * (1 + x / L) ** Rational(3, 2) - Rational(3, 2) * phi * x, 0.75),
        (phi * (L + x) * log(1 + x / L) - phi * x, 1.0),
        (phi * L / (1 + x / L) ** 2 + 2 * phi * x, 6.0),
    ],
    ids=["exponential", "half power", "logarithm", "reciprocal"],
)
def test_a_slope_whose_terms_cancel_at_the_apex_keeps_its_digits(
    g: Expr, rate: float, tmp_path: Path
) -> None:
    """g' = rate phi t/L up to (t/L)**2: exp(u) - 1, (3/2)(sqrt(1 + u) - 1), log(1 + u), ..."""
    sheet = derive_sheet(Geometry("body", g=g))
    (tmp_path / "curve.py").write_text(curve_text(sheet))
    body = run_path(str(tmp_path / "curve.py"), NAMES)
    pieces = body["_BODY"].pieces
    apex = body["_breaks"](L=1.5, phi=0.125).index(0)
    for t in (1e-200, 1e-30, 1e-16):
        wanted = rate * 0.125 * t / 1.5
        right = pieces[apex + 1].from_left(t, L=1.5, phi=0.125).slope
        left = pieces[apex].from_right(t, L=1.5, phi=0.125).slope
        assert right == pytest.approx(wanted, rel=1e-14)
        assert left == pytest.approx(-wanted, rel=1e-14)
