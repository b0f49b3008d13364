"""Errors of the series of the slip zones against the exact conditions."""

from collections.abc import Sequence
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from derive.plot.measure import Array
from derive.plot.style import LINES, style, subplots


class Errors(NamedTuple):
    """Slip zones and their errors, as (left, right) along the first axis.

    size      slip zone over the contact's width
    relative  of each order, |series/exact - 1|
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
    """Errors of the series of a body's slip zones under constant normal loads.

    body        a generated module
    state       Contact of the normal loads
    dQ, dsigma  cycles: each a number or an array
    constants   E_star and the body's own parameters
    """
    law = {"f": f, **constants}
    zone = body.stick_zone(state, state, dQ, dsigma, **law)
    exact = np.stack(np.broadcast_arrays(state.a - zone.m, state.c - zone.n))
    found = {}
    for order in orders:
        series = body.slip_zones(state.a, state.c, dQ, dsigma, order=order, **law)
        with np.errstate(all="ignore"):
            found[order] = np.abs(np.stack(np.broadcast_arrays(*series)) / exact - 1)
    return Errors(exact / (state.a + state.c), found)


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
    """Relative errors of the series against the size of the slip zone, both logarithmic.

    Filled marks are for the left edge, open ones for the right.  Arguments are those of
    `relative_errors`.
    """
    found = relative_errors(body, state, dQ, dsigma, f=f, orders=orders, **constants)
    with style():
        if axes is None:
            _, axes = subplots(size=(5.6, 3.8))
        for order, relative in found.relative.items():
            for edge, marker, fill in ((0, "o", "full"), (1, "s", "none")):
                look = {**LINES[f"order {order}"], "linewidth": 1.2}
                label = f"order {order}, {'left' if edge == 0 else 'right'}"
                seen = np.where(relative[edge] > 0, relative[edge], np.nan)
                axes.loglog(
                    np.ravel(found.size[edge]),
                    np.ravel(seen),
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
