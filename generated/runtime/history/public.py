"""Load histories and steady cycles of a body: the functions that a generated module calls."""

import math
from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager, nullcontext
from functools import cache, partial
from typing import Any

import numpy as np

from ..arrays import Numbers, numbers_of, shape_of
from ..body import Body
from ..chunks import any_lazy, over_chunks
from ..cycle import Own, contact, slip_range
from ..types import Array, History, March, Regime, SteadyCycle, StickZone, Values
from . import refine
from .loops import stick_zone_of_loop
from .march import LOADS, in_phase, is_limited
from .reversals import exact_history

_INSTANTS = {name: "t" for name in History._fields} | {"q": "t,p", "slip": "t,p"}
_CYCLES = {name: "" for name in SteadyCycle._fields} | {"slip_range": "p", "q": "p"}
"""Axes of the results: t is time, p the points."""

WHOLE = ("intervals", "regime", "rounds")
"""Results that are integers."""

ROUGH_TOL = 1e-2
"""Tolerance of the steady cycle that tells whether a zone can carry the shear load."""

MIXED_ERROR = 1e-7
"""Error of a zone from stick_zone with mixed=True, relative to the contact width."""


def march(
    body: Body,
    own: Own,
    P: Values,
    M: Values,
    Q: Values,
    sigma: Values,
    f: Values,
    E_star: Values,
) -> March:
    """A steady cycle instant by instant."""
    numbers = _numbers(own, (P, M, Q, sigma), f, E_star, least=2)
    if any_lazy(numbers.values()):
        axes = dict.fromkeys(March._fields, "t")
        lazy: March = over_chunks(partial(march, body), "march", numbers, (own,), axes)
        return lazy
    states, cycles, regimes = _in_phase(body, tuple(own), numbers, False)
    constants = np.broadcast_arrays(*(numbers[name] for name in ("f", *own)), states.regime)[:-1]
    limited = np.isin(regimes, (Regime.LARGE, Regime.FULL_STICK))
    for case in map(tuple, np.argwhere(limited)):
        if is_limited(regimes[case], cycles[:, *case]):
            friction, *parameters = (value[case][0] for value in constants)
            here = dict(zip(own, parameters, strict=True))
            with np.errstate(all="ignore"):
                found = refine.steady_cycle(
                    body, here, friction, cycles[:, *case], np.zeros(0), ROUGH_TOL
                )
            if found.regime == Regime.NO_STICK:
                states.m[case] = states.n[case] = np.nan
                states.left[case] = states.right[case] = 0
                states.regime[case] = Regime.NO_STICK
    return states


def history(
    body: Body,
    own: Own,
    P: Values,
    M: Values,
    Q: Values,
    sigma: Values,
    f: Values,
    E_star: Values,
    x: Values | None,
    tol: float,
) -> History:
    """Stick zone, shear traction, slip and work at each instant of any load history."""
    _demand(x, tol)
    numbers = _numbers(own, (P, M, Q, sigma), f, E_star)
    if any_lazy(numbers.values()):
        call = partial(history, body, x=x, tol=tol)
        lazy: History = over_chunks(
            call, "history", numbers, (own,), _INSTANTS, np.asarray(x).shape
        )
        return lazy
    found: History = _each(_history, History, _INSTANTS, body, own, numbers, x, tol)
    return found


def steady_cycle(
    body: Body,
    own: Own,
    P: Values,
    M: Values,
    Q: Values,
    sigma: Values,
    f: Values,
    E_star: Values,
    x: Values | None,
    tol: float,
) -> SteadyCycle:
    """The steady cycle to which a closed load history settles."""
    _demand(x, tol)
    numbers = _numbers(own, (P, M, Q, sigma), f, E_star)
    if any_lazy(numbers.values()):
        call = partial(steady_cycle, body, x=x, tol=tol)
        lazy: SteadyCycle = over_chunks(
            call, "steady_cycle", numbers, (own,), _CYCLES, np.asarray(x).shape
        )
        return lazy
    numbers |= dict(zip(LOADS, _closed([numbers[k] for k in LOADS]), strict=True))
    zones = _exact(body, tuple(own), numbers)
    found: SteadyCycle = _each(
        partial(_cycle, zones), SteadyCycle, _CYCLES, body, own, numbers, x, tol
    )
    return found if np.ndim(found.m) else SteadyCycle(*(v if v is None else v[()] for v in found))


