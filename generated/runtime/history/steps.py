r"""Load steps along a path: shear traction, slip and frictional work of the elements.

E* = 1.  In a step the shear traction of an element changes as under full stick, and what exceeds
friction is taken off by slip (nearest.py).  Over a step at points that slip, f p and the slip vary
about linearly, so that the work per length is the mean of f p times the slip.

Where an edge of the contact passes in the step, the motion of the surfaces is not slip, because
surfaces apart move too.  Elements slip there like the nearest one that is in contact throughout,
for the time of their own contact.  The work counts this slip as if it took the whole step: where an
edge passes, the mean of f p over the step is not that of its values before and after it, but the
differences add up to zero over all elements, because f P varies linearly.
"""

import math

import numpy as np

from ..body import Body
from ..cycle import Own
from ..types import Array, Regime
from .elements import Elements, full_stick, mean_pressures
from .nearest import ROUNDING, nearest
from .path import Path


class Interface:
    """The state of the elements while the loads go along a path.

    shear   shear traction
    bound   f p, zero outside the contact
    status  0: sticks; 1 and -1: slips forward and backward
    slip    forward slip in the last step
    work    frictional work per length in the last step
    """

    def __init__(self, body: Body, own: Own, f: float, path: Path, mesh: Elements) -> None:
        self.body, self.own, self.f, self.path, self.mesh = body, own, f, path, mesh
        self.shear, self.status, self.slip, self.work = np.zeros((4, mesh.widths.size))
        self._prepare(0)
        self.bound = self._bounds[0]

    def _prepare(self, first: int) -> None:
        """Compute f p and the full-stick changes for a block of rows from `first` on."""
        rows = Path(*(v[first : first + 512] for v in self.path))
        self._first, self._bounds = first, np.zeros((rows.a.size, self.mesh.widths.size))
        self._changes = np.zeros(self._bounds.shape)
        new = np.ones(rows.a.size, dtype=bool)
        new[1:] = (np.diff(rows.a) != 0) | (np.diff(rows.c) != 0) | (np.diff(rows.P) != 0)
        new &= rows.a + rows.c > 0
        if np.any(new):
            p = mean_pressures(
                self.body, self.own, self.mesh.ends, rows.a[new], rows.c[new], rows.P[new]
            )
            self._bounds = self.f * p[np.maximum(np.cumsum(new) - 1, 0)]
            self._bounds[~(rows.a + rows.c > 0)] = 0.0
            with np.errstate(invalid="ignore"):
                self._changes[1:] = full_stick(self.mesh.ends, *rows[4:6], *rows[2:4])

    def step(self, row: int) -> Regime:
        """Take the step to a row of the path."""
        if not self._first < row < self._first + len(self._bounds):
            self._prepare(row - 1)
        path, before, w = self.path, self.bound, self.mesh.widths
        k = row - self._first
        self.bound, self.slip, self.work = self._bounds[k], np.zeros(w.size), np.zeros(w.size)
        P, Q = path.P[row], path.Q[row]
        if not path.a[row] + path.c[row] > 0:
            self.shear, self.status = np.zeros(w.size), np.zeros(w.size)
            return Regime.NONE
        if not math.isfinite(Q + path.sigma[row]):
            return Regime.UNSOLVED
        if abs(Q) >= self.f * P * (1 - ROUNDING):
            self.status = math.copysign(1.0, Q) * (self.bound > 0)
            self.shear = self.status * self.bound
            self.slip, self.work = np.full((2, w.size), math.nan)
            return Regime.SLIDING
        if math.isnan(path.a[row - 1]):
            # P and Q have grown from zero in proportion; all points have stuck since their contact
            self.shear, self.status = self.bound * (Q / (self.f * P)), np.zeros(w.size)
        if all(v[row] == v[row - 1] for v in path[:4]):
            return Regime.COMPUTED if np.any(self.status) else Regime.FULL_STICK
        trial = self.shear if math.isnan(path.a[row - 1]) else self.shear + self._changes[k]
        trial = trial + (Q - w @ trial) * self.mesh.rise
        if (old := np.flatnonzero(before)).size:
            # a first guess: where contact begins the surfaces slip like those beside it
            self.status = self.status[np.clip(np.arange(w.size), old[0], old[-1])]
        found = nearest(self.mesh, trial, self.bound, self.status)
        if found is None:
            return Regime.UNSOLVED
        self.shear, v, self.status = found
        self._slip(row, 2 * v / w, (before + self.bound) / 2)
        return Regime.COMPUTED if np.any(self.status) else Regime.FULL_STICK

    def _slip(self, row: int, slip: Array, mean: Array) -> None:
        """Set slip and work of the step; `mean` is the mean of f p."""
        path, mesh = self.path, self.mesh
        slip = np.where(self.status != 0, slip, 0.0)
        part = np.ones(slip.size)
        a, c = path.a[row - 1 : row + 1], path.c[row - 1 : row + 1]
        if a[0] != a[1] or c[0] != c[1]:
            outside = np.maximum(-np.min(a) - mesh.ends[:-1], mesh.ends[1:] - np.min(c))
            always = np.flatnonzero(outside <= 0)
            if always.size:
                slips = (self.bound == 0) | (self.status != 0)
                swept = np.clip(np.arange(slip.size), always[0], always[-1])
                slip = np.where(slips, slip[swept], 0.0)
                with np.errstate(all="ignore"):
                    left = (np.max(a) + mesh.middles) / abs(a[1] - a[0])
                    right = (np.max(c) - mesh.middles) / abs(c[1] - c[0])
                part = np.clip(np.fmin(left, right), 0.0, 1.0)
        self.slip, self.work = part * slip, mean * abs(slip)
