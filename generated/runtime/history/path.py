"""The loads and contacts of a history step by step; between two instants all loads vary linearly.

Steps are so short that no edge moves farther than `reach` times the widest contact, and that Q and
sigma change accordingly (SHEAR_STEP).  A step ends where |Q| reaches f P or falls below it.  Where
the contact becomes four times as wide, or a quarter as wide, between two instants, steps are
shorter next to the narrower contact.  The contact before a loss of contact is small.  So is the
first one after it, or it is that of a flat body under a small load.  If there is neither, because
the contact approaches from a great distance, its shear traction is not known, and Q is NaN there.
"""

import math
from typing import NamedTuple

import numpy as np

from ..body import Body
from ..cycle import Own, contact
from ..types import Array

SMALL_CONTACT = 0.02
"""Width of the last contact before a loss and of the first after it, relative to that at the
previous and the next instant.  A flat body begins with a wide contact, under less than the square
of this fraction of the load at the next instant."""

SHEAR_STEP = 4.0
"""Largest change in Q/(f P) in a step, and in h sigma/(8 f P), relative to the largest motion of an
edge."""

MAX_SHEAR = 2.0
"""Largest change that SHEAR_STEP divides into steps: from sliding one way to sliding the other."""

LAST_STEP = 0.01
"""Length of the last step before an instant relative to the others.  The stick zone of the instant
is that of this step; a slip zone that shrinks is longer in earlier steps."""


class Path(NamedTuple):
    """Loads and contacts, one row per step, and the instant at which the step ends, or else -1."""

    P: Array
    M: Array
    Q: Array
    sigma: Array
    a: Array
    c: Array
    instant: Array


def path(body: Body, own: Own, f: float, loads: Array, reach: float, short_end: bool) -> Path:
    """The path; its first row is the contact at the first instant without shear.

    loads: P, M, Q and sigma, one row each.
    short_end: whether the last step before an instant is short.
    """
    loads = np.hstack([loads[:, :1] * [[1.0], [1.0], [0.0], [0.0]], loads])
    a, c, _ = contact(body, own, loads[0], loads[1], 1.0)
    widest = np.max(np.nan_to_num(a + c))
    pieces, unknown = [loads[:, :1]], [False]
    for k in range(1, loads.shape[1]):
        ends = _Way(body, own, loads[:, k - 1 : k + 1], a[k - 1 : k + 1], c[k - 1 : k + 1], widest)
        t = ends.fractions(f, reach, short_end)
        pieces.append(_between(loads[:, k - 1, None], loads[:, k, None], t))
        unknown += [ends.begins_far_away(t[0])] + [False] * (t.size - 1)
    last = np.cumsum([piece.shape[1] for piece in pieces]) - 1
    rows = np.hstack(pieces)
    rows[:, last] = loads
    rows[2, unknown] = np.nan
    instant = np.full(rows.shape[1], -1)
    instant[last[1:]] = np.arange(last.size - 1)
    P, M, Q, sigma = rows
    a, c, _ = contact(body, own, P, M, 1.0)
    return Path(P, M, Q, sigma, a, c, instant)


def _between(first: Array, second: Array, t: Array) -> Array:
    """Loads at a fraction t of the way; what does not change is exactly constant."""
    return first + t * (second - first)


class _Way(NamedTuple):
    """The way from one instant to the next: loads and edges at both, and the widest contact."""

    body: Body
    own: Own
    loads: Array
    a: Array
    c: Array
    widest: float

    def fractions(self, f: float, reach: float, short_end: bool) -> Array:
        """The fractions of the way at which steps end, the last one being 1."""
        narrow, wide = sorted(width if width > 0 else 0.0 for width in self.a + self.c)
        if wide == 0:
            return np.ones(1)
        moved = wide
        if narrow > 0:
            moved = max(abs(self.a[1] - self.a[0]), abs(self.c[1] - self.c[0]))
        uneven = 4 * narrow < wide
        P, _, Q, sigma = self.loads
        shear = max(abs(Q[1] - Q[0]), wide * abs(sigma[1] - sigma[0]) / 8) / (f * max(P))
        change = max((2 if uneven else 1) * moved / self.widest, min(shear, MAX_SHEAR) / SHEAR_STEP)
        count = max(1, math.ceil(change / reach))
        t = np.arange(count + 1) / count
        if short_end:
            t = np.concatenate([t[:-1], [1 - LAST_STEP / count, 1.0]])
        widens = self.a[1] + self.c[1] == wide
        if uneven:
            t = t**2 if widens else 1 - (1 - t) ** 2
        if narrow == 0 and widens:
            beyond = self._empty_part(1)
            t = beyond + (1 - beyond) * t
        if not (narrow == 0 and widens):
            t = t[1:]
        for sign in (1, -1):
            before, after = sign * self.loads[2] - f * self.loads[0]
            if before * after < 0 and (narrow > 0 or t[0] < before / (before - after)):
                t = np.union1d(t, before / (before - after))
        return t

    def _empty_part(self, touching_end: int) -> float:
        """The part of the way without contact, or in which the contact is very small or far away.

        touching_end: the end at which there is contact, 0 or 1.
        """
        a, c, low, high = self.a[touching_end], self.c[touching_end], 0.0, 1.0
        for _ in range(50):
            part = (low + high) / 2
            empty, full = self.loads[:2, 1 - touching_end], self.loads[:2, touching_end]
            P, M = _between(empty, full, part)
            left, right, _ = contact(self.body, self.own, P, M, 1.0)
            near = left < a + self.widest and right < c + self.widest
            if near and left + right > SMALL_CONTACT * (a + c):
                high = part
            else:
                low = part
        return high

    def begins_far_away(self, t: float) -> bool:
        """Whether the contact of the first step, which ends at t, is neither small nor unloaded."""
        if not (math.isnan(self.a[0]) and self.a[1] + self.c[1] > 0):
            return False
        P, M = _between(self.loads[:2, 0], self.loads[:2, 1], t)
        left, right, _ = contact(self.body, self.own, P, M, 1.0)
        small = left + right < 2 * SMALL_CONTACT * (self.a[1] + self.c[1])
        return not (small or SMALL_CONTACT**2 * self.loads[0, 1] > P)