# ---------------------------------------------------------------- arguments and results


def _closed(loads: list[Any]) -> list[Any]:
    """The loads with their first instant repeated at the end, unless they already end with it."""
    arrays = [np.atleast_1d(v) for v in loads]
    instants = max(v.shape[-1] for v in arrays)
    full = [np.broadcast_to(v, (*v.shape[:-1], instants)) for v in arrays]
    if all(np.array_equal(v[..., 0], v[..., -1]) for v in full) and instants > 1:
        return full
    return [np.concatenate([v, v[..., :1]], axis=-1) for v in full]


def _demand(x: Values | None, tol: float) -> None:
    """Raise TypeError if tol is not a number or x is a Dask array, ValueError if tol is not
    positive."""
    if isinstance(tol, bool) or not isinstance(tol, int | float | np.number):
        raise TypeError(f"tol must be a number; got {tol!r:.60}")
    if not 0 < tol < math.inf:
        raise ValueError(f"tol must be positive and finite; got {tol!r:.60}")
    if any_lazy([x]):
        raise TypeError("x must be a number or a NumPy array, not a Dask array: pass x.compute()")


def _numbers(
    own: Own, loads: tuple[Values, ...], f: Values, E_star: Values, least: int = 1
) -> Numbers:
    """The arguments that broadcast, by name.

    Raises TypeError if an argument is not a real number, and ValueError if there are too few
    instants or a constant changes with time.
    """
    named = dict(zip(LOADS, loads, strict=True))
    numbers = numbers_of(named, {"f": f, "E_star": E_star, **own})
    shape = shape_of(numbers) or (1,)
    if shape[-1] < least:
        wanted = ("one instant", "two instants")[least - 1]
        raise ValueError(f"the last axis is time and must contain at least {wanted}; got {shape}")
    if any_lazy(numbers.values()):
        return numbers
    for name in ("f", "E_star", *own):
        value = np.atleast_1d(numbers[name])
        if np.any((value != value[..., :1]) & ~np.isnan(value)):
            raise ValueError(f"{name} must not change along the last axis, which is time")
    return numbers


def _each(
    solve: Callable[..., Any],
    kind: Any,
    axes: Mapping[str, str],
    body: Body,
    own: Own,
    numbers: Numbers,
    x: Values | None,
    tol: float,
) -> Any:
    """The results of all cases.

    solve: returns those of one case for E* = 1, and may leave out the last instants.
    axes: axes of each result.
    """
    *cases, instants = shape_of(numbers) or (1,)
    full = {k: np.broadcast_to(v, (*cases, instants)) for k, v in numbers.items()}
    places = np.asarray(numbers_of({"x": np.zeros(0) if x is None else x}, {})["x"])
    points = np.ravel(places)
    lengths = {"t": (instants,), "p": (points.size,), "t,p": (instants, points.size), "": ()}
    results: dict[str, Any] = {
        name: np.zeros((*cases, *lengths[axis]), dtype=np.int64)
        if name in WHOLE
        else np.full((*cases, *lengths[axis]), np.nan)
        for name, axis in axes.items()
    }
    for at in _shown(list(np.ndindex(*cases))):
        f, E_star = full["f"][at][0], full["E_star"][at][0]
        parameters = {name: full[name][at][0] for name in own}
        loads = np.array([full[name][at] / E_star for name in LOADS])
        with _one_thread()(), np.errstate(all="ignore"):
            found = solve(at, body, parameters, f, loads, points, tol)
        for name, value in found._asdict().items():
            scale = E_star if name in ("q", "work") else 1
            results[name][(*at, *(slice(length) for length in np.shape(value)))] = scale * value
    for name, axis in axes.items():
        if "p" in axis:
            shape = (*results[name].shape[:-1], *places.shape)
            results[name] = None if x is None else results[name].reshape(shape)
    return kind(**results)


