"""`make series`: errors of the series of the slip zones, relative to the exact stick zone.

Each row gives the slip zone relative to the contact width, and the relative errors of orders 1 and
2.  The powers of the slip zone with which the errors fall should equal the orders.
"""

import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from generated.runtime.types import Contact
from notebooks.common import closing_tension
from tests.measure.page import table, write

TABLE = Path(__file__).parents[3] / "notebooks" / "series.md"
F, E_STAR = 0.5, 1.0
ORDERS = (1, 2)
PARTS = 0.3 * 0.25 ** np.arange(4)
BODIES: dict[str, tuple[dict[str, float], float, float]] = {
    "wedge": ({"phi": 0.125}, 1.5, 1.0),
    "hertz": ({"R": 1.0}, 1.5, 1.0),
    "two_radii": ({"R_1": 0.75, "R_2": 1.5}, 1.5, 1.0),
    "flat_rounded": ({"R": 1.0, "b": 0.5}, 1.5, 1.0),
    "hyperbola": ({"b": 0.5, "phi": 0.125}, 1.5, 1.0),
}
"""For each body its parameters and the edges a and c of a contact."""


class Errors(NamedTuple):
    """Slip zones of one body at one edge, and the errors of each order, for each of PARTS."""

    name: str
    edge: str
    size: Any
    errors: Any

    @property
    def slopes(self) -> Any:
        """Powers of the size with which the errors fall, from the last two rows."""
        return np.log(self.errors[:, -2] / self.errors[:, -1]) / np.log(
            self.size[-2] / self.size[-1]
        )


def measured(name: str, parts: Any = PARTS) -> Iterator[Errors]:
    """Errors at both edges of one body."""
    own, a, c = BODIES[name]
    body: Any = importlib.import_module(f"generated.{name}")
    law = {"f": F, "E_star": E_STAR, **own}
    contact = Contact(a, c, 0.0)
    shear = parts * F * body.load(a, c, E_star=E_STAR, **own)
    closing = [closing_tension(body, contact, dQ, **law)[1] for dQ in shear]
    tension = 2 * np.array(closing)
    zone = body.stick_zone(contact, contact, shear, tension, **law)
    exact = {"left": a - zone.m, "right": c - zone.n}
    series = [body.slip_zones(a, c, shear, tension, order=order, **law) for order in ORDERS]
    for edge, size in exact.items():
        errors = np.abs(np.array([getattr(d, edge) for d in series]) / size - 1)
        yield Errors(name, edge, size / (a + c), errors)


TEXT = """
# Errors of the series of the slip zones

Written by `make series`.  The normal loads are constant, and the tension is large,
twice the tension at which a slip zone closes; dQ is 0.3 f P, and a quarter of the
value before in each further row.  The table gives the relative errors of the slip
zones of each order, compared with the exact conditions.  The last row of each edge
gives the power of the slip zone with which the error falls.
"""


def rows() -> Iterator[list[str]]:
    """The cells of the table."""
    for of in (errors for name in BODIES for errors in measured(name)):
        for size, *errors in zip(of.size, *of.errors, strict=True):
            yield [of.name, of.edge, f"{size:.4f}", *(f"{error:.1e}" for error in errors)]
        yield [of.name, of.edge, "power", *(f"{power:.2f}" for power in of.slopes)]


if __name__ == "__main__":
    head = ["body", "edge", "slip zone / width", *(f"order {order}" for order in ORDERS)]
    write(TABLE, TEXT, table(head, rows(), words=2))
