"""The change of shear over a half-cycle, the slip range, and the shear itself.

By the singular integral equation, by hand, within friction, and beside the independent solver.
"""

import importlib
import math
from typing import Any, NamedTuple

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mpf
from numpy.testing import assert_allclose

from generated import flat_rounded, flat_sloped, hertz, wedge
from generated.runtime.types import Contact, Regime
from tests.measure.accuracy.definitions import formula
from tests.measure.benchmarks.series import BODIES, E_STAR, F
from tests.reference.cases import HERTZ, HERTZ_LOAD
from tests.reference.kernel import Surface
from tests.reference.loads import State
from tests.reference.mesh import graded
from tests.reference.solver import Case as SolverCase
from tests.reference.solver import level

TENSIONS = {"moderate": 0.6, "large": 2.5, "large, compression": -3.0}
"""Tension in parts of 8 dQ/(pi h)."""
ONES = {"f": 0.5, "E_star": 1.0, "phi": 1.0}
NODES, WEIGHTS = np.polynomial.legendre.leggauss(150)


class Cycle(NamedTuple):
    """A body whose parameters are 1, both contacts, dQ and dsigma."""

    body: Any
    kinks: tuple[float, ...]
    first: tuple[float, float]
    second: tuple[float, float]
    dQ: float
    dsigma: float

    @property
    def loads(self) -> Any:
        """Arguments of the functions of a half-cycle."""
        return Contact(*self.first, 0.0), Contact(*self.second, 0.0), self.dQ, self.dsigma

    @property
    def law(self) -> dict[str, float]:
        """All constants."""
        own = {hertz: ("R",), wedge: ("phi",), flat_rounded: ("R", "b")}[self.body]
        return {"f": 0.5, "E_star": 1.0, **dict.fromkeys(own, 1.0)}

    def change(self, x: Any) -> Any:
        """dq at x."""
        return self.body.shear_change(x, *self.loads, **self.law)

    def slip(self, x: Any) -> Any:
        """The slip range at x."""
        return self.body.slip_range(x, *self.loads, **self.law)

    @property
    def zone(self) -> Any:
        """m, n and the regime."""
        return self.body.stick_zone(*self.loads, **self.law)


B = (-1.0, 1.0)
CYCLES = {
    "cylinder, moderate": Cycle(hertz, (), (1.2, 1.0), (1.2, 1.0), 0.3, 0.1),
    "cylinder, moderate, varying": Cycle(hertz, (), (1.2, 1.0), (1.15, 1.05), 0.3, -0.1),
    "cylinder, large": Cycle(hertz, (), (1.2, 1.0), (1.2, 1.0), 0.3, 0.8),
    "wedge, moderate": Cycle(wedge, (0.0,), (1.3, 0.9), (1.3, 0.9), 0.2, 0.1),
    "wedge, large": Cycle(wedge, (0.0,), (1.3, 0.9), (1.3, 0.9), 0.2, -0.5),
    "wedge, large, varying": Cycle(wedge, (0.0,), (1.3, 0.9), (1.26, 0.93), 0.2, 0.6),
    "flat, large": Cycle(flat_rounded, B, (1.6, 2.0), (1.6, 2.0), 0.2, 0.4),
    "flat, slip past kinks": Cycle(flat_rounded, B, (1.38, 1.17), (1.38, 1.17), 0.07, 0.2),
}
EACH = pytest.mark.parametrize("of", CYCLES.values(), ids=CYCLES)


def over(integrand: Any, *cuts: float, kinks: tuple[float, ...] = (-0.5, 0.0, 0.5)) -> float:
    """The integral between the outermost cuts, by Gauss-Legendre between them and the kinks;
    x = start + length sin(t)**2."""
    ends = sorted({*cuts, *(k for k in kinks if min(cuts) < k < max(cuts))})
    starts, lengths = np.array(ends[:-1])[:, None], np.diff(ends)[:, None]
    t = (NODES + 1) * np.pi / 4
    x, weight = starts + lengths * np.sin(t) ** 2, lengths * np.sin(2 * t) * WEIGHTS * np.pi / 4
    return float(np.sum(weight * integrand(x.ravel()).reshape(x.shape)))


