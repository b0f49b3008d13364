"""The stick zone under moderate tension, and the tensions that leave no slip zone at one edge.

The stick zone is the contact at the mean load less dQ/(2 f) and the mean tilt less dsigma/(4 f),
for E* = 1.
"""

import math
from typing import Any

from ..inverse import contact_at_tilt
from ..kernels import LAW, kernel, matrix, real, results, vector, whole
from .newton import EPS, narrowed

A, C, TILT, LOAD, MOMENT = range(5)
"""Columns of a matrix of contacts."""

FACTOR = 8.0
"""Factor by which a width is changed until it is bracketed."""

STEPS = 100
"""Largest number of steps until a width is bracketed and found."""


@kernel(results(2)(LAW, vector, matrix, whole, whole, real, vector))
def patch(law: Any, own: Any, path: Any, one: int, other: int, part: float, cycle: Any) -> Any:
    """m and n once a fraction `part` of the change in shear has been applied.

    one, other: the rows of `path` with the contacts at the start and at the end.
    """
    load = (path[one, LOAD] + path[other, LOAD]) / 2 - part * cycle[4] / (2 * cycle[6])
    tilt = (path[one, TILT] + path[other, TILT]) / 2 - part * cycle[5] / (4 * cycle[6])
    return contact_at_tilt(law, own, load, tilt)


@kernel(results(3)(LAW, vector, real, real, real))
def _keeping(law: Any, own: Any, edge: float, width: float, side: float) -> Any:
    """Load, its derivative with respect to the width, and tilt of a contact whose left or right
    edge is fixed."""
    a, c = (edge, width - edge) if side < 0 else (width - edge, edge)
    load, _, tilt, K_left, K_right = law.state(a, c, own)
    if not load > 0:
        return 0.0, 0.0, math.nan
    return load, math.pi / 4 * math.sqrt(width) * (K_right if side < 0 else K_left), tilt


@kernel(real(LAW, vector, real, real, real, real))
def _width_under(law: Any, own: Any, load: float, edge: float, side: float, width: float) -> Any:
    """Width of the contact under a load with the edge on one side given; NaN if there is none.

    width: the first guess.
    """
    steps = 0
    while _keeping(law, own, edge, width, side)[0] < load and steps < STEPS:
        width, steps = width * FACTOR, steps + 1
    while _keeping(law, own, edge, width / FACTOR, side)[0] > load and steps < STEPS:
        width, steps = width / FACTOR, steps + 1
    least = width / FACTOR
    bracket = (least, width, width, width - least)
    for _ in range(STEPS - steps):
        trial = bracket[2]
        now, rate, _ = _keeping(law, own, edge, trial, side)
        bracket = narrowed(bracket, now - load, rate, 2 * EPS * width)
        if bracket[1] - bracket[0] <= 4 * EPS * width:
            return trial
    return math.nan


@kernel(real(LAW, vector, matrix, vector, real))
def closing(law: Any, own: Any, ends: Any, cycle: Any, side: float) -> Any:
    """The change in tension at which the zone reaches the smaller contact's edge on one side."""
    load = (ends[0, LOAD] + ends[1, LOAD]) / 2 - cycle[4] / (2 * cycle[6])
    if not load > 0:
        return math.nan
    edge = min(ends[0, C], ends[1, C]) if side > 0 else min(ends[0, A], ends[1, A])
    width = max(ends[0, A] + ends[0, C], ends[1, A] + ends[1, C])
    width = _width_under(law, own, load, edge, side, width)
    if not width > 0:
        return math.nan
    now, _, tilt = _keeping(law, own, edge, width, side)
    # next to a kink, rounding error in the position of the other edge changes the tilt: use the
    # missing load to correct it
    tilt += side * 4 * (load - now) / (math.pi * width)
    return 4 * cycle[6] * ((ends[0, TILT] + ends[1, TILT]) / 2 - tilt)
