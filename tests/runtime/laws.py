"""Bodies for the tests of the runtime, whose parameters are all 1.

In:  nothing.
Out: `hertz`, `wedge`, `flat_rounded`, each a `Case`; `solved`, what a loop finds, with `zone` and
     `state`; `plain`, a kernel as Python.
"""

from typing import Any, NamedTuple

import numpy as np

import generated.flat_rounded
import generated.hertz
import generated.wedge
from generated.runtime.body import Body
from generated.runtime.kernels import Law
from generated.runtime.slip.zone import each_stick_zone


class Case(NamedTuple):
    """A body and its parameters."""

    body: Body
    own: np.ndarray

    @property
    def law(self) -> Any:
        """The law as loops take it."""
        return self.body.law

    @property
    def functions(self) -> Law:
        """The functions of the law as Python."""
        return self.body.functions


hertz = Case(generated.hertz._BODY, np.ones(1))
wedge = Case(generated.wedge._BODY, np.ones(1))
flat_rounded = Case(generated.flat_rounded._BODY, np.ones(2))


def solved(loop, case: Case, rows, count=2):
    """What a loop finds, a row of `rows` a case."""
    given = np.ascontiguousarray(np.atleast_2d(rows), dtype=float)
    out = np.empty((len(given), count))
    loop(case.law, given, np.tile(case.own, (len(given), 1)), out)
    return out


def plain(kernel):
    """A kernel as Python: a compiled one cannot be called from Python."""
    return getattr(kernel, "py_func", kernel)


def zone(case, *rows):
    """The stick zones of rows of a_1, c_1, a_2, c_2, dQ, dsigma and f."""
    return solved(each_stick_zone, case, [(*row, 1.0) for row in rows], 3)


def state(case, a, c):
    with np.errstate(all="ignore"):
        return case.functions.state(float(a), float(c), case.own)
