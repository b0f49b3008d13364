"""Maps of stick and slip: position against time, in a cycle or any history, or a parameter."""

from math import ceil
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from scipy.ndimage import binary_dilation

from derive.plot.given import LARGE, MIXED, MODERATE, positions_of, row, times
from derive.plot.measure import Array, Measure, unit
from derive.plot.style import FORWARD, LINES, REVERSE, STICK, canvas, style

STILL = 1e-9
"""Slip below this fraction of the largest slip is treated as zero."""


def senses(zone: Any, dsigma: Array) -> tuple[Array, Array]:
    """Direction of slip at the left and right edges at the end of the half-cycle that raises Q.

    It is +1 for slip in the direction of a positive dQ, -1 for slip against it, and 0 if there is
    no slip or its direction is not known.  In the mixed regime, slip reverses at one edge: the edge
    at which the tension opposes the shear load.
    """
    regime, negative = np.asarray(zone.regime), np.asarray(dsigma) < 0
    large, mixed = regime == LARGE, (regime == MIXED) & np.isfinite(zone.m)
    left = np.where(negative, np.where(large, -1, 0), 1)
    right = np.where(negative, 1, np.where(large, -1, 0))
    slips = large | mixed
    forward = np.where(regime == MODERATE, 1, 0)
    return np.where(slips, left, forward), np.where(slips, right, forward)


def stick_slip(
    cycle: Any,
    time: Array | None = None,
    *,
    axes: Axes | None = None,
    length: Measure | None = None,
    legend: bool = True,
) -> Axes:
    """Draw stick and slip at the instants of a cycle.

    Parameters
    ----------
    cycle : March
        A result of `march` of a generated module, for one cycle.
    time : array_like, optional
        The time of each instant; equal steps over one cycle by default.
    axes : Axes, optional
        The Axes to draw into; new ones by default.
    length : Measure, optional
        The unit of x; a suitable one by default.
    legend : bool, optional
        Whether to draw a legend.

    Returns
    -------
    Axes
        The Axes with the picture.

    Raises
    ------
    ValueError
        If there is more than one cycle, or the times do not increase.
    """
    a = np.asarray(cycle.a)
    if a.ndim != 1:
        raise ValueError(f"cycle has the shape {a.shape}; give one cycle")
    at = times(time, np.linspace(0, 1, a.size))
    axes = _map(at, cycle, axes, length, legend)
    axes.set_xlabel("$t$  [cycles]" if time is None else "$t$")
    return axes


def regime_in_words(body: ModuleType, zone: Any) -> str:
    """The name of the regime of a stick zone, such as "full stick"."""
    return str(body.Regime(int(zone.regime)).name.lower().replace("_", " "))


def sweep(
    parameter: Array,
    contact: Any,
    zone: Any,
    dsigma: Array,
    *,
    label: str = "",
    axes: Axes | None = None,
    length: Measure | None = None,
    legend: bool = True,
) -> Axes:
    """Draw contact, stick and slip at the end of a half-cycle, against a parameter.

    Parameters
    ----------
    parameter : array_like, shape (n,)
        The values of the parameter.
    contact : Contact
        Contacts at the end of the half-cycle: one for all values, or one for each.
    zone : StickZone
        The stick zone for each value, as returned by `stick_zone`.
    dsigma : array_like
        Change in the tension: one for all values, or one for each [Pa].  Its sign determines the
        direction of slip at each edge.
    label : str, optional
        The label of the axis of the parameter.
    axes, length, legend : as in `stick_slip`

    Returns
    -------
    Axes
        The Axes with the picture.

    Raises
    ------
    ValueError
        If the shapes do not fit, or dsigma is not the one that was given to `stick_zone`.
    """
    at = row("parameter", parameter, increases=False)
    by_sign = np.isin(zone.regime, (LARGE, MIXED)) & (np.asarray(dsigma) == 0)
    if np.any((by_sign | np.isnan(dsigma)) & np.isfinite(zone.m)):
        raise ValueError(
            "dsigma is 0 or NaN for a stick zone under tension, but its sign determines the "
            "direction of slip at each edge; give the dsigma that was given to stick_zone"
        )
    left, right = senses(zone, dsigma)
    given = {"a": contact.a, "c": contact.c, "m": zone.m, "n": zone.n, "regime": zone.regime}
    given |= {"left": left, "right": right}
    zones = SimpleNamespace(**{k: np.broadcast_to(value, at.shape) for k, value in given.items()})
    axes = _map(at, zones, axes, length, legend)
    axes.set_xlabel(label)
    return axes


