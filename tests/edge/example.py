"""The table in examples/: a tilted flat with rounded edges on a coarse, equal mesh.

Pressure and full-stick shear come from the independent solver of tests/reference; lengths are in
mm, stresses in MPa.  `python -m tests.edge.example` writes the table anew.
"""

from pathlib import Path

import numpy as np

from generated import flat_rounded
from tests.reference.kernel import Surface
from tests.reference.normal import Body, press

PATH = Path(__file__).parents[2] / "examples" / "edge_flat_rounded.csv"
LAW = {"E_star": 115e3, "R": 150.0, "b": 1.0}
A, C = 3.0, 2.6
F, DQ = 0.5, 600.0
"""Coefficient of friction, and by how much the shear load swings [N/mm]."""

SPACING = 0.14
"""Of the nodes; forty elements in the contact."""


def profile(x: np.ndarray) -> np.ndarray:
    """g(x), flat between -b and b."""
    return np.maximum(np.abs(x) - LAW["b"], 0.0) ** 2 / (2 * LAW["R"])


def bonded(surface: Surface, contact: np.ndarray, dQ: float) -> np.ndarray:
    """The shear traction of nodes that a shear load moves by one constant, without strain."""
    inside = np.flatnonzero(contact)
    size = len(inside) + 1
    system, right = np.zeros((size, size)), np.zeros(size)
    system[:-1, :-1] = surface.influence[np.ix_(inside, inside)]
    system[:-1, -1] = 1.0
    system[-1, :-1] = surface.force[inside]
    right[-1] = dQ
    dq = np.zeros(len(contact))
    dq[inside] = np.linalg.solve(system, right)[:-1]
    return dq


def table() -> str:
    """The file's text."""
    x = np.arange(-25, 24) * SPACING + 0.03
    surface = Surface(x)
    P, M = (float(of(A, C, **LAW)) for of in (flat_rounded.load, flat_rounded.moment))
    p = press(Body(profile, LAW["E_star"], (-LAW["b"], LAW["b"])), surface, P, M).p
    rows = zip(x, p, bonded(surface, p > 0, DQ), strict=True)
    lines = [
        "# tilted flat with rounded edges, forty elements in the contact",
        "x [mm]; p [MPa]; dq [MPa]",
    ]
    return "\n".join([*lines, *(f"{a:.4f}; {b:.4f}; {c:.4f}" for a, b, c in rows)]) + "\n"


if __name__ == "__main__":
    PATH.write_text(table())
