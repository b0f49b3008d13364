"""Each constant bounds something: a law that holds no longer holds if it is ten times worse.

The kernels run as plain Python in a process of their own, where a constant can be replaced.
"""

import json
import math
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest

from generated import (
    edge,
    flat_rounded,
    flat_sloped,
    full_stick,
    hertz,
    power,
    quartic,
    rounded_wedge,
    wedge,
)
from generated.runtime import inverse, segments
from generated.runtime.types import Contact, Regime
from tests.edge.example import bonded
from tests.reference.kernel import Surface
from tests.reference.normal import Body, press

F = 0.5
CYLINDER: dict[str, Any] = {"f": F, "E_star": 1.0, "R": 1.0}
OWN = {"E_star": 1.0, "R": 1.0}
LOAD = math.pi / 4
"""Load of a cylinder whose contact is [-1, 1]."""
T = np.arange(17) * np.pi / 8


# ---------------------------------------------------------------- edges


def nodes(count: int, noise: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Nodal pressures of a cylinder."""
    x = np.linspace(-1, 1, count + 2)[1:-1]
    spread = 1 + noise * np.random.default_rng(1).standard_normal(count)
    return x, np.sqrt(1 - x * x) * abs(spread)


def few_nodes_give_a_warning() -> bool:
    return "only" in edge.fit_pressure(*nodes(20)).warning


def missing_nodes_give_a_warning() -> bool:
    x, p = nodes(200)
    kept = (x < -0.9) | (x > -0.8)
    return "missing" in edge.fit_pressure(x[kept], p[kept]).warning


def a_large_error_gives_a_warning() -> bool:
    return "known only" in edge.fit_pressure(*nodes(60, 0.1)).warning


def of_boundary_elements() -> bool:
    """K_N and K_T of a cylinder, each from three meshes of 50 elements, are within two of the
    errors stated, which are at most 1 % and 3 %."""
    found, true = [], (hertz.K_N(1.0, 1.0, **OWN).left, full_stick.K_T(1.0, 1.0, 1.0, 0.0).left)
    for part in (0.15, 0.5, 0.85):
        x = -1 + (np.arange(-3, 54) + part) / 25
        surface = Surface(x)
        p = press(Body(lambda x: x * x / 2, 1.0, ()), surface, LOAD, 0.0).p
        fit = edge.fit_pressure(x, p)
        stuck = edge.fit_stuck_shear(x, bonded(surface, p > 0, 1.0), -1.0)
        off = fit.edge + 1, fit.K_N - true[0], stuck.K_T - true[1]
        stated = fit.edge_error, fit.K_N_error, stuck.K_T_error
        found.append(np.all(np.abs(off) <= 2 * np.array(stated)))
        found.append(fit.K_N_error < 0.01 * true[0] and stuck.K_T_error < 0.03 * true[1])
    return bool(np.all(found))


def a_long_slip_zone_gives_a_warning() -> bool:
    one = edge.Edge(K_N=float(hertz.K_N(1.0, 1.0, **OWN).left), K_T=0.12)
    return "large part" in edge.match(one, hertz, **CYLINDER).warning


def what_is_missed_is_told() -> bool:
    """K_N = 1 makes this cylinder's contact 4 wide, and L_N = -K_N/(2 h) = -1/8."""
    one = edge.Edge(1.0, 0.1, L_N=-0.125 * (1 + 5e-8))
    return len(edge.match(one, hertz, **CYLINDER).missed) == 1


# ---------------------------------------------------------------- contacts


def far_contacts_are_found() -> bool:
    """The load acts far beyond the rounded apex: a wedge from there on."""
    P, M = 1e-6, 1e-2
    found = rounded_wedge.contact(P, M, E_star=1.0, b=1.0, phi=0.5)
    back = rounded_wedge.load(found.a, found.c, E_star=1.0, b=1.0, phi=0.5)
    return bool(abs(back / P - 1) < 1e-6)


def light_contacts_are_found() -> bool:
    """The search begins at a width of P/E*; the contact is 1e45 times as wide."""
    found = quartic.contact(1e-60, 0.0, E_star=1.0, L=1.0)
    return bool(abs(quartic.load(found.a, found.c, E_star=1.0, L=1.0) / 1e-60 - 1) < 1e-12)


def small_and_large_contacts_are_found() -> bool:
    """P = E* phi h/2, as on a wedge."""
    P = np.array([1e-74, 1e75]) / math.sqrt(10)
    found = rounded_wedge.contact(P, 0.0, E_star=1.0, b=1e-90, phi=1.0)
    return bool(np.all(abs((found.a + found.c) / (2 * P) - 1) < 1e-12))


def contacts_carry_their_loads_or_are_nan() -> bool:
    """Just beyond a flat, the last digits of the edges change the load."""
    P = np.geomspace(1e-7, 1e-5, 25)
    found = flat_sloped.contact(P, 0.0, E_star=1.0, b=1.0, phi=1.0)
    off = abs(flat_sloped.load(found.a, found.c, E_star=1.0, b=1.0, phi=1.0) / P - 1)
    return bool(np.nanmax(off) < 3e-5 and np.all(np.isfinite(off[P > 3e-6])))


def a_load_that_no_contact_carries_has_none() -> bool:
    """That of a cylinder, P = pi h**2/16, jumps by 1e-8 at h = 2, past the one that is sought."""

    def state(a: float, c: float, own: Any) -> tuple[float, ...]:
        h = a + c
        load = math.pi * h**2 / 16 * (1 + 1e-8 * (h > 2))
        return load, load * (a - c) / 2, (a - c) / 2, math.sqrt(h) / 2, math.sqrt(h) / 2

    def slope(x: float, own: Any) -> tuple[float, float]:
        return x, 1.0

    none = np.zeros(0)
    sought = LOAD * (1 + 5e-9), 0.0, False
    a, c, _ = inverse.solve(state, slope, lambda own: none, none, *sought)
    return math.isnan(a) and math.isnan(c)


def a_tilt_that_hangs_on_its_own_rounding_has_no_contact() -> bool:
    """A flank of slope phi, within 2e-14 phi of lying level: rounding is 1.1 % of the gap."""
    tilt = 0.02 * (1 - 2e-14)
    return math.isnan(rounded_wedge.contact_at_tilt(1e-21, tilt, E_star=1.0, phi=0.02, b=1e-3).a)


def parts_keep_their_digits() -> bool:
    """The formula of end_pressure at 60 digits, for x outside of the part."""
    off = []
    for e in (1e-4, 0.01, 0.1, 0.3, 0.6, 0.9, 1.1, 1.4, 1.55):
        for y in (0.003, 0.02, 0.08, 0.3, 0.45, 0.6, 0.9):
            with mpmath.workdps(60):
                tangent = mpmath.tan(e)
                f = mpmath.atan(tangent / mpmath.mpf(y))
                sine, cosine = mpmath.sin(f), mpmath.cos(f)
                beyond = (mpmath.sin(e) ** 2 - sine**2) * mpmath.atanh(tangent / mpmath.tan(f))
                true = mpmath.mpf(e) * sine * cosine + beyond
                found = segments.end_pressure(2 * e, float(sine), float(cosine))
                off.append(float(abs(found / true - 1)))
    return max(off) < 4e-15


def integrals_agree_with_the_closed_form() -> bool:
    """The power 2 is the cylinder g = x**2/2."""
    a, c = 1.0, 0.7
    found = power.load(a, c, E_star=1.0, L=1.0, k=2.0)
    return bool(abs(found / hertz.load(a, c, **OWN) - 1) < 1e-13)


def edges_beside_the_apex_keep_their_digits() -> bool:
    """K_N = int g'' sqrt((c - s)/(a + s)) ds/(pi sqrt(h)) at 30 digits; a is 4e-9 of the width."""
    a, k = 2.0**-28, 2.2399
    with mpmath.workdps(30):
        h = 1 + mpmath.mpf(a)

        def integrand(s: Any) -> Any:
            return (k - 1) * abs(s) ** (mpmath.mpf(k) - 2) * mpmath.sqrt((1 - s) / (a + s))

        parts = (mpmath.quad(integrand, part, method="tanh-sinh") for part in ([-a, 0], [0, a, 1]))
        true = sum(parts) / (mpmath.pi * mpmath.sqrt(h))
        found = power.K_N(a, 1.0, E_star=1.0, L=1.0, k=k).left
        return bool(abs(found / true - 1) < 3e-14)


# ---------------------------------------------------------------- cycles


def _zone(contact: float, dQ: float, dsigma: float) -> Any:
    here = Contact(contact, contact, 0.0)
    return hertz.stick_zone(here, here, dQ, dsigma, **CYLINDER)


def large_zones_are_found() -> bool:
    """Tension alone: the zone of a cylinder is symmetric, and scales with the contact."""
    one, two = _zone(1.0, 0.0, 0.4), _zone(2.0, 0.0, 0.8)
    same = max(abs(one.m - one.n), abs(two.m - 2 * one.m), abs(two.n - 2 * one.n))
    return bool(one.regime == two.regime == Regime.LARGE and same < 1e-13)


def a_rule_takes_a_root_at_the_end() -> bool:
    """int dy/sqrt(y) over (0, 1) is 2."""
    quadrature = import_module("generated.runtime.slip.quadrature")
    y, weight = quadrature.double_exponential(0.075)
    return bool(abs(np.sum(weight / np.sqrt(y)) / 2 - 1) < 1e-14)


def _off_conditions(
    body: Any, own: Any, here: Contact, dQ: float, dsigma: float, there: Contact | None = None
) -> float:
    """How far a zone of large tension is from both of its conditions (bounded.py), relative to the
    friction; the slip zones are cut at the body's kinks, and take a rule of their own."""
    quadrature = import_module("generated.runtime.slip.quadrature")
    q, weight = quadrature.double_exponential(0.01)
    m, n, regime = body.stick_zone(here, there or here, dQ, dsigma, f=F, E_star=1.0, **own)
    stuck, sense, sums, b = m + n, np.sign(dsigma), np.zeros(2), own.get("b", 0.0)
    for contact in (here, there or here):
        for k, (side, start, end) in enumerate(((-1, m, contact.a), (1, n, contact.c))):
            kinks = [0.0, *sorted(y for y in (b - start, -b - start) if 0 < y < end - start)]
            for low, high in pairwise([*kinks, end - start]):
                y = low + (high - low) * q
                p = body.pressure(side * (start + y), *contact[:2], E_star=1.0, **own)
                force = -side * sense * F * p * weight * (high - low)
                sums[k] += np.sum(force * np.sqrt((stuck + y) / y))
                sums[1 - k] += np.sum(force * np.sqrt(y / (stuck + y)))
    by_tension = math.pi * stuck * dsigma / 8
    off = sums - [dQ + by_tension, dQ - by_tension]
    assert regime == Regime.LARGE
    return float(np.max(np.abs(off)) / (F * body.load(*here[:2], E_star=1.0, **own)))


def zones_of_a_cylinder_meet_their_conditions() -> bool:
    """R = 2, dQ = f P/2; tension is 2 and 3 times 8 dQ/(pi h)."""
    off = []
    for a, c, pull in ((1.5, 1.25, 2.0), (0.5, 2.0, -3.0)):
        dQ = F / 2 * float(hertz.load(a, c, E_star=1.0, R=2.0))
        dsigma = pull * 8 * dQ / (math.pi * (a + c))
        off.append(_off_conditions(hertz, {"R": 2.0}, Contact(a, c, 0.0), dQ, dsigma))
    return max(off) < 3e-15


def zones_with_a_kink_near_the_edge_meet_their_conditions() -> bool:
    """A punch with a flat [-1, 1]: the edge on the left is 1.6e-3 of the width from the kink."""
    here = Contact(1.004159798891837, 1.6519654071285617, 0.0)
    loads = 0.04000283951655925, 0.30121200179787033
    return _off_conditions(flat_rounded, {"R": 1.0, "b": 1.0}, here, *loads) < 1e-14


def zones_between_two_contacts_meet_their_conditions() -> bool:
    """The same punch, shorter, as the load moves; kinks and edges are far from each other."""
    ends = Contact(1.317, 0.884, 0.0), Contact(1.352, 0.868, 0.0)
    own = {"R": 1.0, "b": 0.5}
    return _off_conditions(flat_rounded, own, ends[0], 0.282, 0.656, ends[1]) < 1e-13


def zones_of_a_short_fillet_meet_their_conditions() -> bool:
    """The same punch: kink and edge are within 2 % of the slip zone on the left."""
    here = Contact(1.0127007211048615, 1.0690410952253155, 0.0)
    own = {"R": 1.0, "b": 1.0}
    return _off_conditions(flat_rounded, own, here, 0.0, 0.012435350026285619) < 1e-12


def slip_on_the_way_is_seen() -> bool:
    """The right edge passes the kink at 0.5.  Its advance dc allows K_T up to f K_N dc/2; K_T is
    below that at both ends of the way, and 1.5 % above it after 0.9 of it."""
    own, loads = {"E_star": 1.0, "R": 1.0, "b": 0.5}, (0.05, -0.02)
    ends = [Contact(1.38, 0.735, 0.0), Contact(0.986, 0.38, 0.0)]
    P, M = (
        [of(*end[:2], **own) for end in ends] for of in (flat_rounded.load, flat_rounded.moment)
    )

    def share(part: float) -> float:
        """K_T over its limit at a part of the way; the advance by differences."""
        way = [
            flat_rounded.contact(P[0] + k * (P[1] - P[0]), M[0] + k * (M[1] - M[0]), **own)
            for k in (part - 1e-6, part, part + 1e-6)
        ]
        a, c, _ = way[1]
        limit = F * flat_rounded.K_N(a, c, **own).right * abs(way[2].c - way[0].c) / 2e-6 / 2
        return float(abs(full_stick.K_T(a, c, *loads).right) / limit)

    assert share(0.01) < 1 and share(0.99) < 1 < share(0.9)
    found = flat_rounded.stick_zone(*ends, *loads, f=F, **own)
    return bool(found.regime == Regime.MIXED)


def shear_below_the_falling_friction_limit_is_refused() -> bool:
    """The load of a cylinder falls, and a stick zone [-m, m] is to narrow to [-0.2, 0.2].  From one
    m on the shear is below friction at an eighth of the way, to 3e-6 of it."""
    growth, bounded, cycles, quadrature = (
        import_module(f"generated.runtime.slip.{name}")
        for name in ("growth", "bounded", "cycles", "quadrature")
    )
    law, own, cycle = hertz._BODY.functions, np.ones(1), cycles.Cycle(1.2, 1.2, 1, 1, 0.1, 0, F)
    of, (low, high) = bounded.slipping(cycle, 1.0, -1.0), (0.7, 0.9)
    for _ in range(40):
        m = (low + high) / 2
        is_carried = growth._within_friction(law, own, of, m, m, (0.2, 0.2))
        low, high = (m, high) if is_carried else (low, m)
    x, zones = (
        -0.2 - (low - 0.2) / 8,
        bounded.both_zones((law, own, quadrature.ROUGH), of, 1 - low, 1 - low),
    )
    drop = F * (law.pressure(x, 1.2, 1.2, own) - law.pressure(x, 1.0, 1.0, own))
    return bool(abs(bounded.change_between(of, zones, low, low, x) / drop - 1) < 3e-6)


def edges_that_hang_on_rounding_of_the_tilt_are_refused() -> bool:
    """A wedge on one flank: P = E* phi sqrt(a c), and rounding of the tilt moves an edge by 7e-6 of
    the width, EPS phi h/P."""
    law, here = {"E_star": 1.0, "phi": 1.0}, Contact(1.0, 1e-21, 0.0)
    dQ = 0.1 * F * wedge.load(here.a, here.c, **law)
    return bool(wedge.stick_zone(here, here, dQ, 0.0, f=F, **law).regime == Regime.UNSOLVED)


def a_fall_that_slips_farther_is_not_known() -> bool:
    """Q to 0.36 f P and back, with a change in tension that moves the zone, [-0.8, 0.8], by 1e-9
    and by 8e-9: a rounding, and more than one."""
    here, Q = Contact(1.0, 1.0, 0.0), 0.36 * F * LOAD
    fall = 2 * Q * (1 - 1e-15), 4 * F * np.array([1e-9, 8e-9])
    found = hertz.shear(0.0, here, Q, 0.0, dQ=fall[0], dsigma=fall[1], **CYLINDER)
    return bool(np.isfinite(found[0]) and np.isnan(found[1]))


def series_are_solved() -> bool:
    found = hertz.slip_zones(1.0, 1.0, 0.3, 0.05, **CYLINDER, order=2)
    return bool(np.isfinite(found.left + found.right))


def shear_carries_the_change_in_load() -> bool:
    zone, here = _zone(1.0, 0.05, 0.5), Contact(1.0, 1.0, 0.0)
    angle, weight = np.polynomial.legendre.leggauss(24)
    total = 0.0
    for low, high in ((-1.0, -zone.m), (-zone.m, zone.n), (zone.n, 1.0)):
        half = (high - low) / 2
        x = (low + high) / 2 + half * np.sin(np.pi / 2 * angle)
        dq = hertz.shear_change(x, here, here, 0.05, 0.5, **CYLINDER)
        total += float(np.sum(weight * np.pi / 2 * np.cos(np.pi / 2 * angle) * half * dq))
    return abs(total - 0.05) < 1e-10


# ---------------------------------------------------------------- marches


def _march(Q: Any, sigma: Any = 0.0) -> list[str]:
    codes = hertz.march(LOAD, 0.0, Q, sigma, **CYLINDER).regime
    return sorted({Regime(int(code)).name for code in np.ravel(codes)})


def a_first_loading_is_not_closed() -> bool:
    return _march([0.0, 0.05, 0.1]) == ["NOT_CLOSED"]


def loads_out_of_proportion_are_refused() -> bool:
    way = np.sin(T)
    return _march(0.1 * way, 0.01 * way + 5e-8 * np.cos(T)) == ["OUT_OF_PHASE"]


def a_small_change_is_a_change() -> bool:
    return _march(0.1 + 1e-12 * np.sin(T)) == ["MODERATE"]


# ---------------------------------------------------------------- histories


def in_phase_is_exact_and_nearly_in_phase_is_not() -> bool:
    t = T[:8:2]
    Q = 0.1 * np.sin(t)
    return hertz.history(LOAD, 0.0, Q, 0.1 * Q + 5e-11 * np.cos(t), **CYLINDER).error[-1] > 0


def _first_loading(tol: float, share: float = 0.35) -> tuple[float, float]:
    """Error of n = sqrt(1 - Q/(f P)), and the error stated, on elements."""
    refine = import_module("generated.runtime.history.refine")
    loads = np.array([[LOAD], [0.0], [share * F * LOAD], [0.0]])
    told = refine.history(hertz._BODY, {"R": 1.0}, F, loads, np.zeros(0), tol)
    return abs(told.n[0] - math.sqrt(1 - share)) / 2, told.error[0]


def a_fine_mesh_is_accurate() -> bool:
    off, stated = _first_loading(1e-3)
    return bool(off < 1e-4 and stated < 1e-3)


def the_error_stated_is_not_far_too_large() -> bool:
    """At least the true one: test_history_solver.py, for many histories."""
    off, stated = _first_loading(1e-3, 0.9)
    return bool(off < stated < 5e-3)


def a_long_leg_takes_many_steps() -> bool:
    """Meshes of 1,024 elements and 64 to 1,024 steps a leg agree on n = 0.97343."""
    loads = LOAD, 0.0191884192, [-0.27608239], [-0.68441338]
    told = hertz.history(*loads, tol=1e-4, **CYLINDER)
    return bool(abs(told.n[0] - 0.97343) < 2e-4 * (told.a[0] + told.c[0]))


def a_large_tension_takes_many_steps() -> bool:
    told = hertz.history(LOAD, 0.0, [-0.3], [-5.0], **CYLINDER)
    return bool(told.error[-1] < 5e-3)


def just_below_sliding_is_exact() -> bool:
    told = hertz.history(LOAD, 0.0, [F * LOAD * (1 - 5e-11)], 0.0, **CYLINDER)
    return bool(told.error[0] == 0)


def _turned() -> Any:
    P, Q = LOAD * (1 + 0.2 * np.sin(T)), 0.3 * F * LOAD * np.cos(T)
    return hertz.steady_cycle(P, 0.0, Q, 0.05 * np.sin(T), **CYLINDER)


def cycles_settle() -> bool:
    found = _turned()
    return bool(found.drift <= 1e-6 and found.error < 0.05)


def the_work_of_a_turned_cycle_is_accurate() -> bool:
    """With tol=1e-5, meshes of 512 and 1,024 elements find 0.0021312."""
    return bool(abs(_turned().work / 0.0021312 - 1) < 2e-3)


def the_error_of_a_mixed_zone_is_stated() -> bool:
    Q, sigma = 0.1 * np.sin(T), 0.13 * np.sin(T)
    found = hertz.steady_cycle(LOAD, 0.0, Q, sigma, **CYLINDER)
    return bool(found.regime == Regime.MIXED and found.error <= 1e-7)


# ---------------------------------------------------------------- the table

TABLE: dict[str, tuple[Any, Callable[[], bool]]] = {
    "edge.fit.EDGE_SPREAD": ((0.035, 3.5), of_boundary_elements),
    "edge.fit.PRESSURE_MESH_ERROR": ((0.006, 0.6), of_boundary_elements),
    "edge.fit.SHEAR_MESH_ERROR": ((0.05, 5.0), of_boundary_elements),
    "edge.average.MIN_NODES": (2, few_nodes_give_a_warning),
    "edge.average.MAX_GAP": (35.0, missing_nodes_give_a_warning),
    "edge.average.MAX_ERROR": (0.75, a_large_error_gives_a_warning),
    "edge.rig.MAX_SLIP": (2.0, a_long_slip_zone_gives_a_warning),
    "edge.rig.MATCH_RTOL": (1e-7, what_is_missed_is_told),
    "inverse.MAX_STEPS": (10, far_contacts_are_found),
    "inverse.LONGEST_STEP": (0.4, light_contacts_are_found),
    "inverse.LEAST": (1e-74, small_and_large_contacts_are_found),
    "inverse.MOST": (1e74, small_and_large_contacts_are_found),
    "inverse.WORST_RTOL": (1e-8, a_load_that_no_contact_carries_has_none),
    "inverse.MAX_EDGE_ROUNDING": (0.1, a_tilt_that_hangs_on_its_own_rounding_has_no_contact),
    "inverse.MAX_LOAD_ROUNDING": ((1e-5, 1e-3), contacts_carry_their_loads_or_are_nan),
    "segments._NEAR": ((0.05, 5.0), parts_keep_their_digits),
    "segments._WIDE": ((0.1, 10.0), parts_keep_their_digits),
    "pieces.QUADRATURE_RTOL": (1e-11, edges_beside_the_apex_keep_their_digits),
    "slip.quadrature.REACH": (0.4, a_rule_takes_a_root_at_the_end),
    "slip.cycles.MAX_EDGE_ROUNDING": (1e-5, edges_that_hang_on_rounding_of_the_tilt_are_refused),
    "slip.shear.ZONE_RTOL": (1e-8, a_fall_that_slips_farther_is_not_known),
    "slip.bounded.NEWTON_RTOL": (1e-3, zones_of_a_cylinder_meet_their_conditions),
    "slip.bounded.NEAREST": (1e-8, zones_of_a_cylinder_meet_their_conditions),
    "slip.bounded.ROUGH_RTOL": (1e-6, zones_between_two_contacts_meet_their_conditions),
    "slip.zone.RULE_RTOL": (2e-9, zones_with_a_kink_near_the_edge_meet_their_conditions),
    "slip.bounded.MIN_GAP": (0.005, zones_of_a_short_fillet_meet_their_conditions),
    "slip.growth.PARTS": (1, slip_on_the_way_is_seen),
    "slip.growth.PLACES": (1, shear_below_the_falling_friction_limit_is_refused),
    "slip.growth.FRICTION_RTOL": (1e-5, shear_below_the_falling_friction_limit_is_refused),
    "slip.series.MAX_STEPS": (4, series_are_solved),
    "pieces.MAX_LEVEL": (0, integrals_agree_with_the_closed_form),
    "pieces.FARTHEST": (0, integrals_agree_with_the_closed_form),
    "slip.bounded.RULES": (1, large_zones_are_found),
    "slip.shear.FINEST": (0, shear_carries_the_change_in_load),
    "history.march.MAX_LAST_STEP": (9.9, a_first_loading_is_not_closed),
    "history.march.PHASE_RTOL": (1e-5, loads_out_of_proportion_are_refused),
    "history.march.LOAD_RTOL": (1e-11, a_small_change_is_a_change),
    "history.reversals.IN_PHASE": (1e-8, in_phase_is_exact_and_nearly_in_phase_is_not),
    "history.refine.FEWEST": (6, a_fine_mesh_is_accurate),
    "history.refine.MAX_ROUNDS": (1, cycles_settle),
    "history.refine.REPEATED": (1e-5, cycles_settle),
    "history.refine.REACH": (30.0, the_work_of_a_turned_cycle_is_accurate),
    "history.refine.SAFETY": (15.0, the_error_stated_is_not_far_too_large),
    "history.reversals.ROUNDING": (1e-10, just_below_sliding_is_exact),
    "history.path.MAX_SHEAR": (0.2, a_large_tension_takes_many_steps),
    "history.path.SHEAR_STEP": (40.0, a_long_leg_takes_many_steps),
    "history.elements.CLOSEST": (0.2, a_fine_mesh_is_accurate),
    "history.public.MIXED_ERROR": (1e-6, the_error_of_a_mixed_zone_is_stated),
}
"""A constant where its user reads it, a worse value, or one in each direction, and the law that
notices."""


def told() -> dict[str, tuple[bool, bool]]:
    """Whether the law of each row holds, and whether it holds with a worse value."""
    found = {}
    for name, (worse, law) in TABLE.items():
        place, constant = f"generated.runtime.{name}".rsplit(".", 1)
        module = import_module(place)
        value, holds, still = getattr(module, constant), bool(law()), False
        for other in worse if isinstance(worse, tuple) else (worse,):
            setattr(module, constant, other)
            with suppress(Exception):  # the worse value may fail in any way
                still |= bool(law())
        setattr(module, constant, value)
        found[name] = holds, still
    return found


@pytest.fixture(scope="module")
def answers() -> Any:
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    run = [sys.executable, "-W", "ignore", "-m", __name__]
    return json.loads(subprocess.run(run, env=environment, check=True, capture_output=True).stdout)


@pytest.mark.parametrize("name", TABLE)
def test_a_law_notices_a_worse_constant(name: str, answers: Any) -> None:
    assert answers[name] == [True, False]


if __name__ == "__main__":
    print(json.dumps(told()))
