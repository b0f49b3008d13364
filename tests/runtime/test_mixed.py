"""Slip that turns round: the boundary-element solver's zones, large tension.

Another solution and the moderate neighbour are in tests/generated/test_turning.py, mirrors and
scales in test_stick.py beside it, plain Python is in test_cycle.py.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from generated.runtime.inverse import contact_at_tilt
from generated.runtime.kernels import loop, opened
from generated.runtime.slip.march import large_zone
from generated.runtime.slip.mixed import mixed_zone

from . import laws
from .laws import solved, state

F = 0.5


@loop
def each_zone(law, given, own, out):
    """given: a, c, dQ, dsigma; m and n of what turns round, the moderate zone, the large one."""
    law = opened(law)
    for i in range(given.shape[0]):
        a, c, dQ, dsigma = given[i]
        load, moment, tilt, _, _ = law.state(a, c, own[i])
        ends = np.array([[a, c, tilt, load, moment], [a, c, tilt, load, moment]])
        cycle = np.array([a, c, a, c, dQ, dsigma, F])
        out[i, 0], out[i, 1] = mixed_zone(law, own[i], ends, cycle)
        low, lean = load - dQ / (2 * F), tilt - dsigma / (4 * F)
        out[i, 2], out[i, 3] = contact_at_tilt(law, own[i], low, lean)
        out[i, 4], out[i, 5] = large_zone(law, own[i], cycle)


def cycles(case, a, c, shear, tension):
    """dQ in parts of 2 f P, tension of 8 dQ/(pi h)."""
    a, c, shear, tension = np.broadcast_arrays(a, c, shear, tension)
    edges = zip(a.flat, c.flat, strict=True)
    load = [state(case, u, v)[0] for u, v in edges]
    dQ = 2 * F * shear * np.reshape(load, a.shape)
    return np.stack([a, c, dQ, tension * 8 * dQ / (np.pi * (a + c))], axis=-1).reshape(-1, 4)


def test_the_boundary_element_solver_finds_the_same():
    """tests/reference/FINDINGS.md: the upright wedge, dQ = 0.3 f P, tension over its threshold."""
    found = {
        0.95: (0.72845, 0.99143, 1.3e-4),
        1.0: (0.72251, 0.99419, 1.9e-4),
        1.05: (0.71662, 0.99206, 1.4e-4),
        1.085: (0.71253, 0.98834, 1.3e-4),
    }
    given = np.array([[1.0, 1.0, 0.15, part * 0.206021] for part in found])
    for (m, n), (m_there, n_there, off) in zip(
        solved(each_zone, laws.wedge, given, 6)[:, :2], found.values(), strict=True
    ):
        assert abs(m - m_there) <= off and abs(n - n_there) <= off


@pytest.mark.parametrize("name", ["wedge", "hertz", "flat_rounded"])
def test_it_goes_over_into_large_tension(name):
    """Up to m + n(large) = H: before, by d in parts of the contact, n parts from it like d**2."""
    case, a, c = getattr(laws, name), 1.5, 1.25

    def past(tension):
        zone = solved(each_zone, case, cycles(case, a, c, 0.2, tension), 6)
        return np.maximum((zone[:, 4] + zone[:, 5]) / (a + c) - 1 / np.asarray(tension), -1)

    border = brentq(lambda t: past(t)[0], 1.02, 1.6, xtol=1e-12)
    tension = border - (border - 1) * np.array([0.02, 0.05, 0.1, 0.15])
    zone = solved(each_zone, case, cycles(case, a, c, 0.2, tension), 6)
    apart = (zone[:, 5] - zone[:, 1]) / past(tension) ** 2
    assert_allclose(apart, apart[0], rtol=0.1)
    assert 1 < apart[0] < 6
    assert_allclose(zone[:, 0], zone[:, 4], atol=1e-4)
    assert np.isnan(solved(each_zone, case, cycles(case, a, c, 0.2, border + 1e-3), 6)[0, 0])
