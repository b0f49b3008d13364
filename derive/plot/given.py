"""Checks of the arguments of a picture; each mistake raises one clear error."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from derive.plot.measure import Array

NONE, MODERATE, LARGE, MIXED = range(4)
"""The codes of `Regime` in every generated module; NONE is what is no half-cycle of a contact."""

ROUNDING = 1e-6
"""Allowance for rounding: relative to the contact width, and to f p."""

SHORT = 1e-3
"""If the shear falls short of f p by more than this fraction everywhere, but the surfaces slip, it
does not belong to this f p."""


def demand_contact(name: str, state: Any, body: Any, law: dict[str, float]) -> None:
    """Demand a single Contact whose edges and tilt agree with this body and its parameters."""
    own = {key: value for key, value in law.items() if key not in ("E_star", "f")}
    a, c, stated = (getattr(state, field, np.nan) for field in ("a", "c", "alpha"))
    why = "not a single Contact with finite edges"
    if np.broadcast(a, c, stated).shape == () and np.isfinite(a + c):
        tilt = float(body.tilt(a, c, **own))
        is_stated = np.isfinite(stated) and stated != 0
        if np.isfinite(tilt) and (not is_stated or np.isclose(tilt, stated, ROUNDING, 0)):
            return
        why = f"not in contact at its tilt of {stated:g} rad, because its edges require {tilt:g}"
    raise ValueError(
        f"{name} is {state!r:.100}, {why}; give one result of `contact` of "
        f"{body.__name__.rpartition('.')[2]} for the same constants"
    )


def demand_numbers(**given: Any) -> None:
    """Demand that each argument be one finite number."""
    for name, value in given.items():
        found = np.asarray(value)
        if found.ndim or found.dtype.kind not in "iuf" or not np.isfinite(found):
            raise ValueError(f"{name} is {value!r:.60}; give one finite number")


def zone_of(
    body: Any, first: Any, second: Any, dQ: float, dsigma: float, mixed: bool, **law: float
) -> Any:
    """The stick zone of one half-cycle; what is no half-cycle is refused in the words of `why`."""
    demand_numbers(dQ=dQ, dsigma=dsigma, **law)
    zone = body.stick_zone(first, second, dQ, dsigma, mixed=mixed, **law)
    if np.ndim(zone.regime) == 0 and zone.regime == NONE:
        raise ValueError(body.why(first, second, dQ, dsigma, **law))
    for name, state in (("first", first), ("second", second)):
        demand_contact(name, state, body, law)
    return zone


def demand_labels(labels: Sequence[str], count: int, what: str) -> None:
    """Demand at least one thing to draw, and one label for each, or none."""
    if not count:
        raise ValueError(f"`{what}` is empty; give at least one")
    if labels and len(labels) != count:
        raise ValueError(
            f"{len(labels)} labels are given for {count} {what}; give one for each, or none"
        )


def row(name: str, values: Array, count: int | None = None, increases: bool = True) -> Array:
    """The values as one row of at least two finite numbers, `count` of them if given."""
    try:
        found = np.asarray(values)
    except ValueError:  # rows of different lengths
        found = np.asarray(None)
    fits = found.ndim == 1 and found.size > 1 and found.size == (count or found.size)
    if not fits or found.dtype.kind not in "iuf" or not np.all(np.isfinite(found)):
        needed = count if count and count > 1 else "at least two"
        raise ValueError(f"{name} is {values!r:.60}; give one row of {needed} finite numbers")
    if increases and np.any(np.diff(found) <= 0):
        i = int(np.argmax(np.diff(found) <= 0))
        raise ValueError(
            f"{name} must increase, but {found[i + 1]:g} follows {found[i]:g} at index {i + 1}"
        )
    return found.astype(float)


def times(time: Array | None, default: Array) -> Array:
    """The time of each instant, or the default; the times must be finite and increase."""
    return row("time", default if time is None else time, default.size)


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
    depth, known = np.minimum(x + a, c - x) / (a + c), np.isfinite(history.slip)
    unlike = (depth < -ROUNDING) & (np.abs(history.q) > 0)
    unlike |= (depth > ROUNDING) & ~known & np.any(known, axis=1, keepdims=True)
    if np.any(unlike):
        raise ValueError(
            "x is not the x of history, which has shear outside the contact at these positions, or "
            "lacks slip inside it; give the same x to `history`"
        )
    return x


def demand_friction(history: Any, x: Array, bound: Array) -> None:
    """Demand that the shear exceed f p nowhere, and reach it at some point if any point slips.

    All points outside [-m, n] by more than the error slip; on elements, a single one of them may
    stick.
    """
    a, c, m, n, error = (
        v[:, None] for v in (history.a, history.c, history.m, history.n, history.error)
    )
    shear, finite = np.abs(history.q), np.isfinite(bound)
    allowed = ROUNDING * np.max(bound, initial=0.0, where=finite)
    exceeds = np.isfinite(shear) & ~(shear <= (1 + ROUNDING) * bound + allowed)
    slips = np.maximum(-m - x, x - n) > (error + ROUNDING) * (a + c)
    slips &= finite & (bound > allowed)
    falls_short = np.any(slips) and np.all(shear[slips] < (1 - SHORT) * bound[slips])
    if shear.shape != bound.shape or np.any(exceeds) or falls_short:
        raise ValueError(
            "history does not fit this body, f and constants: |q| must be at most f p everywhere, "
            "and reach f p where the surfaces slip; give the body, f, constants and x that were "
            "given to `history`"
        )
