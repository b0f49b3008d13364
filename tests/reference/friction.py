"""Shear by Coulomb friction, load step by load step, and the cycle that it settles to.

The slip of one step, times E*/2, is  s = u[q - q before] + (dsigma/4) x + constant,  where

    s = 0 where |q| < f p,    s <= 0 where q = f p,    s >= 0 where q = -f p,    int q dx = Q.

What comes into contact brings no shear with it.
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
"""Changes of q from one cycle to the next, over the largest f p: one that is none, and one that is
none if it falls no more."""


class Half(NamedTuple):
    """A half-cycle: shear at its end, slip in it, and the way that was slipped to and fro."""

    q: Floats
    slip: Floats
    way: Floats


class Cycle(NamedTuple):
    """The steady cycle, there and back, and the number of the round that only repeats."""

    there: Half
    back: Half
    rounds: int


@dataclass(frozen=True)
class Friction:
    """Two states, and the contacts at even steps from the first to the second."""

    surface: Surface
    f: float
    first: State
    second: State
    contacts: Sequence[Contact]

    def cycle(self, most: int = 60) -> Cycle:
        """Rounds from the first state until q repeats itself at both ends."""
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
        raise NoSolution(f"not steady after {most} cycles")

    def _change(self, before: Sequence[Floats], now: Sequence[Floats]) -> float:
        largest = self.f * max(contact.p.max() for contact in self.contacts)
        return float(np.abs(np.subtract(now, before)).max() / largest)

    def _from_nothing(self) -> Floats:
        """q after Q and sigma rose to the first state's, under its P and M."""
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
        """q, the slip of what is in contact, and the places, one step on."""
        bound = self.f * contact.p
        if abs(Q) >= self.surface.force @ bound:
            raise NoSolution("the contact slides")
        b = dsigma / 4 * self.surface.x - self.surface.influence @ q
        found = self._problem.solve(b, -bound, bound, np.array([Q]), places)
        return found.traction, np.where(bound > 0, found.response, 0.0), found.places

    @cached_property
    def _problem(self) -> Bounded:
        rigid = np.ones((1, len(self.surface.x)))
        return Bounded(self.surface.influence, self.surface.force[None, :], rigid)
