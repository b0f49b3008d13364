"""Nodes on a line, clustered quadratically towards given breaks."""

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MERGE = 1e-5
"""Breaks closer together than this fraction of the whole width count as one."""


def graded(breaks: Iterable[float], count: int) -> Floats:
    """Nodes with `count` elements between neighbouring breaks, x = mid - (length/2) cos(theta).

    >>> graded([0, 1, 3], 2)
    array([0. , 0.5, 1. , 2. , 3. ])
    """
    ends = merged(breaks)
    t = (1 - np.cos(np.linspace(0, np.pi, count + 1)[:-1])) / 2
    pieces = (left + (right - left) * t for left, right in pairwise(ends))
    return np.concatenate([*pieces, ends[-1:]])


def merged(breaks: Iterable[float]) -> list[float]:
    """The breaks in ascending order, without those that coincide with the one before.

    >>> merged([1, 0, 1 + 1e-9, 2])
    [0.0, 1.0, 2.0]
    """
    ends = sorted(map(float, breaks))
    least = MERGE * (ends[-1] - ends[0])
    kept = ends[:1]
    for end in ends[1:]:
        if end - kept[-1] > least:
            kept.append(end)
    return kept
