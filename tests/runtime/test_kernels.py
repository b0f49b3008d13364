"""What kernels are made of: compiled for one signature, handed a body by its addresses."""

import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from generated.runtime.kernels import COMPILED, LAW, LOOP, Law, handed, kernel, opened, real, vector
from tests.runtime import laws

ROOT = Path(__file__).parents[2]
compiled = pytest.mark.skipif(not COMPILED, reason="numba does not compile here")


@kernel(real(LAW, real, real, vector))
def _mean_pressure(law: Any, a: Any, c: Any, own: Any) -> Any:
    return law.state(a, c, own)[0] / (a + c) + 0 * law.pressure(0.5, a, c, own)


@kernel(LOOP)
def _each_pressure(law: Any, given: Any, own: Any, out: Any) -> None:
    law = opened(law)
    for i in range(given.shape[0]):
        out[i, 0] = _mean_pressure(law, given[i, 0], given[i, 1], own[i])
        out[i, 1] = law.slope(given[i, 0], own[i])[0]
        out[i, 2] = law.series(given[i, 0], given[i, 1], own[i])[2]
        out[i, 3] = law.breaks(own[i]).size


@pytest.mark.parametrize("case", [laws.hertz, laws.wedge, laws.flat_rounded])
def test_a_law_arrives_as_it_was_handed_over(case: laws.Case) -> None:
    given, out = np.array([[1.5, 1.0], [2.0, 2.5]]), np.empty((2, 4))
    _each_pressure(case.law, given, np.tile(case.own, (2, 1)), out)
    for (a, c), row in zip(given, out, strict=True):
        of = case.functions
        wanted = [of.state(a, c, case.own)[0] / (a + c), of.slope(a, case.own)[0]]
        wanted += [of.series(a, c, case.own)[2], len(of.breaks(case.own))]
        np.testing.assert_allclose(row, wanted, rtol=1e-15)


@compiled
def test_a_kernel_takes_one_signature_alone() -> None:
    with pytest.raises(TypeError, match="No matching definition"):
        _mean_pressure(1.0, "a", 1.0, np.zeros(1))


@compiled
def test_functions_that_are_no_kernels_are_compiled_when_they_are_handed_over() -> None:
    """As those of a generated module are."""
    plain = Law(*(getattr(function, "py_func", function) for function in laws.hertz.functions))
    law, out = handed(plain), np.empty((1, 4))
    _each_pressure(law, np.array([[1.5, 1.0]]), laws.hertz.own[None], out)
    load = laws.hertz.functions.state(1.5, 1.0, laws.hertz.own)[0]
    assert math.isclose(out[0, 0], load / 2.5, rel_tol=1e-15)


WITHOUT_NUMBA = """
import sys
sys.modules["numba"] = None
from generated.runtime import kernels
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
