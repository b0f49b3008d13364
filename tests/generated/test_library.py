"""Every body of the library: there and back over 24 decades, mirrors, scales, and any input."""

import importlib
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from numpy.testing import assert_allclose

from derive.library import library, load_geometry
from derive.units import parse_unit
from generated import two_radii
from tests.benchmarks.inverse import PARAMETERS, SYMMETRIC, states

pytestmark = pytest.mark.slow

OWN: dict[str, dict[str, float]] = PARAMETERS | {
    "hertz": {"R": 1.5},
    "wedge": {"phi": 0.25},
    "unequal_wedge": {"phi_1": 0.25, "phi_2": 0.125},
}
EVERY = pytest.mark.parametrize("name", sorted(OWN))
COUNT = 2000
E_STAR = 1.75

A, C = np.array([1.25, 1.5, 1.125]), np.array([1.5, 1.25, 1.0625])
"""Contacts of every body; they reach over all its kinks."""


def module(name: str) -> ModuleType:
    return importlib.import_module(f"generated.{name}")


def shrunk(name: str) -> tuple[dict[str, float], Any, Any]:
    """Parameters and contacts, small for the arc, which ends at its radius."""
    by = 0.25 if name == "circular_arc" else 1.0
    return OWN[name], by * A, by * C


def test_the_tests_know_every_body() -> None:
    assert sorted(OWN) == sorted(library())


@pytest.mark.parametrize("name", sorted(PARAMETERS))
def test_contact_inverts_load_and_moment_over_24_decades(name: str) -> None:
    """None lost; what is off is what the rounding of the edges moves."""
    body, own, a, c = states(name, COUNT)
    given = {"E_star": E_STAR, **own}
    load, moment = body.load(a, c, **given), body.moment(a, c, **given)
    found = body.contact(load, moment, **given)
    assert not np.any(np.isnan(found.a))
    h, K = a + c, body.K_N(a, c, **given)
    rounding = np.sqrt(h) * (K.left * np.abs(a) + K.right * np.abs(c)) * 2.0**-52 / load
    allowed = 1e-13 + 4 * rounding
    assert np.all(np.abs(body.load(found.a, found.c, **given) / load - 1) < allowed)
    off = body.moment(found.a, found.c, **given) - moment
    assert np.all(np.abs(off) / (load * h) < allowed)


AROUND = {"flat_rounded": {"R": 0.05, "b": 1e-3}, "rounded_wedge": {"phi": 0.02, "b": 1e-3}}
"""Bodies with kinks at -b and b."""


def rounding(body: ModuleType, a: Any, c: Any, **given: float) -> Any:
    """By how much the load moves, of itself, when both edges move by one unit in the last place."""
    K = body.K_N(a, c, **given)
    moved = np.pi / 4 * np.sqrt(a + c) * (K.left * np.abs(a) + K.right * np.abs(c)) * 2.0**-52
    return moved / body.load(a, c, **given)


@pytest.mark.parametrize("name", AROUND)
@pytest.mark.parametrize("side", [-1, 1])
def test_a_load_that_has_its_centre_at_a_kink(name: str, side: int) -> None:
    """Down to widths of 1e-11 of the kink's distance from the origin."""
    body, own = module(name), AROUND[name]
    given = {"E_star": 115e9, **own}
    load = 10.0 ** np.arange(-15.0, -2.0)
    found = body.contact(load, side * load * own["b"], **given)
    off = np.abs(body.load(found.a, found.c, **given) / load - 1)
    assert np.all(off <= 1e-9 + 16 * rounding(body, found.a, found.c, **given))
    centre = -body.moment(found.a, found.c, **given) / body.load(found.a, found.c, **given)
    assert np.all(np.abs(centre + side * own["b"]) <= 1e-4 * (found.a + found.c))


@pytest.mark.parametrize("name", AROUND)
@pytest.mark.parametrize("side", [-1, 1])
def test_contacts_around_a_kink_are_found_again(name: str, side: int) -> None:
    """Each edge 1e-12 to 1e-3 m off the kink, one of them often far closer than the other."""
    body, own, rng = module(name), AROUND[name], np.random.default_rng(3)
    given = {"E_star": 115e9, **own}
    before, beyond = np.append(10 ** rng.uniform(-12, -3, (2, 300)), [[1e-8], [2e-8]], axis=1)
    a, c = before - side * own["b"], beyond + side * own["b"]
    load = body.load(a, c, **given)
    by_moment = body.contact(load, body.moment(a, c, **given), **given)
    by_tilt = body.contact_at_tilt(load, body.tilt(a, c, **own), **given)
    off = 1e-9 + 16 * rounding(body, a, c, **given)
    for found in (by_moment, by_tilt):
        assert np.all(np.abs(body.load(found.a, found.c, **given) / load - 1) <= off)
    assert np.all(np.abs(by_moment.a - a) <= 100 * off * (a + c))


