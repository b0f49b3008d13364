"""Slip zone, tractions and slip next to an edge, from the series of pressure and full-stick shear.

At a distance s from the edge

    p = K_N s**(1/2) + L_N s**(3/2),   full-stick dq = K_T s**(-1/2) + L_T s**(1/2).

Far from the edge the bounded change in shear tends to that of full stick.  This gives d, as in
`slip_zone`, and R(t) = R_0 + R_1 t in `tractions`.  At the first order, L_N = L_T = 0.  A
part of a half-cycle obeys the same equations, with the change up to that point.

The shear traction itself is known if the normal loads are constant.  The first loading to Q and
sigma produces half of the change under twice these loads, because friction in the slip zone is then
f p and not 2 f p.
"""

from typing import Any, NamedTuple

import numpy as np

from ..arrays import demand_order, evaluated
from ..types import Array, Values


class Edge(NamedTuple):
    """One edge at the end of the half-cycle that raises Q.

    Parameters
    ----------
    K_N, K_T, da, L_N, L_T
        As in slip_zone.
    side : str, optional
        "left" or "right", for `match`.
    """

    K_N: Values
    K_T: Values
    da: Values = 0.0
    L_N: Values | None = None
    L_T: Values | None = None
    side: str = "left"


class SlipZone(NamedTuple):
    """Length of a slip zone.

    Attributes
    ----------
    d : ndarray
        The length [m].
    error : ndarray
        The difference between the first and the second order [m].
    """

    d: Array
    error: Array


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


def slip_zone(
    K_N: Values,
    K_T: Values,
    *,
    f: Values,
    L_N: Values | None = None,
    L_T: Values | None = None,
    da: Values = 0.0,
    h: Values | None = None,
    order: int | None = None,
) -> SlipZone:
    """Slip zone at an edge from its coefficients, for any body.

        order 1: d = |K_T|/(f K_N) + da/2
        order 2: sum f (K_N d/2 + (3/8) L_N d**2 - K_N d**2/(16 h)) = |K_T| + (L_T/2) d

    The sum has a term for each end of the half-cycle, with the slip zone and K_N there.  L_T counts
    as positive in the direction of slip.

    Parameters
    ----------
    K_N : array_like
        Coefficient of sqrt(s) in the pressure, s the distance inward [Pa/sqrt(m)].
    K_T : array_like
        Coefficient of 1/sqrt(s) in the full-stick change in shear, signed [Pa sqrt(m)].
    f : array_like
        Coefficient of friction [-].
    L_N : array_like, optional
        Coefficient of s**(3/2) in the pressure [Pa/m**(3/2)].  Give both L_N and L_T, or neither.
    L_T : array_like, optional
        Coefficient of s**(1/2) in the change in shear [Pa/sqrt(m)].
    da : array_like, optional
        How much further out the edge is than at the other end of the half-cycle [m].
    h : array_like, optional
        Width of the contact, if it is known [m].
    order : int, optional
        1 or 2; by default the highest order that the coefficients allow.

    Returns
    -------
    SlipZone
        d [m], error [m], of the shape to which the arguments broadcast.  error is the difference
        between both orders, NaN if only the first is known. Both are NaN unless K_N, f and h are
        positive and slip occurs in both contacts of the half-cycle.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers, or the order is not a whole
        number.
    ValueError
        If only one of L_N and L_T is given, the order needs both, or the shapes do not broadcast.

    Examples
    --------
    >>> d, error = slip_zone(1e10, 1e6, f=0.5)
    >>> f"{d:.3g} m"  # K_T/(f K_N)
    '0.0002 m'
    >>> d, error = slip_zone(1e10, 1e6, f=0.5, L_N=-5e12, L_T=5e8)
    >>> f"{d:.4g} m, to {error:.1g}"
    '0.0002317 m, to 3e-05'
    """
    given = _numbers(Edge(K_N, K_T, da, L_N, L_T), unknown=np.nan)
    most = 1 if L_N is None else 2
    order = most if order is None else order
    demand_order(order)
    if order > most:
        raise ValueError("order 2 needs L_N and L_T: give both, or leave the order out")

    def zones(*half_cycle: Any) -> Any:
        second = HalfCycle(*half_cycle)
        first = second._replace(L_N=0.0, L_T=0.0, h=np.inf).zone()
        return second.zone() if order == 2 else first, np.abs(second.zone() - first)

    return evaluated(zones, given, {"f": f} if h is None else {"f": f, "h": h}, SlipZone)


