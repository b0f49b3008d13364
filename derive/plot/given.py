"""Checks of the arguments of a picture; each mistake raises one clear error."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from derive.plot.measure import Array

ROUNDING = 1e-6
"""Allowance for rounding: of an edge relative to the contact width, of shear relative to f p."""

SHORT = 1e-3
"""If shear falls short of f p by more than this fraction wherever the surfaces slip, it does not
belong to this f p."""


def demand_contact(name: str, body: Any, state: Any, constants: dict[str, float]) -> None:
    """Demand a single Contact whose edges and tilt agree with this body and these constants."""
    own = {key: value for key, value in constants.items() if key != "E_star"}
    a, c = (getattr(state, edge, np.nan) for edge in ("a", "c"))
    if np.broadcast(a, c).shape or not (np.isfinite(a) and np.isfinite(c)):
        why = "not a single Contact with finite edges"
    else:
        tilt, stated = float(body.tilt(a, c, **own)), float(state.alpha)
        is_stated = np.isfinite(stated) and stated != 0
        if np.isfinite(tilt) and (not is_stated or np.isclose(tilt, stated, ROUNDING, 0)):
            return
        why = f"not in contact at its tilt of {stated:g} rad, because its edges require {tilt:g}"
    raise ValueError(
        f"{name} is {state!r:.100}, {why}; give one result of `contact` of "
        f"{body.__name__.rpartition('.')[2]} for the same constants"
    )


def demand_labels(labels: Sequence[str], count: int, what: str) -> None:
    """Demand at least one thing to draw, and one label for each, or none."""
    if not count:
        raise ValueError(f"`{what}` is empty; give at least one")
    if labels and len(labels) != count:
        raise ValueError(
            f"{len(labels)} labels are given for {count} {what}; give one for each, or none"
        )


def demand_half_cycle(
    body: Any, contacts: dict[str, Any], f: float, constants: dict[str, float], **loads: float
) -> None:
    """Demand loads that are finite numbers and do not lower the shear load, and their contacts."""
    demand_numbers(f=f, **loads)
    if loads["dQ"] < 0:
        raise ValueError(
            f"dQ is {loads['dQ']:g}, but only a half-cycle that raises the shear load can be "
            "drawn; exchange its ends, and change the sign of dsigma accordingly"
        )
    for name, state in contacts.items():
        demand_contact(name, body, state, constants)


def demand_numbers(**given: Array) -> None:
    """Demand finite numbers, not arrays, and a positive f; the keywords are the arguments."""
    for name, value in given.items():
        if np.shape(value) or not np.isfinite(value):
            raise ValueError(f"{name} is {value!r:.60}; give one finite number")
        if name == "f" and value <= 0:
            raise ValueError(f"f is {value:g}; give a coefficient of friction above 0")


def row(name: str, values: Array, count: int | None = None, increases: bool = True) -> Array:
    """The values as one row of finite numbers that increase.

    count: their number; at least two by default
    """
    try:
        found = np.asarray(values)
    except ValueError:  # rows of different lengths
        found = np.asarray(None)
    fits = found.ndim == 1 and (found.size > 1 if count is None else found.size == count)
    if not fits or found.dtype.kind not in "iuf" or not np.all(np.isfinite(found)):
        raise ValueError(
            f"{name} is {values!r:.60}; give one row of {count or 'at least two'} finite numbers"
        )
    if increases and np.any(np.diff(found) <= 0):
        i = int(np.argmax(np.diff(found) <= 0))
        raise ValueError(
            f"{name} must increase, but {found[i + 1]:g} follows {found[i]:g} at index {i + 1}"
        )
    return found.astype(float)


def times(time: Array | None, default: Array) -> Array:
    """The time of each instant, or the default; the times must be finite and increase."""
    return default if time is None else row("time", time, default.size)


# ------------------------------------------------------------------ histories


def positions_of(history: Any, x: Array) -> Array:
    """The positions x; demand one history with shear and slip at these positions."""
    x = row("x", x)
    shape = np.size(getattr(history, "a", ())), x.size
    if np.shape(getattr(history, "slip", ())) != shape or not np.any(np.isfinite(history.a)):
        raise ValueError(
            f"history is {history!r:.60}, which is not a single History in contact with slip at "
            f"the {x.size} positions of x; give a result of `history` for the same x"
        )
    a, c = history.a[:, None], history.c[:, None]
    depth = np.minimum(x + a, c - x) / (a + c)
    known = np.isfinite(history.slip)
    wrong = (depth < -ROUNDING) & (np.abs(history.q) > 0)  # no shear is outside the contact
    wrong |= (depth > ROUNDING) & ~known & np.any(known, axis=1, keepdims=True)
    for i, j in np.argwhere(wrong)[:1]:
        raise ValueError(
            f"x is not the x of history: at instant {i}, {x[j]:g} m would be on the other side of "
            "an edge of the contact; give the same x to `history`"
        )
    return x


def demand_friction(history: Any, x: Array, bound: Array) -> None:
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
        raise ValueError(
            f"history does not fit this body, f and constants: at instant {i} and x = {x[j]:g} m, "
            f"|q| is {shear[i, j]:g} Pa and f p is {bound[i, j]:g} Pa; give the body, f, constants "
            "and x that were given to `history`"
        )
