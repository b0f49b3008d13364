"""Errors of the series of the slip zones, compared with the exact conditions."""

from collections.abc import Sequence
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from derive.plot.measure import Array
from derive.plot.style import LINES, canvas


class Errors(NamedTuple):
    """Slip zones and their errors, for the left and the right edge along the first axis.

    Attributes
    ----------
    size : ndarray, shape (2, ...)
        The size of the slip zone over the contact width [-].
    relative : dict of ndarray
        The relative error abs(series/exact - 1) of each order, in the shape of `size` [-].
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
    orders: Sequence[int] = (1, 2),
    **constants: float,
) -> Errors:
    """Errors of the series of the slip zones of a body under constant normal loads.

    Parameters
    ----------
    body : module
        A generated module, such as generated.wedge.
    state : Contact
        The contact under the normal loads, as returned by `contact`.
    dQ, dsigma : array_like
        Changes in the shear load [N/m] and in the tension [Pa] over the half-cycle.
    f : float
        Coefficient of friction [-].
    orders : sequence of int, optional
        Orders of the series.
    **constants : float
        E_star [Pa] and the parameters of the body.

    Returns
    -------
    Errors
        NaN where the stick zone is not known.

    Raises
    ------
    TypeError
        If `state` is not a Contact, or another argument is not a number or an array of numbers.
    ValueError
        If an order is not 1, 2 or 3, or the shapes of the arguments do not broadcast.
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
    orders: Sequence[int] = (1, 2),
    axes: Axes | None = None,
    **constants: float,
) -> Axes:
    """Draw the relative errors of the series against the size of the slip zone on log-log axes.

    Filled markers are for the left edge, and open markers for the right edge.

    Parameters
    ----------
    body, state, dQ, dsigma, f, orders, **constants : as in `relative_errors`
    axes : Axes, optional
        The Axes to draw into; new ones by default.

    Returns
    -------
    Axes
        The Axes with the picture.
    """
    computed = relative_errors(body, state, dQ, dsigma, f=f, orders=orders, **constants)
    with canvas(axes, size=(5.6, 3.8)) as axes:
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
