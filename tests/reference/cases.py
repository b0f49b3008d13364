"""Cycles whose stick zone is known from a closed form or from the two integral conditions.

Q and sigma vary from -dQ/2, -dsigma/2 to dQ/2, dsigma/2; P and M from their first to their second
value.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tests.reference.conditions import LARGE, MODERATE, HalfCycle, Patch, hertz, wedge
from tests.reference.loads import State
from tests.reference.mesh import Floats
from tests.reference.normal import Body
from tests.reference.solver import Case
from tests.reference.stick import Zone


def parabola(x: Floats) -> Floats:
    """The profile of a cylinder, R = 1."""
    return x**2 / 2


@dataclass(frozen=True)
class Shape:
    """One body twice: its profile for the solver, its pressure for the conditions."""

    body: Body
    patch: Callable[[float, float], Patch]


HERTZ = Shape(Body(parabola), hertz)
WEDGE = Shape(Body(np.abs, kinks=(0.0,)), wedge)

HERTZ_LOAD = np.pi / 4
"""Load P at which the half-width of a cylinder is 1, with R = E* = 1."""


@dataclass(frozen=True)
class Known:
    """A cycle, and the direction in which its right edge slips."""

    name: str
    shape: Shape
    kappa: int
    dQ: float
    dsigma: float
    P: tuple[float, float]
    M: tuple[float, float] = (0.0, 0.0)
    f: float = 0.5

    @property
    def states(self) -> tuple[State, State]:
        """First and second state."""
        return (
            State(self.P[0], self.M[0], -self.dQ / 2, -self.dsigma / 2),
            State(self.P[1], self.M[1], self.dQ / 2, self.dsigma / 2),
        )

    @property
    def case(self) -> Case:
        """The cycle for the solver."""
        return Case(self.shape.body, self.f, *self.states)

    @property
    def half_cycle(self) -> HalfCycle:
        """The half-cycle for the conditions."""
        return HalfCycle(self.shape.patch, self.f, *self.states)

    @property
    def exact(self) -> Zone:
        """The stick zone from the conditions."""
        return self.half_cycle.exact(self.kappa)


def _hertz(name: str, kappa: int, dQ: float, dsigma: float, *P: float, **given: object) -> Known:
    """A cylinder; P and dQ are relative to the load at which the half-width is 1."""
    first, second = (HERTZ_LOAD * part for part in P)
    return Known(name, HERTZ, kappa, dQ * HERTZ_LOAD, dsigma, (first, second), **given)  # type: ignore[arg-type]


CLOSED = (
    _hertz("Cattaneo-Mindlin", MODERATE, 0.3, 0.0, 1, 1),
    _hertz("Hertz, moderate", MODERATE, 0.3, 0.1, 1, 1),
    _hertz("Hertz, moderate, leaning the other way", MODERATE, 0.3, -0.1, 1, 1),
    _hertz("Hertz, large", LARGE, 0.15, 0.6, 1, 1),
    _hertz("Hertz, moderate, P and M vary", MODERATE, 0.25, 0.1, 0.9, 1.1, M=(-0.02, 0.02)),
    _hertz("Hertz, large, P and M vary", LARGE, 0.15, 0.6, 0.9, 1.1, M=(-0.01, 0.01)),
    _hertz("Hertz, large, M varies against P", LARGE, 0.15, 0.6, 0.9, 1.1, M=(0.01, -0.01)),
    Known("wedge, moderate", WEDGE, MODERATE, 0.25, 0.1, (1, 1)),
    Known("wedge, large", WEDGE, LARGE, 0.15, 1.0, (1, 1)),
    Known("tilted wedge, moderate", WEDGE, MODERATE, 0.25, 0.1, (1, 1), (0.1, 0.1)),
    Known("tilted wedge, large", WEDGE, LARGE, 0.15, 1.0, (1, 1), (0.1, 0.1)),
    Known("tilted wedge, moderate, P varies", WEDGE, MODERATE, 0.25, 0.1, (1, 1.1), (0.1, 0.1)),
    Known("tilted wedge, large, P varies", WEDGE, LARGE, 0.15, 1.0, (1, 1.1), (0.1, 0.1)),
    Known("tilted wedge, large, M varies", WEDGE, LARGE, 0.15, 1.0, (1, 1), (0.1, 0.12)),
)
