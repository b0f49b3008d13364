r"""The shear traction within the friction limits that is nearest to a trial: the convex problem of
a load step.

`trial` is the shear traction that the step would give under full stick; it carries Q.  The solution
minimises (q - trial)^T A (q - trial)/2 over all q with |q| <= bound that carry Q.  With v = w s, s
half of the forward slip in the step,

    q = trial - K v,   v = 0 between the bounds,   v >= 0 at the upper one,   v <= 0 at the lower,

and for points out of contact bound = 0 and v is free.  The method is Newton's, applied to the
status of the elements: 0 where they stick, 1 and -1 where they slip forward and backward.  For a
given status v follows from a linear system for the elements that slip, or, if those that stick are
fewer, q from one for these:

    A (q - trial) = mu w - v,    w . (q - trial) = 0.

All elements with a wrong status change it at once.  If this does not converge, only the first of
them does in each further iteration, as in Murty's method.
"""

from typing import Any

import numpy as np

from ..types import Array
from .elements import Elements

ROUNDING = 1e-11
"""Values below this fraction of the largest count as zero, and loads that differ by less than this
fraction of f P as equal."""


class Solver:
    """Solves load steps on a mesh.

    It keeps the last factor, because a step begins with the status at the end of the step before.
    """

    def __init__(self, mesh: Elements) -> None:
        self.mesh = mesh
        self._of: tuple[Any, Array] = None, np.empty(0)
        self._factor = np.empty((0, 0))

    def nearest(self, trial: Array, bound: Array, status: Array) -> Any:
        """The shear traction, v, and the status, beginning with a guess of the status.

        Returns None if no solution is found.
        """
        A, K, w = self.mesh.influence, self.mesh.stiffness, self.mesh.widths
        apart, most = bound == 0, bound + ROUNDING * bound.max()
        status = np.where(apart, 0.0, status)
        all_at_once = 30
        for iteration in range(all_at_once + 10 * w.size):
            slips, limit = apart | (status != 0), status * bound
            sticks = ~slips
            chosen = sticks.nonzero()[0]
            if chosen.size == 0:
                # all slip and do not carry Q: the first sticks whose slip would turn round
                side = np.sign(w @ (limit - trial))
                turns = np.where(status == side, -side * (A @ (limit - trial)) / w, np.inf)
                chosen = np.array([turns.argmin()])
                status[chosen], slips[chosen], limit[chosen], sticks[chosen] = 0.0, False, 0.0, True
            if 2 * chosen.size >= w.size:
                chosen, v = slips.nonzero()[0], np.zeros(w.size)
                v[chosen] = self._solved(K, chosen, (trial - limit)[chosen])
                q = trial - K @ v
                q[chosen] = limit[chosen]
            else:
                change = np.where(slips, limit - trial, 0.0)
                right = np.array([(A @ change)[chosen], w[chosen]])
                known, even = self._solved(A, chosen, right.T).T
                mu = (right[1] @ known - w @ change) / (right[1] @ even)
                change[chosen] = mu * even - known
                q, v = trial + change, mu * w - A @ change
                v[chosen] = 0.0
            released = status * v < -ROUNDING * abs(v).max()
            beyond = sticks & (abs(q) > most)
            wrong = (released | beyond).nonzero()[0]
            if wrong.size == 0:
                return q, v, status
            if iteration >= all_at_once:
                wrong = wrong[:1]
            status[wrong] = np.where(beyond, np.sign(q), 0.0)[wrong]
        return None

    def _solved(self, matrix: Array, chosen: Array, right: Array) -> Array:
        """The solution for the chosen rows and columns of a symmetric positive definite matrix."""
        from scipy.linalg.lapack import dpotrf, dpotrs

        if chosen.size == 0:
            return right
        if not (matrix is self._of[0] and np.array_equal(chosen, self._of[1])):
            self._of = matrix, chosen
            rows = matrix.take(chosen, 0).take(chosen, 1).T
            self._factor = dpotrf(rows, clean=False, overwrite_a=True)[0]
        return dpotrs(self._factor, right)[0]