def ends_of(of: Cycle) -> list[float]:
    """Edges of both contacts and ends of the stick zone."""
    m, n, _ = of.zone
    return [-of.first[0], -of.second[0], -float(m), float(n), of.first[1], of.second[1]]


def strain(of: Cycle, x: float) -> float:
    """(1/pi) PV int dq/(x - xi) dxi - dsigma/4."""
    here, ends = float(of.change(x)), ends_of(of)
    total = over(lambda xi: (of.change(xi) - here) / (x - xi), *ends, x, kinks=of.kinks)
    total += here * math.log((x - min(ends)) / (max(ends) - x))
    return total / math.pi - of.dsigma / 4


@EACH
def test_the_change_carries_the_shear_and_what_sticks_is_strained_by_tension_alone(
    of: Cycle,
) -> None:
    m, n, _ = of.zone
    assert over(of.change, *ends_of(of), kinks=of.kinks) == pytest.approx(of.dQ, rel=1e-7)
    for part in (0.03, 0.31, 0.87):
        assert strain(of, -m + part * (m + n)) == pytest.approx(0, abs=2e-6 * abs(of.dsigma))


@EACH
def test_the_slip_range_is_the_integral_of_the_strain(of: Cycle) -> None:
    """It grows outward from nothing at the stick zone; where there is no contact it is NaN."""
    m, n, _ = of.zone
    assert np.all(of.slip(np.linspace(-m, n, 5)) == 0)
    for side in (-1, 1):
        end, edge = (n, 1) if side > 0 else (m, 0)
        reach = min(of.first[edge], of.second[edge])
        x = side * (end + (reach - end) * np.linspace(0, 1, 30) ** 2)
        x[[0, -1]] = side * end, side * reach
        found = of.slip(x)
        assert found[0] == 0 and np.all(np.diff(found) > 0)
        assert np.isnan(of.slip(side * (reach + 1e-9)))
        for part in (0.23, 0.8):
            x, step = side * (end + part * (reach - end)), 1e-3 * (reach - end)
            slips = of.slip(x + step * np.array([-2, -1, 1, 2]))
            rate = (slips[0] - 8 * slips[1] + 8 * slips[2] - slips[3]) / (12 * step)
            assert side * rate == pytest.approx(2 * abs(strain(of, x)), rel=3e-5)


class Case:
    """One body of the series in one cycle; tension in parts of 8 dQ/(pi h)."""

    def __init__(self, name: str, tension: float) -> None:
        own, a, c = BODIES[name]
        self.body: Any = importlib.import_module(f"generated.{name}")
        self.law, self.own = {"f": F, "E_star": E_STAR, **own}, own
        self.here = Contact(a, c, 0.0)
        self.dQ = 0.3 * F * self.body.load(a, c, E_star=E_STAR, **own)
        self.dsigma = tension * 8 * self.dQ / (np.pi * (a + c))
        self.cycle = (self.here, self.here, self.dQ, self.dsigma)
        self.zone = self.body.stick_zone(*self.cycle, **self.law)
        self.ends = [-a, -self.zone.m, self.zone.n, c]

    def change(self, x: Any) -> Any:
        return self.body.shear_change(x, *self.cycle, **self.law)


def test_outside_and_unknown() -> None:
    case = Case("wedge", 0.6)
    assert case.change(2.0) == 0 and case.change(-2.0) == 0
    assert np.isnan(case.body.slip_range(2.0, *case.cycle, **case.law))
    mixed = Case("wedge", 1.05)
    assert mixed.zone.regime == Regime.MIXED
    assert np.all(np.isnan(mixed.change(np.array([-1.0, 0.0, 0.5]))))
    x = np.cos(np.linspace(0, np.pi, 2001))[::-1]
    here = Contact(1.0, 1.0, 0.0)  # forward slip overtakes: tests/reference/FINDINGS.md
    overtaken = here, here, 0.15, 0.931 * 0.206021
    assert_allclose(np.trapezoid(wedge.shear_change(x, *overtaken, **ONES), x), 0.15, rtol=1e-5)
    assert np.isnan(wedge.slip_range(0.995, *overtaken, **ONES))  # it slips back first
    none = wedge.shear_change(np.array([-1.0, 0.5]), case.here, case.here, 0.0, 0.0, **case.law)
    assert np.all(none == 0)
    still = Contact(1.2, 1.0, 0.0), Contact(1.3, 1.1, 0.0), 0.0, 0.0
    cylinder = {"f": 0.5, "E_star": 1.0, "R": 1.0}
    assert np.isnan(hertz.shear_change(0.1, *still, **cylinder))  # of loads that vary
    assert hertz.slip_range(0.1, *still, **cylinder) == 0


