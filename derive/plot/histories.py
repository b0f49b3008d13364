"""Any load history: its stick-slip map, shear and slip at chosen instants, work, and a film.

What is drawn is what `history` of a generated module returns, for one history and a row of places.
"""

from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap

from derive.plot.given import demand_row
from derive.plot.measure import Array, Measure, unit
from derive.plot.style import COLOURS, FORWARD, REVERSE, STICK, style, subplots
from derive.plot.tractions import band, key_above, typical
from derive.plot.zones import AREAS, key, widened

STILL = 1e-9
"""Slip below this fraction of the largest counts as none."""

KINDS = {"stick": STICK, "forward slip": FORWARD, "reverse slip": REVERSE}


def _demand_history(history: Any, x: Array) -> None:
    """One history, with shear and slip at the places of a row."""
    if not (hasattr(history, "slip") and hasattr(history, "intervals")):
        raise ValueError(f"history is {history!r:.60}, no History; give what `history` returns")
    if np.ndim(history.a) != 1:
        raise ValueError(
            f"one history is drawn at a time, its instants in one row; got the shape "
            f"{np.shape(history.a)}: choose one of them, as in History(*(v[0] for v in history))"
        )
    demand_row("x", x)
    if np.shape(history.slip) != (np.size(history.a), np.size(x)):
        given = "none" if history.slip is None else f"those of the shape {np.shape(history.slip)}"
        raise ValueError(
            f"shear and slip at the {np.size(x)} places of x are drawn, and history holds {given}: "
            "give the same x to `history`"
        )


def _times(history: Any, time: Array | None) -> Array:
    """Time of every instant; 0, 1, 2, ... unless it is given."""
    at = (
        np.arange(np.size(history.a), dtype=float)
        if time is None
        else np.asarray(time, dtype=float)
    )
    if at.shape != np.shape(history.a):
        raise ValueError(f"{np.size(history.a)} instants need as many times; got {at.shape}")
    return at


def _steps(history: Any) -> Array:
    """How far each place slips in each interval between instants."""
    return np.diff(history.slip, axis=0)


def slip_map(
    history: Any,
    x: Array,
    time: Array | None = None,
    *,
    axes: Axes | None = None,
    length: Measure | None = None,
    legend: bool = True,
) -> Axes:
    """Where the contact sticks and in which direction it slips; position upward, time to the right.

    Each interval between two instants is coloured by its slip, so that any number of
    stick intervals is seen.

    history  what `history` of a generated module returns, for one history
    x        the places that it was given, in one row; some two hundred make a smooth map
    time     of each instant; 0, 1, 2, ... unless it is given
    length   what x is divided by; the unit that suits, unless it is given
    """
    _demand_history(history, x)
    at, x = _times(history, time), np.asarray(x, dtype=float)
    length = length or unit(np.append(history.a, history.c), "m")
    step = _steps(history)
    most = np.max(np.abs(step), initial=0.0, where=np.isfinite(step))
    kind = np.where(step > STILL * most, 1, np.where(step < -STILL * most, 2, 0))
    touching = np.isfinite(history.a)
    known = np.any(np.isfinite(history.slip), axis=1) & touching
    shown = (np.isfinite(step) & touching[1:, None]).T
    middle = (x[1:] + x[:-1]) / 2
    edges = np.concatenate([[x[0]], middle, [x[-1]]])
    low, high = -length(history.a), length(history.c)
    least, greatest = float(np.nanmin(low)), float(np.nanmax(high))
    margin = 0.03 * (greatest - least)
    with style():
        if axes is None:
            _, axes = subplots(size=(5.6, 3.6))
        axes.pcolormesh(
            at,
            length(edges),
            np.ma.masked_array(kind.T, ~shown),
            cmap=ListedColormap(list(KINDS.values())),
            vmin=-0.5,
            vmax=2.5,
            rasterized=True,
            zorder=0.5,
        )
        for border, beyond in ((low, least - margin), (high, greatest + margin)):
            axes.fill_between(at, border, beyond, color="white", linewidth=0, zorder=0.6)
            axes.plot(at, border, color="#555555", linewidth=1.0)
        for number, name in enumerate(KINDS):
            if np.any(shown & (kind == number).T):
                axes.fill_between([], [], [], label=name, **AREAS[name])
        if np.any(touching & ~known):
            where = widened(touching & ~known)
            axes.fill_between(
                at, low, high, where=where, label="not known", zorder=0.55, **AREAS["not known"]
            )
        axes.set(
            xlabel="instant" if time is None else "$t$",
            ylabel=length.label("x"),
            xlim=(at.min(), at.max()),
            ylim=(least - margin, greatest + margin),
        )
        axes.grid(False)
        if legend:
            key(axes)
    return axes


def _bounds(body: ModuleType, history: Any, x: Array, f: float, constants: Any) -> Array:
    """f p at all places and instants; NaN at a corner, where it is infinite."""
    if not f > 0:
        raise ValueError(f"f is {f}; give the coefficient of friction that `history` was given")
    p = body.pressure(np.asarray(x), history.a[:, None], history.c[:, None], **constants)
    return np.where(np.isfinite(p), f * p, np.nan)