@pytest.mark.parametrize("k", [1.01, 1.03, 1.041, 1.05])
def test_a_power_too_close_to_the_wedge_gives_no_number(k: float) -> None:
    """The rule goes to 1e-275 of a piece; 1e-275**(k - 1) of the load is left, 1e-14 at 1.05."""
    body, given = module("power"), {"E_star": 1.0, "k": k, "L": 1.0}
    assert np.isnan(body.load(1.0, 1.5, **given))
    assert np.isnan(body.moment(1.0, 1.5, **given))
    assert np.isnan(body.K_N(1.0, 1.5, **given)).all()
    assert np.isnan(body.pressure(0.25, 1.0, 1.5, **given))
    assert np.isnan(body.contact(1.0, 0.0, **given)).all()
    assert np.isfinite(body.load(1.0, 1.5, **{**given, "k": 1.06}))


@pytest.mark.parametrize(
    ("k", "alpha"),
    [(1.06, 1e-6), (1.06, 1e-8), (1.06, -1e-12), (1.1, 1e-12), (1.1, 1e-25), (1.3, -1e-40)],
)
def test_a_power_law_level_closer_to_its_apex_than_lengths_can_be(k: float, alpha: float) -> None:
    """(|x|/L)**(k - 1) = alpha within 1e-100 m of it; the contact is micrometres wide all the same.

    Its load and its tilt are asked back; a tilt this small does not change its width.
    """
    own, given = {"k": k, "L": 1e-2}, {"E_star": 115e9, "k": k, "L": 1e-2}
    body = module("power")
    found = body.contact_at_tilt(1e5, alpha, **given)
    assert_allclose(body.load(found.a, found.c, **given), 1e5, rtol=1e-13)
    assert_allclose(body.tilt(found.a, found.c, **own), alpha, atol=1e-15)
    level = body.contact_at_tilt(1e5, 0.0, **given)
    assert_allclose(found.a + found.c, level.a + level.c, rtol=1e-9)


HARD = [
    ("wedge_parabola", {"R": 0.05, "phi": 0.02}, 1.0, 1e-3),
    ("flat_rounded", AROUND["flat_rounded"], 1e-11, 0.0),
    ("flat_rounded", AROUND["flat_rounded"], 2.27e-9, -6.53e-13),
    ("flat_rounded", AROUND["flat_rounded"], 1e300, 1.0),
    ("flat_rounded", AROUND["flat_rounded"], 1e5, 1e300),
]
"""A centre of load on the straight flank; edges a femtometre beyond kinks; lengths past 1e75 m."""


