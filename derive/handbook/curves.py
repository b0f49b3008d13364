"""What a page draws of a body: its profile, and the pressure of some of its contacts.

The pressure is that of the generated module, which is imported as it was printed.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from markupsafe import Markup

from derive.body import Body
from derive.codegen.function import example_of
from derive.codegen.trial import imported
from derive.compiled import compiled
from derive.handbook.picture import Line, svg
from derive.sheet import FormulaSheet
from derive.symbols import E_star, a, c, x

SAMPLES = 241
CONTACTS = ((1.0, 0.0, "P"), (0.5, 0.0, "P/2"), (1.0, 0.25, "P, and a moment M = P a/4"))
"""Load in parts of the first, moment in parts of load and half-width, and what is said of them."""


class Pictures(NamedTuple):
    """Of one body; `drawn_at` says at which numbers, `labels` what the curves of pressure are."""

    profile: Markup
    pressure: Markup
    labels: tuple[str, ...]
    drawn_at: str


def pictures(sheet: FormulaSheet, body: Body) -> Pictures:
    """Drawn at the plain numbers of the module's own examples."""
    point = example_of(sheet, sheet["load"].conditions)
    own = {q.name: float(point[q.symbol]) for q in sheet.geometry.parameters}
    half = float(max(point[a], point[c]))
    law = {"E_star": float(point[E_star]), **own}
    with imported(body.name, body.text, body.stuck) as module:
        lines = tuple(_pressures(module, half, law))
    reach = 1.1 * max(max(line.x) for line in lines)
    values = ", ".join(f"{name} = {value:g}" for name, value in law.items())
    largest = max(float(np.median(line.y)) for line in lines)
    return Pictures(
        svg("profile g(x)", "x", "g", [_profile(sheet, own, reach)]),
        svg("contact pressure p(x)", "x", "p", lines, top=4 * largest),
        tuple(line.label for line in lines),
        values,
    )


def _profile(sheet: FormulaSheet, own: dict[str, float], reach: float) -> Line:
    places = np.linspace(-reach, reach, SAMPLES)
    names = [q.symbol for q in sheet.geometry.parameters]
    g = compiled([x, *names], sheet.geometry.g, modules="numpy")
    with np.errstate(all="ignore"):
        values = np.broadcast_to(g(places, *(own[str(n)] for n in names)), places.shape)
    there = np.isfinite(values)
    return Line("g", places[there].tolist(), values[there].tolist())


def _pressures(module: Any, half: float, law: dict[str, float]) -> Iterator[Line]:
    load = float(module.load(half, half, **law))
    for part, turn, label in CONTACTS:
        state = module.contact(part * load, turn * part * load * half, **law)
        if not np.isfinite(state.a):
            continue
        angle = np.linspace(0, np.pi, SAMPLES)
        h = state.a + state.c
        places = (state.c - state.a) / 2 - h / 2 * np.cos(angle)
        p = module.pressure(places, state.a, state.c, **law)
        p[[0, -1]] = 0.0
        there = np.isfinite(p)
        yield Line(label, places[there].tolist(), p[there].tolist())
