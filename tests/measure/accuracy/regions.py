"""Where accuracy is measured: random inputs, region by region.

Regions know nothing of a body but what its sheet tells: its parameters and their units, where its
kinks are, and which contacts exist.
"""

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Any

import numpy as np
from sympy import And, Expr, lambdify

from derive.sheet.formulas import FormulaSheet
from generated.runtime.types import Contact, Regime

Sample = Mapping[str, Any]
"""float64 arrays of one length by argument name."""

Placed = Iterator[tuple[str, Sample]]
"""Samples by region."""

BULK, KINKS, EXTREME = "bulk", "near kinks and edges", "extreme"
REGIONS = (BULK, KINKS, EXTREME)

NEAREST = -9.0
"""Decades of the width by which an edge, or a place, lies beside a kink at least."""

WIDEST = {"catenary": 0.5, "circular_arc": -0.1}
"""Decades of the widest contact, where a body ends or its load leaves float64."""


class Regions:
    """Samples of one body."""

    def __init__(self, sheet: FormulaSheet, module: Any, count: int, seed: int = 1) -> None:
        self.sheet, self.module, self.count = sheet, module, count
        self.rng = np.random.default_rng(seed)
        self.parameters = [q.name for q in sheet.geometry.parameters]

    # ------------------------------------------------------------------ ingredients

    def decades(self, low: float, high: float) -> Any:
        """Numbers spread evenly over the decades from 10**low to 10**high."""
        return 10.0 ** self.rng.uniform(low, high, self.count)

    @property
    def signs(self) -> Any:
        """-1 and 1 at random."""
        return self.rng.choice([-1.0, 1.0], self.count)

    def material(self, apart: float = 1.0) -> dict[str, Any]:
        """E_star and the body's parameters; its lengths within so many decades, either way."""
        given, scale = {"E_star": self.decades(0, 3)}, self.decades(-3, 0)
        for q in self.sheet.geometry.parameters:
            match q.unit:
                case "m":
                    given[q.name] = scale * self.decades(-apart, apart)
                case "rad":
                    given[q.name] = self.decades(-3, 0)
                case _:
                    given[q.name] = self.rng.uniform(1.1, 4.0, self.count)
        return given

    def size(self, given: Sample) -> Any:
        """A length of the body's order."""
        lengths = [q.name for q in self.sheet.geometry.parameters if q.unit == "m"]
        return given["b" if "b" in lengths else lengths[0]] if lengths else np.ones(self.count)

    @cached_property
    def exists(self) -> Any:
        """Whether contacts exist."""
        conditions = self.sheet["load"].conditions
        names = sorted({str(s) for condition in conditions for s in condition.free_symbols})
        test = lambdify(names, And(*conditions), modules="numpy")
        return lambda given: np.broadcast_to(test(*(given[n] for n in names)), len(given["a"]))

    def place(self, position: Expr, given: Sample) -> Any:
        """Where a kink is, in float64."""
        names = sorted(map(str, position.free_symbols))
        return np.ones(len(given["E_star"])) * lambdify(names, position)(*(given[n] for n in names))

    def _chosen(self, given: Sample, chosen: Any) -> Sample:
        return {name: value[chosen] for name, value in given.items()}

    # ------------------------------------------------------------------ contacts

    def contacts(self) -> Placed:
        """Contacts in the bulk, with an edge beside a kink, and extreme ones.

        Extreme: widths over 24 decades (six, where the pressure is integrated), one edge close to
        the origin, lengths of the body six decades apart.
        """
        widest = WIDEST.get(self.sheet.geometry.name, 12.0)
        yield BULK, self._of_width(self.material(), (-0.5, min(widest, 1.0)), (-0.45, 0.45))
        for kink in self.sheet.geometry.slope.kinks:
            if not kink.position.is_zero or self._may_leave(kink.position):
                yield KINKS, self._edge_at(kink.position)
        far = 12.0 if self.sheet.geometry.slope.is_polynomial else 3.0
        lopsided = self.signs * (0.5 - self.decades(-8, -0.5))
        middle = np.where(self.rng.random(self.count) < 0.5, lopsided, 0.0)
        yield EXTREME, self._of_width(self.material(3.0), (-far, min(widest, far)), middle)

    def _may_leave(self, place: Expr) -> bool:
        """Whether contacts exist that do not hold a kink."""
        return any(k.clipped for k in self.sheet.frame.kinks if k.kink.position == place)

    def _of_width(self, given: dict[str, Any], widths: tuple[float, float], middle: Any) -> Sample:
        """Widths so many decades of the body's size; middles in parts of the width."""
        width = self.size(given) * self.decades(*widths)
        if isinstance(middle, tuple):
            middle = self.rng.uniform(*middle, self.count)
        given |= {"a": width * (0.5 - middle), "c": width * (0.5 + middle)}
        return self._existing(given)

    def _edge_at(self, position: Expr) -> Sample:
        """One edge just beyond a kink, or just short of it."""
        given = self.material()
        width = self.size(given) * self.decades(-0.5, 1.0)
        near = self.place(position, given) + self.signs * width * self.decades(NEAREST, -1)
        right = self.signs > 0
        given |= {
            "a": np.where(right, width - near, -near),
            "c": np.where(right, near, near + width),
        }
        return self._existing(given)

    def _existing(self, given: dict[str, Any]) -> Sample:
        return self._chosen(given, self.exists(given) & (given["a"] + given["c"] > 0))

    def places(self) -> Placed:
        """Places in the bulk of every contact; beside an edge or a kink of those in the bulk."""
        for region, given in self.contacts():
            a, c = given["a"], given["c"]
            theta = self.rng.uniform(0.2, np.pi - 0.2, len(a))
            yield region, {**given, "x": (c - a) / 2 + (a + c) / 2 * np.cos(theta)}
            if region == BULK:
                near = (a + c) * 10 ** self.rng.uniform(NEAREST, -1, len(a))
                yield (
                    KINKS,
                    {**given, "x": np.where(self.rng.random(len(a)) < 0.5, near - a, c - near)},
                )
                for kink in self.sheet.geometry.slope.kinks:
                    sense = self.rng.choice([-1.0, 1.0], len(a))
                    x = self.place(kink.position, given) + sense * near
                    yield KINKS, self._chosen({**given, "x": x}, (x > -a) & (x < c))

    # ------------------------------------------------------------------ loads

    def loaded(self, *formulas: str) -> Placed:
        """Loads, moments or tilts of contacts, by the name of the argument."""
        names = {"P": "load", "M": "moment", "alpha": "tilt"}
        for region, given in self.contacts():
            law = {n: v for n, v in given.items() if n not in "ac"}
            own = {n: v for n, v in law.items() if n != "E_star"}
            found = {}
            for name in formulas:
                of = getattr(self.module, names[name])
                found[name] = of(given["a"], given["c"], **(own if name == "alpha" else law))
            yield region, law | found

    def sheared(self) -> Placed:
        """Contacts with changes of shear, tension and normal loads of comparable effect."""
        for region, given in self.contacts():
            count = len(given["a"])
            width = given["a"] + given["c"]
            some = self.rng.uniform(-1, 1, (3, count))
            shear = 10 ** self.rng.uniform(-3, 3, count)
            changes = {"dQ": shear, "dsigma": some[0] * 4 * shear / width}
            changes |= {"dP": some[1] * 4 * shear, "dM": some[2] * shear * width}
            yield region, {**given, **changes, "f": self.rng.uniform(0.1, 1, count)}

    # ------------------------------------------------------------------ cycles

    def cycles(self, regime: Regime, varied: bool = False) -> Placed:
        """Half-cycles of a regime; moderate ones with a patch's edge beside a kink, too."""
        large = regime == Regime.LARGE
        for region, given in self.contacts():
            if large and region == EXTREME:
                continue
            found = self._slipping(given, (2.5, 4.0) if large else (0.0, 0.6 if varied else 0.9))
            yield region, self._of_regime(self._second(found) if varied else found, regime)
        if regime == Regime.MODERATE and not varied:
            for region, given in self.contacts():
                if region == KINKS:
                    yield KINKS, self._of_regime(self._patched(given), regime)

    def _slipping(self, given: Sample, tension: tuple[float, float]) -> Sample:
        """dQ in parts of 2 f P; tension in parts of that at which K_T vanishes."""
        count = len(given["a"])
        law = {n: v for n, v in given.items() if n not in "ac"}
        friction = self.rng.uniform(0.1, 1, count)
        dQ = self.rng.uniform(0.05, 0.5, count) * 2 * friction
        dQ = dQ * self.module.load(given["a"], given["c"], **law)
        over = self.rng.choice([-1.0, 1.0], count) * self.rng.uniform(*tension, count)
        dsigma = over * 8 * dQ / (np.pi * (given["a"] + given["c"]))
        return {**given, "f": friction, "dQ": dQ, "dsigma": dsigma}

    def _second(self, sample: Sample) -> Sample:
        """A second contact, whose edges differ by less than slip reaches in."""
        moved = {}
        for edge in "ac":
            off = self.rng.uniform(-0.02, 0.02, len(sample["a"]))
            moved[f"{edge}_2"] = sample[edge] + off * (sample["a"] + sample["c"])
        return {**sample, **moved}

    def _patched(self, patch: Sample) -> Sample:
        """Contacts around a patch whose edge lies beside a kink."""
        width = patch["a"] + patch["c"]
        out = self.rng.uniform(0.02, 0.2, (2, len(width))) * width
        law = {n: v for n, v in patch.items() if n not in "ac"}
        own = {n: v for n, v in law.items() if n != "E_star"}
        given = {**patch, "a": patch["a"] + out[0], "c": patch["c"] + out[1]}
        pairs = [(v["a"], v["c"]) for v in (given, patch)]
        whole, stuck = (self.module.load(*edges, **law) for edges in pairs)
        level, leant = (self.module.tilt(*edges, **own) for edges in pairs)
        friction = self.rng.uniform(0.1, 1, len(width))
        dsigma = 4 * friction * law["E_star"] * (level - leant)
        return {**given, "f": friction, "dQ": 2 * friction * (whole - stuck), "dsigma": dsigma}

    def zone_of(self, sample: Sample) -> Any:
        """The stick zone of a cycle, as it is generated."""
        first, second = contacts_of(sample)
        loads = sample["dQ"], sample["dsigma"]
        return self.module.stick_zone(first, second, *loads, **self.law_of(sample))

    def law_of(self, sample: Sample, friction: bool = True) -> dict[str, Any]:
        """Friction, material and body."""
        names = ["E_star", *self.parameters, *(["f"] if friction else [])]
        return {n: sample[n] for n in names}

    def _of_regime(self, sample: Sample, regime: Regime) -> Sample:
        """Those of a regime, and those that are not solved."""
        sample = self._chosen(sample, np.isfinite(sample["dQ"]))
        if not sample["dQ"].size:
            return sample
        found = self.zone_of(sample).regime
        return self._chosen(sample, (found == regime) | (found == Regime.UNSOLVED))

    def placed(self, regime: Regime, slips: bool = False) -> Placed:
        """Cycles with places in the stick zone and in slip zones, or in these alone."""
        for region, sample in self.cycles(regime):
            if not sample["dQ"].size:
                continue
            zone = self.zone_of(sample)
            sample = self._chosen(sample, np.isfinite(zone.m))
            m, n = (v[np.isfinite(zone.m)] for v in zone[:2])
            part = self.rng.uniform(0.1, 0.9, len(m))
            right = self.rng.random(len(m)) < 0.5
            slipped = np.where(right, n + part * (sample["c"] - n), -m - part * (sample["a"] - m))
            stuck = -m + part * (m + n)
            x = slipped if slips else np.where(np.arange(len(m)) % 2, slipped, stuck)
            yield region, {**sample, "x": x}

    def risen_and_fallen(self) -> Placed:
        """A first rise to half of the change, and a fall since, in proportion."""
        for region, sample in self.placed(Regime.MODERATE):
            part = self.rng.uniform(0.1, 0.9, len(sample["a"]))
            rise = {"Q": sample["dQ"] / 2, "sigma": sample["dsigma"] / 2}
            fall = {"dQ": part * sample["dQ"], "dsigma": part * sample["dsigma"]}
            yield region, {**sample, **rise, **fall}


def contacts_of(sample: Sample) -> tuple[Contact, Contact]:
    """Both ends of the half-cycle; the same where the normal loads stay."""
    tilt = np.zeros(len(sample["a"]))
    first = Contact(sample["a"], sample["c"], tilt)
    return first, Contact(sample["a_2"], sample["c_2"], tilt) if "a_2" in sample else first
