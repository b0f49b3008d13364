"""Checks of the arguments of a picture; each mistake raises one clear error."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from derive.plot.measure import Array


def demand_contact(name: str, state: Any) -> None:
    """Check that the argument called `name` is a single Contact with finite edges."""
    if not (hasattr(state, "a") and hasattr(state, "c")):
        raise ValueError(
            f"{name} is {state!r}, which is not a Contact; give a result of `contact`, such as "
            "body.contact(P, M, ...)"
        )
    shape = np.broadcast(state.a, state.c).shape
    if shape:
        raise ValueError(
            f"{name} contains contacts of shape {shape}, but only one can be drawn; select one "
            "of them, for example by Contact(*(v[0] for v in state))"
        )
    if not (np.isfinite(state.a) and np.isfinite(state.c)):
        raise ValueError(
            f"{name} has edges that are NaN, for example because the load is not positive or the "
            "body cannot carry the moment; give a contact whose a and c are finite"
        )


def demand_contact_of(name: str, body: Any, state: Any, constants: dict[str, float]) -> None:
    """Check that the edges and the tilt of a Contact agree with this body and these constants."""
    demand_contact(name, state)
    own = {key: value for key, value in constants.items() if key != "E_star"}
    tilt, stated = float(body.tilt(state.a, state.c, **own)), float(state.alpha)
    if np.isnan(tilt):
        why = f"the body cannot be in contact from {-state.a:g} to {state.c:g} m"
    elif np.isfinite(stated) and stated and abs(tilt - stated) > 1e-6 * max(abs(tilt), abs(stated)):
        why = f"its edges require a tilt of {tilt:g} rad, but its tilt is {stated:g} rad"
    else:
        return
    raise ValueError(
        f"{name} is not a contact of {body.__name__.rpartition('.')[2]} with these constants: "
        f"{why}; give a result of `contact` of this body for the same constants"
    )


def demand_contacts(states: Sequence[Any], labels: Sequence[str]) -> None:
    """Demand a sequence of at least one Contact, and either no labels or one for each."""
    if hasattr(states, "a"):  # a likely mistake, because a Contact is itself a tuple
        raise ValueError(
            "states is a single Contact; give a list of results of `contact`, such as "
            "[body.contact(P, M, ...)]"
        )
    if not len(states):
        raise ValueError("`states` is empty; give a list of at least one Contact")
    for i, state in enumerate(states):
        demand_contact(f"states[{i}]", state)
    demand_labels(labels, len(states), "states")


def demand_labels(labels: Sequence[str], count: int, what: str) -> None:
    """Demand one label for each, or none."""
    if labels and len(labels) != count:
        raise ValueError(
            f"{len(labels)} labels are given for {count} {what}; give one for each, or none"
        )


def real_numbers(name: str, values: Array) -> Array:
    """The values as an array of floating-point numbers; text and other objects are refused."""
    try:
        found = np.asarray(values)
    except ValueError:  # rows of different lengths
        found = np.asarray(None)
    if found.dtype.kind not in "iuf":
        raise ValueError(f"{name} is {values!r:.60}; give real numbers only")
    return found.astype(float)


MANY = (
    "but only one half-cycle can be drawn; give a finite number, or draw a map of many half-cycles "
    "with `sweep`"
)


def demand_numbers(remedy: str = MANY, /, **given: Array) -> None:
    """Demand finite numbers, not arrays; the keywords are the names of the arguments."""
    for name, value in given.items():
        shape = real_numbers(name, value).shape
        if shape or not np.isfinite(value):
            what = f"an array of shape {shape}" if shape else f"{value}"
            raise ValueError(f"{name} is {what}, {remedy}")


def demand_signs(dQ: float, f: float) -> None:
    """Check that the half-cycle does not lower the shear load and that the coefficient of friction
    is positive."""
    if dQ < 0:
        raise ValueError(
            f"dQ is {dQ:g}, but only a half-cycle that raises the shear load can be drawn; "
            "exchange its ends, and change the sign of dsigma accordingly"
        )
    if f <= 0:
        raise ValueError(f"f is {f:g}; give a coefficient of friction above 0")


def demand_row(name: str, values: Array) -> None:
    """Require a one-dimensional array of at least two finite values."""
    values = real_numbers(name, values)
    shape = values.shape
    if len(shape) != 1 or shape[0] < 2:
        raise ValueError(
            f"{name} has the shape {shape}; give a one-dimensional array of at least two values, "
            "such as np.linspace(0, 1, 101)"
        )
    demand_finite(name, values)


def demand_finite(name: str, values: Array) -> None:
    """Demand finite values."""
    if not np.all(np.isfinite(values)):
        raise ValueError(f"{name} contains NaN or infinite values; give finite values only")


def demand_increasing(name: str, values: Array, remedy: str) -> None:
    """Demand that each value be larger than the one before it."""
    wrong = np.flatnonzero(~(np.diff(values) > 0))
    if wrong.size:
        i = wrong[0]
        raise ValueError(
            f"{name} must increase, but {values[i + 1]:g} follows {values[i]:g} at index {i + 1}; "
            f"{remedy}"
        )


def times(time: Array | None, default: Array) -> Array:
    """The time of each instant, or the default; the times must be finite and increase."""
    if time is None:
        return default
    at = real_numbers("time", time)
    if at.shape != default.shape:
        raise ValueError(
            f"time has the shape {at.shape}; give one time for each of the {default.size} instants"
        )
    demand_finite("time", at)
    demand_increasing("time", at, "give the times of successive instants")
    return at


def demand_fitting(shape: tuple[int, ...], **given: Array) -> None:
    """Demand a single value, or one for each value along the axis, for every argument."""
    for name, value in given.items():
        if np.shape(value) not in ((), (1,), shape):
            raise ValueError(
                f"{name} has the shape {np.shape(value)}, but there are {shape[0]} values along "
                "the axis; give one number, or one for each of these values"
            )


# ------------------------------------------------------------------ histories

ROUNDING = 1e-6
"""Allowance for rounding: of an edge relative to the contact width, of shear relative to f p."""

SHORT = 1e-3
"""If shear falls short of f p by more than this fraction wherever the surfaces slip, it does not
belong to this f p."""


def positions_of(history: Any, x: Array) -> Array:
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
        must = "must equal f p where the surfaces slip" if slips[i, j] else "must not exceed f p"
        raise ValueError(
            f"history does not fit this body, f and constants: at instant {i} and x = {x[j]:g} m, "
            f"|q| is {shear[i, j]:g} Pa and f p is {bound[i, j]:g} Pa, but |q| {must}; give the "
            "body, f, constants and x that were given to `history`"
        )


def demand_indices(at: Sequence[int], count: int) -> None:
    """Demand a sequence of at least one index of an instant."""
    found = np.asarray(at, dtype=object)
    whole = all(isinstance(i, int | np.integer) and not isinstance(i, bool) for i in found.flat)
    if found.ndim != 1 or not found.size or not (whole and all(-count <= i < count for i in found)):
        raise ValueError(
            f"`at` is {at!r:.60}; give a list of at least one index from {-count} to {count - 1}, "
            f"because history has {count} instants"
        )
