"""Bodies for the tests of the runtime: laws of the library, and the laws' parameters.

In:  nothing.
Out: `hertz`, `wedge`, `flat_rounded`, each a `Case`, all parameters 1; the last one is without the
     further coefficients of its pressure, as bodies may be.
"""

import math
from types import ModuleType
from typing import NamedTuple

import numpy as np

import generated.flat_rounded
import generated.hertz
import generated.wedge
from generated.runtime.kernels import SIGNATURES, Law, handed, kernel


class Case(NamedTuple):
    """A body: its law as kernels take it, the law's functions, its parameters."""

    law: object
    functions: Law
    own: np.ndarray


def _no_series(a, c, own):
    return math.nan, math.nan, math.nan, math.nan


def _case(module: ModuleType, *own: float, **instead: object) -> Case:
    functions = Law(*(getattr(module, f"_{name}") for name in Law._fields))._replace(**instead)
    compiled = Law(*(kernel(of)(f) for of, f in zip(SIGNATURES, functions, strict=True)))
    return Case(handed(compiled), compiled, np.array(own))


hertz = _case(generated.hertz, 1.0)
wedge = _case(generated.wedge, 1.0)
flat_rounded = _case(generated.flat_rounded, 1.0, 1.0, series=_no_series)
