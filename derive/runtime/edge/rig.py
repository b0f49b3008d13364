r"""Loads of a body whose edge is that of another contact: a rig for a prototype.

Slip next to an edge depends to the first order on K_N, K_T, f and the move of the edge alone.  A
body under P and M has two numbers free, a and c, and so a rig can be given

    one edge     K_N by the width, at M = 0; the move by dP, at dM = 0; K_T by dQ; L_T, if wished,
                 by dQ and dsigma together; L_N, if wished, by a parameter of the body left free
    both edges   both K_N by P and M; both moves by dP and dM; both K_T by dQ and dsigma

What is left over differs one order further: L_N and L_T, the width, and the other edge.  Some
wishes exclude each other: a cylinder has one K_N at both edges, and L_N = -K_N/(2 h) there.

All of a body comes from its functions of (a, c), which are explicit, so that one damped Newton's
method in log h, mid/h and the logarithm of the free parameter serves all of them.
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
"""Widths of the contact at which the search begins [m]."""

LEANS = np.linspace(-0.45, 0.45, 7)
"""Middles over widths at which it begins."""

FREE = np.geomspace(1e-6, 1e6, 37)
"""Values of a free parameter at which it begins."""

STARTS, STEPS = 16, 60
"""Places from which Newton's method begins at most, and its steps."""

CLOSE = 1e-8
"""What is left of a wish that counts as met, in parts."""

WIDE = 0.2
"""A slip zone over the width above which an edge is not alone."""


class Edge(NamedTuple):
    """One edge at the end of the half-cycle that raises Q.

    K_N  coefficient of sqrt(s) in the pressure [Pa/sqrt(m)]
    K_T  coefficient of 1/sqrt(s) in the full-stick change of shear, signed [Pa sqrt(m)]
    da   how much further the edge reaches than at the other end of the half-cycle [m]
    L_N, L_T  of s**(3/2) and s**(1/2) [Pa/m**(3/2), Pa/sqrt(m)]; None: not known, or not wished
    side "left" or "right"
    """

    K_N: float
    K_T: float
    da: float = 0.0
    L_N: float | None = None
    L_T: float | None = None
    side: str = "left"


class Rig(NamedTuple):
    """Loads of a rig, and what its edges have.  describe() tells it in words.

    P, M            at the end of the half-cycle that raises Q [N/m, N]
    dQ, dsigma, dP, dM  by how much more than at its start [N/m, Pa, N/m, N]
    parameters      of the body, the free one among them
    first, second   Contact at the start and at the end of the half-cycle
    edges           Edges of Edge: what both edges of the rig have
    d               Edges: exact slip zones at `second` [m]; NaN where none is known
    regime          a code of Regime, as of stick_zone
    met, missed     wishes that are met, and those that are not, in words
    next_order      by what part the rig's slip zone differs through L_N and L_T, Edges; NaN where
                    these are not known or no wish is
    warning         what speaks against the loads, in words; "" if nothing does
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
    """Loads of a body that give its edge the K_N, K_T and move of another contact's edge.

        K_N(a, c) = K_N;  a - a_1 = da;  K_T(a, c, dQ, dsigma) = K_T

    Parameters
    ----------
    edge : Edge or Edges
        An Edge, and M = dM = 0; or a body's Edges(left, right) of two, for both edges.
    module : module
        The body: a generated module, such as generated.hertz.
    f : float
        Coefficient of friction, of both contacts [-].
    E_star : float
        Composite modulus of the rig [Pa].
    free : str, optional
        The name of a parameter to be found, too, so that L_N is met.
    **parameters : float
        Parameters of the body, but for the free one.

    Returns
    -------
    Rig
        Its warning says what is wrong with the rig's loads, if anything.

    Raises
    ------
    ValueError
        Where the wishes cannot be met, and says which.

    Notes
    -----
    All are numbers.  L_T is met by dsigma where it is given; else dsigma = 0, for one edge.
    Loads that shear the other way are turned, so that dQ >= 0: slip is the same, of the other
    sense. Where a body can do it in several ways, the widest contact is taken.

    Examples
    --------
    >>> from generated import hertz
    >>> rig = match(Edge(2.5e10, 2e6), hertz, f=0.5, E_star=115e9, R=0.1)
    >>> f"P = {rig.P:.4g} N/m, dQ = {rig.dQ:.4g} N/m, slip zone {1e6 * rig.d.left:.0f} um"
    'P = 8.069e+05 N/m, dQ = 2.732e+05 N/m, slip zone 176 um'
    """
    law = _law(module, free, parameters)
    f, E_star = _positive(f, "f"), _positive(E_star, "E_star")
    wished = _wishes(edge)
    body = _Body(module, E_star, law, free)
    if free and all(one.L_N is None for one in wished.values()):
        raise ValueError(f"free={free!r} is found by L_N: give L_N of an edge, or {free} itself")
    a, c, own = _contact(body, wished)
    second = body.contact(a, c, own)
    first = _before(body, second, own, wished)
    dQ, dsigma = _shear(a + c, wished)
    P, M, P_1, M_1 = (of(at) for at in (second, first) for of in (body.load(own), body.moment(own)))
    one = len(wished) == 1
    turned = dQ < 0
    if turned:
        dQ, dsigma = -dQ, 0.0 - dsigma
    friction = dict(f=f, E_star=E_star, **own)
    zone = module.stick_zone(first, second, dQ, dsigma, **friction)
    d = Edges(float(second.a - zone.m), float(second.c - zone.n))
    regime = int(zone.regime)
    edges = _edges(body, first, second, own, dQ, dsigma, -1.0 if turned else 1.0)
    met, missed = _told(edges, wished, a + c)
    parts = [_next_order(wished.get(side), had, f) for side, had in zip(SIDES, edges, strict=True)]
    warning = _warning(Regime(regime), d, a + c, dQ, f * (P + P_1), [*wished])
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
    """A rig in words and numbers, a line each; SI units.

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
    for side, had, d, part in zip(SIDES, rig.edges, rig.d, rig.next_order, strict=True):
        lines.append(
            f"{side} edge: K_N = {had.K_N:.6g}, L_N = {had.L_N:.4g}, K_T = {had.K_T:.6g}, "
            f"L_T = {had.L_T:.4g}, moves by {had.da:.4g} m, slip zone {d:.6g} m"
        )
        if math.isfinite(part):
            lines.append(f"    its L_N and L_T change the slip zone by {100 * part:+.2g} %")
    lines.append(f"met: {', '.join(rig.met)}")
    lines += [f"not met: {words}" for words in rig.missed]
    lines += [f"warning: {rig.warning}"] if rig.warning else []
    return "\n".join(lines)


