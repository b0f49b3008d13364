"""Sums over straight lines and parabolas, support/_parabolas.py: identities, and other routes."""

import importlib
from inspect import signature
from itertools import chain, product
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mpf
from numpy.testing import assert_allclose, assert_array_equal
from sympy import Expr, Rational, cos, integrate, sin, symbols, tan

from generated import _quadrature, flat_rounded
from generated._parabolas import _BOW, _EXCESS, AFAR, Parabolas, _polynomial
from generated._profile import Curve, Profile
from tests.codegen.kinked import contacts, profile

e, T, t = symbols("e T t", positive=True)
D = e - sin(e) * cos(e)
tangents = tan((T - e) / 2) * tan((T + e) / 2)
over_the_part = (t, (T - e) / 2, (T + e) / 2)
"""The angles of a part by the sum T and the difference e of those of its ends."""


def vanishes(difference: Expr) -> bool:
    """Whether a form of sines is zero at four points, to 40 digits: it has no others to hide in."""
    points = [(30, 90), (110, 170), (1, 2), (150, 160), (5, 250)]
    return all(
        abs(difference.subs({e: Rational(x, 100), T: Rational(y, 100)}).evalf(50)) < mpf(10) ** -40
        for x, y in points
    )


FORMS: dict[str, tuple[Expr, Expr]] = {
    "w ds, over h^2/4": (
        8 * (sin(t) * cos(t)) ** 2,
        D + 2 * sin(e) * cos(e) * sin(T) ** 2,
    ),
    "w ds/A, over h": (
        2 * cos(t) ** 2,
        D + 2 * sin(e) * cos((T - e) / 2) * cos((T + e) / 2),
    ),
    "w ds/B, over h": (
        2 * sin(t) ** 2,
        D + 2 * sin(e) * sin((T - e) / 2) * sin((T + e) / 2),
    ),
    "w (A - B) ds, over h^3": (
        2 * (sin(t) * cos(t)) ** 2 * (sin(t) ** 2 - cos(t) ** 2),
        -sin(e) * cos(T) / 6 * (sin(T - e) ** 2 + sin(T - e) * sin(T + e) + sin(T + e) ** 2),
    ),
    "(s - the part's middle) ds/w, over h": (
        2 * (sin(t) ** 2 - (sin((T - e) / 2) ** 2 + sin((T + e) / 2) ** 2) / 2),
        -cos(T) * (sin(e) ** 3 - cos(e) * D),
    ),
    "(sin(t)**2 + 2 tan(t)**2) dt": (
        sin(t) ** 2 + 2 * tan(t) ** 2,
        2 * tan(e) * tan((T - e) / 2) * tan((T + e) / 2)
        + 2 * sin(e) ** 2 * tan(e)
        - 3 * D / 2
        + sin(e) * sin((T - e) / 2) * sin((T + e) / 2),
    ),
    "(3 sin(t)**2 + 12 tan(t)**2 + 8 tan(t)**4) dt, less 3 times that": (
        6 * tan(t) ** 2 + 8 * tan(t) ** 4,
        6 * tan(e) * tangents
        + 8 * tan(e) * tangents**2
        + Rational(8, 3) * (tan(e) * (1 + tangents)) ** 3
        - 2 * (tan(e) * sin(e) ** 2 - D),
    ),
}
"""Integrals over a part, s being told by its angle t, and what is added up in their place."""


@pytest.mark.parametrize("name", FORMS)
def test_the_sums_are_the_integrals(name: str) -> None:
    integrand, form = FORMS[name]
    assert vanishes(integrate(integrand.expand(), over_the_part) - form)


def test_both_polynomials_are_exact_to_rounding() -> None:
    """Their last coefficients are no series', but Chebyshev's."""

    def bow(z: mpf) -> mpf:
        angle = mpmath.sqrt(z)
        return (angle - mpmath.sin(angle) * mpmath.cos(angle)) / angle**3

    def excess(z: mpf) -> mpf:
        y = mpmath.sqrt(z)
        return (mpmath.atanh(y) - y) / y**3

    half = mpmath.tanh(mpmath.atanh(mpmath.sqrt(mpf(4) / 7)) / 2)
    for coefficients, function, end in (
        (_BOW, bow, (mpmath.pi / 2) ** 2),
        (_EXCESS, excess, half**2),
    ):
        with mpmath.workdps(50):
            for z in mpmath.linspace(end / 10**6, end, 301):
                exact = mpmath.polyval([mpf(v) for v in chain.from_iterable(coefficients)], z)
                assert abs(exact / function(z) - 1) < mpf(2) ** -53
            places = np.linspace(0, float(end), 301)[1:]
            wanted = [float(function(mpf(z))) for z in places]
        found = _polynomial(coefficients, places)
        assert_allclose(found, wanted, rtol=2.0**-51)
        assert_array_equal([_polynomial(coefficients, float(z)) for z in places], found)


