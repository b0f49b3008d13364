"""Load histories and steady cycles of a body: what a person gives, and what is told."""

import math
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Numbers, shape_of
from ..body import Asked, numbers_of
from ..chunks import any_lazy
from ..cycle import march, stick_zone
from ..types import Array, Contact, History, Regime, SteadyCycle, StickZone
from .batch import run
from .lazy import over_chunks
from .loops import stick_zone_of_loop

_LOADS = ("P", "M", "Q", "sigma")

_INSTANTS = {name: "t" for name in History._fields} | {"q": "t,p", "slip": "t,p"}
_CYCLES = {name: "" for name in SteadyCycle._fields} | {"slip_range": "p", "q": "p"}
"""Axes of the results: time, and places."""

TURNING = 1e-7
"""Of what stick_zone solves with mixed=True, the error in parts of the width."""


class _Given(NamedTuple):
    """Rows for a kernel: histories, parameters; the shape of one and its number of instants."""

    rows: Any
    own: Any
    cycles: tuple[int, ...]
    instants: int
    E_star: Any


def history(
    asked: Asked,
    P: Array,
    M: Array,
    Q: Array,
    sigma: Array,
    *,
    f: Array,
    E_star: Array,
    x: Array = None,
    tol: float = 1e-3,
) -> History:
    """Any load history: what sticks at every instant, shear, slip and friction's work.

        |q| <= f p, int q dx = Q, and slip only where |q| = f p, against it: one convex problem a
            step on elements; it begins with the contact under P[0], M[0] and no shear, then Q[0]
            and sigma[0] are applied
        constant P and M, sigma = k Q, |k| <= 8/(pi (a + c)), |Q| < f P: exact, MODERATE; a stack
            of reversals, each with load(m, n) = P - dQ/(2 f) and tilt(m, n) = alpha - dsigma/(4 f
            E*) by the changes since it, 2 Q and 2 sigma before the first one

    Parameters
    ----------
    {arguments}

    Returns
    -------
    History
        a, c, m, n [m]; intervals; regime; q [Pa], slip [m] at x; work [J/m]; error;
        work_error [J/m].  Time is not given, hence no rate of slip: what slips between two
        instants is np.diff(slip, axis=-2) where x is a row.  NaN where there is no contact;
        m and n where it slides, slip and work from then on.

    Notes
    -----
    Arguments broadcast; time lies along the last axis, and between two instants all loads go
    straight.  Many histories are shared by the cores; Dask arrays stay lazy.
    """
    numbers = _numbers(asked, (P, M, Q, sigma), f, E_star, x, tol)
    if any_lazy(numbers.values()):
        return over_chunks(asked.call, History, _INSTANTS, numbers, x, tol)
    given = _given(asked, numbers, x, tol)
    places = np.shape(x) if x is not None else ()
    count = math.prod(places) if x is not None else 0
    out = np.empty((given.rows.shape[0], given.instants * (9 + 2 * count)))
    law = asked.body.law
    run("history.reversals.each_history", law, given.rows, given.own, out)
    rest = np.flatnonzero(np.isnan(out[:, 5]))
    if rest.size:
        computed = np.empty((rest.size, out.shape[1]))
        run("history.solve.each_history", law, given.rows[rest], given.own[rest], computed)
        out[rest] = computed
    shape = (*given.cycles, given.instants)
    found = out.reshape((*shape, 9 + 2 * count))
    a, c, m, n, intervals, regime, work, error, work_error = (found[..., i] for i in range(9))
    q = slip = None
    if x is not None:
        q = (found[..., 9 : 9 + count] * given.E_star[..., None, None]).reshape((*shape, *places))
        slip = found[..., 9 + count :].reshape((*shape, *places))
    work, work_error = (v * given.E_star[..., None] for v in (work, work_error))
    intervals, regime = np.nan_to_num(intervals).astype(np.int64), regime.astype(np.int64)
    return History(a, c, m, n, intervals, regime, q, slip, work, error, work_error)


