"""Both edges of one contact, each by its coefficients: the conditions of ../slip/series.py."""

import math

from ..kernels import kernel, matrix, nothing, real
from ..slip.series import Series, solved
from ..types import Array


@kernel(nothing(matrix, real, matrix))
def each_pair(given: Array, order: Array, out: Array) -> None:
    """Slip zone of the first edge, of rows h, f, both K_T, both moves, and the pressures.

    Pressures now of the first edge and of the other one, then those before.
    """
    for i in range(given.shape[0]):
        row = given[i]
        h, f, K_T, K_T_2, da, dc = row[0], row[1], row[2], row[3], row[4], row[5]
        K, K_2 = row[6], row[9]
        out[i, 0] = math.nan
        if not (h > 0 and f > 0 and K > 0 and K_2 > 0):
            continue
        gain, gain_2 = max(da, 0.0), max(dc, 0.0)
        left = abs(K_T) / (f * K) - abs(da) / 2
        right = abs(K_T_2) / (f * K_2) - abs(dc) / 2
        if order > 1:
            of = Series(
                h - gain - gain_2,
                math.pi * math.sqrt(h) * (K_T + K_T_2) / 2,
                4 * (K_T - K_T_2) / math.sqrt(h),
                -f if K_T < 0 else f,
                -f if K_T_2 < 0 else f,
                da,
                dc,
                (row[6], row[7], row[8]),
                (row[9], row[10], row[11]),
                (row[12], row[13], row[14]),
                (row[15], row[16], row[17]),
            )
            left, right = solved(of, left, right, int(order))
        left, right = left + gain, right + gain_2
        if left >= gain and right >= gain_2 and left + right < h:
            out[i, 0] = left
