"""Load histories and steady cycles of a body: the functions that a generated module offers."""

import math
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Numbers, shape_of
from ..body import Asked, numbers_of
from ..chunks import any_lazy
from ..cycle import march, stick_zone
from ..types import FEATURES, ZONE, Array, Contact, History, Regime, SteadyCycle, StickZone
from .batch import run
from .lazy import over_chunks
from .loops import stick_zone_of_loop

_LOADS = ("P", "M", "Q", "sigma")

_INSTANTS = {name: "t" for name in History._fields} | {"q": "t,p", "slip": "t,p"}
_CYCLES = {name: "" for name in SteadyCycle._fields} | {"slip_range": "p", "q": "p"}
"""Axes of the results: t is time, p the points."""

TURNING = 1e-7
"""Error of a zone from stick_zone with mixed=True, relative to the contact width."""

STILL = 1e-4
"""Such a zone is permanent if its middle slips by less than this fraction of the work over f P, the
slip of all points on average.  If it cannot carry the mean shear load, it slips at every point."""


class _Given(NamedTuple):
    """Rows for a kernel, one per history.

    rows      f, tol, the number of points, the loads divided by E*, and the points
    own       parameters of the body
    cycles    shape of the histories, without the axis of time
    instants  number of instants
    E_star    composite modulus of each history
    """

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
    """Stick zone, shear traction, slip and frictional work at each instant of any load history.

        |q| <= f p, int q dx = Q, slip only where |q| = f p and opposite to q
        constant P and M, sigma = k Q, |k| <= 8/(pi (a + c)), |Q| < f P:
            load(m, n) = P - dQ/(2 f), tilt(m, n) = alpha - dsigma/(4 f E*)

    The first conditions are solved on elements, one convex problem per load step.  The history
    begins with the contact under P[0], M[0] without shear; then Q[0] and sigma[0] are applied.  In
    the second case the results are exact and the regime is MODERATE: dQ and dsigma are the changes
    since each reversal of the loads, or 2 Q and 2 sigma before the first one.

    Returns
    -------
    History
        a, c, m, n [m]; intervals; regime; q [Pa], slip [m] at x; work [J/m]; error; work_error
        [J/m]; slip_error [m].  All are NaN where there is no contact.  If the contact slides, m
        and n are NaN at that instant, and slip and work from then on.  If the regime is UNSOLVED,
        only a and c are known, for example after P = 0 with M != 0, when the contact approaches
        from a great distance.  Slip rates are not returned, because time is not an argument; for a
        1-D x, the slip between two instants is `np.diff(slip, axis=-2)`.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers, x is a Dask array,
        or tol is not a number.
    ValueError
        If the shapes of the arguments do not broadcast; if there is no instant; if f, E_star or a
        parameter of the body changes with time; or if tol is not positive.

    Notes
    -----
    Arguments broadcast; time lies along the last axis, and all loads vary linearly between two
    instants.  From P = 0 the loads grow in proportion, so that q = (Q/P) p while the contact is
    small.  Next to the ends of stick intervals, q is less accurate than on average.  Many
    histories are distributed over the cores; Dask arrays stay lazy.
    """
    numbers = _numbers(asked, (P, M, Q, sigma), f, E_star, x, tol)
    if any_lazy(numbers.values()):
        return over_chunks(asked.call, History, _INSTANTS, numbers, x, tol)
    given = _given(asked, numbers, x, tol)
    points = np.shape(x) if x is not None else ()
    count = math.prod(points) if x is not None else 0
    out = np.empty((given.rows.shape[0], given.instants * (FEATURES + 2 * count)))
    law = asked.body.law
    run("history.reversals.each_history", law, given.rows, given.own, out)
    rest = np.flatnonzero(np.isnan(out[:, 5]))
    if rest.size:
        computed = np.empty((rest.size, out.shape[1]))
        run("history.solve.each_history", law, given.rows[rest], given.own[rest], computed)
        out[rest] = computed
    shape = (*given.cycles, given.instants)
    columns = out.reshape((*shape, FEATURES + 2 * count))
    features = [columns[..., i] for i in range(FEATURES)]
    a, c, m, n, intervals, regime, work, error, work_error, slip_error = features
    q = slip = None
    if x is not None:
        tractions, slips = (
            columns[..., FEATURES : FEATURES + count],
            columns[..., FEATURES + count :],
        )
        q = (tractions * given.E_star[..., None, None]).reshape((*shape, *points))
        slip = slips.reshape((*shape, *points))
    work, work_error = (v * given.E_star[..., None] for v in (work, work_error))
    intervals, regime = np.nan_to_num(intervals).astype(np.int64), regime.astype(np.int64)
    return History(a, c, m, n, intervals, regime, q, slip, work, error, work_error, slip_error)


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
    """The steady cycle to which a closed load history settles: stick zone, slip range and work.

        M = 0, tilt and sigma constant, |Q| < f P: [-m, n] is the contact under
            P_E = -(max(Q - f P) + max(-Q - f P))/(2 f)

    In this case m and n are exact, whatever the phase between P and Q, and the regime is MODERATE.
    Where stick_zone is exact, m and n are its results, with mixed=True if the normal loads are
    constant and the middle of the zone does not slip on elements.  Otherwise the history is
    repeated until slip repeats.  The stick zone then consists of the points whose total slip in the
    last cycle, forward plus reverse, is below 1e-4 of the largest, or 5e-4 on fewer than 512
    elements.  The shift of its ends at a threshold of 3e-3 is part of the error.

    Returns
    -------
    SteadyCycle
        m, n [m]; regime; slip_range [m], q [Pa] at x; work [J/m]; rounds; drift; error;
        work_error [J/m]; slip_error [m]; shear_error [Pa].  Slip range, shear traction and work
        are computed on elements, even where m and n are exact; the slip range is NaN where x is
        not in contact throughout the cycle.  All are NaN if the contact is lost or slides; m and
        n are NaN if no point sticks throughout the cycle.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers, x is a Dask array,
        or tol is not a number.
    ValueError
        If the shapes of the arguments do not broadcast; if there is no instant; if f, E_star or a
        parameter of the body changes with time; or if tol is not positive.

    Notes
    -----
    Arguments broadcast; time lies along the last axis, and the loads return from the last instant
    to the first.  Many cycles are distributed over the cores; Dask arrays stay lazy.
    """
    numbers = _numbers(asked, (P, M, Q, sigma), f, E_star, x, tol)
    if any_lazy(numbers.values()):
        return over_chunks(asked.call, SteadyCycle, _CYCLES, numbers, x, tol)
    numbers |= dict(zip(_LOADS, _closed(tuple(numbers[k] for k in _LOADS)), strict=True))
    zone, accuracy = _exact(asked, numbers)
    given = _given(asked, numbers, x, tol)
    points = np.shape(x) if x is not None else ()
    count = math.prod(points) if x is not None else 0
    # the middle of the exact zone is one more point
    middle = np.broadcast_to((zone.n - zone.m) / 2, given.cycles)
    rows = np.column_stack([given.rows, middle.ravel()])
    rows[:, 2] += 1
    out = np.empty((rows.shape[0], ZONE + 2 * (count + 1)))
    run("history.solve.each_cycle", asked.body.law, rows, given.own, out)
    columns = out.reshape((*given.cycles, ZONE + 2 * (count + 1)))
    slips, tractions = np.split(columns[..., ZONE:], 2, axis=-1)
    m, n, regime, work, rounds, drift, *errors = (columns[..., i] for i in range(ZONE))
    error, work_error, slip_error, shear_error = errors
    with np.errstate(all="ignore"):
        limit = np.max(numbers["f"] * numbers["P"], axis=-1)
        still = slips[..., -1] * limit <= STILL * work * given.E_star
    still &= regime == Regime.COMPUTED
    known = np.isfinite(zone.m) & ((zone.regime != Regime.MIXED) | still)
    m, n = np.where(known, zone.m, m), np.where(known, zone.n, n)
    regime = np.where(known, zone.regime, regime).astype(np.int64)
    error = np.where(known, accuracy, error)
    q = slip = None
    if x is not None:
        slip = slips[..., :-1].reshape((*given.cycles, *points))
        q = (tractions[..., :-1] * given.E_star[..., None]).reshape((*given.cycles, *points))
    rounds = np.nan_to_num(rounds).astype(np.int64)
    work, work_error, shear_error = (v * given.E_star for v in (work, work_error, shear_error))
    errors = [error, work_error, slip_error, shear_error]
    values = (m, n, regime, slip, q, work, rounds, drift, *errors)
    return SteadyCycle(*(v if v is None else v[()] for v in values))


