"""Compute coefficients, movements and slip zones of both edges from the load steps of a table.

The half-cycle runs from the first load step to the last.  The slip zones are those at its end.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import hypot, nan

import numpy as np

from derive.command.errors import BadTable
from derive.edge.table import Step
from generated.runtime.edge import (
    PressureFit,
    ShearFit,
    fit_pressure,
    fit_stuck_shear,
    reach,
    slip_zone,
)

INSIDE = 0.5
"""If the pressure at an end of the table exceeds this fraction of the largest pressure, the table
is taken to end inside the contact."""

INWARD = {"left": 1, "right": -1}
"""The direction from each edge into the contact."""

PRESSURES, WIDTHS = (1e4, 1e11), (1e-7, 1.0)
"""Plausible ranges of the largest pressure [Pa] and of the contact width [m] in a table."""


@dataclass(frozen=True)
class Zone:
    """A slip zone at the end of the half-cycle.

    d       the size of the slip zone [m]
    error   one standard deviation, due to the uncertainty of the fit [m]
    series  the change that one more term of the series would make [m]
    order   the order of the series
    part    the slip zone divided by the distance at which the next term equals the first
    """

    d: float
    error: float
    series: float
    order: int
    part: float


@dataclass(frozen=True)
class FittedEdge:
    """One edge at one load step; the rest is known at the last load step only.

    shear     full stick next to the edge, or None if the table has no shear traction
    da        how far the edge has moved outward since the first load step, and its error [m]
    zone      the slip zone, or None if the shear is not known
    """

    step: str
    side: str
    pressure: PressureFit
    shear: ShearFit | None = None
    da: float = 0.0
    da_error: float = 0.0
    zone: Zone | None = None


@dataclass(frozen=True)
class Findings:
    """All results from a table; the notes are warnings, and reasons for missing results."""

    edges: tuple[FittedEdge, ...]
    notes: tuple[str, ...]


def find(
    steps: Sequence[Step],
    shown: str,
    f: float,
    dQ: float | None = None,
    dsigma: float | None = None,
    done: Callable[[str], None] = lambda step: None,
) -> Findings:
    """Evaluate a table for both edges.

    dQ, dsigma: the changes in the loads, if the table has no shear traction [N/m, Pa].
    done: is told the name of each load step once its edges are fitted.

    Raises BadTable if the table does not describe a contact.
    """
    notes: list[str] = []
    edges: list[FittedEdge] = []
    for step in steps:
        edges += _edges(step, shown, notes)
        done(step.name)
    if not edges:
        raise BadTable(
            shown,
            "the table ends inside the contact on both sides",
            "add nodes up to at least one edge",
        )
    first = {e.side: e for e in edges if e.step == steps[0].name}
    last = {e.side: _moved(e, first) for e in edges if e.step == steps[-1].name}
    if dQ is None and dsigma is None:
        stuck = _shears(steps, last, shown, notes)
    else:
        stuck = _from_loads(steps[-1], last, shown, dQ or 0.0, dsigma or 0.0)
    if not stuck:
        notes.append(
            "the slip zones cannot be computed without an edge and a shear traction: if the table "
            "has no shear traction, add that of a run without slip, or give --dQ and --dsigma"
        )
    notes += _unlikely(steps[-1])
    slides = _slides(steps, last, stuck, f)
    notes += slides
    for side in stuck:
        zone = _zone(side, last, stuck, nan if slides else f)
        last[side] = replace(last[side], shear=stuck[side], zone=zone)
        if slides:
            continue
        if np.isnan(zone.d):
            notes.append(
                f"{side} edge: no slip zone extends inward from the edge at both ends of the "
                "half-cycle"
            )
        elif zone.part > 0.3:
            notes.append(
                f"{side} edge: the slip zone is {zone.part:.1f} times the distance at which "
                "the next term equals the first, so the series is not reliable there"
            )
    before = [e for e in edges if e.step != steps[-1].name]
    return Findings((*before, *last.values()), tuple(notes))


def _unlikely(step: Step) -> list[str]:
    """Return a warning if the units of a table are not plausible."""
    highest, inside = float(np.max(step.p)), step.x[step.p > 0]
    width = float(np.ptp(inside))
    if PRESSURES[0] <= highest <= PRESSURES[1] and WIDTHS[0] <= width <= WIDTHS[1]:
        return []
    return [
        f"the largest pressure is {highest:.3g} Pa and the contact is {width:.3g} m wide: "
        "check the units"
    ]


def _slides(
    steps: Sequence[Step], last: dict[str, FittedEdge], stuck: dict[str, ShearFit], f: float
) -> list[str]:
    """Return why the whole contact slides, if it does and if this is known."""
    if len(stuck) < 2:
        return []
    h = last["right"].pressure.edge - last["left"].pressure.edge
    dQ = np.pi * np.sqrt(h) * (stuck["left"].K_T + stuck["right"].K_T) / 2
    capacity = f * sum(np.trapezoid(step.p, step.x) for step in (steps[0], steps[-1]))
    if not abs(dQ) >= capacity:
        return []
    return [
        f"no slip zone: the whole contact slides, because dQ = {dQ:.3g} N/m is not below "
        f"f (P_1 + P_2) = {capacity:.3g} N/m"
    ]


def _edges(step: Step, shown: str, notes: list[str]) -> list[FittedEdge]:
    """Fit the edges of one load step."""
    where = f"load step {step.name}: " if step.name else ""
    edges = []
    for side, direction in INWARD.items():
        x, p = step.x[::direction], step.p[::direction]
        try:
            fit = fit_pressure(x, p)
        except ValueError as error:
            raise BadTable(shown, f"{where}{error}", "correct the table") from None
        if p[0] > INSIDE * np.max(p):
            notes.append(f"{where}{side} edge: the table ends inside the contact")
            continue
        if fit.warning:
            notes.append(f"{where}{side} edge: {fit.warning}")
        edges.append(FittedEdge(step.name, side, fit))
    return edges


def _moved(edge: FittedEdge, first: dict[str, FittedEdge]) -> FittedEdge:
    """An edge with its movement since the first load step; 0 if it was not in the table there."""
    before = first.get(edge.side, edge).pressure
    da = INWARD[edge.side] * (before.edge - edge.pressure.edge) + 0.0  # not -0
    error = hypot(edge.pressure.edge_error, before.edge_error) if da else 0.0
    return replace(edge, da=da, da_error=error)


def _shears(
    steps: Sequence[Step], last: dict[str, FittedEdge], shown: str, notes: list[str]
) -> dict[str, ShearFit]:
    """Fit full stick at both edges to the change in the shear traction over the half-cycle."""
    first, end = steps[0], steps[-1]
    if end.q is None or first.q is None:
        return {}
    dq = end.q
    if len(steps) > 1:
        if len(first.x) != len(end.x) or np.any(first.x != end.x):
            raise BadTable(
                shown,
                "the first and the last load step have shear tractions at different nodes",
                "use the same nodes in both, so that the change is known",
            )
        dq = end.q - first.q
    shears = {}
    for side, edge in last.items():
        if np.isnan(edge.pressure.edge):
            continue
        x, dq_inward = end.x[:: INWARD[side]], dq[:: INWARD[side]]
        try:
            fit = fit_stuck_shear(x, dq_inward, edge.pressure.edge, edge.pressure.edge_error)
        except ValueError as error:
            raise BadTable(shown, f"shear: {error}", "correct the table") from None
        if fit.warning:
            notes.append(f"{side} edge, shear: {fit.warning}")
        shears[side] = fit
    return shears


def _from_loads(
    end: Step, last: dict[str, FittedEdge], shown: str, dQ: float, dsigma: float
) -> dict[str, ShearFit]:
    """Compute K_T and L_T of full stick from the loads, as in generated/full_stick.py."""
    if end.q is not None:
        raise BadTable(
            shown,
            "the table has a shear traction, and --dQ or --dsigma is given as well",
            "remove either the shear column or these options",
        )
    if len(last) < 2:
        raise BadTable(
            shown,
            "the table has only one edge, but --dQ and --dsigma need both",
            "give a column with the shear traction instead",
        )
    left, right = last["left"].pressure, last["right"].pressure
    h, h_error = right.edge - left.edge, hypot(right.edge_error, left.edge_error)

    def coefficients(h: float, sign: int) -> tuple[float, float]:
        by_tension = sign * dsigma * h / 8
        return (dQ / np.pi + by_tension) / h**0.5, (dQ / np.pi - 3 * by_tension) / (2 * h**1.5)

    found = {}
    for side, sign in INWARD.items():
        (K_T, L_T), (K_2, L_2) = coefficients(h, sign), coefficients(h + h_error, sign)
        found[side] = ShearFit(K_T, L_T, abs(K_2 - K_T), abs(L_2 - L_T))  # without nodes and a fit
    return found


def _zone(side: str, last: dict[str, FittedEdge], stuck: dict[str, ShearFit], f: float) -> Zone:
    """Compute the slip zone of one edge, to the second order if that is more certain."""
    edge, fit, shear = last[side], last[side].pressure, stuck[side]
    values = {"K_N": fit.K_N, "K_T": shear.K_T, "L_N": fit.L_N, "L_T": shear.L_T, "da": edge.da}
    errors = {"K_N": fit.K_N_error, "K_T": shear.K_T_error, "L_N": fit.L_N_error}
    errors |= {"L_T": shear.L_T_error, "da": edge.da_error}
    width = None
    if len(stuck) == 2:  # the other edge determines L_T and adds to K_T, as in docs/edge.md
        width = last["right"].pressure.edge - last["left"].pressure.edge
        (other,) = stuck.keys() - {side}
        other_K_T = stuck[other].K_T
        other_d = slip_zone(last[other].pressure.K_N, other_K_T, f=f, da=last[other].da).d
        errors["L_T"] = 0.0

    def length(order: int, **changed: float) -> float:
        used = values | changed
        if width and order == 2:
            used["L_T"] = (2 * other_K_T - used["K_T"]) / (2 * width)
            used["K_T"] += other_K_T * float(other_d) / (4 * width)
        return float(slip_zone(**used, f=f, h=width, order=order).d)

    def with_error(order: int) -> tuple[float, float]:
        d = length(order)
        parts = [length(order, **{name: values[name] + e}) - d for name, e in errors.items() if e]
        return d, float(np.sqrt(np.sum(np.square(parts))))

    # use the second term unless the uncertainty of the fit outweighs its benefit
    (first_d, first_error), (d, error), order = with_error(1), with_error(2), 2
    series = abs(d - first_d)
    if not error < hypot(first_error, series):
        d, error, order = first_d, first_error, 1
    distance = reach(fit.K_N, shear.K_T, L_N=fit.L_N, L_T=shear.L_T, h=width)
    part = d / float(distance) if distance > 0 else nan
    return Zone(d, error, series, order, part)
