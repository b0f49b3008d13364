"""Any load history: its stick-slip map, shear and slip at chosen instants, work and animation.

The pictures show the result of `history` of a generated module, for one history and an array of
positions.
"""

from collections.abc import Sequence
from itertools import compress
from types import ModuleType
from typing import Any

import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap

from derive.plot.given import demand_increasing, demand_numbers, demand_row, times
from derive.plot.measure import Array, Measure, unit
from derive.plot.style import COLOURS, FORWARD, REVERSE, STICK, style, subplots
from derive.plot.tractions import band, key_above, typical
from derive.plot.zones import AREAS, key, widened

STILL = 1e-9
"""Slip below this fraction of the largest slip is treated as zero."""

ROUNDING = 1e-6
"""Allowance for rounding: of an edge relative to the contact width, of shear relative to f p."""

SHORT = 1e-3
"""If shear falls short of f p by more than this fraction wherever the surfaces slip, it does not
belong to this f p."""

KINDS = {"stick": STICK, "forward slip": FORWARD, "reverse slip": REVERSE}


def _positions(history: Any, x: Array) -> Array:
    """The positions x; demand one history with shear and slip at these positions."""
    if not (hasattr(history, "slip") and hasattr(history, "intervals")):
        raise ValueError(
            f"history is {history!r:.60}, which is not a History; give a result of `history`"
        )
    if np.ndim(history.a) != 1:
        raise ValueError(
            f"history has the shape {np.shape(history.a)}, but only one history can be drawn; "
            "select one of them, for example by History(*(v[0] for v in history))"
        )
    if not np.any(np.isfinite(history.a)):
        raise ValueError("history has no contact at any instant, so that there is nothing to draw")
    demand_row("x", x)
    if np.shape(history.slip) != (np.size(history.a), np.size(x)):
        shape = np.shape(history.slip)
        given = "no slip" if history.slip is None else f"slip of shape {shape}"
        raise ValueError(
            f"history contains {given}, but slip at the {np.size(x)} positions of x is needed; "
            "give the same x to `history`"
        )
    x = np.asarray(x, dtype=float)
    demand_increasing("x", x, "sort x, for example by np.unique(x), and give it to `history` again")
    _demand_same(history, x)
    return x


def _demand_same(history: Any, x: Array) -> None:
    """Demand no shear outside the contact, and slip at all points in it if there is any."""
    a, c = history.a[:, None], history.c[:, None]
    depth = np.minimum(x + a, c - x) / (a + c)
    shear = (depth < -ROUNDING) & (np.abs(history.q) > 0)
    known = np.isfinite(history.slip)
    wrong = shear | ((depth > ROUNDING) & ~known & np.any(known, axis=1, keepdims=True))
    for i, j in np.argwhere(wrong)[:1]:
        where, what = ("outside", "shear") if shear[i, j] else ("inside", "no slip")
        raise ValueError(
            f"x is not the x of history: at instant {i}, {x[j]:g} m is {where} the contact, but "
            f"history contains {what} there; give the same x to `history`"
        )


def _times(history: Any, time: Array | None) -> Array:
    """The time of every instant; 0, 1, 2, ... by default."""
    return times(time, np.arange(np.size(history.a), dtype=float))


