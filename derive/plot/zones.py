"""Maps of stick and slip: position upward, time or a parameter to the right."""

from collections.abc import Iterator
from math import ceil
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from derive.plot.given import demand_fitting, demand_row
from derive.plot.measure import Array, Measure, unit
from derive.plot.style import FORWARD, LINES, REVERSE, STICK, style, subplots

MODERATE, LARGE, MIXED = 1, 2, 3
"""Codes of `Regime` in every generated module."""


def senses(zone: Any, dsigma: Array) -> tuple[Array, Array]:
    """Sense of slip at the left and at the right edge at the end of the half-cycle that raises Q.

    +1 in the sense of a positive dQ, -1 against it, 0 none, or none that is known.  In the mixed
    regime slip turns round at the edge that tension does not load.
    """
    regime, back = np.asarray(zone.regime), np.asarray(dsigma) < 0
    large, mixed = regime == LARGE, (regime == MIXED) & np.isfinite(zone.m)
    left = np.where(back, np.where(large, -1, 0), 1)
    right = np.where(back, 1, np.where(large, -1, 0))
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
    """Stick and slip over a cycle, instant by instant.

    cycle   what `march` of a generated module returns, for one cycle
    time    of each instant; equal steps over one cycle, unless it is given
    length  what x is divided by; the unit that suits, unless it is given
    """
    a = np.asarray(cycle.a)
    if a.ndim != 1:
        raise ValueError(
            f"one cycle is drawn at a time, its instants in one row; got the shape {a.shape}: "
            "choose one of them, as in March(*(v[0] for v in cycle))"
        )
    at = np.linspace(0, 1, a.size) if time is None else np.asarray(time, dtype=float)
    if at.shape != a.shape:
        raise ValueError(f"{a.size} instants need as many times; got the shape {at.shape}")
    axes = _map(at, _Zones(*(np.asarray(v) for v in cycle)), axes, length, legend)
    axes.set_xlabel("$t$  [cycles]" if time is None else "$t$")
    return axes


def regime_in_words(body: ModuleType, zone: Any) -> str:
    """How a cycle slips."""
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
    """Contact, stick and slip at the end of a half-cycle, over a parameter.

    parameter  what grows to the right
    contact    Contact at the end of the half-cycle; one for all, or one for each
    zone       StickZone of each, as `stick_zone` returns it
    dsigma     change of tension, one for all or one for each; its sign tells which edge slips
               which way
    label      what stands along the axis
    """
    at = np.asarray(parameter, dtype=float)
    demand_row("parameter", at)
    named = {"contact.a": contact.a, "contact.c": contact.c, "zone.m": zone.m, "zone.n": zone.n}
    demand_fitting(at.shape, dsigma=dsigma, **named)
    _demand_tension(zone, dsigma)
    left, right = senses(zone, dsigma)
    given = contact.a, contact.c, zone.m, zone.n, left, right, zone.regime
    zones = _Zones(*(np.broadcast_to(value, at.shape) for value in given))
    axes = _map(at, zones, axes, length, legend)
    axes.set_xlabel(label)
    return axes


def _demand_tension(zone: Any, dsigma: Array) -> None:
    """Without tension no edge slips against the other, and its sign decides which one does."""
    regime, none = np.asarray(zone.regime), np.asarray(dsigma) == 0
    if np.any(np.isnan(dsigma) & np.isfinite(zone.m)):
        raise ValueError(
            "dsigma is NaN where a stick zone is known: give the dsigma that stick_zone was given"
        )
    wrong = ((regime == LARGE) | ((regime == MIXED) & np.isfinite(zone.m))) & none
    if np.any(wrong):
        name = "large" if np.any(wrong & (regime == LARGE)) else "mixed"
        raise ValueError(
            f"dsigma is 0 where the regime is {name}, and there its sign tells which edge slips "
            "which way: give the dsigma that stick_zone was given"
        )


class _Zones(NamedTuple):
    """Contact, stick zone and senses of slip at every place along an axis; codes of Regime."""

    a: Array
    c: Array
    m: Array
    n: Array
    left: Array
    right: Array
    regime: Array


AREAS: dict[str, Any] = {
    "stick": {"color": STICK, "linewidth": 0},
    "forward slip": {"color": FORWARD, "linewidth": 0},
    "reverse slip": {"color": REVERSE, "linewidth": 0},
    "slip turns round": {"facecolor": "w", "edgecolor": "#999999", "hatch": "...", "linewidth": 0},
    "not known": {"facecolor": "w", "edgecolor": "#bbbbbb", "hatch": "////", "linewidth": 0},
}


