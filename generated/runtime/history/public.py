"""Load histories and steady cycles of a body: the functions that a generated module calls."""

import math
from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager, nullcontext
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from ..arrays import number, numbers_of, shape_of
from ..body import Body
from ..chunks import any_lazy, over_chunks
from ..cycle import Own, contact, slip_range
from ..types import Array, History, March, Regime, SteadyCycle, StickZone, Values
from . import refine
from .loops import stick_zone_of_loop
from .march import in_phase, is_limited
from .reversals import exact_history

LOADS = ("P", "M", "Q", "sigma")
"""The loads of a history, in the order of their rows."""

_AXES: dict[Any, dict[str, str]] = {
    March: dict.fromkeys(March._fields, "t"),
    History: dict.fromkeys(History._fields, "t") | {"q": "t,p", "slip": "t,p"},
    SteadyCycle: dict.fromkeys(SteadyCycle._fields, "") | {"slip_range": "p", "q": "p"},
}
"""Axes of the results: t is time, p the points."""

WHOLE = ("intervals", "regime", "rounds")
"""Results that are integers."""

ROUGH_TOL = 1e-2
"""Tolerance of the steady cycle that tells whether a zone can carry the shear load."""

MIXED_ERROR = 1e-7
"""Error of a zone from stick_zone with mixed=True, relative to the contact width."""


def march(body: Body, own: Own, given: tuple[Values, ...]) -> March:
    """A steady cycle instant by instant."""
    found: March = _answer(March, partial(_march, body), (), 2, *_named(own, given))
    return found


def history(body: Body, own: Own, given: tuple[Values, ...], x: Any, tol: float) -> History:
    """Stick zone, shear traction, slip and work at each instant of any load history."""
    solve = partial(_each, History, partial(_history, body), x, _demand(x, tol))
    found: History = _answer(History, solve, np.shape(x), 1, *_named(own, given))
    return found


def steady_cycle(
    body: Body, own: Own, given: tuple[Values, ...], x: Any, tol: float
) -> SteadyCycle:
    """The steady cycle to which a closed load history settles."""
    solve = partial(_cycles, body, x, _demand(x, tol))
    found: SteadyCycle = _answer(SteadyCycle, solve, np.shape(x), 1, *_named(own, given))
    return found


# ---------------------------------------------------------------- arguments and results


class _Cases(NamedTuple):
    """All cases of the arguments, broadcast, for E* = 1.

    loads            P, M, Q and sigma over E*, one row each; time lies along the last axis
    f, E_star, own   as given; time has length one
    """

    loads: Array
    f: Array
    E_star: Array
    own: dict[str, Array]

    def constants(self, at: Any) -> tuple[Own, float]:
        """The body's parameters and f of one case."""
        return {name: value[at][0] for name, value in self.own.items()}, self.f[at][0]


def _named(own: Own, given: tuple[Values, ...]) -> tuple[Own, Own]:
    """The loads, and the constants, by name; `given` are loads, f and E_star."""
    *loads, f, E_star = given
    return dict(zip(LOADS, loads, strict=True)), {"f": f, "E_star": E_star, **own}


def _answer(
    kind: Any,
    solve: Callable[[_Cases], Any],
    places: tuple[int, ...],
    least: int,
    loads: Own,
    constants: Own,
) -> Any:
    """What is found for all cases, chunk by chunk if an argument is a Dask array.

    kind: of the result
    places: the shape of the points
    least: the smallest number of instants

    Raises TypeError if an argument is not a real number, and ValueError if there are too few
    instants or a constant changes with time.
    """
    numbers = numbers_of(loads, constants)
    shape = shape_of(numbers) or (1,)
    if shape[-1] < least:
        raise ValueError(f"the last axis is time and must have {least} or more values; got {shape}")
    if any_lazy(numbers.values()):
        call = partial(_answer, kind, solve, places, least)
        return over_chunks(
            call, kind.__name__.lower(), numbers, (loads, constants), _AXES[kind], places
        )
    full = {name: np.broadcast_to(value, shape) for name, value in numbers.items()}
    for name in constants:
        if np.any(np.fmin.reduce(full[name], -1) < np.fmax.reduce(full[name], -1)):
            raise ValueError(f"{name} must not change along the last axis, which is time")
    # NaN at one instant is NaN at all of them
    held = {name: np.min(full[name], axis=-1, keepdims=True) for name in constants}
    f, E_star = held.pop("f"), held.pop("E_star")
    with np.errstate(all="ignore"):
        return solve(_Cases(np.stack([full[k] for k in LOADS]) / E_star, f, E_star, held))


def _demand(x: Any, tol: float) -> float:
    """tol, if it is positive and x is not a Dask array.

    Raises TypeError or ValueError otherwise.
    """
    if any_lazy([x]):
        raise TypeError("x must be a number or a NumPy array, not a Dask array: pass x.compute()")
    return number(tol, "tol", "positive finite")


