"""The stick zone: both conditions in 25 digits, other solutions, regimes and their borders."""

import importlib
import math
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mpmath import mpf
from numpy.testing import assert_allclose, assert_array_equal

from generated import hertz, unequal_wedge, wedge
from generated.runtime.types import Contact, Regime, StickZone
from tests.measure.accuracy.partial_slip import between, digits_of
from tests.measure.accuracy.reference import Problem

pytestmark = pytest.mark.slow

E_STAR, F = 1.25, 0.5
OWN: dict[str, dict[str, float]] = {
    "hertz": {"R": 1.5},
    "wedge": {"phi": 0.25},
    "unequal_wedge": {"phi_1": 0.25, "phi_2": 0.375},
    "flat_rounded": {"R": 1.5, "b": 0.5},
    "two_radii": {"R_1": 0.75, "R_2": 1.5},
    "wedge_parabola": {"phi": 0.25, "R": 1.5},
    "rounded_wedge": {"phi": 0.25, "b": 0.5},
    "quartic": {"L": 1.25},
}
FIRST, SECOND = (1.5, 1.25), (1.5625, 1.28125)
"""Contacts (a, c) at both ends of a cycle."""


def module(name: str) -> ModuleType:
    return importlib.import_module(f"generated.{name}")


def law(name: str) -> dict[str, float]:
    return {"E_star": E_STAR, **OWN[name]}


def loads(name: str, *edges: tuple[float, float]) -> Any:
    """P at the contacts (a, c)."""
    return [module(name).load(a, c, **law(name)) for a, c in edges]


def known(
    name: str, edges: list[tuple[float, float]], shear: float, tension: float
) -> dict[str, float]:
    """A cycle as tests/measure/accuracy takes it."""
    first, second = (dict(zip(("a", "c"), each, strict=True)) for each in edges)
    there = {f"{key}_2": value for key, value in second.items()}
    return {**law(name), **first, **there, "f": F, "dQ": shear, "dsigma": tension}


STILL, VARY = [(1.5, 1.25)] * 2, [FIRST, SECOND]


@pytest.mark.enough("wedge-edges1*", "*edges8-*", "*edges11-*")
@pytest.mark.parametrize(
    ("name", "edges", "part", "tension"),
    [
        ("hertz", STILL, 0.25, 1.5),
        ("wedge", VARY, 0.25, 2.5),
        ("hertz", VARY, 0.25, -2.5),
        ("wedge", [(2.0, 0.75)] * 2, 0.25, -3.0),
        ("unequal_wedge", [(1.0, 1.5)] * 2, 0.25, 2.0),
        ("quartic", VARY, 0.25, 2.0),
        ("wedge_parabola", [(1.0, 1.25)] * 2, 0.25, 2.0),
        ("flat_rounded", [(0.505, 0.5075)] * 2, 0.25, 2.0),
        ("rounded_wedge", [(0.50001, 1.25)] * 2, 0.25, -1.75),
        # one end within a hundredth of the width of the apex: once called MIXED
        ("wedge", [(2.615, 0.34)] * 2, 0.6584, -1.257),
        ("wedge", [(0.0772, 0.278)] * 2, 0.673, 1.8335),
        ("wedge", [(6.22, 2.51)] * 2, 0.74, -1.775),
    ],
)
def test_a_zone_of_large_tension_meets_both_conditions(
    name: str, edges: list[tuple[float, float]], part: float, tension: float
) -> None:
    """`part` of 2 f P; `tension` in parts of 8 dQ/(pi h), the threshold of constant loads."""
    shear = part * F * sum(loads(name, *edges))
    dsigma = tension * 8 * shear / (np.pi * sum(edges[0]))
    ends = (Contact(*each, 0.0) for each in edges)
    zone = module(name).stick_zone(*ends, shear, dsigma, f=F, **law(name))
    assert zone.regime == Regime.LARGE
    assert (min(zone.m, zone.n) < 0.01 * sum(edges[0])) == (part > 0.5)
    problem = Problem(between(name), digits=digits_of(name))
    exact = problem.answer(zone[:2], known(name, edges, shear, dsigma)).numbers
    assert_allclose(zone[:2], np.array(exact, float), rtol=1e-11 if part > 0.5 else 1e-12)