def steady_cycle(
    asked: Asked,
    P: Array,
    M: Array,
    Q: Array,
    sigma: Array,
    *,
    f: Array,
    E_star: Array,
    x: Array = None,
    tol: float = 1e-3,
) -> SteadyCycle:
    """What a closed load history settles to: the permanent stick zone, slip and work a cycle.

        as by stick_zone where that is exact, with `mixed` where the normal loads are constant
        M = 0, tilt and sigma constant, |Q| < f P: exact, MODERATE; [-m, n] is the contact under
            P_E = -(max(Q - f P) + max(-Q - f P))/(2 f), whatever the phase of P and Q
        else the history is repeated until slip repeats, and what sticks is what slips less in the
            last round, to and fro added, than 1e-4 of the most; how far the ends move with thirty
            times that is part of the error

    Parameters
    ----------
    {arguments}

    Returns
    -------
    SteadyCycle
        m, n [m]; regime; slip_range [m], q [Pa] at x; work [J/m]; rounds; drift; error;
        work_error [J/m].  Slip range, shear and work are computed on elements, even where m
        and n are exact.  NaN where the contact is lost or slides; m and n where no place
        sticks all the time.

    Notes
    -----
    Arguments broadcast; time lies along the last axis, and from the last instant the loads go
    back to the first.  Many cycles are shared by the cores; Dask arrays stay lazy.
    """
    numbers = _numbers(asked, (P, M, Q, sigma), f, E_star, x, tol)
    if any_lazy(numbers.values()):
        return over_chunks(asked.call, SteadyCycle, _CYCLES, numbers, x, tol)
    numbers |= dict(zip(_LOADS, _closed(tuple(numbers[k] for k in _LOADS)), strict=True))
    given = _given(asked, numbers, x, tol)
    places = np.shape(x) if x is not None else ()
    count = math.prod(places) if x is not None else 0
    out = np.empty((given.rows.shape[0], 8 + 2 * count))
    run("history.solve.each_cycle", asked.body.law, given.rows, given.own, out)
    found = out.reshape((*given.cycles, 8 + 2 * count))
    m, n, regime, work, rounds, drift, error, work_error = (found[..., i] for i in range(8))
    zone, accuracy = _exact(asked, numbers)
    known = np.isfinite(zone.m)
    m, n = np.where(known, zone.m, m), np.where(known, zone.n, n)
    regime = np.where(known, zone.regime, regime).astype(np.int64)
    error = np.where(known, accuracy, error)
    q = slip = None
    if x is not None:
        slip = found[..., 8 : 8 + count].reshape((*given.cycles, *places))
        q = (found[..., 8 + count :] * given.E_star[..., None]).reshape((*given.cycles, *places))
    work, work_error = work * given.E_star, work_error * given.E_star
    values = (m, n, regime, slip, q, work, rounds, drift, error, work_error)
    return SteadyCycle(*(v if v is None else v[()] for v in values))


