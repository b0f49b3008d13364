"""Where accuracy is measured: random inputs of every function, region by region.

Regions know nothing of any body but what its sheet tells: whether its tilt is bounded, and where
its kinks are.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from sympy import Expr, lambdify, oo

from derive.sheet import FormulaSheet

BODIES = ("hertz", "wedge")
"""Closed both ways; what is solved or integrated is held to 1e-13 in tests/generated."""

Sample = Mapping[str, Any]
"""float64 arrays of one length by argument name."""

EXPONENTS = {"loads": 12, "moments": 8, "edges": 15, "kinks": 300, "limit": 12}
"""How far each corner is explored, in decades."""


class Regions:
    """Samples of one body."""

    def __init__(self, sheet: FormulaSheet, module: Any, count: int, seed: int = 1) -> None:
        self.sheet, self.module, self.count = sheet, module, count
        self.rng = np.random.default_rng(seed)

    def of(self, function: str) -> Iterator[tuple[str, Sample]]:
        """Every region of one function."""
        match function:
            case "contact":
                yield "bulk", self.loads(0, (-2, 0))
                yield "extreme loads", self.loads(EXPONENTS["loads"], (-8, 0))
                yield "large moments", self.loads(3, (0, EXPONENTS["moments"]))
                yield "no moment", self.loads(EXPONENTS["loads"], None)
            case "contact_at_tilt":
                yield from self.at_tilt()
            case "pressure":
                yield from self.inside()
            case "K_T" | "L_T" | "stick_margin":
                yield "bulk", self.sheared(self.contacts(0, (-2, 0)))
                yield "extreme loads", self.sheared(self.contacts(EXPONENTS["loads"], (-8, 8)))
            case _:
                yield "bulk", self.contacts(0, (-2, 0))
                yield "extreme loads", self.contacts(EXPONENTS["loads"], (-8, 0))
                yield "large moments", self.contacts(3, (0, EXPONENTS["moments"]))

    # ------------------------------------------------------------------ ingredients

    def decades(self, low: float, high: float) -> Any:
        """Numbers spread evenly over the decades from 10**low to 10**high."""
        return 10.0 ** self.rng.uniform(low, high, self.count)

    @property
    def signs(self) -> Any:
        """-1 and 1 at random."""
        return self.rng.choice([-1.0, 1.0], self.count)

    def material(self) -> dict[str, Any]:
        """E_star and the body's parameters."""
        own = {q.name: self.decades(-3, 0) for q in self.sheet.geometry.parameters}
        return {"E_star": self.decades(0, 3), **own}

    def loads(self, decades: float, moments: tuple[float, float] | None) -> dict[str, Any]:
        """P over so many decades, M from so many decades of P times the half-width."""
        given = {"P": self.decades(-decades, decades), **self.material()}
        if moments is None:
            return given | {"M": np.zeros(self.count)}
        half = self.module.contact(**given).a
        return given | {"M": self.signs * self.decades(*moments) * given["P"] * half}

    def contacts(self, decades: float, moments: tuple[float, float]) -> dict[str, Any]:
        """Contacts [-a, c] under such loads."""
        given = self.loads(decades, moments)
        state = self.module.contact(**given)
        return {k: v for k, v in given.items() if k not in "PM"} | {"a": state.a, "c": state.c}

    def sheared(self, given: dict[str, Any]) -> dict[str, Any]:
        """Contacts with changes of shear and tension of comparable effect."""
        shear = self.decades(-6, 6)
        tension = self.signs * shear / (given["a"] + given["c"]) * self.decades(-3, 3)
        turn = self.signs * shear * (given["a"] + given["c"]) * self.decades(-3, 3)
        more = self.signs * shear * self.decades(-3, 3)
        friction = self.decades(-1, 0)
        return given | {"dQ": shear, "dsigma": tension, "dP": more, "dM": turn, "f": friction}

    # ------------------------------------------------------------------ corners

    def at_tilt(self) -> Iterator[tuple[str, Sample]]:
        """Tilts of common contacts, and those close to the largest that the body can take."""
        for name, decades, moments in (("bulk", 0, (-2, 0)), ("extreme loads", 12, (-8, 0))):
            given = self.loads(decades, moments)
            yield name, self._tilted(given, self.module.contact(**given).alpha)
        low, high = self.sheet.geometry.slope.limits
        for side, limit in (("left", -high), ("right", -low)):
            if limit not in (oo, -oo):
                given = self.loads(3, None)
                short = -np.expm1(-self.decades(-EXPONENTS["limit"], 0))
                bound = self._values(limit, given)
                yield f"tilt near its {side} limit", self._tilted(given, bound * (1 - short))

    def _tilted(self, given: dict[str, Any], alpha: Any) -> dict[str, Any]:
        return {k: v for k, v in given.items() if k != "M"} | {"alpha": alpha}

    def inside(self) -> Iterator[tuple[str, Sample]]:
        """Places in the bulk, next to both edges and next to every kink."""
        for name, decades, moments in (
            ("", 0, (-2, 0)),
            (", extreme loads", EXPONENTS["loads"], (-8, 0)),
            (", large moments", 3, (0, EXPONENTS["moments"])),
        ):
            given = self.contacts(decades, moments)
            a, c = given["a"], given["c"]
            theta = self.rng.uniform(0.1, np.pi - 0.1, self.count)
            yield f"bulk{name}", self._placed(given, (c - a) / 2 + (a + c) / 2 * np.cos(theta))
            near = (a + c) * self.decades(-EXPONENTS["edges"], -1)
            yield f"left edge{name}", self._placed(given, near - a)
            yield f"right edge{name}", self._placed(given, c - near)
            for kink in self.sheet.geometry.slope.kinks:
                at = self._values(kink.position, given)
                close = self.signs * self.decades(-EXPONENTS["kinks"], 0) * np.minimum(a, c)
                yield f"kink {kink.number}{name}", self._placed(given, at + close)

    def _values(self, expr: Expr, given: Sample) -> Any:
        """A place or a slope of the body, in float64."""
        names = sorted(map(str, expr.free_symbols))
        return np.ones(self.count) * lambdify(names, expr)(*(given[name] for name in names))

    def _placed(self, given: dict[str, Any], x: Any) -> dict[str, Any]:
        inside = (x > -given["a"]) & (x < given["c"])
        return {k: v[inside] for k, v in given.items()} | {"x": x[inside]}
