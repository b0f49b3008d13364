"""The findings of the whole paper, made once a process."""

import pytest

from derive.paper.andresen2020 import paper
from derive.paper.verdict import Finding, check


@pytest.fixture(scope="session")
def findings() -> dict[str, Finding]:
    """The findings by label."""
    return {claim.label: check(claim) for claim in paper().claims}