# ------------------------------------------------------------------ the shear itself


class Loop:
    """One body whose shear load rises to Q and falls by dQ, the tension in proportion."""

    def __init__(self, name: str, tension: float, fall: float = 1.4) -> None:
        self.case = Case(name, tension)
        self.Q, self.sigma = self.case.dQ / 2, self.case.dsigma / 2
        self.dQ, self.dsigma = fall * self.Q, fall * self.sigma
        self.body, self.here = self.case.body, self.case.here

    def shear(self, x: Any, part: float = 0.0) -> Any:
        """q after that part of the fall."""
        fall = {"dQ": part * self.dQ, "dsigma": part * self.dsigma}
        return self.body.shear(x, self.here, self.Q, self.sigma, **self.case.law, **fall)


@pytest.mark.enough("*wedge", "*flat_rounded")
@pytest.mark.parametrize("name", ["wedge", "two_radii", "flat_rounded"])
@pytest.mark.parametrize("tension", TENSIONS.values(), ids=TENSIONS)
@pytest.mark.parametrize("part", [0.0, 0.5])
def test_shear_carries_its_load_within_friction(name: str, tension: float, part: float) -> None:
    loop = Loop(name, tension)
    fallen = loop.body.stick_zone(
        loop.here, loop.here, part * loop.dQ, part * loop.dsigma, **loop.case.law
    )
    cuts = [*loop.case.ends, -fallen.m, fallen.n]
    q = over(lambda x: loop.shear(x, part), *cuts)
    assert_allclose(q, loop.Q - part * loop.dQ, rtol=1e-6, atol=1e-7 * loop.Q)
    x = np.linspace(-1.6, 1.1, 109)
    bound = F * loop.body.pressure(x, loop.here.a, loop.here.c, E_star=E_STAR, **loop.case.own)
    assert np.all(np.abs(loop.shear(x, part)) <= bound * (1 + 1e-9))
    slips = np.abs(loop.shear(x, part)) >= bound * (1 - 1e-9)
    upper = loop.case.zone if part == 0 else fallen
    assert np.all(slips == ((x <= -upper.m) | (x >= upper.n)))


@pytest.mark.parametrize("fall", [0.0, 1.25, 2.0])
def test_shear_of_a_cylinder_by_hand(fall: float) -> None:
    """Cattaneo: q = f p0 (sqrt(1 - x^2/a^2) - (b/a) sqrt(1 - x^2/b^2)), b = a sqrt(1 - Q/(f P)).

    Mindlin: less 2 f p0 (sqrt(1 - x^2/a^2) - (b'/a) sqrt(1 - x^2/b'^2)) after a fall by dQ, with
    b' = a sqrt(1 - dQ/(2 f P)).  With E* = 4, R = 1, a = 1: P = pi E* a^2/(4 R) = pi and
    p0 = E* a/(2 R) = 2; Q = f P/2: b^2 = 1/2, and b'^2 = 1 - fall/4 for a fall by fall Q.
    """
    x, f = np.linspace(-1.1, 1.1, 45), 0.25
    Q = f * np.pi / 2

    def ring(b: float) -> Any:
        return np.sqrt(np.maximum(1 - x**2, 0)) - np.sqrt(np.maximum(b**2 - x**2, 0))

    wanted = f * 2 * (ring(np.sqrt(0.5)) - 2 * ring(np.sqrt(1 - fall / 4)))
    here = Contact(1.0, 1.0, 0.0)
    found = hertz.shear(x, here, Q, 0.0, dQ=fall * Q, f=f, E_star=4.0, R=1.0)
    assert_allclose(found, wanted, atol=1e-14)


