"""What the notebooks on the paper share: its coefficients as printed, cycles, texts."""

import doctest
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from derive.check.userfile import BUILT_IN, read_claims
from generated import wedge
from notebooks import common

LAW = {"E_star": 1.0, "phi": 1.0}
GIVEN = {"f": 0.5, **LAW}
DQ, PULL = 0.15, 0.4


def test_examples() -> None:
    done = doctest.testmod(common)
    assert (done.failed, done.attempted >= 3) == (0, True)


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
