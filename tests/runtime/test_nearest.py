"""The shear within friction that is nearest to a trial one: the conditions that single it out."""

import numpy as np
import pytest

from generated.runtime.history.elements import influence, inverse_of
from generated.runtime.history.nearest import nearest

ENDS = -np.cos(np.linspace(0, np.pi, 41))
W = np.diff(ENDS)
X = (ENDS[1:] + ENDS[:-1]) / 2
BOUND = np.sqrt(1 - X**2)
"""Carries nearly pi/2."""
A = influence(ENDS)
B = inverse_of(A)


def solution(trial, load, places=None):
    """Whether it is found, q, s and the places."""
    places = np.zeros(W.size) if places is None else places.copy()
    q, s, room = np.zeros(W.size), np.zeros(W.size), np.zeros((W.size + 1, W.size))
    given = np.array([load])
    found = nearest(A, B, B @ W, W, trial, BOUND, given, places, q, s, room)
    return found, q, s, places


def wavy(seed):
    angle = np.arccos(X)
    return np.random.default_rng(seed).normal(size=8) @ np.cos(np.outer(np.arange(8), angle)) / 2


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("load", [0.0, 0.6, -1.5])
def test_it_meets_every_condition(seed, load):
    """They are those of a convex problem: what meets them is its only solution."""
    trial = wavy(seed)
    found, q, s, places = solution(trial, load)
    assert found
    assert np.all(abs(q) <= BOUND * (1 + 1e-9)) and W @ q == pytest.approx(load, abs=1e-9)
    sticks = places == 0
    assert np.any(sticks) and not np.all(sticks)
    assert np.all(s[sticks] == 0) and np.all(s * places <= 1e-9)
    assert q[~sticks] == pytest.approx((places * BOUND)[~sticks])
    mu = A @ (q - trial) / W - s
    assert np.ptp(mu) < 1e-8 * np.max(abs(A @ trial / W))


def test_the_guess_does_not_matter():
    trial = wavy(1)
    _, plain, _, _ = solution(trial, 0.4)
    for seed in range(3):
        guess = np.sign(wavy(seed + 50))
        guess[20] = 0
        _, q, _, _ = solution(trial, 0.4, guess)
        assert q == pytest.approx(plain, abs=1e-10)


def test_a_trial_within_friction_that_carries_the_load_is_the_answer():
    trial = 0.3 * BOUND
    found, q, s, places = solution(trial, W @ trial)
    assert found and not np.any(s) and not np.any(places)
    assert q == pytest.approx(trial, abs=1e-12)


def test_more_than_friction_bears_is_not_found():
    assert not solution(0 * X, 1.01 * (W @ BOUND))[0]
