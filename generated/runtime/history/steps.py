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
from typing import Any

import numpy as np

from ..body import Body
from ..cycle import Own
from ..types import Array, Regime
from .elements import Elements, full_stick, mean_pressures
from .nearest import ROUNDING, Solver
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
        self._solver = Solver(mesh)
        self.shear, self.status, self.slip, self.work = np.zeros((4, mesh.widths.size))
        self._prepare(0)
        self.bound = self._bounds[0]

    def _prepare(self, first: int) -> None:
        """Compute what the steps to a block of rows from `first` on need of the path alone.

        bounds   f p
        changes  change in shear under full stick
        swept    of each element the nearest one that is in contact throughout the step, if an edge
                 moves
        parts    part of the step for which the element is in contact
        """
        path, ends = Path(*(v[first : first + 512] for v in self.path)), self.mesh.ends
        self._first, self._bounds = first, np.zeros((path.a.size, ends.size - 1))
        self._changes = np.zeros(self._bounds.shape)
        moves = (np.diff(path.a) != 0) | (np.diff(path.c) != 0)
        new = np.append(True, moves | (np.diff(path.P) != 0)) & (path.a + path.c > 0)
        if np.any(new):
            p = mean_pressures(self.body, self.own, ends, path.a[new], path.c[new], path.P[new])
            self._bounds = self.f * p[np.maximum(np.cumsum(new) - 1, 0)]
            self._bounds[~(path.a + path.c > 0)] = 0.0
            with np.errstate(invalid="ignore"):
                self._changes[1:] = full_stick(ends, *path[4:6], *path[2:4])
        a, c = path.a[:, None], path.c[:, None]
        always = -np.minimum(a[:-1], a[1:]) <= ends[:-1]
        always &= ends[1:] <= np.minimum(c[:-1], c[1:])
        self._swept = _nearest_marked(always & moves[:, None])
        with np.errstate(all="ignore"):
            left = (np.maximum(a[:-1], a[1:]) + self.mesh.middles) / abs(np.diff(a, axis=0))
            right = (np.maximum(c[:-1], c[1:]) - self.mesh.middles) / abs(np.diff(c, axis=0))
        part = np.clip(np.fmin(left, right), 0.0, 1.0)
        self._parts = np.where((moves & np.any(always, axis=1))[:, None], part, 1.0)

    def step(self, row: int, guess: Any = None) -> Regime:
        """Take the step to a row of the path, from a guess of the status after it; without one,
        from the status before it.
        """
        if not self._first < row < self._first + len(self._bounds):
            self._prepare(row - 1)
        path, before, w, k = self.path, self.bound, self.mesh.widths, row - self._first
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
        found = self._solver.nearest(trial, self.bound, self.status if guess is None else guess)
        if found is None:
            return Regime.UNSOLVED
        self.shear, v, self.status = found
        slides = self.status != 0
        slip = np.where(slides, 2 * v / self.mesh.widths, 0.0)[self._swept[k - 1]]
        slip = np.where(slides | (self.bound == 0), slip, 0.0)
        self.slip = self._parts[k - 1] * slip
        self.work = (before + self.bound) / 2 * abs(slip)
        return Regime.COMPUTED if slides.any() else Regime.FULL_STICK


def _nearest_marked(marked: Array) -> Array:
    """Of each element in a row the nearest one between the first and the last that are marked; the
    element itself where none is marked."""
    count = marked.shape[1]
    first, last = np.argmax(marked, axis=1), count - 1 - np.argmax(marked[:, ::-1], axis=1)
    first = np.where(np.any(marked, axis=1), first, 0)
    return np.clip(np.arange(count), first[:, None], last[:, None])
