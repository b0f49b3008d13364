"""A cycle instant by instant."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import wedge
from generated.runtime.types import Contact, Regime

LAW = {"f": 0.5, "E_star": 1.25, "phi": 0.25}
OWN = {"E_star": 1.25, "phi": 0.25}
T = np.arange(16) * np.pi / 8
"""Sixteen instants; the loads turn at the 4th and the 12th."""
UP, DOWN = np.arange(-3, 5), np.arange(5, 13)


def loads(tension: float, normal: float = 0.0, turn: float = 0.0) -> tuple[np.ndarray, ...]:
    P, M = wedge.load(1.5, 1.0, **OWN), wedge.moment(1.5, 1.0, **OWN)
    Q = 0.15 * 0.5 * P * np.sin(T)
    sigma = tension * 8 * Q / (np.pi * 2.5)
    return P * (1 + normal * np.sin(T)), M * (1 + turn * np.sin(T)), Q, sigma


@pytest.mark.parametrize("tension", [0.0, 0.5, -0.5])
def test_moderate_tension_slips_forward_and_back(tension: float) -> None:
    cycle = wedge.march(*loads(tension), **LAW)
    assert np.all(cycle.regime == Regime.MODERATE)
    assert np.all(cycle.left[UP] == 1) and np.all(cycle.right[UP] == 1)
    assert np.all(cycle.left[DOWN] == -1) and np.all(cycle.right[DOWN] == -1)


@pytest.mark.parametrize("tension", [3.0, -3.0])
def test_large_tension_slips_apart(tension: float) -> None:
    cycle, sense = wedge.march(*loads(tension), **LAW), np.sign(tension)
    assert np.all(cycle.regime == Regime.LARGE)
    assert np.all(cycle.left[UP] == sense) and np.all(cycle.right[UP] == -sense)
    assert np.all(cycle.left == -cycle.right)
    assert np.all(cycle.left[DOWN] == -sense)


@pytest.mark.parametrize("tension", [0.5, 3.0])
@pytest.mark.parametrize("normal", [0.0, 0.01])
def test_at_the_turns_it_is_the_permanent_stick_zone(tension: float, normal: float) -> None:
    given = loads(tension, normal, -normal)
    cycle = wedge.march(*given, **LAW)
    ends = wedge.contact(given[0][[12, 4]], given[1][[12, 4]], **OWN)
    first, second = (Contact(*(v[i] for v in ends)) for i in (0, 1))
    zone = wedge.stick_zone(first, second, np.ptp(given[2]), 2 * given[3][4], **LAW)
    assert_allclose((cycle.m[[4, 12]], cycle.n[[4, 12]]), ([zone.m] * 2, [zone.n] * 2), rtol=1e-11)
    assert np.all(np.diff(cycle.m[UP]) < 0) and np.all(np.diff(cycle.n[DOWN]) < 0)


def test_constant_loads_go_back_as_they_came() -> None:
    cycle = wedge.march(*loads(0.5), **LAW)
    assert_allclose(cycle.m[UP], cycle.m[DOWN], rtol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2, 3])
def test_series_come_closer_order_by_order(order: int) -> None:
    given = loads(3.0, 0.002)
    exact, found = wedge.march(*given, **LAW), wedge.march(*given, **LAW, order=order)
    assert np.array_equal(found.regime, exact.regime)
    assert np.array_equal(found.left, exact.left)
    off = np.max(np.abs(found.m - exact.m) + np.abs(found.n - exact.n))
    assert 0.1 ** (order + 2) < off < 0.35**order


def test_cycles_lie_along_the_last_axis() -> None:
    given = [np.stack(pair) for pair in zip(loads(0.5), loads(3.0), strict=True)]
    both = wedge.march(*given, **LAW)
    assert both.m.shape == (2, 16)
    assert np.array_equal(both.m[1], wedge.march(*loads(3.0), **LAW).m)


def test_no_change_is_full_stick() -> None:
    P = wedge.load(1.5, 1.0, **OWN) * np.ones(4)
    cycle = wedge.march(P, 0.0, 0.1 * P, 0.0, **LAW)
    assert np.all(cycle.regime == Regime.FULL_STICK)
    assert np.all(cycle.left == 0) and np.all(cycle.m == cycle.a)


def test_loads_out_of_phase_have_no_stick_zone() -> None:
    P, M, Q, _ = loads(0.0)
    cycle = wedge.march(P, M, Q, 0.1 * np.cos(T), **LAW)
    assert np.all(np.isnan(cycle.m)) and np.all(cycle.regime == Regime.OUT_OF_PHASE)
    assert np.all(cycle.a > 0) and not np.any(cycle.left)


def test_loads_that_turn_inside_a_half_cycle_are_refused() -> None:
    """The whole cycle is: none of it is steady."""
    P, _, Q, _ = loads(0.0)
    Q[[1, 2]] = Q[[2, 1]]
    cycle = wedge.march(P, 0.0, Q, 0.0, **LAW)
    assert np.all(cycle.regime == Regime.OUT_OF_PHASE) and np.all(np.isnan(cycle.m))


def test_a_first_loading_is_no_cycle() -> None:
    """From one state to the other and no further: the last instant does not lead back."""
    Q = 0.1 * wedge.load(1.5, 1.0, **OWN) * np.linspace(-1, 1, 5)
    P = wedge.load(1.5, 1.0, **OWN)
    cycle = wedge.march(P, 0.0, Q, 0.0, **LAW)
    assert np.all(cycle.regime == Regime.NOT_CLOSED) and np.all(np.isnan(cycle.n))
    whole = wedge.march(P, 0.0, np.append(Q, Q[-2:0:-1]), 0.0, **LAW)
    assert np.all(whole.regime == Regime.MODERATE)


def test_a_contact_that_is_gone_at_one_instant_makes_no_cycle() -> None:
    P, M, Q, sigma = loads(0.5)
    P[3] = -1.0
    cycle = wedge.march(P, M, Q, sigma, **LAW)
    assert np.all(cycle.regime == Regime.NONE) and np.all(np.isnan(cycle.m))


@pytest.mark.parametrize("shift", [3, 8, 15])
def test_where_the_array_starts_does_not_matter(shift: int) -> None:
    """Loads that rest at both turns, too: while they do, the half-cycle is at its end."""
    P = wedge.load(1.5, 1.0, **OWN)
    for Q in (np.sin(T), np.clip(1.5 * np.sin(T), -1, 1)):
        whole = wedge.march(P, 0.0, 0.1 * P * Q, 0.0, **LAW)
        rolled = wedge.march(P, 0.0, np.roll(0.1 * P * Q, shift), 0.0, **LAW)
        for before, after in zip(whole, rolled, strict=True):
            assert_allclose(np.roll(after, -shift), before, rtol=1e-13)
    assert np.ptp(whole.m[3:6]) == 0 and whole.m[3] == np.min(whole.m)


def test_shear_that_rounding_alone_changes_is_constant() -> None:
    P = wedge.load(1.5, 1.0, **OWN)
    Q = 0.1 * P * (np.sin(T) ** 2 + np.cos(T) ** 2)
    cycle = wedge.march(P, 0.0, Q, 0.1 * np.sin(T), **LAW)
    assert np.all(cycle.regime == Regime.LARGE)


@pytest.mark.parametrize("order", [0, 1, 2])
def test_no_shear_and_sliding_are_told_by_series_too(order: int) -> None:
    P, M, Q, _ = loads(0.0, 0.05)
    still = wedge.march(P, M, 0 * Q, 0.0, **LAW, order=order)
    assert np.all(still.regime == Regime.FULL_STICK)
    assert np.all(still.left == 0) and np.all(still.m <= still.a)
    slides = wedge.march(P, M, 30 * Q, 0.0, **LAW, order=order)
    assert np.all(slides.regime == Regime.SLIDING) and np.all(np.isnan(slides.m))


def test_slip_that_overtakes_is_told_from_none() -> None:
    """Wedge, dQ = 0.3 f P, 0.929 of the closing tension: MIXED with a known zone at the end."""
    t = np.linspace(0, 1, 41)
    part = (1 - np.cos(2 * np.pi * t)) / 2
    Q, sigma = 0.15 * (part - 0.5), 0.929 * 0.206021 * (part - 0.5)
    cycle = wedge.march(1.0, 0.0, Q, sigma, f=0.5, E_star=1.0, phi=1.0)
    known = (cycle.regime == Regime.MIXED) & np.isfinite(cycle.m)
    assert np.any(known)
    assert np.all(cycle.left[known] == np.where((t > 0) & (t <= 0.5), 1, -1)[known])
    assert np.array_equal(cycle.left[known], cycle.right[known])


@pytest.mark.parametrize("order", [0, 2])
@pytest.mark.parametrize("tension", [1.0021, 1.02, 1.08])
def test_nothing_is_told_of_a_cycle_in_which_slip_turns_round(tension: float, order: int) -> None:
    """Wedge, P = E* = phi = 1, dQ = 0.3 f P, tension over 8 dQ/(pi h).  At its start the right edge
    is not at friction: a twentieth of the way the independent solver finds a slip zone of 0.0024
    there at 1.02, where a half-cycle that ended then would leave one of 0.0007."""
    part = (1 - np.cos(2 * np.pi * np.linspace(0, 1, 41))) / 2
    Q, sigma = 0.15 * (part - 0.5), tension * 8 * 0.15 / (2 * np.pi) * (part - 0.5)
    cycle = wedge.march(1.0, 0.0, Q, sigma, f=0.5, E_star=1.0, phi=1.0, order=order)
    on_the_way = (part > 0) & (part < 1)
    assert np.all(cycle.regime[on_the_way] == Regime.MIXED)
    assert np.all(np.isnan(cycle.m[on_the_way]))
    assert not np.any(cycle.left[on_the_way]) and not np.any(cycle.right[on_the_way])
    if order == 0:
        assert np.isfinite(cycle.m[[0, 20]]).all() == (tension < 1.01)  # forward slip overtakes