def test_where_the_shear_is_not_known() -> None:
    loop = Loop("wedge", 0.6)
    here, law, Q, sigma = loop.here, loop.case.law, loop.Q, loop.sigma
    large = 2.5 / 0.6 * loop.dsigma

    def q(Q: float, sigma: float, dQ: float, dsigma: float) -> Any:
        return wedge.shear(0.25, here, Q, sigma, dQ=dQ, dsigma=dsigma, **law)

    assert np.isfinite(q(Q, sigma, Q, sigma))
    assert np.isnan(q(Q, sigma, 2.1 * Q, 2.1 * sigma))  # past the reversal
    assert np.isnan(q(Q, sigma, loop.dQ, large))  # slips the other way on the right
    assert np.isnan(q(Q, 0.0, 1.9 * Q, 0.6 * sigma))  # deeper than the first slip on the left
    assert np.isnan(q(-Q, sigma, 0.0, 0.0))
    assert np.isnan(q(F * 0.125 * np.sqrt(1.5), 0.0, 0.0, 0.0))  # P = phi sqrt(a c): it slides
    assert q(0.0, 0.0, 0.0, 0.0) == 0.0
    assert np.isnan(q(0.0, 0.0, 0.5 * Q, 0.0))
    # forward slip overtakes in the whole half-cycle, yet a first rise is none: FINDINGS.md
    overtaken = Contact(1.0, 1.0, 0.0), 0.15 / 2, 0.931 * 0.206021 / 2
    assert np.isnan(wedge.shear(0.25, *overtaken, **ONES))
    assert wedge.shear(2.0, here, Q, sigma, **law) == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("body", [hertz, wedge])
def test_no_fall_leads_beyond_friction(body: Any) -> None:
    """Any rise, and any fall after it: what would drive on a place that slipped is not known."""
    rng = np.random.default_rng(12)
    own = {"phi": 0.125} if body is wedge else {"R": 1.0}
    a, c = 1.0, rng.uniform(0.3, 3.0, 150)
    friction, here = F * body.load(a, c, E_star=1.0, **own), Contact(a, c, np.nan)
    Q, sigma = rng.uniform(0, 0.99, 150) * friction, rng.uniform(-8, 8, 150) * friction / (a + c)
    down = {"dQ": 2 * rng.uniform(size=150) * Q, "dsigma": 2 * rng.uniform(size=150) * sigma}
    x = -a + np.linspace(0.01, 0.99, 21)[:, None] * (a + c)
    q = body.shear(x, here, Q, sigma, f=F, E_star=1.0, **own, **down)
    bound = F * body.pressure(x, a, c, E_star=1.0, **own)
    known = np.isfinite(q)
    assert np.count_nonzero(known.any(axis=0)) > 30
    assert np.all(np.abs(q[known]) <= (1 + 1e-7) * bound[known])


FIFTHS = [-1.02, -1, -0.9, -0.8, -0.6, -0.4, -0.2, 0, 0.2, 0.4, 0.6, 0.8, 0.9, 1, 1.02]


@pytest.mark.slow
@pytest.mark.enough("2.5-*")
@pytest.mark.parametrize(("tension", "fall"), [(0.0, 1.3), (0.4, 2.0), (2.5, 1.3), (-3.0, 2.0)])
def test_the_independent_solver_finds_the_same_shear(tension: float, fall: float) -> None:
    """It rises from nothing, falls and rises.  Mean differences fall with the mesh."""
    Q, R = 0.15 * F * HERTZ_LOAD, 1.0
    sigma = tension * 8 * Q / (np.pi * 2 * R)
    upper, lower = (State(HERTZ_LOAD, 0.0, v * Q, v * sigma) for v in (1.0, 1.0 - fall))
    off = []
    for count in (24, 48):
        mesh = Surface(graded(FIFTHS, count))
        found = level(SolverCase(HERTZ.body, F, upper, lower), mesh, 4)
        law = {"f": F, "E_star": HERTZ.body.E_star, "R": R}
        for q, part in ((found.cycle.back.q, 0.0), (found.cycle.there.q, fall)):
            down = {"dQ": part * Q, "dsigma": part * sigma}
            exact = hertz.shear(found.x, Contact(1.0, 1.0, 0.0), Q, sigma, **law, **down)
            off.append(np.mean(np.abs(q - exact)) / np.max(np.abs(exact)))
    assert np.all(np.array(off[2:]) < 5e-4)
    assert np.all(np.array(off[2:]) < np.array(off[:2]) / 2.5)


