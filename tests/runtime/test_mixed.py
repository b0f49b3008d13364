"""Slip that turns round: the boundary-element solver's zones, large tension.

Another solution and the moderate neighbour are in tests/generated/test_turning.py, mirrors and
scales in test_stick.py beside it, plain Python is in test_cycle.py.
"""

import numpy as np
import pytest

from generated.runtime.cycle import stick_zone
from generated.runtime.types import Contact, Regime

from . import laws
from .laws import state

F = 0.5


def cycles(case, a, c, shear, tension):
    """Rows of a, c, dQ, dsigma; dQ in parts of 2 f P, tension of 8 dQ/(pi h)."""
    dQ = 2 * F * shear * state(case, a, c)[0]
    tension = np.atleast_1d(tension)
    rows = [np.full(tension.shape, v) for v in (a, c, dQ)]
    return np.stack([*rows, tension * 8 * dQ / (np.pi * (a + c))], axis=-1)


def zones(case, rows):
    """m, n and the regime of cycles, mixed ones solved, a row each."""
    a, c, dQ, dsigma = np.transpose(rows)
    here, own = Contact(a, c, 0.0), {str(i): v for i, v in enumerate(case.own)}
    return np.transpose(stick_zone(case.body, own, here, here, dQ, dsigma, F, 1.0, mixed=True))


def test_the_boundary_element_solver_finds_the_same():
    """tests/reference/FINDINGS.md: the upright wedge, dQ = 0.3 f P, tension over its threshold."""
    found = {
        0.95: (0.72845, 0.99143, 1.3e-4),
        1.0: (0.72251, 0.99419, 1.9e-4),
        1.05: (0.71662, 0.99206, 1.4e-4),
        1.085: (0.71253, 0.98834, 1.3e-4),
    }
    here = zones(laws.wedge, [[1.0, 1.0, 0.15, part * 0.206021] for part in found])
    for (m, n, regime), (m_there, n_there, off) in zip(here, found.values(), strict=True):
        assert regime == Regime.MIXED
        assert abs(m - m_there) <= off and abs(n - n_there) <= off


@pytest.mark.parametrize("name", ["wedge", "hertz", "flat_rounded"])
def test_it_goes_over_into_large_tension(name):
    """The slip zones are continuous where reversed slip no longer turns round."""
    case, low, high = getattr(laws, name), 1.02, 1.6
    while high - low > 1e-8:
        middle = (low + high) / 2
        (zone,) = zones(case, cycles(case, 1.5, 1.25, 0.2, middle))
        low, high = (low, middle) if zone[2] == Regime.LARGE else (middle, high)
    before, beyond = zones(case, cycles(case, 1.5, 1.25, 0.2, [low, high]))
    assert (before[2], beyond[2]) == (Regime.MIXED, Regime.LARGE)
    assert before[:2] == pytest.approx(beyond[:2], abs=1e-6)
