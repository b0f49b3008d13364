"""Coefficients, moves and slip zones of both edges from the load steps of a table.

The half-cycle leads from the first load step to the last.  Slip zones are told at its end.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import hypot, nan

import numpy as np

from derive.edge.table import Step
from derive.errors import BadTable
from derive.runtime.edge import (
    OtherEdge,
    Pressure,
    PressureFit,
    ShearFit,
    fit_pressure,
    fit_stuck_shear,
    reach,
    slip_zone,
)

INSIDE = 0.5
"""Pressure at an end of a table, over the largest, that says that contact does not end there."""

SIDES = ("left", "right")

PRESSURES, WIDTHS = (1e4, 1e11), (1e-7, 1.0)
"""Largest pressures and widths between which a table's units are believed [Pa, m]."""


@dataclass(frozen=True)
class Found:
    """One edge at one load step."""

    step: str
    side: str
    pressure: PressureFit


@dataclass(frozen=True)
class Zone:
    """A slip zone at the end of the half-cycle [m].

    error   one standard deviation, of what was fitted
    series  what one more term would change
    part    the slip zone over the distance at which the next term matters as much
    """

    side: str
    K_T: float
    K_T_error: float
    da: float
    d: float
    error: float
    series: float
    order: int
    part: float


@dataclass(frozen=True)
class Findings:
    """All that a table says; notes are warnings and what is not there."""

    edges: tuple[Found, ...]
    shears: tuple[tuple[str, ShearFit], ...]
    zones: tuple[Zone, ...]
    notes: tuple[str, ...]


def find(
    steps: Sequence[Step],
    shown: str,
    f: float,
    dQ: float | None = None,
    dsigma: float | None = None,
) -> Findings:
    """What a table says of both edges.

    dQ, dsigma: what the loads change by, in place of a shear traction [N/m, Pa].

    Raises BadTable for what is no contact.
    """
    notes: list[str] = []
    edges = [edge for step in steps for edge in _edges(step, shown, notes)]
    if not edges:
        raise BadTable(
            shown, "the table ends inside the contact on both sides", "give nodes up to an edge"
        )
    first = {e.side: e for e in edges if e.step == steps[0].name}
    last = {e.side: e for e in edges if e.step == steps[-1].name}
    shears = _shears(steps, last, shown, notes)
    stuck = {side: (s.K_T, s.K_T_error, s.L_T, s.L_T_error) for side, s in shears}
    if dQ is not None or dsigma is not None:
        if shears:
            raise BadTable(
                shown, "holds a shear traction, and --dQ or --dsigma say it again", "give one"
            )
        if len(last) < 2:
            raise BadTable(
                shown, "has one edge", "--dQ and --dsigma need both: give a shear column"
            )
        stuck = _from_loads(last, dQ or 0.0, dsigma or 0.0)
    if not stuck and all(np.isnan(e.pressure.edge) for e in last.values()):
        notes.append("no slip zone: neither edge was found")
    elif not stuck:
        notes.append(
            "no slip zone: the table has no shear traction of a run without slip; give one, or "
            "--dQ and --dsigma"
        )
    moves = {side: _move(first.get(side), last[side]) for side in last}
    zones = tuple(
        _zone(side, last, first, stuck, moves, f)
        for side in SIDES
        if side in last and side in stuck
    )
    unlikely = _unlikely(steps[-1])
    notes += [unlikely] if unlikely else []
    slides = _slides(steps, last, stuck, f)
    if slides:
        notes.append(slides)
        none = dict.fromkeys(("d", "error", "series", "part"), nan)
        zones = tuple(replace(zone, **none) for zone in zones)  # type: ignore[arg-type]
    for zone in () if slides else zones:
        if np.isnan(zone.d):
            notes.append(f"{zone.side} edge: slip does not reach in at both ends of the half-cycle")
        elif zone.part > 0.3:
            notes.append(
                f"{zone.side} edge: the slip zone is {zone.part:.1f} of the distance at which the "
                "next term matters as much: the series does not hold so far in"
            )
    return Findings(tuple(edges), tuple(shears), zones, tuple(notes))


def _unlikely(step: Step) -> str:
    """What speaks against the units of a table; "" if nothing does."""
    highest, inside = float(np.max(step.p)), step.x[step.p > 0]
    width = float(np.ptp(inside))
    if PRESSURES[0] <= highest <= PRESSURES[1] and WIDTHS[0] <= width <= WIDTHS[1]:
        return ""
    return f"pressure rises to {highest:.3g} Pa over a contact of {width:.3g} m: check the units"


def _slides(
    steps: Sequence[Step],
    last: dict[str, Found],
    stuck: dict[str, tuple[float, float, float, float]],
    f: float,
) -> str:
    """Why the whole contact slides; "" where it does not, or where that is not known."""
    if len(last) < 2 or len(stuck) < 2:
        return ""
    h = last["right"].pressure.edge - last["left"].pressure.edge
    dQ = np.pi * np.sqrt(h) * (stuck["left"][0] + stuck["right"][0]) / 2
    holds = f * sum(np.trapezoid(step.p, step.x) for step in (steps[0], steps[-1]))
    if not abs(dQ) >= holds:
        return ""
    return (
        f"no slip zone: the contact slides, since dQ = {dQ:.3g} N/m and f (P_1 + P_2) is "
        f"{holds:.3g} N/m"
    )


