"""The change of shear and the slip it leaves: force, strain, superposition, and the gap beside."""

import importlib
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import hertz, wedge
from generated._types import Contact, Regime
from tests.benchmarks.series import BODIES, E_STAR, F

CYCLES = {"moderate": 0.6, "large": 2.5, "large, compression": -3.0}
"""Tension in parts of 8 dQ/(pi h)."""
CLOSED = ("wedge", "hertz", "two_radii", "flat_rounded")
"""Bodies whose pressure is a formula; where it is integrated each place takes a millisecond."""

NODES, WEIGHTS = np.polynomial.legendre.leggauss(100)


class Case:
    """One body in one cycle; contacts that differ where `moved`."""

    def __init__(self, name: str, tension: float, moved: float = 0.0) -> None:
        own, a, c = BODIES[name]
        self.body: Any = importlib.import_module(f"generated.{name}")
        self.law, self.own = {"f": F, "E_star": E_STAR, **own}, own
        self.first, self.second = Contact(a, c, 0.0), Contact(a + moved, c + moved / 2, 0.0)
        self.dQ = 0.3 * F * self.body.load(a, c, E_star=E_STAR, **own)
        self.dsigma = tension * 8 * self.dQ / (np.pi * (a + c))
        self.cycle = (self.first, self.second, self.dQ, self.dsigma)
        self.zone = self.body.stick_zone(*self.cycle, **self.law)
        self.ends = [-self.second.a, -a, -self.zone.m, self.zone.n, c, self.second.c]

    def change(self, x: Any) -> Any:
        return self.body.shear_change(x, *self.cycle, **self.law)

    def integral(self, integrand: Any) -> float:
        """Over the contact, cut where dq is not smooth."""
        return over(integrand, *self.ends)


def over(integrand: Any, *cuts: float) -> float:
    """Gauss-Legendre between the cuts and the bodies' kinks; x = start + length sin(t)**2."""
    ends = sorted({*cuts, *(k for k in (-0.5, 0.0, 0.5) if min(cuts) < k < max(cuts))})
    t, weight = (NODES + 1) * np.pi / 4, WEIGHTS * np.pi / 4
    total = 0.0
    for start, stop in pairwise(ends):
        x = start + (stop - start) * np.sin(t) ** 2
        total += float(np.sum(integrand(x) * weight * (stop - start) * np.sin(2 * t)))
    return total


@pytest.mark.parametrize("name", CLOSED)
@pytest.mark.parametrize("tension", CYCLES.values(), ids=CYCLES)
def test_it_carries_the_shear_load(name: str, tension: float) -> None:
    case = Case(name, tension)
    assert_allclose(case.integral(case.change), case.dQ, rtol=1e-7)


@pytest.mark.parametrize("name", CLOSED)
@pytest.mark.parametrize("tension", CYCLES.values(), ids=CYCLES)
@pytest.mark.parametrize("moved", [0.0, pytest.param(0.01, marks=pytest.mark.slow)])
def test_its_strain_in_the_stick_zone_is_that_of_the_tension(
    name: str, tension: float, moved: float
) -> None:
    """(1/pi) PV int dq/(x - xi) dxi = dsigma/4; PV int dxi/(x - xi) is a logarithm."""
    case = Case(name, tension, moved)
    low, high = case.ends[0], case.ends[-1]
    for part in (0.2, 0.45, 0.8):
        x = -case.zone.m + part * (case.zone.m + case.zone.n)
        here = float(case.change(x))
        case.ends.append(x)
        regular = case.integral(lambda s, x=x, here=here: (case.change(s) - here) / (x - s))
        case.ends.pop()
        strain = (regular + here * np.log((x - low) / (high - x))) / np.pi
        assert_allclose(strain, case.dsigma / 4, rtol=1e-5, atol=1e-5 * case.dQ)


@pytest.mark.parametrize("tension", CYCLES.values(), ids=CYCLES)
def test_it_is_continuous_where_slip_begins(tension: float) -> None:
    case = Case("wedge", tension)
    for end in (-case.zone.m, case.zone.n):
        near = case.change(end + np.array([-1e-9, 0.0, 1e-9]))
        assert_allclose(near, near[1], rtol=1e-3)
        assert np.ptp(case.change(end + np.array([-1e-14, 0.0, 1e-14]))) < 1e-5 * abs(near[1])


def test_opposite_slip_has_opposite_signs() -> None:
    case = Case("wedge", 2.5)
    left, right = case.change(np.array([-1.49, 0.99]))
    assert left > 0 > right  # dQ > 0 and dsigma > 0 load the left edge more
    p = wedge.pressure(np.array([-1.49, 0.99]), 1.5, 1.0, E_star=E_STAR, **case.own)
    assert_allclose((left, right), 2 * F * p * [1, -1], rtol=1e-14)


