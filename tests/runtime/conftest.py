"""Kernels of the tests are compiled anew when the runtime has changed, which numba does not see."""

from contextlib import suppress
from pathlib import Path

HERE = Path(__file__).parent
RUNTIME = HERE.parents[1] / "derive" / "runtime"

newest = max(path.stat().st_mtime for path in RUNTIME.rglob("*.py"))
for path in HERE.glob("__pycache__/*.nb[ic]"):
    with suppress(OSError):  # another worker was quicker
        if path.stat().st_mtime < newest:
            path.unlink()