def _exact(asked: Asked, numbers: Numbers) -> tuple[StickZone, Array]:
    """Exact stick zones, NaN for cycles without an exact solution, and their errors.

    The error is relative to the contact width.
    """
    shape = shape_of(numbers)
    full = {name: np.broadcast_to(value, shape) for name, value in numbers.items()}
    P, M, Q, sigma = (full.pop(name) for name in _LOADS)
    states = march(asked, P, M, Q, sigma, f=full["f"], E_star=full["E_star"])
    code = np.asarray(states.regime[..., 0])
    uniform = np.all(states.regime == code[..., None], axis=-1)
    known = uniform & np.isin(code, (Regime.MODERATE, Regime.LARGE, Regime.FULL_STICK))
    m, n = (np.where(known, np.min(v, axis=-1), np.nan) for v in (states.m, states.n))
    constant = np.all((P[..., :1] == P) & (M[..., :1] == M), axis=-1)
    mixed = np.asarray(uniform & constant & (code == Regime.MIXED))
    if np.any(mixed):
        load = np.where(np.ptp(Q, axis=-1)[..., None] > 0, Q, sigma)
        low, high = (at(load, axis=-1)[..., None] for at in (np.argmin, np.argmax))
        changes = [
            np.take_along_axis(v, high, -1) - np.take_along_axis(v, low, -1) for v in (Q, sigma)
        ]
        dQ, dsigma = (v[mixed, 0] for v in changes)
        of_mixed, friction = _selected(asked, {k: v[..., 0] for k, v in full.items()}, mixed)
        here = Contact(states.a[mixed, 0], states.c[mixed, 0], np.nan)
        m[mixed], n[mixed], _ = stick_zone(of_mixed, here, here, dQ, dsigma, **friction, mixed=True)
    rest = np.isnan(m)
    if np.any(rest):
        loads = (np.broadcast_to(v, shape)[rest] for v in (P, M, Q, sigma))
        of_rest, friction = _selected(asked, full, rest)
        m[rest], n[rest], _ = stick_zone_of_loop(of_rest, *loads, **friction)
        code = np.where(rest & np.isfinite(m), Regime.MODERATE, code)
    return StickZone(m, n, code), np.where(code == Regime.MIXED, TURNING, 0.0)


