"""Where the functions of a cycle are tried: contacts, changes of load, places and histories."""

from collections.abc import Callable, Iterator

import numpy as np
from sympy import lambdify

from generated._types import Contact, Regime, StickZone
from tests.accuracy.marches import LOADS, WAY, at
from tests.accuracy.regions import EXPONENTS, Regions, Sample

Placed = Iterator[tuple[str, Sample]]
"""Regions by name."""

Where = Callable[[Regions], Placed]

MODERATE, LARGE = (0.0, 0.9), (2.5, 4.0)
"""Tension in parts of that at which K_T vanishes."""

SHEAR, TINY = (-1.5, -0.3), (-EXPONENTS["slip"], -4.0)
"""Decades of f P."""

VARIED, TINY_ZONES, THRESHOLD = (
    "varying normal loads",
    "tiny slip zones",
    "tension near the threshold",
)


def law_of(sample: Sample, *others: str) -> Sample:
    """Friction, material and body, without arguments by position."""
    positional = {"a", "c", "a_2", "c_2", "dQ", "dsigma", "x", "Q", "sigma", *others}
    return {n: v for n, v in sample.items() if n not in positional}


def contacts_of(sample: Sample) -> tuple[Contact, Contact]:
    """Both ends of the half-cycle; the same where the normal loads stay."""
    tilt = np.zeros(len(sample["a"]))
    first = Contact(sample["a"], sample["c"], tilt)
    return first, Contact(sample["a_2"], sample["c_2"], tilt) if "a_2" in sample else first


def zone_of(regions: Regions, sample: Sample) -> StickZone:
    """What the program says of a cycle."""
    changes = sample["dQ"], sample.get("dsigma", 0.0)
    zone: StickZone = regions.module.stick_zone(*contacts_of(sample), *changes, **law_of(sample))
    return zone


