"""Stick zones of cycles in which slip turns round: another solution, borders, what must hold."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from generated import wedge
from generated.runtime.forward import each_pressure
from generated.runtime.history import refine
from generated.runtime.types import Contact, Regime
from tests.generated import test_stick
from tests.generated.test_stick import E_STAR, F, module
from tests.reference.conditions import HalfCycle, Patch
from tests.reference.loads import State
from tests.reference.mixed import turning

pytestmark = pytest.mark.slow

LIKE = ("hertz", "wedge", "unequal_wedge", "two_radii", "flat_rounded", "quartic")
OWN: dict[str, dict[str, float]] = {
    **{name: test_stick.OWN[name] for name in LIKE},
    "rounded_wedge": {"phi": 0.25, "b": 1.0},
    "parabola_quartic": {"R": 1.5, "L": 1.25},
}


def cycle(name: str, a: Any, c: Any, dQ: Any, tension: Any) -> tuple[Any, Any, Any]:
    """Contact, dQ and dsigma; dQ in parts of 2 f P, tension of 8 dQ/(pi h)."""
    shear = 2 * F * dQ * module(name).load(a, c, E_star=E_STAR, **OWN[name])
    return Contact(a, c, 0.0), shear, tension * 8 * shear / (np.pi * (np.asarray(a) + c))


def zone_of(name: str, a: Any, c: Any, dQ: Any, tension: Any, mixed: bool = True) -> Any:
    here, shear, change = cycle(name, a, c, dQ, tension)
    given = {"f": F, "E_star": E_STAR, **OWN[name]}
    return module(name).stick_zone(here, here, shear, change, **given, mixed=mixed)


def half_cycle(name: str, a: float, c: float, dQ: float, tension: float) -> HalfCycle:
    _, shear, change = cycle(name, a, c, dQ, tension)
    body, law = module(name), {"E_star": E_STAR, **OWN[name]}
    own = np.array([OWN[name][key] for key in sorted(OWN[name])])  # the order of the law

    def pressure(x: Any) -> Any:
        """Compiled: it is asked tens of thousands of times."""
        rows, out = np.ones((len(x), 4)), np.empty((len(x), 1))
        rows[:, 0], rows[:, 1], rows[:, 2] = x, a, c
        each_pressure(body._BODY.law, rows, np.tile(own, (len(x), 1)), out)
        return E_STAR * out[:, 0]

    patch = Patch(a, c, pressure)
    P, M = (float(of(a, c, **law)) for of in (body.load, body.moment))
    ends = (State(P, M, s * float(shear) / 2, s * float(change) / 2) for s in (-1, 1))
    return HalfCycle(lambda P, M: patch, F, *ends)


@pytest.mark.enough("wedge-1.5-1.25-*", "wedge-1.25-*", "quartic-*")
@pytest.mark.parametrize(
    ("name", "a", "c", "dQ", "tension"),
    [
        ("wedge", 1.5, 1.5, 0.15, 1.02),  # phase 3 begins early
        ("wedge", 1.5, 1.25, 0.15, 1.08),
        ("wedge", 1.25, 1.5, 0.2, 1.2),  # the half-cycle ends in phase 2
        ("hertz", 1.5, 1.5, 0.25, 1.05),
        ("hertz", 1.75, 1.25, 0.4, 1.1),
        ("unequal_wedge", 1.0, 1.25, 0.2, 1.1),
        ("quartic", 1.5, 1.25, 0.3, 1.04),
        ("parabola_quartic", 1.25, 1.5, 0.3, 1.06),
    ],
)
def test_another_solution_finds_the_same(
    name: str, a: float, c: float, dQ: float, tension: float
) -> None:
    """tests/reference/mixed.py: Abel's equation by steps, tables by splines, SciPy's roots; it
    shares no line with the package, and agrees with the boundary-element solver."""
    zone = zone_of(name, a, c, dQ, tension)
    assert zone.regime == Regime.MIXED
    other = turning(half_cycle(name, a, c, dQ, tension)).zone
    assert_allclose((zone.m, zone.n), other, atol=2e-6 * (a + c))


RECEDES = {
    (2.16, 1.785, 0.392, 1.443): (0.9117067, 1.6851613),
    (1.96, 1.86, 0.56, 1.35): (0.5513213, 1.7390336),
}
"""Cycles of a rounded wedge, and the limits of m and n of the other solution in finer cells."""


@pytest.mark.parametrize("at", RECEDES)
def test_slip_that_recedes_past_a_kink(at: tuple[float, float, float, float]) -> None:
    """At x = -b the rate at which the stick zone falls has a root."""
    zone = zone_of("rounded_wedge", *at)
    assert zone.m < OWN["rounded_wedge"]["b"] < at[0]
    assert_allclose((zone.m, zone.n), RECEDES[at], rtol=0, atol=4e-8 * sum(at[:2]))


@pytest.mark.enough("flat_rounded")
@pytest.mark.parametrize("name", OWN)
def test_nearly_all_random_cycles_are_solved(name: str) -> None:
    """Up to 0.6 of the shear that slides, and tension to twice the threshold: what is left is NaN,
    told as UNSOLVED."""
    rng = np.random.default_rng(7)
    a, c = rng.uniform(0.75, 2.0, (2, 80))
    tension = np.exp(rng.uniform(np.log(0.95), np.log(2), 80)) * rng.choice([-1, 1], 80)
    zone = zone_of(name, a, c, rng.uniform(0.02, 0.6, 80), tension)
    solved, lost = zone.regime == Regime.MIXED, zone.regime == Regime.UNSOLVED
    assert np.all(np.isfinite(zone.m) == ~lost)
    assert np.count_nonzero(solved) >= 10
    assert np.count_nonzero(solved) >= 3 * np.count_nonzero(lost)
    assert np.all((zone.m <= a)[solved] & (zone.n <= c)[solved] & (zone.m + zone.n > 0)[solved])


@pytest.mark.enough("hertz", "flat_rounded")
@pytest.mark.parametrize("name", ["wedge", "hertz", "flat_rounded", "two_radii"])
def test_there_is_no_hole_beside_the_other_regimes(name: str) -> None:
    """Past a + n(moderate) = 8 dQ/(pi dsigma), by d in parts of the contact, the zone parts from
    the moderate one like d**2: quarter the step, a sixteenth of the way.  Into large tension it
    goes over without a step."""
    a, c, shear = 1.0, 1.25, 0.3
    body, law = module(name), {"E_star": E_STAR, **OWN[name]}
    _, dQ, top = cycle(name, a, c, shear, 1.0)
    load, tilt = body.load(a, c, **law) - dQ / (2 * F), body.tilt(a, c, **OWN[name])

    def patch(part: Any) -> Any:
        return body.contact_at_tilt(load, tilt - part * top / (4 * F * E_STAR), **law)

    def past(part: float) -> float:
        return float((a + patch(part).c) / (a + c) - 1 / part)

    border = brentq(past, 0.9, 1.1)
    part = border + np.geomspace(1e-6, 1e-2, 24)
    zone = zone_of(name, a, c, shear, part)
    assert np.all(zone.regime == Regime.MIXED)
    d = np.array([past(each) for each in part])
    apart = np.abs(zone.n - patch(part).c) / (a + c)
    assert np.all(apart <= 1.5 * d**2 + 1e-9)
    assert np.all(apart[d > 1e-3] >= 0.2 * d[d > 1e-3] ** 2)

    def large(part: float) -> bool:
        return bool(zone_of(name, a, c, shear, part, mixed=False).regime == Regime.LARGE)

    low, high = 1.02, 1.9
    while high - low > 1e-8:
        middle = (low + high) / 2
        low, high = (low, middle) if large(middle) else (middle, high)
    before, beyond = (zone_of(name, a, c, shear, part) for part in (low, high))
    assert (before.regime, beyond.regime) == (Regime.MIXED, Regime.LARGE)
    assert_allclose(before[:2], beyond[:2], atol=1e-6)


def test_the_second_window_begins_where_the_large_zone_gets_too_narrow() -> None:
    """m + n(large) = 8 dQ/(pi dsigma) again at a large tension: beyond it the zone goes on."""
    tension = np.linspace(2.0, 6.0, 81)
    zone = zone_of("hertz", 1.0, 1.0, 0.5, tension)
    large = zone.regime == Regime.LARGE
    assert large[0] and not large[-1]
    border = np.flatnonzero(~large)[0]
    assert np.all(np.isfinite(zone.m[: border + 8]))
    for end in (zone.m, zone.n):
        steps = np.abs(np.diff(end[border - 4 : border + 8]))
        assert np.max(steps) <= 1.5 * np.min(steps)


def test_varying_loads_stay_unknown() -> None:
    first, second = (Contact(a, 1.25, 0.0) for a in (1.5, 1.52))
    _, shear, change = cycle("wedge", 1.5, 1.25, 0.2, 1.05)
    law = {"f": F, "E_star": E_STAR, "phi": 0.25}
    zone = wedge.stick_zone(first, second, shear, change, **law, mixed=True)
    assert zone.regime == Regime.MIXED and np.isnan(zone.m)


def test_elements_find_the_same_beside_the_ends_of_a_flat() -> None:
    """Edges 3e-5 inside and 6e-3 beyond the ends of the flat, in parts of it."""
    at = ("flat_rounded", 0.499985, 0.50302, 0.3079, 1.1169)
    name, a, c = at[:3]
    zone, (here, dQ, dsigma) = zone_of(*at), cycle(*at)
    body, own = module(name), OWN[name]
    P, M = (float(of(here.a, here.c, E_star=1.0, **own)) for of in (body.load, body.moment))
    loads = np.array([[P, P], [M, M], [0, dQ / E_STAR], [0, dsigma / E_STAR]])
    found = refine.steady_cycle(body._BODY, own, F, loads[:, [0, 1, 0]], np.zeros(0), 1e-3)
    assert zone.regime == Regime.MIXED
    assert abs(zone.m - found.m) < found.error * (a + c) < 5e-3
    assert abs(zone.n - found.n) < found.error * (a + c)
