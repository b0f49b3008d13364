r"""Histories and steady cycles on successively finer meshes, with an estimate of the error.

Each mesh has twice as many elements as the one before, and its steps are half as long.  It is
refined towards the kinks of the profile, the edges of the contact at the instants, and the ends of
the stick zones that were found on the mesh before.  The refinement ends when the estimated error is
below the tolerance, or with the finest mesh.

The estimated error is SAFETY times the difference between the last two meshes, which exceeds the
error of the last one.  For m and n the distance between the elements is added that the end of a
stick zone lies between.  Of the shear traction in a history the mean difference over the contact
counts.

E* = 1 throughout.
"""

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..body import Body
from ..cycle import Own, contact
from ..forward import breaks_of
from ..types import Array, History, Regime, SteadyCycle
from .elements import Elements, elements_of, mesh, pressures, value_at
from .path import Path, path
from .steps import Interface
from .zones import permanent, sticking

FEWEST = 64
"""Elements of the first mesh."""

REACH = 3.0
"""Largest motion of an edge in a step, relative to the contact width, times the number of
elements."""

SAFETY = 1.5
"""Factor on the difference between two meshes in the estimated errors."""

MAX_ROUNDS = 100
"""Largest number of repetitions of a cycle."""

NO_SLIP = 0.1
"""Slip in a cycle below this fraction of the largest, divided by the number of elements, counts as
zero: next to the stick zone slip decays slowly from cycle to cycle."""

REPEATED = 1e-6
"""A cycle has settled if slip changes by less than this fraction of the largest slip."""


class _Found(NamedTuple):
    """A result on one mesh, and what the next mesh and the error need of it.

    result   a History or a SteadyCycle whose error is not known yet
    mesh     None if the contact of a cycle is lost or slides
    between  the distance between the elements that the ends of a stick zone lie between
    values   of the elements: shear at each instant of a history; slip in the last round of a cycle,
             forward plus backward
    """

    result: Any
    mesh: Any
    between: Any
    values: Any


def _refined(solve: Callable[..., Any], compare: Callable[..., Any], tol: float) -> Any:
    """The result on the last mesh, with its error.

    solve: solves the problem with a number of elements, from the result on the mesh before.
    compare: the error by comparison with the mesh before.
    """
    count, finest = FEWEST, FEWEST * (4 if tol >= 1e-3 else 8 if tol >= 1e-4 else 16)
    found = solve(count, None)
    while True:
        coarse, count = found, 2 * count
        found = solve(count, coarse)
        error = compare(found, coarse)
        if count >= finest or np.all((error <= tol) | np.isnan(found.result.m)):
            return found.result._replace(error=error)


def _elements(body: Body, own: Own, way: Path, coarse: Any, count: int) -> Elements:
    """The elements for a path; they end at kinks, and where an edge rests, because slip jumps."""
    at = way.instant >= 0
    stick_ends = np.empty(0) if coarse is None else np.append(-coarse.result.m, coarse.result.n)
    low, high = -np.nanmax(way.a), np.nanmax(way.c)
    breaks = breaks_of(body.law, own.values())
    points = np.concatenate([[low, high], breaks, -way.a[at], way.c[at], stick_ends])
    rests = np.flatnonzero((np.diff(way.a) == 0) & (np.diff(way.c) == 0))
    fixed = np.unique(np.concatenate([breaks, -way.a[rests], way.c[rests]]))
    return elements_of(mesh(points[(low <= points) & (points <= high)], fixed, count))


def _zone_error(fine: _Found, coarse: _Found, h: Array) -> Array:
    """The error of m and n relative to the width h; a zone on only one of two meshes is unknown."""
    new, old = fine.result, coarse.result
    change = np.maximum(abs(new.m - old.m), abs(new.n - old.n)) / h
    change = np.where(np.isnan(change), 1.0 * (np.isnan(new.m) != np.isnan(old.m)), change)
    return SAFETY * change + fine.between / h


def _shear_at(
    body: Body, own: Own, f: float, mesh: Elements, x: Array, state: tuple[Array, ...]
) -> Array:
    """Shear traction at the points x, one row per contact.

    state: a, c, and shear and status of the elements, one row per contact.
    """
    a, c, shear, status = state
    bound = f * pressures(body, own, x, a, c)
    k = np.clip(np.searchsorted(mesh.ends, x) - 1, 0, mesh.middles.size - 1)
    sticks = np.clip(value_at(mesh, shear, x), -bound, bound)
    with np.errstate(invalid="ignore"):
        q = np.where(status[:, k] != 0, status[:, k] * bound, sticks)
        return np.where(np.isnan(x) | np.isnan(shear[:, :1]), np.nan, q)


def _slip_at(mesh: Elements, x: Array, slip: Array) -> Array:
    """Slip at the points x; NaN where the bodies are never in contact."""
    outside = (x < mesh.ends[0]) | (x > mesh.ends[-1])
    return np.where(outside, np.nan, value_at(mesh, slip, x))


# ---------------------------------------------------------------- histories


def history(body: Body, own: Own, f: float, loads: Array, x: Array, tol: float) -> History | None:
    """A history with its error, on as many meshes as it needs; None if there is no contact.

    loads: P, M, Q and sigma, one row each.
    """
    if not np.any(contact(body, own, loads[0], loads[1], 1.0).a > -math.inf) or not f > 0:
        return None
    solve = partial(_history_on, body, own, f, loads, x)
    found: History = _refined(solve, partial(_compare_instants, f * loads[0]), tol)
    return found