def test_superposition() -> None:
    """Ciavarella and Jaeger: f (p1 + p2) - 2 f p of the patch, by functions of the sheet alone."""
    case, x = Case("hertz", 0.6, 0.01), np.linspace(-1.6, 1.1, 28)
    own = {"E_star": E_STAR, **case.own}
    p = sum(hertz.pressure(x, of.a, of.c, **own) for of in (case.first, case.second))
    patch = hertz.pressure(x, case.zone.m, case.zone.n, **own)
    assert_allclose(case.change(x), F * p - 2 * F * patch, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("name", ["hertz", "wedge", "flat_rounded"])
def test_slip_of_moderate_tension_is_the_gap_beside_the_patch(name: str) -> None:
    """2 f times the gap that the body leaves at the patch's load and tilt; the gap opens with the
    slope g' + alpha less the pressure's strain."""
    case = Case(name, 0.6)
    m, n = case.zone.m, case.zone.n
    law = {"E_star": E_STAR, **case.own}
    alpha = case.body.tilt(m, n, **case.own)
    g = {
        "hertz": lambda x: x**2 / 2,
        "wedge": lambda x: 0.125 * abs(x),
        "flat_rounded": lambda x: max(abs(x) - 0.5, 0.0) ** 2 / 2,
    }[name]

    def pressed(x: float, end: float) -> float:
        """int_end^x of the pressure's strain: that of 1/(x - s) is a logarithm."""

        def weighted(s: Any) -> Any:
            return case.body.pressure(s, m, n, **law) * np.log((x - s) / (end - s))

        return 2 / (np.pi * E_STAR) * over(weighted, -m, n)

    for end, edge in ((-m, -1.5), (n, 1.0)):
        for part in (0.5, 1.0):
            x = end + part * (edge - end)
            gap = g(x) - g(end) + alpha * (x - end)
            gap -= pressed(x, end)
            slip = case.body.slip_range(x, *case.cycle, **case.law)
            assert_allclose(slip, 2 * F * gap, rtol=1e-6)


@pytest.mark.parametrize("tension", CYCLES.values(), ids=CYCLES)
def test_slip_is_the_integral_of_the_mismatch_of_strain(tension: float) -> None:
    """(E*/2) d slip/dx = |(1/pi) PV int dq/(x - xi) dxi - dsigma/4| by quadrature of dq."""
    case = Case("hertz", tension)
    low, high = case.ends[0], case.ends[-1]
    for end, edge in ((-case.zone.m, low), (case.zone.n, high)):
        x = end + 0.5 * (edge - end)
        step = 1e-3 * (edge - end)
        before, after = (
            case.body.slip_range(x + s, *case.cycle, **case.law) for s in (-step, step)
        )
        here = float(case.change(x))
        case.ends.append(x)
        regular = case.integral(lambda s, x=x, here=here: (case.change(s) - here) / (x - s))
        case.ends.pop()
        strain = (regular + here * np.log((x - low) / (high - x))) / np.pi - case.dsigma / 4
        rate = (after - before) / (2 * abs(step))
        assert_allclose(rate, 2 / E_STAR * abs(strain), rtol=2e-3)


def test_nothing_slips_inside_the_stick_zone() -> None:
    case = Case("wedge", 2.5)
    x = np.linspace(-case.zone.m, case.zone.n, 9)
    assert np.all(case.body.slip_range(x, *case.cycle, **case.law) == 0)


def test_outside_and_unknown() -> None:
    case = Case("wedge", 0.6)
    assert case.change(2.0) == 0 and case.change(-2.0) == 0
    assert np.isnan(case.body.slip_range(2.0, *case.cycle, **case.law))
    mixed = Case("wedge", 1.05)
    assert mixed.zone.regime == Regime.MIXED
    assert np.all(np.isnan(mixed.change(np.array([-1.0, 0.0, 0.5]))))
    x = np.cos(np.linspace(0, np.pi, 2001))[::-1]
    law = {
        "f": 0.5,
        "E_star": 1.0,
        "phi": 1.0,
    }  # forward slip overtakes: tests/reference/FINDINGS.md
    overtaken = Contact(1.0, 1.0, 0.0), Contact(1.0, 1.0, 0.0), 0.15, 0.931 * 0.206021
    assert_allclose(np.trapezoid(wedge.shear_change(x, *overtaken, **law), x), 0.15, rtol=1e-5)
    assert np.isnan(wedge.slip_range(0.995, *overtaken, **law))  # it slips back first
    none = wedge.shear_change(np.array([-1.0, 0.5]), case.first, case.first, 0.0, 0.0, **case.law)
    assert np.all(none == 0)


@pytest.mark.parametrize("tension", CYCLES.values(), ids=CYCLES)
def test_it_is_finite_at_the_apex(tension: float) -> None:
    """The pressures' logarithms cancel in the stick zone."""
    case = Case("wedge", tension)
    here, beside = case.change(0.0), case.change(1e-7)
    assert_allclose(here, beside, rtol=1e-4)


def test_part_of_the_way() -> None:
    """dq until then: the same with what has changed until then, growing nowhere backwards."""
    case, x = Case("hertz", 0.6), np.linspace(-1.5, 1.0, 26)
    parts = np.array([0.25, 0.5, 1.0])[:, None]
    found = hertz.shear_change(
        x, case.first, case.first, parts * case.dQ, parts * case.dsigma, **case.law
    )
    assert found.shape == (3, 26)
    assert np.all(np.diff(found, axis=0) > -1e-15)
