"""Changes between two contacts, support/_changes.py, and what is made sharp by them."""

import importlib
import math
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mpf
from numpy.testing import assert_allclose

from derive.proof.points import numeric
from derive.symbols import E_star, a, c
from generated import flat_rounded, hertz, rounded_wedge, wedge
from generated._changes import change_along, change_between, edges_along
from generated._types import Contact, Regime
from tests.accuracy.reference import sheet_of

CYLINDER = {"E_star": 3.0, "R": 0.25}


WAYS: list[tuple[str, dict[str, float], Any, Any]] = [
    ("wedge", {"E_star": 2.0, "phi": 0.3}, (1.0, 1e-9), (0.75, 0.8e-9)),
    ("rounded_wedge", {"E_star": 2.0, "phi": 0.3, "b": 0.5}, (1.0, 0.75), (0.4, 0.3)),
    ("rounded_wedge", {"E_star": 2.0, "phi": 0.3, "b": 0.5}, (1.0, -0.25), (0.7, -0.3)),
    ("flat_rounded", {"E_star": 2.0, "R": 0.3, "b": 0.5}, (1.0, 0.75), (0.8, 0.7)),
    ("quartic", {"E_star": 2.0, "L": 0.3}, (1.0, 0.75), (0.6, 0.7)),
]
"""Bodies, their constants, and contacts between which they change."""


def exact(body: str, name: str, edges: tuple[float, float], constants: dict[str, float]) -> mpf:
    """A formula of the sheet with 50 digits."""
    sheet = sheet_of(body)
    point = {q.symbol: mpf(constants[q.name]) for q in sheet.geometry.parameters}
    point |= {E_star: mpf(constants["E_star"]), a: mpf(edges[0]), c: mpf(edges[1])}
    with mpmath.workdps(50):
        return numeric(sheet.flat(name))(point)


@pytest.mark.parametrize("back", [1e-14, 1e-6, 0.1, 0.9])
def test_a_cylinder_by_hand(back: float) -> None:
    """P = pi E* h**2/(16 R) and alpha = (a - c)/(2 R): from a = c = 1 with the left edge drawn back
    by d, P falls by pi E* d (4 - d)/(16 R) and E* alpha by E* d/(2 R).
    """
    start = np.array([1.0]), np.array([1.0])
    found = change_along(hertz._LAW, start, (np.array([-back]), np.array([0.0])), CYLINDER)
    assert_allclose(found.load, -math.pi * 3 * back * (4 - back) / 4, rtol=4e-15)
    assert_allclose(found.tilt, -3 * back / 0.5, rtol=4e-15)
    assert found.settled.all()


@pytest.mark.parametrize(("body", "constants", "start", "end"), WAYS)
def test_a_change_is_the_difference_of_two_formulas(
    body: str, constants: dict[str, float], start: Any, end: Any
) -> None:
    law = importlib.import_module(f"generated.{body}")._LAW
    first, last = (tuple(map(np.atleast_1d, edges)) for edges in (start, end))
    found = change_between(law, first, last, constants)
    assert found.settled.all()
    for value, name, scale in ((found.load, "load", 1), (found.tilt, "tilt", constants["E_star"])):
        wanted = scale * (exact(body, name, end, constants) - exact(body, name, start, constants))
        assert_allclose(value, float(wanted), rtol=1e-12)


@pytest.mark.parametrize("back", [1e-14, 1e-6, 0.1, 0.9])
def test_roots_at_the_edges_of_a_cylinder_by_hand(back: float) -> None:
    """K = E* sqrt(h)/(2 R) at both edges: from h = 2 to 2 - d both fall by
    E* d/(2 R (sqrt(2) + sqrt(2 - d))).
    """
    start = np.array([1.0]), np.array([1.0])
    motion = np.array([0.0]), np.array([-back])
    roots, settled = edges_along(hertz._LAW, start, motion, CYLINDER)
    wanted = -3 * back / (0.5 * (math.sqrt(2) + math.sqrt(2 - back)))
    assert_allclose(roots, [[wanted], [wanted]], rtol=4e-15)
    assert settled.all()


@pytest.mark.parametrize(("body", "constants", "start", "end"), WAYS)
def test_a_change_of_roots_is_the_difference_of_two_formulas(
    body: str, constants: dict[str, float], start: Any, end: Any
) -> None:
    law = importlib.import_module(f"generated.{body}")._LAW
    first, last = (tuple(map(np.atleast_1d, edges)) for edges in (start, end))
    motion = last[0] - first[0], last[1] - first[1]
    roots, settled = edges_along(law, first, motion, constants)
    assert settled.all()
    for value, name in zip(roots, ("K_N_left", "K_N_right"), strict=True):
        wanted = exact(body, name, end, constants) - exact(body, name, start, constants)
        assert_allclose(value, float(wanted), rtol=1e-12)


