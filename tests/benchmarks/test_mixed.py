"""The sample of mixed cycles, and how its parts are counted."""

import numpy as np
import pytest

from tests.benchmarks.mixed import SHEAR, TENSION, Turning, pairs, parts, share, turning


def test_parts_of_the_sample_make_the_whole() -> None:
    rng = np.random.default_rng(1)
    shear, tension = rng.uniform(0, 0.99, 500), rng.uniform(0.95, 6, 500)
    found = Turning(shear, tension, rng.uniform(size=500) < 0.3, 1.0)
    counts = [found.between(s, t) for s in pairs(SHEAR) for t in pairs(TENSION)]
    whole = found.between((SHEAR[0], SHEAR[-1]), (TENSION[0], TENSION[-1]))
    assert tuple(np.sum(counts, axis=0)) == whole == (np.count_nonzero(found.unsolved), 500)


def test_a_share_is_of_something() -> None:
    assert share(1, 8) == "12 % of 8"
    assert share(0, 0) == "-"


@pytest.mark.thorough
@pytest.mark.slow
def test_mixed_cycles_of_moderate_shear_are_solved() -> None:
    found = turning("wedge", 120)
    assert 30 < found.unsolved.size < 90
    unsolved, of = found.between((0, 0.6), (0.95, 1.5))
    assert of > 5
    assert unsolved == 0
    assert "0.8 to 0.99" in str(parts("wedge", found).columns[0]._cells)
