"""Every body of the library: what mechanics demands of pressure and full stick, there and back over
24 decades."""

import importlib
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from numpy.testing import assert_allclose

from derive.body.library import load_geometry
from generated import two_radii

pytestmark = pytest.mark.slow

OWN: dict[str, dict[str, float]] = {
    "catenary": {"R": 1.0, "b": 0.5},
    "circular_arc": {"R": 1.0},
    "flat_rounded": {"b": 1.0, "R": 2.0},
    "flat_sloped": {"b": 1.0, "phi": 0.1},
    "hertz": {"R": 1.5},
    "hyperbola": {"phi": 0.1, "b": 1.0},
    "parabola_quartic": {"R": 1.0, "L": 1.0},
    "power": {"k": 2.5, "L": 1.0},
    "quartic": {"L": 1.0},
    "rounded_wedge": {"phi": 0.1, "b": 1.0},
    "two_radii": {"R_1": 1.0, "R_2": 3.0},
    "unequal_wedge": {"phi_1": 0.25, "phi_2": 0.125},
    "wedge": {"phi": 0.25},
    "wedge_parabola": {"phi": 0.1, "R": 1.0},
}
WIDEST = {"catenary": 1.0, "circular_arc": -0.1}
"""Decades of the widest contact, where a body ends or its load leaves float64."""

EVERY = pytest.mark.parametrize("name", sorted(OWN))
COUNT = 60
E_STAR = 1.75

A, C = np.array([1.25, 1.5, 1.125]), np.array([1.5, 1.25, 1.0625])
"""Contacts of every body; they reach over all its kinks."""


def module(name: str) -> ModuleType:
    return importlib.import_module(f"generated.{name}")


def shrunk(name: str) -> tuple[dict[str, float], Any, Any]:
    """Parameters and contacts, small for the arc, which ends at its radius."""
    by = 0.25 if name == "circular_arc" else 1.0
    return OWN[name], by * A, by * C


def states(name: str) -> tuple[Any, Any]:
    """Contacts from 1e-12 to 1e12 m wide, central and lopsided."""
    rng = np.random.default_rng(5)
    if name.startswith("flat"):
        width = 10 ** rng.uniform(0.4, 12, COUNT)
        middle = rng.uniform(-0.49, 0.49, COUNT) * (width - 2 * OWN[name]["b"])
    else:
        width = 10 ** rng.uniform(-12, WIDEST.get(name, 12.0), COUNT)
        middle = width * rng.uniform(-0.45, 0.45, COUNT)
    return width / 2 - middle, width / 2 + middle


def kinks(name: str) -> list[float]:
    """Places where a body's curve or its curvature may change."""
    found = (kink.position for kink in load_geometry(name).slope.kinks)
    return [0.0, *(float(at.subs({s: OWN[name][str(s)] for s in at.free_symbols})) for at in found)]


# ------------------------------------------------------------------ pressure and full stick


@EVERY
def test_pressure_is_positive_inside_and_zero_outside(name: str) -> None:
    body, given, (a, c) = module(name), {"E_star": E_STAR, **OWN[name]}, states(name)
    share, h = 10 ** np.random.default_rng(6).uniform(-9, np.log10(0.5), COUNT), a + c
    for x in (h * share - a, c - h * share):
        assert np.all(body.pressure(x, a, c, **given) > 0)
    for x in (-a - 1e-9 * h, -a, c, c + 1e-9 * h):
        assert not np.any(body.pressure(x, a, c, **given))


@EVERY
def test_pressure_carries_load_and_moment(name: str) -> None:
    """By the double-exponential rule between edges and kinks."""
    own, a, c = shrunk(name)
    body, given, t = module(name), {"E_star": E_STAR, **own}, np.arange(-3, 3.01, 1 / 16)
    y = np.pi / 2 * np.sinh(t)
    place, weight = np.tanh(y), np.pi / 32 * np.cosh(t) / np.cosh(y) ** 2
    for edges in zip(a, c, strict=True):
        cuts = np.unique([-edges[0], *kinks(name), edges[1]])
        mid, half = (cuts[1:] + cuts[:-1])[:, None] / 2, np.diff(cuts)[:, None] / 2
        x = mid + half * place
        part = half * weight * body.pressure(x, *edges, **given)
        load = body.load(*edges, **given)
        assert_allclose(np.sum(part), load, rtol=1e-9)
        off = np.sum(-x * part) - body.moment(*edges, **given)
        assert abs(off) <= 1e-9 * load * max(edges)


@EVERY
def test_pressure_next_to_an_edge_is_its_series(name: str) -> None:
    """p = K_N sqrt(s) + L_N s**(3/2) + ..., the rest of the order of (s/h)**2 of the first."""
    own, a, c = shrunk(name)
    body, given, s = module(name), {"E_star": E_STAR, **own}, (a + c) * 2.0**-17
    series = (getattr(body, function)(a, c, **given) for function in ("K_N", "L_N"))
    for x, K, L in zip((s - a, c - s), *series, strict=True):
        off = body.pressure(x, a, c, **given) - np.sqrt(s) * (K + L * s)
        assert np.all(np.abs(off) <= 1e-7 * np.sqrt(s) * K)
        assert np.all(np.abs(L * s) <= 1e-3 * K)


# ------------------------------------------------------------------ the contact from loads