# ------------------------------------------------------------------ against quadrature

quiet = np.errstate(all="ignore")
"""As generated functions call what they need."""

KINKS = (-0.75, 0.25, 1.125)
BENDS = (None, 1.5, 0.25, 2.0)
JUMP = 0.125
"""A straight flank, a corner at 0.25, and three radii; g' is zero at 0.25 - 0.125/1.5, say."""

ROOT = 0.25 - JUMP / 1.5


def slope_at(number: int, s: Any) -> Any:
    """g' of each piece, by hand."""
    after = 1.5 * (0.25 - ROOT) + JUMP
    return [
        1.5 * (KINKS[0] - ROOT) + 0 * s,
        1.5 * (s - ROOT),
        after + 0.25 * (s - 0.25),
        after + 0.25 * (1.125 - 0.25) + 2.0 * (s - 1.125),
    ][number]


BODY = Parabolas(
    kinks=KINKS,
    spans=(1.0, 0.875),
    corners={1: JUMP},
    bends=BENDS,
    slopes=(
        (0, slope_at(0, 0.0)),
        (ROOT, 0),
        (0.25, slope_at(2, 0.25)),
        (1.125, slope_at(3, 1.125)),
    ),
).in_numbers()


def integrated() -> Profile:
    """The same body for quadrature of g'', which knows nothing of parabolas."""

    def curve(number: int, s: Any) -> Curve:
        return Curve(slope_at(number, s), (BENDS[number] or 0.0) + 0 * s, lambda: 0 * s)

    straight = [number for number, bend in enumerate(BENDS) if bend is None]
    return profile(KINKS, (0.0, JUMP, 0.0), curve, straight)


def test_load_moment_tilt_and_K_N_against_quadrature() -> None:
    a, c = contacts(KINKS, 5)
    found, wanted = BODY.state(a, c), quiet(_quadrature.state_of)(integrated(), a, c)
    assert np.count_nonzero(np.isfinite(found.load)) > 290
    assert_array_equal(np.isnan(found.load), np.isnan(wanted.load))
    far = np.maximum(np.abs(a), np.abs(c))
    sizes = wanted.load, far * wanted.load, 3 + 0 * a, wanted.left, wanted.right
    for field, size in zip(found._fields, sizes, strict=True):
        off = np.abs(getattr(found, field) - getattr(wanted, field))
        assert np.all((off <= 2e-13 * size)[np.isfinite(wanted.load)]), field


def test_each_result_alone_is_the_same() -> None:
    a, c = contacts(KINKS, 5)
    state = BODY.state(a, c)
    there = np.isfinite(state.load)
    assert_array_equal(BODY.load(a, c)[there], state.load[there])
    assert_array_equal(BODY.moment(a, c), state.moment)
    assert_array_equal(BODY.tilt(a, c), state.tilt)
    assert_array_equal(BODY.edges(a, c), (state.left, state.right))


def test_L_N_against_quadrature() -> None:
    a, c = contacts(KINKS, 5)
    found, wanted = BODY.second(a, c), quiet(_quadrature.second_of)(integrated(), a, c)
    K = BODY.edges(a, c)
    for one, other, its in zip(found, wanted, K, strict=True):
        carried = (its > 0) & np.isfinite(other)
        size = np.maximum(np.abs(other), its / (a + c))[carried]
        assert np.count_nonzero(carried) > 300
        assert np.max(np.abs(one - other)[carried] / size) < 1e-12


