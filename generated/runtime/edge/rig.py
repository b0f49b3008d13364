r"""Loads of a body whose edge then matches the edge of another contact: a rig for a prototype.

To first order, slip next to an edge depends only on K_N, K_T, f and the displacement of the edge.
The contact of a body under P and M has two free numbers, a and c, so that a rig can match

    one edge     K_N by the width, at M = 0; the displacement by dP, at dM = 0; K_T by dQ; if
                 requested, L_T by dQ and dsigma together, and L_N by a free parameter of the body
    both edges   both K_N by P and M; both displacements by dP and dM; both K_T by dQ and dsigma

The remaining differences are one order higher: L_N and L_T, the width, and the other edge.  Some
requests exclude each other: a cylinder has the same K_N at both edges, and L_N = -K_N/(2 h) there.

The body enters only by its functions of (a, c), which are explicit.  One damped Newton method in
log h, mid/h and the logarithm of the free parameter therefore serves all bodies.
"""

import inspect
import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..types import Contact, Edges, Regime
from .zone import slip_zone

SIDES = ("left", "right")

WIDTHS = np.geomspace(1e-9, 1e6, 121)
"""Widths of the contact from which the search starts [m]."""

LEANS = np.linspace(-0.45, 0.45, 7)
"""Positions of the middle, relative to the width, from which the search starts."""

FREE = np.geomspace(1e-6, 1e6, 37)
"""Values of a free parameter from which the search starts."""

STARTS, STEPS = 16, 60
"""Largest number of starting points of Newton's method, and of its steps."""

CLOSE = 1e-8
"""Relative deviation below which a request counts as met."""

WIDE = 0.2
"""Slip zone over contact width above which an edge is not independent of the other one."""


