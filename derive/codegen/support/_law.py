"""What partial slip needs of a body: its functions, and the places where its curve is cut."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ._arrays import at_rows
from ._types import Array, Contact

NODES, FEWER = 20, 12
"""Nodes of Gauss's rule along a way between two contacts, and of the one it is held against."""

SETTLED = 1e-9
"""What both may differ by: the finer one is exact to rounding then."""


class Law(NamedTuple):
    """The functions of one body that partial slip is made of; the integrand is the pressure.

    kinks: places where the curve is cut.
    third: coefficients of s**(5/2) in the pressure next to the edges; None if nothing gives them.
    smooth: numbers of the cuts that one curve goes across.
    """

    contact: Callable[..., Contact]
    contact_at_tilt: Callable[..., Contact]
    tilt: Callable[..., Array]
    load: Callable[..., Array]
    moment: Callable[..., Array]
    pressure: Callable[..., Array]
    integrand: Callable[..., Array]
    K_N: Callable[..., Any]
    L_N: Callable[..., Any]
    kinks: Callable[..., tuple[Array, ...]]
    third: Callable[..., Any] | None = None
    smooth: tuple[int, ...] = ()

    def tilt_of(self, a: Array, c: Array, constants: dict[str, Array]) -> Array:
        """alpha; of all constants those that are the profile's."""
        return self.tilt(a, c, **_profile(constants))

    def places(self, constants: dict[str, Array]) -> tuple[Array, ...]:
        """Where its curve is cut."""
        return self.kinks(**_profile(constants))

    def bends(self, constants: dict[str, Array]) -> tuple[Array, ...]:
        """Where one curve ends and another begins."""
        found = enumerate(self.places(constants))
        return tuple(place for i, place in found if i not in self.smooth)


def _profile(constants: dict[str, Array]) -> dict[str, Array]:
    return {name: value for name, value in constants.items() if name != "E_star"}


class Change(NamedTuple):
    """From one contact to another.

    load: by how much the load rises.
    tilt: by how much the tilt rises, times E*.
    settled: whether both are known to rounding.
    """

    load: Array
    tilt: Array
    settled: Array


Way = tuple[Array, Array]
"""a and c of a contact, or by how much they change."""


def change_between(law: Law, start: Way, end: Way, constants: dict[str, Array]) -> Change:
    """Changes along the straight way between two contacts, added up from flat punches,

        dP = (pi/4) sqrt(h) (K_left da + K_right dc),
        E* dalpha = (K_left da - K_right dc)/sqrt(h),

    which loses nothing where a difference of two loads, or of two tilts, would.  All arrays have
    one length.
    """
    return change_along(law, start, (end[0] - start[0], end[1] - start[1]), constants)


@np.errstate(all="ignore")
def change_along(law: Law, start: Way, motion: Way, constants: dict[str, Array]) -> Change:
    """The same for a contact and by how much its edges move."""
    ends = _ends(law, start, motion, constants)
    sums, rough = (_added_up(law, start, motion, ends, constants, n) for n in (NODES, FEWER))
    known = np.all(np.abs(sums - rough)[:2] <= SETTLED * sums[2:], axis=0)
    return Change(sums[0], sums[1], known)


def _ends(law: Law, start: Way, motion: Way, constants: dict[str, Array]) -> Array:
    """Parts of the way, 0 to 1, between which no edge goes across a kink, one row each."""
    found = [0.0 * start[0], 0.0 * start[0] + 1]
    for bend in law.bends(constants):
        for way in ((-start[0] - bend) / motion[0], (bend - start[1]) / motion[1]):
            found.append(np.where((way > 0) & (way < 1), way, 1.0))
    return np.sort(found, axis=0)


def _added_up(
    law: Law, start: Way, motion: Way, ends: Array, constants: dict[str, Array], count: int
) -> Array:
    """Changes of the load and of E* times the tilt, and the sums of all their terms' sizes."""
    angles, weights = np.polynomial.legendre.leggauss(count)
    angles = np.pi / 4 * (angles + 1)  # a root at an end of the way is smooth over these
    weights, nodes = weights * np.sin(2 * angles), np.sin(angles) ** 2
    weights = weights / np.sum(weights)
    total = np.zeros((4, start[0].size))
    for low, high in pairwise(ends):
        rows = np.flatnonzero(high > low)
        if not rows.size:
            continue
        length = (high - low)[rows]
        part = low[rows] + length * nodes[:, None]
        a, c = (edge[rows] + part * by[rows] for edge, by in zip(start, motion, strict=True))
        K = law.K_N(a, c, **at_rows(rows, constants))
        root = np.sqrt(a + c)
        shares = [length * rate * by[rows] for rate, by in zip(K, motion, strict=True)]
        for i, (left, right) in enumerate((shares, map(np.abs, shares))):
            total[2 * i, rows] += np.pi / 4 * weights @ (root * (left + right))
            total[2 * i + 1, rows] += weights @ ((left + (right if i else -right)) / root)
    return total