def _steps(history: Any) -> Array:
    """The slip at each position in each interval between two instants."""
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
        If the history does not fit x, has fewer than two instants, or has no contact.
    """
    x, at = _positions(history, x), _times(history, time)
    if at.size < 2:
        raise ValueError(
            "history has one instant, but a map shows the slip between instants; give a history "
            "of at least two instants"
        )
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
        for edge, beyond in ((low, least - margin), (high, greatest + margin)):
            axes.fill_between(at, edge, beyond, color="white", linewidth=0, zorder=0.6)
            axes.plot(at, edge, color="#555555", linewidth=1.0)
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
    """f p at all positions and instants; NaN at a corner, where p is infinite."""
    demand_numbers("but one history has one value; give a finite number", f=f, **constants)
    if not f > 0:
        raise ValueError(
            f"f is {f}; give the positive coefficient of friction that was given to `history`"
        )
    bound = f * body.pressure(x, history.a[:, None], history.c[:, None], **constants)
    _demand_friction(history, x, bound)
    return np.where(np.isfinite(bound), bound, np.nan)


def _demand_friction(history: Any, x: Array, bound: Array) -> None:
    """Demand that shear exceed f p nowhere, and reach it at a point that slips, if there is any.

    All points outside [-m, n] by more than the error slip; on elements, a single one of them may
    stick.
    """
    a, c, m, n, error = (
        v[:, None] for v in (history.a, history.c, history.m, history.n, history.error)
    )
    shear, finite = np.abs(history.q), np.isfinite(bound)
    most = bound + ROUNDING * (bound + np.max(bound, initial=0.0, where=finite))
    slips = np.maximum(-m - x, x - n) > (error + ROUNDING) * (a + c)
    slips &= (np.minimum(x + a, c - x) > ROUNDING * (a + c)) & finite
    wrong = np.isfinite(shear) & ~(shear <= most)
    if np.all(shear[slips] < (1 - SHORT) * bound[slips]):
        wrong |= slips
    for i, j in np.argwhere(wrong)[:1]:
        must = "must equal f p where the surfaces slip" if slips[i, j] else "must not exceed f p"
        raise ValueError(
            f"history does not fit this body, f and constants: at instant {i} and x = {x[j]:g} m, "
            f"|q| is {shear[i, j]:g} Pa and f p is {bound[i, j]:g} Pa, but |q| {must}; give the "
            "body, f, constants and x that were given to `history`"
        )


def _demand_indices(at: Sequence[int], count: int) -> None:
    """Demand a sequence of at least one index of an instant."""
    found = np.asarray(at, dtype=object)
    whole = all(isinstance(i, int | np.integer) and not isinstance(i, bool) for i in found.flat)
    if found.ndim != 1 or not found.size or not (whole and all(-count <= i < count for i in found)):
        raise ValueError(
            f"`at` is {at!r:.60}; give a list of at least one index from {-count} to {count - 1}, "
            f"because history has {count} instants"
        )


def _note(axes: Axes, why: str, names: Sequence[str], missing: Array) -> None:
    """Write in the picture which of the curves are missing, and why."""
    if np.any(missing):
        text = f"{why}: {', '.join(compress(names, missing))}"
        axes.text(0.02, 0.015, text, transform=axes.transAxes)


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
    x, count = _positions(history, x), np.size(history.a)
    _demand_indices(at, count)
    if labels and len(labels) != len(at):
        raise ValueError(
            f"{len(labels)} labels are given for {len(at)} instants; give one for each, or none"
        )
    bound = _bounds(body, history, x, f, constants)
    chosen = [bound[i] for i in at]
    touching = (x >= -np.min(history.a)) & (x <= np.min(history.c))
    slip = np.where(touching, history.slip, np.nan)
    length = length or unit(x, "m")
    stress, depth = stress or unit(typical(np.ravel(chosen)), "Pa"), unit(slip, "m")
    with style():
        if axes is None:
            _, axes = subplots(2, 1, size=(5.6, 5.0), sharex=True)
        names = list(labels) or [f"instant {range(count)[i]}" for i in at]
        for number, (i, name, limit) in enumerate(zip(at, names, chosen, strict=True)):
            if number == 0 or not np.allclose(limit, chosen[0], equal_nan=True):
                band(axes[0], length(x), stress(limit), "" if number else r"$\pm f\,p$")
            axes[0].plot(length(x), stress(history.q[i]), label=name)
            axes[1].plot(length(x), depth(slip[i]))
        _note(axes[0], "no contact", names, [np.isnan(history.a[i]) for i in at])
        if np.any(touching):
            _note(axes[1], "slip not known", names, [np.all(np.isnan(slip[i])) for i in at])
        else:
            _note(axes[1], "slip not drawn", ["no point is in contact at all instants"], [True])
        highest = 1.15 * float(np.max(typical(stress(np.ravel(chosen))), initial=0.0)) or 1.0
        axes[0].set(ylabel=stress.label("q"), ylim=(-highest, highest))
        axes[1].set(xlabel=length.label("x"), ylabel=depth.label("s"))
        key_above(axes[0])
    return axes


def friction_work(
    body: ModuleType, history: Any, x: Array, *, f: float, **constants: float
) -> Array:
    """The frictional work per unit area at every position.

        sum of f (p_1 + p_2)/2 |slip_2 - slip_1| over all intervals between two instants

    The sum is exact if, between two instants, slip has one direction and the pressure is constant.

    Parameters
    ----------
    body : module
        A generated module, such as generated.wedge.
    history : History
        A result of `history` of a generated module, for one history.
    x : array_like, shape (n,)
        The positions that were given to `history` [m], which must increase.
    f : float
        Coefficient of friction, as given to `history` [-].
    **constants : float
        E_star [Pa] and the parameters of the body.

    Returns
    -------
    ndarray, shape (n,)
        The work [J/m²]; NaN where the slip is not known.

    Raises
    ------
    ValueError
        If the history does not fit x, f, the body or the constants; the message says what is wrong.
    """
    bound = _bounds(body, history, _positions(history, x), f, constants)
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
    """Draw the frictional work of the whole history against x; see `friction_work`.

    Parameters
    ----------
    body : module
        A generated module, such as generated.wedge.
    history : History
        A result of `history` of a generated module, for one history.
    x : array_like, shape (n,)
        The positions that were given to `history` [m], which must increase.
    f : float
        Coefficient of friction, as given to `history` [-].
    axes : Axes, optional
        The Axes to draw into; new ones by default.
    length : Measure, optional
        The unit of x; a suitable one by default.
    label : str, optional
        The label of the curve in a legend.
    **constants : float
        E_star [Pa] and the parameters of the body.

    Returns
    -------
    Axes
        The Axes with the picture.

    Raises
    ------
    ValueError
        If the history does not fit x, f, the body or the constants; the message says what is wrong.
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
    """Make an animation of the shear traction and the friction bounds, with one frame per instant.

    Parameters
    ----------
    body : module
        A generated module, such as generated.wedge.
    history : History
        A result of `history` of a generated module, for one history.
    x : array_like, shape (n,)
        The positions that were given to `history` [m], which must increase.
    time : array_like, optional
        The time of each instant, which must increase; 0, 1, 2, ... by default.
    f : float
        Coefficient of friction, as given to `history` [-].
    interval : float, optional
        The duration of a frame [ms].
    axes : Axes, optional
        The Axes to draw into; new ones by default.
    length : Measure, optional
        The unit of x; a suitable one by default.
    stress : Measure, optional
        The unit of the shear traction; a suitable one by default.
    **constants : float
        E_star [Pa] and the parameters of the body.

    Returns
    -------
    FuncAnimation
        Its method `save` writes a GIF, and `to_jshtml` makes a player for a notebook.

    Raises
    ------
    ValueError
        If the history does not fit x, f, the body or the constants; the message says what is wrong.
    """
    x, at = _positions(history, x), _times(history, time)
    bound = _bounds(body, history, x, f, constants)
    length, stress = length or unit(x, "m"), stress or unit(typical(np.ravel(bound)), "Pa")
    position, highest = length(x), 1.15 * float(np.nanmax(typical(stress(np.ravel(bound)))))
    step = np.vstack([np.zeros(np.size(x)), _steps(history)])
    most = np.max(np.abs(step), initial=0.0, where=np.isfinite(step))
    with style():
        if axes is None:
            _, axes = subplots(size=(5.0, 3.0))
        grey: dict[str, Any] = {"color": "#888888", "linewidth": 1}
        (upper,) = axes.plot([], [], label=r"$\pm f\,p$", **grey)
        (lower,) = axes.plot([], [], **grey)
        (shear,) = axes.plot([], [], color=COLOURS["vermilion"], linewidth=2, label="$q$")
        areas = [
            axes.fill_between([], [], [], label=name, zorder=0.5, **AREAS[name])
            for name in ("forward slip", "reverse slip")
        ]
        caption = axes.text(0.98, 0.04, "", transform=axes.transAxes, ha="right")
        axes.set(xlabel=length.label("x"), ylabel=stress.label("q"))
        axes.set(xlim=(position.min(), position.max()), ylim=(-highest, highest))
        key_above(axes)

    def draw(i: int) -> list[Any]:
        with style():
            upper.set_data(position, stress(bound[i]))
            lower.set_data(position, -stress(bound[i]))
            shear.set_data(position, stress(history.q[i]))
            for area, sign in zip(areas, (1, -1), strict=True):
                slips = (sign * step[i] > STILL * most) & (bound[i] > 0)
                area.set_data(position, -stress(bound[i]), stress(bound[i]), where=slips)
            name = f"instant {i}" if time is None else f"$t$ = {at[i]:.3g}"
            caption.set_text(name if np.isfinite(history.a[i]) else f"{name}: no contact")
        return [upper, lower, shear, *areas, caption]

    figure: Any = axes.figure
    return FuncAnimation(figure, draw, frames=np.size(history.a), interval=interval, blit=False)