# ---------------------------------------------------------------------- regimes


def steady(body: ModuleType, a: Any, c: Any, shear: Any, tension: Any, **own: float) -> StickZone:
    here = Contact(a, c, 0.0)
    return body.stick_zone(here, here, shear, tension, f=F, E_star=E_STAR, **own)  # type: ignore[no-any-return]


def elliptic(a: mpf, c: mpf, m: mpf, n: mpf) -> tuple[mpf, mpf]:
    """Integrals of sqrt((a + x)(c - x)) r and sqrt((a + x)(c - x))/r, r = sqrt((x + m)/(x - n)).

    Both extend from n to c.  With u = c - x they are sums of U_k = int u**k/sqrt(Q) du, where
    Q = u (u1 - u)(u2 - u)(u3 - u), u1 = c - n, u2 = c + m and u3 = c + a.  The substitution
    tau = (x - n)/u gives

        U_k = u1**k/sqrt(u2 u3) int (1 + tau)**-k dtau/sqrt(tau (tau + alpha)(tau + beta))

    with alpha = (a + n)/u3 and beta = (m + n)/u2.  For k = 0 and 1 these are Carlson's R_F and
    R_J.  For k = 2 the derivative of sqrt(tau (tau + alpha)/(tau + beta))/(1 + tau) reduces the
    integral to these and R_D; for k = 3 the derivative of sqrt(Q) reduces it to the other U_k.
    If u1 is small, the terms nearly cancel, and float64 would lose a factor of about (h/u1)**2
    in precision.  The program therefore uses quadrature.
    """
    u1, u2, u3 = c - n, c + m, c + a
    alpha, beta = (a + n) / u3, (m + n) / u2
    first = 2 * mpmath.elliprf(0, alpha, beta)
    third = mpf(2) / 3 * mpmath.elliprj(0, alpha, beta, 1)
    second = mpf(2) / 3 * mpmath.elliprd(0, alpha, beta)
    mixed = (alpha * beta - 2 * alpha - 2 * beta + 3) * third + beta * (alpha - beta) * second
    squared = (first / 2 + mixed / (2 * (beta - 1))) / (alpha - 1)
    U = [u1**k / mpmath.sqrt(u2 * u3) * v for k, v in enumerate((first, third, squared))]
    e1, e2, e3 = u1 + u2 + u3, u1 * u2 + u1 * u3 + u2 * u3, u1 * u2 * u3
    U.append((e3 * U[0] - 2 * e2 * U[1] + 3 * e1 * U[2]) / 4)
    return u2 * u3 * U[1] - (u2 + u3) * U[2] + U[3], u1 * u3 * U[1] - (u1 + u3) * U[2] + U[3]


@pytest.mark.parametrize(("a", "c", "pull"), [(1.5, 1.25, 2.0), (0.5, 2.0, -3.0)])
def test_hertz_in_complete_elliptic_integrals(a: float, c: float, pull: float) -> None:
    """Large tension: both conditions by Carlson's forms; the forms against their integrals."""
    radius = 2.0
    shear = 0.5 * F * float(hertz.load(a, c, E_star=E_STAR, R=radius))
    dsigma = pull * 8 * shear / (np.pi * (a + c))
    m, n, regime = steady(hertz, a, c, shear, dsigma, R=radius)
    assert regime == Regime.LARGE
    with mpmath.workdps(40):
        given_edges = [mpf(float(v)) for v in (a, c, m, n)]
        left, right, left_end, right_end = given_edges
        near, far = elliptic(*given_edges)
        for power, found in ((1, near), (-1, far)):

            def integrand(t: mpf, power: int = power) -> mpf:
                """At x = n + (c - n) sin(t)**2."""
                y, rest = ((right - right_end) * of(t) ** 2 for of in (mpmath.sin, mpmath.cos))
                root = mpmath.sqrt((left_end + right_end + y) / y) ** power
                return 2 * mpmath.sqrt(y * rest * (left + right_end + y) * rest) * root

            direct = mpmath.quad(integrand, [0, mpmath.pi / 2])
            assert abs(found / direct - 1) < mpf(10) ** -30
        near_left, far_left = elliptic(right, left, right_end, left_end)
        scale = np.sign(pull) * F * E_STAR / radius  # f 2 p = f (E*/R) sqrt(..)
        by_tension = mpmath.pi * dsigma * (left_end + right_end) / 8
        off_right = scale * (far_left - near) - shear + by_tension
        off_left = scale * (near_left - far) - shear - by_tension
        assert max(abs(off_right), abs(off_left)) < 1e-14 * shear


