"""The findings of the whole paper, made once a process."""

from time import process_time

import pytest

from derive.paper.andresen2020 import paper
from derive.paper.verdict import Finding, check


@pytest.fixture(scope="session")
def timed() -> tuple[dict[str, Finding], float]:
    """The findings by label, and the seconds of this process that they took."""
    began = process_time()
    found = {claim.label: check(claim) for claim in paper().claims}
    return found, process_time() - began


@pytest.fixture(scope="session")
def findings(timed: tuple[dict[str, Finding], float]) -> dict[str, Finding]:
    return timed[0]
