"""Property tests draw the same examples on every machine; no test sees the user's own cache."""

from itertools import count

import pytest
from hypothesis import settings

from derive.cache import VARIABLE

settings.register_profile("ci", derandomize=True, deadline=None)
settings.load_profile("ci")

_NUMBERS = count()


@pytest.fixture(autouse=True)
def empty_cache(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """A cache of its own for every test, and for the processes that it starts."""
    folder = tmp_path_factory.getbasetemp() / "caches" / str(next(_NUMBERS))
    monkeypatch.setenv(VARIABLE, str(folder))