def test_regimes_of_constant_loads_follow_the_signs_of_K_T() -> None:
    """Random cycles: moderate if both K_T are positive; large if the right one, of the zone that is
    still stuck in the end, has the opposite sign; mixed between; all are solved."""
    rng = np.random.default_rng(1)
    a, c = np.exp(rng.normal(size=(2, 5000)))
    ratio = rng.choice([-1, 1], 5000) * np.exp(rng.uniform(-2, 2, 5000))
    shear = 2 * F * wedge.load(a, c, E_star=E_STAR, phi=0.25) * rng.uniform(0.001, 0.999, 5000)
    tension = ratio * 8 * shear / (np.pi * (a + c))
    m, n, regime = steady(wedge, a, c, shear, tension, phi=0.25)
    K_T = wedge.K_T(a, c, shear, tension)
    forward = (K_T.left >= 0) & (K_T.right >= 0)
    assert np.array_equal(regime == Regime.MODERATE, forward)
    assert np.array_equal(forward, np.abs(ratio) <= 1)
    assert set(np.unique(regime)) == {Regime.MODERATE, Regime.LARGE, Regime.MIXED}
    large = regime == Regime.LARGE
    assert np.all(np.pi * (m + n)[large] * np.abs(tension[large]) / 8 >= shear[large])
    assert np.all(regime[np.isnan(m)] == Regime.MIXED)


# ---------------------------------------------------------------------- what must always hold

size = st.floats(0.25, 4.0)
part = st.floats(0.01, 0.9)
tension = st.floats(-4.0, 4.0)
nudge = st.floats(-0.03, 0.03)


def one_cycle(
    body: ModuleType, own: dict[str, float], a: Any, c: Any, share: Any, pull: Any
) -> tuple[Any, Any]:
    """dQ and dsigma from parts of 2 f P and of 8 dQ/(pi h)."""
    shear = 2 * F * share * body.load(a, c, E_star=E_STAR, **own)
    return shear, pull * 8 * shear / (np.pi * (a + c))


