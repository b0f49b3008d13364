"""Errors of the series of the slip zones, compared with the exact conditions."""

from collections.abc import Sequence
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from derive.plot.measure import Array
from derive.plot.style import LINES, style, subplots


class Errors(NamedTuple):
    """Slip zones and their errors, for the left and the right edge along the first axis.

    size      the size of the slip zone over the contact width
    relative  the relative error |series/exact - 1| of each order
    """

    size: Array
    relative: dict[int, Array]


def relative_errors(
    body: ModuleType,
    state: Any,
    dQ: Array,
    dsigma: Array,
    *,
    f: float,
    orders: Sequence[int] = (1, 2, 3),
    **constants: float,
) -> Errors:
    """Errors of the series of the slip zones of a body under constant normal loads.

    body        a generated module
    state       Contact under the normal loads
    dQ, dsigma  changes in the shear load and in the tension over the half-cycle: numbers or arrays
    f           coefficient of friction
    orders      orders of the series
    constants   E_star and the parameters of the body
    """
    law = {"f": f, **constants}
    zone = body.stick_zone(state, state, dQ, dsigma, **law)
    exact = np.stack(np.broadcast_arrays(state.a - zone.m, state.c - zone.n))
    relative = {}
    for order in orders:
        series = body.slip_zones(state.a, state.c, dQ, dsigma, order=order, **law)
        with np.errstate(all="ignore"):
            relative[order] = np.abs(np.stack(np.broadcast_arrays(*series)) / exact - 1)
    return Errors(exact / (state.a + state.c), relative)


def errors(
    body: ModuleType,
    state: Any,
    dQ: Array,
    dsigma: Array,
    *,
    f: float,
    orders: Sequence[int] = (1, 2, 3),
    axes: Axes | None = None,
    **constants: float,
) -> Axes:
    """Draw the relative errors of the series over the size of the slip zone, on logarithmic axes.

    Filled markers are for the left edge, and open markers for the right edge.  For the arguments,
    see `relative_errors`.
    """
    computed = relative_errors(body, state, dQ, dsigma, f=f, orders=orders, **constants)
    with style():
        if axes is None:
            _, axes = subplots(size=(5.6, 3.8))
        for order, relative in computed.relative.items():
            for edge, marker, fill in ((0, "o", "full"), (1, "s", "none")):
                look = {**LINES[f"order {order}"], "linewidth": 1.2}
                label = f"order {order}, {'left' if edge == 0 else 'right'}"
                nonzero = np.where(relative[edge] > 0, relative[edge], np.nan)
                axes.loglog(
                    np.ravel(computed.size[edge]),
                    np.ravel(nonzero),
                    marker=marker,
                    markersize=4.5,
                    fillstyle=fill,
                    label=label,
                    **look,
                )
        axes.set(
            xlabel="slip zone / contact width,  $d/(a + c)$", ylabel=r"$|d/d_\mathrm{exact} - 1|$"
        )
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return axes