@EVERY
def test_contact_inverts_load_and_moment_over_24_decades(name: str) -> None:
    """None lost; what is off is what the rounding of the edges moves."""
    body, given, (a, c) = module(name), {"E_star": E_STAR, **OWN[name]}, states(name)
    load, moment = body.load(a, c, **given), body.moment(a, c, **given)
    found = body.contact(load, moment, **given)
    assert not np.any(np.isnan(found.a))
    allowed = 1e-13 + 5.1 * rounding(body, a, c, **given)
    assert np.all(np.abs(body.load(found.a, found.c, **given) / load - 1) < allowed)
    off = body.moment(found.a, found.c, **given) - moment
    assert np.all(np.abs(off) / (load * (a + c)) < allowed)


AROUND = {"flat_rounded": {"R": 0.05, "b": 1e-3}, "rounded_wedge": {"phi": 0.02, "b": 1e-3}}
"""Bodies with kinks at -b and b."""


def rounding(body: ModuleType, a: Any, c: Any, **given: float) -> Any:
    """By how much the load moves, of itself, when both edges move by one unit in the last place."""
    K = body.K_N(a, c, **given)
    moved = np.pi / 4 * np.sqrt(a + c) * (K.left * np.abs(a) + K.right * np.abs(c)) * 2.0**-52
    return moved / body.load(a, c, **given)


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


def test_a_contact_hangs_on_one_shoulder() -> None:
    """A cylinder alone then: centre b + alpha R away, P = pi E* h**2/(16 R)."""
    P, centre, own = 0.01, np.array([1.5, -1.5, 40.0]), {"R": 1.0, "b": 1.0}
    a, c, alpha = module("flat_rounded").contact(P, -P * centre, E_star=1.0, **own)
    assert np.all((c < -1) | (a < -1))
    assert_allclose((c - a) / 2, centre, rtol=1e-12)
    assert_allclose(a + c, 4 * np.sqrt(P / np.pi), rtol=1e-10)
    assert_allclose(alpha, -np.sign(centre) * (np.abs(centre) - 1), rtol=1e-12)


def test_where_there_is_no_contact() -> None:
    """No load, no number, lengths past 1e75 m, a tilt beyond the flanks, and a centre or a load
    beyond the ends of an arc."""
    bad, inf, nan = [0.0, -1.0, np.inf, np.nan], np.inf, np.nan
    for name in ("flat_rounded", "hyperbola", "circular_arc"):
        body, own = module(name), {"E_star": 1.0, **OWN[name]}
        for solve in (body.contact, body.contact_at_tilt):
            assert np.all(np.isnan(solve(bad, 0.05, **own)))
            assert np.all(np.isnan(solve(1e-3, [inf, nan], **own)))
    flat, bent, arc = map(module, ("flat_rounded", "rounded_wedge", "circular_arc"))
    assert np.all(np.isnan(flat.contact([1e300, 1e5], [0.0, 1e300], E_star=1.0, R=1.0, b=1.0).a))
    given = {"E_star": 1.0, "phi": 0.02, "b": 1e-3}
    assert np.all(np.isnan(bent.contact_at_tilt(1.0, [0.02, -0.03, 1e9], **given).a))
    assert np.all(np.isnan(arc.contact([1e12, 1e4], [0.0, 2e3], E_star=1e11, R=0.1).a))


def test_an_arc_pressed_in_almost_to_its_ends() -> None:
    """One edge or both 1e-1 to 1e-5 of the radius from an end; none lost, none slow."""
    gap = 10.0 ** -np.linspace(1, 5, 41)
    own, a = {"R": 0.1}, 0.1 * (1 - gap)
    body, given = module("circular_arc"), {"E_star": 1e11, **own}
    for c in (a, 0.1 * (1 - gap[::-1]), 0.05, -0.05):
        load, moment = body.load(a, c, **given), body.moment(a, c, **given)
        found = body.contact(load, moment, **given)
        assert_allclose(found.a, a, rtol=1e-12)
        assert_allclose(found.c, c + 0 * a, rtol=1e-12)


@pytest.mark.parametrize("beyond", [1e-5, 6.3e-8])
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


@EVERY
def test_contact_at_tilt_inverts_load_and_tilt(name: str) -> None:
    """Load and modulus by one factor change no contact, which grows with the load."""
    own, a, c = shrunk(name)
    body, given = module(name), {"E_star": E_STAR, **own}
    load, tilt = body.load(a, c, **given), body.tilt(a, c, **own)
    found = body.contact_at_tilt(load, tilt, **given)
    assert_allclose(found.a, a, rtol=1e-13)
    assert_allclose(found.c, c, rtol=1e-13)
    stiffer = body.contact_at_tilt(16 * load, tilt, **given | {"E_star": 16 * E_STAR})
    assert_allclose(stiffer, found, rtol=1e-13)
    wider = body.contact_at_tilt(1.01 * load, tilt, **given)
    assert np.all(wider.a > a) and np.all(wider.c > c)


def test_a_hyperbola_tilted_almost_as_far_as_its_flanks() -> None:
    """phi (1 - 1e-3 to 1e-9) and loads over twelve decades, the load asked back."""
    own = {"b": 0.01, "phi": 0.1}
    body, given = module("hyperbola"), {"E_star": 1e11, **own}
    load, gap = np.meshgrid(10.0 ** np.arange(0.0, 13.0, 2.0), 10.0 ** -np.arange(3.0, 9.0))
    found = body.contact_at_tilt(load, 0.1 * (1 - gap), **given)
    off = np.abs(body.load(found.a, found.c, **given) / load - 1)
    assert np.all(off <= 1e-9 + 16 * rounding(body, found.a, found.c, **given))


@pytest.mark.parametrize("a", [1.5e-15, 1e-8, 1e-3])
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
