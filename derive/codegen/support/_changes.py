"""What load, tilt, pressure and K_N change by, added up from flat punches.

An edge that moves outward by da, or dc, adds a flat punch to the pressure,

    dp = K_left sqrt((c - x)/(a + x)) da/(2 sqrt(h)) + K_right sqrt((a + x)/(c - x)) dc/(2 sqrt(h)),

so that load, tilt and the root at the right edge rise by

    dP = (pi/4) sqrt(h) (K_left da + K_right dc),    E* dalpha = (K_left da - K_right dc)/sqrt(h),
    dK_right = K_left da/(2 h) - (K_right/(4 h) + (3/2) L_right) dc,

and that at the left edge in the same way.  Added up along a straight way from one contact to
another they lose nothing where a difference would.  All arrays have one length.
"""

from collections.abc import Callable
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ._arrays import TINY, Array, at_rows, weighted
from ._law import Law

NODES, FEWER, FEWEST = 20, 12, 8
"""Nodes of Gauss's rule along a way between two contacts, and of those it is held against."""

SETTLED = 3e-14
"""A doubt that is rounding."""

Way = tuple[Array, Array]
"""a and c of a contact, or by how much they change."""

Rates = Callable[[Array, Array, Way, Array], list[Way]]
"""What is integrated over the places of both edges: of a, c, how far they have moved, and rows."""


class Change(NamedTuple):
    """From one contact to another.

    load: by how much the load rises.
    tilt: by how much the tilt rises, times E*.
    doubt: what they may be off by, in parts of both edges' shares.
    """

    load: Array
    tilt: Array
    doubt: Array

    @property
    def settled(self) -> Array:
        """Whether both are known to rounding."""
        return self.doubt <= SETTLED


def change_between(law: Law, start: Way, end: Way, constants: dict[str, Array]) -> Change:
    """From one contact to another."""
    return change_along(law, start, (end[0] - start[0], end[1] - start[1]), constants)


@np.errstate(all="ignore")
def change_along(law: Law, start: Way, motion: Way, constants: dict[str, Array]) -> Change:
    """From a contact on, by how much its edges move."""

    def rates(a: Array, c: Array, moved: Way, rows: Array) -> list[Way]:
        left, right = law.K_N(a, c, **at_rows(rows, constants))
        root = np.sqrt(a + c)
        flat = np.pi / 4 * root
        return [(flat * left, flat * right), (left / root, -right / root)]

    (load, tilt), doubt = _added_up(law, start, motion, constants, rates)
    return Change(load, tilt, doubt)


@np.errstate(all="ignore")
def step_for(law: Law, here: Way, load: Array, tilt: Array, constants: dict[str, Array]) -> Way:
    """Newton's step of both edges of a contact that lacks so much load, and E* times tilt.

    K_left da and K_right dc are half the sum and half the difference of both.
    """
    root = np.sqrt(here[0] + here[1])
    K = law.K_N(*here, **constants)
    by_load, by_tilt = load * (4 / np.pi) / root, tilt * root
    return (by_load + by_tilt) / (2 * K.left), (by_load - by_tilt) / (2 * K.right)


@np.errstate(all="ignore")
def pressure_along(
    law: Law, x: Array, start: Way, motion: Way, constants: dict[str, Array]
) -> tuple[Array, Array]:
    """By how much p rises at x, which stays inside; whether that is known to rounding."""
    before, behind = start[0] + x, start[1] - x

    def rates(a: Array, c: Array, moved: Way, rows: Array) -> list[Way]:
        left, right = law.K_N(a, c, **at_rows(rows, constants))
        A, B = before[rows] + moved[0], behind[rows] + moved[1]
        twice = 2 * np.sqrt(a + c)
        return [(left * np.sqrt(B / A) / twice, right * np.sqrt(A / B) / twice)]

    (risen,), doubt = _added_up(law, start, motion, constants, rates)
    return risen, doubt <= SETTLED


@np.errstate(all="ignore")
def edges_along(
    law: Law, start: Way, motion: Way, constants: dict[str, Array]
) -> tuple[Way, Array]:
    """By how much K_N rises at the left and the right edge; whether that is known to rounding."""

    def rates(a: Array, c: Array, moved: Way, rows: Array) -> list[Way]:
        held, h = at_rows(rows, constants), a + c
        K, L = law.K_N(a, c, **held), law.L_N(a, c, **held)
        own = [-(k / (4 * h) + 1.5 * slope) for k, slope in zip(K, L, strict=True)]
        return [(own[0], K.right / (2 * h)), (K.left / (2 * h), own[1])]

    (left, right), doubt = _added_up(law, start, motion, constants, rates)
    return (left, right), doubt <= SETTLED


def _added_up(
    law: Law, start: Way, motion: Way, constants: dict[str, Array], rates: Rates
) -> tuple[list[Array], Array]:
    """The integrals along the way, and what they may be off by, in parts of the shares.

    How fast the rules come together tells how far the finest is off: r**2 times its distance from
    the next one, r being by how much that is less than the distance between the coarser two.  Close
    to a kink r is not small.
    """
    ends = _ends(law, start, motion, constants)
    rules = (_by_rule(start, motion, ends, rates, count) for count in (NODES, FEWER, FEWEST))
    doubt = np.zeros(start[0].shape)
    found = []
    for (fine, size), (middle, _), (coarse, _) in zip(*rules, strict=True):
        last, before = np.abs(fine - middle), np.abs(middle - coarse)
        closer = np.minimum(last / (before + TINY), 1)
        doubt = np.maximum(doubt, last * closer**2 / (size + TINY))
        found.append(fine)
    return found, doubt


def _ends(law: Law, start: Way, motion: Way, constants: dict[str, Array]) -> Array:
    """Parts of the way, 0 to 1, between which no edge goes across a kink, a column each."""
    found = [0.0 * start[0], 0.0 * start[0] + 1]
    for bend in law.bends(constants):
        for way in ((-start[0] - bend) / motion[0], (bend - start[1]) / motion[1]):
            found.append(np.where((way > 0) & (way < 1), way, 1.0))
    return np.sort(found, axis=0)


def _by_rule(
    start: Way, motion: Way, ends: Array, rates: Rates, count: int
) -> list[tuple[Array, Array]]:
    """The integrals, and those of the sizes of both edges' shares."""
    nodes, weights = rule_of_way(count)
    found: list[tuple[Array, Array]] = []
    moves = (motion[0] != 0) | (motion[1] != 0)
    for low, high in pairwise(ends):
        rows = np.flatnonzero((high > low) & moves)
        length = (high - low)[rows]
        part = low[rows] + length * nodes[:, None]
        moved = part * motion[0][rows], part * motion[1][rows]
        given = rates(start[0][rows] + moved[0], start[1][rows] + moved[1], moved, rows)
        if not found:
            found = [(np.zeros(start[0].shape), np.zeros(start[0].shape)) for _ in given]
        for (value, size), (left, right) in zip(found, given, strict=True):
            by_left, by_right = length * motion[0][rows] * left, length * motion[1][rows] * right
            value[rows] = weighted(weights, by_left + by_right, value[rows])
            size[rows] = weighted(weights, np.abs(by_left) + np.abs(by_right), size[rows])
    return found


@cache
def rule_of_way(count: int) -> tuple[Array, Array]:
    """Nodes and weights on (0, 1), for which roots at the ends are smooth: over sin(angle)**2."""
    angles, weights = np.polynomial.legendre.leggauss(count)
    angles = np.pi / 4 * (angles + 1)
    weights = weights * np.sin(2 * angles)
    return np.sin(angles) ** 2, weights / np.sum(weights)
