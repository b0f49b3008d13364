"""The curve of a body that is integrated: g', g'' and g''' as code, close to a break and far."""

from collections.abc import Callable
from pathlib import Path
from runpy import run_path
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Max, Rational, cosh, log, pi, sqrt
from sympy import exp as sympy_exp

from derive import Geometry, parameter, x
from derive.codegen.integrated import curve_text
from derive.derivation import derive_sheet
from generated._profile import Curve, Piece, Profile
from generated._quadrature import state_of
from generated._state import State

b = parameter("b", "width", unit="m")
k = parameter("k", "exponent", unit="-")
L = parameter("L", "length", unit="m")
phi = parameter("phi", "slope", unit="rad")

OWN = {"b": 0.5, "L": 1.5, "phi": 0.125}
BOTH = {"b": 0.5, "phi": 0.125}
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


@pytest.mark.enough("beside a root")
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
                wanted[2] = [mpf(float(t)) * term for term in wanted[2]]  # t g'''
                totals = [(sum(each), sum(map(abs, each))) for each in wanted]
            pairs = [(left[n], right[n]) for n in (0, 1)] + [(left.change(), right.change())]
            for sides, (total, size) in zip(pairs, totals, strict=True):
                for value in sides:
                    assert abs(abs(mpf(float(value[i]))) - abs(total)) <= 1e-13 * size, t


@pytest.mark.enough("9/4", "7/3")
@pytest.mark.slow
@pytest.mark.parametrize(
    "exponent",
    [
        pi,
        *(
            pytest.param(q, marks=pytest.mark.slow)
            for q in (sqrt(2), Rational(7, 3), Rational(9, 4))
        ),
    ],
    ids=str,
)
def test_a_power_that_is_no_whole_or_half_one_is_written_as_it_is(
    exponent: Expr, tmp_path: Path
) -> None:
    """g = x**2/(2 L) + phi x + b u**q, u = |x|/b: g'' = 1/L + q (q - 1) u**(q - 2)/b, also where
    t**2 is zero in float64."""
    sheet = derive_sheet(
        Geometry("body", g=x**2 / (2 * L) + phi * x + b * (Abs(x) / b) ** exponent)
    )
    (tmp_path / "curve.py").write_text(curve_text(sheet))
    body = run_path(str(tmp_path / "curve.py"), NAMES)
    q = float(exponent)
    t = np.array([1e-200, 1e-100, 1e-3, 1.0])
    for side in (body["_piece_1_from_left"], body["_piece_0_from_right"]):
        with np.errstate(all="ignore"):  # as in a module: 1/t**(2 - pi) is 0 by 1/inf
            found = side(t, **OWN).curvature
            wanted = 1 / 1.5 + q * (q - 1) * (t / 0.5) ** (q - 2) / 0.5
        assert found == pytest.approx(wanted, rel=1e-12)


def test_a_corner_where_an_exponential_is_e_becomes_code(tmp_path: Path) -> None:
    """g = phi (b exp(x/b) + Max(0, x - b)): at x = b g' is phi e and phi (e + 1), g'' phi e/b."""
    sheet = derive_sheet(Geometry("body", g=b * phi * sympy_exp(x / b) + phi * Max(0, x - b)))
    (tmp_path / "curve.py").write_text(curve_text(sheet))
    body = run_path(str(tmp_path / "curve.py"), NAMES)["_BODY"]
    beside = [body.pieces[0].from_right(0.0, **BOTH), body.pieces[1].from_left(0.0, **BOTH)]
    for curve, slope in zip(beside, (np.e, np.e + 1), strict=True):
        assert abs(curve.slope) == pytest.approx(0.125 * slope, rel=1e-15)
        assert curve.curvature == pytest.approx(0.125 * np.e / 0.5, rel=1e-15)


@pytest.mark.slow
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


def state(g: Expr, tmp_path: Path) -> Callable[..., State]:
    """What a contact [-a, c] of a body carries, in the units of its parameters OWN."""
    sheet = derive_sheet(Geometry("body", g=g))
    (tmp_path / "curve.py").write_text(curve_text(sheet))
    body = run_path(str(tmp_path / "curve.py"), NAMES)["_BODY"]
    given = {p.name: OWN[p.name] for p in sheet.geometry.parameters}

    @np.errstate(all="ignore")
    def of(a: Any, c: Any) -> State:
        return state_of(body, np.float64(a), np.float64(c), **given)

    return of


def exactly(integrand: Callable[[mpf], mpf], a: float, c: float) -> mpf:
    """int f(s)/w ds over [-a, c] by s = (c - a)/2 + (h/2) sin u."""
    half, mid = (mpf(a) + mpf(c)) / 2, (mpf(c) - mpf(a)) / 2
    parts = mpmath.linspace(-mpmath.pi / 2, mpmath.pi / 2, 9)
    return mpmath.quad(lambda u: integrand(mid + half * mpmath.sin(u)), parts)


