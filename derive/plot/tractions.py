"""Pressure, change in shear traction, slip and frictional work along the interface."""

from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from derive.plot.given import MIXED, demand_contact, demand_labels, demand_numbers, zone_of
from derive.plot.measure import Array, Measure, unit
from derive.plot.style import COLOURS, canvas
from derive.plot.zones import AREAS, key, regime_in_words, senses

SAMPLES = 401
"""Number of points along a contact, minus one; they are closer together towards its edges."""

IN_A_ZONE = 61
"""Number of points along a slip zone, minus one.

It is small because slip takes long to compute if the body has no closed formulas.  Slip outside the
zone is zero.
"""


def places(left: float, right: float, count: int = SAMPLES) -> Array:
    """`count` + 1 points from `left` to `right`, closer together at both ends.

    If `count` is odd, no point is in the middle.
    """
    angle = np.linspace(0, np.pi, count + 1)
    return (left + right) / 2 - (right - left) / 2 * np.cos(angle)


def pressures(
    body: ModuleType,
    states: Sequence[Any],
    labels: Sequence[str] = (),
    *,
    axes: Axes | None = None,
    length: Measure | None = None,
    stress: Measure | None = None,
    **constants: float,
) -> Axes:
    """Draw the pressure of one or more contacts of a body.

    Parameters
    ----------
    body : module
        A generated module, such as generated.wedge.
    states : sequence of Contact
        The contacts, as returned by `contact`.
    labels : sequence of str, optional
        The label of each contact; without labels, no legend is drawn.
    axes : Axes, optional
        The Axes to draw into; new ones by default.
    length : Measure, optional
        The unit of x; a suitable one by default.
    stress : Measure, optional
        The unit of the pressure; a suitable one by default.
    **constants : float
        E_star [Pa] and the parameters of the body.

    Returns
    -------
    Axes
        The Axes with the picture.

    Raises
    ------
    ValueError
        If a contact is not a single one, or the number of labels is wrong.
    """
    demand_labels(labels, len(states), "states")
    demand_numbers(**constants)
    lines = []
    for i, state in enumerate(states):
        demand_contact(f"states[{i}]", state, body, constants)
        x = places(-float(state.a), float(state.c))
        lines.append((x, body.pressure(x, state.a, state.c, **constants)))
    length = length or unit([x for x, _ in lines], "m")
    stress = stress or unit(peak(*(p for _, p in lines)), "Pa")
    with canvas(axes) as axes:
        for i, (x, p) in enumerate(lines):
            axes.plot(length(x), stress(p), label=labels[i] if labels else None)
        axes.set(xlabel=length.label("x"), ylabel=stress.label("p"))
        axes.set_ylim(0, 1.08 * peak(*(stress(p) for _, p in lines)))
        if labels:
            axes.legend()
    return axes


def peak(*drawn: Array) -> float:
    """The largest of all pressures, with the infinite peak at a corner cut off above the others."""
    values = np.concatenate([np.ravel(p) for p in drawn])
    finite = values[np.isfinite(values)]
    return float(min(np.max(finite), 1.35 * np.quantile(finite, 0.97))) if finite.size else 1.0