def slipping(
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


def some(sample: Sample, chosen: np.ndarray) -> Sample:
    """Those that are chosen."""
    return {name: value[chosen] for name, value in sample.items()}


def moderate(regions: Regions) -> Placed:
    """Constant normal loads; tension close to its threshold, too."""
    yield from _constant(regions, MODERATE)
    bulk = _bulk(regions)
    almost = 1 - regions.decades(-6, -2, len(bulk["a"]))
    near = slipping(regions, bulk, (-0.5, -0.2), (1, 1))
    yield THRESHOLD, {**near, "dsigma": near["dsigma"] * almost}


def moderate_and_varied(regions: Regions) -> Placed:
    """Those, and two contacts that differ."""
    yield from moderate(regions)
    yield VARIED, varied(regions)


def large(regions: Regions) -> Placed:
    """Constant normal loads; what the program calls mixed is left out."""
    for name, sample in _constant(regions, LARGE):
        regime = zone_of(regions, sample).regime
        yield name, some(sample, (regime == Regime.LARGE) | (regime == Regime.UNSOLVED))


def without_tension(where: Where) -> Where:
    """The same, of shear alone."""

    def of(regions: Regions) -> Placed:
        for name, sample in where(regions):
            if name != THRESHOLD:
                yield name, {n: v for n, v in sample.items() if n != "dsigma"}

    return of


def _constant(regions: Regions, tension: tuple[float, float]) -> Placed:
    for name, given in regions.contacts(wide=False):
        if len(given["a"]):
            yield name, slipping(regions, given, SHEAR, tension)
    yield TINY_ZONES, slipping(regions, _bulk(regions), TINY, tension)


def _bulk(regions: Regions) -> Sample:
    return next(given for name, given in regions.contacts(wide=False) if name == "bulk")


def varied(regions: Regions) -> Sample:
    """Two contacts whose edges differ by less than slip reaches in; of moderate regime."""
    sample = dict(slipping(regions, _bulk(regions), (-1.0, -0.3), (0.0, 0.6)))
    count = len(sample["a"])
    width = sample["a"] + sample["c"]
    for edge in "ac":
        moved = regions.rng.choice([-1.0, 1.0], count) * regions.decades(-5, -1, count)
        sample[f"{edge}_2"] = sample[edge] + width * moved
    return some(sample, zone_of(regions, sample).regime == Regime.MODERATE)


def as_gained(where: Where) -> Where:
    """Varying loads as the series take them: by how much [-a, c] reaches further."""

    def of(regions: Regions) -> Placed:
        for name, sample in where(regions):
            if "a_2" not in sample:
                yield name, sample
                continue
            gained = {f"d{e}": sample[e] - sample[f"{e}_2"] for e in "ac"}
            yield name, {n: v for n, v in sample.items() if n not in ("a_2", "c_2")} | gained

    return of


# ------------------------------------------------------------------ places


def placed(where: Where, slips: bool = False) -> Where:
    """With places all over the contact; beside ends of the stick zone, edges and kinks.

    slips: in slip zones alone.
    """

    def of(regions: Regions) -> Placed:
        for name, sample in where(regions):
            zone = zone_of(regions, sample)
            known = np.isfinite(zone.m)
            ends = np.where(known, zone.m, 0), np.where(known, zone.n, 0)
            yield name, _at(regions, sample, _anywhere(regions, sample, *ends, slips))
            if name == "bulk":
                for where_x, x in _corners(regions, sample, *ends, slips):
                    yield f"bulk, x beside {where_x}", _at(regions, sample, x)

    return of


def _at(regions: Regions, sample: Sample, x: np.ndarray) -> Sample:
    inside = (x > -sample["a"]) & (x < sample["c"])
    for kink in kinks_of(regions, sample):
        inside &= x != kink
    return some({**sample, "x": x}, inside)


def _anywhere(
    regions: Regions, sample: Sample, m: np.ndarray, n: np.ndarray, slips: bool
) -> np.ndarray:
    """In the stick zone, or in a slip zone."""
    count = len(m)
    part = regions.rng.uniform(0.05, 0.95, count)
    stuck = -m + part * (m + n)
    left, right = -m - part * (sample["a"] - m), n + part * (sample["c"] - n)
    slipped = np.where(regions.rng.random(count) < 0.5, left, right)
    return slipped if slips else np.where(np.arange(count) % 2, slipped, stuck)


def _corners(
    regions: Regions, sample: Sample, m: np.ndarray, n: np.ndarray, slips: bool
) -> Iterator[tuple[str, np.ndarray]]:
    count = len(m)
    right = regions.rng.random(count) < 0.5
    side, end = np.where(right, 1, -1), np.where(right, n, m)
    edge = np.where(right, sample["c"], sample["a"])
    near = (edge - end) * regions.decades(-10, -1, count)
    both = np.ones(count) if slips else regions.rng.choice([-1.0, 1.0], count)
    yield "an end of the stick zone", side * (end + both * near)
    yield "an edge", side * (edge - (edge - end) * regions.decades(-12, -1, count))
    for number, kink in enumerate(kinks_of(regions, sample), 1):
        signs = regions.rng.choice([-1.0, 1.0], count)
        x = kink + signs * (sample["a"] + sample["c"]) * regions.decades(-15, -1, count)
        yield f"kink {number}", np.where((x > n) | (x < -m), x, np.nan) if slips else x


def kinks_of(regions: Regions, sample: Sample) -> list[np.ndarray]:
    """Places of the body's kinks, in float64."""
    places = []
    for kink in regions.sheet.geometry.slope.kinks:
        names = sorted(map(str, kink.position.free_symbols))
        found = lambdify(names, kink.position)(*(sample[name] for name in names))
        places.append(np.ones(len(sample["a"])) * found)
    return places


def risen_and_fallen(where: Where) -> Where:
    """A first rise of half of it, and a fall since, in proportion."""

    def of(regions: Regions) -> Placed:
        for name, sample in where(regions):
            if name == THRESHOLD:
                continue
            part = regions.rng.uniform(0.1, 0.9, len(sample["a"]))
            Q, sigma = sample["dQ"] / 2, sample["dsigma"] / 2
            fall = {"dQ": part * sample["dQ"], "dsigma": part * sample["dsigma"]}
            yield name, {**sample, "Q": Q, "sigma": sigma, **fall}

    return of


# ------------------------------------------------------------------ histories


def histories(regions: Regions) -> Placed:
    """Loads at every instant, in phase; normal loads that stay, and some that vary."""
    for name, sample in moderate_and_varied(regions):
        if name != THRESHOLD:
            yield name, _history(regions, sample)


def _history(regions: Regions, sample: Sample) -> Sample:
    law = {n: v for n, v in law_of(sample).items() if n != "f"}
    first, second = contacts_of(sample)
    normal = {
        "P": [regions.module.load(end.a, end.c, **law) for end in (first, second)],
        "M": [regions.module.moment(end.a, end.c, **law) for end in (first, second)],
    }
    offset = regions.rng.uniform(-1, 1, len(first.a))
    shear = {
        "Q": [offset * sample["dQ"], (offset + 1) * sample["dQ"]],
        "sigma": [offset * sample["dsigma"], (offset + 1) * sample["dsigma"]],
    }
    loads = normal | shear
    found = dict(law_of(sample))
    for name in LOADS:
        low, high = loads[name]
        for instant, part in enumerate(WAY):
            found[at(name, instant)] = low + part * (high - low)
    return found
