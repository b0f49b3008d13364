"""Contacts under given loads, and their state, pressure and series, case by case.

These are the public functions of bodies without closed formulas for them.
"""

import math
from typing import Any

from .inverse import contact, contact_at_tilt
from .kernels import LOOP, kernel, opened


@kernel(LOOP)
def each_state(law: Any, given: Any, own: Any, out: Any) -> None:
    """Load, moment, tilt and K_N of contacts a, c; NaN where they extend beyond the body."""
    law = opened(law)
    for i in range(given.shape[0]):
        load, moment, tilt, left, right = law.state(given[i, 0], given[i, 1], own[i])
        if load < math.inf:
            out[i, 0], out[i, 1], out[i, 2], out[i, 3], out[i, 4] = load, moment, tilt, left, right
        else:
            out[i, :] = math.nan


@kernel(LOOP)
def each_pressure(law: Any, given: Any, own: Any, out: Any) -> None:
    """Pressure at x in the contacts a, c."""
    law = opened(law)
    for i in range(given.shape[0]):
        out[i, 0] = law.pressure(given[i, 0], given[i, 1], given[i, 2], own[i])


@kernel(LOOP)
def each_series(law: Any, given: Any, own: Any, out: Any) -> None:
    """Coefficients of s**(3/2) and of s**(5/2) for the contacts a, c."""
    law = opened(law)
    for i in range(given.shape[0]):
        left, right, third_left, third_right = law.series(given[i, 0], given[i, 1], own[i])
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = left, right, third_left, third_right


@kernel(LOOP)
def each_contact(law: Any, given: Any, own: Any, out: Any) -> None:
    """Edges a, c and the tilt under loads P and moments M."""
    law = opened(law)
    for i in range(given.shape[0]):
        out[i, 0], out[i, 1], out[i, 2] = contact(law, own[i], given[i, 0], given[i, 1])


@kernel(LOOP)
def each_contact_at_tilt(law: Any, given: Any, own: Any, out: Any) -> None:
    """Edges a, c under loads P at given tilts, and the tilt, NaN where there is no contact."""
    law = opened(law)
    for i in range(given.shape[0]):
        alpha = given[i, 1]
        a, c = contact_at_tilt(law, own[i], given[i, 0], alpha)
        out[i, 0], out[i, 1], out[i, 2] = a, c, alpha if a == a else math.nan