def load(curvature: Callable[[mpf], mpf], a: float, c: float) -> mpf:
    """P = (E*/2) int g'' w ds."""
    a, c = mpf(a), mpf(c)
    return exactly(lambda s: curvature(s) * (a + s) * (c - s), a, c) / 2


SMOOTH: dict[str, tuple[Expr, Callable[[mpf], mpf], list[tuple[float, float]]]] = {
    "flanks that turn straight, with a corner": (
        phi * b * log(cosh(x / b)) + phi * Abs(x - b / 4),
        lambda s: mpf(OWN["phi"]) / OWN["b"] / mpmath.cosh(s / OWN["b"]) ** 2,
        [(-3, 3.5), (-5, 5.5), (-10, 10.5), (-150, 151.0)],
    ),
    "a quartic apex under a root": (
        phi * b * sqrt(1 + (x / b) ** 4),
        lambda s: (
            mpf(OWN["phi"]) * 2 * s**2 * (3 + (s / OWN["b"]) ** 4)
            / OWN["b"] ** 3 / (1 + (s / OWN["b"]) ** 4) ** mpf(1.5)
        ),
        [(1, 1), (1e-3, -5e-4), (1e-6, 2e-6), (1e-10, 1e-10)],
    ),
    "a quartic apex as a difference": (
        phi * b * (cosh(x / b) - x**2 / (2 * b**2)),
        lambda s: mpf(OWN["phi"]) / OWN["b"] * 2 * mpmath.sinh(s / (2 * mpf(OWN["b"]))) ** 2,
        [(0.5, 0.5), (1e-2, 2e-2), (1e-5, -5e-6), (1e-9, 1e-9)],
    ),
}  # fmt: skip


@pytest.mark.enough("flanks*", "a quartic apex as*")
@pytest.mark.slow
@pytest.mark.parametrize("name", SMOOTH)
def test_loads_where_the_curvature_is_a_small_difference_keep_their_digits(
    name: str, tmp_path: Path
) -> None:
    """Far out on flanks, and close to a place without curvature; the corner lies beside."""
    g, curvature, contacts = SMOOTH[name]
    of = state(g, tmp_path)
    for a, c in contacts:
        with mpmath.workdps(40):
            wanted = load(curvature, a, c)
            assert abs(mpf(float(of(a, c).load)) / wanted - 1) < 1e-13


@pytest.mark.enough("1e-12")
@pytest.mark.slow
@pytest.mark.parametrize(
    "beyond", [pytest.param(1e-16, marks=pytest.mark.slow), 1e-12, 1e-9, 1e-7, 1e-4]
)
def test_a_tilt_whose_left_edge_lies_just_beyond_a_smooth_kink(
    beyond: float, tmp_path: Path
) -> None:
    """At -b g'' = 0 and g''' jumps; the quadrature is done when the tilt agrees, too.

    -pi alpha = int g'/w ds, with s = (c - a)/2 + (h/2) sin u; phi x adds -phi.
    """
    g = b * (Abs(x + b) / b) ** Rational(11, 4) + phi * x
    a, c = 0.5 + beyond, 0.25
    found = float(state(g, tmp_path)(a, c).tilt)
    with mpmath.workdps(40):
        rise = lambda s: mpf(11) / 4 * mpmath.sign(s + 0.5) * (2 * abs(s + 0.5)) ** mpf(1.75)  # noqa: E731
        half, mid = (mpf(a) + mpf(c)) / 2, (mpf(c) - mpf(a)) / 2
        kink = mpmath.asin((-mpf(0.5) - mid) / half)
        over = mpmath.quad(
            lambda u: rise(mid + half * mpmath.sin(u)),
            [-mpmath.pi / 2, kink, *mpmath.linspace(kink, mpmath.pi / 2, 9)[1:]],
        )
        wanted = -over / mpmath.pi - mpf(OWN["phi"])
    assert abs(mpf(found) / wanted - 1) < 1e-13


def test_exponentials_beyond_float64_have_a_slope_all_the_same(tmp_path: Path) -> None:
    """g = phi b log(1 + exp(x/b)): P = (E*/2) int g'' w ds -> (E* phi/2) sqrt(a c) far out, where
    g'' = (phi/b)/(4 cosh(x/2b)^2) is as narrow as a corner."""
    found = state(phi * b * log(1 + sympy_exp(x / b)), tmp_path)(1e6, 4e6)
    assert float(found.load) == pytest.approx(OWN["phi"] * 2e6 / 2, rel=1e-9)
