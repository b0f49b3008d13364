r"""Histories and steady cycles on successively finer meshes, with an estimate of the error.

Each mesh has twice as many elements as the one before, and twice as many steps.  It is refined
towards the kinks of the profile, the edges of the contact at the instants, and the ends of the
stick zones that were found on the mesh before.  The refinement ends when the estimated error is
below the tolerance, or with the finest mesh.

The estimated error is SAFETY times the difference between the last two meshes, which exceeds the
error of the last one.  Of the shear traction the mean difference over the contact counts, of slip
the largest at any point, of the work that of its density, added up over the contact.  For m and n
the distance between the elements is added that the end of a stick zone lies between.

E* = 1 throughout.
"""

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..body import Body
from ..cycle import Own
from ..forward import breaks_of
from ..types import Array, History, Regime, SteadyCycle
from .elements import Elements, elements_of, mesh, pressures, value_at
from .path import Path, path, touching
from .steps import Interface
from .zones import permanent, sticking

FEWEST = 64
"""Elements of the first mesh.  With k times as many, at least k steps are taken from one instant to
the next."""

REACH = 8.0
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


def _refined(solve: Callable[..., Any], compare: Callable[..., Any], tol: float) -> Any:
    """The result on the last mesh, and its errors.

    solve: solves the problem with a number of elements, from the result on the mesh before.
    compare: the errors by comparison with the mesh before, the first of which is compared with the
        tolerance.
    """
    count, finest = FEWEST, FEWEST * (4 if tol >= 1e-3 else 8 if tol >= 1e-4 else 16)
    found = solve(count, None)
    while True:
        coarse, count = found, 2 * count
        found = solve(count, coarse)
        errors = compare(found, coarse)
        if count >= finest or np.all((errors[0] <= tol) | np.isnan(found.m)):
            return found, errors


def _elements(body: Body, own: Own, way: Path, coarse: Any, count: int) -> Elements:
    """The elements for a path; they end at kinks, and where an edge rests, because slip jumps."""
    at = way.instant >= 0
    stick_ends = np.empty(0) if coarse is None else np.append(-coarse.m, coarse.n)
    low, high = -np.nanmax(way.a), np.nanmax(way.c)
    breaks = breaks_of(body, own)
    points = np.concatenate([[low, high], breaks, -way.a[at], way.c[at], stick_ends])
    rests = np.flatnonzero((np.diff(way.a) == 0) & (np.diff(way.c) == 0))
    fixed = np.unique(np.concatenate([breaks, -way.a[rests], way.c[rests]]))
    return elements_of(mesh(points[(low <= points) & (points <= high)], fixed, count))


def _zone_error(fine: Any, coarse: Any, h: Array) -> Array:
    """The error of m and n relative to the width h; a zone on only one of two meshes is unknown."""
    change = np.maximum(abs(fine.m - coarse.m), abs(fine.n - coarse.n)) / h
    change = np.where(np.isnan(change), 1.0 * (np.isnan(fine.m) != np.isnan(coarse.m)), change)
    return SAFETY * change + fine.between / h


def _apart(fine: Any, coarse: Any, name: str) -> Array:
    """The differences between two meshes at the elements of the finer one."""
    there = value_at(coarse.mesh, getattr(coarse, name), fine.mesh.middles)
    return abs(getattr(fine, name) - there)


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
        return np.where(np.isnan(x), np.nan, q)


def _slip_at(mesh: Elements, x: Array, slip: Array) -> Array:
    """Slip at the points x; NaN where the bodies are never in contact."""
    outside = (x < mesh.ends[0]) | (x > mesh.ends[-1])
    return np.where(outside, np.nan, value_at(mesh, slip, x))


# ---------------------------------------------------------------- histories


class _Instants(NamedTuple):
    """A history on one mesh: results as in History, and those of the elements, a row per instant.

    between  the distance between the elements that the ends of the stick zone lie between
    density  frictional work per length up to the instant
    """

    mesh: Elements
    a: Array
    c: Array
    m: Array
    n: Array
    between: Array
    intervals: Array
    regime: Array
    work: Array
    shear: Array
    status: Array
    slip: Array
    density: Array


