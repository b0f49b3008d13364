"""What the tests of generated modules share."""

import pytest

from derive.codegen.integrals import Integrals


@pytest.fixture
def no_integrals_printed(monkeypatch: pytest.MonkeyPatch) -> None:
    """In docstrings they take more than half of the time, and have tests in test_integrals.py."""
    monkeypatch.setattr(Integrals, "lines", lambda *_: iter(()))
