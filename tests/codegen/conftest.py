"""What the tests of generated modules share."""

import pytest

import derive.codegen.integrals
from derive.codegen.function import FunctionText


@pytest.fixture
def short_docstrings(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without integrals, which have tests in test_integrals.py, and examples: most of the time."""
    monkeypatch.setattr(derive.codegen.integrals, "lines_of", lambda *_: iter(()))
    monkeypatch.setattr(FunctionText, "_doctest", ())