def _selected(asked: Asked, constants: Numbers, cycles: Array) -> tuple[Asked, Numbers]:
    """The call with the body's parameters of some of the cycles, and their f and E_star."""
    own = {name: value[cycles] for name, value in constants.items()}
    friction = {name: own.pop(name) for name in ("f", "E_star")}
    return asked._replace(own=own), friction


def _closed(loads: tuple[Array, ...]) -> list[Any]:
    """The loads with their first instant repeated at the end, unless they already end with it."""
    arrays = [np.atleast_1d(np.asarray(v, dtype=np.float64)) for v in loads]
    instants = max(v.shape[-1] for v in arrays)
    full = [np.broadcast_to(v, (*v.shape[:-1], instants)) for v in arrays]
    if all(np.array_equal(v[..., 0], v[..., -1]) for v in full) and instants > 1:
        return full
    return [np.concatenate([v, v[..., :1]], axis=-1) for v in full]


def _numbers(
    asked: Asked, loads: tuple[Array, ...], f: Array, E_star: Array, x: Array, tol: float
) -> Numbers:
    """The arguments that broadcast, by name.

    Raises TypeError if an argument is not a real number or x is a Dask array, and ValueError if the
    tolerance is not positive or there is no instant.
    """
    if isinstance(tol, bool) or not isinstance(tol, int | float | np.number):
        raise TypeError(f"tol must be a number; got {tol!r:.60}")
    if not 0 < tol < math.inf:
        raise ValueError(f"tol must be positive and finite; got {tol!r:.60}")
    if any_lazy([x]):
        raise TypeError("x must be a number or a NumPy array, not a Dask array: pass x.compute()")
    named = dict(zip(_LOADS, loads, strict=True))
    numbers = numbers_of(named, {"f": f, "E_star": E_star, **asked.own})
    if 0 in shape_of(numbers)[-1:]:
        raise ValueError("the last axis is time and must contain at least one instant; it is empty")
    return numbers


def _given(asked: Asked, numbers: Numbers, x: Array, tol: float) -> _Given:
    """Arrange the arguments in rows.

    Raises ValueError if a constant changes with time.
    """
    *cycles, instants = shape_of(numbers) or (1,)
    shape = (*cycles, instants)
    held = {}
    for name in ("f", "E_star", *asked.own):
        value = np.broadcast_to(numbers[name], shape).reshape(-1, instants)
        if np.any((value != value[:, :1]) & ~np.isnan(value)):
            raise ValueError(f"{name} must not change along the last axis, which is time")
        held[name] = value[:, :1]
    points = np.ravel(np.zeros(0) if x is None else numbers_of({"x": x}, {})["x"])
    count = held["f"].shape[0]
    whole = [np.broadcast_to(numbers[k], shape).reshape(-1, instants) for k in _LOADS]
    rows = [held["f"], np.full((count, 1), tol), np.full((count, 1), float(points.size))]
    rows += [v / held["E_star"] for v in whole] + [np.broadcast_to(points, (count, points.size))]
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
"""Functions of load histories that are bound to every body."""
