"""What the notebooks on the paper share: its coefficients as printed, cycles, texts."""

import doctest
import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from derive.check.userfile import BUILT_IN, read_claims
from generated import hertz, wedge
from generated.runtime.types import Contact
from notebooks import common

LAW = {"E_star": 1.0, "phi": 1.0}
GIVEN = {"f": 0.5, **LAW}
DQ, PULL = 0.15, 0.4


def test_examples() -> None:
    done = doctest.testmod(common)
    assert (done.failed, done.attempted >= 3) == (0, True)


def test_loads_swing_in_phase_between_both_states() -> None:
    of = common.cycle((0.9, 1.1), (0.0, 0.2), DQ, PULL, count=9)
    assert_allclose([load[[0, 4, 8]] for load in of.loads[:2]], [[0.9, 1.1, 0.9], [0, 0.2, 0]])
    assert_allclose(of.Q[4] - of.Q[0], DQ)
    assert_allclose(of.sigma[4] - of.sigma[0], PULL)
    assert np.all(wedge.march(*of.loads, **GIVEN).regime != wedge.Regime.NONE)


@pytest.fixture
def wedge_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the claims of the paper, those that are asked for: the others take seconds to read."""
    head, *claims = (BUILT_IN / "4_wedge.toml").read_text().split("[[claims]]")
    wanted = [claim for claim in claims if 'label = "K_T/tilted/' in claim]
    path = tmp_path / "wedge.toml"
    path.write_text("[[claims]]".join([head, *wanted]))
    monkeypatch.setattr(common, "paper", lambda: read_claims(path))


@pytest.mark.slow
@pytest.mark.usefixtures("wedge_alone")
def test_the_printed_coefficient_of_a_tilted_contact() -> None:
    """Eq. (32): dQ/(pi sqrt(2 a)) + (dsigma/4) sqrt(a/2), and with c and - at the right; eq. (33)
    and (34): K_N = (2/pi) sqrt(c/(a (a + c))), and a/c times it, for E* = phi = 1."""
    a, c = 1.6, 0.625
    state = wedge.Contact(a, c, 0.0)
    ends = common.printed(wedge, state, DQ, PULL, da=0.02, dc=-0.01, **GIVEN)
    K_left, K_right = (
        DQ / (np.pi * np.sqrt(2 * e)) + s * PULL / 4 * np.sqrt(e / 2) for e, s in ((a, 1), (c, -1))
    )
    N_left = 2 / np.pi * np.sqrt(c / (a * (a + c)))
    assert_allclose(ends.m, a - abs(K_left) / (0.5 * N_left) - 0.01)
    assert_allclose(ends.n, c - abs(K_right) / (0.5 * N_left * a / c) + 0.005)


@pytest.mark.slow
@pytest.mark.usefixtures("wedge_alone")
def test_the_printed_march_ends_as_the_printed_series_does() -> None:
    of = common.cycle((1.0, 1.0), (0.1, 0.15), DQ, PULL, count=9)
    marched = common.series_march(wedge, of, **GIVEN)["printed"]
    first, second = (wedge.contact(1.0, M, **LAW) for M in (0.1, 0.15))
    for at, begin, end in ((4, first, second), (8, second, first)):
        moved = {"da": end.a - begin.a, "dc": end.c - begin.c}
        ends = common.printed(wedge, end, DQ, PULL, **moved, **GIVEN)
        assert_allclose((marched.m[at], marched.n[at]), (ends.m, ends.n))


def test_errors_are_parts_of_the_exact_slip_zone() -> None:
    edges, exact = wedge.Contact(1.0, 1.0, 0.0), common.Ends(0.8, 0.9)
    (left, right), *_ = common.errors_at(edges, exact, {"k": common.Ends(0.75, 0.95)}).values()
    assert_allclose((left, right), (0.25, -0.5))


def test_closing_tensions_by_hand() -> None:
    """Cylinder, P = pi/4: h falls to h sqrt(1 - dQ/(2 f P)), one edge stays, alpha = (a - c)/2.
    Wedge, P = sqrt(a c) = 1, dQ = 0.3 f P: m = 0.85**2 with c = 1, and the tilt is
    (2/pi) atan((m - c)/(2 sqrt(m c)))."""
    stuck = 2 * math.sqrt(1 - 0.2 / (2 * 0.4 * math.pi / 4))
    cylinder = {"f": 0.4, "E_star": 1.0, "R": 1.0}
    lower, upper = common.closing_tension(hertz, Contact(1.1, 0.9, 0.1), 0.2, **cylinder)
    assert (upper, -lower) == pytest.approx((2 * 0.4 * (2 - stuck),) * 2, rel=1e-12)
    tilt = 2 / math.pi * math.atan((1 - 0.85**2) / (2 * 0.85))
    sharp = {"f": 0.5, "E_star": 1.0, "phi": 1.0}
    lower, upper = common.closing_tension(wedge, Contact(1.0, 1.0, 0.0), 0.15, **sharp)
    assert (lower, upper) == pytest.approx((-2 * tilt, 2 * tilt), rel=1e-12)
