"""Each constant bounds something: a law that holds no longer holds if it is ten times worse.

The kernels run as plain Python in a process of their own, where a constant can be replaced.
"""

import json
import math
import os
import subprocess
import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np
import pytest

from generated import edge, hertz, power, quartic, rounded_wedge
from generated.runtime.types import Contact, Regime

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


def a_long_slip_zone_gives_a_warning() -> bool:
    one = edge.Edge(K_N=float(hertz.K_N(1.0, 1.0, **OWN).left), K_T=0.12)
    return "large part" in edge.match(one, hertz, **CYLINDER).warning


def what_is_missed_is_told() -> bool:
    rig = import_module("generated.runtime.edge.rig")
    one = edge.Edge(1.0, 1.0)
    other = one._replace(K_N=1 + 5e-8)
    _, missed = rig._compared({"left": one}, hertz.Edges(other, other), 1.0)
    return len(missed) == 1


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


def integrals_agree_with_the_closed_form() -> bool:
    """The power 2 is the cylinder g = x**2/2."""
    a, c = 1.0, 0.7
    found = power.load(a, c, E_star=1.0, L=1.0, k=2.0)
    return bool(abs(found / hertz.load(a, c, **OWN) - 1) < 1e-13)


# ---------------------------------------------------------------- cycles


def _zone(contact: float, dQ: float, dsigma: float) -> Any:
    here = Contact(contact, contact, 0.0)
    return hertz.stick_zone(here, here, dQ, dsigma, **CYLINDER)


def large_zones_are_found() -> bool:
    """Tension alone: the zone of a cylinder is symmetric, and scales with the contact."""
    one, two = _zone(1.0, 0.0, 0.4), _zone(2.0, 0.0, 0.8)
    same = max(abs(one.m - one.n), abs(two.m - 2 * one.m), abs(two.n - 2 * one.n))
    return bool(one.regime == two.regime == Regime.LARGE and same < 1e-13)


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
    Q = 0.1 * np.sin(T)
    return hertz.history(LOAD, 0.0, Q, 0.1 * Q + 5e-11 * np.cos(T), **CYLINDER).error[-1] > 0


def _first_loading(tol: float, share: float = 0.35) -> tuple[float, float]:
    """Error of n = sqrt(1 - Q/(f P)), and the error stated, on elements."""
    refine = import_module("generated.runtime.history.refine")
    loads = np.array([[LOAD], [0.0], [share * F * LOAD], [0.0]])
    told = refine.history(hertz._BODY, {"R": 1.0}, F, loads, np.zeros(0), tol)
    return abs(told.n[0] - math.sqrt(1 - share)) / 2, told.error[0]


def a_fine_mesh_is_accurate() -> bool:
    off, stated = _first_loading(1e-3)
    return bool(off < 1e-4 and stated < 1e-3)


def a_long_leg_takes_many_steps() -> bool:
    """Meshes of 1,024 elements and 64 to 1,024 steps a leg agree on n = 0.97343."""
    loads = LOAD, 0.0191884192, [-0.27608239], [-0.68441338]
    told = hertz.history(*loads, tol=1e-4, **CYLINDER)
    return bool(abs(told.n[0] - 0.97343) < 2e-4 * (told.a[0] + told.c[0]))


def _turned() -> Any:
    P, Q = LOAD * (1 + 0.2 * np.sin(T)), 0.3 * F * LOAD * np.cos(T)
    return hertz.steady_cycle(P, 0.0, Q, 0.05 * np.sin(T), **CYLINDER)


def cycles_settle() -> bool:
    found = _turned()
    return bool(found.drift <= 1e-6 and found.error < 0.05)


def the_error_of_a_mixed_zone_is_stated() -> bool:
    Q, sigma = 0.1 * np.sin(T), 0.13 * np.sin(T)
    found = hertz.steady_cycle(LOAD, 0.0, Q, sigma, **CYLINDER)
    return bool(found.regime == Regime.MIXED and found.error <= 1e-7)


# ---------------------------------------------------------------- the table

TABLE: dict[str, tuple[Any, Callable[[], bool]]] = {
    "edge.average.MIN_NODES": (2, few_nodes_give_a_warning),
    "edge.average.MAX_GAP": (35.0, missing_nodes_give_a_warning),
    "edge.average.MAX_ERROR": (0.75, a_large_error_gives_a_warning),
    "edge.rig.MAX_SLIP": (2.0, a_long_slip_zone_gives_a_warning),
    "edge.rig.MATCH_RTOL": (1e-7, what_is_missed_is_told),
    "inverse.MAX_STEPS": (10, far_contacts_are_found),
    "inverse.LONGEST_STEP": (0.4, light_contacts_are_found),
    "slip.series.MAX_STEPS": (4, series_are_solved),
    "pieces.MAX_LEVEL": (0, integrals_agree_with_the_closed_form),
    "slip.bounded.RULES": (1, large_zones_are_found),
    "slip.shear.FINEST": (0, shear_carries_the_change_in_load),
    "history.march.MAX_LAST_STEP": (9.9, a_first_loading_is_not_closed),
    "history.march.PHASE_RTOL": (1e-5, loads_out_of_proportion_are_refused),
    "history.march.LOAD_RTOL": (1e-11, a_small_change_is_a_change),
    "history.reversals.IN_PHASE": (1e-8, in_phase_is_exact_and_nearly_in_phase_is_not),
    "history.refine.FEWEST": (6, a_fine_mesh_is_accurate),
    "history.refine.MAX_ROUNDS": (1, cycles_settle),
    "history.refine.REPEATED": (1e-5, cycles_settle),
    "history.path.SHEAR": (40.0, a_long_leg_takes_many_steps),
    "history.elements.CLOSEST": (0.2, a_fine_mesh_is_accurate),
    "history.public.MIXED_ERROR": (1e-6, the_error_of_a_mixed_zone_is_stated),
}
"""A constant where its user reads it, a worse value, and the law that notices."""


def told() -> dict[str, tuple[bool, bool]]:
    """Whether the law of each row holds, and whether it holds with the worse value."""
    found = {}
    for name, (worse, law) in TABLE.items():
        place, constant = f"generated.runtime.{name}".rsplit(".", 1)
        module = import_module(place)
        value, holds = getattr(module, constant), bool(law())
        setattr(module, constant, worse)
        try:
            found[name] = holds, bool(law())
        except Exception:  # the worse value may fail in any way
            found[name] = holds, False
        finally:
            setattr(module, constant, value)
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
