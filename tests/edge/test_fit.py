"""Coefficients from nodal values: tables of the bodies' exact pressures with noise, and by hand."""

import importlib
import inspect
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import flat_rounded, full_stick, hertz
from generated.edge import K_N_from_loads, fit_pressure, fit_stuck_shear

NOISE = 0.01
BODIES = {
    "hertz": ({"E_star": 1.0, "R": 1.0}, 1.3, 0.7),
    "wedge": ({"E_star": 1.0, "phi": 1.0}, 0.75, 1.25),
    "flat_rounded": ({"E_star": 1.0, "R": 1.0, "b": 0.6}, 1.0, 0.9),
    "two_radii": ({"E_star": 1.0, "R_1": 1.0, "R_2": 2.0}, 1.0, 1.0),
    "quartic": ({"E_star": 1.0, "D": 1.0}, 1.0, 1.0),
}
"""Kinks far and near, tilted ones; the constants that a body does not have are left out."""


JUDGES = {
    "hyperbola": ({"E_star": 1.0, "R": 1.0, "phi": 0.5}, 1.3, 0.8),
    "parabola_quartic": ({"E_star": 1.0}, 0.9, 1.2),
    "wedge_parabola": ({"E_star": 1.0, "phi": 0.5, "R": 1.0}, 0.8, 1.1),
    "circular_arc": ({"E_star": 1.0, "R": 3.0}, 1.2, 0.9),
}
"""Bodies on which nothing of the fit was chosen."""


class Draws(NamedTuple):
    """Off: of the edge over an element, of K_N in parts; covered: by two standard deviations."""

    edge: Any
    K_N: Any
    covered: Any
    warned: Any
    found: Any


def draws(name: str, elements: int, count: int, seed: int = 0) -> Draws:
    """Tables of one body with 1 % noise, the mesh anywhere."""
    body = importlib.import_module(f"generated.{name}")
    law, a, c = (BODIES | JUDGES)[name]
    names = inspect.signature(body.load).parameters.keys() - {"a", "c", "E_star"}
    law = {k: v for k, v in law.items() if k == "E_star" or k in names}
    if missing := names - law.keys():
        law |= dict.fromkeys(missing, 1.0)
    size, rng = (a + c) / elements, np.random.default_rng(seed)
    true = body.K_N(a, c, **law).left
    rows = []
    for _ in range(count):
        x = -a + size * (np.arange(-2, elements + 3) + rng.random())
        p = body.pressure(x, a, c, **law)
        found = fit_pressure(x, p * (1 + NOISE * rng.standard_normal(len(x))))
        off = found.edge + a, found.K_N - true
        covered = [abs(off[0]) <= 2 * found.edge_error, abs(off[1]) <= 2 * found.K_N_error]
        known = np.isfinite(found.K_N)
        rows.append((abs(off[0]) / size, abs(off[1]) / true, *covered, bool(found.warning), known))
    edge, K_N, edge_covered, K_covered, warned, known = np.array(rows).T
    return Draws(edge, K_N, (edge_covered, K_covered), warned, known)


@pytest.mark.enough(
    "hertz-20-0", "wedge-40-0", "flat_rounded-20-0", "hyperbola-*", "circular_arc-*"
)
@pytest.mark.parametrize(
    ("name", "elements", "seed"),
    [*((name, n, 0) for name in BODIES for n in (20, 40)), *((name, 40, 4242) for name in JUDGES)],
)
def test_the_error_stated_covers_the_truth(name: str, elements: int, seed: int) -> None:
    """In 95 of 100 draws; 60 draws: two of them more may miss."""
    of = draws(name, elements, 60, seed)
    assert np.all(of.found)
    for covered in of.covered:
        assert np.sum(covered) >= 55


