"""The pictures on the page of a body: its profile, and the pressure of some contacts.

Lengths are divided by a_0, the contact half-width under a central load P, and pressures by the
mean pressure P/(2 a_0) of that contact.  The pressure is computed by the generated module, imported
from its printed text.
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
"""The contacts that are drawn: load over P, moment over load times half-width, and label."""

SKETCHED = 1.5
"""The range of x in the sketch of a profile, on either side, in half-widths."""


class Pictures(NamedTuple):
    """The pictures of one body.

    labels     the labels of the pressure curves
    drawn_at   the values of the parameters at which the pictures are drawn
    """

    profile: Markup
    pressure: Markup
    labels: tuple[str, ...]
    drawn_at: str


def pictures(sheet: FormulaSheet, body: Body) -> Pictures:
    """The pictures of one body, drawn at the values of the examples in the module."""
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
    """A sketch of the profile alone, for an index."""
    return sketch(f"profile of {sheet.geometry.name}", _profile(sheet, SKETCHED))


def _drawn_at(sheet: FormulaSheet) -> tuple[float, dict[str, float]]:
    """The half-width, and E_star and the parameters of the body, in the examples of the module."""
    point = example_of(sheet, sheet["load"].conditions)
    own = {q.name: float(point[q.symbol]) for q in sheet.geometry.parameters}
    return float(max(point[a], point[c])), {"E_star": float(point[E_star]), **own}


def _profile(sheet: FormulaSheet, reach: float) -> Line:
    half, law = _drawn_at(sheet)
    positions = np.linspace(-reach, reach, SAMPLES)
    names = [q.symbol for q in sheet.geometry.parameters]
    g = compiled([x, *names], sheet.geometry.g, modules="numpy")
    with np.errstate(all="ignore"):
        values = g(half * positions, *(law[str(n)] for n in names)) / half
    values = np.broadcast_to(values, positions.shape)
    finite = np.isfinite(values)
    return Line("g", positions[finite].tolist(), values[finite].tolist())


def _pressures(module: Any, half: float, law: dict[str, float]) -> Iterator[Line]:
    load = float(module.load(half, half, **law))
    for part, turn, label in CONTACTS:
        state = module.contact(part * load, turn * part * load * half, **law)
        if not np.isfinite(state.a):
            continue
        angle = np.linspace(0, np.pi, SAMPLES)
        h = state.a + state.c
        positions = (state.c - state.a) / 2 - h / 2 * np.cos(angle)
        p = module.pressure(positions, state.a, state.c, **law)
        p[[0, -1]] = 0.0
        finite = np.isfinite(p)
        x_drawn, p_drawn = positions[finite] / half, 2 * half * p[finite] / load
        yield Line(label, x_drawn.tolist(), p_drawn.tolist())
