"""The findings of the whole paper, made once a process.

Tests of all of them are thorough: notebook 08, which `make test` executes, makes them too, and
stops where a verdict is not the expected one.
"""

import pytest

from derive.paper.userfile import built_in as paper
from derive.paper.verdict import Finding, check


@pytest.fixture(scope="session")
def findings() -> dict[str, Finding]:
    """The findings by label."""
    return {claim.label: check(claim) for claim in paper().claims}