def _edges(step: Step, shown: str, notes: list[str]) -> list[Found]:
    """The edges of one load step."""
    where = f"load step {step.name}: " if step.name else ""
    found = []
    for side, way in zip(SIDES, (1, -1), strict=True):
        x, p = step.x[::way], step.p[::way]
        try:
            fit = fit_pressure(x, p)
        except ValueError as error:
            raise BadTable(shown, f"{where}{error}", "nothing was computed") from None
        if p[0] > INSIDE * np.max(p):
            notes.append(f"{where}{side} edge: the table ends inside the contact")
            continue
        if fit.warning:
            notes.append(f"{where}{side} edge: {fit.warning}")
        found.append(Found(step.name, side, fit))
    return found


def _shears(
    steps: Sequence[Step], last: dict[str, Found], shown: str, notes: list[str]
) -> list[tuple[str, ShearFit]]:
    """Full stick at both edges, from the change of shear over the half-cycle."""
    first, end = steps[0], steps[-1]
    if end.q is None or first.q is None:
        return []
    dq = end.q
    if len(steps) > 1:
        if len(first.x) != len(end.x) or np.any(first.x != end.x):
            raise BadTable(
                shown,
                "the first and the last load step have shear at different nodes",
                "give the same nodes, so that its change is known",
            )
        dq = end.q - first.q
    found = []
    for side, way in zip(SIDES, (1, -1), strict=True):
        if side not in last or np.isnan(last[side].pressure.edge):
            continue
        fitted = last[side].pressure
        try:
            fit = fit_stuck_shear(end.x[::way], dq[::way], fitted.edge, fitted.edge_error)
        except ValueError as error:
            raise BadTable(shown, f"shear: {error}", "nothing was computed") from None
        if fit.warning:
            notes.append(f"{side} edge, shear: {fit.warning}")
        found.append((side, fit))
    return found


def _from_loads(
    last: dict[str, Found], dQ: float, dsigma: float
) -> dict[str, tuple[float, float, float, float]]:
    """K_T and L_T of full stick from the loads, as generated/full_stick.py has them."""
    h = last["right"].pressure.edge - last["left"].pressure.edge
    off = hypot(last["right"].pressure.edge_error, last["left"].pressure.edge_error)
    found = {}
    for side, sign in zip(SIDES, (1, -1), strict=True):

        def both(h: float, sign: int = sign) -> tuple[float, float]:
            pull = sign * dsigma * h / 8
            return (dQ / np.pi + pull) / h**0.5, (dQ / np.pi - 3 * pull) / (2 * h**1.5)

        (K_T, L_T), (K_2, L_2) = both(h), both(h + off)
        found[side] = (K_T, abs(K_2 - K_T), L_T, abs(L_2 - L_T))
    return found


def _move(first: Found | None, last: Found) -> float:
    """How much further an edge reaches at the end."""
    if first is None:
        return 0.0
    outward = -1 if last.side == "left" else 1
    return outward * (last.pressure.edge - first.pressure.edge) + 0.0  # not -0


def _zone(
    side: str,
    last: dict[str, Found],
    first: dict[str, Found],
    stuck: dict[str, tuple[float, float, float, float]],
    moves: dict[str, float],
    f: float,
) -> Zone:
    """The slip zone of one edge, to the second order where that is the better known."""
    fit, (K_T, K_T_error, L_T, L_T_error) = last[side].pressure, stuck[side]
    theirs = SIDES[1 - SIDES.index(side)]
    pair = theirs in last and theirs in stuck
    values: dict[str, float] = {
        "K_N": fit.K_N,
        "K_T": K_T,
        "L_N": fit.L_N,
        "L_T": L_T,
        "da": moves[side],
    }
    errors = {"K_N": fit.K_N_error, "K_T": K_T_error, "L_N": fit.L_N_error, "L_T": L_T_error}
    errors["da"] = hypot(fit.edge_error, first[side].pressure.edge_error) if moves[side] else 0.0
    then = first[side].pressure if moves[side] else None

    def length(order: int, change: dict[str, float]) -> tuple[float, float]:
        v = values | change
        before = then and Pressure(then.K_N + v["K_N"] - fit.K_N, then.L_N)
        L_T_alone: float | None = v["L_T"]
        h = other = None
        if pair:
            them = last[theirs].pressure
            old = first[theirs].pressure if moves[theirs] else None
            known = Pressure(old.K_N, old.L_N) if old else None
            other = OtherEdge(them.K_N, stuck[theirs][0], them.L_N, da=moves[theirs], then=known)
            L_T_alone = None
            h = last["right"].pressure.edge - last["left"].pressure.edge
        found = slip_zone(
            v["K_N"],
            v["K_T"],
            f=f,
            L_N=v["L_N"],
            L_T=L_T_alone,
            da=v["da"],
            h=h,
            order=order,
            then=before,
            other=other,
        )
        return float(found.d), float(found.error)

    def told(order: int) -> tuple[float, float, float]:
        d, series = length(order, {})
        parts = [
            length(order, {name: values[name] + e})[0] - d
            for name, e in errors.items()
            if e and not (pair and name == "L_T")
        ]
        return d, float(np.sqrt(np.sum(np.square(parts)))), series

    # the second term counts unless what is fitted makes it less certain than it is worth
    first_d, first_error, first_series = told(1)
    d, error, series = told(2)
    order = 2
    if not error < hypot(first_error, first_series):
        d, error, series, order = first_d, first_error, first_series, 1
    width = last["right"].pressure.edge - last["left"].pressure.edge if pair else None
    over = reach(fit.K_N, K_T, L_N=fit.L_N, L_T=L_T, h=width)
    part = d / float(over) if over > 0 else nan
    return Zone(side, K_T, K_T_error, moves[side], d, error, series, order, part)