class Edge(NamedTuple):
    """One edge at the end of the half-cycle that raises Q.

    Parameters
    ----------
    K_N : float
        Coefficient of sqrt(s) in the pressure [Pa/sqrt(m)].
    K_T : float
        Coefficient of 1/sqrt(s) in the full-stick change in shear, signed [Pa sqrt(m)].
    da : float, optional
        How much further out the edge is than at the other end of the half-cycle [m].
    L_N, L_T : float, optional
        Coefficients of s**(3/2) and s**(1/2) [Pa/m**(3/2), Pa/sqrt(m)]; None if not known or not
        requested.
    side : str, optional
        "left" or "right".
    """

    K_N: float
    K_T: float
    da: float = 0.0
    L_N: float | None = None
    L_T: float | None = None
    side: str = "left"


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
    ValueError
        If the requests cannot be met; the message names them.

    Notes
    -----
    All arguments are numbers.  L_T, if given, is met by dsigma; otherwise dsigma = 0 for one edge.
    If the shear load would fall, all its signs are reversed so that dQ >= 0: slip is the same, in
    the opposite direction.  If a body has several solutions, the widest contact is taken.

    Examples
    --------
    >>> from generated import hertz
    >>> rig = match(Edge(2.5e10, 2e6), hertz, f=0.5, E_star=115e9, R=0.1)
    >>> f"P = {rig.P:.4g} N/m, dQ = {rig.dQ:.4g} N/m, slip zone {1e6 * rig.d.left:.0f} um"
    'P = 8.069e+05 N/m, dQ = 2.732e+05 N/m, slip zone 176 um'
    """
    law = _law(module, free, parameters)
    f, E_star = _positive(f, "f"), _positive(E_star, "E_star")
    requested = _requests(edge)
    body = _Body(module, E_star, law, free)
    if free and all(one.L_N is None for one in requested.values()):
        raise ValueError(
            f"free={free!r} is determined from L_N: give L_N of an edge, or {free} itself"
        )
    a, c, own = _contact(body, requested)
    second = body.contact(a, c, own)
    first = _before(body, second, own, requested)
    dQ, dsigma = _shear(a + c, requested)
    P, M, P_1, M_1 = (of(at) for at in (second, first) for of in (body.load(own), body.moment(own)))
    one = len(requested) == 1
    is_reversed = dQ < 0
    if is_reversed:
        dQ, dsigma = -dQ, 0.0 - dsigma
    friction = dict(f=f, E_star=E_star, **own)
    zone = module.stick_zone(first, second, dQ, dsigma, **friction)
    d = Edges(float(second.a - zone.m), float(second.c - zone.n))
    regime = int(zone.regime)
    edges = _edges(body, first, second, own, dQ, dsigma, -1.0 if is_reversed else 1.0)
    met, missed = _compared(edges, requested, a + c)
    parts = [
        _next_order(requested.get(side), actual, f)
        for side, actual in zip(SIDES, edges, strict=True)
    ]
    warning = _warning(Regime(regime), d, a + c, dQ, f * (P + P_1), [*requested])
    M, dM = (0.0, 0.0) if one else (M, M - M_1)
    return Rig(
        P,
        M,
        dQ,
        dsigma,
        P - P_1,
        dM,
        own,
        first,
        second,
        edges,
        d,
        regime,
        met,
        missed,
        Edges(*parts),
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

    Examples
    --------
    >>> from generated import hertz
    >>> rig = match(Edge(2.5e10, 2e6), hertz, f=0.5, E_star=115e9, R=0.1)
    >>> print(describe(rig).splitlines()[0])
    P = 806894 N/m, M = 0 N at the end of the half-cycle
    """
    own = ", ".join(f"{name} = {value:.6g}" for name, value in rig.parameters.items())
    lines = [
        f"P = {rig.P:.6g} N/m, M = {rig.M:.6g} N at the end of the half-cycle",
        f"change over it: dQ = {rig.dQ:.6g} N/m, dsigma = {rig.dsigma:.6g} Pa, "
        f"dP = {rig.dP:.6g} N/m, dM = {rig.dM:.6g} N",
        f"body: {own}",
        f"contact: from [{-rig.first.a:.6g}, {rig.first.c:.6g}] m to "
        f"[{-rig.second.a:.6g}, {rig.second.c:.6g}] m",
    ]
    for side, actual, d, part in zip(SIDES, rig.edges, rig.d, rig.next_order, strict=True):
        lines.append(
            f"{side} edge: K_N = {actual.K_N:.6g}, L_N = {actual.L_N:.4g}, "
            f"K_T = {actual.K_T:.6g}, L_T = {actual.L_T:.4g}, moves by {actual.da:.4g} m, "
            f"slip zone {d:.6g} m"
        )
        if math.isfinite(part):
            lines.append(f"    its L_N and L_T change the slip zone by {100 * part:+.2g} %")
    lines.append(f"met: {', '.join(rig.met)}")
    lines += [f"not met: {words}" for words in rig.missed]
    lines += [f"warning: {rig.warning}"] if rig.warning else []
    return "\n".join(lines)


# ---------------------------------------------------------------- arguments


def _law(module: Any, free: str | None, parameters: Mapping[str, Any]) -> dict[str, float]:
    """The body's parameters as numbers, without the free one."""
    needed = ("load", "moment", "tilt", "K_N", "L_N", "K_T", "L_T", "stick_zone")
    if not all(callable(getattr(module, name, None)) for name in needed):
        raise TypeError(
            f"module must be a generated body, such as generated.hertz; got {module!r:.60}"
        )
    arguments = inspect.signature(module.load).parameters.values()
    names = [a.name for a in arguments if a.kind is a.KEYWORD_ONLY and a.name != "E_star"]
    if free is not None and free not in names:
        raise ValueError(f"free must be one of {', '.join(names)}; got {free!r:.40}")
    asked = [name for name in names if name != free]
    if set(asked) != set(parameters):
        given = ", ".join(parameters) or "none"
        raise ValueError(
            f"the body's parameters are {', '.join(asked) or 'none'}; got {given}: give each of "
            "them once"
        )
    return {name: _positive(parameters[name], name) for name in asked}


def _number(value: Any, name: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"{name} must be one finite number; got {value!r:.60}")
    return number


def _positive(value: Any, name: str) -> float:
    number = _number(value, name)
    if not number > 0:
        raise ValueError(f"{name} must be positive; got {number:.6g}")
    return number


