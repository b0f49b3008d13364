"""What the functions of partial slip solve, in many digits, and where they are tried.

Constant normal loads: the contact [-a, c] at both ends of the cycle.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import mpmath
import numpy as np
from mpmath import mpf

from derive.sheet import FormulaSheet
from derive.symbols import h
from derive.theory import slip
from generated._types import Contact, Regime
from tests.accuracy.inverses import formula
from tests.accuracy.reference import Conditions, function_of
from tests.accuracy.regions import EXPONENTS, Regions, Sample
from tests.derive.partial_slip import Cycle as Integrals

Given = Mapping[str, mpf]


@dataclass(frozen=True)
class Cycle:
    """One function.

    fields      its numbers, in the order of the unknowns
    results     them, from the generated module
    conditions  what vanishes at them
    regions     where
    digits      of the reference
    share       of the points asked for
    bodies      those that it is measured for; all with closed formulas if none is named
    """

    name: str
    fields: tuple[str, ...]
    results: Callable[[Any, Sample], tuple[Any, ...]]
    conditions: Callable[[str], Conditions]
    regions: Callable[[Regions], Iterator[tuple[str, Sample]]]
    digits: int = 50
    share: float = 0.2
    bodies: tuple[str, ...] = ()

    def takes(self, sheet: FormulaSheet) -> bool:
        """Whether it is measured for a body: its reference needs closed formulas."""
        among = not self.bodies or sheet.geometry.name in self.bodies
        return among and sheet.geometry.slope.is_polynomial


# ------------------------------------------------------------------ conditions


def _patch(body: str) -> Conditions:
    """Moderate tension: the contact at a reduced load and a shifted tilt."""
    load, tilt = formula(body, "load"), formula(body, "tilt")

    def off(edges: Sequence[mpf], given: Given) -> list[mpf]:
        there = {**given, "a": edges[0], "c": edges[1]}
        return [
            load(**there) - load(**given) + given["dQ"] / (2 * given["f"]),
            tilt(**there) - tilt(**given) + given["dsigma"] / (4 * given["f"] * given["E_star"]),
        ]

    return off


def _between(body: str) -> Conditions:
    """Large tension: both conditions of the singular integral equation, by quadrature."""
    pressure = formula(body, "pressure")

    def off(edges: Sequence[mpf], given: Given) -> list[mpf]:
        def p(x: mpf) -> mpf:
            return pressure(**{**given, "x": x})

        sense = 1 if given["dsigma"] > 0 else -1
        cycle = Integrals(
            (p, p),
            (given["a"],) * 2,
            (given["c"],) * 2,
            given["f"],
            given["dQ"],
            given["dsigma"],
            (sense, -sense),
        )
        return [*cycle.residuals(edges[0], edges[1])]

    return off


def _threshold(body: str) -> Conditions:
    """Both K_T vanish in turn."""

    def off(tensions: Sequence[mpf], given: Given) -> list[mpf]:
        width = given["a"] + given["c"]
        return [
            mpmath.pi * width * t / 8 - s * given["dQ"]
            for t, s in zip(tensions, (-1, 1), strict=True)
        ]

    return off


def _first_order(body: str) -> Conditions:
    """d = |K_T|/(f K_N)."""
    K_N = formula(body, "K_N_left"), formula(body, "K_N_right")

    def off(zones: Sequence[mpf], given: Given) -> list[mpf]:
        width = given["a"] + given["c"]
        strain = mpmath.pi * width * given["dsigma"] / 8
        scale = mpmath.pi * mpmath.sqrt(width) * given["f"]
        pulls = abs(given["dQ"] + strain), abs(given["dQ"] - strain)
        return [scale * K(**given) * d - p for K, d, p in zip(K_N, zones, pulls, strict=True)]

    return off


def _series(order: int) -> Callable[[str], Conditions]:
    """The conditions of derive/theory/slip.py, cut behind an order."""
    if order == 1:
        return _first_order
    both = slip.conditions(order)
    names, functions = zip(*(function_of(condition) for condition in both), strict=True)

    def conditions(body: str) -> Conditions:
        at = {n: formula(body, n) for n in ("K_N_left", "K_N_right", "L_N_left", "L_N_right")}

        @cache
        def known(point: tuple[tuple[str, mpf], ...], digits: int) -> dict[str, mpf]:
            given = dict(point)
            width = given["a"] + given["c"]
            held = {**given, str(h): width}
            for side, edge in (("left", "a"), ("right", "c")):
                C = [at[f"K_N_{side}"](**given), at[f"L_N_{side}"](**given)]
                if order > 2:
                    step = width * mpf(10) ** (-digits // 3)
                    more, less = (
                        at[f"L_N_{side}"](**{**given, edge: given[edge] + s * step})
                        for s in (1, -1)
                    )
                    rate = (more - less) / (2 * step)
                    C.append((C[0] / 2 * mpf(-1) / 8 / width**2 - rate) / mpf("2.5"))
                held |= {f"C_{side}_{i}": v for i, v in enumerate(C)}
                sense = 1 if side == "left" else -1
                pull = given["dQ"] + sense * mpmath.pi * width * given["dsigma"] / 8
                held[f"K_T_{side}"] = pull / (mpmath.pi * mpmath.sqrt(width))
                held[f"kappa_{side}"] = mpf(1 if pull >= 0 else -1)
            return held

        def off(zones: Sequence[mpf], given: Given) -> list[mpf]:
            held = known(tuple(given.items()), mpmath.mp.dps)
            held = {**held, "d_left": zones[0], "d_right": zones[1]}
            return [of(*(held[n] for n in its)) for its, of in zip(names, functions, strict=True)]

        return off

    return conditions


# ------------------------------------------------------------------ what is judged


def _zone(module: Any, sample: Sample, regime: Regime) -> tuple[Any, ...]:
    here = Contact(sample["a"], sample["c"], np.zeros(len(sample["a"])))
    law = {n: v for n, v in sample.items() if n not in ("a", "c", "dQ", "dsigma")}
    zone = module.stick_zone(here, here, sample["dQ"], sample["dsigma"], **law)
    right = zone.regime == regime
    return np.where(right, zone.m, np.nan), np.where(right, zone.n, np.nan)


def _limits(module: Any, sample: Sample) -> tuple[Any, ...]:
    here = Contact(sample["a"], sample["c"], np.zeros(len(sample["a"])))
    law = {n: v for n, v in sample.items() if n not in ("a", "c", "dQ")}
    return tuple(module.tension_threshold(here, here, sample["dQ"], **law))


def _zones(order: int) -> Callable[[Any, Sample], tuple[Any, ...]]:
    return lambda module, sample: tuple(module.slip_zones(**sample, order=order))


# ------------------------------------------------------------------ where


def _slipping(
    regions: Regions, given: Sample, part: tuple[float, float], tension: tuple[float, float]
) -> Sample:
    """Shear of so many decades of f P; tension in parts of that at which K_T vanishes."""
    count = len(given["a"])
    law = {n: v for n, v in given.items() if n not in "ac"}
    friction = regions.decades(-1, 0, count)
    dQ = 2 * friction * regions.module.load(given["a"], given["c"], **law)
    dQ = dQ * regions.decades(*part, count)
    signs = regions.rng.choice([-1.0, 1.0], count)
    over = signs * regions.rng.uniform(*tension, count)
    width = given["a"] + given["c"]
    return {**given, "f": friction, "dQ": dQ, "dsigma": over * 8 * dQ / (np.pi * width)}


def _slips(
    tension: tuple[float, float],
) -> Callable[[Regions], Iterator[tuple[str, Sample]]]:
    def of(regions: Regions) -> Iterator[tuple[str, Sample]]:
        for name, given in regions.contacts():
            if len(given["a"]):
                yield name, _slipping(regions, given, (-1.5, -0.3), tension)
        bulk = next(given for name, given in regions.contacts() if name == "bulk")
        yield "tiny slip zones", _slipping(regions, bulk, (-EXPONENTS["slip"], -4), tension)
        if tension[1] < 1:
            almost = 1 - regions.decades(-6, -2, len(bulk["a"]))
            near = _slipping(regions, bulk, (-0.5, -0.2), (1, 1))
            yield "tension near the threshold", {**near, "dsigma": near["dsigma"] * almost}

    return of


def _shears(regions: Regions) -> Iterator[tuple[str, Sample]]:
    for name, sample in _slips((0, 0.9))(regions):
        if "threshold" not in name:
            yield name, {n: v for n, v in sample.items() if n != "dsigma"}


CYCLES = (
    Cycle(
        "stick_zone, moderate tension",
        ("m", "n"),
        lambda module, sample: _zone(module, sample, Regime.MODERATE),
        _patch,
        _slips((0, 0.9)),
    ),
    Cycle(
        "stick_zone, large tension",
        ("m", "n"),
        lambda module, sample: _zone(module, sample, Regime.LARGE),
        _between,
        _slips((2.5, 4.0)),
        digits=30,
        share=0.02,
        bodies=("hertz", "wedge"),
    ),
    Cycle("tension_threshold", ("lower", "upper"), _limits, _threshold, _shears),
    *(
        Cycle(
            f"slip_zones, order {order}",
            ("left", "right"),
            _zones(order),
            _series(order),
            _slips((0, 0.9)),
        )
        for order in (1, 2, 3)
    ),
)