def instants(
    body: ModuleType,
    history: Any,
    x: Array,
    at: Sequence[int],
    labels: Sequence[str] = (),
    *,
    f: float,
    axes: Sequence[Axes] | None = None,
    length: Measure | None = None,
    stress: Measure | None = None,
    **constants: float,
) -> Sequence[Axes]:
    """Shear at chosen instants above, within the friction bounds; slip so far below.

    Slip is drawn where the bodies touch at all instants: elsewhere they move freely in between.

    body       a generated module
    history, x as for `slip_map`
    at         numbers of the instants, from 0; -1 is the last one
    labels     what the legend says of each; their numbers, unless they are given
    axes       two Axes, or None for new ones
    length     what x is divided by; the unit that suits, unless it is given
    stress     what shear is divided by
    constants  E_star and the body's own parameters
    """
    _demand_history(history, x)
    x, count = np.asarray(x, dtype=float), np.size(history.a)
    if not len(at) or not all(-count <= i < count for i in at):
        raise ValueError(f"at is {list(at)}; give numbers of instants, of which there are {count}")
    if labels and len(labels) != len(at):
        raise ValueError(f"{len(labels)} labels are given for {len(at)} instants")
    bound = _bounds(body, history, x, f, constants)
    chosen = [bound[i] for i in at]
    touching = (x >= -np.min(history.a)) & (x <= np.min(history.c))
    slip = np.where(touching, history.slip, np.nan)
    length = length or unit(x, "m")
    stress, depth = stress or unit(typical(np.ravel(chosen)), "Pa"), unit(slip, "m")
    with style():
        if axes is None:
            _, axes = subplots(2, 1, size=(5.6, 5.0), sharex=True)
        for number, (i, limit) in enumerate(zip(at, chosen, strict=True)):
            name = labels[number] if labels else f"instant {range(count)[i]}"
            if number == 0 or not np.allclose(limit, chosen[0], equal_nan=True):
                band(axes[0], length(x), stress(limit), "" if number else r"$\pm f\,p$")
            axes[0].plot(length(x), stress(history.q[i]), label=name)
            axes[1].plot(length(x), depth(slip[i]))
        highest = 1.15 * float(np.nanmax(typical(stress(np.ravel(chosen)))))
        axes[0].set(ylabel=stress.label("q"), ylim=(-highest, highest))
        axes[1].set(xlabel=length.label("x"), ylabel=depth.label("s"))
        key_above(axes[0])
    return axes


def friction_work(
    body: ModuleType, history: Any, x: Array, *, f: float, **constants: float
) -> Array:
    """Friction's work at every place, per area [J/m²].

        sum of f (p_1 + p_2)/2 |slip_2 - slip_1| over all intervals between two instants

    That is exact while slip goes one way between two instants and the pressure is constant.
    Arguments are those of `instants`.
    """
    _demand_history(history, x)
    bound = _bounds(body, history, x, f, constants)
    step = np.abs(_steps(history))
    still = step == 0
    return np.sum(np.where(still, 0.0, (bound[1:] + bound[:-1]) / 2 * step), axis=0)


def work(
    body: ModuleType,
    history: Any,
    x: Array,
    *,
    f: float,
    axes: Axes | None = None,
    length: Measure | None = None,
    label: str | None = None,
    **constants: float,
) -> Axes:
    """Friction's work of the whole history along x, as by `friction_work`.

    Arguments are those of `instants`.
    """
    done = friction_work(body, history, x, f=f, **constants)
    length, joule = length or unit(x, "m"), unit(done, "J/m²")
    with style():
        if axes is None:
            _, axes = subplots()
        axes.plot(length(x), joule(done), color=COLOURS["vermilion"], label=label)
        axes.set(xlabel=length.label("x"), ylabel=joule.label("w"), ylim=(0, None))
    return axes


def film(
    body: ModuleType,
    history: Any,
    x: Array,
    time: Array | None = None,
    *,
    f: float,
    interval: float = 100,
    axes: Axes | None = None,
    length: Measure | None = None,
    stress: Measure | None = None,
    **constants: float,
) -> FuncAnimation:
    """A film of the shear within the friction bounds, one frame for each instant.

    Its `save` writes a GIF, `to_jshtml` makes a player for a notebook.

    interval   milliseconds a frame

    Arguments are those of `instants`, and `time` that of `slip_map`.
    """
    _demand_history(history, x)
    at, bound = _times(history, time), _bounds(body, history, x, f, constants)
    length, stress = length or unit(x, "m"), stress or unit(typical(np.ravel(bound)), "Pa")
    place, highest = length(x), 1.15 * float(np.nanmax(typical(stress(np.ravel(bound)))))
    step = np.vstack([np.zeros(np.size(x)), _steps(history)])
    most = np.max(np.abs(step), initial=0.0, where=np.isfinite(step))
    with style():
        if axes is None:
            _, axes = subplots(size=(5.0, 3.0))
        grey: dict[str, Any] = {"color": "#888888", "linewidth": 1}
        (upper,) = axes.plot([], [], label=r"$\pm f\,p$", **grey)
        (lower,) = axes.plot([], [], **grey)
        (shear,) = axes.plot([], [], color=COLOURS["vermilion"], linewidth=2, label="$q$")
        ways = [
            axes.fill_between([], [], [], label=name, zorder=0.5, **AREAS[name])
            for name in ("forward slip", "reverse slip")
        ]
        word = axes.text(0.98, 0.04, "", transform=axes.transAxes, ha="right")
        axes.set(xlabel=length.label("x"), ylabel=stress.label("q"))
        axes.set(xlim=(place.min(), place.max()), ylim=(-highest, highest))
        key_above(axes)

    def draw(i: int) -> list[Any]:
        with style():
            upper.set_data(place, stress(bound[i]))
            lower.set_data(place, -stress(bound[i]))
            shear.set_data(place, stress(history.q[i]))
            for way, sign in zip(ways, (1, -1), strict=True):
                slips = (sign * step[i] > STILL * most) & (bound[i] > 0)
                way.set_data(place, -stress(bound[i]), stress(bound[i]), where=slips)
            word.set_text(f"instant {i}" if time is None else f"$t$ = {at[i]:.3g}")
        return [upper, lower, shear, *ways, word]

    figure: Any = axes.figure
    return FuncAnimation(figure, draw, frames=np.size(history.a), interval=interval, blit=False)