def _requests(edge: Any) -> dict[str, Edge]:
    """The data requested of each edge, as numbers."""
    pair = hasattr(edge, "left") and hasattr(edge, "right")  # Edges of any package
    given = dict(zip(SIDES, edge, strict=True)) if pair else {getattr(edge, "side", None): edge}
    for side, one in given.items():
        if not isinstance(one, Edge):
            raise TypeError(f"edge must be an Edge, or Edges of two of them; got {one!r:.60}")
        if side not in SIDES:
            raise ValueError(f"side must be 'left' or 'right'; got {side!r:.40}")
        _positive(one.K_N, "K_N")
    values_of = {
        side: {name: v for name, v in one._asdict().items() if name != "side" and v is not None}
        for side, one in given.items()
    }
    return {
        str(side): Edge(**{name: _number(v, name) for name, v in values.items()}, side=str(side))
        for side, values in values_of.items()
    }


class _Body(NamedTuple):
    """A module and its parameters; the free parameter is the last of the unknowns."""

    module: Any
    E_star: float
    law: dict[str, float]
    free: str | None

    def own(self, value: Any) -> dict[str, Any]:
        """All parameters, with this value of the free one."""
        return self.law | ({self.free: value} if self.free else {})

    def of(self, name: str, a: Any, c: Any, own: Mapping[str, Any]) -> Any:
        """A function of the body at (a, c)."""
        return getattr(self.module, name)(a, c, E_star=self.E_star, **own)

    def contact(self, a: float, c: float, own: Mapping[str, float]) -> Contact:
        """The contact with its tilt."""
        return Contact(a, c, float(self.module.tilt(a, c, **own)))

    def load(self, own: Mapping[str, float]) -> Callable[[Contact], float]:
        """The load P as a function of the contact."""
        return lambda at: float(self.of("load", at.a, at.c, own))

    def moment(self, own: Mapping[str, float]) -> Callable[[Contact], float]:
        """The moment M as a function of the contact."""
        return lambda at: float(self.of("moment", at.a, at.c, own))


# ---------------------------------------------------------------- the contact


def _contact(body: _Body, requested: Mapping[str, Edge]) -> tuple[float, float, dict[str, float]]:
    """The widest contact whose edges are as requested, and the body's parameters."""

    def residual(u: Any) -> Any:
        """Residuals of the requests (last axis); u is log h, mid/h, log of the free parameter."""
        h, lean = np.exp(u[..., 0]), u[..., 1]
        a, c = h * (0.5 - lean), h * (0.5 + lean)
        own = body.own(np.exp(u[..., 2])) if body.free else body.law
        K_N = body.of("K_N", a, c, own)
        rows = [np.log(getattr(K_N, side) / one.K_N) for side, one in requested.items()]
        if len(requested) == 1:
            rows.append(body.of("moment", a, c, own) / (body.of("load", a, c, own) * h))
        if body.free:
            L_N = body.of("L_N", a, c, own)
            rows += [
                (getattr(L_N, side) - one.L_N) * h / one.K_N
                for side, one in requested.items()
                if one.L_N is not None
            ]
        return np.stack(np.broadcast_arrays(*rows), -1)

    axes = [np.log(WIDTHS), LEANS, *([np.log(FREE)] if body.free else [])]
    with np.errstate(all="ignore"):
        grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
        found = [_solved(residual, grid[at]) for at in _lowest(np.sum(residual(grid) ** 2, -1))]
    known = [one for one in found if one[1] < CLOSE]
    if not known:
        raise ValueError(_impossible(body, requested, found))
    # the widest contact; among equally wide ones the one closest to symmetric
    u, _ = max(known, key=lambda one: (round(one[0][0], 6), -abs(one[0][1])))
    h, lean = math.exp(u[0]), float(u[1])
    own = {k: float(v) for k, v in body.own(math.exp(u[-1])).items()}
    return h * (0.5 - lean), h * (0.5 + lean), own


def _lowest(cost: Any) -> list[tuple[int, ...]]:
    """Points of a grid that lie no higher than their neighbours, the lowest first."""
    cost = np.where(np.isfinite(cost), cost, np.inf)
    least = np.isfinite(cost)
    for axis in range(cost.ndim):
        rise = np.diff(cost, axis=axis)
        rise = np.where(np.isnan(rise), 0.0, rise)
        ends = [(1, 0) if i == axis else (0, 0) for i in range(cost.ndim)]
        back = [pair[::-1] for pair in ends]
        least &= (np.pad(rise, back, constant_values=1.0) >= 0) & (np.pad(rise, ends) <= 0)
    places = np.argwhere(least)
    middle = (np.array(cost.shape) - 1) / 2
    leans = np.abs(places[:, 1] - middle[1]) if cost.ndim > 1 else 0
    order = np.lexsort((leans, cost[tuple(places.T)]))
    return [tuple(map(int, places[i])) for i in order[:STARTS]]


