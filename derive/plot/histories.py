"""Any load history: shear and slip at chosen instants, frictional work and animation.

The pictures show the result of `history` of a generated module, for one history and an array of
positions.
"""

from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes

from derive.plot.given import (
    demand_friction,
    demand_labels,
    demand_numbers,
    positions_of,
    times,
)
from derive.plot.measure import Array, Measure, unit
from derive.plot.style import COLOURS, canvas, style
from derive.plot.tractions import band, note_unknown, peak
from derive.plot.zones import AREAS, key, kinds_of_slip


def _bounds(
    body: ModuleType, history: Any, x: Array, f: float, constants: Any
) -> tuple[Array, Array]:
    """The positions, and f p there at all instants; NaN at a corner, where p is infinite."""
    x = positions_of(history, x)
    demand_numbers(f=f, **constants)
    bound = f * body.pressure(x, history.a[:, None], history.c[:, None], **constants)
    demand_friction(history, x, bound)
    return x, np.where(np.isfinite(bound), bound, np.nan)


def _instants(at: Any, count: int) -> list[int]:
    """The indices of instants, counted from zero."""
    try:
        found = [range(count)[i] for i in at]
    except (TypeError, IndexError):
        found = []
    if not found:
        raise ValueError(
            f"`at` is {at!r:.60}; give a list of at least one index from {-count} to {count - 1}, "
            f"because history has {count} instants"
        )
    return found


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
    """Draw shear traction and friction bounds at chosen instants, with the accumulated slip below.

    Slip is drawn only where the bodies touch at all instants, because they move freely elsewhere.

    Parameters
    ----------
    body : module
        A generated module, such as generated.wedge.
    history : History
        A result of `history` of a generated module, for one history.
    x : array_like, shape (n,)
        The positions that were given to `history` [m], which must increase.
    at : sequence of int
        Indices of the instants, starting at 0; -1 is the last one.
    labels : sequence of str, optional
        Labels of the instants in the legend; their indices by default.
    f : float
        Coefficient of friction, as given to `history` [-].
    axes : sequence of two Axes, optional
        The Axes to draw into; new ones by default.
    length : Measure, optional
        The unit of x; a suitable one by default.
    stress : Measure, optional
        The unit of the shear traction; a suitable one by default.
    **constants : float
        E_star [Pa] and the parameters of the body.

    Returns
    -------
    sequence of Axes
        The two Axes with the pictures.

    Raises
    ------
    ValueError
        If the history does not fit x, f, the body or the constants; the message says what is wrong.
    """
    x, bound = _bounds(body, history, x, f, constants)
    numbers = _instants(at, np.size(history.a))
    demand_labels(labels, len(numbers), "instants")
    chosen = bound[numbers]
    touching = (x >= -np.min(history.a)) & (x <= np.min(history.c))
    slip = np.where(touching, history.slip, np.nan)
    length = length or unit(x, "m")
    stress, depth = stress or unit(peak(chosen), "Pa"), unit(slip, "m")
    with canvas(axes, 2, size=(5.6, 5.0)) as axes:
        names = list(labels) or [f"instant {i}" for i in numbers]
        for number, (i, name) in enumerate(zip(numbers, names, strict=True)):
            if number == 0 or not np.allclose(bound[i], chosen[0], equal_nan=True):
                band(axes[0], length(x), stress(bound[i]), "" if number else r"$\pm f\,p$")
            axes[0].plot(length(x), stress(history.q[i]), label=name)
            axes[1].plot(length(x), depth(slip[i]))
        note_unknown(axes[0], "shear", names, history.q[numbers])
        note_unknown(axes[1], "slip", names, slip[numbers])
        highest = 1.15 * peak(stress(chosen))
        axes[0].set(ylabel=stress.label("q"), ylim=(-highest, highest))
        axes[1].set(xlabel=length.label("x"), ylabel=depth.label("s"))
        key(axes[0])
    return axes


def friction_work(
    body: ModuleType, history: Any, x: Array, *, f: float, **constants: float
) -> Array:
    """The frictional work per unit area at every position.

        sum of f (p_1 + p_2)/2 |slip_2 - slip_1| over all intervals between two instants

    The sum is exact if, between two instants, slip has one direction and the pressure is constant.

    Parameters
    ----------
    body, history, x, f, **constants : as in `instants`

    Returns
    -------
    ndarray, shape (n,)
        The work [J/m²]; NaN where the slip is not known.
    """
    _, bound = _bounds(body, history, x, f, constants)
    step = np.abs(np.diff(history.slip, axis=0))
    return np.sum(np.where(step == 0, 0.0, (bound[1:] + bound[:-1]) / 2 * step), axis=0)


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
    """Draw the frictional work of the whole history against x; see `friction_work`.

    Parameters
    ----------
    body, history, x, f, length, **constants : as in `instants`
    axes : Axes, optional
        The Axes to draw into; new ones by default.
    label : str, optional
        The label of the curve in a legend.

    Returns
    -------
    Axes
        The Axes with the picture.
    """
    done = friction_work(body, history, x, f=f, **constants)
    length, joule = length or unit(x, "m"), unit(done, "J/m²")
    with canvas(axes) as axes:
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
    """Make an animation of the shear traction and the friction bounds, with one frame per instant.

    Parameters
    ----------
    body, history, x, f, length, stress, **constants : as in `instants`
    time : array_like, optional
        The time of each instant, which must increase; 0, 1, 2, ... by default.
    interval : float, optional
        The duration of a frame [ms].
    axes : Axes, optional
        The Axes to draw into; new ones by default.

    Returns
    -------
    FuncAnimation
        Its method `save` writes a GIF, and `to_jshtml` makes a player for a notebook.
    """
    x, bound = _bounds(body, history, x, f, constants)
    at = times(time, np.arange(np.size(history.a), dtype=float))
    length, stress = length or unit(x, "m"), stress or unit(peak(bound), "Pa")
    position, highest = length(x), 1.15 * peak(stress(bound))
    senses = np.vstack([np.zeros(np.size(x)), kinds_of_slip(history)])
    with canvas(axes, size=(5.0, 3.0)) as axes:
        upper, lower = band(axes, [], np.array([]), r"$\pm f\,p$")
        (shear,) = axes.plot([], [], color=COLOURS["vermilion"], linewidth=2, label="$q$")
        areas = [
            axes.fill_between([], [], [], label=name, zorder=0.5, **AREAS[name])
            for name in ("forward slip", "reverse slip")
        ]
        caption = axes.text(0.98, 0.04, "", transform=axes.transAxes, ha="right")
        axes.set(xlabel=length.label("x"), ylabel=stress.label("q"))
        axes.set(xlim=(position.min(), position.max()), ylim=(-highest, highest))
        key(axes)

    def draw(i: int) -> list[Any]:
        with style():
            upper.set_data(position, stress(bound[i]))
            lower.set_data(position, -stress(bound[i]))
            shear.set_data(position, stress(history.q[i]))
            for area, sense in zip(areas, (1, -1), strict=True):
                slips = (senses[i] == sense) & (bound[i] > 0)
                area.set_data(position, -stress(bound[i]), stress(bound[i]), where=slips)
            name = f"instant {i}" if time is None else f"$t$ = {at[i]:.3g}"
            caption.set_text(name if np.isfinite(history.a[i]) else f"{name}: no contact")
        return [upper, lower, shear, *areas, caption]

    figure: Any = axes.figure
    return FuncAnimation(figure, draw, frames=np.size(history.a), interval=interval, blit=False)
