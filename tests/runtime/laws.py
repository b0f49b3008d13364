"""Bodies for the tests of the runtime: laws of the library, and the laws' parameters.

In:  nothing.
Out: `hertz`, `wedge`, `flat_rounded`, each a `Case`, all parameters 1; the last one is without the
     further coefficients of its pressure, as bodies may be; `solved`, what a loop of a kernel
     finds, with `zone` and `state`.
"""

import math
from types import ModuleType
from typing import NamedTuple

import numpy as np

import generated.flat_rounded
import generated.hertz
import generated.wedge
from generated.runtime.kernels import SIGNATURES, Law, handed, kernel
from generated.runtime.slip.zone import each_stick_zone


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


def solved(loop, case: Case, rows, count=2):
    """What a loop finds, a row of `rows` a case."""
    given = np.ascontiguousarray(np.atleast_2d(rows), dtype=float)
    out = np.empty((len(given), count))
    loop(case.law, given, np.tile(case.own, (len(given), 1)), out)
    return out


def zone(case, *rows):
    return solved(each_stick_zone, case, rows, 3)


def state(case, a, c):
    return case.functions.state(float(a), float(c), case.own)
