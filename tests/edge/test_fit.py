"""Coefficients from nodal values: tables of known contacts with noise, and by hand."""

import importlib
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import flat_rounded, full_stick, hertz
from generated.edge import K_N_from_loads, PressureFit, fit_pressure, fit_stuck_shear

# own constants, a, c; kinks far and near, tilted contacts, no kink
BODIES = {
    "hertz": ({"R": 1.0}, 1.3, 0.7),
    "wedge": ({"phi": 1.0}, 0.75, 1.25),
    "flat_rounded": ({"R": 1.0, "b": 0.6}, 1.0, 0.9),
    "circular_arc": ({"R": 3.0}, 1.2, 0.9),
    "hyperbola": ({"b": 1.0, "phi": 0.5}, 1.3, 0.8),
}


def cosh_with_a_kink(x: Any, phi: float, at: float) -> tuple[Any, float]:
    """The pressure of g = cosh x + phi |x - at| pressed to [-1, 1], E* = 1, and K_N at the left.

    With x = cos t and g' = sum b_n cos(n t), p = sum b_n sin(n t)/2.
    """
    t, rule = np.arccos(np.clip(x, -1.0, 1.0)), (np.arange(40) + 0.5) * np.pi / 40
    kink, n = np.arccos(at), np.arange(1, 40)
    b = np.array([np.mean(2 * np.sinh(np.cos(rule)) * np.cos(k * rule)) for k in n])
    with np.errstate(divide="ignore"):
        jump = np.log(np.abs(np.sin((t + kink) / 2) / np.sin((t - kink) / 2)))
    p = np.sin(np.multiply.outer(t, n)) @ b / 2 + phi / np.pi * jump
    slope = np.sum(n * b * (-1.0) ** (n + 1)) / 2 + phi / np.pi * np.tan(kink / 2)
    return np.where(np.abs(x) < 1, p, 0.0), float(slope * np.sqrt(2))


def draws(name: str, elements: int, count: int) -> tuple[list[PressureFit], float, float]:
    """Fits to tables with 1 % noise and the mesh anywhere, the edge, and K_N there."""
    rng, fits = np.random.default_rng(1), []
    own, a, c = BODIES.get(name, ({}, 1.0, 1.0))
    phi, at = {"kink": (0.5, 0.3), "far kink": (0.5, 0.7)}.get(name, (0.0, 0.0))
    for _ in range(count):
        x = -a + (a + c) / elements * (np.arange(-2, elements + 3) + rng.random())
        if own:
            body = importlib.import_module(f"generated.{name}")
            p, K_N = body.pressure(x, a, c, E_star=1.0, **own), body.K_N(a, c, E_star=1.0, **own)[0]
        else:
            p, K_N = cosh_with_a_kink(x, phi, at)
        fits.append(fit_pressure(x, p * (1 + 0.01 * rng.standard_normal(len(x)))))
    return fits, -a, float(K_N)


# the largest median of |K_N - exact| in percent; a wedge is the hardest
CASES = [(n, 40, 6.0) for n in BODIES if n != "wedge"] + [
    *(("wedge", 40, 14.0), ("hertz", 20, 8.0), ("hertz", 200, 1.5)),
    *(("kink", 40, 8.0), ("kink", 200, 3.0), ("far kink", 40, 8.0), ("far kink", 200, 2.5)),
]


@pytest.mark.enough("hertz-20-*", "wedge-*", "kink-40-*", "far kink-200-*")
@pytest.mark.parametrize(("name", "elements", "limit"), CASES)
def test_the_error_stated_covers_the_truth(name: str, elements: int, limit: float) -> None:
    """At least 90 of 100 lie within two standard deviations, which are not far too large."""
    fits, edge, K_N = draws(name, elements, 40)
    found = np.array([(f.edge - edge, f.K_N - K_N) for f in fits])
    stated = np.array([(f.edge_error, f.K_N_error) for f in fits])
    assert np.all(np.mean(np.abs(found) <= 2 * stated, axis=0) >= 0.9)
    median = np.median(np.abs(found), axis=0)
    assert median[0] < 0.3 * 2 / elements and median[1] < limit / 100 * K_N
    assert np.median(stated[:, 1]) < 3.5 * limit / 100 * K_N


X = np.linspace(-1.03, 1.07, 64)
P = np.sqrt(np.maximum(1 - X**2, 0.0))


COARSE = np.arange(-11, 12) * 0.1 + 0.03
NOISE = 1 + 0.05 * np.random.default_rng(0).standard_normal(len(X))
FINE = np.linspace(-1.2, 1.2, 49)
WIDE = np.linspace(-3, 3, 25)  # seven nodes from -0.75 to 0.75 are in contact
WITHOUT = np.delete(np.arange(len(X)), np.arange(27, 38))  # eleven nodes in the middle