ROUNDED = {"E_star": 11.0, "R": 0.125, "b": 0.0625}
SHARP = {"E_star": 3.0, "phi": 0.25}

BESIDE_KINKS: list[tuple[str, dict[str, float], tuple[float, float], float]] = [
    ("flat_rounded", ROUNDED, (581160.0, 233.0), -68408.0),
    ("flat_rounded", ROUNDED, (5.0, 4.0), 0.125),
    ("wedge", SHARP, (1.0, 1e-3), 0.2e-3),
    ("wedge", SHARP, (1.0, 1e-3), 1e-5),
    ("rounded_wedge", SHARP | {"b": 0.5}, (1.0, 0.75), 0.51),
    ("rounded_wedge", SHARP | {"b": 0.5}, (1.0, 40.0), -0.4),
]
"""Bodies, their constants, a contact, and where its right edge draws back to."""


@pytest.mark.parametrize(("body", "constants", "start", "end"), BESIDE_KINKS)
def test_the_doubt_is_what_a_change_is_off_by(
    body: str, constants: dict[str, float], start: tuple[float, float], end: float
) -> None:
    """Where one edge moves, the load changes by its share alone."""
    law = importlib.import_module(f"generated.{body}")._LAW
    wanted = exact(body, "load", (start[0], end), constants) - exact(body, "load", start, constants)
    motion = np.array([0.0]), np.array([end - start[1]])
    found = change_along(law, tuple(map(np.atleast_1d, start)), motion, constants)
    off = float(abs(mpf(float(found.load[0])) / wanted - 1))
    assert off <= 30 * found.doubt[0] + 1e-15
    assert found.doubt[0] <= 1e3 * off + 1e-15


def test_a_moderate_zone_that_no_change_tells_is_told_by_load_and_tilt() -> None:
    """Its right edge has passed a narrow flat, which the rules along the way do not resolve.

    Wide contacts of a flat of half-width b on flanks of radius R: what slips beyond the flat leaves
    a zone on the left flank alone, a cylinder around x = -b, whose load is pi E* h**2/(16 R) and
    whose tilt is (m - n - 2 b)/(2 R).
    """
    constants, friction = {"E_star": 10.0, "R": 0.125, "b": 0.0625}, 0.25
    edges, shear, tension = (581160.0, 233.0), 8e11, -1.6e6
    here = Contact(*edges, 0.0)
    zone = flat_rounded.stick_zone(here, here, shear, tension, f=friction, **constants)
    assert zone.regime == Regime.MODERATE
    with mpmath.workdps(50):
        load = exact("flat_rounded", "load", edges, constants) - mpf(shear) / (2 * mpf(friction))
        lean = exact("flat_rounded", "tilt", edges, constants)
        lean -= mpf(tension) / (4 * mpf(friction) * 10)
        width = mpmath.sqrt(16 * mpf(0.125) * load / (mpmath.pi * 10))
        apart = 2 * mpf(0.125) * lean + 2 * mpf(0.0625)
        m, n = (width + apart) / 2, (width - apart) / 2
    assert n < -0.0625
    assert_allclose([zone.m, zone.n], [float(m), float(n)], rtol=1e-14)


def test_what_is_not_known_to_rounding_is_said() -> None:
    """K_N of a wedge grows like 1/sqrt(a) as the edge comes close to the apex."""
    ways = np.array([0.9, 1e-4])
    first, last = (np.ones(2), np.ones(2)), (ways, np.ones(2))
    found = change_between(wedge._LAW, first, last, {"E_star": 1.0, "phi": 0.1})
    assert found.settled.tolist() == [True, False]


def test_no_motion_changes_nothing() -> None:
    here = np.array([1.0]), np.array([0.5])
    found = change_between(rounded_wedge._LAW, here, here, {"E_star": 1.0, "phi": 0.1, "b": 0.2})
    assert [*found.load, *found.tilt, *found.settled] == [0, 0, True]


@given(st.floats(1e-13, 0.9), st.floats(-0.49, 0.49))
def test_the_tension_that_closes_a_zone_under_a_cylinder(share: float, middle: float) -> None:
    """The width under (1 - q) P is h sqrt(1 - q), q = dQ/(2 f P): the far edge draws back by
    d = h q/(1 + sqrt(1 - q)), which turns the body by d/(2 R): dsigma = 2 f E* d/R.
    """
    h, friction = 1.0, 0.5
    left, right = h * (0.5 + middle), h * (0.5 - middle)
    width = left + right
    load = math.pi * CYLINDER["E_star"] * width**2 / (16 * CYLINDER["R"])
    here = Contact(left, right, 0.0)
    found = hertz.closing_tension(here, here, 2 * friction * load * share, f=friction, **CYLINDER)
    back = width * share / (1 + math.sqrt(1 - share))
    wanted = 2 * friction * CYLINDER["E_star"] * back / CYLINDER["R"]
    assert_allclose([-found.lower, found.upper], wanted, rtol=2e-14)


