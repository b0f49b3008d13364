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

MAX_EXCHANGES = 30
"""Iterations in which all elements may change their status at once."""


def nearest(mesh: Elements, trial: Array, bound: Array, status: Array) -> Any:
    """The shear traction, v, and the status, beginning with a guess of the status.

    Returns None if no solution is found.
    """
    A, K, w = mesh.influence, mesh.stiffness, mesh.widths
    apart, largest = bound == 0, np.max(bound)
    status = np.where(apart, 0.0, status)
    for iteration in range(MAX_EXCHANGES + 10 * w.size):
        slips, limit = apart | (status != 0), status * bound
        if np.all(slips):
            # all slip and do not carry Q: the first element sticks whose slip would turn round
            side = np.sign(w @ (limit - trial))
            first = np.argmin(np.where(status == side, -side * (A @ (limit - trial)) / w, np.inf))
            status[first], slips[first], limit[first] = 0.0, False, 0.0
        if 2 * np.count_nonzero(slips) <= w.size:
            chosen = np.flatnonzero(slips)
            v = np.zeros(w.size)
            v[chosen] = _solved(K[chosen[:, None], chosen], (trial - limit)[chosen])
            q = np.where(slips, limit, trial - K @ v)
        else:
            chosen = np.flatnonzero(~slips)
            change = np.where(slips, limit - trial, 0.0)
            right = np.column_stack([(A @ change)[chosen], w[chosen]])
            known, even = _solved(A[chosen[:, None], chosen], right).T
            mu = (w[chosen] @ known - w @ change) / (w[chosen] @ even)
            change[chosen] = mu * even - known
            q, v = trial + change, np.where(slips, mu * w - A @ change, 0.0)
        released = (status != 0) & (status * v < -ROUNDING * np.max(abs(v)))
        beyond = ~slips & (abs(q) > bound + ROUNDING * largest)
        wrong = np.flatnonzero(released | beyond)
        if wrong.size == 0:
            return q, v, status
        if iteration >= MAX_EXCHANGES:
            wrong = wrong[:1]
        status[wrong] = np.where(beyond, np.sign(q), 0.0)[wrong]
    return None


def _solved(matrix: Array, right: Array) -> Array:
    """The solution of a system with a symmetric positive definite matrix, which is overwritten."""
    from scipy.linalg.lapack import dposv

    return dposv(matrix.T, right, overwrite_a=True)[1] if right.size else right