@settings(max_examples=10)
@given(a=size, c=size, share=part, pull=tension, da=nudge, dc=nudge)
@example(a=1.5, c=1.25, share=0.2, pull=1.02, da=0.0, dc=0.0)  # slip turns round
def test_the_mirror_swaps_the_edges_and_backwards_a_zone_is_the_same(
    a: float, c: float, share: float, pull: float, da: float, dc: float
) -> None:
    """x -> -x turns M, alpha and dsigma; the flanks of the unequal wedge change places."""
    body, slopes, swapped = unequal_wedge, {"phi_1": 0.25, "phi_2": 0.375}, (0.375, 0.25)
    shear, dsigma = one_cycle(body, slopes, a, c, share, pull)
    near = {"rtol": 1e-9, "atol": 1e-9 * shear}
    law = {"f": F, "E_star": E_STAR, **slopes}
    turned = law | dict(zip(slopes, swapped, strict=True))
    here, there = Contact(a, c, 0.0), Contact(c, a, 0.0)
    after, behind = (Contact(u * (1 + v), w * (1 + z), 0.0)
                     for u, v, w, z in ((a, da, c, dc), (c, dc, a, da)))  # fmt: skip
    zone = body.stick_zone(here, after, shear, dsigma, **law, mixed=True)
    mirror = body.stick_zone(there, behind, shear, -dsigma, **turned, mixed=True)
    assert zone.regime == mirror.regime
    assert_allclose((zone.m, zone.n), (mirror.n, mirror.m), rtol=1e-11)
    backwards = body.stick_zone(after, here, shear, dsigma, **law, mixed=True)
    assert_allclose(backwards, zone, rtol=1e-11)
    mirror = body.tension_threshold(there, there, shear, **turned)
    limits = body.tension_threshold(here, here, shear, **law)
    assert_allclose(limits, (-mirror.upper, -mirror.lower), **near)
    moved, back = {"da": a * da, "dc": c * dc}, {"da": c * dc, "dc": a * da}
    for order in (1, 2):
        zones = body.slip_zones(a, c, shear, dsigma, **law, **moved, order=order)
        mirror = body.slip_zones(c, a, shear, -dsigma, **turned, **back, order=order)
        assert_allclose(zones, mirror[::-1], **near)
    x = np.linspace(-a, c, 7)
    pairs = [
        [
            getattr(body, name)(sign * x, *ends, shear, sign * dsigma, **given)
            for sign, ends, given in ((1, (here, here), law), (-1, (there, there), turned))
        ]
        for name in ("shear_change", "slip_range")
    ]
    pairs.append(
        [
            body.shear(
                *(sign * x, end, shear / 2, sign * dsigma / 2),
                **(given | {"dQ": shear, "dsigma": sign * dsigma}),
            )
            for sign, end, given in ((1, here, law), (-1, there, turned))
        ]
    )
    for first, second in pairs:
        assert_allclose(first, second, rtol=1e-6, atol=1e-7 * np.nanmax([1e-9, *np.abs(first)]))
    turn = np.array([0.0, 0.5, 1.0, 0.5])
    P, M = (of(a, c, E_star=E_STAR, **slopes) for of in (body.load, body.moment))
    march = body.march(P, M, shear * turn, dsigma * turn, **law)
    mirror = body.march(P, -M, shear * turn, -dsigma * turn, **turned)
    for field, other in (("a", "c"), ("m", "n"), ("left", "right"), ("regime", "regime")):
        assert_allclose(getattr(march, field), getattr(mirror, other), **near)


LENGTHS = ("R", "b", "R_1", "R_2")


@pytest.mark.enough("flat_rounded")
@pytest.mark.parametrize("name", ["hertz", "wedge", "rounded_wedge", "flat_rounded", "two_radii"])
def test_forces_and_lengths_scale(name: str) -> None:
    """Pa and m are free: random cycles, one with kinks in slip zones and at a place, and one in
    which slip turns round."""
    body, rng = module(name), np.random.default_rng(2)
    low, high = [[0.75], [0.75], [0.01], [-4]], [[3], [3], [0.9], [4]]
    a, c, share, pull = np.append(
        rng.uniform(low, high, (4, 14)),
        np.transpose([[1.305, 1.561, 0.125, 4], [1.5, 1.25, 0.2, 1.02]]),
        axis=1,
    )
    shear, dsigma = one_cycle(body, OWN[name], a, c, share, pull)
    x = np.array([0 * a, -0.95 * a, 0.97 * c])

    def found(length: float, force: float) -> Any:
        here, size = Contact(a * length, c * length, 0.0), length * force
        own = {k: v * length if k in LENGTHS else v for k, v in OWN[name].items()}
        given = {"f": F, "E_star": E_STAR * force, **own}
        loads = here, here, shear * size, dsigma * force
        zone = body.stick_zone(*loads, **given, mixed=True)
        slip = body.slip_range(x * length, *loads, **given)
        return zone.regime, np.array([zone.m, zone.n]) / length, slip / length

    regime, ends, slip = found(1.0, 1.0)
    assert {Regime.MODERATE, Regime.LARGE, Regime.MIXED} <= {*regime}
    for other in (found(1e-12, 1.0), found(1e6, 1.0), found(1.0, 1e8)):
        assert_array_equal(other[0], regime)
        assert_allclose(other[1], ends, rtol=1e-10)
        assert_allclose(other[2], slip, rtol=1e-8, atol=1e-12)


