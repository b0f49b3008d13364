"""The stick zone under moderate tension.

The stick zone is the contact at the mean load less dQ/(2 f) and the mean tilt less dsigma/(4 f),
for E* = 1.
"""

from typing import Any

from ..inverse import contact_at_tilt
from ..kernels import kernel

A, C, TILT, LOAD, MOMENT = range(5)
"""Columns of a matrix of contacts."""


@kernel
def patch(law: Any, own: Any, path: Any, one: int, other: int, part: float, cycle: Any) -> Any:
    """m and n once a fraction `part` of the change in shear has been applied.

    one, other: the rows of `path` with the contacts at the start and at the end.
    """
    load = (path[one, LOAD] + path[other, LOAD]) / 2 - part * cycle[4] / (2 * cycle[6])
    tilt = (path[one, TILT] + path[other, TILT]) / 2 - part * cycle[5] / (4 * cycle[6])
    return contact_at_tilt(law, own, load, tilt)
