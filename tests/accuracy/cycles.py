"""The functions of partial slip that are measured: what each solves, and where it is tried."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from derive.sheet import FormulaSheet
from generated._types import Regime
from tests.accuracy import loads, marches, series, tensions, tractions
from tests.accuracy.loads import Where, contacts_of, law_of
from tests.accuracy.reference import Problem
from tests.accuracy.regions import Sample

Results = Callable[[Any, Sample], tuple[Any, ...]]
"""Numbers of a generated module at a sample."""


@dataclass(frozen=True)
class Cycle:
    """One function.

    fields      its numbers
    results     them, from the generated module
    problem     what they solve, of a body
    where       regions
    starts      the unknowns, if the numbers are told from them
    share       of the points asked for
    integrated  whether it is measured for bodies whose formulas are integrals, too
    bodies      those that it is measured for; all if none is named
    without     those that it is not measured for: one point takes minutes
    """

    name: str
    fields: tuple[str, ...]
    results: Results
    problem: Callable[[str], Problem]
    where: Where
    starts: Results | None = None
    share: float = 0.2
    integrated: bool = False
    bodies: tuple[str, ...] = ()
    without: tuple[str, ...] = ()

    def takes(self, sheet: FormulaSheet) -> bool:
        """Whether it is measured for a body."""
        name = sheet.geometry.name
        among = (not self.bodies or name in self.bodies) and name not in self.without
        return among and (self.integrated or sheet.geometry.slope.is_polynomial)

    def of(self, body: str, digits: int) -> Problem:
        """Its problem, to no more digits than these."""
        problem = self.problem(body)
        return replace(problem, digits=min(digits, problem.digits))


# ------------------------------------------------------------------ what is judged


def _zone(regime: Regime) -> Results:
    def of(module: Any, sample: Sample) -> tuple[Any, ...]:
        changes = sample["dQ"], sample["dsigma"]
        zone = module.stick_zone(*contacts_of(sample), *changes, **law_of(sample))
        right = zone.regime == regime
        return np.where(right, zone.m, np.nan), np.where(right, zone.n, np.nan)

    return of


def _tensions(name: str) -> Results:
    def of(module: Any, sample: Sample) -> tuple[Any, ...]:
        return tuple(getattr(module, name)(*contacts_of(sample), sample["dQ"], **law_of(sample)))

    return of


def _patch_edges(module: Any, sample: Sample) -> tuple[Any, ...]:
    """The edges that move as the moderate solution closes a slip zone."""
    found = _tensions("closing_tension")(module, sample)
    law = {n: v for n, v in law_of(sample).items() if n != "f"}
    own = {n: v for n, v in law.items() if n != "E_star"}
    ends = contacts_of(sample)
    load = sum(module.load(e.a, e.c, **law) for e in ends) / 2 - sample["dQ"] / (2 * sample["f"])
    tilt = sum(module.tilt(e.a, e.c, **own) for e in ends) / 2
    scale = 4 * sample["f"] * sample["E_star"]
    lower, upper = (module.contact_at_tilt(load, tilt - t / scale, **law) for t in found)
    return lower.c, upper.a


def _series(name: str, *orders: int) -> Results:
    def of(module: Any, sample: Sample) -> tuple[Any, ...]:
        zones = [getattr(module, name)(**sample, order=order) for order in orders]
        return tuple(edge for zone in zones for edge in zone)

    return of


def _traction(name: str) -> Results:
    def of(module: Any, sample: Sample) -> tuple[Any, ...]:
        changes = sample["dQ"], sample["dsigma"]
        law = law_of(sample)
        return (getattr(module, name)(sample["x"], *contacts_of(sample), *changes, **law),)

    return of


def _shear(module: Any, sample: Sample) -> tuple[Any, ...]:
    here, _ = contacts_of(sample)
    fall = {"dQ": sample["dQ"], "dsigma": sample["dsigma"]}
    loaded = sample["x"], here, sample["Q"], sample["sigma"]
    return (module.shear(*loaded, **law_of(sample), **fall),)


def _risen_and_fallen(regime: Regime) -> Results:
    def of(module: Any, sample: Sample) -> tuple[Any, ...]:
        risen = {**sample, "dQ": 2 * sample["Q"], "dsigma": 2 * sample["sigma"]}
        return _zone(regime)(module, risen) + _zone(regime)(module, sample)

    return of


def _march(module: Any, sample: Sample) -> tuple[Any, ...]:
    cycle = _marched(module, sample)
    return tuple(v[..., now] for now in marches.INSTANTS for v in cycle[:4])


def _march_starts(module: Any, sample: Sample) -> tuple[Any, ...]:
    cycle, found = _marched(module, sample), []
    for now, begun in marches.INSTANTS.items():
        found += [*(v[..., now] for v in cycle[:4]), *(v[..., begun] for v in cycle[:2])]
    return tuple(found)


def _marched(module: Any, sample: Sample) -> Any:
    instants = range(len(marches.WAY))
    given = [
        np.stack([sample[marches.at(name, i)] for i in instants], axis=-1) for name in marches.LOADS
    ]
    law = {n: v[:, None] for n, v in sample.items() if n[:-2] not in marches.LOADS}
    return module.march(*given, **law)


# ------------------------------------------------------------------ the catalogue

_VARIED = loads.moderate_and_varied
_STUCK, _SLID = Regime.MODERATE, Regime.LARGE
_CLOSED_EITHER_WAY = ("hertz", "wedge")
_DEAR = ("power",)

CYCLES = (
    Cycle(
        "stick_zone, moderate tension",
        ("m", "n"),
        _zone(_STUCK),
        lambda body: Problem(tensions.patch(body)),
        _VARIED,
        integrated=True,
    ),
    Cycle(
        "stick_zone, large tension",
        ("m", "n"),
        _zone(_SLID),
        lambda body: Problem(tensions.between(body), digits=tractions.large_digits(body)),
        loads.large,
        share=0.02,
        integrated=True,
        without=_DEAR,
    ),
    Cycle(
        "tension_threshold",
        ("lower", "upper"),
        _tensions("tension_threshold"),
        lambda body: Problem(tensions.threshold(body)),
        loads.without_tension(loads.moderate),
        integrated=True,
    ),
    Cycle(
        "closing_tension",
        ("lower", "upper"),
        _tensions("closing_tension"),
        tensions.closing,
        loads.without_tension(_VARIED),
        starts=_patch_edges,
        integrated=True,
        share=0.1,
    ),
    *(
        Cycle(
            f"slip_zones, order {order}",
            ("left", "right"),
            _series("slip_zones", order),
            series.series(order),
            loads.as_gained(_VARIED),
            integrated=True,
            share=0.1,
            without=_DEAR if order == 3 else (),
        )
        for order in (1, 2, 3)
    ),
    *(
        Cycle(
            f"slip_error, order {order}",
            ("left", "right"),
            _series("slip_error", order),
            series.error(order),
            loads.as_gained(_VARIED),
            starts=_series("slip_zones", order, order + 1),
            integrated=True,
            share=0.05,
            without=_DEAR if order == 2 else (),
        )
        for order in (1, 2)
    ),
    Cycle(
        "shear_change, moderate tension",
        ("",),
        _traction("shear_change"),
        tractions.change,
        loads.placed(loads.moderate),
        starts=_zone(_STUCK),
        integrated=True,
        share=0.1,
    ),
    Cycle(
        "shear_change, large tension",
        ("",),
        _traction("shear_change"),
        lambda body: tractions.change(body, large=True),
        loads.placed(loads.large),
        starts=_zone(_SLID),
        share=0.01,
        integrated=True,
        without=_DEAR,
    ),
    Cycle(
        "shear, moderate tension",
        ("",),
        _shear,
        tractions.shear,
        loads.risen_and_fallen(loads.placed(loads.moderate)),
        starts=_risen_and_fallen(_STUCK),
        share=0.05,
        integrated=True,
    ),
    Cycle(
        "shear, large tension",
        ("",),
        _shear,
        lambda body: tractions.shear(body, large=True),
        loads.risen_and_fallen(loads.placed(loads.large)),
        starts=_risen_and_fallen(_SLID),
        share=0.02,
        bodies=_CLOSED_EITHER_WAY,
    ),
    Cycle(
        "slip_range, moderate tension",
        ("",),
        _traction("slip_range"),
        tractions.slip,
        loads.placed(loads.moderate, slips=True),
        starts=_zone(_STUCK),
        share=0.01,
    ),
    Cycle(
        "slip_range, large tension",
        ("",),
        _traction("slip_range"),
        lambda body: tractions.slip(body, large=True),
        loads.placed(loads.large, slips=True),
        starts=_zone(_SLID),
        share=0.01,
    ),
    Cycle(
        "march",
        marches.FIELDS,
        _march,
        marches.march,
        loads.histories,
        starts=_march_starts,
        share=0.03,
        integrated=True,
    ),
)
