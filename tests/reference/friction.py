"""Shear traction with Coulomb friction, in load steps, and the steady cycle.

The slip of one step, times E*/2, is  s = u[q - q before] + (dsigma/4) x + constant,  where

    s = 0 where |q| < f p,    s <= 0 where q = f p,    s >= 0 where q = -f p,    int q dx = Q.

Points that come into contact carry no shear traction.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tests.reference.bounded import Bounded, NoSolution, Places
from tests.reference.kernel import Surface
from tests.reference.loads import State
from tests.reference.mesh import Floats
from tests.reference.normal import Contact

SETTLED, ROUNDING = 1e-11, 1e-9
"""Changes of q from one cycle to the next, relative to the largest f p, below which the cycle is
steady: SETTLED in any case, ROUNDING if the change no longer decreases."""


class Half(NamedTuple):
    """A half-cycle: shear traction at its end, slip, and total slip to and fro (way)."""

    q: Floats
    slip: Floats
    way: Floats


class Cycle(NamedTuple):
    """The steady cycle, its two half-cycles, and the number of cycles until it repeated itself."""

    there: Half
    back: Half
    rounds: int


@dataclass(frozen=True)
class Friction:
    """Two states, and the contacts at equal steps from the first to the second."""

    surface: Surface
    f: float
    first: State
    second: State
    contacts: Sequence[Contact]

    def cycle(self, most: int = 60) -> Cycle:
        """Repeat the cycle from the first state until q repeats itself at both ends."""
        q = self._from_nothing()
        there = back = Half(q, q, q)
        change = np.inf
        for rounds in range(1, most + 1):
            before = there.q, back.q
            there = self._half(back.q, forth=True)
            back = self._half(there.q, forth=False)
            last, change = change, self._change(before, (there.q, back.q))
            if change < SETTLED or last / 2 < change < ROUNDING:
                return Cycle(there, back, rounds)
        raise NoSolution(f"the shear traction is not steady after {most} cycles")

    def _change(self, before: Sequence[Floats], now: Sequence[Floats]) -> float:
        largest = self.f * max(contact.p.max() for contact in self.contacts)
        return float(np.abs(np.subtract(now, before)).max() / largest)

    def _from_nothing(self) -> Floats:
        """q after Q and sigma have risen to those of the first state, under its P and M."""
        Q, sigma = self.first.Q, self.first.sigma
        return self._step(np.zeros_like(self.surface.x), self.contacts[0], Q, sigma)[0]

    def _half(self, q: Floats, forth: bool) -> Half:
        """The steps from the first state to the second, or back."""
        ends = (self.first, self.second) if forth else (self.second, self.first)
        contacts = self.contacts[1:] if forth else self.contacts[-2::-1]
        count = len(contacts)
        dsigma = (ends[1].sigma - ends[0].sigma) / count
        slip, way, places = np.zeros_like(q), np.zeros_like(q), None
        for number, contact in enumerate(contacts, 1):
            Q = ends[0].towards(ends[1], number / count).Q
            q, s, places = self._step(q, contact, Q, dsigma, places)
            slip, way = slip + s, way + np.abs(s)
        return Half(q, slip, way)

    def _step(
        self, q: Floats, contact: Contact, Q: float, dsigma: float, places: Places | None = None
    ) -> tuple[Floats, Floats, Places]:
        """q, the slip of the nodes in contact, and the status of the nodes after one load step."""
        bound = self.f * contact.p
        if abs(Q) >= self.surface.force @ bound:
            raise NoSolution("the contact slides: |Q| reaches f P")
        b = dsigma / 4 * self.surface.x - self.surface.influence @ q
        found = self._problem.solve(b, -bound, bound, np.array([Q]), places)
        return found.traction, np.where(bound > 0, found.response, 0.0), found.places

    @cached_property
    def _problem(self) -> Bounded:
        rigid = np.ones((1, len(self.surface.x)))
        return Bounded(self.surface.influence, self.surface.force[None, :], rigid)
