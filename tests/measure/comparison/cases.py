"""Cycles for the comparison: the result cases of the paper, and other bodies and loads.

E* = 1 and f = 1/2 throughout.  In the paper, tensions are relative to the tension at which a slip
zone closes.
"""

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import NamedTuple

import numpy as np

from generated.runtime.types import Contact
from notebooks.common import closing_tension
from tests.reference.loads import State
from tests.reference.mesh import Floats
from tests.reference.normal import Body
from tests.reference.solver import Case

F = 0.5


class Shape(NamedTuple):
    """A body: its profile and kinks for the solver, its parameters for the generated functions."""

    profile: Callable[[Floats], Floats]
    own: dict[str, float]
    kinks: tuple[float, ...] = ()


SHAPES = {
    "wedge": Shape(np.abs, {"phi": 1.0}, (0.0,)),
    "hertz": Shape(lambda x: x**2 / 2, {"R": 1.0}),
    "quartic": Shape(lambda x: x**4 / 4, {"L": 1.0}),
    "hyperbola": Shape(lambda x: np.sqrt(x**2 + 0.25), {"b": 0.5, "phi": 1.0}),
    "catenary": Shape(lambda x: np.cosh(x) - 1, {"R": 1.0, "b": 1.0}),
    "two_radii": Shape(
        lambda x: np.where(x < 0, x**2 / 1.5, x**2 / 3), {"R_1": 0.75, "R_2": 1.5}, (0.0,)
    ),
    "flat_rounded": Shape(
        lambda x: np.maximum(np.abs(x) - 0.5, 0.0) ** 2 / 2, {"R": 1.0, "b": 0.5}, (-0.5, 0.5)
    ),
}


@dataclass(frozen=True)
class Compared:
    """One cycle of one body.

    P, M     normal load and moment at both ends of the half-cycle
    dQ       change of the shear load relative to f times the mean normal load
    tension  change of tension relative to 8 dQ/(pi h), where h is the width at the mean loads
    closing  whether it is relative to the tension that closes the right slip zone instead
    """

    name: str
    body: str
    P: tuple[float, float]
    M: tuple[float, float]
    dQ: float
    tension: float
    closing: bool = False

    @property
    def module(self) -> ModuleType:
        """The generated functions of the body."""
        return importlib.import_module(f"generated.{self.body}")

    @property
    def law(self) -> dict[str, float]:
        """E* and the parameters of the body."""
        return {"E_star": 1.0, **SHAPES[self.body].own}

    @property
    def contacts(self) -> tuple[Contact, Contact]:
        """Contacts at both ends of the half-cycle."""
        first, second = (
            self.module.contact(P, M, **self.law) for P, M in zip(self.P, self.M, strict=True)
        )
        return first, second

    @property
    def changes(self) -> tuple[float, float]:
        """Changes dQ and dsigma over the half-cycle."""
        load = float(np.mean(self.P))
        shear = self.dQ * F * load
        mean = self.module.contact(load, float(np.mean(self.M)), **self.law)
        if self.closing:
            _, closing = closing_tension(self.module, mean, shear, f=F, **self.law)
            return shear, self.tension * closing
        return shear, self.tension * 8 * shear / (np.pi * float(mean.a + mean.c))

    @property
    def case(self) -> Case:
        """The cycle in the form that the solver takes."""
        shear, tension = self.changes
        first, second = (
            State(P, M, sign * shear / 2, sign * tension / 2)
            for P, M, sign in zip(self.P, self.M, (-1, 1), strict=True)
        )
        shape = SHAPES[self.body]
        return Case(Body(shape.profile, kinks=shape.kinks), F, first, second)


def _wedge(
    name: str, dQ: float, tension: float, P: float = 0.0, tilts: tuple[float, float] = (0.0, 0.0)
) -> Compared:
    """g = |x|; mean load 1, range of load P.  At a tilt alpha, M/P = (P/2) tan(pi alpha/2)."""
    loads = 1 - P / 2, 1 + P / 2
    first, second = (
        np.tan(np.pi * tilt / 2) / 2 * load**2 for tilt, load in zip(tilts, loads, strict=True)
    )
    return Compared(name, "wedge", loads, (first, second), dQ, tension, closing=True)


PAPER = (
    _wedge("5.1 constant loads", 1.0, 0.0),
    _wedge("5.2 varying normal load", 1.0, 0.0, P=0.15),
    _wedge("5.3 moderate tension", 0.3, 0.5),
    _wedge("5.3 large tension", 0.3, 2.0),
    _wedge("5.4 tilted", 0.3, 0.0, tilts=(0.3, 0.3)),
    _wedge("5.5 varying moment, large tension", 0.3, 2.0, tilts=(0.28, 0.32)),
)

OURS = tuple(
    Compared(*row)
    for row in (
        ("cylinder, P and M vary, large", "hertz", (0.75, 0.8), (-0.01, 0.01), 0.3, 3.0),
        ("flat with rounded edges, tilted, large", "flat_rounded", (1, 1), (0.1, 0.1), 0.4, -2.5),
        ("two radii, P varies, moderate", "two_radii", (0.95, 1.05), (0, 0), 0.5, 0.5),
        ("quartic, M varies, large", "quartic", (0.5, 0.5), (-0.005, 0.005), 0.3, 2.5),
        ("hyperbola, tilted, moderate", "hyperbola", (1, 1), (-0.1, -0.1), 0.5, -0.5),
        ("catenary, P varies, large", "catenary", (0.95, 1), (0, 0), 0.3, 3.0),
        ("wedge, slip reverses, 1.02", "wedge", (1, 1), (0, 0), 0.3, 1.02),
        ("wedge, slip reverses, 1.08", "wedge", (1, 1), (0, 0), 0.3, 1.08),
        ("wedge, slip reverses, 1.15", "wedge", (1, 1), (0, 0), 0.3, 1.15),
        ("cylinder, tilted, slip reverses", "hertz", (0.75, 0.75), (0.1, 0.1), 0.5, 1.1),
        ("two radii, slip reverses", "two_radii", (1, 1), (0, 0), 0.7, -1.1),
    )
)

EVERY = PAPER + OURS
