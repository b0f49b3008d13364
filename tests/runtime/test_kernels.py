"""What kernels are made of: compiled for one signature, plain Python without numba."""

import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from generated.runtime import kernels
from generated.runtime.body import kernel_of
from generated.runtime.kernels import COMPILED, kernel, real
from generated.runtime.words import COMPILING

ROOT = Path(__file__).parents[2]


@kernel(real(real))
def _half(a: Any) -> Any:
    return a / 2


@pytest.mark.skipif(not COMPILED, reason="numba does not compile here")
def test_a_kernel_takes_one_signature_alone() -> None:
    assert _half(1.0) == 0.5
    with pytest.raises(TypeError, match="No matching definition"):
        _half("a")


@pytest.mark.skipif(not COMPILED, reason="numba does not compile here")
def test_a_line_says_that_a_solver_is_compiled_but_not_that_one_is_loaded(tmp_path: Path) -> None:
    """Once, on standard error, which here is neither a terminal nor Jupyter."""
    for expected in (f"{COMPILING}\n", ""):
        run = subprocess.run(
            [sys.executable, "-c", "import generated.runtime.kernels"],
            capture_output=True,
            text=True,
            env=os.environ | {"PYTHONPATH": str(ROOT), "NUMBA_CACHE_DIR": str(tmp_path)},
        )
        assert (run.returncode, run.stdout, run.stderr) == (0, "", expected)


@pytest.mark.skipif(not COMPILED, reason="numba does not compile here")
def test_each_solver_has_a_line_of_its_own(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for _ in range(2):
        kernel_of.cache_clear()
        kernel_of("forward.each_contact")  # its module has been loaded, so that nothing is compiled
        for _ in range(2):
            kernels._ANNOUNCEMENT.on_start(None)
        assert capsys.readouterr() == ("", f"{COMPILING}\n")
    monkeypatch.setattr(sys, "stderr", None)  # as in a program without a console
    kernels._ANNOUNCEMENT.on_start(None)


WITHOUT_NUMBA = """
import sys
sys.modules["numba"] = None
from generated.runtime import inverse, kernels  # noqa: F401
from generated.runtime.body import kernel_of
from generated import hertz
assert not kernels.COMPILED
here = hertz.Contact(1.0, 1.0, 0.0)
zone = hertz.stick_zone(here, here, 0.1, 0.0, f=0.5, E_star=4.0, R=1.0)
print(repr(float(zone.m)))
"""


def test_without_numba_the_same_text_runs_as_python() -> None:
    """Cattaneo: b = a sqrt(1 - dQ/(2 f P)), P = pi E* a**2/(4 R) = pi."""
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", WITHOUT_NUMBA],
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )
    assert run.returncode == 0, run.stderr
    assert math.isclose(float(run.stdout), math.sqrt(1 - 0.1 / math.pi), rel_tol=1e-14)


LOADED = """
import sys
import numpy as np
from generated import wedge
wedge.contact(np.linspace(1, 2, 3), 0.1, E_star=1.0, phi=0.25)
print(*{name.partition(".")[0] for name in sys.modules} & {"numba", "dask", "scipy", "sympy"})
"""


def test_formulas_load_neither_numba_nor_dask() -> None:
    run = subprocess.run([sys.executable, "-c", LOADED], cwd=ROOT, capture_output=True, text=True)
    assert run.stdout.strip() == "", run.stderr
