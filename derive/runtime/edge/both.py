"""Both edges of one contact, given by their coefficients: the conditions of ../slip/series.py."""

import math

from ..kernels import kernel, matrix, nothing, real
from ..slip.series import Series, beside_edges
from ..types import Array


@kernel(nothing(matrix, real, matrix))
def each_pair(given: Array, order: Array, out: Array) -> None:
    """Slip zone of the first edge, for rows of h, f, both K_T, both displacements, and pressures.

    The current pressures at the first and at the other edge come first, followed by those at the
    other end of the half-cycle.
    """
    for i in range(given.shape[0]):
        row = given[i]
        h, f, K_T, K_T_2, da, dc = row[0], row[1], row[2], row[3], row[4], row[5]
        out[i, 0] = math.nan
        if not (h > 0 and f > 0 and row[6] > 0 and row[9] > 0):
            continue
        root = math.sqrt(h)
        of = Series(
            h - max(da, 0.0) - max(dc, 0.0),
            math.pi * root * (K_T + K_T_2) / 2,
            4 * (K_T - K_T_2) / root,
            -f if K_T < 0 else f,
            -f if K_T_2 < 0 else f,
            da,
            dc,
            (row[6], row[7], row[8]),
            (row[9], row[10], row[11]),
            (row[12], row[13], row[14]),
            (row[15], row[16], row[17]),
        )
        drive, drive_2 = math.pi * root * K_T, math.pi * root * K_T_2
        out[i, 0], _ = beside_edges(of, f, h, drive, drive_2, int(order))
