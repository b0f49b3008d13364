"""The benchmark runs, and compares functions that compute the same thing."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.benchmarks.speed import calls, rows, table
from tests.paper_forms import FORMS

CASES = [(body, function) for body, functions in FORMS.items() for function in functions]


@pytest.mark.parametrize(("body", "function"), CASES)
def test_the_three_agree(body: str, function: str) -> None:
    """To the digits that the paper's form keeps in the bulk."""
    generated, plain, cse = (call() for call in calls(body, function, 500))
    fields = list(FORMS[body][function])
    for i, field in enumerate(fields):
        ours = getattr(generated, field) if field else generated
        for theirs in (plain, cse):
            assert_allclose(ours, theirs[i] if len(fields) > 1 else theirs, rtol=1e-8)
        assert np.all(np.isfinite(ours))


def test_every_form_is_timed_and_shown() -> None:
    found = list(rows((10,), seconds=0.001))
    assert [row.name for row in found] == [f"{body}.{function}" for body, function in CASES]
    assert all(min(row.generated, row.plain, row.cse) > 0 for row in found)
    assert table(found).row_count == len(CASES)
