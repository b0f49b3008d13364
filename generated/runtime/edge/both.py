"""Both edges of one contact, given by their coefficients: the conditions of ../slip/series.py."""

import math
from typing import Any

from ..kernels import loop
from ..slip.series import Edge, beside_edges


@loop
def each_pair(given: Any, out: Any) -> None:
    """h, f, both K_T, both displacements, four pressures K, L -> the slip zone, to both orders.

    The pressures now at this edge and at the other one come first, then those at the other end of
    the half-cycle.
    """
    for i in range(given.shape[0]):
        row = given[i]
        h, f, drive = row[0], row[1], math.pi * math.sqrt(row[0])
        out[i, :] = math.nan
        if not (h > 0 and f > 0 and row[6] > 0 and row[8] > 0):
            continue
        kappa, kappa_2 = -f if row[2] < 0 else f, -f if row[3] < 0 else f
        one = Edge(row[6], row[7], row[10], row[11], kappa, row[4], drive * row[2])
        two = Edge(row[8], row[9], row[12], row[13], kappa_2, row[5], drive * row[3])
        for order in range(1, 3):
            out[i, order - 1], _ = beside_edges(one, two, h, order)
