r"""The slip zone at an edge, from the series of pressure and full-stick shear next to it.

At a distance s from the edge

    p = K_N s**(1/2) + L_N s**(3/2) + N_N s**(5/2),
    full-stick dq = K_T s**(-1/2) + L_T s**(1/2) + N_T s**(3/2).

For a single edge, take f (p_1 + p_2) of the contacts at both ends of the half-cycle, with slip
zones d_1 and d_2.  The bounded change in shear tends to that of full stick if
(derive/theory/edge.py)

    sum f (K_N d/2 + 3 L_N d**2/8 + 5 N_N d**3/16) = |K_T| + L_T d/2 + 3 N_T d**2/8,

with L_T and N_T positive in the direction of slip.  A contact of width h adds
sum f K_N d**2/(16 h) to the right-hand side.  If the other edge is known, both edges obey the
conditions of ../slip/series.py.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..arrays import evaluated, numbers_of
from ..types import Array
from .both import each_pair

PRESSURE = (1 / 2, 3 / 8, 5 / 16)
"""binomial(k + 1/2, k + 1), the factor of C_k d**(k + 1)."""

SHEAR = (1.0, 1 / 2, 3 / 8)
"""binomial(k - 1/2, k), the factor of the full-stick coefficients times d**k."""

GROWN = (1.0, 2 / 3, 8 / 15)
"""B(k + 1, 1/2)/2, the factor of b**k in K_N(b) that gives s**(k + 1/2) in the pressure."""

STEPS = 60
"""Largest number of Newton steps."""

Coefficients = tuple[Any, Any, Any]


class SlipZone(NamedTuple):
    """Length of a slip zone.

    Attributes
    ----------
    d : ndarray
        The length [m].
    error : ndarray
        Its change due to the next term of the series [m].
    """

    d: Array
    error: Array


class Pressure(NamedTuple):
    """p = K_N s**(1/2) + L_N s**(3/2) + N_N s**(5/2) next to an edge.

    Parameters
    ----------
    K_N : array_like
        Coefficient of s**(1/2) [Pa/sqrt(m)].
    L_N, N_N : array_like, optional
        Coefficients of s**(3/2) and s**(5/2) [Pa/m**(3/2), Pa/m**(5/2)]; None if not known.
    """

    K_N: Array
    L_N: Array = None
    N_N: Array = None


class OtherEdge(NamedTuple):
    """The other edge of a contact, as slip_zone takes it; signs as at that edge.

    Parameters
    ----------
    K_N : array_like
        Coefficient of s**(1/2) in the pressure [Pa/sqrt(m)].
    K_T : array_like
        Coefficient of 1/sqrt(s) in the full-stick change in shear [Pa sqrt(m)].
    L_N, N_N : array_like, optional
        Coefficients of s**(3/2) and s**(5/2) in the pressure [Pa/m**(3/2), Pa/m**(5/2)].
    da : array_like, optional
        How much further out the edge is than at the other end of the half-cycle [m].
    then : Pressure, optional
        Pressure next to this edge at the other end of the half-cycle.
    """

    K_N: Array
    K_T: Array
    L_N: Array = None
    N_N: Array = None
    da: Array = 0.0
    then: Any = None


def slip_zone(
    K_N: Array,
    K_T: Array,
    *,
    f: Array,
    L_N: Array = None,
    L_T: Array = None,
    da: Array = 0.0,
    h: Array = None,
    order: int | None = None,
    N_N: Array = None,
    N_T: Array = None,
    then: Pressure | None = None,
    other: OtherEdge | None = None,
) -> SlipZone:
    """Slip zone at an edge from its coefficients, for any body.

        order 1: d = |K_T|/(f K_N) + da/2
        order 2, with L_N and L_T: f K_N d + (3/4) f L_N d**2 = |K_T| + (L_T/2) d, with further
            terms where da is not zero; h adds f K_N d**2/(8 h) on the right
        order 3, with N_N and N_T as well, without h
        with h and the other edge: both conditions of a body's slip_zones, which determine L_T

    Parameters
    ----------
    K_N : array_like
        Coefficient of sqrt(s) in the pressure, s the distance inward [Pa/sqrt(m)].
    K_T : array_like
        Coefficient of 1/sqrt(s) in the full-stick change in shear, signed [Pa sqrt(m)].
    f : array_like
        Coefficient of friction [-].
    L_N, N_N : array_like, optional
        Coefficients of s**(3/2) and s**(5/2) in the pressure [Pa/m**(3/2), Pa/m**(5/2)].
    L_T, N_T : array_like, optional
        Coefficients of s**(1/2) and s**(3/2) in the change [Pa/sqrt(m), Pa/m**(3/2)].
    da : array_like, optional
        How much further out the edge is than at the other end of the half-cycle [m].
    h : array_like, optional
        Width of the contact, if it is known [m].
    order : int, optional
        1, 2 or 3; by default the highest order that the coefficients allow.
    then : Pressure, optional
        Pressure next to the edge at the other end of the half-cycle; by default it follows from
        K_N, L_N, N_N and da.
    other : OtherEdge, optional
        The other edge of the contact; needs h.

    Returns
    -------
    SlipZone
        d [m], error [m].  error is the change due to one more term; if no further coefficients are
        known, it is the change due to the last term, and NaN at order 1. Both are NaN unless K_N, f
        and h are positive and slip occurs in both contacts of the half-cycle.

    Raises
    ------
    ValueError
        If the coefficients do not allow the order, or if coefficients are given twice.

    Notes
    -----
    Arguments broadcast; results are float64 of the broadcast shape.

    Examples
    --------
    >>> d, error = slip_zone(1e10, 1e6, f=0.5)
    >>> f"{d:.3g} m"  # K_T/(f K_N)
    '0.0002 m'
    >>> d, error = slip_zone(1e10, 1e6, f=0.5, L_N=-5e12, L_T=5e8)
    >>> f"{d:.4g} m, to {error:.1g}"
    '0.0002317 m, to 3e-05'
    """
    if other is not None:
        return _with_other(K_N, K_T, f, L_N, L_T, da, h, order, N_N, N_T, then, other)
    most = 1 if L_N is None or L_T is None else 2 if N_N is None or N_T is None else 3
    if h is not None:
        most = min(most, 2)
    if then is not None:
        most = min(most, _terms(then))
    order = _demand_order(order, most)
    given = _numbers(
        dict(K_N=K_N, L_N=L_N, N_N=N_N, K_T=K_T, L_T=L_T, N_T=N_T, da=da), dict(f=f, h=h), then
    )

    def zones(**n: Any) -> Any:
        now = (n["K_N"], n.get("L_N", 0.0), n.get("N_N", 0.0))
        before = _before(now, n, n["da"])
        shear = (n["K_T"], n.get("L_T", 0.0), n.get("N_T", 0.0))
        found = [
            length(now, before, shear, n["f"], n["da"], k, n.get("h", np.inf))
            for k in range(1, most + 1)
        ]
        return found[order - 1], _error(found, order)

    found: SlipZone = evaluated_by_name(zones, given, SlipZone)
    return found


def _error(zones: list[Any], order: int) -> Any:
    """The change due to the next term, or else due to the last one."""
    if order < len(zones):
        return np.abs(zones[order] - zones[order - 1])
    if order > 1:
        return np.abs(zones[order - 1] - zones[order - 2])
    return np.full(np.shape(zones[0]), np.nan)


def _demand_order(order: Any, most: int) -> int:
    """Raise TypeError unless the order is a whole number, ValueError unless it is allowed."""
    if order is None:
        return most
    if isinstance(order, bool) or not isinstance(order, int | np.integer):
        raise TypeError(f"order must be a whole number; got {order!r:.60}")
    if not 1 <= order <= most:
        allowed = "1" if most == 1 else f"1 to {most}"
        raise ValueError(
            f"order must be {allowed} with the coefficients given; got {order}: order 2 needs L_N "
            "and L_T, and order 3 also needs N_N and N_T; with `other`, these coefficients are "
            "needed for the pressures at both edges, and for `then` if the edges move"
        )
    return int(order)


def _terms(pressure: Pressure | OtherEdge) -> int:
    """The number of known coefficients of a pressure."""
    return 1 if pressure.L_N is None else 2 if pressure.N_N is None else 3


def _numbers(given: dict[str, Any], positive: dict[str, Any], then: Any = None) -> dict[str, Any]:
    """All arguments as float64; those that must be positive become NaN unless they are."""
    if then is not None:
        given = given | {f"then.{name}": value for name, value in then._asdict().items()}
    known, constants = (
        {name: v for name, v in group.items() if v is not None} for group in (given, positive)
    )
    return numbers_of(known, constants)


def evaluated_by_name(
    function: Callable[..., Any], numbers: dict[str, Any], kind: Any = None
) -> Any:
    """A formula that takes its arguments by their names, because some may not be given."""
    names = tuple(numbers)
    return evaluated(
        lambda *values: function(**dict(zip(names, values, strict=True))), numbers, {}, kind
    )


def _before(now: Coefficients, n: dict[str, Any], move: Any) -> Coefficients:
    """The pressure at the other end of the half-cycle: as given, or derived from the current
    pressure."""
    if "then.K_N" in n:
        return n["then.K_N"], n.get("then.L_N", 0.0), n.get("then.N_N", 0.0)
    return shifted(now, move)


def shifted(pressure: Coefficients, move: Any) -> Coefficients:
    """The coefficients at a single edge after it has receded by `move`.

    K_N(b) = K_N + (3/2) L_N b + (15/8) N_N b**2 for an edge that has receded by b.
    """
    k_0, k_1, k_2 = (C / share for C, share in zip(pressure, GROWN, strict=True))
    moved = (k_0 + k_1 * move + k_2 * move**2, k_1 + 2 * k_2 * move, k_2)
    return tuple(k * share for k, share in zip(moved, GROWN, strict=True))


def length(
    now: Coefficients,
    before: Coefficients,
    shear: Coefficients,
    f: Any,
    da: Any,
    order: int,
    h: Any = np.inf,
) -> Any:
    """The slip zone at a single edge, to the given order, measured from the current position of the
    edge.

    Newton's method starts from the shortest possible slip zone, where friction is too small.
    """
    K_T = np.abs(shear[0])
    if order == 1:
        d = K_T / (f * now[0]) + da / 2
        return np.where((now[0] > 0) & (d >= np.maximum(da, 0.0)), d, np.nan)
    sense = np.where(shear[0] < 0, -1.0, 1.0)
    drives = [K_T, *(sense * V for V in shear[1:])][:order]
    holds = [
        [f * (C - (one[0] / (6 * h) if k == 1 else 0.0)) for k, C in enumerate(one[:order])]
        for one in (now, before)
    ]
    shortest = np.maximum(da, 0.0)
    d = np.array(np.broadcast_arrays(shortest, K_T, f, *now, *before)[0], float)
    start, _ = _excess(d, da, holds, drives)
    for _ in range(STEPS):
        value, rate = _excess(d, da, holds, drives)
        step = np.where(value == 0, 0.0, value / rate)
        d = d - step
        if not np.any(np.abs(step) > 4e-16 * np.abs(d)):
            break
    excess, rate = _excess(d, da, holds, drives)
    done = np.abs(step) <= 1e-12 * np.abs(d)
    exists = (now[0] > 0) & (before[0] > 0) & (d >= shortest) & (start <= 0) & done
    exists &= (rate > 0) & np.isfinite(excess)
    return np.where(exists, d, np.nan)


def _excess(d: Any, da: Any, holds: Any, drives: Any) -> Any:
    """Frictional resistance minus the driving term, and its derivative with respect to d."""
    value, rate = -drives[0], 0.0
    for one, reach in zip(holds, (d, d - da), strict=True):
        for k, C in enumerate(one):
            value = value + C * PRESSURE[k] * reach ** (k + 1)
            rate = rate + C * PRESSURE[k] * (k + 1) * reach**k
    for k, V in enumerate(drives[1:], 1):
        value = value - V * SHEAR[k] * d**k
        rate = rate - V * SHEAR[k] * k * d ** (k - 1)
    return value, rate


# ---------------------------------------------------------------- both edges


def _with_other(
    K_N: Any,
    K_T: Any,
    f: Any,
    L_N: Any,
    L_T: Any,
    da: Any,
    h: Any,
    asked: int | None,
    N_N: Any,
    N_T: Any,
    then: Any,
    other: OtherEdge,
) -> SlipZone:
    """The conditions of both edges, solved as in a body's slip_zones."""
    if h is None:
        raise ValueError("`other` can only be used with the width of the contact: give h, too")
    if L_T is not None or N_T is not None:
        raise ValueError(
            "L_T and N_T must not be given with `other`, because they follow from h and K_T of "
            "both edges: leave them out, or leave `other` out"
        )
    own = Pressure(K_N, L_N, N_N)
    befores = [side for side in (then, other.then) if side is not None]
    most = min(2, *map(_terms, (own, other, *befores)))
    order = _demand_order(asked, most)
    given = _numbers(dict(K_N=K_N, L_N=L_N, K_T=K_T, da=da), dict(f=f, h=h), then)
    alias = _numbers(other._replace(then=None)._asdict(), {}, other.then)
    given |= {f"other.{name}": value for name, value in alias.items()}

    def zones(**n: Any) -> Any:
        cases = np.stack(np.broadcast_arrays(*_rows(n)), -1)
        flat = np.ascontiguousarray(cases.reshape(-1, cases.shape[-1]))
        out = np.empty((len(flat), 2))
        each_pair(flat, out)
        found = [out[:, k].reshape(cases.shape[:-1]) for k in range(most)]
        return found[order - 1], _error(found, order)

    found: SlipZone = evaluated_by_name(zones, given, SlipZone)
    return found


def _rows(n: dict[str, Any]) -> list[Any]:
    """h, f, K_T and the displacements of both edges; the current pressures at both edges, and those
    at the other end of the half-cycle."""
    theirs = {name.removeprefix("other."): v for name, v in n.items() if name.startswith("other.")}
    h, sides = n["h"], (n, theirs)
    now = [(s["K_N"], s.get("L_N", 0.0)) for s in sides]
    before = []
    for side, (K, L), opposite in zip(sides, now, reversed(sides), strict=True):
        if "then.K_N" in side:
            before.append((side["then.K_N"], side.get("then.L_N", 0.0)))
            continue
        # a move of either edge adds the pressure of a flat punch: dp/da = K_N sqrt(h - s)/(2
        # sqrt(h s)) at the edge that moves, and K_N sqrt(s)/(2 h) at the other edge
        K_before = K + (1.5 * L + K / (4 * h)) * side["da"]
        K_before = K_before - opposite["K_N"] / (2 * h) * opposite["da"]
        before.append((K_before, L))
    loads = [h, n["f"], n["K_T"], theirs["K_T"], n["da"], theirs["da"]]
    return [*loads, *now[0], *now[1], *before[0], *before[1]]