@pytest.mark.enough("40-*")
@pytest.mark.parametrize(
    ("elements", "limit", "wedge"), [(20, 0.12, 0.25), (40, 0.08, 0.18), (80, 0.05, 0.1)]
)
def test_the_median_comes_close(elements: int, limit: float, wedge: float) -> None:
    """Of each body; a wedge, infinite at its kink, is the hardest, and warned of at 20 elements."""
    for name in BODIES:
        of = draws(name, elements, 1200 // elements, seed=1)
        assert np.median(of.edge) < 0.3
        assert np.median(of.K_N) < (wedge if name == "wedge" else limit)


@pytest.mark.parametrize("name", BODIES)
def test_a_coarse_mesh_is_warned_of(name: str) -> None:
    """Where K_N is not known to 5 %, as with 20 elements."""
    for elements in (10, 20):
        assert np.all(draws(name, elements, 12).warned)


def test_a_kink_next_to_the_edge_and_a_complete_contact_are_warned_of() -> None:
    """A flat with edges that are rounded over two of twenty elements, and one with sharp edges."""
    x = np.arange(-11, 12) * 0.1 + 0.03
    found = fit_pressure(x, flat_rounded.pressure(x, 1.0, 1.0, E_star=1.0, R=1.0, b=0.8))
    assert "no range of nodes" in found.warning or "known only to" in found.warning
    x = np.linspace(-1.2, 1.2, 49)
    p = np.where(np.abs(x) < 1, 1 / np.sqrt(np.maximum(1 - x**2, 1e-9)), 0.0)
    assert fit_pressure(x, p).warning


def test_exact_nodes_give_the_coefficients() -> None:
    """p = sqrt(s (2 - s)): K_N = sqrt(2), L_N = -K_N/4; the right edge by the other way."""
    x = np.linspace(-1.03, 1.07, 64)
    p = np.sqrt(np.maximum(1 - x**2, 0.0))
    for way, place in ((1, -1.0), (-1, 1.0)):
        found = fit_pressure(x[::way], p[::way])
        # that the edge lies in the element is a datum, too, and pulls a little
        assert_allclose(found.edge, place, atol=1e-4)
        assert_allclose((found.K_N, found.L_N), (np.sqrt(2), -np.sqrt(2) / 4), rtol=2e-3)
        assert found.warning == "" and "polynomial of degree" in found.why


def test_stuck_shear_of_a_known_contact() -> None:
    """Noise of 1 %: within two standard deviations in 95 of 100; the edge's error comes to it."""
    rng, a, c = np.random.default_rng(2), 1.3, 0.7
    true = full_stick.K_T(a, c, 1.0, 0.3).left, full_stick.L_T(a, c, 1.0, 0.3).left
    x = -a + 0.05 * (np.arange(39) + 0.4)
    exact = (1.0 / np.pi - 0.075 * (x - (c - a) / 2)) / np.sqrt((a + x) * (c - x))
    hits = []
    for _ in range(60):
        dq = exact * (1 + NOISE * rng.standard_normal(len(x)))
        found = fit_stuck_shear(x, dq, -a)
        hits.append(abs(found.K_T - true[0]) <= 2 * found.K_T_error)
    assert sum(hits) >= 55
    wide = fit_stuck_shear(x, dq, -a, 0.01)
    assert wide.K_T_error > found.K_T_error
    back = fit_stuck_shear(-x, dq, a)
    assert_allclose(back.K_T, found.K_T, rtol=1e-9)


def test_reaction_forces_give_K_N() -> None:
    """A tilted cylinder at two neighbouring loads, by its contact law."""
    law = {"E_star": 1.25, "R": 4.0}
    a, c = np.array([1.4999, 1.5001]), np.array([0.9998, 1.0002])
    found = K_N_from_loads(hertz.load(a, c, **law), hertz.moment(a, c, **law), a, c)
    assert_allclose(found, hertz.K_N(1.5, 1.0, **law), rtol=1e-7)
    still = K_N_from_loads(hertz.load(a, c, **law), hertz.moment(a, c, **law), [1.5, 1.5], c)
    assert np.isnan(still.left)
    with pytest.raises(ValueError, match="two values"):
        K_N_from_loads(1.0, 1.0, 1.0, 1.0)


@pytest.mark.parametrize(
    ("x", "p", "words"),
    [
        ([0.0, 1.0], [1.0], "rows of equal length"),
        ([0.0, np.nan, 2.0], [0.0, 1.0, 0.0], "x is nan at node 2"),
        ([0.0, 1.0, 1.0], [0.0, 1.0, 2.0], "two nodes lie at"),
        ([0.0, 2.0, 1.0], [0.0, 1.0, 2.0], "sort the nodes"),
        ([0.0, 1.0, 2.0], [0.0, -1.0, 0.0], "must not be negative"),
        ([0.0, 1.0, 2.0], [0.0, 0.0, 0.0], "there is no contact"),
        ([0.0, 1.0, 2.0], [1.0, 0.0, 2.0], "one contact at a time"),
    ],
)
def test_what_is_no_table(x: Any, p: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        fit_pressure(x, p)


@pytest.mark.parametrize("loaded", [0, 5])
def test_no_change_in_shear_is_said(loaded: int) -> None:
    """At no node, or only at a few of them."""
    x = np.linspace(0, 1, 40)
    found = fit_stuck_shear(x, np.where(np.arange(40) < loaded, 1.0, 0.0), 0.0)
    assert np.isnan(found.K_T)
    assert found.warning == "the change in the shear traction is zero at most nodes"


def test_an_edge_elsewhere_is_refused() -> None:
    x = np.linspace(0, 1, 40)
    with pytest.raises(ValueError, match="does not lie next to"):
        fit_stuck_shear(x, np.ones(40), -0.5)
    with pytest.raises(ValueError, match="numbers in metres"):
        fit_stuck_shear(x, np.ones(40), np.nan)
