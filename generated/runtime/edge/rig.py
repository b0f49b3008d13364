"""Loads of a body whose edge then matches the edge of another contact: a rig for a prototype.

To first order, slip next to an edge depends only on K_N, K_T, f and the displacement of the edge.
The contact of a body under P and M has two free numbers, a and c, so that a rig can match one edge
at M = dM = 0, or both.  docs/edge.md says what is matched by what, and what differs still.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..arrays import number
from ..reasons import MEANINGS
from ..types import Contact, Edges, Regime
from .near import Edge, slip_zone

MATCH_RTOL = 1e-8
"""Relative deviation below which a request counts as met."""

MAX_SLIP = 0.2
"""Slip zone over contact width above which an edge is not independent of the other one."""


class Rig(NamedTuple):
    """Loads of a rig, and the resulting data of its edges; `describe` gives them in words.

    Attributes
    ----------
    P, M : float
        Normal load and moment at the end of the half-cycle that raises Q [N/m, N].
    dQ, dsigma, dP, dM : float
        Changes over this half-cycle [N/m, Pa, N/m, N].
    parameters : dict
        Parameters of the body, including the free one.
    first, second : Contact
        Contacts at the start and at the end of the half-cycle.
    edges : Edges
        An Edge for each edge of the rig.
    d : Edges
        Exact slip zones at `second` [m]; NaN where none is known.
    regime : int
        A code of Regime, as returned by stick_zone.
    met, missed : tuple of str
        Requests that are met, and those that are not.
    next_order : Edges
        Relative change in the rig's slip zone due to L_N and L_T; NaN where they are not known or
        nothing was requested.
    warning : str
        Reasons against these loads; "" if there are none.
    """

    P: float
    M: float
    dQ: float
    dsigma: float
    dP: float
    dM: float
    parameters: dict[str, float]
    first: Contact
    second: Contact
    edges: Edges
    d: Edges
    regime: int
    met: tuple[str, ...]
    missed: tuple[str, ...]
    next_order: Edges
    warning: str


def match(
    edge: Edge | Edges,
    module: Any,
    *,
    f: float,
    E_star: float,
    free: str | None = None,
    **parameters: float,
) -> Rig:
    """Loads of a body whose edge has the K_N, K_T and displacement of another contact's edge.

        K_N(a, c) = K_N;  a - a_1 = da;  K_T(a, c, dQ, dsigma) = K_T

    Parameters
    ----------
    edge : Edge or Edges
        One Edge, matched at M = dM = 0; or a body's Edges(left, right) of two Edge objects.
    module : module
        The body: a generated module, such as generated.hertz.
    f : float
        Coefficient of friction of both contacts [-].
    E_star : float
        Composite modulus of the rig [Pa].
    free : str, optional
        The name of a parameter that is also determined, so that L_N is met.
    **parameters : float
        All parameters of the body except the free one.

    Returns
    -------
    Rig
        The loads, and a warning that gives the reasons against them, if there are any.

    Raises
    ------
    TypeError
        If an argument is not of the type above, or the parameters are not those of the body.
    ValueError
        If the requests cannot be met; the message names them.

    Notes
    -----
    All arguments are numbers.  L_T, if given, is met by dsigma; otherwise dsigma = 0 for one edge.
    If the shear load would fall, all its signs are reversed so that dQ >= 0: slip is the same, in
    the opposite direction.  Of several solutions, the widest contact that is found is taken.

    Examples
    --------
    >>> from generated import hertz
    >>> rig = match(Edge(2.5e10, 2e6), hertz, f=0.5, E_star=115e9, R=0.1)
    >>> f"P = {rig.P:.4g} N/m, dQ = {rig.dQ:.4g} N/m, slip zone {1e6 * rig.d.left:.0f} um"
    'P = 8.069e+05 N/m, dQ = 2.732e+05 N/m, slip zone 176 um'
    """
    f, E_star = (number(v, name, "positive finite") for v, name in ((f, "f"), (E_star, "E_star")))
    law = {name: number(value, name, "positive finite") for name, value in parameters.items()}
    wished = _requests(edge)
    if not callable(getattr(module, "stick_zone", None)):
        raise TypeError(
            f"module must be a generated body, such as generated.hertz; got {module!r:.60}"
        )
    if free and (free in law or np.all(np.isnan(wished.L_N))):
        raise ValueError(
            f"free={free!r} is determined from L_N: give either {free} or L_N of an edge"
        )

    def of(name: str, a: Any, c: Any, law: Mapping[str, Any]) -> Any:
        return getattr(module, name)(a, c, E_star=E_star, **law)

    (a, c, a_1, c_1), law = _contacts(of, wished, law, free)
    if not np.any(np.nan_to_num(wished.da)):
        a_1, c_1 = a, c
    first, second = (Contact(*at, float(module.tilt(*at, **law))) for at in ((a_1, c_1), (a, c)))
    (P_1, M_1), (P, M) = (
        [float(of(name, at.a, at.c, law)) for name in ("load", "moment")] for at in (first, second)
    )
    if np.any(np.isnan(wished.K_N)):
        M = M_1 = 0.0
    # K_T and L_T are linear in both; one edge without L_T needs no tension
    rates = np.vstack([*module.K_T(a, c, *np.eye(2)), *module.L_T(a, c, *np.eye(2)), [0.0, 1.0]])
    sizes = np.concatenate([wished.K_T, wished.L_T, [0.0]])
    used = np.flatnonzero(np.isfinite(sizes))[:2]
    dQ, dsigma = (np.linalg.solve(rates[used], sizes[used]) + 0.0).tolist()  # not -0
    K_N, L_N = of("K_N", a, c, law), of("L_N", a, c, law)
    K_T, L_T = module.K_T(a, c, dQ, dsigma), module.L_T(a, c, dQ, dsigma)
    table = np.array([K_N, K_T, (a - a_1, c - c_1), L_N, L_T])
    actual, rows = Edge(*table), zip(*table.tolist(), Edges._fields, strict=True)
    zones = [slip_zone(*e[:2], f=f, da=e.da, L_N=e.L_N, L_T=e.L_T).d for e in (actual, wished)]
    if dQ < 0:
        dQ, dsigma = -dQ, 0.0 - dsigma
    zone = module.stick_zone(first, second, dQ, dsigma, f=f, E_star=E_star, **law)
    d, regime = Edges(float(a - zone.m), float(c - zone.n)), int(zone.regime)
    warning = ""
    if regime not in (Regime.MODERATE, Regime.LARGE):
        warning = MEANINGS.get(Regime(regime), "no stick zone was found")
    elif np.any(np.isfinite(wished.K_N) & (np.array(d) > MAX_SLIP * (a + c))):
        warning = "the slip zone is a large part of the contact: the other edge affects it"
    return Rig(
        *(P, M, dQ, dsigma, P - P_1, M - M_1, law, first, second, Edges(*map(Edge._make, rows))),
        *(d, regime, *_compared(wished, actual, a + c)),
        Edges(*(np.round(zones[0] / zones[1] - 1, 9) + 0.0).tolist()),  # as requests are met
        warning,
    )


def describe(rig: Rig) -> str:
    """A rig in words and numbers, one item per line, in SI units.

    Parameters
    ----------
    rig : Rig
        A result of `match`.

    Returns
    -------
    str
        The lines.

    Raises
    ------
    TypeError
        If `rig` is not a Rig.

    Examples
    --------
    >>> from generated import hertz
    >>> rig = match(Edge(2.5e10, 2e6), hertz, f=0.5, E_star=115e9, R=0.1)
    >>> print(describe(rig).splitlines()[0])
    P = 806894 N/m, M = 0 N at the end of the half-cycle
    """
    if not isinstance(rig, Rig):
        raise TypeError(f"rig must be a Rig, as returned by match; got {rig!r:.60}")
    own = ", ".join(f"{name} = {value:.6g}" for name, value in rig.parameters.items())
    lines = [
        f"P = {rig.P:.6g} N/m, M = {rig.M:.6g} N at the end of the half-cycle",
        f"change over it: dQ = {rig.dQ:.6g} N/m, dsigma = {rig.dsigma:.6g} Pa, "
        f"dP = {rig.dP:.6g} N/m, dM = {rig.dM:.6g} N",
        f"body: {own}",
        f"contact: from [{-rig.first.a:.6g}, {rig.first.c:.6g}] m to "
        f"[{-rig.second.a:.6g}, {rig.second.c:.6g}] m",
    ]
    for actual, d, part in zip(rig.edges, rig.d, rig.next_order, strict=True):
        lines.append(
            f"{actual.side} edge: K_N = {actual.K_N:.6g}, L_N = {actual.L_N:.4g}, "
            f"K_T = {actual.K_T:.6g}, L_T = {actual.L_T:.4g}, moves by {actual.da:.4g} m, "
            f"slip zone {d:.6g} m"
        )
        if math.isfinite(part):
            lines.append(f"    its L_N and L_T change the slip zone by {100 * part:+.2g} %")
    lines += [f"met: {', '.join(rig.met)}", *(f"not met: {words}" for words in rig.missed)]
    return "\n".join(lines + ([f"warning: {rig.warning}"] if rig.warning else []))


def _requests(edge: Any) -> Any:
    """An Edge of arrays, with the left and the right edge's numbers; NaN where nothing is asked."""
    pair = hasattr(edge, "left") and hasattr(edge, "right")  # Edges of any package
    given = zip(Edges._fields, edge, strict=True) if pair else [(getattr(edge, "side", ""), edge)]
    rows = dict.fromkeys(Edges._fields, [math.nan] * 5)
    for side, one in given:
        if not isinstance(one, Edge):
            raise TypeError(f"edge must be an Edge, or Edges of two of them; got {one!r:.60}")
        if side not in Edges._fields:
            raise ValueError(f"side must be 'left' or 'right'; got {side!r:.40}")
        rows[side] = [number(one.K_N, "K_N", "positive finite")]
        rows[side] += [number(one.K_T, "K_T"), number(one.da, "da")]
        for name, value in (("L_N", one.L_N), ("L_T", one.L_T)):
            rows[side].append(math.nan if value is None else number(value, name))
    return Edge(*np.array([*rows.values()]).T)