# ---------------------------------------------------------------- what is given


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
        raise ValueError(f"the body's parameters are {', '.join(asked) or 'none'}; got {given}")
    return {name: _positive(parameters[name], name) for name in asked}


def _number(value: Any, name: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"{name} must be one number; got {value!r:.60}")
    return number


def _positive(value: Any, name: str) -> float:
    number = _number(value, name)
    if not number > 0:
        raise ValueError(f"{name} must be positive; got {number:.6g}")
    return number


def _wishes(edge: Any) -> dict[str, Edge]:
    """What each edge is to have, as numbers."""
    pair = hasattr(edge, "left") and hasattr(edge, "right")  # Edges of any package
    given = dict(zip(SIDES, edge, strict=True)) if pair else {getattr(edge, "side", None): edge}
    for side, one in given.items():
        if not isinstance(one, Edge):
            raise TypeError(f"edge must be an Edge, or Edges(left, right) of two; got {one!r:.60}")
        if side not in SIDES:
            raise ValueError(f"side must be 'left' or 'right'; got {side!r:.40}")
        _positive(one.K_N, "K_N")
    named = {
        side: {name: v for name, v in one._asdict().items() if name != "side" and v is not None}
        for side, one in given.items()
    }
    return {
        str(side): Edge(**{name: _number(v, name) for name, v in values.items()}, side=str(side))
        for side, values in named.items()
    }


class _Body(NamedTuple):
    """A module and its parameters; the free one stands at the end of what is looked for."""

    module: Any
    E_star: float
    law: dict[str, float]
    free: str | None

    def own(self, value: Any) -> dict[str, Any]:
        """All parameters."""
        return self.law | ({self.free: value} if self.free else {})

    def of(self, name: str, a: Any, c: Any, own: Mapping[str, Any]) -> Any:
        """One of the body's functions at (a, c)."""
        return getattr(self.module, name)(a, c, E_star=self.E_star, **own)

    def contact(self, a: float, c: float, own: Mapping[str, float]) -> Contact:
        """The contact with its tilt."""
        return Contact(a, c, float(self.module.tilt(a, c, **own)))

    def load(self, own: Mapping[str, float]) -> Callable[[Contact], float]:
        """P of a contact."""
        return lambda at: float(self.of("load", at.a, at.c, own))

    def moment(self, own: Mapping[str, float]) -> Callable[[Contact], float]:
        """M of a contact."""
        return lambda at: float(self.of("moment", at.a, at.c, own))


# ---------------------------------------------------------------- the contact


