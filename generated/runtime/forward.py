"""Contacts under given loads, their state, pressure and series, and the breaks of a body.

The state, the pressure and the series are those of bodies without closed formulas for them.
"""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from .inverse import contact, contact_at_tilt
from .kernels import loop, opened

UNIT = {"E_star": 1.0}
"""The modulus for which kernels solve."""


@loop
def each_state(law: Any, given: Any, own: Any, out: Any) -> None:
    """a, c, E* -> load, moment, tilt, K_N; NaN where the contact extends beyond the body."""
    law = opened(law)
    for i in range(given.shape[0]):
        a, c, E_star = given[i, 0], given[i, 1], given[i, 2]
        load, moment, tilt, left, right = law.state(a, c, own[i])
        out[i, :] = math.nan
        if load < math.inf:
            out[i, 0], out[i, 1], out[i, 2] = E_star * load, E_star * moment, tilt
            out[i, 3], out[i, 4] = E_star * left, E_star * right


@loop
def each_pressure(law: Any, given: Any, own: Any, out: Any) -> None:
    """x, a, c, E* -> p."""
    law = opened(law)
    for i in range(given.shape[0]):
        out[i, 0] = given[i, 3] * law.pressure(given[i, 0], given[i, 1], given[i, 2], own[i])


@loop
def each_series(law: Any, given: Any, own: Any, out: Any) -> None:
    """a, c, E* -> coefficients of s**(3/2)."""
    law = opened(law)
    for i in range(given.shape[0]):
        E_star = given[i, 2]
        left, right = law.series(given[i, 0], given[i, 1], own[i])
        out[i, 0], out[i, 1] = E_star * left, E_star * right


@loop
def each_contact(law: Any, given: Any, own: Any, out: Any) -> None:
    """P, M, E* -> a, c, tilt."""
    law = opened(law)
    for i in range(given.shape[0]):
        P, M, E_star = given[i, 0], given[i, 1], given[i, 2]
        out[i, 0], out[i, 1], out[i, 2] = contact(law, own[i], P / E_star, M / E_star)


@loop
def each_contact_at_tilt(law: Any, given: Any, own: Any, out: Any) -> None:
    """P, alpha, E* -> a, c, alpha; NaN where there is no contact."""
    law = opened(law)
    for i in range(given.shape[0]):
        P, alpha, E_star = given[i, 0], given[i, 1], given[i, 2]
        a, c = contact_at_tilt(law, own[i], P / E_star, alpha)
        out[i, 0], out[i, 1], out[i, 2] = a, c, alpha if a == a else math.nan


@loop
def each_break(law: Any, number: Any, own: Any, out: Any) -> None:
    """As many breaks of the curve as `out` has columns, and their number."""
    law = opened(law)
    for i in range(out.shape[0]):
        breaks = law.breaks(own[i])
        number[i, 0] = breaks.size
        for k in range(min(breaks.size, out.shape[1])):
            out[i, k] = breaks[k]


def breaks_of(law: Any, own: Iterable[float]) -> Any:
    """The points where the formula of the curve of a body with these parameters changes."""
    number, parameters = np.zeros((1, 1)), np.array([[*own]], dtype=float)
    each_break(law, number, parameters, np.empty((1, 0)))
    out = np.empty((1, int(number[0, 0])))
    each_break(law, number, parameters, out)
    return out[0]
