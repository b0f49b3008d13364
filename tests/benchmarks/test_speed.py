"""The figures of `make bench` are of functions that compute the same thing."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.benchmarks.speed import BODIES, Figure, beside_by_hand, contenders, hole, page
from tests.paper_forms import FORMS


@pytest.mark.parametrize(
    ("body", "function"), [(b, f) for b in FORMS if b in BODIES for f in FORMS[b]]
)
def test_contenders_agree(body: str, function: str) -> None:
    found = {name: call() for name, call in contenders(body, function, 50).items()}
    ours = found.pop("generated")
    fields = list(FORMS[body][function])
    assert found
    for theirs in found.values():
        for i, field in enumerate(fields):
            mine = getattr(ours, field) if field else ours
            assert np.all(np.isfinite(mine))
            assert_allclose(mine, theirs[i] if len(fields) > 1 else theirs, rtol=1e-7)


@pytest.mark.slow
def test_the_kernel_by_hand_finds_the_same_stick_zones() -> None:
    assert [f.value > 0 for f in beside_by_hand([20], 1e-3)] == [True]  # raises where they differ


def test_a_hole_is_seen_from_both_sides() -> None:
    assert hole([1.0, 3.0, 1.5]) == 3.0
    assert hole([3.0, 1.0]) == 3.0


def test_the_page_tells_which_bounds_are_met() -> None:
    figures = [Figure("quick", 1.0, 2.0, "us"), Figure("threads", 1.0, 1.7, "times", least=True)]
    text = page(figures, [], [10, 100], [("load", [5.0])])
    assert "| quick | 1 us | at most 2 us | yes |" in text
    assert "| threads | 1 times | at least 1.7 times | no |" in text
    assert "| load | 5 |  |" in text
