"""Checks of what is given to a picture: one clear error for each thing that cannot be drawn."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from derive.plot.measure import Array


def demand_contact(name: str, state: Any) -> None:
    """A Contact with two edges; name: what the caller calls it."""
    if not (hasattr(state, "a") and hasattr(state, "c")):
        raise ValueError(
            f"{name} is {state!r}, which is no Contact; give what `contact` returns, such as "
            "body.contact(P, M, ...)"
        )
    shape = np.broadcast(state.a, state.c).shape
    if shape:
        raise ValueError(
            f"{name} holds contacts in the shape {shape}, and one is drawn: give one of them, such "
            "as Contact(*(v[0] for v in state))"
        )
    if not (np.isfinite(state.a) and np.isfinite(state.c)):
        raise ValueError(
            f"{name} is no contact: its edges are NaN, as under a load that is not positive or a "
            "moment that the body cannot take; give a contact whose a and c are numbers"
        )


def demand_contact_of(name: str, body: Any, state: Any, constants: dict[str, float]) -> None:
    """A Contact of this body and these constants, as far as its pressure and its tilt tell."""
    demand_contact(name, state)
    own = {key: value for key, value in constants.items() if key != "E_star"}
    tilt, stated = float(body.tilt(state.a, state.c, **own)), float(state.alpha)
    if np.isnan(tilt):
        found = f"it cannot touch from {-state.a:g} to {state.c:g} m"
    elif np.isfinite(stated) and stated and abs(tilt - stated) > 1e-6 * max(abs(tilt), abs(stated)):
        found = f"over these edges it is tilted by {tilt:g}, and {name} by {stated:g}"
    else:
        return
    raise ValueError(
        f"{name} is no contact of {body.__name__.rpartition('.')[2]} with these constants: "
        f"{found}; give what its own `contact` returns for the same constants"
    )


def demand_contacts(states: Sequence[Any], labels: Sequence[str]) -> None:
    """At least one Contact, and a label for each or none."""
    if hasattr(states, "a"):  # a Contact is a tuple itself: a likely mistake
        raise ValueError(
            "states is one Contact; give a list of what `contact` returns, such as "
            "[body.contact(P, M, ...)]"
        )
    if not len(states):
        raise ValueError("states is empty; give a list of one Contact or more")
    for i, state in enumerate(states):
        demand_contact(f"states[{i}]", state)
    if labels and len(labels) != len(states):
        raise ValueError(
            f"{len(labels)} labels are given for {len(states)} states; give one for each, or none"
        )


def demand_numbers(**given: Array) -> None:
    """Numbers drawn one at a time, by the caller's names for them."""
    for name, value in given.items():
        if np.ndim(value) or not np.isfinite(value):
            what = f"values in the shape {np.shape(value)}" if np.ndim(value) else f"{value}"
            raise ValueError(
                f"{name} is {what}; one half-cycle is drawn at a time: give a number, and a map "
                "over many by `sweep`"
            )


def demand_signs(dQ: float, f: float) -> None:
    """A half-cycle that raises the shear load, and friction."""
    if dQ < 0:
        raise ValueError(
            f"dQ is {dQ:g}; a half-cycle that raises the shear load is drawn: exchange its ends, "
            "and with them the sign of dsigma"
        )
    if f <= 0:
        raise ValueError(f"f is {f:g}; give a coefficient of friction above 0")


def demand_row(name: str, values: Array) -> None:
    """The values along an axis: two or more, in one row."""
    shape = np.shape(values)
    if len(shape) != 1 or shape[0] < 2:
        raise ValueError(
            f"{name} has the shape {shape}; a map needs two values or more, in one row: give an "
            "array of one dimension, such as np.linspace(0, 1, 101)"
        )
    if not np.all(np.isfinite(values)):
        raise ValueError(f"{name} holds NaN or infinite values; give finite ones")


def demand_fitting(shape: tuple[int, ...], **given: Array) -> None:
    """Each one value for all, or one for each place along the axis."""
    for name, value in given.items():
        if np.shape(value) not in ((), (1,), shape):
            raise ValueError(
                f"{name} has the shape {np.shape(value)} where {shape[0]} values stand along the "
                "axis: give one number, or one for each of them"
            )
