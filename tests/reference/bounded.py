"""Tractions between bounds, and the motion that opposes them.

Find t and the rigid motion mu with  s = L t + b + N^T mu,  R t = r,  lower <= t <= upper,  and

    s = 0 between the bounds,    s >= 0 at the lower one,    s <= 0 at the upper one.

For pressure the bounds are 0 and infinity, and s is the gap.  For shear traction the bounds are
-f p and f p, and s is the slip of the step.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.reference.mesh import Floats

Flags = NDArray[np.bool_]
Places = NDArray[np.int8]
"""The status of each node: -1 at the lower bound, 1 at the upper one, 0 between them."""

ROUNDING = 1e-12
"""Values of t and s below this fraction of their largest value count as zero."""

ROUNDS = 60
"""Iterations in which all nodes may change their status.  Afterwards, and whenever hardly any node
would remain between its bounds, one node changes per iteration."""


class NoSolution(ArithmeticError):
    """No tractions between the bounds carry the loads."""


class Solution(NamedTuple):
    """t, s, mu, and the status of each node."""

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
        """Solve by Newton's method, applied to the status of the nodes.

        It starts from the given status, or with all nodes between their bounds.
        """
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
        raise NoSolution("the iteration does not converge: the nodes at their bounds keep changing")

    def _placed(
        self, b: Floats, lower: Floats, upper: Floats, loads: Floats, places: Places
    ) -> Solution:
        """The solution for a given status: t at its bounds, or s = 0 between them."""
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
            raise NoSolution("the equations of nodes between bounds are singular") from error
        t[free], rigid = np.split(unknown, [np.count_nonzero(free)])
        s = np.where(free, 0.0, self.influence @ t + b + rigid @ self.modes)
        return Solution(t, s, rigid, places)


def _misplaced(found: Solution, lower: Floats, upper: Floats) -> Flags:
    """Nodes beyond a bound, and nodes at a bound where s has the wrong sign."""
    t, s, _, places = found
    beyond, against = ROUNDING * np.abs(t).max(), ROUNDING * np.abs(s).max()
    outside = (places == 0) & ((t > upper + beyond) | (t < lower - beyond))
    return outside | ((lower < upper) & (places * s > against))


def _corrected(found: Solution, upper: Floats) -> Places:
    """The corrected status: at the bound that was exceeded, or between the bounds."""
    passed = np.where(found.traction > upper, np.int8(1), np.int8(-1))
    return np.where(found.places == 0, passed, np.int8(0))