def tractions(
    body: ModuleType,
    first: Any,
    second: Any,
    dQ: float,
    dsigma: float,
    *,
    f: float,
    mixed: bool = False,
    axes: Sequence[Axes] | None = None,
    length: Measure | None = None,
    stress: Measure | None = None,
    **constants: float,
) -> Sequence[Axes]:
    """Draw the pressure at both ends of a half-cycle, and below it the change in shear traction.

    The surfaces slip where the change in shear traction reaches the bound f (p_1 + p_2).  These
    zones are shaded in the colour of the direction of slip.  A zone in which slip reverses within
    the half-cycle is dotted; the shear traction may then be unknown, and a note in the picture says
    so.

    Parameters
    ----------
    body : as in `pressures`
    first, second : Contact
        Contacts at the start and at the end of the half-cycle that raises the shear load.
    dQ, dsigma : float
        Changes in the shear load [N/m] and in the tension [Pa] over this half-cycle.
    f : float
        Coefficient of friction [-].
    mixed : bool, optional
        Whether to compute stick zones where slip reverses; see `stick_zone`.
    axes : sequence of two Axes, optional
        The Axes to draw into; new ones by default.
    length, stress, **constants : as in `pressures`

    Returns
    -------
    sequence of Axes
        The two Axes with the pictures.

    Raises
    ------
    ValueError
        If these are not one half-cycle; the message is that of `why`.
    """
    law = {"f": f, **constants}
    zone = zone_of(body, first, second, dQ, dsigma, mixed, **law)
    x = places(-float(max(first.a, second.a)), float(max(first.c, second.c)))
    p1, p2 = (body.pressure(x, s.a, s.c, **constants) for s in (first, second))
    shear = body.shear_change(x, first, second, dQ, dsigma, **law)
    length, stress = length or unit(x, "m"), stress or unit(peak(p1, p2), "Pa")
    with canvas(axes, 2, size=(5.6, 5.0)) as axes:
        above, below = axes
        same = bool(np.all(np.isclose(p1, p2, rtol=1e-12, atol=0) | (p1 == p2)))
        if not same:
            above.plot(length(x), stress(p1), "--", color=COLOURS["sky"], label="start, $p_1$")
        above.plot(
            length(x), stress(p2), color=COLOURS["blue"], label="$p$" if same else "end, $p_2$"
        )
        limit = stress(f * (p1 + p2))
        band(below, length(x), limit, r"$\pm f\,(p_1 + p_2)$")
        below.plot(
            length(x), stress(shear), color=COLOURS["vermilion"], linewidth=2, label=r"$\Delta q$"
        )
        _shade(axes, second, zone, dsigma, length)
        above.set(ylabel=stress.label("p"), ylim=(0, 1.08 * peak(stress(p1), stress(p2))))
        note_unknown(below, "shear", [regime_in_words(body, zone)], [shear])
        below.set(xlabel=length.label("x"), ylabel=stress.label(r"\Delta q"))
        _centre(below, stress(shear), limit)
        for each in axes:
            key(each)
    return axes


def shear(
    body: ModuleType,
    contact: Any,
    Q: float,
    sigma: float,
    dQ: float,
    dsigma: float,
    *,
    f: float,
    between: int = 3,
    axes: Axes | None = None,
    length: Measure | None = None,
    stress: Measure | None = None,
    **constants: float,
) -> Axes:
    """Draw the shear traction at and between both ends of a cycle under constant normal loads.

    The surfaces slip where the shear traction reaches the bound f p.  A note in the picture says at
    which end the shear traction is not known.

    Parameters
    ----------
    contact : Contact
        The contact under the normal loads, as returned by `contact`.
    Q, sigma : float
        Shear load [N/m] and tension [Pa] at the upper end, reached first, starting from zero.
    between : int, optional
        Number of states that are drawn between the upper and the lower end.
    body, dQ, dsigma, f : as in `tractions`
    axes, length, stress, **constants : as in `pressures`

    Returns
    -------
    Axes
        The Axes with the picture.

    Raises
    ------
    ValueError
        If the changes are not one half-cycle; the message is that of `why`.
    """
    if not isinstance(between, int) or between < 0:
        raise ValueError(f"between is {between!r}; give a whole number of states, 0 or more")
    law = {"f": f, **constants}
    demand_numbers(Q=Q, sigma=sigma)
    zone_of(body, contact, contact, dQ, dsigma, mixed=False, **law)
    x = places(-float(contact.a), float(contact.c))
    bound = f * body.pressure(x, contact.a, contact.c, **constants)
    parts = np.linspace(0.0, 1.0, between + 2)
    q = body.shear(
        x, contact, Q, sigma, dQ=parts[:, None] * dQ, dsigma=parts[:, None] * dsigma, **law
    )
    length, stress = length or unit(x, "m"), stress or unit(peak(bound), "Pa")
    with canvas(axes) as axes:
        band(axes, length(x), stress(bound), r"$\pm f\,p$")
        for inner in q[1:-1]:
            axes.plot(length(x), stress(inner), color=COLOURS["sky"], linewidth=0.8)
        names = ("upper end", "lower end")
        for name, end, colour in zip(names, q[[0, -1]], ("vermilion", "blue"), strict=True):
            axes.plot(length(x), stress(end), color=COLOURS[colour], linewidth=2, label=name)
        note_unknown(axes, "shear", names, q[[0, -1]])
        _centre(axes, stress(q), stress(bound))
        axes.set(xlabel=length.label("x"), ylabel=stress.label("q"))
        key(axes)
    return axes


