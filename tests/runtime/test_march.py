"""A cycle instant by instant: against closed forms at all instants, and what is refused."""

import math

import numpy as np
import pytest

import generated.hertz
import generated.wedge
from generated.runtime.types import Contact, Regime

F = 0.5
T = np.arange(16) * np.pi / 8
"""Sixteen instants; what follows sin(t) turns at the 4th and the 12th."""
UP, DOWN = np.arange(-3, 5), np.arange(5, 13)
hertz = generated.hertz, {"E_star": 1.0, "R": 1.0}
wedge = generated.wedge, {"E_star": 1.0, "phi": 1.0}
EACH = pytest.mark.parametrize("case", [hertz, wedge], ids=["hertz", "wedge"])


def march(case, P, M, Q, sigma):
    """a, c, m, n, left, right, regime, a column an instant."""
    module, law = case
    loads = np.broadcast_arrays(*np.atleast_1d(P, M, Q, sigma))
    return np.array(module.march(*loads, f=F, **law))


def loads(case, shear=0.15, tension=0.0, normal=0.0, way=None):
    """Loads in proportion about those of [-1.5, 1]; tension over 8 dQ/(pi h)."""
    way = np.sin(T) if way is None else way
    P, M = (of(1.5, 1.0, **case[1]) for of in (case[0].load, case[0].moment))
    Q = shear * F * P * way
    return P * (1 + normal * way), M * (1 + normal / 2 * way), Q, tension * 8 * Q / (np.pi * 2.5)


def refused(found, regime):
    """All of a cycle is NaN but for its contacts, and told by one code."""
    return (
        np.all(found[6] == regime)
        and np.all(np.isnan(found[2:4]))
        and not np.any(found[4:6])
        and np.all(np.isfinite(found[:2]))
    )


# ---------------------------------------------------------------- what is known


@EACH
@pytest.mark.parametrize("tension", [0.0, 0.5, -0.5])
@pytest.mark.parametrize("normal", [0.0, 0.01])
def test_moderate_tension_in_closed_form(case, tension, normal):
    """Since the loads turned: the contact at the mean load less dQ/(2 f), at the mean tilt less
    dsigma/(4 f); forward slip on the way up, and back on the way down."""
    given = loads(case, tension=tension, normal=normal)
    found = march(case, *given)
    assert np.all(found[6] == Regime.MODERATE)
    _, _, Q, sigma = given
    module, law = case
    own = {name: value for name, value in law.items() if name != "E_star"}
    assert found[:2] == pytest.approx(np.array(module.contact(*given[:2], **law))[:2], rel=1e-12)
    tilt = module.tilt(*found[:2], **own)
    for way, start, sense in ((UP, 12, 1), (DOWN, 4, -1)):
        load = (given[0][way] + given[0][start]) / 2 - abs(Q[way] - Q[start]) / (2 * F)
        lean = (tilt[way] + tilt[start]) / 2 - sense * (sigma[way] - sigma[start]) / (4 * F)
        patch = module.contact_at_tilt(load, lean, **law)
        assert found[2:4, way] == pytest.approx(np.array(patch)[:2], rel=1e-11)
        assert np.all(found[4:6, way] == sense)


@EACH
@pytest.mark.parametrize("tension", [3.0, -3.0])
@pytest.mark.parametrize("normal", [0.0, 0.01])
def test_large_tension_slips_apart(case, tension, normal):
    given, sense = loads(case, tension=tension, normal=normal), np.sign(tension)
    found = march(case, *given)
    assert np.all(found[6] == Regime.LARGE)
    assert np.all(found[4, UP] == sense) and np.all(found[4, DOWN] == -sense)
    assert np.all(found[5] == -found[4])
    first, second = found[:2, 12], found[:2, 4]
    dQ, dsigma = (v[4] - v[12] for v in given[2:])
    ends = (Contact(*edges, 0.0) for edges in (first, second))
    m, n, regime = case[0].stick_zone(*ends, dQ, dsigma, f=F, **case[1])
    assert regime == Regime.LARGE
    assert found[2, [4, 12]] == pytest.approx([m, m], rel=1e-11)
    assert found[3, [4, 12]] == pytest.approx([n, n], rel=1e-11)
    assert np.all(np.diff(found[2, UP]) < 0) and np.all(np.diff(found[3, DOWN]) < 0)


def test_no_change_is_full_stick():
    found = march(wedge, 1.0, 0.1, 0.1, np.zeros(4))
    assert np.all(found[6] == Regime.FULL_STICK)
    assert np.array_equal(found[2:4], found[:2]) and not np.any(found[4:6])


@pytest.mark.parametrize("shift", range(0, 16, 5))
def test_where_the_array_starts_does_not_matter(shift):
    """Loads that rest at both turns, too; and two cycles in one array."""
    P = np.array(1.2)
    for way in (np.sin(T), np.clip(1.5 * np.sin(T), -1, 1)):
        whole = march(wedge, P, 0.0, 0.1 * way, 0.0)
        rolled = march(wedge, P, 0.0, np.roll(0.1 * way, shift), 0.0)
        assert np.array_equal(np.roll(rolled, -shift, axis=1), whole)
        twice = march(wedge, P, 0.0, np.tile(0.1 * way, 2), 0.0)
        assert np.array_equal(twice, np.tile(whole, 2))
    assert np.ptp(whole[2, 3:6]) == 0 and whole[2, 3] == np.min(whole[2])