def reach(
    K_N: Values,
    K_T: Values,
    *,
    L_N: Values | None = None,
    L_T: Values | None = None,
    h: Values | None = None,
) -> Array:
    """The distance from the edge at which the next term of the series equals the first.

        the least of |K_N/L_N|, |K_T/L_T| and h; those not given are left out

    Parameters
    ----------
    K_N, K_T, L_N, L_T, h
        As in slip_zone.

    Returns
    -------
    ndarray
        The distance [m]; the relative error of a first-order slip zone d is about d divided by it.
        NaN if none of L_N, L_T and h is given.

    Raises
    ------
    TypeError, ValueError
        As in slip_zone.

    Examples
    --------
    >>> f"{reach(1e10, 1e6, L_N=-5e12, L_T=2e8):.3g} m"
    '0.002 m'
    """

    def least(K_N: Any, L_N: Any, K_T: Any, L_T: Any, h: Any = np.inf) -> Any:
        return np.minimum(np.minimum(np.abs(K_N / L_N), np.abs(K_T / L_T)), h)

    unknown = np.nan if L_N is None and L_T is None and h is None else 0.0
    L_N, L_T = (unknown if value is None else value for value in (L_N, L_T))
    given = {"K_N": K_N, "L_N": L_N, "K_T": K_T, "L_T": L_T}
    return evaluated(least, given, {} if h is None else {"h": h})


