"""Tractions between bounds, and what moves against them.

Find t and the rigid motion mu with  s = L t + b + N^T mu,  R t = r,  lower <= t <= upper,  and

    s = 0 between the bounds,    s >= 0 at the lower one,    s <= 0 at the upper one.

Pressure: bounds 0 and infinity, s the gap.  Shear: bounds -f p and f p, s the slip of the step.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.reference.mesh import Floats

Flags = NDArray[np.bool_]
Places = NDArray[np.int8]
"""-1 at the lower bound, 1 at the upper one, 0 between."""

ROUNDING = 1e-12
"""What counts as none of t and of s, over the largest of each."""

ROUNDS = 60
"""Rounds in which every node may change its place; after them one node a round.  So it is too where
hardly any node would be left between its bounds."""


class NoSolution(ArithmeticError):
    """No tractions between the bounds carry these loads."""


class Solution(NamedTuple):
    """t, s, mu, and where each node is."""

    traction: Floats
    response: Floats
    rigid: Floats
    places: Places


@dataclass(frozen=True)
class Bounded:
    """The linear part: L, the rows R of the resultants, the rows N of the rigid modes."""

    influence: Floats
    resultants: Floats
    modes: Floats

    def solve(
        self, b: Floats, lower: Floats, upper: Floats, loads: Floats, places: Places | None = None
    ) -> Solution:
        """Newton's method on the places, from those given or from all between the bounds."""
        places = np.zeros(len(b), dtype=np.int8) if places is None else places
        places = np.where(lower == upper, np.int8(1), places)
        for turn in range(ROUNDS + 20 * len(b)):
            found = self._placed(b, lower, upper, loads, places)
            wrong = _misplaced(found, lower, upper)
            if not wrong.any():
                return found
            better = np.where(wrong, _corrected(found, upper), places)
            if turn >= ROUNDS or np.count_nonzero(better == 0) <= len(loads):
                better = np.where(np.arange(len(b)) == np.argmax(wrong), better, places)
            places = better
        raise NoSolution("the places of the nodes do not settle")

    def _placed(
        self, b: Floats, lower: Floats, upper: Floats, loads: Floats, places: Places
    ) -> Solution:
        """t at its bounds where the places say so, s = 0 elsewhere."""
        free = places == 0
        t = np.select([places < 0, places > 0], [lower, upper], 0.0)
        matrix = np.block(
            [
                [self.influence[np.ix_(free, free)], self.modes[:, free].T],
                [self.resultants[:, free], np.zeros((len(loads), len(loads)))],
            ]
        )
        known = np.concatenate([-(b + self.influence @ t)[free], loads - self.resultants @ t])
        try:
            unknown = np.linalg.solve(matrix, known)
        except np.linalg.LinAlgError as error:
            raise NoSolution("no node is left between its bounds") from error
        t[free], rigid = np.split(unknown, [np.count_nonzero(free)])
        s = np.where(free, 0.0, self.influence @ t + b + rigid @ self.modes)
        return Solution(t, s, rigid, places)


def _misplaced(found: Solution, lower: Floats, upper: Floats) -> Flags:
    """Nodes beyond a bound, and nodes at a bound that would rather leave it for the inside."""
    t, s, _, places = found
    beyond, against = ROUNDING * np.abs(t).max(), ROUNDING * np.abs(s).max()
    outside = (places == 0) & ((t > upper + beyond) | (t < lower - beyond))
    return outside | ((lower < upper) & (places * s > against))


def _corrected(found: Solution, upper: Floats) -> Places:
    """To the bound that was passed, or back from it to the inside."""
    passed = np.where(found.traction > upper, np.int8(1), np.int8(-1))
    return np.where(found.places == 0, passed, np.int8(0))
