"""Where accuracy is measured: random inputs of every function, region by region.

Regions know nothing of any body but what its sheet tells: its parameters and their units, whether
its tilt is bounded, where its kinks are, and which contacts exist.
"""

from collections.abc import Iterator, Mapping
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from sympy import And, Expr, Symbol, lambdify, oo

from derive.sheet import FormulaSheet

Sample = Mapping[str, Any]
"""float64 arrays of one length by argument name."""

EXPONENTS = {
    "loads": 12,
    "moments": 8,
    "edges": 15,
    "kinks": 300,
    "limit": 12,
    "slip": 12,
    "parameters": 6,
}
"""How far each corner is explored, in decades."""

EVEN, UNEVEN = (1.1, 4.0), (1.06, 60.0)
"""Exponents of a body, as they are drawn evenly, and over decades."""

WIDEST = {"catenary": 1.0, "circular_arc": -0.1}
"""Decades of the widest contact, where a body ends or its load leaves float64."""


WIDE = 4.0
"""Decades of the body's size across which a contact reaches whose edge lies beside a kink."""

UNEVEN_REGION = "uneven parameters"


class Regions:
    """Samples of one body."""

    def __init__(self, sheet: FormulaSheet, module: Any, count: int, seed: int = 1) -> None:
        self.sheet, self.module, self.count = sheet, module, count
        self.rng = np.random.default_rng(seed)

    def of(self, function: str) -> Iterator[tuple[str, Sample]]:
        """Every region of one function."""
        match function:
            case "contact":
                yield from self.loaded()
            case "contact_at_tilt":
                yield from self.at_tilt()
            case "pressure":
                for name, given in self.contacts():
                    yield from self.inside(name, given)
            case "K_T" | "L_T" | "stick_margin":
                for name, given in self.contacts():
                    yield name, self.sheared(given)
            case _:
                yield from self.contacts()

    # ------------------------------------------------------------------ ingredients

    def decades(self, low: float, high: float, count: int | None = None) -> Any:
        """Numbers spread evenly over the decades from 10**low to 10**high."""
        return 10.0 ** self.rng.uniform(low, high, self.count if count is None else count)

    @property
    def signs(self) -> Any:
        """-1 and 1 at random."""
        return self.rng.choice([-1.0, 1.0], self.count)

    def material(self, uneven: bool = False) -> dict[str, Any]:
        """E_star and the body's parameters; the lengths of one body within two decades, or six."""
        given, scale = {"E_star": self.decades(0, 3)}, self.decades(-3, 0)
        apart = EXPONENTS["parameters"] / 2 if uneven else 1
        for q in self.sheet.geometry.parameters:
            match q.unit:
                case "m":
                    given[q.name] = scale * self.decades(-apart, apart)
                case "rad":
                    given[q.name] = self.decades(-2 * apart, 0) if uneven else self.decades(-3, 0)
                case _ if uneven:
                    given[q.name] = self.decades(np.log10(UNEVEN[0]), np.log10(UNEVEN[1]))
                case _:
                    given[q.name] = self.rng.uniform(*EVEN, self.count)
        return given

    @property
    def may_be_uneven(self) -> bool:
        """Whether parameters can differ from each other, or one is an exponent."""
        parameters = self.sheet.geometry.parameters
        return len(parameters) > 1 or any(q.unit not in ("m", "rad") for q in parameters)

    @property
    def _lengths(self) -> list[str]:
        return [q.name for q in self.sheet.geometry.parameters if q.unit == "m"]

    def size(self, given: Sample) -> Any:
        """A length of the body's order."""
        lengths = self._lengths
        return given["b" if "b" in lengths else lengths[0]] if lengths else np.ones(self.count)

    def _any_size(self, given: Sample) -> Any:
        """One of the body's lengths; that beyond which it has no end if it has one."""
        lengths = self._lengths
        if not lengths or self.sheet.geometry.name in WIDEST:
            return self.size(given)
        chosen = self.rng.integers(len(lengths), size=self.count)
        return np.choose(chosen, [given[name] for name in lengths])

    @cached_property
    def exists(self) -> Any:
        """Whether contacts exist."""
        conditions = self.sheet["load"].conditions
        names = sorted({str(s) for condition in conditions for s in condition.free_symbols})
        test = lambdify(names, And(*conditions), modules="numpy")
        return lambda given: np.broadcast_to(test(*(given[n] for n in names)), self.count)

    # ------------------------------------------------------------------ contacts

    def contacts(self, wide: bool = True) -> Iterator[tuple[str, Sample]]:
        """Contacts in the bulk, of extreme widths, lopsided, level, and with edges at kinks.

        wide: also such with edges at kinks that are up to WIDE decades wider than the body's size.
        """
        widest = min(WIDEST.get(self.sheet.geometry.name, 12.0), EXPONENTS["loads"])
        yield "bulk", self._of_width((-0.5, min(widest, 1.0)), (-0.45, 0.45))
        yield "extreme widths", self._of_width((-EXPONENTS["loads"], widest), (-0.45, 0.45))
        lean = 0.5 - self.decades(-EXPONENTS["moments"], -0.5)
        yield "lopsided", self._of_width((-2, min(widest, 2.0)), self.signs * lean)
        other = Regions(self.sheet, self.module, self.count, seed=2)  # draws of its own
        widths = (-EXPONENTS["loads"], widest)
        yield "extreme widths, lopsided", other._of_width(widths, other.signs * lean)
        if self.may_be_uneven:
            apart = Regions(self.sheet, self.module, self.count, seed=3)
            yield UNEVEN_REGION, apart._of_width((-0.5, min(widest, 1.0)), (-0.45, 0.45), True)
        level = self.decades(-EXPONENTS["edges"], -1)
        yield "nearly level", self._of_width((-1, min(widest, 1.0)), self.signs * level)
        for kink in self.sheet.geometry.slope.kinks:
            if not kink.position.is_zero or self._may_leave(kink.position):
                yield f"edge beside kink {kink.number}", self._edge_at(kink.position)
                if wide:
                    other = Regions(self.sheet, self.module, self.count, seed=5)
                    where = f"edge beside kink {kink.number}, wide contact"
                    yield where, other._edge_at(kink.position, (1.0, WIDE))

    def _may_leave(self, place: Expr) -> bool:
        """Whether contacts exist that do not hold a kink."""
        return any(k.clipped for k in self.sheet.frame.kinks if k.kink.position == place)

    def _of_width(self, widths: tuple[float, float], middle: Any, uneven: bool = False) -> Sample:
        """Widths so many decades of the body's size; middles in parts of the width."""
        given = self.material(uneven)
        width = (self._any_size(given) if uneven else self.size(given)) * self.decades(*widths)
        if isinstance(middle, tuple):
            middle = self.rng.uniform(*middle, self.count)
        given |= {"a": width * (0.5 - middle), "c": width * (0.5 + middle)}
        return self._existing(given)

    def _edge_at(self, place: Expr, widths: tuple[float, float] = (-0.5, 1.0)) -> Sample:
        """One edge just beyond a kink, or just short of it; the other so many decades away."""
        given = self.material()
        kink, size = self._values(place, given), self.size(given)
        near = kink + self.signs * size * self.decades(-EXPONENTS["edges"], -1)
        far = size * self.decades(*widths)
        right = self.rng.choice([True, False], self.count)
        given |= {"a": np.where(right, far - near, -near), "c": np.where(right, near, near + far)}
        return self._existing(given)

    def _existing(self, given: dict[str, Any]) -> Sample:
        return self._some(given, self.exists(given) & (given["a"] + given["c"] > 0))

    def _some(self, given: Sample, chosen: Any) -> Sample:
        return {name: value[chosen] for name, value in given.items()}

    # ------------------------------------------------------------------ loads

    def loads(
        self, decades: float, moments: tuple[float, float] | None, uneven: bool = False
    ) -> dict[str, Any]:
        """P over so many decades, M from so many decades of P times the half-width."""
        given = {"P": self.decades(-decades, decades), **self.material(uneven)}
        if moments is None:
            return given | {"M": np.zeros(self.count)}
        half = self.module.contact(**given).a
        return given | {"M": self.signs * self.decades(*moments) * given["P"] * half}

    def loaded(self) -> Iterator[tuple[str, Sample]]:
        """Loads and moments; of bodies that are solved, those of contacts."""
        if "contact_a" in self.sheet:
            yield "bulk", self.loads(0, (-2, 0))
            yield "extreme loads", self.loads(EXPONENTS["loads"], (-8, 0))
            yield "large moments", self.loads(3, (0, EXPONENTS["moments"]))
            yield "no moment", self.loads(EXPONENTS["loads"], None)
            if self.may_be_uneven:
                apart = Regions(self.sheet, self.module, self.count, seed=3)
                yield UNEVEN_REGION, apart.loads(0, (-2, 0), uneven=True)
            return
        for name, given in self.contacts():
            law = {n: v for n, v in given.items() if n not in "ac"}
            P, M = (of(given["a"], given["c"], **law) for of in self._laws)
            yield name, law | {"P": P, "M": M}

    @property
    def _laws(self) -> tuple[Any, Any]:
        return self.module.load, self.module.moment

    def sheared(self, given: Sample) -> Sample:
        """Contacts with changes of shear and tension of comparable effect."""
        count = len(given["a"])
        signs = self.rng.choice([-1.0, 1.0], (3, count))
        shear, width = self.decades(-6, 6, count), given["a"] + given["c"]
        return {
            **given,
            "dQ": shear,
            "dsigma": signs[0] * shear / width * self.decades(-3, 3, count),
            "dP": signs[1] * shear * self.decades(-3, 3, count),
            "dM": signs[2] * shear * width * self.decades(-3, 3, count),
            "f": self.decades(-1, 0, count),
        }

    # ------------------------------------------------------------------ corners

    def at_tilt(self) -> Iterator[tuple[str, Sample]]:
        """Tilts of common contacts, and those close to the largest that the body can take."""
        for name, given in self.contacts():
            law = {n: v for n, v in given.items() if n not in "ac"}
            own = {n: v for n, v in law.items() if n != "E_star"}
            load = self.module.load(given["a"], given["c"], **law)
            yield name, law | {"P": load, "alpha": self.module.tilt(given["a"], given["c"], **own)}
        low, high = self.sheet.geometry.slope.limits
        for side, limit in (("left", -high), ("right", -low)):
            if limit not in (oo, -oo) and "contact_at_tilt_a" in self.sheet:
                given = {k: v for k, v in self.loads(3, None).items() if k != "M"}
                short = -np.expm1(-self.decades(-EXPONENTS["limit"], 0))
                bound = self._values(limit, given)
                yield f"tilt near its {side} limit", given | {"alpha": bound * (1 - short)}

    def inside(self, name: str, given: Sample) -> Iterator[tuple[str, Sample]]:
        """Places in the bulk, next to both edges, next to every kink, and beside every part.

        Next to the origin, too, of smooth bodies that are integrated.
        """
        a, c = given["a"], given["c"]
        count = len(a)
        theta = self.rng.uniform(0.1, np.pi - 0.1, count)
        yield name, self._placed(given, (c - a) / 2 + (a + c) / 2 * np.cos(theta))
        near = (a + c) * self.decades(-EXPONENTS["edges"], -1, count)
        yield f"{name}, x at the left edge", self._placed(given, near - a)
        yield f"{name}, x at the right edge", self._placed(given, c - near)
        for kink in self.sheet.geometry.slope.kinks:
            at = self._values(kink.position, given)
            signs = self.rng.choice([-1.0, 1.0], count)
            close = signs * self.decades(-EXPONENTS["kinks"], 0, count) * np.minimum(c - at, a + at)
            yield f"{name}, x at kink {kink.number}", self._placed(given, at + close)
        if not self.sheet.geometry.slope.is_polynomial and not self.sheet.geometry.slope.kinks:
            other = Regions(self.sheet, self.module, self.count, seed=4)
            close = other.rng.choice([-1.0, 1.0], count) * np.minimum(a, c)
            close = close * other.decades(-EXPONENTS["edges"], -1, count)
            yield f"{name}, x at the origin", self._placed(given, close)
        yield from self._beside_parts(name, given)

    def _beside_parts(self, name: str, given: Sample) -> Iterator[tuple[str, Sample]]:
        """x outside a part between two kinks or edges, a tenth to ten of its lengths away."""
        kinks = [self._values(k.position, given) for k in self.sheet.geometry.slope.kinks]
        low, high = -np.asarray(given["a"]), np.asarray(given["c"])
        ends = [low, *(np.clip(k, low, high) for k in kinks), high]
        for number, (start, end) in enumerate(pairwise(ends)) if kinks else ():
            far = (end - start) * self.decades(-1, 1, len(low))
            x = np.where(self.rng.random(len(low)) < 0.5, start - far, end + far)
            yield f"{name}, x beside part {number}", self._placed(given, x)

    def _values(self, expr: Expr, given: Sample) -> Any:
        """A place or a slope of the body, in float64."""
        names = sorted(map(str, expr.free_symbols))
        values = lambdify(names, expr)(*(given[name] for name in names))
        return np.ones(len(next(iter(given.values())))) * values

    def _placed(self, given: Sample, x: Any) -> Sample:
        corners = [k.position for k in self.sheet.geometry.slope.kinks if k.is_corner]
        chosen = (x > -given["a"]) & (x < given["c"])
        for place in corners:  # where the pressure is infinite
            chosen &= x != self._values(place, given)
        return self._some(dict(given) | {"x": x}, chosen)


def names_of(function_symbols: tuple[Symbol, ...]) -> list[str]:
    """Argument names of a function."""
    return [str(s) for s in function_symbols]
