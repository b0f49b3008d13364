"""What the tests of commands share."""

import pytest


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """`derive new` without the seconds that another process takes."""
    monkeypatch.setattr(
        "derive.command.new_geometry.in_processes",
        lambda task, items, *_: [task(item, lambda *_: None) for item in items],
    )
