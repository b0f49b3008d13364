r"""Tractions, slip and frictional work next to a single edge, from the series of zone.py.

With t = s - d the distance from the slip zone (derive/theory/edge.py)

    dq = f (p_1 + p_2) - sqrt(t) R(t)   in the stick zone,   dq = f (p_1 + p_2)   in the slip zone,
    slip range = (2/E*) int_0^(d - s) sqrt(u) R(-u) du,

times the direction of slip, +1 or -1.  The polynomial R makes dq tend to its full-stick value
far from the edge.  A part of a half-cycle obeys the same equations, with the change up to that
point.

The shear traction itself is known if the normal loads are constant.  The first loading to Q and
sigma produces half of the change under twice these loads, because friction in the slip zone is then
f p and not 2 f p.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..types import Array
from .zone import Coefficients, _demand_order, _numbers, evaluated_by_name, length, shifted

BEYOND = ((1.0, 3 / 2, 15 / 8), (1.0, 5 / 2), (1.0,))
"""binomial(k + 1/2, k - m), the factor of C_k d**(k - m) in the coefficient of t**m in R, for k =
m, m + 1, ..."""

STUCK = ((1.0, 3 / 2), (1.0,), ())
"""binomial(k - 1/2, k - 1 - m), the factor of the full-stick coefficients, for k = m + 1, ..."""

WORK = tuple(
    tuple(math.gamma(k + 1.5) * math.gamma(m + 2.5) / math.gamma(k + m + 4) for m in range(3))
    for k in range(3)
)
"""B(k + 3/2, m + 5/2) = int_0^1 s**(k + 1/2) (1 - s)**(m + 3/2) ds."""


class Tractions(NamedTuple):
    """Tractions at a point next to an edge, at one instant.

    Attributes
    ----------
    p : ndarray
        Pressure [Pa].
    q : ndarray
        Shear traction [Pa]; NaN where it depends on the path of the loads.
    dq : ndarray
        Change in the shear traction since the last reversal of the loads [Pa].
    """

    p: Array
    q: Array
    dq: Array


class Peak(NamedTuple):
    """The largest shear traction over a cycle.

    Attributes
    ----------
    s : ndarray
        Its distance from the edge [m].
    q : ndarray
        The shear traction [Pa].
    """

    s: Array
    q: Array


class _Edge(NamedTuple):
    """Coefficients of one edge; those beyond the order are zero."""

    now: Coefficients
    shear: Coefficients
    f: Any
    da: Any
    order: int


def _read(n: dict[str, Any], order: int) -> _Edge:
    L_N, L_T = (n.get(name, 0.0) if order > 1 else 0.0 for name in ("L_N", "L_T"))
    N_N, N_T = (n.get(name, 0.0) if order > 2 else 0.0 for name in ("N_N", "N_T"))
    now, shear = (n["K_N"], L_N, N_N), (n["K_T"], L_T, N_T)
    return _Edge(now, shear, n["f"], n.get("da", 0.0), order)


def _order(asked: Any, given: dict[str, Any]) -> int:
    """The order asked for, or the highest one that the coefficients allow."""
    pairs = (("L_N", "L_T"), ("N_N", "N_T"))
    known = [all(given[name] is not None for name in pair) for pair in pairs]
    return _demand_order(asked, 1 + known[0] + all(known))


def _pressure(coefficients: Coefficients, s: Any) -> Any:
    """The pressure by its series; zero outside the contact."""
    inside = np.maximum(s, 0.0)
    powers = sum(C * inside**k for k, C in enumerate(coefficients))
    return np.sqrt(inside) * powers


class _Half(NamedTuple):
    """A half-cycle up to an instant: slip zones and pressures in both contacts, and R."""

    d: Any
    d_before: Any
    now: Coefficients
    before: Coefficients
    stuck: list[Any]


def _half(edge: _Edge, share: Any = 1.0) -> _Half:
    """The half-cycle, or the first part of it; lengths are measured from the edge at the end of
    that part."""
    now = shifted(edge.now, (1 - share) * edge.da)
    before = shifted(edge.now, edge.da)
    moved, lag = share * edge.da, (1 - share) * edge.da
    # the same full-stick change, as a function of the distance from the edge at that instant
    V = edge.shear
    V = (V[0] + (V[1] / 2) * lag + (3 / 8) * V[2] * lag**2, V[1] + (3 / 2) * V[2] * lag, V[2])
    V = (share * V[0], share * V[1], share * V[2])
    d = length(now, before, V, edge.f, moved, edge.order)
    sense = np.where(V[0] < 0, -1.0, 1.0)
    stuck = []
    for m in range(3):
        R = 0.0
        for k in range(m, 3):
            factor = BEYOND[m][k - m]
            R = R + edge.f * factor * (now[k] * d ** (k - m) + before[k] * (d - moved) ** (k - m))
        for k in range(m + 1, 3):
            R = R - sense * V[k] * STUCK[m][k - 1 - m] * d ** (k - 1 - m)
        stuck.append(R)
    return _Half(d, d - moved, now, before, stuck)


def _change(edge: _Edge, half: _Half, s: Any) -> Any:
    """The change in the shear traction; s is the distance from the edge at that instant."""
    t = np.maximum(s - half.d, 0.0)
    stuck = np.sqrt(t) * sum(R * t**m for m, R in enumerate(half.stuck))
    slides = _pressure(half.now, s) + _pressure(half.before, s - half.d + half.d_before)
    return np.where(edge.shear[0] < 0, -1.0, 1.0) * (edge.f * slides - stuck)


def _scaled(edge: _Edge, factor: Any) -> _Edge:
    """The same edge under `factor` times the change in shear."""
    return edge._replace(shear=tuple(factor * V for V in edge.shear))


def _reversed(edge: _Edge) -> _Edge:
    """The reverse half-cycle; lengths are measured from the edge at its end."""
    V, lag = edge.shear, edge.da
    V = (V[0] + V[1] / 2 * lag + 3 / 8 * V[2] * lag**2, V[1] + 3 / 2 * V[2] * lag, V[2])
    back: Any = tuple(-one for one in V)
    return edge._replace(now=shifted(edge.now, lag), shear=back, da=-lag)


def tractions(
    s: Array,
    K_N: Array,
    K_T: Array,
    *,
    f: Array,
    L_N: Array = None,
    L_T: Array = None,
    N_N: Array = None,
    N_T: Array = None,
    da: Array = 0.0,
    order: int | None = None,
    share: Array = 1.0,
    back: bool = False,
    mean: Array = 0.0,
) -> Tractions:
    """Pressure and shear traction next to a single edge, at any instant of the steady cycle.

        in the slip zone   dq = f (p_1 + p_2)
        in the stick zone  dq = f (p_1 + p_2) - sqrt(s - d) R(s - d), which tends to its full-stick
            value far from the edge
        both are multiplied by the direction of slip, +1 or -1

    Parameters
    ----------
    s : array_like
        Distance inward from the position of the edge at the highest shear load [m].
    K_N : array_like
        Coefficient of sqrt(s) in the pressure [Pa/sqrt(m)].
    K_T : array_like
        Coefficient of 1/sqrt(s) in the full-stick change in shear, signed [Pa sqrt(m)].
    f : array_like
        Coefficient of friction [-].
    L_N : array_like, optional
        Coefficient of s**(3/2) in the pressure [Pa/m**(3/2)].
    L_T : array_like, optional
        Coefficient of sqrt(s) in the change in shear [Pa/sqrt(m)].
    N_N : array_like, optional
        Coefficient of s**(5/2) in the pressure [Pa/m**(5/2)].
    N_T : array_like, optional
        Coefficient of s**(3/2) in the change in shear [Pa/m**(3/2)].
    da : array_like, optional
        How much further out the edge is than at the other end of the half-cycle [m].
    order : int, optional
        1, 2 or 3; by default the highest order that the coefficients allow.
    share : array_like, optional
        Completed part of the half-cycle, from 0 to 1; all loads change linearly.
    back : bool, optional
        Whether to take the half-cycle that lowers the shear load, not the one that raises it.
    mean : array_like, optional
        Mean of K_T over the cycle [Pa sqrt(m)]; before the first cycle, Q and sigma rose from zero
        to their highest values.

    Returns
    -------
    Tractions
        p [Pa], q [Pa], dq [Pa].  NaN where slip_zone gives NaN; q is also NaN where the edge moves
        and the surfaces do not slip at s. Accurate where s is small compared with `reach`.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers, or the order is not a whole
        number.
    ValueError
        If the shapes of the arguments do not broadcast, or the order is not one that is allowed.

    Notes
    -----
    Arguments broadcast; results are float64 of the broadcast shape.

    Examples
    --------
    >>> p, q, dq = tractions(1e-4, 1e10, 1e6, f=0.5)
    >>> f"{q / p:.3g} and {dq / p:.3g}"  # slips: f and 2 f
    '0.5 and 1'
    """
    coefficients = dict(K_N=K_N, L_N=L_N, N_N=N_N, K_T=K_T, L_T=L_T, N_T=N_T)
    order = _order(order, coefficients)
    given = _numbers(dict(s=s, **coefficients, da=da, share=share, mean=mean), dict(f=f))

    def evaluate(**n: Any) -> Any:
        s, share, mean = n["s"], n["share"], n["mean"]
        share = np.where((share >= 0) & (share <= 1), share, np.nan)
        rising = _read(n, order)
        edge = _reversed(rising) if back else rising
        position = (share if back else 1 - share) * rising.da  # of the edge at this instant
        half = _half(edge, share)
        p, dq = _pressure(half.now, s - position), _change(edge, half, s - position)
        constant = rising.da == 0
        still = _scaled(rising, np.where(constant, 1.0, np.nan))
        whole = _change(still, _half(still), s)
        first = _scaled(still, 2 * np.abs(mean / rising.shear[0]) + 1)
        first_change = _change(first, _half(first), s) / 2
        leads = mean / rising.shear[0] >= 0
        lowest = np.where(leads, first_change - whole, -first_change)
        q = np.where(back, lowest + whole, lowest) + dq
        slides = np.where(edge.shear[0] < 0, -1.0, 1.0) * edge.f * p
        q = np.where(s - position <= half.d, slides, q)
        shown = p + 0 * half.d  # NaN where there is no slip zone
        return shown, q, dq

    result: Tractions = evaluated_by_name(evaluate, given, Tractions)
    return result


def slip_range(
    s: Array,
    K_N: Array,
    K_T: Array,
    *,
    f: Array,
    E_star: Array,
    L_N: Array = None,
    L_T: Array = None,
    N_N: Array = None,
    N_T: Array = None,
    da: Array = 0.0,
    order: int | None = None,
) -> Array:
    """Slip range of a cycle next to a single edge.

        (2/E*) int_0^(d - s) sqrt(u) R(-u) du; order 1: (8 f K_N/(3 E*)) (d - s)**(3/2)

    Parameters
    ----------
    s : array_like
        Distance inward from the position of the edge at the highest shear load [m].
    K_N : array_like
        Coefficient of sqrt(s) in the pressure [Pa/sqrt(m)].
    K_T : array_like
        Coefficient of 1/sqrt(s) in the full-stick change in shear, signed [Pa sqrt(m)].
    f : array_like
        Coefficient of friction [-].
    E_star : array_like
        Composite modulus, see E_star() [Pa].
    L_N : array_like, optional
        Coefficient of s**(3/2) in the pressure [Pa/m**(3/2)].
    L_T : array_like, optional
        Coefficient of sqrt(s) in the change in shear [Pa/sqrt(m)].
    N_N : array_like, optional
        Coefficient of s**(5/2) in the pressure [Pa/m**(5/2)].
    N_T : array_like, optional
        Coefficient of s**(3/2) in the change in shear [Pa/m**(3/2)].
    da : array_like, optional
        How much further out the edge is than at the other end of the half-cycle [m].
    order : int, optional
        1, 2 or 3; by default the highest order that the coefficients allow.

    Returns
    -------
    ndarray
        The slip range [m]; 0 where the surfaces stick. NaN where slip_zone gives NaN, and at
        points that leave the contact during the cycle.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers, or the order is not a whole
        number.
    ValueError
        If the shapes of the arguments do not broadcast, or the order is not one that is allowed.

    Notes
    -----
    Arguments broadcast; results are float64 of the broadcast shape.

    Examples
    --------
    >>> f"{slip_range(0.0, 1e10, 1e6, f=0.5, E_star=1e11):.3g}"
    '3.77e-07'
    """
    coefficients = dict(K_N=K_N, L_N=L_N, N_N=N_N, K_T=K_T, L_T=L_T, N_T=N_T)
    order = _order(order, coefficients)
    given = _numbers(dict(s=s, **coefficients, da=da), dict(f=f, E_star=E_star))

    def evaluate(**n: Any) -> Any:
        edge = _read(n, order)
        half = _half(edge)
        u = np.maximum(half.d - n["s"], 0.0)
        slip = sum(R * (-1) ** m * u ** (m + 1.5) / (m + 1.5) for m, R in enumerate(half.stuck))
        return np.where(n["s"] >= np.maximum(edge.da, 0.0), 2 / n["E_star"] * slip, np.nan)

    return evaluated_by_name(evaluate, given)


def work(
    K_N: Array,
    K_T: Array,
    *,
    f: Array,
    E_star: Array,
    L_N: Array = None,
    L_T: Array = None,
    N_N: Array = None,
    N_T: Array = None,
    order: int | None = None,
) -> Array:
    """Frictional work next to a single edge, per cycle and unit depth, at constant normal loads.

        2 int_0^d f p times the slip range ds; order 1: pi f**2 K_N**2 d**3/(3 E*)

    Parameters
    ----------
    K_N : array_like
        Coefficient of sqrt(s) in the pressure [Pa/sqrt(m)].
    K_T : array_like
        Coefficient of 1/sqrt(s) in the full-stick change in shear, signed [Pa sqrt(m)].
    f : array_like
        Coefficient of friction [-].
    E_star : array_like
        Composite modulus, see E_star() [Pa].
    L_N : array_like, optional
        Coefficient of s**(3/2) in the pressure [Pa/m**(3/2)].
    L_T : array_like, optional
        Coefficient of sqrt(s) in the change in shear [Pa/sqrt(m)].
    N_N : array_like, optional
        Coefficient of s**(5/2) in the pressure [Pa/m**(5/2)].
    N_T : array_like, optional
        Coefficient of s**(3/2) in the change in shear [Pa/m**(3/2)].
    order : int, optional
        1, 2 or 3; by default the highest order that the coefficients allow.

    Returns
    -------
    ndarray
        The work [J/m]. NaN where slip_zone gives NaN.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers, or the order is not a whole
        number.
    ValueError
        If the shapes of the arguments do not broadcast, or the order is not one that is allowed.

    Notes
    -----
    Arguments broadcast; results are float64 of the broadcast shape.

    Examples
    --------
    >>> f"{work(1e10, 1e6, f=0.5, E_star=1e11):.3g}"
    '0.00209'
    """
    coefficients = dict(K_N=K_N, L_N=L_N, N_N=N_N, K_T=K_T, L_T=L_T, N_T=N_T)
    order = _order(order, coefficients)
    given = _numbers(coefficients, dict(f=f, E_star=E_star))

    def evaluate(**n: Any) -> Any:
        edge = _read(n, order)
        half = _half(edge)
        total = sum(
            C * R * (-1) ** m / (m + 1.5) * WORK[k][m] * half.d ** (k + m + 3)
            for k, C in enumerate(edge.now)
            for m, R in enumerate(half.stuck)
        )
        return 4 * edge.f / n["E_star"] * total

    return evaluated_by_name(evaluate, given)


def peak(
    K_N: Array,
    K_T: Array,
    *,
    f: Array,
    L_N: Array = None,
    L_T: Array = None,
    N_N: Array = None,
    N_T: Array = None,
    order: int | None = None,
    mean: Array = 0.0,
) -> Peak:
    """The largest shear traction of a cycle next to a single edge, at constant normal loads.

        q = f p(s) at the end of the slip zone at the highest load; s = d if mean = 0

    Closer to the edge, q = f p, and q/p is largest.

    Parameters
    ----------
    K_N : array_like
        Coefficient of sqrt(s) in the pressure [Pa/sqrt(m)].
    K_T : array_like
        Coefficient of 1/sqrt(s) in the full-stick change in shear, signed [Pa sqrt(m)].
    f : array_like
        Coefficient of friction [-].
    L_N : array_like, optional
        Coefficient of s**(3/2) in the pressure [Pa/m**(3/2)].
    L_T : array_like, optional
        Coefficient of sqrt(s) in the change in shear [Pa/sqrt(m)].
    N_N : array_like, optional
        Coefficient of s**(5/2) in the pressure [Pa/m**(5/2)].
    N_T : array_like, optional
        Coefficient of s**(3/2) in the change in shear [Pa/m**(3/2)].
    order : int, optional
        1, 2 or 3; by default the highest order that the coefficients allow.
    mean : array_like, optional
        Mean of K_T over the cycle [Pa sqrt(m)]; before the first cycle, Q and sigma rose from zero
        to their highest values.

    Returns
    -------
    Peak
        s [m], q [Pa], positive in the direction of slip there. NaN where slip_zone
        gives NaN.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers, or the order is not a whole
        number.
    ValueError
        If the shapes of the arguments do not broadcast, or the order is not one that is allowed.

    Notes
    -----
    Arguments broadcast; results are float64 of the broadcast shape.

    Examples
    --------
    >>> s, q = peak(1e10, 1e6, f=0.5)
    >>> f"{s:.3g} m, {q:.3g} Pa"
    '0.0002 m, 7.07e+07 Pa'
    """
    coefficients = dict(K_N=K_N, L_N=L_N, N_N=N_N, K_T=K_T, L_T=L_T, N_T=N_T)
    order = _order(order, coefficients)
    given = _numbers(dict(**coefficients, mean=mean), dict(f=f))

    def evaluate(**n: Any) -> Any:
        edge = _read(n, order)
        half = _half(_scaled(edge, 2 * np.abs(n["mean"] / edge.shear[0]) + 1))
        return half.d, edge.f * _pressure(half.now, half.d)

    result: Peak = evaluated_by_name(evaluate, given, Peak)
    return result


def reach(
    K_N: Array, K_T: Array, *, L_N: Array = None, L_T: Array = None, h: Array = None
) -> Array:
    """The distance from the edge at which the next term of the series equals the first.

        the least of |K_N/L_N|, |K_T/L_T| and h; those not given are left out

    Parameters
    ----------
    K_N : array_like
        Coefficient of sqrt(s) in the pressure [Pa/sqrt(m)].
    K_T : array_like
        Coefficient of 1/sqrt(s) in the full-stick change in shear, signed [Pa sqrt(m)].
    L_N : array_like, optional
        Coefficient of s**(3/2) in the pressure [Pa/m**(3/2)].
    L_T : array_like, optional
        Coefficient of sqrt(s) in the change in shear [Pa/sqrt(m)].
    h : array_like, optional
        Width of the contact, if it is known [m].

    Returns
    -------
    ndarray
        The distance [m]; the relative error of a first-order slip zone d is about d divided by it.
        NaN if none of L_N, L_T and h is given.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If the shapes of the arguments do not broadcast.

    Notes
    -----
    Arguments broadcast; results are float64 of the broadcast shape.

    Examples
    --------
    >>> f"{reach(1e10, 1e6, L_N=-5e12, L_T=2e8):.3g} m"
    '0.002 m'
    """
    given = _numbers(dict(K_N=K_N, K_T=K_T, L_N=L_N, L_T=L_T), dict(h=h))

    def evaluate(**n: Any) -> Any:
        pairs = (("K_N", "L_N"), ("K_T", "L_T"))
        known = [np.abs(n[one] / n[two]) for one, two in pairs if two in n]
        known += [n["h"]] if "h" in n else []
        return np.minimum.reduce(np.broadcast_arrays(*known)) if known else np.nan

    return evaluated_by_name(evaluate, given)
