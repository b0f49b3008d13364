"""Kernels: compiled once, kept on disk as long as they are whole and their sources are the same.

What happens on disk is tried in a small package of its own, which compiles in a second.
"""

import os
import pickle
import shutil
from pathlib import Path

import numpy as np
import pytest

from generated import hyperbola, wedge
from generated.runtime.forward import each_contact
from generated.runtime.kernels import COMPILED, COMPILING, DAMAGED
from tests.commands import ROOT, python

compiled = pytest.mark.skipif(not COMPILED, reason="numba does not compile here")

FACTOR = """
from .kernels import kernel

@kernel
def times(slope):
    return 2.0 * slope
"""

INVERSE = """
def solve(state, slope, breaks, own, load, given, held):
    return 0.0, 0.0, 0.0
"""

SOLVER = """
from concurrent.futures import ThreadPoolExecutor
import numpy as np
from .factor import times
from .body import Body
from .kernels import loop, opened

@loop
def each_slope(law, given, own, out):
    law = opened(law)
    for i in range(given.shape[0]):
        out[i, 0] = times(law.slope(given[i, 0], own[i])[0])

@loop
def each_pressure(law, given, own, out):
    out[:, :] = -1.0

def _zero(x, a, c, own):
    return 0.0

def _state(a, c, own):
    return 0.0, 0.0, 0.0, 0.0, 0.0

def _slope(x, own):
    return own[0] * x, 1.0

def _series(a, c, own):
    return 0.0, 0.0

def _breaks(own):
    return np.empty(0)

_BODY = Body(__name__, _zero, _state, _slope, _series, _breaks)

def main():
    for each in (each_slope, each_pressure):
        out = np.empty((2, 1, 1))
        with ThreadPoolExecutor(2) as pool:
            call = lambda one: each(_BODY.law, np.array([[3.0]]), np.array([[5.0]]), one)
            list(pool.map(call, out))
        print(*set(out.ravel().tolist()))
"""
"""Prints 2 (5 x 3) = 30 and -1.  Two threads call each loop first: one of them compiles it."""


@pytest.fixture(scope="module")
def used(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a small package that has been compiled."""
    folder = tmp_path_factory.mktemp("used")
    small = folder / "small"
    small.mkdir()
    (small / "__init__.py").touch()
    (small / "factor.py").write_text(FACTOR)
    (small / "solver.py").write_text(SOLVER)
    (small / "inverse.py").write_text(INVERSE)
    for name in ("body", "kernels"):
        shutil.copy(ROOT / "generated" / "runtime" / f"{name}.py", small)
    assert solved(folder) == (["30.0", "-1.0"], [COMPILING])
    return folder


def solved(path: Path) -> tuple[list[str], list[str]]:
    """What the package at a path prints, and the lines on standard error, which is a pipe."""
    order = f"import sys; sys.path.insert(0, {str(path)!r}); import small.solver as s; s.main()"
    done = python(order, NUMBA_CACHE_DIR="")
    assert done.returncode == 0, done.stderr
    return done.stdout.split(), done.stderr.splitlines()


@pytest.fixture
def copy(used: Path, tmp_path: Path) -> Path:
    """A copy of that folder with the times of its files."""
    return shutil.copytree(used, tmp_path / "copy", copy_function=shutil.copy2)


# ------------------------------------------------------------------ on disk


@compiled
def test_a_source_that_is_replaced_by_an_older_file_is_noticed(copy: Path) -> None:
    """By the kernels in other files that call it, too."""
    path = copy / "small" / "factor.py"
    then = path.stat().st_mtime - 1e6
    path.write_text(FACTOR.replace("2.0", "4.0"))
    os.utime(path, (then, then))
    assert solved(copy) == (["60.0", "-1.0"], [COMPILING])


@compiled
@pytest.mark.enough("truncated")
@pytest.mark.parametrize("swapped", [False, True], ids=["truncated", "swapped"])
def test_damaged_kernels_on_disk_are_compiled_anew_once(copy: Path, swapped: bool) -> None:
    """One is empty and the index of the other ends halfway; or each is in the file of the other."""
    kept = copy / "small" / "__pycache__"
    (one,), (other,) = (kept.glob(f"solver.each_{name}-*.nbc") for name in ("slope", "pressure"))
    (index,) = kept.glob("solver.each_pressure-*.nbi")
    if swapped:
        one.rename(kept / "aside")
        other.rename(one)
        (kept / "aside").rename(other)
    else:
        one.write_bytes(b"")
        index.write_bytes(index.read_bytes()[:99])
    assert solved(copy) == (["30.0", "-1.0"], [DAMAGED, COMPILING])
    assert solved(copy) == (["30.0", "-1.0"], [])  # what is loaded is not told


@compiled
def test_a_package_in_an_archive_is_compiled_in_every_process(copy: Path) -> None:
    shutil.rmtree(copy / "small" / "__pycache__")
    archive = Path(shutil.make_archive(str(copy / "packed"), "zip", copy))
    values, (line,) = solved(archive)
    assert values == ["30.0", "-1.0"] and "once per process" in line


def test_loops_bodies_and_functions_are_pickled_by_name() -> None:
    """As processes of a cluster send them."""
    for held in (each_contact, hyperbola._BODY, hyperbola.contact, wedge.stick_zone):
        sent = pickle.dumps(held)
        assert pickle.loads(sent) is held and len(sent) < 100


# ------------------------------------------------------------------ without numba

PLAIN = """
import sys
sys.modules["numba"] = None
from generated import hertz
from generated.runtime import kernels
from generated.runtime.forward import each_contact
assert not kernels.COMPILED
here = hertz.Contact(1.0, 1.0, 0.0)
zone = hertz.stick_zone(here, here, 0.1, 0.0, f=0.5, E_star=4.0, R=1.0)
print(repr(float(zone.m)))
"""


def test_without_numba_the_same_text_runs_as_python() -> None:
    """Cattaneo: b = a sqrt(1 - dQ/(2 f P)), P = pi E* a**2/(4 R) = pi."""
    done = python("-W", "error", "-c", PLAIN)
    assert float(done.stdout) == pytest.approx(np.sqrt(1 - 0.1 / np.pi), rel=1e-14), done.stderr


@compiled
def test_kernels_are_compiled_where_derive_is_imported() -> None:
    """Only its commands run them as plain Python."""
    order = "import derive, derive.pipeline\nfrom generated.runtime import kernels\n"
    assert python(f"{order}print(kernels.COMPILED)").stdout == "True\n"