@cache
def _one_thread() -> Callable[[], AbstractContextManager[Any]]:
    """Linear algebra on one thread, which is faster than several for matrices as small as these."""
    try:
        from threadpoolctl import ThreadpoolController
    except ImportError:
        return nullcontext
    return partial(ThreadpoolController().limit, limits=1, user_api="blas")


def _shown(cases: list[Any]) -> Iterable[Any]:
    """The cases; with a bar if they take long, tqdm is installed, and stderr is a terminal."""
    try:
        from tqdm import tqdm
    except ImportError:
        return cases
    bar: Iterable[Any] = tqdm(cases, unit="case", delay=1.0, leave=False, disable=None)
    return bar


# ---------------------------------------------------------------- one case, for E* = 1


def _history(
    at: Any, body: Body, own: Own, f: float, loads: Array, x: Array, tol: float
) -> History:
    """One history, up to the first instant whose loads are not known."""
    known = np.cumprod(np.all(np.isfinite(loads), axis=0), dtype=bool)
    if not np.any(known):
        known[:1] = True
    loads = loads[:, known]
    return exact_history(body, own, f, loads, x) or refine.history(body, own, f, loads, x, tol)


def _cycle(
    zones: StickZone,
    at: Any,
    body: Body,
    own: Own,
    f: float,
    loads: Array,
    x: Array,
    tol: float,
) -> SteadyCycle:
    """One steady cycle; its zone is the exact one if that is permanent."""
    m, n, regime = (v[at] for v in zones)
    found = refine.steady_cycle(body, own, f, loads, x, tol)
    if math.isnan(m) or (is_limited(regime, loads) and found.regime == Regime.NO_STICK):
        return found
    error = MIXED_ERROR if regime == Regime.MIXED else 0.0
    found = found._replace(m=m, n=n, regime=regime, error=error)
    constant = np.ptp(loads[0]) == np.ptp(loads[1]) == 0
    if x.size and constant and regime in (Regime.MODERATE, Regime.LARGE):
        found = found._replace(slip_range=_exact_range(body, own, f, loads, x))
    return found


def _exact_range(body: Body, own: Own, f: float, loads: Array, x: Array) -> Array:
    """The slip range of a half-cycle in phase, under constant normal loads."""
    here = contact(body, own, loads[0, 0], loads[1, 0], 1.0)
    varies = 2 if np.ptp(loads[2]) > np.ptp(loads[3]) * (here.a + here.c) else 3
    change = loads[2:, np.argmax(loads[varies])] - loads[2:, np.argmin(loads[varies])]
    dQ, dsigma = change if change[0] >= 0 else -change
    return slip_range(body, own, x, here, here, dQ, dsigma, f, 1.0)


def _in_phase(body: Body, own: tuple[str, ...], numbers: Numbers, mixed: bool) -> Any:
    """What in_phase finds for arguments by name."""
    shape = shape_of(numbers)
    full = {name: np.broadcast_to(value, shape) for name, value in numbers.items()}
    loads = np.stack([full[name] / full["E_star"] for name in LOADS])
    held = {name: full[name][..., :1] for name in own}
    with np.errstate(all="ignore"):
        return in_phase(body, held, full["f"][..., :1], loads, mixed)


def _exact(body: Body, own: tuple[str, ...], numbers: Numbers) -> StickZone:
    """Exact stick zones; NaN for cycles without an exact solution."""
    states, *_ = _in_phase(body, own, numbers, True)
    code = np.asarray(states.regime[..., 0])
    known = np.all(states.regime == code[..., None], axis=-1)
    m, n = (np.where(known, np.fmin.reduce(v, axis=-1), np.nan) for v in states[2:4])
    rest = np.isnan(m)
    if np.any(rest):
        given = {name: np.broadcast_to(v, states.m.shape)[rest] for name, v in numbers.items()}
        held = {name: given.pop(name) for name in own}
        m[rest], n[rest], _ = stick_zone_of_loop(body, held, **given)
        code = np.where(rest & np.isfinite(m), Regime.MODERATE, code)
    return StickZone(m, n, code)