def _shade(axes: Sequence[Axes], at: Any, zone: Any, dsigma: float, length: Measure) -> None:
    """Shade the slip zones by their direction of slip; the last of the Axes gets the labels."""
    if not np.isfinite(zone.m):
        return
    reversing = "slip reverses" if int(zone.regime) == MIXED else ""
    for start, end, sense in zip(
        (-at.a, zone.n), (-zone.m, at.c), senses(zone, dsigma), strict=True
    ):
        if name := {1: "forward slip", -1: "reverse slip"}.get(int(sense), reversing):
            for each in axes:
                label = name if each is axes[-1] else None
                ends = float(length(start)), float(length(end))
                each.axvspan(*ends, label=label, zorder=0.5, **AREAS[name])


def band(axes: Axes, x: Array, limit: Array, label: str) -> list[Line2D]:
    """Draw the friction bounds of either sign."""
    look: dict[str, Any] = {"color": "#888888", "linewidth": 1}
    return [*axes.plot(x, limit, label=label, **look), *axes.plot(x, -limit, **look)]


def note_unknown(axes: Axes, what: str, names: Sequence[str], curves: Array) -> None:
    """Write in the picture which of the curves are not known."""
    unknown = [n for n, y in zip(names, curves, strict=True) if not np.any(np.isfinite(y))]
    if unknown:
        text = f"{what} not known: {', '.join(unknown)}"
        axes.text(0.02, 0.015, text, transform=axes.transAxes)


def _centre(axes: Axes, shear: Array, limit: Array) -> None:
    """Centre the axis of shear on zero, with room for the shear, or for its limit if it is zero."""
    largest = np.max(np.abs(shear), initial=0.0, where=np.isfinite(shear))
    highest = 1.6 * (largest or peak(limit))
    axes.set_ylim(-highest, highest)


def slip(
    body: ModuleType,
    first: Any,
    second: Any,
    dQ: float,
    dsigma: float,
    *,
    f: float,
    mixed: bool = False,
    axes: Sequence[Axes] | None = None,
    length: Measure | None = None,
    **constants: float,
) -> Sequence[Axes]:
    """Draw the slip in a half-cycle, and below it f p s.

    Here s is the slip and p is the mean of the pressures at both ends of the half-cycle.  Under
    constant normal loads, f p s is the frictional work per unit area in every half-cycle.

    Parameters
    ----------
    body, first, second, dQ, dsigma, f, mixed, axes, length, **constants : as in `tractions`

    Returns
    -------
    sequence of Axes
        The two Axes with the pictures.
    """
    law = {"f": f, **constants}
    zone = zone_of(body, first, second, dQ, dsigma, mixed, **law)
    left, right = -float(min(first.a, second.a)), float(min(first.c, second.c))
    ends = (-float(zone.m), float(zone.n)) if np.isfinite(zone.m) else (left, right)
    x = np.append(places(left, ends[0], IN_A_ZONE), places(ends[1], right, IN_A_ZONE))
    slipped = body.slip_range(x, first, second, dQ, dsigma, **law)
    p1, p2 = (body.pressure(x, s.a, s.c, **constants) for s in (first, second))
    mean = np.where(slipped == 0, 0.0, (p1 + p2) / 2)
    work = f * mean * slipped
    length, depth, joule = length or unit(x, "m"), unit(slipped, "m"), unit(work, "J/m²")
    with canvas(axes, 2, size=(5.6, 4.6)) as axes:
        axes[0].plot(length(x), depth(slipped), color=COLOURS["blue"])
        axes[1].plot(length(x), joule(work), color=COLOURS["vermilion"])
        _shade(axes, second, zone, dsigma, length)
        note_unknown(axes[0], "slip", [regime_in_words(body, zone)], [slipped])
        axes[0].set(ylabel=depth.label("s"))
        axes[1].set(xlabel=length.label("x"), ylabel=joule.label("f\\,p\\,s"))
        if axes[1].get_legend_handles_labels()[1]:
            key(axes[1])
        for each in axes:
            each.set_ylim(bottom=0)
    return axes