ONES = {"f": 0.5, "E_star": 1.0, "phi": 1.0}


def test_slip_that_reverses_for_a_while_and_is_overtaken() -> None:
    """Wedge, P = E* = phi = 1, dQ = 0.3 f P: the independent solver of tests/reference finds the
    moderate zone exact up to a + n = 8 dQ/(pi dsigma), 0.9322 of the tension that closes a slip
    zone (0.206021), and n = 0.98878 at 0.931 of it."""
    here = Contact(1.0, 1.0, 0.0)
    closing = 2 / math.pi * 4 * 0.5 * math.atan((1 - 0.85**2) / (2 * 0.85))  # m c = 0.85**2, c = 1
    assert_allclose(closing, 0.206021, atol=1e-6)
    parts = np.array([0.9271, 0.931, 0.9321, 0.9323, 1.0])
    for sign in (1, -1):
        zone = wedge.stick_zone(here, here, 0.15, sign * parts * closing, **ONES)
        assert np.all(zone.regime == Regime.MIXED)
        assert np.array_equal(np.isnan(zone.m), [False, False, False, True, True])
        assert_allclose((zone.n if sign > 0 else zone.m)[1], 0.98878, atol=1.1e-4)
        moderate = wedge.contact_at_tilt(0.85, -sign * parts[:3] * closing / 2, E_star=1.0, phi=1.0)
        assert_allclose(zone.n[:3], moderate.c, rtol=1e-14)


# ---------------------------------------------------------------------- single cycles


TURNS = (1.024055154, 0.947572418), (1.034835827, 0.478985506)


@pytest.mark.parametrize(
    ("first", "second", "shear", "change"),
    [
        # n of partial half-cycles, by another solution of both conditions: .8390676, .8388734 and
        # .8390422 at 0.9, 0.95 and 1 of the way
        ((0.959081679, 0.947987961), (0.799004679, 1.099626511), 0.054427069, 0.148206282),
        # and from the other end, 1.2298205 before 1.2298618
        ((0.855612782, 1.309197473), (0.90769218, 1.246496963), 0.026197074, 0.041746480),
        # a falls to 0.99392 half way; where it turns, slip begins
        (*TURNS, 0.000875918, -0.000726985),
    ],
)
def test_slip_that_reverses_on_the_way_is_mixed(
    first: tuple[float, float], second: tuple[float, float], shear: float, change: float
) -> None:
    ends, own = (Contact(*first, 0.0), Contact(*second, 0.0)), {"E_star": 1.25, "phi": 0.125}
    assert wedge.stick_zone(*ends, shear, change, f=0.5, **own).regime == Regime.MIXED
    if first == TURNS[0]:
        still = wedge.stick_zone(*ends, 0.0, 0.0, f=0.5, **own)
        assert still.regime == Regime.FULL_STICK and still.m < 0.995


def test_large_tension_that_drives_on_what_has_slipped_is_not_large() -> None:
    """Shear comes in as dQ - pi dsigma (x - mid)/4 where all sticks, right after the turn.

    Its zero, mid + 4 dQ/(pi dsigma), lies beyond the slip zones of opposite senses that the two
    conditions give: a wedge, tilted to where its middle slips.  Boundary elements that march find
    [-m, n] with m = -0.229, n = 0.257, narrower by 1 % of the contact than the conditions say.
    """
    here, own = Contact(1.0, 3.0, np.nan), {"E_star": 1.0, "phi": 0.125}
    dsigma = 20.0 * wedge.load(1.0, 3.0, **own) / 4
    law = {"f": 0.5, **own}
    for mixed in (False, True):
        zone = wedge.stick_zone(here, here, 0.0, dsigma, mixed=mixed, **law)
        assert np.isnan(zone.m) and np.isnan(zone.n)
        assert zone.regime in (Regime.MIXED, Regime.UNSOLVED)