def counted(body: ModuleType, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """For how many contacts the body's state is asked from now on, call by call."""
    asked, state = [], body._state

    def counting(a: Any, c: Any, **given: Any) -> Any:
        asked.append(np.size(a))
        return state(a, c, **given)

    monkeypatch.setattr(body, "_state", counting)
    return asked


@pytest.mark.parametrize(("name", "own", "load", "moment"), HARD)
def test_one_hard_load_asks_for_few_contacts(
    name: str, own: dict[str, float], load: float, moment: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So that it costs its neighbours milliseconds."""
    body = module(name)
    asked = counted(body, monkeypatch)
    body.contact(load, moment, E_star=115e9, **own)
    assert len(asked) <= 80


HOPELESS = [
    ("circular_arc", {"R": 0.1}, 1e12, 0.0),
    ("circular_arc", {"R": 0.1}, 1e20, 5e18),
    ("circular_arc", {"R": 0.1}, 1e4, 2e3),
    ("wedge_parabola", {"R": 0.1, "phi": 0.1}, 1e-30, 5e-32),
]
"""More load than the arc carries closer than 1e-6 to its ends, a centre beyond them, a contact
narrower than 1e-75 m."""


@pytest.mark.parametrize(("name", "own", "load", "moment"), HOPELESS)
def test_one_hopeless_load_is_given_up_early(
    name: str, own: dict[str, float], load: float, moment: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    body = module(name)
    asked = counted(body, monkeypatch)
    assert np.isnan(body.contact(load, moment, E_star=1e11, **own).a)
    assert len(asked) <= 400


def test_an_arc_pressed_in_almost_to_its_ends() -> None:
    """One edge or both 1e-1 to 1e-6 of the radius from an end; none lost, none slow."""
    gap = 10.0 ** -np.linspace(1, 6, 41)
    own, a = {"R": 0.1}, 0.1 * (1 - gap)
    body, given = module("circular_arc"), {"E_star": 1e11, **own}
    for c in (a, 0.1 * (1 - gap[::-1]), 0.05, -0.05):
        load, moment = body.load(a, c, **given), body.moment(a, c, **given)
        found = body.contact(load, moment, **given)
        assert_allclose(found.a, a, rtol=1e-13)
        assert_allclose(found.c, c + 0 * a, rtol=1e-13)
        mirrored = body.contact(load, -moment, **given)
        assert_allclose(mirrored.c, a, rtol=1e-13)


@pytest.mark.parametrize("beyond", [1e-5, 1e-6, 6.3e-8, 1e-9])
@pytest.mark.parametrize("tilted", [False, True])
def test_an_edge_just_beyond_a_corner_is_met_to_its_rounding(beyond: float, tilted: bool) -> None:
    """Not to 1e-9 of the load alone, which leaves the edge's distance from it one part in 1e4."""
    body, own = module("wedge_parabola"), {"phi": 0.2, "R": 1.3}
    a, c = beyond * np.array([1.0, -1.7, 0.6]), np.array([3.5, 1.0, 2.0])
    load = body.load(a, c, E_star=1.0, **own)
    if tilted:
        found = body.contact_at_tilt(load, body.tilt(a, c, **own), E_star=1.0, **own)
    else:
        found = body.contact(load, body.moment(a, c, E_star=1.0, **own), E_star=1.0, **own)
    again = body.load(found.a, found.c, E_star=1.0, **own)
    assert_allclose(again, load, rtol=2e-13)


def test_an_edge_at_the_apex_of_a_sharp_power_by_hand() -> None:
    """k = 3/2, L = 1, contact [-1, 0]: g'' = t**(-1/2)/2 at t = -x, and w = sqrt(t (1 - t)), so
    P = (1/2) int g'' w = (1/4) int sqrt(1 - t) dt = 1/6.  K_N at the apex is infinite."""
    body, own = module("power"), {"k": 1.5, "L": 1.0}
    assert body.load(1.0, 0.0, E_star=1.0, **own) == pytest.approx(1 / 6, rel=1e-13)
    # M = -mid P - (1/8) int g'' w (2 s + a - c) ds, mid = -1/2, and the integral is
    # (1/2) int sqrt(1 - t) (1 - 2 t) dt = (1/2) (2/3 - 8/15) = 1/15
    assert body.moment(1.0, 0.0, E_star=1.0, **own) == pytest.approx(1 / 12 - 1 / 120, rel=1e-13)


def test_a_load_whose_edge_coefficients_leave_float64() -> None:
    """cosh 690 = 1e299: K_N is infinite in float64, and P = (pi/2) r I_1(r) is not."""
    r = 690.0
    load = module("catenary").load(r, r, E_star=1.0, R=1.0, b=1.0)
    assert load == pytest.approx(float(mpmath.pi / 2 * r * mpmath.besseli(1, r)), rel=1e-12)


def test_a_tilt_that_hangs_on_its_own_rounding_has_no_contact() -> None:
    """A flank of slope phi, tilted to within 2e-14 phi or 1e-12 phi of lying level: rounding,
    2.2e-16 phi, is more than a hundredth of the one gap, and 2.2e-4 of the other."""
    body, given = module("rounded_wedge"), {"E_star": 1.0, "phi": 0.02, "b": 1e-3}
    found = body.contact_at_tilt([1e-21, 1e-18], [0.02 * (1 - 2e-14), 0.02 * (1 - 1e-12)], **given)
    assert np.isnan(found.a[0])
    off = body.load(found.a[1], found.c[1], **given) / 1e-18 - 1
    assert abs(off) <= 1e-9 + 16 * rounding(body, found.a[1], found.c[1], **given)


def test_a_hyperbola_under_a_far_load() -> None:
    """Its centre 1e5 to 1e9 m from a bend of half a metre, which the right edge has just left."""
    own, a, c = {"b": 0.625, "phi": 0.125}, np.array([1e5, 1e8, 9.5e9]), np.array([-0.5, -2, -6])
    body, given = module("hyperbola"), {"E_star": 1.0, **own}
    found = body.contact(body.load(a, c, **given), body.moment(a, c, **given), **given)
    assert_allclose(found.a, a, rtol=1e-13)
    assert_allclose(found.c, c, rtol=1e-8)


def test_a_hyperbola_tilted_almost_as_far_as_its_flanks() -> None:
    """phi (1 - 1e-3 to 1e-9) and loads over twelve decades, the load asked back."""
    own = {"b": 0.01, "phi": 0.1}
    body, given = module("hyperbola"), {"E_star": 1e11, **own}
    load, gap = np.meshgrid(10.0 ** np.arange(0.0, 13.0, 2.0), 10.0 ** -np.arange(3.0, 9.0))
    found = body.contact_at_tilt(load, 0.1 * (1 - gap), **given)
    off = np.abs(body.load(found.a, found.c, **given) / load - 1)
    assert np.all(off <= 1e-9 + 16 * rounding(body, found.a, found.c, **given))


def test_a_load_over_the_straight_flank_of_a_wedge() -> None:
    """All of it pressed by the apex, where g' jumps by phi; c far below a, and the centre -a/4."""
    own = {"R": 0.05, "phi": 0.02}
    found = module("wedge_parabola").contact(1.0, 1e-3, E_star=115e9, **own)
    assert_allclose(found.a, 4e-3, rtol=1e-6)
    # P = (E*/2) int g'' w ds = (E*/2) phi sqrt(a c)
    assert_allclose(found.c, (2 * 1.0 / (115e9 * own["phi"])) ** 2 / 4e-3, rtol=1e-6)


@EVERY
def test_contact_at_tilt_inverts_load_and_tilt(name: str) -> None:
    own, a, c = shrunk(name)
    body, given = module(name), {"E_star": E_STAR, **own}
    found = body.contact_at_tilt(body.load(a, c, **given), body.tilt(a, c, **own), **given)
    assert_allclose(found.a, a, rtol=1e-13)
    assert_allclose(found.c, c, rtol=1e-13)


@pytest.mark.parametrize("name", sorted(SYMMETRIC))
def test_the_mirror_image_of_a_contact(name: str) -> None:
    own, a, c = shrunk(name)
    body, given = module(name), {"E_star": E_STAR, **own}
    x = -a + 0.3 * (a + c)
    for function, odd in (("load", 1), ("moment", -1)):
        there, here = (getattr(body, function)(*e, **given) for e in ((c, a), (a, c)))
        assert_allclose(there, odd * here, rtol=1e-13, atol=1e-15)
    for function in ("K_N", "L_N"):
        there, here = (getattr(body, function)(*e, **given) for e in ((c, a), (a, c)))
        assert_allclose(there.left, here.right, rtol=1e-12)
    assert_allclose(body.tilt(c, a, **own), -body.tilt(a, c, **own), rtol=1e-12, atol=1e-15)
    there, here = body.pressure(-x, c, a, **given), body.pressure(x, a, c, **given)
    assert_allclose(there, here, rtol=1e-12)


@EVERY
def test_all_lengths_larger_by_one_factor(name: str) -> None:
    """P goes with it, M with its square, tilt and pressure not at all."""
    own, a, c = shrunk(name)
    by = 2.0**11
    units = {q.name: parse_unit(q.unit).length for q in load_geometry(name).parameters}
    larger = {key: value * by ** float(units[key]) for key, value in own.items()}
    body = module(name)
    small, large = {"E_star": E_STAR, **own}, {"E_star": E_STAR, **larger}
    assert_allclose(body.load(by * a, by * c, **large), by * body.load(a, c, **small), rtol=1e-13)
    x = -a + 0.4 * (a + c)
    there = body.pressure(by * x, by * a, by * c, **large)
    assert_allclose(there, body.pressure(x, a, c, **small), rtol=1e-13)
    assert_allclose(body.tilt(by * a, by * c, **larger), body.tilt(a, c, **own), rtol=1e-12)


@EVERY
def test_numbers_arrays_and_what_does_not_exist(name: str) -> None:
    own, a, c = shrunk(name)
    body, given = module(name), {"E_star": E_STAR, **own}
    load = body.load(a, c, **given)
    alone = [body.load(float(p), float(q), **given) for p, q in zip(a, c, strict=True)]
    assert_allclose(alone, load, rtol=1e-14)
    assert type(alone[0]) is np.float64
    assert body.load(a[:, None], c, **given).shape == (3, 3)
    assert body.load(np.empty(0), c[:1], **given).shape == (0,)
    stiffness = np.array([[1.0], [2.0]])
    assert body.contact(load, E_star=stiffness, **own).a.shape == (2, 3)
    mixed = body.contact(np.array([load[0], -1.0, np.nan, load[1]]), **given)
    assert list(np.isnan(mixed.a)) == [False, True, True, False]
    assert_allclose(mixed.a[[0, 3]], body.contact(load[:2], **given).a, rtol=1e-14)
    assert np.isnan(body.load(-2.0, 1.0, **given))
    outside = body.pressure(np.array([-1e160, 1e160, -np.inf, np.inf, 3.0]), a[0], c[0], **given)
    assert list(outside) == [0.0] * 5
    assert np.isnan(body.pressure(np.nan, a[0], c[0], **given))
    many = np.linspace(0.9, 1.0, 30_000)
    whole = body.load(many * a[0], c[0], **given)
    assert_allclose(whole[::7000], body.load(many[::7000] * a[0], c[0], **given), rtol=1e-13)


@EVERY
def test_the_pressure_carries_the_load(name: str) -> None:
    """int p dx by Gauss and Chebyshev on x = mid + (h/2) cos(t); corners are only logarithms."""
    own, a, c = shrunk(name)
    body, given = module(name), {"E_star": E_STAR, **own}
    t = (np.arange(4000) + 0.5) * np.pi / 4000
    for left, right in zip(a, c, strict=True):
        h, mid = left + right, (right - left) / 2
        p = body.pressure(mid + h / 2 * np.cos(t), left, right, **given)
        found = np.sum(p * np.sin(t)) * h / 2 * np.pi / 4000
        assert_allclose(found, body.load(left, right, **given), rtol=1e-3)


@pytest.mark.parametrize("a", [1.5e-15, 1.1e-13, 1e-8, 1e-3])
def test_an_edge_beside_a_change_of_radius_keeps_its_digits(a: float) -> None:
    """K_left = (1/(pi sqrt h)) int g'' sqrt((c - s)/(a + s)) ds, and with s + a = h sin(t)**2 each
    piece of constant g'' gives g'' h (t + sin(2 t)/2): an angle T = asin sqrt(a/h) of 1/R_1, the
    rest of 1/R_2."""
    R_1, R_2, c = 1.0, 3.0, 1.25
    with mpmath.workdps(40):
        h = mpf(a) + c
        T = mpmath.asin(mpmath.sqrt(a / h))
        inner = T + mpmath.sin(2 * T) / 2
        exact = mpmath.sqrt(h) / mpmath.pi * (inner / R_1 + (mpmath.pi / 2 - inner) / R_2)
    found = two_radii.K_N(a, c, E_star=1.0, R_1=R_1, R_2=R_2)
    assert abs(float(found.left) / float(exact) - 1) < 1e-14


@pytest.mark.parametrize("x", [-6.7e-288, 1e-265, 5e-324])
def test_the_pressure_next_to_a_smooth_kink_is_that_at_it(x: float) -> None:
    """In a wide contact with the kink not far from an edge: quotients leave float64 there."""
    law = {"E_star": 1.0, "R_1": 0.3, "R_2": 77.0}
    edges = 1.7e7, 2.7e8
    assert two_radii.pressure(x, *edges, **law) == two_radii.pressure(0.0, *edges, **law)


@EVERY
def test_a_contact_gives_the_same_bits_wherever_it_stands(name: str) -> None:
    """Whether two contacts are the same decides how a cycle slips: rounding must not tell.

    Many of their edges lie close to kinks, where formulas give way to quadrature.
    """
    body, own = module(name), OWN[name]
    by = 0.25 if name == "circular_arc" else 1.0
    a, c = by * np.random.default_rng(4).uniform([[1.001], [1.0]], [[1.5], [2.0]], (2, 317))
    twice = np.stack([a, a]), np.stack([c, c])
    K = body.K_N(*twice, E_star=E_STAR, **own)
    load, moment = (of(*twice, E_star=E_STAR, **own) for of in (body.load, body.moment))
    for value in (load, moment, body.tilt(*twice, **own), K.left, K.right):
        assert np.array_equal(value[0], value[1], equal_nan=True)


@pytest.mark.parametrize("name", ["flat_rounded", "rounded_wedge", "two_radii", "catenary"])
def test_a_contact_gives_the_same_bits_alone_and_among_others(name: str) -> None:
    """Sums of one column and of many are added up in one order."""
    body, own = module(name), OWN[name]
    a, c = np.random.default_rng(4).uniform([[1.001], [1.0]], [[1.5], [2.0]], (2, 40))
    whole = [*body.K_N(a, c, E_star=E_STAR, **own), *body.L_N(a, c, E_star=E_STAR, **own)]
    whole += [body.load(a, c, E_star=E_STAR, **own), body.tilt(a, c, **own)]
    for i in range(a.size):
        one = a[i : i + 1], c[i : i + 1]
        alone = [*body.K_N(*one, E_star=E_STAR, **own), *body.L_N(*one, E_star=E_STAR, **own)]
        alone += [body.load(*one, E_star=E_STAR, **own), body.tilt(*one, **own)]
        assert [float(value[0]) for value in alone] == [float(value[i]) for value in whole]


def test_a_narrow_flat_in_a_wide_contact_keeps_the_digits_of_the_second_coefficient() -> None:
    """Without the flat -1/(4 sqrt(h)); the flat takes int k ds/pi away over its width, k of the
    defining integral.  Both halves of the parabola are ten thousand times as large."""
    a, c = 1e4, 1e12
    found = module("flat_rounded").L_N(a, c, E_star=1.0, R=1.0, b=1.0)
    with mpmath.workdps(40):
        h = mpf(a) + mpf(c)

        def taken(s: mpf) -> mpf:
            r = mpmath.sqrt((c - s) / (a + s))
            return r * (3 + 2 * r**2) / (6 * h ** mpf(1.5))

        exact = -1 / (4 * mpmath.sqrt(h)) - mpmath.quad(taken, [-1, 1]) / mpmath.pi
        assert abs(mpf(float(found.left)) / exact - 1) < 1e-15


def test_a_pressure_beside_a_corner_by_quadrature_keeps_its_digits() -> None:
    """At distances d far below a and c, p/E* = (phi/pi) log(1/d)/2 and what does not change with d:
    between two of them, one a subnormal number, it rises by (phi/pi) log(d2/d1)/2."""
    own, a, c = {"R": 1e9, "phi": 0.05}, 2e-12, 2e-5
    near, far = 8.1257789551387e-311, 8.1257789551387e-201
    p = module("wedge_parabola").pressure([near, far], a, c, E_star=1.0, **own)
    with mpmath.workdps(30):
        rise = mpf(own["phi"]) / mpmath.pi * mpmath.log(mpf(far) / mpf(near)) / 2
        assert abs(mpf(float(p[0] - p[1])) / rise - 1) < 1e-14


def test_the_pressure_beside_a_corner_grows_to_the_smallest_of_numbers() -> None:
    """p = -(phi/pi) log x + what does not change; the corner just inside the left edge."""
    own, E = {"phi": 0.0625, "R": 0.5}, 2.0
    x = 10.0 ** np.arange(-320.0, -290.0)
    p = module("wedge_parabola").pressure(x, 2e-12, 2e-5, E_star=E, **own)
    steps = np.diff(p) / (E * own["phi"] / (2 * np.pi) * np.log(10))
    assert_allclose(steps[10:], -1, rtol=1e-6)  # earlier ones are numbers of a few bits
    assert np.all(steps < 0)


@pytest.mark.parametrize(
    ("name", "arm", "factor"),
    [
        ("wedge_parabola", 0.3, 2),
        ("flat_sloped", -10.0, 2),
        ("rounded_wedge", -1e3, 2),
        ("flat_rounded", 0.3, 2),
        ("hyperbola", 0.3, 2),
        ("two_radii", 0.3, 1),
    ],
)
def test_many_loads_of_one_arm_are_solved_as_few_are(
    name: str, arm: float, factor: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Edges cross kinks where the load grows: what starts between two rungs must not be lost there,
    nor cost many times more."""
    body, own = module(name), {"E_star": 1.0, **OWN[name]}
    load, asked = np.geomspace(1e-8, 1e4, 700), counted(body, monkeypatch)
    together = body.contact(load, arm * load, **own)
    at_once, asked[:] = sum(asked), []
    apart = [body.contact(part, arm * part, **own) for part in np.split(load, 2)]
    for field, *parts in zip(together, *apart, strict=True):
        assert_allclose(field, np.concatenate(parts), rtol=1e-8, equal_nan=True)
    assert at_once <= factor * sum(asked) + 2000
