"""What a page draws of a body: its profile, and the pressure of some of its contacts.

Lengths are drawn in parts of the half-width a_0 under a load P that is central, pressures in parts
of the mean pressure P/(2 a_0) there.  The pressure is that of the generated module, imported as it
was printed.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from markupsafe import Markup

from derive.body import Body
from derive.codegen.function import example_of
from derive.codegen.trial import imported
from derive.compiled import compiled
from derive.handbook.picture import Line, sketch, svg
from derive.sheet import FormulaSheet
from derive.symbols import E_star, a, c, x

SAMPLES = 241
CONTACTS = ((1.0, 0.0, "P"), (0.5, 0.0, "P/2"), (1.0, 0.25, "P, and a moment M = P a₀/4"))
"""Load in parts of the first, moment in parts of load and half-width, and what is said of them."""

SKETCHED = 1.5
"""How far a sketch of a profile reaches, in half-widths."""


class Pictures(NamedTuple):
    """Of one body; `drawn_at` says at which numbers, `labels` what the curves of pressure are."""

    profile: Markup
    pressure: Markup
    labels: tuple[str, ...]
    drawn_at: str


def pictures(sheet: FormulaSheet, body: Body) -> Pictures:
    """Drawn at the plain numbers of the module's own examples."""
    half, law = _drawn_at(sheet)
    with imported(body.name, body.text, body.stuck) as module:
        lines = tuple(_pressures(module, half, law))
    reach = 1.1 * max(max(line.x) for line in lines)
    values = ", ".join(f"{name} = {value:g}" for name, value in law.items())
    largest = max(float(np.median(line.y)) for line in lines)
    return Pictures(
        svg("profile g(x)", "x/a₀", "g/a₀", [_profile(sheet, reach)]),
        svg("contact pressure p(x)", "x/a₀", "2 a₀ p/P", lines, top=4 * largest),
        tuple(line.label for line in lines),
        values,
    )


def profile(sheet: FormulaSheet) -> Markup:
    """The profile alone, for an index."""
    return sketch(f"profile of {sheet.geometry.name}", _profile(sheet, SKETCHED))


def _drawn_at(sheet: FormulaSheet) -> tuple[float, dict[str, float]]:
    """The half-width, and the modulus and the body's parameters, of the module's own examples."""
    point = example_of(sheet, sheet["load"].conditions)
    own = {q.name: float(point[q.symbol]) for q in sheet.geometry.parameters}
    return float(max(point[a], point[c])), {"E_star": float(point[E_star]), **own}


def _profile(sheet: FormulaSheet, reach: float) -> Line:
    half, law = _drawn_at(sheet)
    places = np.linspace(-reach, reach, SAMPLES)
    names = [q.symbol for q in sheet.geometry.parameters]
    g = compiled([x, *names], sheet.geometry.g, modules="numpy")
    with np.errstate(all="ignore"):
        values = g(half * places, *(law[str(n)] for n in names)) / half
    values = np.broadcast_to(values, places.shape)
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
        x_drawn, p_drawn = places[there] / half, 2 * half * p[there] / load
        yield Line(label, x_drawn.tolist(), p_drawn.tolist())