@pytest.mark.parametrize("tension", [1.0021, 1.02, 1.08])
def test_nothing_is_told_of_a_cycle_in_which_slip_turns_round(tension):
    """Wedge, dQ = 0.3 f P: at the start of a half-cycle the right edge is not at friction.  The
    zone at its end is known where forward slip overtakes it."""
    way = -np.cos(np.linspace(0, 2 * np.pi, 41)) / 2
    Q, sigma = 0.15 * way, tension * 8 * 0.15 / (2 * np.pi) * way
    found = march(wedge, 1.0, 0.0, Q, sigma)
    between = np.abs(way) < 0.5
    assert np.all(found[6, between] == Regime.MIXED)
    assert np.all(np.isnan(found[2, between])) and not np.any(found[4:6, between])
    assert np.isfinite(found[2, [0, 20]]).all() == (tension < 1.01)
    assert np.all(found[6] == Regime.MIXED)


# ---------------------------------------------------------------- what is refused


def test_loads_out_of_phase():
    """Normal load, and bulk tension, a quarter and an eighth of a turn ahead of the shear load."""
    P = 0.3
    turned = march(hertz, P * (1 + 0.2 * np.sin(T)), 0.0, 0.3 * F * P * np.cos(T), 0.0)
    assert refused(turned, Regime.OUT_OF_PHASE)
    ahead = march(hertz, P, 0.0, 0.3 * F * P * np.cos(T), 1e-3 * np.cos(T - np.pi / 4))
    assert refused(ahead, Regime.OUT_OF_PHASE)
    P, M, Q, sigma = loads(wedge)
    Q[[1, 2]] = Q[[2, 1]]  # they turn inside a half-cycle
    assert refused(march(wedge, P, M, Q, sigma), Regime.OUT_OF_PHASE)


@pytest.mark.parametrize("which", range(4))
def test_one_instant_out_of_proportion_takes_the_whole_cycle(which):
    given = [v.copy() for v in loads(wedge, tension=0.5, normal=0.01)]
    change = np.ptp(given[which])
    given[which][6] += 1e-8 * change
    assert np.all(march(wedge, *given)[6] == Regime.MODERATE)
    given[which][6] += 1e-4 * change
    assert refused(march(wedge, *given), Regime.OUT_OF_PHASE)


def test_shear_at_friction_slides():
    """f P0 (.9, 1, 1.1, ...), though dQ < 2 f P0; and one instant at the limit."""
    part = np.array([0.9, 1, 1.1, 1.2, 1.3, 1.2, 1.1, 1])
    assert refused(march(hertz, 0.3, 0.0, F * 0.3 * part, 0.0), Regime.SLIDING)
    slides = march(hertz, 0.3, 0.0, -F * 0.3 * np.sin(T), 0.0)
    assert refused(slides, Regime.SLIDING)


@pytest.mark.parametrize("rests", [0, 2])
def test_a_first_loading_is_no_cycle(rests):
    Q = np.append(np.linspace(0, 0.1, 9), np.full(rests, 0.1))
    overshoots = 0.1 * np.array([0, 0.2, 0.4, 0.8, 1, 0.995])
    for way in (Q, -Q, Q[::-1], overshoots):
        assert refused(march(wedge, 1.2, 0.0, way, 0.0), Regime.NOT_CLOSED)
    P, sigma = np.linspace(1, 1.1, 9), np.linspace(0, 0.1, 9)
    assert refused(march(wedge, P, 0.0, 0.0, 0.0), Regime.NOT_CLOSED)
    assert refused(march(wedge, P, 0.0, 0.0, sigma), Regime.NOT_CLOSED)


def test_a_cycle_may_close_by_itself_or_lead_back_to_its_start():
    Q = np.linspace(0, 0.1, 5)
    there_and_back = np.concatenate([Q, Q[-2::-1]])
    closed, open_ = (march(wedge, 1.2, 0.0, v, 0.0) for v in (there_and_back, there_and_back[:-1]))
    assert np.all(closed[6] == Regime.MODERATE)
    assert np.array_equal(closed[:, 1:-1], open_[:, 1:])
    assert np.array_equal(closed[:, 0], closed[:, -1])
    quarters = march(wedge, 1.2, 0.0, np.array([0, 0.1, 0, -0.1]), 0.0)
    assert np.array_equal(quarters[4], [1, 1, -1, -1])


def test_a_contact_or_a_load_that_is_none_takes_the_whole_cycle():
    P, M, Q, sigma = loads(wedge)
    for k, value in ((0, -1.0), (1, math.nan), (2, math.nan), (3, math.inf)):
        given = [v.copy() for v in (P, M, Q, sigma)]
        given[k][3] = value
        found = march(wedge, *given)
        assert np.all(found[6] == Regime.NONE) and np.all(np.isnan(found[2:4]))
        assert np.isnan(found[0, 3]) == (k < 2) and np.isfinite(found[0, 4])
