"""Every test of this folder computes with thirty digits; some do without proofs."""

from collections.abc import Iterator

import mpmath
import pytest

import derive.codegen.trial
import derive.command.processes
import derive.pipeline
import derive.proof.prove
from tests.derive.bodies import assumed


@pytest.fixture(autouse=True, scope="module")
def thirty_digits() -> Iterator[None]:
    with mpmath.workdps(30):
        yield


@pytest.fixture
def unproven(monkeypatch: pytest.MonkeyPatch) -> None:
    """The pipeline without the seconds that its proofs take, and without other processes, which
    would know nothing of that."""
    monkeypatch.setattr(derive.proof.prove, "prove_sheet", assumed)
    monkeypatch.setattr(derive.codegen.trial, "demand_right", lambda *_: None)
    monkeypatch.setattr(derive.command.processes, "cores", lambda: 1)
    monkeypatch.setattr(derive.pipeline, "USER_FILE_LIMITS", None)