@pytest.mark.parametrize("gap", [1e-10, 1e-7])
def test_at_a_corner_beside_the_end_of_the_stick_zone(gap: float) -> None:
    """dq = 2 f (p - p_s), both infinite there; the formulas with 400 digits, 1e-150 before it."""
    law, friction, corner = {"E_star": 2.0, "phi": 0.1, "b": 0.3}, 0.5, 0.3
    patch = 0.8, corner + gap
    load = flat_sloped.load(*patch, **law)
    tilt = flat_sloped.tilt(*patch, phi=0.1, b=0.3)
    shear = 0.1 * load
    here = flat_sloped.contact_at_tilt(load + shear / (2 * friction), tilt, **law)
    cycle = here, here, shear, 0.0
    zone = flat_sloped.stick_zone(*cycle, f=friction, **law)
    assert 0 < zone.n - corner < 2 * gap
    pressure = formula("flat_sloped", "pressure")
    with mpmath.workdps(400):
        given = {name: mpf(value) for name, value in law.items()}
        whole, stuck = (
            pressure(x=mpf(corner) - mpf(10) ** -150, a=mpf(float(a)), c=mpf(float(c)), **given)
            for a, c in ((here.a, here.c), (zone.m, zone.n))
        )
        wanted = float(2 * friction * (whole - stuck))
    found = flat_sloped.shear_change(corner, *cycle, f=friction, **law)
    assert_allclose(found, wanted, rtol=1e-16 / gap + 1e-9)
    turned = Contact(here.c, here.a, -here.alpha)
    mirrored = flat_sloped.shear_change(-corner, turned, turned, shear, 0.0, f=friction, **law)
    assert_allclose(mirrored, wanted, rtol=1e-16 / gap + 1e-9)


@given(st.floats(1e-9, 0.5), st.floats(-0.999, 0.999))
def test_the_shear_of_short_slip_zones_by_hand(share: float, place: float) -> None:
    """Cattaneo and Mindlin: under a cylinder dq = (f E*/R) (sqrt(b**2 - x**2) - sqrt(d**2 - x**2)),
    d**2 = (1 - s) b**2 with s = dQ/(2 f P): f E*/R times s b**2 over the sum of both roots.
    """
    half, friction, law = 1.5, 0.4, {"E_star": 3.0, "R": 0.25}
    here = Contact(half, half, 0.0)
    load = np.pi * law["E_star"] * (2 * half) ** 2 / (16 * law["R"])
    found = hertz.shear_change(
        place * half, here, here, 2 * friction * load * share, 0.0, f=friction, **law
    )
    outer = half**2 * (1 - place) * (1 + place)
    inner = max(0.0, outer - share * half**2)
    by = share * half**2 if inner else outer
    wanted = friction * law["E_star"] / law["R"] * by / (np.sqrt(outer) + np.sqrt(inner))
    beside_the_end = 1e-14 / max(1e-300, abs(outer - share * half**2)) ** 0.5
    assert_allclose(found, wanted, rtol=1e-14 / share + beside_the_end)


@pytest.mark.parametrize("share", [1e-8, 1e-6])
@pytest.mark.parametrize("x", [-0.9, 0.3])
def test_tiny_slip_zones_of_large_tension_by_hand(share: float, x: float) -> None:
    """Where next to nothing slips dq is that of full stick, (dQ - pi dsigma x/4)/(pi w(x)) in a
    contact with a = c = 1; the zones' lengths are differences, known to 1e-16 of the contact."""
    here, law = Contact(1.0, 1.0, 0.0), {"f": 0.4, "E_star": 1.0, "R": 1.0}
    dQ, dsigma = share, 8 * share  # pi h dsigma/8 = 2 pi dQ
    assert hertz.stick_zone(here, here, dQ, dsigma, **law).regime == Regime.LARGE
    found = hertz.shear_change(x, here, here, dQ, dsigma, **law)
    wanted = (dQ - np.pi * dsigma * x / 4) / (np.pi * np.sqrt((1 - x) * (1 + x)))
    assert_allclose(found, wanted, rtol=1e-15 / share + 1e3 * share)