def _solved(function: Callable[[Any], Any], u: Any) -> tuple[Any, float]:
    """u and the largest residual, by Newton's method with steps that are halved until they help.

    If the requests leave a direction undetermined, as for a cylinder that rolls, u does not move in
    that direction.
    """
    residual = function(u)
    for _ in range(STEPS):
        small = 1e-6 * np.eye(len(u))
        rates = np.stack([(function(u + one) - function(u - one)) / 2e-6 for one in small], -1)
        if not np.all(np.isfinite(rates)):
            break
        step = np.linalg.lstsq(rates, -residual, rcond=1e-8)[0]
        step *= min(1.0, 1.0 / max(np.max(np.abs(step)), 1e-300))
        for _ in range(30):
            trial = function(u + step)
            if np.sum(trial**2) < np.sum(residual**2):
                break
            step = step / 2
        else:
            break
        u, residual = u + step, trial
    return u, float(np.max(np.abs(residual)))


def _impossible(body: _Body, requested: Mapping[str, Edge], found: Any) -> str:
    """The message that names requests that exclude each other, and the nearest solution."""
    name = body.module.__name__.rpartition(".")[2]
    requests = [f"K_N = {one.K_N:.6g} at the {side} edge" for side, one in requested.items()]
    if body.free:
        requests += [
            f"L_N = {one.L_N:.6g} at the {side} edge"
            for side, one in requested.items()
            if one.L_N is not None
        ]
    message = f"no contact of {name}{' with M = 0' if len(requested) == 1 else ''} has "
    message += " and ".join(requests)
    if found:
        u, _ = min(found, key=lambda one: one[1])
        h, own = math.exp(u[0]), body.own(math.exp(u[-1]))
        a, c = h * (0.5 - u[1]), h * (0.5 + u[1])
        names = ("K_N", "L_N") if body.free else ("K_N",)
        near = [
            f"{name} = {float(getattr(body.of(name, a, c, own), side)):.6g} at the {side} edge"
            for name in names
            for side in requested
        ]
        if len(requested) == 1:
            near.append(f"M = {float(body.of('moment', a, c, own)):.6g}")
        message += f"; the nearest has {', '.join(near)}"
    if len(requested) == 2:
        return message + ": match one edge alone, or use a body whose edges can differ this way"
    if body.free:
        return message + f": give {body.free} in place of L_N, or use another body"
    return message + ": use other parameters, or another body"


def _before(
    body: _Body, now: Contact, own: Mapping[str, float], requested: Mapping[str, Edge]
) -> Contact:
    """The contact at the start of the half-cycle, with edges further in by their displacements."""
    moves = {side: one.da for side, one in requested.items()}
    if not any(moves.values()):
        return now
    if len(moves) == 2:
        a, c = now.a - moves["left"], now.c - moves["right"]
    else:
        ((side, move),) = moves.items()
        a, c = _beside(body, now, own, side, move)
    load = float(body.of("load", a, c, own))
    if not (a + c > 0 and load > 0):
        raise ValueError(
            f"no load moves the edge of this body by {max(moves.values()):.6g} m at a contact "
            f"width of {now.a + now.c:.6g} m: use a larger body"
            + (", or match one edge alone" if len(moves) == 2 else "")
        )
    return body.contact(a, c, own)


