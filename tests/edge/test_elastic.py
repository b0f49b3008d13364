"""The composite modulus, by hand."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated.edge import E_star, EdgeWarning, dundurs


def test_similar_bodies_by_hand() -> None:
    """210/(2 (1 - 0.09)) = 115.3846."""
    assert_allclose(E_star(210e9, 0.3), 210e9 / 1.82, rtol=1e-15)
    assert_allclose(E_star(210e9, 0.3, 210e9, 0.3), 210e9 / 1.82, rtol=1e-15)


def test_different_bodies_are_warned_of() -> None:
    """1/E* = 0.75/1 + 0.75/3 = 1; beta = 0 where both are incompressible."""
    with pytest.warns(EdgeWarning, match="Dundurs"):
        assert_allclose(E_star(1.0, 0.5, 3.0, 0.5 - 1e-3), 1.0, rtol=1e-3)
    assert_allclose(E_star(1.0, 0.5, 3.0, 0.5), 1.0, rtol=1e-15)


def test_dundurs_by_hand() -> None:
    """A rigid body on one with nu = 0: (1 - 2 nu)/(2 (1 - nu)) = 1/2."""
    found = dundurs([1.0, 1e30], [0.0, 0.3], [1e30, 1.0], [0.3, 0.0])
    assert_allclose(found, [0.5, -0.5], rtol=1e-12)


def test_what_is_no_elastic_body() -> None:
    assert np.all(np.isnan(E_star([-1.0, 1.0, 1.0, np.inf], [0.3, 0.6, -1.0, 0.3])))
    with pytest.raises(ValueError, match="given together"):
        E_star(1.0, 0.3, 2.0)