def _contact(body: _Body, wished: Mapping[str, Edge]) -> tuple[float, float, dict[str, float]]:
    """The widest contact whose edges are as wished, and the body's parameters."""

    def off(u: Any) -> Any:
        """What is left of the wishes, the last axis; u are log h, mid/h, log of what is free."""
        h, lean = np.exp(u[..., 0]), u[..., 1]
        a, c = h * (0.5 - lean), h * (0.5 + lean)
        own = body.own(np.exp(u[..., 2])) if body.free else body.law
        K_N = body.of("K_N", a, c, own)
        rows = [np.log(getattr(K_N, side) / one.K_N) for side, one in wished.items()]
        if len(wished) == 1:
            rows.append(body.of("moment", a, c, own) / (body.of("load", a, c, own) * h))
        if body.free:
            L_N = body.of("L_N", a, c, own)
            rows += [
                (getattr(L_N, side) - one.L_N) * h / one.K_N
                for side, one in wished.items()
                if one.L_N is not None
            ]
        return np.stack(np.broadcast_arrays(*rows), -1)

    axes = [np.log(WIDTHS), LEANS, *([np.log(FREE)] if body.free else [])]
    with np.errstate(all="ignore"):
        grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
        found = [_solved(off, grid[at]) for at in _lowest(np.sum(off(grid) ** 2, -1))]
    known = [one for one in found if one[1] < CLOSE]
    if not known:
        raise ValueError(_impossible(body, wished, found))
    # the widest; of those as wide the one that leans least
    u, _ = max(known, key=lambda one: (round(one[0][0], 6), -abs(one[0][1])))
    h, lean = math.exp(u[0]), float(u[1])
    own = {k: float(v) for k, v in body.own(math.exp(u[-1])).items()}
    return h * (0.5 - lean), h * (0.5 + lean), own


def _lowest(cost: Any) -> list[tuple[int, ...]]:
    """Places on a grid that lie no higher than their neighbours, the lowest first."""
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


def _solved(off: Callable[[Any], Any], u: Any) -> tuple[Any, float]:
    """Newton's method with steps that are halved until they help; u, and the largest thing left.

    Where wishes leave a direction open, as of a cylinder that rolls, it is not gone into.
    """
    left = off(u)
    for _ in range(STEPS):
        small = 1e-6 * np.eye(len(u))
        rates = np.stack([(off(u + one) - off(u - one)) / 2e-6 for one in small], -1)
        if not np.all(np.isfinite(rates)):
            break
        step = np.linalg.lstsq(rates, -left, rcond=1e-8)[0]
        step *= min(1.0, 1.0 / max(np.max(np.abs(step)), 1e-300))
        for _ in range(30):
            trial = off(u + step)
            if np.sum(trial**2) < np.sum(left**2):
                break
            step = step / 2
        else:
            break
        u, left = u + step, trial
    return u, float(np.max(np.abs(left)))


def _impossible(body: _Body, wished: Mapping[str, Edge], found: Any) -> str:
    """Which wishes exclude each other, and what comes nearest."""
    name = body.module.__name__.rpartition(".")[2]
    asks = [f"K_N = {one.K_N:.6g} at the {side} edge" for side, one in wished.items()]
    if body.free:
        asks += [
            f"L_N = {one.L_N:.6g} at the {side} edge"
            for side, one in wished.items()
            if one.L_N is not None
        ]
    told = f"no contact of {name}{' with M = 0' if len(wished) == 1 else ''} has "
    told += " and ".join(asks)
    if found:
        u, _ = min(found, key=lambda one: one[1])
        h, own = math.exp(u[0]), body.own(math.exp(u[-1]))
        a, c = h * (0.5 - u[1]), h * (0.5 + u[1])
        names = ("K_N", "L_N") if body.free else ("K_N",)
        near = [
            f"{name} = {float(getattr(body.of(name, a, c, own), side)):.6g} at the {side} edge"
            for name in names
            for side in wished
        ]
        if len(wished) == 1:
            near.append(f"M = {float(body.of('moment', a, c, own)):.6g}")
        told += f"; the nearest has {', '.join(near)}"
    if len(wished) == 2:
        return told + ": match one edge alone, or take a body whose edges may differ so"
    if body.free:
        return told + f": give {body.free} in place of L_N, or take another body"
    return told + ": take other parameters, or another body"


def _before(
    body: _Body, now: Contact, own: Mapping[str, float], wished: Mapping[str, Edge]
) -> Contact:
    """The contact at the start of the half-cycle: its edges reach less far by their moves."""
    moves = {side: one.da for side, one in wished.items()}
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
            f"the edge moves by {max(moves.values()):.6g} m, which no load of this body does with "
            f"a contact of {now.a + now.c:.6g} m: take a larger body"
            + (", or match one edge alone" if len(moves) == 2 else "")
        )
    return body.contact(a, c, own)


