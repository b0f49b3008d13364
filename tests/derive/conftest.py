"""Every test of this folder computes with thirty digits."""

from collections.abc import Iterator

import mpmath
import pytest


@pytest.fixture(autouse=True, scope="module")
def thirty_digits() -> Iterator[None]:
    with mpmath.workdps(30):
        yield