def tractions(
    s: Values, edge: Edge, *, f: Values, share: Values = 1.0, mean: Values = 0.0
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
    edge : Edge
        Its coefficients; of the first order unless L_N and L_T are given.
    f : array_like
        Coefficient of friction [-].
    share : array_like, optional
        Instant, from 0 to 1 in the half-cycle that raises the shear load and on to 2 in the one
        that lowers it; all loads change linearly.
    mean : array_like, optional
        Mean of K_T over the cycle [Pa sqrt(m)]; before the first cycle, Q and sigma rose from zero
        to their highest values.

    Returns
    -------
    Tractions
        p [Pa], q [Pa], dq [Pa], of the shape to which the arguments broadcast.  NaN where slip_zone
        gives NaN; q is also NaN where the edge moves and the surfaces do not slip at s. Accurate
        where s is small compared with `reach`.

    Raises
    ------
    TypeError, ValueError
        As in slip_zone.

    Examples
    --------
    >>> p, q, dq = tractions(1e-4, Edge(1e10, 1e6), f=0.5)
    >>> f"{q / p:.3g} and {dq / p:.3g}"  # slips: f and 2 f
    '0.5 and 1'
    """

    def evaluate(s: Any, share: Any, mean: Any, *half_cycle: Any) -> Any:
        rising = HalfCycle(*half_cycle)
        end = np.minimum(share, 2 - share)
        half = rising.part(np.where(share > 1, 1.0, 0.0), np.where(end >= 0, end, np.nan))
        here = s - (1 - end) * rising.da  # from the edge at this instant
        p, dq, d = half.pressure(here), half.change(here), half.zone()
        still = rising.part(0.0, np.where(rising.da == 0, 1.0, np.nan))
        whole = still.change(s)
        first = still.part(0.0, 2 * np.abs(mean / rising.K_T) + 1).change(s) / 2
        lowest = np.where(mean / rising.K_T >= 0, first - whole, -first)
        q = np.where(share > 1, lowest + whole, lowest) + dq
        return p + 0 * d, np.where(here <= d, half.sense * rising.f * p, q), dq  # NaN if d is

    given = {"s": s, "share": share, "mean": mean} | _numbers(edge)
    return evaluated(evaluate, given, {"f": f}, Tractions)


def slip_range(s: Values, edge: Edge, *, f: Values, E_star: Values) -> Array:
    """Slip range of a cycle next to a single edge.

        (2/E*) int_0^(d - s) sqrt(u) R(-u) du; order 1: (8 f K_N/(3 E*)) (d - s)**(3/2)

    Parameters
    ----------
    s, edge, f
        As in tractions.
    E_star : array_like
        Composite modulus, see E_star() [Pa].

    Returns
    -------
    ndarray
        The slip range [m], of the shape to which the arguments broadcast; 0 where the surfaces
        stick. NaN where slip_zone gives NaN, and at points that leave the contact during the cycle.

    Raises
    ------
    TypeError, ValueError
        As in slip_zone.

    Examples
    --------
    >>> f"{slip_range(0.0, Edge(1e10, 1e6), f=0.5, E_star=1e11):.3g}"
    '3.77e-07'
    """

    def evaluate(s: Any, *values: Any) -> Any:
        half, E_star = HalfCycle(*values[:-1]), values[-1]
        R_0, R_1 = half.stuck()
        u = np.maximum(half.zone() - s, 0.0)
        slip = R_0 * u**1.5 / 1.5 - R_1 * u**2.5 / 2.5
        return np.where(s >= np.maximum(half.da, 0.0), 2 / E_star * slip, np.nan)

    return evaluated(evaluate, {"s": s} | _numbers(edge), {"f": f, "E_star": E_star})


def _numbers(edge: Any, unknown: float = 0.0) -> dict[str, Any]:
    """The numbers of an edge in the order of HalfCycle; L_N and L_T are unknown unless given."""
    if not isinstance(edge, Edge):
        raise TypeError(f"edge must be an Edge; got {edge!r:.60}")
    if (edge.L_N is None) != (edge.L_T is None):
        raise ValueError("L_N and L_T have the same order: give both, or neither")
    if edge.L_N is None:
        edge = edge._replace(L_N=unknown, L_T=unknown)
    return dict(zip(HalfCycle._fields, edge[:5], strict=False))


class HalfCycle(NamedTuple):
    """A half-cycle next to one edge: pressure at its end, change in full-stick shear, motion.

    Distances are measured from the edge at the end of the half-cycle.
    """

    K_N: Any
    K_T: Any
    da: Any
    L_N: Any
    L_T: Any
    f: Any
    h: Any = np.inf

    @property
    def sense(self) -> Any:
        """The direction of slip, +1 or -1."""
        return np.where(self.K_T < 0, -1.0, 1.0)

    def part(self, start: Any, end: Any) -> "HalfCycle":
        """From one instant to another one, counted from 0 to 1; all loads change linearly."""
        lag, share = (1 - end) * self.da, end - start
        K_T, L_T = share * (self.K_T + self.L_T / 2 * lag), share * self.L_T
        return self._replace(K_N=self.K_N_at(lag), K_T=K_T, L_T=L_T, da=share * self.da)

    def K_N_at(self, lag: Any) -> Any:
        """K_N when the edge was further in by `lag`; L_N does not change."""
        return self.K_N + 1.5 * self.L_N * lag

    def pressure(self, s: Any, lag: Any = 0.0) -> Any:
        """The pressure at that instant."""
        inside = np.maximum(s - lag, 0.0)
        return np.sqrt(inside) * (self.K_N_at(lag) + self.L_N * inside)

    def zone(self) -> Any:
        """The slip zone: the root of A d**2 + B d = C beyond which friction suffices."""
        before, shortest = self.K_N_at(self.da), np.maximum(self.da, 0.0)
        # a contact of width h acts as a smaller L_N
        L, L_before = (self.L_N - K_N / (6 * self.h) for K_N in (self.K_N, before))
        A = 3 / 8 * self.f * (L + L_before)
        B = self.f / 2 * (self.K_N + before - 1.5 * L_before * self.da) - self.sense * self.L_T / 2
        C = np.abs(self.K_T) + self.f / 2 * self.da * (before - 0.75 * L_before * self.da)
        d = 2 * C / (B + np.sqrt(B**2 + 4 * A * C))
        slips = (self.K_N > 0) & (before > 0) & (d >= shortest) & (B + 2 * A * shortest > 0)
        return np.where(slips, d, np.nan)

    def stuck(self) -> tuple[Any, Any]:
        """R_0 and R_1."""
        R_0 = 2 * self.f * (self.K_N + 1.5 * self.L_N * self.zone())
        return R_0 - self.sense * self.L_T, 2 * self.f * self.L_N

    def change(self, s: Any) -> Any:
        """The change in the shear traction at its end."""
        R_0, R_1 = self.stuck()
        t = np.maximum(s - self.zone(), 0.0)
        p = self.pressure(s) + self.pressure(s, self.da)
        return self.sense * (self.f * p - np.sqrt(t) * (R_0 + R_1 * t))
