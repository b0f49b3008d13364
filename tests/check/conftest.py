"""What the tests of the checker share."""

import pytest

from derive.command.limit import LimitReached


@pytest.fixture
def unmended(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the seconds of a search for a correction."""

    def stopped(*_: object) -> None:
        raise LimitReached

    monkeypatch.setattr("derive.check.verdict.repaired", stopped)