def test_an_edge_that_turns_round_on_the_way_leaves_the_smallest_contact() -> None:
    """P from 1/2 to 2 at M = -1/r, r = sqrt(pi), cylinder with E* = R = 1: c = -M/P + 2 sqrt(P)/r
    is 3/r at P = 1, where dc/dP = 0, and more at both ends; a = M/P + 2 sqrt(P)/r grows from
    (sqrt(2) - 2)/r."""
    r = np.sqrt(np.pi)
    m, n = (np.sqrt(2) - 2) / r, 3 / r
    own: dict[str, Any] = {"f": 0.5, "E_star": 1.0, "R": 1.0}
    low, high = (hertz.contact(P, -1 / r, E_star=1.0, R=1.0) for P in (0.5, 2.0))
    for zone in (hertz.stick_zone(*pair, 0.0, 0.0, **own) for pair in ((low, high), (high, low))):
        assert zone.regime == Regime.FULL_STICK
        assert_allclose((zone.m, zone.n), (m, n), rtol=1e-14)
    assert np.isnan(hertz.slip_range(3.1 / r, low, high, 0.0, 0.0, **own))
    for steps in (1, 7):
        P = np.concatenate([np.linspace(2, 0.5, steps + 1), np.linspace(0.5, 2, steps + 1)[1:-1]])
        found = hertz.steady_cycle(P, -1 / r, 0.0, 0.0, **own)
        assert_allclose((found.m, found.n, found.error), (m, n, 0), rtol=1e-14)
    states = hertz.march(P, -1 / r, 0.0, 0.0, **own)
    assert np.all(np.diff(states.n[1:8]) <= 1e-15)  # what stuck since the reversal does not grow


def test_large_tension_holds_at_every_part_of_the_way() -> None:
    """kappa dq >= 0 where slip is still to come, at eight parts of the half-cycle: what is tested
    at both of its ends alone holds in between."""
    rng = np.random.default_rng(3)
    a, c = rng.uniform(0.75, 2.5, (2, 400))
    here, own = Contact(a, c, np.nan), {"E_star": 1.0, "phi": 0.125}
    friction = 0.5 * wedge.load(a, c, **own)
    dQ = 2 * rng.uniform(0, 0.9, 400) * friction
    dsigma = 2 * rng.uniform(-10, 10, 400) * friction / (a + c)
    law = {"f": 0.5, **own}
    zone = wedge.stick_zone(here, here, dQ, dsigma, **law)
    large = zone.regime == Regime.LARGE
    assert np.count_nonzero(large) > 60
    sense = np.sign(dsigma)
    for part in np.arange(1, 9) / 8:
        for place, kappa in ((-zone.m, sense), (zone.n, -sense)):
            dq = wedge.shear_change(place, here, here, part * dQ, part * dsigma, **law)
            assert np.all((kappa * dq)[large] >= -1e-9)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_slip_zones_down_to_rounding_are_found_at_any_size(size: float) -> None:
    """Large tension under a cylinder; until rounding hides them, the zones are |K_T|/(f K_N)."""
    here = hertz.contact(size, 0.0, E_star=1.0, R=size)
    dQ = 0.1 * size * 10.0 ** -np.arange(1, 16)
    dsigma = 6 * dQ / (here.a + here.c)
    zone = hertz.stick_zone(here, here, dQ, dsigma, f=F, E_star=1.0, R=size)
    assert_array_equal(zone.regime, Regime.LARGE)
    first = hertz.slip_zones(here.a, here.c, dQ, dsigma, f=F, E_star=1.0, R=size)
    found = np.array([here.a - zone.m, here.c - zone.n])
    rounding = 2e-15 * size / np.array(first)
    assert np.all(np.abs(found / first - 1) < 10 * dQ / size + rounding + 1e-9)
