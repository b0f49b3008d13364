"""Stick zones on elements: that of a load step, and the permanent one of a cycle."""

import math

import numpy as np

from ..types import Array
from .elements import Elements


def runs(marked: Array) -> Array:
    """The first and the last index of each run of marked elements, one row for each run."""
    turns = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]])))
    return turns.reshape(-1, 2) - [0, 1]


def sticking(
    mesh: Elements, shear: Array, bound: Array, status: Array, a: float, c: float
) -> tuple[float, float, int, float]:
    """m, n, the number of stick intervals, and an error of m and n, in a load step.

    A single element that sticks counts as an interval only if no interval is longer.  A stick-slip
    boundary lies between the middles of two elements; the error is half of this distance, or a
    whole element next to an edge, where the mesh does not resolve a slip zone.
    """
    sticks = (bound > 0) & (status == 0)
    intervals = runs(sticks)
    longer = intervals[intervals[:, 0] < intervals[:, 1]]
    intervals = longer if len(longer) else intervals[:1]
    if not len(intervals):
        return math.nan, math.nan, 0, 0.0
    x, w, ends, error = mesh.middles, mesh.widths, [], 0.0
    for last, side, edge in ((intervals[0, 0], -1, -a), (intervals[-1, 1], 1, c)):
        beyond, near, far = last + side, last - 2 * side, last - 4 * side
        if not 0 <= beyond < x.size or bound[beyond] == 0:
            ends.append(edge)
            error = max(error, w[last])
            continue
        end = mesh.ends[max(last, beyond)]
        if 0 <= far < x.size and sticks[near] and sticks[far]:
            # f p - |q| rises like the square root of the distance from the end
            g, G = ((bound - status[beyond] * shear)[[near, far]]) ** 2
            end = x[near] + (x[near] - x[far]) * g / (G - g) if g < G else end
        low, high = sorted((x[last], x[beyond]))
        ends.append(min(max(end, low, -a), high, c))
        error = max(error, (high - low) / 2)
    return -ends[0], ends[1], len(intervals), error


def permanent(
    mesh: Elements, slip: Array, sticks: Array, always: Array
) -> tuple[float, float, float]:
    """m, n and an error of both, in a cycle; NaN if there is no zone.

    slip: slip in the cycle, forward plus backward.
    sticks: whether the slip of the elements counts as zero.
    always: whether they are always in contact.

    The zone is the longest run of elements that stick.  Its ends are extrapolated to zero
    slip, because slip rises from there as the power 3/2 of the distance.  Of the two points for the
    extrapolation, the outer one slips at least four times as far.  The error is half an element.
    """
    x = mesh.middles
    zones = runs(always & sticks)
    zones = zones[zones[:, 0] < zones[:, 1]]
    if not len(zones):
        return math.nan, math.nan, math.nan
    zone = zones[np.argmax(mesh.ends[zones[:, 1] + 1] - mesh.ends[zones[:, 0]])]
    ends, middle = [], np.mean(x[zone])
    for last, side in zip(zone, (-1, 1), strict=True):
        near, far = last + 2 * side, last + 3 * side
        while 0 <= far + side < x.size and slip[far] < 4 * slip[near]:
            far += side
        end = mesh.ends[max(last, last + side)]
        if 0 <= far < x.size and always[near] and always[far]:
            g, G = slip[[near, far]] ** (2 / 3)
            if g < G:
                low, high = sorted((middle, x[near]))
                end = min(max(x[near] - (x[far] - x[near]) * g / (G - g), low), high)
        ends.append(end)
    return -ends[0], ends[1], np.max(mesh.widths[zone]) / 2