def _history_on(
    body: Body, own: Own, f: float, loads: Array, x: Array, count: int, coarse: _Found | None
) -> _Found:
    """The history on one mesh."""
    way = path(body, own, f, loads, REACH / count, coarse is not None)
    mesh = _elements(body, own, way, coarse, count)
    interface, instants = Interface(body, own, f, way, mesh), loads.shape[1]
    m, n, between = np.full((3, instants), np.nan)
    intervals, regime = np.zeros((2, instants), dtype=np.int64)
    shear, status, slip = np.full((3, instants, count), np.nan)
    work, slipped, worked, now = np.full(instants, np.nan), np.zeros(count), 0.0, Regime.NONE
    for row in range(1, way.a.size):
        if now != Regime.UNSOLVED:
            now = interface.step(row)
            slipped = slipped + interface.slip
            worked += interface.work @ mesh.widths
        j = way.instant[row]
        if j < 0:
            continue
        regime[j] = now
        if now in (Regime.NONE, Regime.UNSOLVED):
            continue
        shear[j], status[j], slip[j] = interface.shear, interface.status, slipped
        work[j] = worked
        m[j], n[j], intervals[j], between[j] = sticking(
            mesh, interface.shear, interface.bound, interface.status, way.a[row], way.c[row]
        )
    a, c = way.a[way.instant >= 0], way.c[way.instant >= 0]
    q = _shear_at(body, own, f, mesh, x, (a, c, shear, status))
    zone = a, c, m, n, intervals, regime
    found = History(*zone, q, _slip_at(mesh, x, slip), work, between)
    return _Found(found, mesh, between, shear)


def _compare_instants(limit: Array, fine: _Found, coarse: _Found) -> Array:
    """The error of zone and shear at each instant; limit is f P."""
    new, old = fine.result, coarse.result
    unsolved = (new.regime == Regime.UNSOLVED) | (old.regime == Regime.UNSOLVED)
    apart = abs(fine.values - value_at(coarse.mesh, coarse.values, fine.mesh.middles))
    shear = SAFETY * apart @ fine.mesh.widths / limit
    return np.where(unsolved, np.nan, np.maximum(_zone_error(fine, coarse, new.a + new.c), shear))


# ---------------------------------------------------------------- steady cycles


def steady_cycle(
    body: Body, own: Own, f: float, loads: Array, x: Array, tol: float
) -> SteadyCycle | None:
    """A steady cycle with its error, on as many meshes as it needs; None if contact is lost.

    loads: P, M, Q and sigma, one row each; those of the last instant are those of the first.
    """
    touches = contact(body, own, loads[0], loads[1], 1.0).a > -math.inf
    if not (np.all(touches) and np.all(np.isfinite(loads)) and f > 0):
        return None
    found: SteadyCycle = _refined(partial(_cycle_on, body, own, f, loads, x), _compare_rounds, tol)
    return found


def _cycle_on(
    body: Body, own: Own, f: float, loads: Array, x: Array, count: int, coarse: _Found | None
) -> _Found:
    """The steady cycle on one mesh."""
    way = path(body, own, f, loads, REACH / count, False)
    least = int(np.argmax(way.instant == 0))  # the first steps apply the loads of the first instant
    mesh = _elements(body, own, way, coarse, count)
    interface, always = Interface(body, own, f, way, mesh), np.ones(count, dtype=bool)
    before, drift, nan, statuses = np.zeros(count), math.inf, math.nan, dict[int, Array]()
    for rounds in range(MAX_ROUNDS + 1):
        total, slip, low, high = np.zeros((4, count))
        work = 0.0
        for row in range(1, least + 1) if rounds == 0 else range(least + 1, way.a.size):
            regime = interface.step(row, statuses.get(row))
            statuses[row] = interface.status.astype(np.int8)
            if regime not in (Regime.COMPUTED, Regime.FULL_STICK):
                none = np.full(x.size, nan)
                lost = SteadyCycle(nan, nan, regime, none, none, nan, 0, nan, nan)
                return _Found(lost, None, nan, nan)
            always &= interface.bound > 0
            total, slip = total + abs(interface.slip), slip + interface.slip
            work += interface.work @ mesh.widths
            low, high = np.minimum(low, slip), np.maximum(high, slip)
        most = np.max(total)
        drift = np.max(abs(total - before)) / most if most > 0 else 0.0
        before = total
        if rounds and drift <= REPEATED:  # the first loading is no cycle
            break
    a, c = np.min(way.a), np.min(way.c)
    m, n, between, regime = a, c, 0.0, Regime.FULL_STICK
    if most > 0 or a + c <= 0:
        # where nothing slips, elements may slip a little, but less as the mesh is refined
        less = total
        if coarse is not None and coarse.mesh is not None:
            fallen = value_at(coarse.mesh, coarse.values, mesh.middles) - total
            less = np.clip(total - fallen, 0.0, total)
        m, n, between = permanent(mesh, total, less <= NO_SLIP / count * most, always)
        regime = Regime.NO_STICK if math.isnan(m) else Regime.COMPUTED
        m, n = min(m, a), min(n, c)
    state = way.a[-1:], way.c[-1:], interface.shear[None], interface.status[None]
    q = _shear_at(body, own, f, mesh, x, state)[0]
    slip = _slip_at(mesh, x, high - low)
    found = SteadyCycle(m, n, regime, slip, q, work, rounds, drift, between)
    return _Found(found, mesh, between, total)


def _compare_rounds(fine: _Found, coarse: _Found) -> Any:
    """The error of the stick zone of a steady cycle."""
    found = fine.result
    error = _zone_error(fine, coarse, found.m + found.n)
    return error + math.inf if found.drift > REPEATED else error  # NaN stays NaN