def history(body: Body, own: Own, f: float, loads: Array, x: Array, tol: float) -> History:
    """A history with its errors, on as many meshes as it needs.

    loads: P, M, Q and sigma, one row each.
    """
    if not np.any(touching(body, own, *loads[:2])[0] > -math.inf) or not f > 0:
        none, whole = np.full(loads.shape[1], np.nan), np.zeros(loads.shape[1], dtype=np.int64)
        field = np.full((loads.shape[1], x.size), np.nan)
        zone = none, none, none, none, whole, whole
        return History(*zone, field, field, none, none, none, none)
    found, errors = _refined(
        partial(_history_on, body, own, f, loads), partial(_compare_instants, f * loads[0]), tol
    )
    state = found.a, found.c, found.shear, found.status
    q = np.where(
        np.isnan(found.shear[:, :1]), np.nan, _shear_at(body, own, f, found.mesh, x, state)
    )
    slip = _slip_at(found.mesh, x, found.slip)
    zone = found.a, found.c, found.m, found.n, found.intervals, found.regime
    return History(*zone, q, slip, found.work, *errors)


def _history_on(
    body: Body, own: Own, f: float, loads: Array, count: int, coarse: _Instants | None
) -> _Instants:
    """The history on one mesh."""
    way = path(body, own, f, loads, REACH / count, count // FEWEST, True)
    mesh = _elements(body, own, way, coarse, count)
    interface, instants = Interface(body, own, f, way, mesh), loads.shape[1]
    m, n, between = np.full((3, instants), np.nan)
    intervals, regime = np.zeros((2, instants), dtype=np.int64)
    shear, status, slip, density = np.full((4, instants, count), np.nan)
    slipped, worked, now = np.zeros(count), np.zeros(count), Regime.NONE
    for row in range(1, way.a.size):
        if now != Regime.UNSOLVED:
            now = interface.step(row)
            slipped, worked = slipped + interface.slip, worked + interface.work
        j = way.instant[row]
        if j < 0:
            continue
        regime[j] = now
        if now in (Regime.NONE, Regime.UNSOLVED):
            continue
        shear[j], status[j], slip[j], density[j] = (
            interface.shear,
            interface.status,
            slipped,
            worked,
        )
        m[j], n[j], intervals[j], between[j] = sticking(
            mesh, interface.shear, interface.bound, interface.status, way.a[row], way.c[row]
        )
    a, c = way.a[way.instant >= 0], way.c[way.instant >= 0]
    zone = m, n, between, intervals, regime, density @ mesh.widths
    return _Instants(mesh, a, c, *zone, shear, status, slip, density)


def _compare_instants(limit: Array, fine: _Instants, coarse: _Instants) -> tuple[Array, ...]:
    """The errors of a history: of zone and shear, of work, and of slip; limit is f P."""
    unsolved = (fine.regime == Regime.UNSOLVED) | (coarse.regime == Regime.UNSOLVED)
    shear = SAFETY * _apart(fine, coarse, "shear") @ fine.mesh.widths / limit
    error = np.maximum(_zone_error(fine, coarse, fine.a + fine.c), shear)
    error[unsolved] = np.nan
    work = SAFETY * _apart(fine, coarse, "density") @ fine.mesh.widths
    return error, work, SAFETY * np.max(_apart(fine, coarse, "slip"), axis=1)


# ---------------------------------------------------------------- steady cycles


class _Round(NamedTuple):
    """The last round of a cycle on one mesh: results as in SteadyCycle, and those of the elements.

    between     the distance between the elements that the ends of the stick zone lie between
    a, c        the contact at the first instant, whose shear and status follow
    slip_range  slip range in the round
    density     frictional work per length in the round
    total       slip in the round, forward plus backward
    """

    mesh: Any
    m: float
    n: float
    between: float
    regime: Regime
    work: float
    rounds: int
    drift: float
    a: float
    c: float
    shear: Any
    status: Any
    slip_range: Any
    density: Any
    total: Any


def steady_cycle(body: Body, own: Own, f: float, loads: Array, x: Array, tol: float) -> SteadyCycle:
    """A steady cycle with its errors, on as many meshes as it needs.

    loads: P, M, Q and sigma, one row each; those of the last instant are those of the first.
    """
    nan, none = math.nan, np.full(x.size, np.nan)
    touches = touching(body, own, *loads[:2])[0] > -math.inf
    if not (np.all(touches) and np.all(np.isfinite(loads)) and f > 0):
        return SteadyCycle(nan, nan, Regime.NONE, none, none, nan, 0, nan, nan, nan, nan, nan)
    found, errors = _refined(partial(_cycle_on, body, own, f, loads), _compare_rounds, tol)
    zone = found.m, found.n, found.regime
    q = slip = none
    if found.mesh is not None:
        edges = np.array([[found.a], [found.c]])
        state = (*edges, found.shear[None], found.status[None])
        q = _shear_at(body, own, f, found.mesh, x, state)[0]
        slip = _slip_at(found.mesh, x, found.slip_range)
    return SteadyCycle(*zone, slip, q, found.work, found.rounds, found.drift, *errors)


def _cycle_on(
    body: Body, own: Own, f: float, loads: Array, count: int, coarse: _Round | None
) -> _Round:
    """The steady cycle on one mesh."""
    least = count // FEWEST  # the first steps apply the loads of the first instant
    way = path(body, own, f, loads, REACH / count, least, False)
    mesh = _elements(body, own, way, coarse, count)
    interface, always = Interface(body, own, f, way, mesh), np.ones(count, dtype=bool)
    before, drift, nan = np.zeros(count), math.inf, math.nan
    for rounds in range(MAX_ROUNDS + 1):
        total, work, slip, low, high = np.zeros((5, count))
        for row in range(1, least + 1) if rounds == 0 else range(least + 1, way.a.size):
            regime = interface.step(row)
            if regime not in (Regime.COMPUTED, Regime.FULL_STICK):
                return _Round(None, nan, nan, nan, regime, nan, 0, *[nan] * 8)
            always &= interface.bound > 0
            total, work = total + abs(interface.slip), work + interface.work
            slip = slip + interface.slip
            low, high = np.minimum(low, slip), np.maximum(high, slip)
        most = np.max(total)
        drift = np.max(abs(total - before)) / most if most > 0 else 0.0
        before = total
        if rounds > 1 and drift <= REPEATED:
            break
    a, c = np.min(way.a), np.min(way.c)
    m, n, between, regime = a, c, 0.0, Regime.FULL_STICK
    if most > 0 or a + c <= 0:
        # where nothing slips, elements may slip a little, but less as the mesh is refined
        less = total
        if coarse is not None and coarse.mesh is not None:
            fallen = value_at(coarse.mesh, coarse.total, mesh.middles) - total
            less = np.clip(total - fallen, 0.0, total)
        m, n, between = permanent(mesh, total, less <= NO_SLIP / count * most, always)
        regime = Regime.NO_STICK if math.isnan(m) else Regime.COMPUTED
        m, n = min(m, a), min(n, c)
    state = way.a[-1], way.c[-1], interface.shear, interface.status
    zone = m, n, between, regime, work @ mesh.widths, rounds, drift
    return _Round(mesh, *zone, *state, high - low, work, total)


def _compare_rounds(fine: _Round, coarse: _Round) -> tuple[float, ...]:
    """The errors of a steady cycle: of zone, work, slip range and shear."""
    if fine.mesh is None or coarse.mesh is None:
        return (math.nan,) * 4
    error = _zone_error(fine, coarse, fine.m + fine.n)
    if fine.drift > REPEATED:
        error = math.inf
    if fine.regime == Regime.NO_STICK:
        error = math.nan
    work = SAFETY * _apart(fine, coarse, "density") @ fine.mesh.widths + fine.drift * fine.work
    slip = SAFETY * np.max(_apart(fine, coarse, "slip_range"))
    shear = SAFETY * _apart(fine, coarse, "shear") @ fine.mesh.widths / (fine.a + fine.c)
    return error, work, slip, shear