def slip_map(
    history: Any,
    x: Array,
    time: Array | None = None,
    *,
    axes: Axes | None = None,
    length: Measure | None = None,
    legend: bool = True,
) -> Axes:
    """Draw a map of stick and of the direction of slip, with position over time.

    Each interval between two instants is coloured by its slip, so that any number of stick zones
    can be seen.

    Parameters
    ----------
    history : History
        A result of `history` of a generated module, for one history.
    x : array_like, shape (n,)
        The positions that were given to `history` [m], which must increase; about two hundred
        make a smooth map.
    time : array_like, optional
        The time of each instant, which must increase; 0, 1, 2, ... by default.
    axes, length, legend : as in `stick_slip`

    Returns
    -------
    Axes
        The Axes with the picture.

    Raises
    ------
    ValueError
        If the history does not fit x, has fewer than two instants, or has no contact.
    """
    x, at = positions_of(history, x), times(time, np.arange(np.size(history.a), dtype=float))
    length = length or unit(np.append(history.a, history.c), "m")
    touching = np.isfinite(history.a)
    unknown = touching & ~np.any(np.isfinite(history.slip), axis=1)
    kinds = np.where(touching[1:, None], kinds_of_slip(history), np.nan)
    edges = np.concatenate([[x[0]], (x[1:] + x[:-1]) / 2, [x[-1]]])
    low, high = -length(history.a), length(history.c)
    least, greatest = float(np.nanmin(low)), float(np.nanmax(high))
    margin = 0.03 * (greatest - least)
    with canvas(axes, size=(5.6, 3.6)) as axes:
        colours = ListedColormap([REVERSE, STICK, FORWARD])
        look: dict[str, Any] = {"cmap": colours, "vmin": -1.5, "vmax": 1.5, "rasterized": True}
        axes.pcolormesh(at, length(edges), kinds.T, zorder=0.5, **look)
        for edge, beyond in ((low, least - margin), (high, greatest + margin)):
            axes.fill_between(at, edge, beyond, color="white", linewidth=0, zorder=0.6)
        for name, sense in (("stick", 0), ("forward slip", 1), ("reverse slip", -1)):
            if np.any(kinds == sense):
                axes.fill_between([], [], [], label=name, **AREAS[name])
        if np.any(unknown):
            look = {"where": binary_dilation(unknown), "label": "not known", **AREAS["not known"]}
            axes.fill_between(at, low, high, zorder=0.55, **look)
        axes.set(
            xlabel="instant" if time is None else "$t$", ylim=(least - margin, greatest + margin)
        )
        _finish(axes, at, (low, high), length, legend)
    return axes


def kinds_of_slip(history: Any) -> Array:
    """At each position in each interval between two instants: +1 forward slip, -1 reverse slip,
    0 stick, NaN if it is not known."""
    step = np.diff(history.slip, axis=0)
    most = np.max(np.abs(step), initial=0.0, where=np.isfinite(step))
    return np.where(np.abs(step) > STILL * most, np.sign(step), 0.0 * step)


AREAS: dict[str, Any] = {
    "stick": {"color": STICK, "linewidth": 0},
    "forward slip": {"color": FORWARD, "linewidth": 0},
    "reverse slip": {"color": REVERSE, "linewidth": 0},
    "slip reverses": {"facecolor": "w", "edgecolor": "#999999", "hatch": "...", "linewidth": 0},
    "not known": {"facecolor": "w", "edgecolor": "#bbbbbb", "hatch": "////", "linewidth": 0},
}


