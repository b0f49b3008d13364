"""Pressure, edges and tilt from the profile, the normal load and the moment.

    E*/2 gap = u[p] + E*/2 (g(x) + alpha x - delta),    int p dx = P,    int p x dx = -M,

where gap = 0 or p = 0 at each node, and neither is negative.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tests.reference.bounded import Bounded, NoSolution, Places
from tests.reference.kernel import Surface
from tests.reference.mesh import Floats, graded


@dataclass(frozen=True)
class Body:
    """The profile g(x), and the kinks at which its slope jumps."""

    g: Callable[[Floats], Floats]
    E_star: float = 1.0
    kinks: tuple[float, ...] = ()


class Contact(NamedTuple):
    """Pressure at the nodes, tilt, edges located within the elements, and status of the nodes."""

    p: Floats
    alpha: float
    left: float
    right: float
    places: Places


def press(
    body: Body, surface: Surface, P: float, M: float, places: Places | None = None
) -> Contact:
    """The contact under P and M; `places` is a guess of the status of the nodes."""
    x = surface.x
    problem = Bounded(
        surface.influence,
        resultants=np.array([surface.force, surface.moment]),
        modes=np.array([np.ones_like(x), x]),
    )
    none, infinite = np.zeros_like(x), np.full_like(x, np.inf)
    lifted = body.E_star / 2 * body.g(x)
    p, _, rigid, places = problem.solve(lifted, none, infinite, np.array([P, -M]), places)
    return Contact(p, 2 / body.E_star * float(rigid[1]), *edges(x, p), places)


def edges(x: Floats, p: Floats) -> tuple[float, float]:
    """The edges, close to the outermost nodes that carry pressure."""
    inside = np.flatnonzero(p > 0)
    if len(inside) < 7:
        raise NoSolution("the contact contains fewer than 7 nodes: refine the mesh")
    if inside[0] < 2 or inside[-1] > len(x) - 3:
        raise TooShort("the contact reaches an end of the mesh: extend the mesh")
    return _edge(x, p, inside[0], 1), _edge(x, p, inside[-1], -1)


def _edge(x: Floats, p: Floats, first: np.intp, inward: int) -> float:
    """The edge, from p^2 at the second and third node inside, extrapolated linearly to zero."""
    near, far = first + inward, first + 2 * inward
    root = x[near] - p[near] ** 2 * (x[far] - x[near]) / (p[far] ** 2 - p[near] ** 2)
    return float(np.clip(root, *sorted((x[first - 2 * inward], x[near]))))


class TooShort(NoSolution):
    """The contact extends beyond the mesh."""


def rough_edges(body: Body, P: float, M: float, count: int = 24) -> tuple[float, float]:
    """Approximate edges, from a coarse mesh around the line of action of the load.

    The width of the mesh is adapted to the contact.
    """
    if P <= 0:
        raise NoSolution(f"no contact: P must be positive; got {P}")
    centre, reach = -M / P, 1.0
    for _ in range(200):
        breaks = [centre - reach, centre, centre + reach]
        inner = [k for k in body.kinks if abs(k - centre) < reach]
        try:
            contact = press(body, Surface(graded([*breaks, *inner], count)), P, M)
        except TooShort:
            reach *= 1.5
        except NoSolution:
            reach /= 1.5
        else:
            if contact.right - contact.left > reach / 2:
                return contact.left, contact.right
            reach /= 1.5
    raise NoSolution("no mesh that contains the contact was found")