def _beside(
    body: _Body, now: Contact, own: Mapping[str, float], side: str, move: float
) -> tuple[float, float]:
    """Edges of the contact without a moment whose edge on one side reaches less far."""
    h, near = now.a + now.c, (now.a if side == "left" else now.c) - move

    def edges(u: Any) -> tuple[Any, Any]:
        far = np.exp(u[..., 0]) - near
        return (near, far) if side == "left" else (far, near)

    def off(u: Any) -> Any:
        a, c = edges(u)
        at = body.of("moment", a, c, own) / (body.of("load", a, c, own) * h)
        return np.reshape(at, (*np.shape(u)[:-1], 1))

    if not h - 2 * move > 0:
        return math.nan, math.nan
    with np.errstate(all="ignore"):
        u, left = _solved(off, np.array([math.log(h - 2 * move)]))
    a, c = edges(u)
    return (float(a), float(c)) if left < CLOSE else (math.nan, math.nan)


# ---------------------------------------------------------------- shear, and what comes of it


def _shear(h: float, wished: Mapping[str, Edge]) -> tuple[float, float]:
    """dQ and dsigma: sqrt(h) K_T = dQ/pi +- dsigma h/8, 2 h**(3/2) L_T = dQ/pi -+ 3 dsigma h/8."""
    if len(wished) == 2:
        left, right = (math.sqrt(h) * wished[side].K_T for side in SIDES)
        return math.pi * (left + right) / 2, 4 * (left - right) / h
    ((side, one),) = wished.items()
    force, pull = math.sqrt(h) * one.K_T, 0.0
    if one.L_T is not None:
        pull = (force - 2 * h**1.5 * one.L_T) / 4
    return math.pi * (force - pull), 8 * pull / h * (1 if side == "left" else -1)


def _edges(
    body: _Body,
    first: Contact,
    second: Contact,
    own: Mapping[str, float],
    dQ: float,
    dsigma: float,
    sense: float,
) -> Edges:
    """What both edges have, K_T and L_T in the prototype's sense."""
    at = second.a, second.c
    K_N, L_N = (body.of(name, *at, own) for name in ("K_N", "L_N"))
    K_T, L_T = (of(*at, sense * dQ, sense * dsigma) for of in (body.module.K_T, body.module.L_T))
    moves = Edges(second.a - first.a, second.c - first.c)
    rows = zip(K_N, K_T, moves, L_N, L_T, SIDES, strict=True)
    had = [Edge(*map(float, row[:-1]), side=row[-1]) for row in rows]  # type: ignore[misc, arg-type]
    return Edges(*had)


def _told(
    edges: Edges, wished: Mapping[str, Edge], h: float
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Wishes that are met, and those that are not."""
    met, missed = [], []
    for side, one in wished.items():
        had = getattr(edges, side)
        sizes = {"K_N": had.K_N, "K_T": had.K_T, "da": h, "L_N": had.K_N / h, "L_T": had.K_T / h}
        for name, size in sizes.items():
            asked, is_there = getattr(one, name), getattr(had, name)
            if asked is None:
                continue
            where = f"{name} ({side})"
            if abs(is_there - asked) <= CLOSE * max(abs(asked), abs(size)):
                met.append(where)
            else:
                missed.append(f"{where} is {is_there:.6g} where {asked:.6g} is wished")
    return tuple(met), tuple(missed)


def _next_order(wished: Edge | None, had: Edge, f: float) -> float:
    """By what part the slip zone differs through L_N and L_T, each edge taken alone."""
    if wished is None or wished.L_N is None or wished.L_T is None:
        return math.nan

    def d(of: Edge) -> float:
        found = slip_zone(of.K_N, of.K_T, f=f, L_N=of.L_N, L_T=of.L_T, da=of.da)
        return float(found.d)

    return d(had) / d(wished) - 1


def _warning(regime: Regime, d: Edges, h: float, dQ: float, holds: float, sides: list[str]) -> str:
    """What speaks against the loads."""
    said = {
        Regime.SLIDING: f"the rig slides: dQ = {dQ:.6g} N/m, and f (P_1 + P_2) is {holds:.6g}",
        Regime.FULL_STICK: "nothing slips",
        Regime.MIXED: "slip reverses within a half-cycle, or an edge sticks: no exact slip zone",
        Regime.LARGE: "",
        Regime.MODERATE: "",
    }.get(regime, "no stick zone was found")
    if not said and max(getattr(d, side) for side in sides) > WIDE * h:
        said = "the slip zone is a large part of the contact: the edge is not alone"
    return said