def _map(at: Array, zones: Any, axes: Axes | None, length: Measure | None, legend: bool) -> Axes:
    """Draw the areas of stick and slip, and the lines between them.

    zones: contact, stick zone, directions of slip and code of Regime, named as in a March
    """
    length = length or unit(np.append(zones.a, zones.c), "m")
    low, high = -length(zones.a), length(zones.c)
    start, end = -length(zones.m), length(zones.n)
    touching, known = np.isfinite(low), np.isfinite(start)
    areas = [("stick", low, high, touching)]
    for lower, upper, sense in ((low, start, zones.left), (end, high, zones.right)):
        areas += [
            ("forward slip", lower, upper, known & (sense == 1)),
            ("reverse slip", lower, upper, known & (sense == -1)),
            ("slip reverses", lower, upper, known & (sense == 0) & (zones.regime == MIXED)),
        ]
    # the neighbours of unknown values leave no gap next to known ones
    areas.append(("not known", low, high, binary_dilation(touching & ~known)))
    with canvas(axes, size=(5.6, 3.6)) as axes:
        for i, (name, lower, upper, where) in enumerate(areas):
            if np.any(where):
                look = {"where": where, "label": name, "zorder": 0.5 + i / 100, **AREAS[name]}
                axes.fill_between(at, lower, upper, **look)
        boundaries(axes, at, zones, "exact", length=length)
        _finish(axes, at, (low, high), length, legend)
    return axes


def _finish(
    axes: Axes, at: Array, edges: tuple[Array, Array], length: Measure, legend: bool
) -> None:
    """Draw the edges of the contact, and what all maps have."""
    for edge in edges:
        axes.plot(at, edge, color="#555555", linewidth=1.0)
    axes.set(ylabel=length.label("x"), xlim=(at.min(), at.max()))
    axes.grid(False)
    if legend:
        key(axes)


def key(axes: Axes) -> None:
    """Draw the legend of a map above it; call it again after drawing more lines.

    Parameters
    ----------
    axes : Axes
        The Axes of the map.
    """
    handles, labels = axes.get_legend_handles_labels()
    shown = dict(zip(labels, handles, strict=True))  # each name once
    spec = axes.get_subplotspec()
    columns = spec.get_gridspec().ncols if spec else 1
    wide = axes.figure.get_figwidth() / columns  # type: ignore[union-attr]
    rows = ceil(len(shown) / max(2, int(wide / 1.25)))
    with style():
        axes.legend(
            list(shown.values()),
            list(shown),
            loc="lower left",
            bbox_to_anchor=(0, 1.0),
            ncols=ceil(len(shown) / max(rows, 1)),
            borderaxespad=0.2,
            handlelength=1.6,
            handletextpad=0.4,
            columnspacing=1.0,
        )


def boundaries(
    axes: Axes,
    at: Array,
    zones: Any,
    kind: str,
    *,
    length: Measure,
    label: str | None = None,
) -> None:
    """Draw the stick-slip boundaries from another source, as lines over a map.

    Parameters
    ----------
    axes : Axes
        The Axes of the map.
    at : array_like
        The times, or the values of the parameter, on the axis of the map.
    zones : March or StickZone
        The stick zones: a result of `march` or `stick_zone`, or a StickZone of your own.
    kind : str
        The line style: "exact", "printed", "order 1", "order 2" or "solver".
    length : Measure
        The unit of x in the map.
    label : str, optional
        The label in the legend; `kind` by default.

    Raises
    ------
    ValueError
        If the kind is not one of these.
    """
    if kind not in LINES:
        raise ValueError(f"the kind of line {kind!r} is not known; give one of {', '.join(LINES)}")
    left, right = (np.atleast_1d(getattr(zones, edge, 0)) for edge in ("left", "right"))
    turns = np.flatnonzero((np.diff(left) != 0) | (np.diff(right) != 0)) + 1
    at = np.insert(np.asarray(at, dtype=float), turns, np.nan)  # a gap wherever slip turns round
    with style():
        for end, text in ((-length(zones.m), label or kind), (length(zones.n), None)):
            axes.plot(at, np.insert(end, turns, np.nan), label=text, **LINES[kind])
    if axes.get_legend():
        key(axes)
