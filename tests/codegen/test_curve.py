"""The curve of a body that is integrated: g', g'' and t g''' as code, close to a break and far."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from inspect import signature
from types import ModuleType

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Rational, cosh, log, sqrt
from sympy import exp as sympy_exp

from derive import Geometry, x
from derive.proof.points import numeric
from derive.proof.quadrature import value_by_quadrature
from derive.symbols import E_star, a, c
from tests.codegen.made import module_of, text_of_body
from tests.derive.bodies import L, b, k, phi

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("short_docstrings")]

OWN = {"b": 0.5, "L": 1.5, "phi": 0.125}
DISTANCES = np.concatenate([np.geomspace(1e-75, 1e-3, 6), np.linspace(0.01, 3, 3)])


def summed(t: mpf, k: mpf) -> list[list[mpf]]:
    """Terms of g', g'' and g''' for g = b u**k + t**(7/3)/L**(4/3) + phi sqrt(t**2 + b**2)."""
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


def own_names(module: ModuleType) -> list[str]:
    """The parameters of a body in their order."""
    return [name for name in signature(module.tilt).parameters if name not in ("a", "c")]


@contextmanager
def body_of(g: Expr, **more: float) -> Iterator[tuple[ModuleType, np.ndarray, Callable]]:
    """The module of g(x), its own parameters in their order, and the curve beside x = 0."""
    with module_of(text_of_body(g)) as module:
        own = np.array([(OWN | more)[name] for name in own_names(module)])
        apex = [*module._cuts(own), 0].index(0)
        yield module, own, lambda side, t: module._curve(apex + (side > 0), side, t, own)


def test_a_power_with_an_open_exponent_beside_other_terms_keeps_its_digits() -> None:
    """No common denominator, and t**k/t**2 as one power: apart, both leave float64 at small t."""
    third = Abs(x) ** Rational(7, 3) / L ** Rational(4, 3)
    with body_of(b * (Abs(x) / b) ** k + third + phi * sqrt(x**2 + b**2), k=1.75) as (
        module,
        own,
        curve,
    ):
        for exponent in (1.75, 3.25):
            own[own_names(module).index("k")] = exponent
            for t in map(float, DISTANCES):
                with mpmath.workdps(40):
                    wanted = summed(mpf(t), mpf(exponent))
                    wanted[2] = [mpf(t) * term for term in wanted[2]]  # t g'''
                    totals = [(sum(each), sum(map(abs, each))) for each in wanted]
                for side in (1, -1):
                    for value, (total, size) in zip(curve(side, t), totals, strict=True):
                        assert abs(abs(mpf(value)) - abs(total)) <= 1e-13 * size, t


def test_a_slope_whose_terms_cancel_at_the_apex_is_right_to_a_rounding_of_them() -> None:
    """g' = phi (exp(u) - 1), u = t/L, which is phi t/L up to (t/L)**2."""
    with body_of(phi * L * (sympy_exp(x / L) - x / L)) as (_, _, curve):
        for t in (1e-75, 1e-30, 1e-16):
            wanted = 0.125 * t / 1.5
            found = [curve(side, t)[0] for side in (1, -1)]
            assert found == pytest.approx([wanted, -wanted], rel=1e-14, abs=1e-16)


# ------------------------------------------------------------------ what is integrated over it


def exactly(integrand: Callable[[mpf], mpf], a: float, c: float) -> mpf:
    """int f(s)/w ds over [-a, c] by s = (c - a)/2 + (h/2) sin u."""
    half, mid = (mpf(a) + mpf(c)) / 2, (mpf(c) - mpf(a)) / 2
    parts = mpmath.linspace(-mpmath.pi / 2, mpmath.pi / 2, 9)
    return mpmath.quad(lambda u: integrand(mid + half * mpmath.sin(u)), parts)


def named(module: ModuleType) -> dict[str, float]:
    return {name: OWN[name] for name in own_names(module)}


def test_loads_where_the_curvature_is_a_small_difference_keep_their_digits() -> None:
    """Far out on flanks that turn straight; the corner lies beside.

    P = (E*/2) int g'' w ds."""
    g = phi * b * log(cosh(x / b)) + phi * Abs(x - b / 4)
    with body_of(g) as (module, _, _):
        for a, c in ((-3, 3.5), (-150, 151.0)):

            def curvature(s: mpf, a: float = a, c: float = c) -> mpf:
                bent = mpf(OWN["phi"]) / OWN["b"] / mpmath.cosh(s / OWN["b"]) ** 2
                return bent * (a + s) * (c - s)

            with mpmath.workdps(40):
                wanted = exactly(curvature, a, c) / 2
                found = module.load(a, c, E_star=1.0, **named(module))
                assert abs(mpf(float(found)) / wanted - 1) < 1e-12, (a, c)


def test_exponentials_beyond_float64_have_a_slope_all_the_same() -> None:
    """g = phi b log(1 + exp(x/b)): P = (E*/2) int g'' w ds -> (E* phi/2) sqrt(a c) far out, where
    g'' = (phi/b)/(4 cosh(x/2b)^2) is as narrow as a corner."""
    with body_of(phi * b * log(1 + sympy_exp(x / b))) as (module, _, _):
        found = module.load(1e6, 4e6, E_star=1.0, **named(module))
    assert float(found) == pytest.approx(OWN["phi"] * 2e6 / 2, rel=1e-9)


def test_the_second_term_beside_a_corner_where_the_curvature_goes_on() -> None:
    """L_N of a contact whose right edge is just beyond the corner, by its defining integral."""
    g = phi * b * log(cosh(x / b)) + phi * Abs(x - b / 4)
    body = Geometry("cornered", g)  # whose g has plain symbols
    left, right = 1.0, OWN["b"] / 4 + 1e-4
    point = {q.symbol: mpf(OWN[q.name]) for q in body.parameters}
    point |= {a: mpf(left), c: mpf(right), E_star: mpf(1)}
    with body_of(g) as (module, _, _), mpmath.workdps(40):
        found = module.L_N(left, right, E_star=1.0, **named(module))
        for side in ("left", "right"):
            wanted = numeric(value_by_quadrature(body.g, f"L_N_{side}"))(point)
            assert float(getattr(found, side)) == pytest.approx(float(wanted), rel=1e-10)
