"""The shear load that a stick zone can carry: the limits at which it no longer sticks."""

import math

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

import generated.hertz as cylinder
from generated.runtime.slip import locked
from generated.runtime.types import Regime

from .laws import hertz, state

F = 0.5
GIVEN = {"f": F, "E_star": 1.0, "R": 1.0}


def carries(cycle, regime, Q):
    """Whether a cylinder carries Q in a cycle a_1, c_1, a_2, c_2, dQ, dsigma."""
    ends = [state(hertz, *cycle[:2])[:2], state(hertz, *cycle[2:4])[:2]]
    first = np.array([*ends[0], Q, 0.0])
    last = np.array([*ends[1], Q + cycle[4], cycle[5]])
    return locked.carries(hertz.body, {"R": 1.0}, F, first, last, regime)


def demand_limits(cycle, regime, lowest, highest):
    """Within 0.2 % of f P of both limits; the integrals are accurate to 0.1 %."""
    off = 2e-3 * F * math.pi / 4
    assert carries(cycle, regime, highest - off)
    assert not carries(cycle, regime, highest + off)
    assert carries(cycle, regime, lowest + off)
    assert not carries(cycle, regime, lowest - off)


@pytest.mark.parametrize("d", [0.1, 0.4])
def test_a_cylinder_that_is_rocked(d):
    """From [-1 - d, 1 - d] to [-1 + d, 1 + d], p = sqrt(1 - (x - middle)**2)/2 for R = E* = 1.

    The least p at x > 0 is that of the first contact, so that the highest |Q| is

        2 f int_0^(1 - d) sqrt(1 - (x + d)**2)/2 dx = f (pi/4 - (d sqrt(1 - d**2) + asin d)/2).
    """
    highest = F * (math.pi / 4 - (d * math.sqrt(1 - d * d) + math.asin(d)) / 2)
    cycle = [1 + d, 1 - d, 1 - d, 1 + d, 0.0, 0.0]
    demand_limits(cycle, Regime.FULL_STICK, -highest, highest)


@pytest.mark.parametrize("tension", [0.3, -0.5])
def test_tension_alone(tension):
    """dq is odd: the highest Q is int min(f p, f p - dq) dx = f P - int |dq| dx/2."""
    here = cylinder.contact(math.pi / 4, 0.0, E_star=1.0, R=1.0)
    zone = cylinder.stick_zone(here, here, 0.0, tension, **GIVEN)
    assert zone.regime == Regime.LARGE and zone.m == pytest.approx(zone.n)
    angle, weight = leggauss(400)
    x = np.sin(math.pi / 2 * angle)
    dq = cylinder.shear_change(x, here, here, 0.0, tension, **GIVEN)
    half = np.sum(weight * math.pi / 2 * np.sqrt(1 - x * x) * abs(dq)) / 2
    highest = F * math.pi / 4 - half
    assert 0.2 < highest / (F * math.pi / 4) < 0.95
    cycle = [1.0, 1.0, 1.0, 1.0, 0.0, tension]
    demand_limits(cycle, Regime.LARGE, -highest, highest)


def test_under_moderate_tension_every_load_below_sliding_is_carried():
    cycle = [1.0, 1.0, 1.0, 1.0, 0.1, 0.02]
    assert carries(cycle, Regime.MODERATE, 0.999 * F * math.pi / 4)