@pytest.mark.parametrize(
    ("x", "p", "words"),
    [
        (COARSE, np.sqrt(np.maximum(1 - COARSE**2, 0.0)), "there are only 20 nodes"),
        (COARSE[::2], np.sqrt(np.maximum(1 - COARSE[::2] ** 2, 0.0)), "there are only 10 nodes"),
        (COARSE[::4], np.sqrt(np.maximum(1 - COARSE[::4] ** 2, 0.0)), "are too few"),
        (WIDE, np.sqrt(np.maximum(1 - WIDE**2, 0.0)), "7 nodes in contact are too few"),
        (COARSE, cosh_with_a_kink(COARSE, 0.5, 0.3)[0], "there are only 20 nodes"),
        (X, P * NOISE, "K_N is known only to within"),
        (X[WITHOUT], P[WITHOUT], "nodes are missing between x = -0.163333 and 0.236667"),
        (
            COARSE,
            flat_rounded.pressure(COARSE, 1.0, 1.0, E_star=1.0, R=1.0, b=0.9),
            "no range of nodes follows the square-root law",
        ),
        (
            FINE,
            np.where(np.abs(FINE) < 1, 1 / np.sqrt(np.maximum(1 - FINE**2, 1e-9)), 0.0),
            "or the contact is complete",
        ),
    ],
)
def test_what_is_warned_of(x: Any, p: Any, words: str) -> None:
    assert words in fit_pressure(x, p).warning


@pytest.mark.parametrize("loaded", [0, 5])
def test_no_change_in_shear_is_said(loaded: int) -> None:
    """At no node, or only at a few of them."""
    x = np.linspace(0.02, 1, 40)
    found = fit_stuck_shear(x, np.where(np.arange(40) < loaded, 1.0, 0.0), 0.0)
    assert np.isnan(found.K_T)
    assert found.warning == f"{loaded} nodes with a shear traction are too few: use a finer mesh"


def test_reaction_forces_give_K_N() -> None:
    """A tilted cylinder at two neighbouring loads, by its contact law."""
    law = {"E_star": 1.25, "R": 4.0}
    a, c = np.array([1.4999, 1.5001]), np.array([0.9998, 1.0002])
    loads = hertz.load(a, c, **law), hertz.moment(a, c, **law)
    assert_allclose(K_N_from_loads(*loads, a, c), hertz.K_N(1.5, 1.0, **law), rtol=1e-7)
    assert np.isnan(K_N_from_loads(*loads, [1.5, 1.5], c).left)
    with pytest.raises(ValueError, match="two values"):
        K_N_from_loads(1.0, 1.0, 1.0, 1.0)


@pytest.mark.parametrize(
    ("x", "p", "words"),
    [
        ([0.0, 1.0], [1.0], "rows of equal length"),
        ([0.0, np.nan, 2.0], [0.0, 1.0, 0.0], "x is nan at node 2"),
        ([0.0, 1.0, 1.0], [0.0, 1.0, 2.0], "give each node once"),
        ([0.0, 2.0, 1.0], [0.0, 1.0, 2.0], "is 2 at node 2 and 1 at the next: sort the nodes"),
        ([0.0, 1.0, 2.0], [0.0, -1.0, 0.0], "it is -1 at x = 1: give compression"),
        ([0.0, 1.0, 2.0], [0.0, 0.0, 0.0], "p must be positive at the nodes of one contact"),
        ([0.0, 1.0, 2.0], [1.0, 0.0, 2.0], "it is 0 at x = 1: .* one contact at a time"),
    ],
)
def test_what_is_no_table(x: Any, p: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        fit_pressure(x, p)


@pytest.mark.parametrize(
    ("edge", "words"), [(-0.5, "lie next to"), (np.nan, "edge must be one finite")]
)
def test_an_edge_elsewhere_is_refused(edge: float, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        fit_stuck_shear(np.linspace(0, 1, 40), np.ones(40), edge)


def test_stuck_shear_of_a_known_contact() -> None:
    """Noise of 1 %, and the error of the edge, which adds to that of K_T."""
    rng, a, c = np.random.default_rng(2), 1.3, 0.7
    true = [of(a, c, 1.0, 0.3).left for of in (full_stick.K_T, full_stick.L_T)]
    x = -a + 0.05 * (np.arange(39) + 0.4)
    exact = (1.0 / np.pi - 0.075 * (x - (c - a) / 2)) / np.sqrt((a + x) * (c - x))
    tables = [exact * (1 + 0.01 * rng.standard_normal(len(x))) for _ in range(40)]
    fits = [fit_stuck_shear(x, dq, -a) for dq in tables]
    off = np.array([(f.K_T, f.L_T) for f in fits]) - true
    stated = np.array([(f.K_T_error, f.L_T_error) for f in fits])
    assert np.all(np.mean(np.abs(off) <= 2 * stated, axis=0) >= 0.9)
    assert np.all(np.median(stated, axis=0) < (0.1 * true[0], 0.5))
    assert fit_stuck_shear(x, tables[0], -a, 0.1).K_T_error > 2 * fits[0].K_T_error
    assert_allclose(fit_stuck_shear(-x, tables[0], a).K_T, fits[0].K_T, rtol=1e-9)
