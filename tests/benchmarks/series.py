"""How far the series of the slip zones are off, order by order, against the exact stick zone.

    python -m tests.benchmarks.series      the table, also kept in notebooks/series.md

Large tension, twice that which closes a slip zone; dQ from 0.3 f P down to 0.3 f P/64.  Each row
gives the slip zone in parts of the width, the relative error of orders 1, 2 and 3, and under the
last row of a body how fast each falls: by the size of the slip zone to the power of the order.
"""

import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from generated.runtime.types import Contact

TABLE = Path(__file__).parent.parent.parent / "notebooks" / "series.md"
F, E_STAR = 0.5, 1.0
ORDERS = (1, 2, 3)
PARTS = 0.3 * 0.25 ** np.arange(4)
BODIES: dict[str, tuple[dict[str, float], float, float]] = {
    "wedge": ({"phi": 0.125}, 1.5, 1.0),
    "hertz": ({"R": 1.0}, 1.5, 1.0),
    "two_radii": ({"R_1": 0.75, "R_2": 1.5}, 1.5, 1.0),
    "flat_rounded": ({"R": 1.0, "b": 0.5}, 1.5, 1.0),
    "hyperbola": ({"b": 0.5, "phi": 0.125}, 1.5, 1.0),
}
"""Parameters and a contact of each body."""


class Errors(NamedTuple):
    """Slip zones of one body at one edge, and what each order is off, row by row of PARTS."""

    name: str
    edge: str
    size: Any
    errors: Any

    @property
    def slopes(self) -> Any:
        """Powers of the size with which the errors fall, between the last two rows."""
        return np.log(self.errors[:, -2] / self.errors[:, -1]) / np.log(
            self.size[-2] / self.size[-1]
        )


def measured(name: str, parts: Any = PARTS) -> Iterator[Errors]:
    """Both edges of one body."""
    own, a, c = BODIES[name]
    body: Any = importlib.import_module(f"generated.{name}")
    law = {"f": F, "E_star": E_STAR, **own}
    here = Contact(a, c, 0.0)
    shear = parts * F * body.load(a, c, E_star=E_STAR, **own)
    tension = 2 * body.closing_tension(here, here, shear, **law).upper
    zone = body.stick_zone(here, here, shear, tension, **law)
    exact = {"left": a - zone.m, "right": c - zone.n}
    found = [body.slip_zones(a, c, shear, tension, order=order, **law) for order in ORDERS]
    for edge, size in exact.items():
        errors = np.abs(np.array([getattr(d, edge) for d in found]) / size - 1)
        yield Errors(name, edge, size / (a + c), errors)


def table() -> str:
    """The table in Markdown."""
    lines = [
        "# How exact the series of the slip zones are",
        "",
        "Made by `make series`.  Large tension, twice that which closes a slip zone, constant",
        "normal loads; dQ = 0.3 f P and a quarter of it in turn.  Relative errors of the slip zone",
        "against the exact conditions; in the last row of each the power of its size with which",
        "they fall.",
        "",
        "| body | edge | slip zone / width | order 1 | order 2 | order 3 |",
        "| --- | --- | ---: | ---: | ---: | ---: |",
    ]
    for name in BODIES:
        for of in measured(name):
            for size, *errors in zip(of.size, *of.errors, strict=True):
                shown = " | ".join(f"{e:.1e}" for e in errors)
                lines.append(f"| {name} | {of.edge} | {size:.4f} | {shown} |")
            slopes = " | ".join(f"{v:.2f}" for v in of.slopes)
            lines.append(f"| {name} | {of.edge} | power | {slopes} |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Print the table and keep it."""
    text = table()
    TABLE.parent.mkdir(exist_ok=True)
    TABLE.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
