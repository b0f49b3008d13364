"""The findings of the whole paper, made once a process."""

from time import process_time

import pytest

from derive.paper.andresen2020 import paper
from derive.paper.verdict import Finding, check


@pytest.fixture(scope="session")
def findings() -> dict[str, Finding]:
    return {claim.label: check(claim) for claim in paper().claims}


@pytest.fixture(scope="session")
def timed(request: pytest.FixtureRequest) -> tuple[dict[str, Finding], float]:
    """The findings, and the seconds that they took; paper() is derived and proven in them."""
    began = process_time()
    found: dict[str, Finding] = request.getfixturevalue("findings")
    return found, process_time() - began