def _each(kind: Any, solve: Callable[..., Any], x: Any, tol: float, cases: _Cases) -> Any:
    """The results of all cases, one after the other.

    solve: returns those of one case, without the last instants if these are not known; None if
        there is no contact.
    """
    *shape, instants = cases.loads.shape[1:]
    places = np.asarray(numbers_of({"x": np.zeros(0) if x is None else x}, {})["x"])
    points = np.ravel(places)
    lengths = {"t": (instants,), "p": (points.size,), "t,p": (instants, points.size), "": ()}
    results: dict[str, Any] = {
        name: np.zeros((*shape, *lengths[axis]), dtype=np.int64)
        if name in WHOLE
        else np.full((*shape, *lengths[axis]), np.nan)
        for name, axis in _AXES[kind].items()
    }
    for at in _shown(list(np.ndindex(*shape))):
        with _one_thread()():
            found = solve(at, *cases.constants(at), cases.loads[:, *at], points, tol)
        for name, value in found._asdict().items() if found else ():
            scale = cases.E_star[at][0] if name in ("q", "work") else 1
            results[name][(*at, *(slice(length) for length in np.shape(value)))] = scale * value
    for name, value in results.items():
        if "p" in _AXES[kind][name]:
            value = None if x is None else value.reshape((*value.shape[:-1], *places.shape))
        results[name] = None if value is None else value[()]
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


# ---------------------------------------------------------------- cases, for E* = 1


def _march(body: Body, cases: _Cases) -> March:
    """The states of all cycles."""
    states: March
    states, cycles, regimes = in_phase(body, cases.own, cases.f, cases.loads, False)
    limited = is_limited(regimes, cycles) & (regimes != Regime.MIXED)
    for at in map(tuple, np.argwhere(limited)):
        none = np.zeros(0)
        found = refine.steady_cycle(body, *cases.constants(at), cycles[:, *at], none, ROUGH_TOL)
        if found and found.regime == Regime.NO_STICK:
            states.m[at] = states.n[at] = np.nan
            states.left[at] = states.right[at] = 0
            states.regime[at] = Regime.NO_STICK
    return states


def _history(
    body: Body, at: Any, own: Own, f: float, loads: Array, x: Array, tol: float
) -> History | None:
    """One history, up to the first instant whose loads are not known."""
    known = np.cumprod(np.all(np.isfinite(loads), axis=0), dtype=bool)
    if not np.any(known):
        return None
    loads = loads[:, known]
    return exact_history(body, own, f, loads, x) or refine.history(body, own, f, loads, x, tol)


def _cycles(body: Body, x: Any, tol: float, cases: _Cases) -> SteadyCycle:
    """Steady cycles; their first instant is repeated at the end unless they already end with it."""
    loads = cases.loads
    if loads.shape[-1] == 1 or not np.array_equal(loads[..., 0], loads[..., -1]):
        cases = cases._replace(loads=np.concatenate([loads, loads[..., :1]], axis=-1))
    solve = partial(_cycle, body, *_exact(body, cases))
    found: SteadyCycle = _each(SteadyCycle, solve, x, tol, cases)
    return found


def _cycle(
    body: Body,
    zones: StickZone,
    changes: Array,
    at: Any,
    own: Own,
    f: float,
    loads: Array,
    x: Array,
    tol: float,
) -> SteadyCycle | None:
    """One steady cycle; its zone is the exact one if that is permanent."""
    m, n, regime = (v[at] for v in zones)
    found = refine.steady_cycle(body, own, f, loads, x, tol)
    if not found or math.isnan(m):
        return found
    if is_limited(regime, loads) and found.regime == Regime.NO_STICK:
        return found
    error = MIXED_ERROR if regime == Regime.MIXED else 0.0
    found = found._replace(m=m, n=n, regime=regime, error=error)
    constant = np.ptp(loads[0]) == np.ptp(loads[1]) == 0
    if x.size and constant and regime in (Regime.MODERATE, Regime.LARGE):
        here = contact(body, own, loads[0, 0], loads[1, 0], 1.0)
        exact = slip_range(body, own, x, (here, here, *changes[:, *at], f, 1.0))
        found = found._replace(slip_range=exact)
    return found


def _exact(body: Body, cases: _Cases) -> tuple[StickZone, Array]:
    """Exact stick zones, NaN for cycles without an exact solution, and the largest changes in Q and
    sigma over cycles in phase."""
    loads, f, own = cases.loads, cases.f, cases.own
    states, cycles, _ = in_phase(body, own, f, loads, True)
    code = states.regime[..., 0]
    known = np.all(states.regime == code[..., None], axis=-1)
    m, n = (np.where(known, np.fmin.reduce(v, axis=-1), np.nan) for v in states[2:4])
    rest = np.isnan(m)
    if np.any(rest):
        held = {name: value[rest] for name, value in own.items()}
        m[rest], n[rest], _ = stick_zone_of_loop(body, held, f[rest], loads[:, rest])
    zones = StickZone(m, n, np.where(rest & np.isfinite(m), Regime.MODERATE, code))
    return zones, cycles[2:, ..., 1] - cycles[2:, ..., 0]
