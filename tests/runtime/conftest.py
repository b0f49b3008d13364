"""The runtime is tested in its copy, generated/runtime, whose kernels other tests need as well: to
compile both would take as long as half of all tests.

Kernels of the tests are compiled anew when the runtime has changed, which numba does not see.
"""

from contextlib import suppress
from pathlib import Path

import pytest

HERE = Path(__file__).parent
SOURCE, COPY = (HERE.parents[1] / name / "runtime" for name in ("derive", "generated"))

newest = max(path.stat().st_mtime for path in COPY.rglob("*.py"))
for path in HERE.glob("__pycache__/*.nb[ic]"):
    with suppress(OSError):  # another worker was quicker
        if path.stat().st_mtime < newest:
            path.unlink()


@pytest.fixture(scope="session", autouse=True)
def the_copy_is_up_to_date() -> None:
    for path in SOURCE.rglob("*.py"):
        copy = COPY / path.relative_to(SOURCE)
        same = copy.exists() and copy.read_text("utf-8").endswith(path.read_text("utf-8"))
        assert same, f"{copy} is not {path}: run derive generate"
