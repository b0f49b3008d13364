"""The shear within friction that is nearest to a trial one: the conditions that single it out."""

import numpy as np
import pytest

from generated.runtime.history.elements import elements_of
from generated.runtime.history.nearest import nearest

MESH = elements_of(-np.cos(np.linspace(0, np.pi, 41)))
W, X = MESH.widths, MESH.middles
BOUND = np.where(abs(X) < 0.9, np.sqrt(1 - X**2), 0.0)
"""Friction where there is contact; it carries some 1.5."""


def wavy(seed, load):
    """A trial that carries the load."""
    angle = np.arccos(X)
    trial = np.random.default_rng(seed).normal(size=8) @ np.cos(np.outer(np.arange(8), angle)) / 2
    return trial + (load - W @ trial) * MESH.rise


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("load", [0.0, 0.6, -1.4])
def test_it_meets_every_condition(seed, load):
    """They are those of a convex problem: what meets them is its only solution."""
    trial = wavy(seed, load)
    q, v, status = nearest(MESH, trial, BOUND, np.zeros(W.size))
    assert np.all(abs(q) <= BOUND * (1 + 1e-9)) and W @ q == pytest.approx(load, abs=1e-9)
    sticks = (status == 0) & (BOUND > 0)
    assert np.any(sticks) and not np.all(sticks)
    assert np.all(v[sticks] == 0) and np.all(v * status >= 0)
    assert q[~sticks] == pytest.approx((status * BOUND)[~sticks])
    mu = (MESH.influence @ (q - trial) + v) / W
    assert np.ptp(mu) < 1e-8 * np.max(abs(MESH.influence @ trial / W))


@pytest.mark.parametrize("load", [0.4, -1.4])
def test_the_guess_does_not_matter(load):
    trial = wavy(1, load)
    plain, _, _ = nearest(MESH, trial, BOUND, np.zeros(W.size))
    for seed in range(3):
        q, _, _ = nearest(MESH, trial, BOUND, np.sign(wavy(seed + 50, 0.0)))
        assert q == pytest.approx(plain, abs=1e-10)


def test_a_trial_within_friction_is_the_answer():
    trial = 0.3 * BOUND
    q, v, status = nearest(MESH, trial, BOUND, np.zeros(W.size))
    assert not np.any(status) and q == pytest.approx(trial, abs=1e-12)
    assert np.all(v[BOUND > 0] == 0)


def test_no_step_separates_two_shears():
    """The nearest points of a convex set are no farther apart than the trials."""
    for seed in range(6):
        trials = wavy(seed, 0.5), wavy(seed + 10, 0.5)
        shears = [nearest(MESH, trial, BOUND, np.zeros(W.size))[0] for trial in trials]
        before, after = ((d[0] - d[1]) @ MESH.influence @ (d[0] - d[1]) for d in (trials, shears))
        assert after <= before * (1 + 1e-9)
