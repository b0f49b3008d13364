"""Compute coefficients, movements and slip zones of both edges from the load steps of a table.

The half-cycle runs from the first load step to the last.  The slip zones are those at its end.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
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

SIDES = ("left", "right")

PRESSURES, WIDTHS = (1e4, 1e11), (1e-7, 1.0)
"""Plausible ranges of the largest pressure [Pa] and of the contact width [m] in a table."""


@dataclass(frozen=True)
class FittedEdge:
    """The fit of one edge at one load step."""

    step: str
    side: str
    pressure: PressureFit


@dataclass(frozen=True)
class Zone:
    """A slip zone at the end of the half-cycle.

    d       the size of the slip zone [m]
    error   one standard deviation, due to the uncertainty of the fit [m]
    series  the change that one more term of the series would make [m]
    order   the order of the series
    part    the slip zone divided by the distance at which the next term equals the first
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
    """All results from a table; the notes are warnings, and reasons for missing results."""

    edges: tuple[FittedEdge, ...]
    shears: tuple[tuple[str, ShearFit], ...]
    zones: tuple[Zone, ...]
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
    last = {e.side: e for e in edges if e.step == steps[-1].name}
    shears = _shears(steps, last, shown, notes)
    stuck = {side: (s.K_T, s.K_T_error, s.L_T, s.L_T_error) for side, s in shears}
    if dQ is not None or dsigma is not None:
        if shears:
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
        stuck = _from_loads(last, dQ or 0.0, dsigma or 0.0)
    if not stuck and all(np.isnan(e.pressure.edge) for e in last.values()):
        notes.append("the slip zones cannot be computed, because neither edge was found")
    elif not stuck:
        notes.append(
            "the slip zones cannot be computed, because the shear traction is missing: add that of "
            "a run without slip to the table, or give --dQ and --dsigma"
        )
    notes += _unlikely(steps[-1])
    slides = _slides(steps, last, stuck, f)
    notes += slides
    moves = {side: _move(first.get(side), last[side]) for side in last}
    zones = tuple(
        _zone(side, last, first, stuck, moves, nan if slides else f)
        for side in SIDES
        if side in last and side in stuck
    )
    for zone in () if slides else zones:
        if np.isnan(zone.d):
            notes.append(
                f"{zone.side} edge: no slip zone extends inward from the edge at both ends of the "
                "half-cycle"
            )
        elif zone.part > 0.3:
            notes.append(
                f"{zone.side} edge: the slip zone is {zone.part:.1f} times the distance at which "
                "the next term equals the first, so the series is not reliable there"
            )
    return Findings(tuple(edges), tuple(shears), zones, tuple(notes))


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
    steps: Sequence[Step],
    last: dict[str, FittedEdge],
    stuck: dict[str, tuple[float, float, float, float]],
    f: float,
) -> list[str]:
    """Return why the whole contact slides, if it does and if this is known."""
    if len(last) < 2 or len(stuck) < 2:
        return []
    h = last["right"].pressure.edge - last["left"].pressure.edge
    dQ = np.pi * np.sqrt(h) * (stuck["left"][0] + stuck["right"][0]) / 2
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
    for side, direction in zip(SIDES, (1, -1), strict=True):
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


def _shears(
    steps: Sequence[Step], last: dict[str, FittedEdge], shown: str, notes: list[str]
) -> list[tuple[str, ShearFit]]:
    """Fit full stick at both edges to the change in the shear traction over the half-cycle."""
    first, end = steps[0], steps[-1]
    if end.q is None or first.q is None:
        return []
    dq = end.q
    if len(steps) > 1:
        if len(first.x) != len(end.x) or np.any(first.x != end.x):
            raise BadTable(
                shown,
                "the first and the last load step have shear tractions at different nodes",
                "use the same nodes in both, so that the change is known",
            )
        dq = end.q - first.q
    shears = []
    for side, direction in zip(SIDES, (1, -1), strict=True):
        if side not in last or np.isnan(last[side].pressure.edge):
            continue
        fitted = last[side].pressure
        try:
            fit = fit_stuck_shear(
                end.x[::direction], dq[::direction], fitted.edge, fitted.edge_error
            )
        except ValueError as error:
            raise BadTable(shown, f"shear: {error}", "correct the table") from None
        if fit.warning:
            notes.append(f"{side} edge, shear: {fit.warning}")
        shears.append((side, fit))
    return shears


def _from_loads(
    last: dict[str, FittedEdge], dQ: float, dsigma: float
) -> dict[str, tuple[float, float, float, float]]:
    """Compute K_T and L_T of full stick from the loads, as in generated/full_stick.py."""
    h = last["right"].pressure.edge - last["left"].pressure.edge
    h_error = hypot(last["right"].pressure.edge_error, last["left"].pressure.edge_error)
    coefficients = {}
    for side, sign in zip(SIDES, (1, -1), strict=True):

        def both(h: float, sign: int = sign) -> tuple[float, float]:
            by_tension = sign * dsigma * h / 8
            return (dQ / np.pi + by_tension) / h**0.5, (dQ / np.pi - 3 * by_tension) / (2 * h**1.5)

        (K_T, L_T), (K_2, L_2) = both(h), both(h + h_error)
        coefficients[side] = (K_T, abs(K_2 - K_T), L_T, abs(L_2 - L_T))
    return coefficients


def _move(first: FittedEdge | None, last: FittedEdge) -> float:
    """Return how far an edge moves outward from the start to the end of the half-cycle."""
    if first is None:
        return 0.0
    outward = -1 if last.side == "left" else 1
    return outward * (last.pressure.edge - first.pressure.edge) + 0.0  # not -0


def _zone(
    side: str,
    last: dict[str, FittedEdge],
    first: dict[str, FittedEdge],
    stuck: dict[str, tuple[float, float, float, float]],
    moves: dict[str, float],
    f: float,
) -> Zone:
    """Compute the slip zone of one edge, to the second order if that is more certain."""
    fit, (K_T, K_T_error, L_T, L_T_error) = last[side].pressure, stuck[side]
    other_side = SIDES[1 - SIDES.index(side)]
    width = other_K_T = by_other = None
    if other_side in last and other_side in stuck:
        width = last["right"].pressure.edge - last["left"].pressure.edge
        other_K_T, other_fit = stuck[other_side][0], last[other_side].pressure
        other = slip_zone(other_fit.K_N, other_K_T, f=f, da=moves[other_side])
        by_other = other_K_T * float(other.d) / (4 * width)  # as in docs/edge.md
        L_T_error = 0.0
    values = {"K_N": fit.K_N, "K_T": K_T, "L_N": fit.L_N, "L_T": L_T, "da": moves[side]}
    errors = {"K_N": fit.K_N_error, "K_T": K_T_error, "L_N": fit.L_N_error, "L_T": L_T_error}
    errors["da"] = hypot(fit.edge_error, first[side].pressure.edge_error) if moves[side] else 0.0

    def length(order: int, **changed: float) -> float:
        used = values | changed
        if width and other_K_T and by_other and order == 2:
            used |= {"L_T": (2 * other_K_T - used["K_T"]) / (2 * width)}
            used |= {"K_T": used["K_T"] + by_other}
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
    distance = reach(fit.K_N, K_T, L_N=fit.L_N, L_T=L_T, h=width)
    part = d / float(distance) if distance > 0 else nan
    return Zone(side, K_T, K_T_error, moves[side], d, error, series, order, part)