def _exact(asked: Asked, numbers: Numbers) -> tuple[StickZone, Array]:
    """The zones of cycles that stick_zone solves, NaN of others; and how far they may be off."""
    shape = shape_of(numbers)
    full = {name: np.broadcast_to(value, shape) for name, value in numbers.items()}
    P, M, Q, sigma = (full.pop(name) for name in _LOADS)
    told = march(asked, P, M, Q, sigma, f=full["f"], E_star=full["E_star"])
    code = np.asarray(told.regime[..., 0])
    alike = np.all(told.regime == code[..., None], axis=-1)
    known = alike & np.isin(code, (Regime.MODERATE, Regime.LARGE, Regime.FULL_STICK))
    m, n = (np.where(known, np.min(v, axis=-1), np.nan) for v in (told.m, told.n))
    still = np.all((P[..., :1] == P) & (M[..., :1] == M), axis=-1)
    turns = np.asarray(alike & still & (code == Regime.MIXED))
    if np.any(turns):
        way = np.where(np.ptp(Q, axis=-1)[..., None] > 0, Q, sigma)
        low, high = (at(way, axis=-1)[..., None] for at in (np.argmin, np.argmax))
        changes = [
            np.take_along_axis(v, high, -1) - np.take_along_axis(v, low, -1) for v in (Q, sigma)
        ]
        dQ, dsigma = (v[turns, 0] for v in changes)
        held = {name: value[turns, 0] for name, value in full.items()}
        friction = {name: held.pop(name) for name in ("f", "E_star")}
        here = Contact(told.a[turns, 0], told.c[turns, 0], np.nan)
        mine = asked._replace(own=held)
        m[turns], n[turns], _ = stick_zone(mine, here, here, dQ, dsigma, **friction, mixed=True)
    rest = np.isnan(m)
    if np.any(rest):
        loads = (np.broadcast_to(v, shape)[rest] for v in (P, M, Q, sigma))
        held = {name: value[rest] for name, value in full.items()}
        friction = {name: held.pop(name) for name in ("f", "E_star")}
        m[rest], n[rest], _ = stick_zone_of_loop(asked._replace(own=held), *loads, **friction)
        code = np.where(rest & np.isfinite(m), Regime.MODERATE, code)
    return StickZone(m, n, code), np.where(code == Regime.MIXED, TURNING, 0.0)


def _closed(loads: tuple[Array, ...]) -> list[Any]:
    """Loads whose last instant is the first again."""
    arrays = [np.atleast_1d(np.asarray(v, dtype=np.float64)) for v in loads]
    instants = max(v.shape[-1] for v in arrays)
    full = [np.broadcast_to(v, (*v.shape[:-1], instants)) for v in arrays]
    if all(np.array_equal(v[..., 0], v[..., -1]) for v in full) and instants > 1:
        return full
    return [np.concatenate([v, v[..., :1]], axis=-1) for v in full]


def _numbers(
    asked: Asked, loads: tuple[Array, ...], f: Array, E_star: Array, x: Array, tol: float
) -> Numbers:
    """What broadcasts, by name.

    Raises TypeError for what is no real number, and for places that are a Dask array; ValueError
    for a tolerance that is not positive, and where there is no instant.
    """
    if not tol > 0:
        raise ValueError(f"tol must be positive; got {tol!r:.60}")
    if any_lazy([x]):
        raise TypeError("x must be there, a number or a NumPy array; got a Dask array")
    named = dict(zip(_LOADS, loads, strict=True))
    numbers = numbers_of(named, {"f": f, "E_star": E_star, **asked.own})
    if 0 in shape_of(numbers)[-1:]:
        raise ValueError("the last axis is time and must hold one instant at least; it is empty")
    return numbers


def _given(asked: Asked, numbers: Numbers, x: Array, tol: float) -> _Given:
    """Lay out what is given in rows.

    Raises ValueError for constants that change in time.
    """
    *cycles, instants = shape_of(numbers) or (1,)
    shape = (*cycles, instants)
    held = {}
    for name in ("f", "E_star", *asked.own):
        value = np.broadcast_to(numbers[name], shape).reshape(-1, instants)
        if np.any((value != value[:, :1]) & ~np.isnan(value)):
            raise ValueError(f"{name} must not change along the last axis, which is time")
        held[name] = value[:, :1]
    places = np.ravel(np.zeros(0) if x is None else numbers_of({"x": x}, {})["x"])
    count = held["f"].shape[0]
    whole = [np.broadcast_to(numbers[k], shape).reshape(-1, instants) for k in _LOADS]
    rows = [held["f"], np.full((count, 1), tol), np.full((count, 1), float(places.size))]
    rows += [v / held["E_star"] for v in whole] + [np.broadcast_to(places, (count, places.size))]
    own = np.hstack([np.empty((count, 0)), *(held[name] for name in asked.own)])
    modulus = held["E_star"].reshape(tuple(cycles))
    return _Given(
        np.ascontiguousarray(np.hstack(rows)),
        np.ascontiguousarray(own),
        tuple(cycles),
        instants,
        modulus,
    )


HISTORIES = (history, steady_cycle)
"""What every body is bound to."""