def _beside(
    body: _Body, now: Contact, own: Mapping[str, float], side: str, move: float
) -> tuple[float, float]:
    """Edges of the contact without a moment whose edge on one side lies further in by `move`."""
    h, near = now.a + now.c, (now.a if side == "left" else now.c) - move

    def edges(u: Any) -> tuple[Any, Any]:
        far = np.exp(u[..., 0]) - near
        return (near, far) if side == "left" else (far, near)

    def residual(u: Any) -> Any:
        a, c = edges(u)
        at = body.of("moment", a, c, own) / (body.of("load", a, c, own) * h)
        return np.reshape(at, (*np.shape(u)[:-1], 1))

    if not h - 2 * move > 0:
        return math.nan, math.nan
    with np.errstate(all="ignore"):
        u, left = _solved(residual, np.array([math.log(h - 2 * move)]))
    a, c = edges(u)
    return (float(a), float(c)) if left < CLOSE else (math.nan, math.nan)


# ---------------------------------------------------------------- shear, and the resulting edges


def _shear(h: float, requested: Mapping[str, Edge]) -> tuple[float, float]:
    """dQ and dsigma: sqrt(h) K_T = dQ/pi +- dsigma h/8, 2 h**(3/2) L_T = dQ/pi -+ 3 dsigma h/8."""
    if len(requested) == 2:
        left, right = (math.sqrt(h) * requested[side].K_T for side in SIDES)
        return math.pi * (left + right) / 2, 4 * (left - right) / h
    ((side, one),) = requested.items()
    force, tension = math.sqrt(h) * one.K_T, 0.0
    if one.L_T is not None:
        tension = (force - 2 * h**1.5 * one.L_T) / 4
    return math.pi * (force - tension), 8 * tension / h * (1 if side == "left" else -1)


def _edges(
    body: _Body,
    first: Contact,
    second: Contact,
    own: Mapping[str, float],
    dQ: float,
    dsigma: float,
    sense: float,
) -> Edges:
    """The data of both edges, with K_T and L_T signed as in the prototype."""
    at = second.a, second.c
    K_N, L_N = (body.of(name, *at, own) for name in ("K_N", "L_N"))
    K_T, L_T = (of(*at, sense * dQ, sense * dsigma) for of in (body.module.K_T, body.module.L_T))
    moves = Edges(second.a - first.a, second.c - first.c)
    rows = zip(K_N, K_T, moves, L_N, L_T, SIDES, strict=True)
    two = [Edge(*map(float, row[:-1]), side=row[-1]) for row in rows]  # type: ignore[misc, arg-type]
    return Edges(*two)


def _compared(
    edges: Edges, requested: Mapping[str, Edge], h: float
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Requests that are met, and those that are not."""
    met, missed = [], []
    for side, one in requested.items():
        actual = getattr(edges, side)
        sizes = {
            "K_N": actual.K_N,
            "K_T": actual.K_T,
            "da": h,
            "L_N": actual.K_N / h,
            "L_T": actual.K_T / h,
        }
        for name, size in sizes.items():
            target, value = getattr(one, name), getattr(actual, name)
            if target is None:
                continue
            where = f"{name} ({side})"
            if abs(value - target) <= CLOSE * max(abs(target), abs(size)):
                met.append(where)
            else:
                missed.append(f"{where} is {value:.6g} instead of {target:.6g}")
    return tuple(met), tuple(missed)


def _next_order(requested: Edge | None, actual: Edge, f: float) -> float:
    """Relative change in the slip zone due to L_N and L_T, with each edge taken alone."""
    if requested is None or requested.L_N is None or requested.L_T is None:
        return math.nan

    def d(of: Edge) -> float:
        found = slip_zone(of.K_N, of.K_T, f=f, L_N=of.L_N, L_T=of.L_T, da=of.da)
        return float(found.d)

    return d(actual) / d(requested) - 1


def _warning(regime: Regime, d: Edges, h: float, dQ: float, limit: float, sides: list[str]) -> str:
    """Reasons against the loads."""
    warning = {
        Regime.SLIDING: f"the contact of the rig slides: dQ = {dQ:.6g} N/m is not below "
        f"f (P_1 + P_2) = {limit:.6g} N/m",
        Regime.FULL_STICK: "nothing slips",
        Regime.MIXED: "slip reverses within a half-cycle, or an edge sticks: the slip zone is not "
        "exact",
        Regime.LARGE: "",
        Regime.MODERATE: "",
    }.get(regime, "no stick zone was found")
    if not warning and max(getattr(d, side) for side in sides) > WIDE * h:
        warning = "the slip zone is a large part of the contact: the other edge affects it"
    return warning