def _contacts(
    of: Callable[..., Any], wished: Any, law: dict[str, float], free: str | None
) -> tuple[list[float], dict[str, float]]:
    """a and c at the end and at the start of the half-cycle, and the body's parameters.

    The body enters only by its explicit functions: of(name, a, c, parameters).  The unknowns u are
    log h, mid/h, the displacements of both edges over h, and the logarithm of the free parameter.
    """
    from scipy.ndimage import minimum_filter
    from scipy.optimize import least_squares

    alone = np.any(np.isnan(wished.K_N))
    asked = np.isfinite([(0.0, 0.0), wished.K_N, wished.da, wished.L_N])
    asked[3] &= bool(free)

    def place(u: Any) -> tuple[list[Any], dict[str, Any]]:
        h, lean = np.exp(u[..., 0]), u[..., 1]
        a, c = h * (0.5 - lean), h * (0.5 + lean)
        own = law | ({free: np.exp(u[..., 4])} if free else {})
        return [a, c, a - h * u[..., 2], c - h * u[..., 3]], own

    def residual(u: Any) -> Any:
        (a, c, a_1, c_1), own = place(u)
        h = (a + c)[..., None]
        K_N, L_N = (np.stack(of(name, a, c, own), -1) for name in ("K_N", "L_N"))
        # M and dM vanish if one edge alone is given; in any case, both are contacts of the body
        levers = [of("moment", *at, own) / of("load", *at, own) for at in ((a, c), (a_1, c_1))]
        rows = [alone * np.stack(levers, -1) / h, np.log(K_N / wished.K_N)]
        rows += [u[..., 2:4] - wished.da / h, (L_N - wished.L_N) * h / wished.K_N]
        off = np.stack(rows, -2)[..., asked]
        return np.where(np.isfinite(off), off, 1e9)

    # h from 1e-9 to 1e6 m, never near 1 m, as steps begin with the length of u
    axes: list[Any] = [np.arange(-20.5, 14, 0.28), np.linspace(-0.45, 0.45, 7), 0.0, 0.0]
    axes += [np.linspace(-13.8, 13.8, 37)] if free else []
    grid: Any = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
    with np.errstate(all="ignore"):
        cost = np.sum(residual(grid) ** 2, -1)
        lowest = (cost == minimum_filter(cost, 3)) & (cost < 1e9)
        starts = grid[lowest][np.argsort(cost[lowest], kind="stable")[:16]]
        found = [least_squares(residual, u, xtol=1e-15, ftol=1e-15, gtol=1e-15) for u in starts]
    met = [one.x for one in found if np.max(np.abs(one.fun)) < MATCH_RTOL]
    if met:
        # the widest contact; among equally wide ones the one closest to symmetric
        ends, own = place(max(met, key=lambda u: (round(u[0], 6), -abs(u[1]))))
        return [*map(float, ends)], {name: float(value) for name, value in own.items()}
    near = ""
    if found:
        (a, c, a_1, c_1), own = place(min(found, key=lambda one: one.cost).x)
        (K, K_2), (L, L_2) = of("K_N", a, c, own), of("L_N", a, c, own)
        near = f"; of the nearest one, left and right, K_N = {K:.6g} and {K_2:.6g}"
        near += f", da = {a - a_1:.6g} and {c - c_1:.6g}"
        near += f", L_N = {L:.6g} and {L_2:.6g}" if free else ""
    raise ValueError(
        f"no contact{' with M = dM = 0' if alone else ''} has the data requested{near}: use other "
        f"parameters or another body{'' if alone else ', or match one edge alone'}"
        f"{f', or give {free} in place of L_N' if free else ''}"
    )


def _compared(wished: Any, actual: Any, h: float) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Requests that are met, and those that are not."""
    met, missed = [], []
    sizes = actual.K_N, actual.K_T, [h, h], actual.K_N / h, actual.K_T / h
    for i, side in enumerate(Edges._fields):
        for name, value, target, size in zip(Edge._fields, actual, wished, sizes, strict=False):
            if abs(value[i] - target[i]) <= MATCH_RTOL * max(abs(target[i]), abs(size[i])):
                met.append(f"{name} ({side})")
            elif np.isfinite(target[i]):
                missed.append(f"{name} ({side}) is {value[i]:.6g} instead of {target[i]:.6g}")
    return tuple(met), tuple(missed)
