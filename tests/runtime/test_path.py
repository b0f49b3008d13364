"""Where the steps between two instants of a history end; test_history.py tests what follows."""

import numpy as np
import pytest

from generated import hertz
from generated.runtime.history.path import path


def shear_on_the_way(Q, **given):
    """Under f P = 1/4."""
    loads = np.array(np.broadcast_arrays(0.5, 0.0, Q, 0.0))
    return path(hertz._BODY, {"R": 1.0}, 0.5, loads, 0.1, **given).Q


def test_a_step_ends_where_shear_comes_to_friction_or_leaves_it():
    """At a half of the way up and at 5/8 of the way down."""
    way = shear_on_the_way([0.0, 0.5, 0.1], least=1, short_end=False)
    assert np.count_nonzero(abs(way - 0.25) < 1e-15) == 2


def test_the_last_step_is_short():
    steps = np.diff(shear_on_the_way([0.0, 0.2], least=2, short_end=True)[-4:])
    assert steps[-1] / steps[0] == pytest.approx(0.01, rel=1e-9)