def test_the_pressure_against_quadrature_wherever_x_lies() -> None:
    """Inside parts, beside them, and many times their length away."""
    a, c = contacts(KINKS, 5)
    rng = np.random.default_rng(6)
    inside = rng.uniform(-a, c)
    beside = rng.choice(KINKS, a.size) + rng.choice([-1, 1], a.size) * 10 ** rng.uniform(-12, -1)
    for x in (inside, np.clip(beside, -a, c), -a + (a + c) * 1e-9, np.append(KINKS, -a[3:])):
        found, wanted = (
            BODY.pressure(x, a, c),
            quiet(_quadrature.pressure_at)(integrated(), x, a, c),
        )
        corner = x == KINKS[1]
        assert np.all((found == wanted)[corner & (x > -a) & (x < c)])
        loaded = (wanted > 0) & np.isfinite(wanted)
        assert_allclose(found[loaded], wanted[loaded], rtol=3e-13)
        assert np.all(found[wanted == 0] == 0)


def test_bodies_of_numbers_are_looked_up() -> None:
    one = flat_rounded._body(R=np.float64(1.5), b=np.float64(0.75))
    assert one.plain and one is flat_rounded._body(R=np.float64(1.5), b=np.float64(0.75))
    several = flat_rounded._body(R=np.array([1.5, 2.0]), b=np.float64(0.75))
    assert not several.plain and several.bends[0].tolist() == [1 / 1.5, 0.5]


def test_numbers_give_the_bits_of_arrays() -> None:
    a, c = contacts(KINKS, 5, 60)
    x = np.linspace(-0.9, 1.5, a.size)
    for method, at in (
        *((name, (a, c)) for name in ("load", "moment", "tilt", "edges", "second")),
        ("pressure", (x, a, c)),
    ):
        function = getattr(BODY, method)
        alone = [function(*numbers) for numbers in zip(*at, strict=True)]
        there = a + c > 0
        assert_array_equal(np.transpose(alone)[..., there], np.array(function(*at))[..., there])


def test_the_pressure_of_arrays_however_they_lie_in_memory() -> None:
    """Elements that see a part from afar are put back where they belong."""
    flat = Parabolas((-1.0, 1.0), (2.0,), {}, (1.0, None, 1.0), ((-1.0, 0), None, (1.0, 0)))
    flat = flat.in_numbers()
    x, a = np.linspace(-0.9, 1.1, 12).reshape(3, 4), np.linspace(1.01, 1.4, 4)
    wanted = [[flat.pressure(p, q, np.float64(1.05)) for p, q in zip(r, a, strict=True)] for r in x]
    for places in (x, np.asfortranarray(x), x.T.copy().T, x[::-1][::-1]):
        assert_array_equal(flat.pressure(places, a, np.float64(1.05)), wanted)
    turned = flat.pressure(np.asfortranarray(x).T, a[:, None], np.float64(1.05))
    assert_array_equal(turned.T, wanted)


def test_a_short_part_is_as_long_as_its_parameter_says() -> None:
    """g'' = 1 from b to b + l, both rounded: l is not their difference, and P = l w/2 beside it."""
    b, short = np.float64(1.1), np.float64(1e-9)
    body = Parabolas((b, b + short), (short,), {}, (None, 1.0, None), (None, (b, 0), (0, short)))
    a, c, body = np.float64(0.5), np.float64(2.9), body.in_numbers()
    wanted = short / 2 * np.sqrt((a + b) * (c - b))
    assert_allclose(body.load(a, c), wanted, rtol=2e-9)  # w changes by 1e-9 of it over the part
    assert_allclose(body.load(np.array([a]), c), wanted, rtol=2e-9)
    assert abs((b + short) - b - short) > 1e-8 * short


def test_no_number_is_no_error() -> None:
    """A place that is no number, and a contact too narrow for float64, as numbers and as arrays."""
    arc = Parabolas((0.0,), (), {}, (1.0, 2.0), ((0, 0), (0, 0))).in_numbers()
    nan, low, high = (np.float64(v) for v in (np.nan, -1.0, 2.0))
    assert np.isnan(arc.pressure(nan, low, high))
    assert np.isnan(arc.pressure(np.array([nan]), low, high)).all()
    for tiny in (1e-250, 1e-300):
        arc.second(np.float64(tiny), np.float64(tiny))


