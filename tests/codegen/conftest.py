"""What the tests of generated modules share."""

import pytest

from derive.codegen.function import FunctionText
from derive.codegen.integrals import Integrals


@pytest.fixture
def short_docstrings(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without integrals, which have tests in test_integrals.py, and examples: most of the time."""
    monkeypatch.setattr(Integrals, "lines", lambda *_: iter(()))
    monkeypatch.setattr(FunctionText, "_doctest", ())