@pytest.mark.parametrize("right", [1e-2, 1e-6, 1e-11, 1e-14])
def test_a_moderate_zone_close_to_the_largest_tilt(right: float) -> None:
    """A wedge that leans almost on one flank: both equations solved with 50 digits."""
    constants = {"E_star": 2.0, "phi": 0.3}
    edges, friction = (1.0, right), 0.5
    load = wedge.load(*edges, **constants)
    shear, tension = 0.05 * load, 0.02 * load
    here = Contact(*edges, 0.0)
    zone = wedge.stick_zone(here, here, shear, tension, f=friction, **constants)
    assert zone.regime == Regime.MODERATE
    with mpmath.workdps(50):
        less = exact("wedge", "load", edges, constants) - mpf(float(shear))
        lean = exact("wedge", "tilt", edges, constants) - mpf(float(tension)) / 4

        def off(m: mpf, log_n: mpf) -> list[mpf]:
            point = {E_star: mpf(2), numeric_phi: mpf(0.3), a: m, c: mpmath.exp(log_n)}
            return [of_load(point) / less - 1, (of_tilt(point) - lean) / mpmath.sqrt(right)]

        numeric_phi = sheet_of("wedge").geometry.parameters[0].symbol
        of_load, of_tilt = (numeric(sheet_of("wedge").flat(n)) for n in ("load", "tilt"))
        m, log_n = mpmath.findroot(off, (mpf(float(zone.m)), mpmath.log(mpf(float(zone.n)))))
        n = mpmath.exp(log_n)
    assert_allclose([zone.m, zone.n], [float(m), float(n)], rtol=5e-15)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["wedge", "rounded_wedge"])
def test_results_are_the_same_bits_alone_and_among_others(name: str) -> None:
    module: Any = importlib.import_module(f"generated.{name}")
    own = {"wedge": {"phi": 0.1}, "rounded_wedge": {"phi": 0.1, "b": 0.3}}[name]
    law, friction, rng = {"E_star": 2.0, **own}, 0.5, np.random.default_rng(2)
    left = rng.uniform(0.5, 1, 60)
    right = left * 10 ** rng.uniform(-9, 0, 60)
    shear = module.load(left, right, **law) * 10 ** rng.uniform(-9, -0.1, 60)

    def all_of(a: Any, c: Any, dQ: Any) -> Any:
        here = Contact(a, c, 0.0 * a)
        zone = module.stick_zone(here, here, dQ, 0.0, f=friction, **law)
        closing = module.closing_tension(here, here, dQ, f=friction, **law)
        change = module.shear_change((c - a) / 2, here, here, dQ, 0.0, f=friction, **law)
        return np.array([zone.m, zone.n, *closing, change])

    together = all_of(left, right, shear)
    alone = [all_of(*given) for given in zip(left, right, shear, strict=True)]
    assert np.array_equal(together.T, alone, equal_nan=True)


@pytest.mark.parametrize("share", [0.1, 0.9, 1.1, 10.0])
@pytest.mark.parametrize("grown", [1e-4, 1e-8, 1e-11])
def test_a_closing_tension_between_two_cylinder_contacts(grown: float, share: float) -> None:
    """From a = c = 1 to 1 + e, E* = 3, R = 1/4, f = 1/2: P = (3 pi/4) h**2.  The zone carries
    (P1 + P2)/2 - dQ; its width h = sqrt(4 P/(3 pi)) may be more than 2.  With c = 1 kept its left
    edge is at h - 1: 4 f E* times the mean tilt, 0, less (h - 2)/(2 R) is 12 (2 - h).
    """
    end = 1 + grown
    with mpmath.workdps(40):
        loads = [3 * mpmath.pi / 4 * (2 * mpf(edge)) ** 2 for edge in (1.0, end)]
        shear = float(share * (loads[1] - loads[0]))
        width = mpmath.sqrt(4 * (sum(loads) / 2 - mpf(shear)) / (3 * mpmath.pi))
        wanted = float(12 * (2 - width))
    first, second = Contact(1.0, 1.0, 0.0), Contact(end, end, 0.0)
    found = hertz.closing_tension(first, second, shear, f=0.5, **CYLINDER)
    assert_allclose([found.upper, -found.lower], wanted, rtol=4e-15)