PARABOLIC = {
    "flat_rounded": {"R": 1.5, "b": 0.75},
    "flat_sloped": {"phi": 0.125, "b": 0.75},
    "rounded_wedge": {"phi": 0.125, "b": 0.75},
    "two_radii": {"R_1": 1.5, "R_2": 0.5},
    "wedge_parabola": {"phi": 0.125, "R": 1.5},
}


@pytest.mark.parametrize("name", PARABOLIC)
def test_every_argument_of_a_generated_function_may_be_an_array(name: str) -> None:
    """Any of them, with numbers beside it: the bits of one number after the other."""
    module = importlib.import_module(f"generated.{name}")
    values = {"x": 0.25, "a": 1.0, "c": 2.0, "E_star": 3.0, **PARABOLIC[name]}
    for function in ("tilt", "load", "moment", "pressure", "K_N", "L_N"):
        call = getattr(module, function)
        given = {k: v for k, v in values.items() if k in signature(call).parameters}
        for some in product((False, True), repeat=len(given)):
            arrays = {k: np.array([v, 1.25 * v]) for k, v in given.items()}
            chosen = dict(zip(given, some, strict=True))
            found = call(**{k: arrays[k] if chosen[k] else v for k, v in given.items()})
            for i in (0, 1):
                one = call(**{k: float(arrays[k][i]) if chosen[k] else v for k, v in given.items()})
                assert_array_equal(np.array(found)[..., i] if any(some) else np.array(found), one)


# ------------------------------------------------------------------ properties

places = st.floats(-2, 2)


@given(place=places, a=places, width=st.floats(1e-6, 4))
def test_a_kink_that_is_none_changes_nothing(place: float, a: float, width: float) -> None:
    """A parabola cut at any place is the same parabola: parts add up."""
    whole = Parabolas((0.0,), (), {}, (2.0, 0.5), ((0, 0), (0, 0))).in_numbers()
    low, high = sorted((0.0, place))
    middle = 0.5 if place > 0 else 2.0
    cut = Parabolas((low, high), (high - low,), {}, (2.0, middle, 0.5), ((0, 0),) * 3)
    a, c = np.float64(a), np.float64(width - a)
    one, other = whole.state(a, c), cut.in_numbers().state(a, c)
    far = max(abs(a), abs(c))
    for field, size in zip(one._fields, (one.load, far * one.load, 4 * far, *one[3:]), strict=True):
        assert abs(getattr(one, field) - getattr(other, field)) <= 4e-15 * size, field


@given(a=st.floats(0.1, 3), c=st.floats(0.1, 3), x=st.floats(-3, 3))
def test_mirrored_bodies_carry_mirrored_pressures(a: float, c: float, x: float) -> None:
    mirrored = Parabolas(
        tuple(-kink for kink in reversed(KINKS)),
        (0.875, 1.0),
        {1: JUMP},
        tuple(reversed(BENDS)),
        tuple((-place, -slope) for place, slope in reversed(BODY.slopes)),  # type: ignore[misc]
    ).in_numbers()
    a, c, x = map(np.float64, (a, c, x))
    one, other = quiet(BODY.pressure)(x, a, c), quiet(mirrored.pressure)(-x, c, a)
    assert_allclose(one, other, rtol=1e-13, atol=1e-300)  # at the corner, too, where both are inf
    assert_allclose(BODY.second(a, c), mirrored.second(c, a)[::-1], rtol=1e-12)
    assert_allclose(BODY.tilt(a, c), -mirrored.tilt(c, a), atol=1e-14)


@given(start=st.floats(0.001, 0.999), share=st.floats(1e-12, 1), length=st.floats(1e-12, 1))
def test_from_afar_the_argument_of_artanh_is_small(
    start: float, share: float, length: float
) -> None:
    """y = w(x) tan(e)/(d + w tan e) of a part in [0, 1] from `start`, x in front of it: below
    sqrt(4/7), as the polynomial needs it, wherever x lies more than 3/4 of its length away."""
    distance = start * share
    length = min(length * distance / AFAR, 1 - start)
    x, end = start - distance, start + length
    root = mpmath.sqrt
    sine = length / (root(end * (1 - start)) + root(start * max(1 - end, 0)))
    tangent = sine / root(1 - sine**2)
    near = root(start * (1 - start))
    y = root(x * (1 - x)) * tangent / (distance + near * tangent)
    assert y <= root(mpf(4) / 7) + 1e-9
