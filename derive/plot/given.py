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
    if labels and len(labels) != len(states):
        raise ValueError(
            f"{len(labels)} labels are given for {len(states)} states; give one for each, or none"
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