def _map(at: Array, zones: _Zones, axes: Axes | None, length: Measure | None, legend: bool) -> Axes:
    """Areas of stick and slip, and their borders."""
    length = length or unit(np.append(zones.a, zones.c), "m")
    low, high = -length(zones.a), length(zones.c)
    start, end = -length(zones.m), length(zones.n)
    with style():
        if axes is None:
            _, axes = subplots(size=(5.6, 3.6))
        labels = set()
        for i, (name, edges, where) in enumerate(_areas(zones, low, high, start, end)):
            look = {**AREAS[name], "label": None if name in labels else name}
            axes.fill_between(at, *edges, where=where, zorder=0.5 + i / 100, **look)
            labels.add(name)
        for edge in (low, high):
            axes.plot(at, edge, color="#555555", linewidth=1.0)
        for edge, label in ((start, "exact"), (end, None)):
            broken = _broken(at, edge, (zones.left, zones.right))
            axes.plot(*broken, label=label, **LINES["exact"])
        axes.set(ylabel=length.label("x"), xlim=(at.min(), at.max()))
        axes.grid(False)
        if legend:
            key(axes)
    return axes


def _areas(
    zones: _Zones, low: Array, high: Array, start: Array, end: Array
) -> Iterator[tuple[str, tuple[Array, Array], Array]]:
    """An area to fill: its name, the lines between which it lies, and where along the axis."""
    there = np.isfinite(low) & np.isfinite(high)
    known = np.isfinite(start) & np.isfinite(end)
    yield "stick", (low, high), there
    for edges, way in (((low, start), zones.left), ((end, high), zones.right)):
        turns = known & (way == 0) & (zones.regime == MIXED)
        for name, where in (
            ("forward slip", known & (way == 1)),
            ("reverse slip", known & (way == -1)),
            ("slip turns round", turns),
        ):
            if np.any(where):
                yield name, edges, where
    if np.any(there & ~known):
        yield "not known", (low, high), widened(there & ~known)


def widened(unknown: Array) -> Array:
    """Extended by one neighbour on either side, so that no gap is left next to known values."""
    wide = unknown.copy()
    wide[1:] |= unknown[:-1]
    wide[:-1] |= unknown[1:]
    return wide


def key(axes: Axes) -> None:
    """The legend of a map, above it and beside no line: its areas, and the lines drawn since."""
    handles, labels = axes.get_legend_handles_labels()
    spec = axes.get_subplotspec()
    columns = spec.get_gridspec().ncols if spec else 1
    wide = axes.figure.get_figwidth() / columns  # type: ignore[union-attr]
    rows = ceil(len(labels) / max(2, int(wide / 1.25)))
    with style():
        axes.legend(
            handles,
            labels,
            loc="lower left",
            bbox_to_anchor=(0, 1.0),
            ncols=ceil(len(labels) / max(rows, 1)),
            borderaxespad=0.2,
            handlelength=1.6,
            handletextpad=0.4,
            columnspacing=1.0,
        )


def _broken(at: Array, values: Array, sense: tuple[Array, Array]) -> tuple[Array, Array]:
    """A line with a gap wherever slip restarts in the other sense."""
    turns = [np.flatnonzero(np.diff(np.atleast_1d(way)) != 0) + 1 for way in sense]
    gaps = np.unique(np.concatenate(turns))
    return np.insert(at, gaps, np.nan), np.insert(values, gaps, np.nan)


def boundaries(
    axes: Axes,
    at: Array,
    zones: Any,
    kind: str,
    *,
    length: Measure,
    label: str | None = None,
) -> None:
    """Both ends of a stick zone from another source, as lines over a map.

    at      what stands along the map: times, or values of the parameter
    zones   what has m and n: of `march`, of `stick_zone`, or a StickZone of one's own
    kind    which look they have: "exact", "printed", "order 1", "order 2", "order 3", "solver"
    length  what the map's x is divided by
    label   what a legend says of them; the kind, unless it is given
    """
    if kind not in LINES:
        raise ValueError(f"no look is known for {kind!r}: give one of {', '.join(LINES)}")
    sense = getattr(zones, "left", 0), getattr(zones, "right", 0)
    with style():
        for end, text in ((-length(zones.m), label or kind), (length(zones.n), None)):
            axes.plot(*_broken(np.asarray(at), end, sense), label=text, **LINES[kind])
    if axes.get_legend():
        key(axes)
