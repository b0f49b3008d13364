"""The pictures on the page of a body: its profile, and the pressure of some contacts.

Lengths are divided by a_0, the contact half-width under a central load P, and pressures by the
mean pressure P/(2 a_0) of that contact.  The pressure is computed by the generated module, imported
from its printed text.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
from markupsafe import Markup
from mpmath import mpf
from sympy import lambdify

from derive.codegen.example import example_of
from derive.codegen.trial import imported
from derive.proof.points import holds
from derive.sheet.built import BuiltBody
from derive.sheet.formulas import FormulaSheet
from derive.sheet.picture import Line, curves, sketch
from derive.symbols import E_star, a, c, x

SAMPLES = 241
CONTACTS = (
    (1.0, 0.0, "P", "-"),
    (0.5, 0.0, "P/2", "--"),
    (1.0, 0.25, "P, and a moment M = P a₀/4", ":"),
)
"""The contacts that are drawn: load over P, moment over load times half-width, label and look."""

OWN = {
    "power": {"k": 1.5},
    "two_radii": {"R_2": 4.0},
    "unequal_wedge": {"phi_2": 0.25},
    "wedge_parabola": {"R": 8.0},
}
"""Parameters for which a picture shows the character of a body better than for those of the
examples, at which the unequal wedge is symmetrical, for instance."""

CLOSE = 2.0 ** -np.arange(5.0, 30.0)
"""Distances from a corner at which the pressure is drawn, divided by the contact width."""

SKETCHED = 1.5
"""The range of x in the sketch of a profile, on either side, in half-widths."""


def pictures(sheet: FormulaSheet, body: BuiltBody) -> dict[str, Any]:
    """What the template figures.html shows of one body.

    profile, pressure  the pictures
    drawn_at           the values of the parameters at which the pictures are drawn
    has_corner         whether the body has a corner, where the pressure is infinite
    """
    half, law = drawn_at(sheet)
    corners = _corners(sheet, law)
    with imported(body.name, body.text, body.stuck) as module:
        lines = tuple(_pressures(module, half, law, corners))
    reach = 1.1 * max(max(line.x) for line in lines)
    top = 4 * max(float(np.median(line.y)) for line in lines)
    return {
        "profile": curves("profile g(x)", "x/a₀", "g/a₀", [_profile(sheet, reach)]),
        "pressure": curves("contact pressure p(x)", "x/a₀", "2 a₀ p/P", lines, top),
        "drawn_at": ", ".join(f"{name} = {value:g}" for name, value in law.items()),
        "has_corner": bool(corners),
    }


def profile(sheet: FormulaSheet) -> Markup:
    """A sketch of the profile alone, for an index."""
    return sketch(f"profile of {sheet.geometry.name}", _profile(sheet, SKETCHED))


def drawn_at(sheet: FormulaSheet) -> tuple[float, dict[str, float]]:
    """The half-width, E_star and the parameters of the body: those of the examples in its module,
    or its OWN."""
    needed = sheet["load"].conditions
    example = example_of(sheet, needed)
    own = OWN.get(sheet.geometry.name, {})
    changed = {q.symbol: mpf(own[q.name]) for q in sheet.geometry.parameters if q.name in own}
    point = example | changed
    if not holds(needed, point):  # a body of the user has this name
        point = example
    law = {q.name: float(point[q.symbol]) for q in sheet.geometry.parameters}
    return float(max(point[a], point[c])), {"E_star": float(point[E_star]), **law}


def _corners(sheet: FormulaSheet, law: dict[str, float]) -> list[float]:
    """Positions of the corners of the body, where the pressure is infinite."""
    kinks = [kink.position for kink in sheet.geometry.slope.kinks if kink.is_corner]
    return [float(at.subs({s: law[str(s)] for s in at.free_symbols})) for at in kinks]


def _profile(sheet: FormulaSheet, reach: float) -> Line:
    half, law = drawn_at(sheet)
    positions = np.linspace(-reach, reach, SAMPLES)
    names = [q.symbol for q in sheet.geometry.parameters]
    g = lambdify([x, *names], sheet.geometry.g, modules="numpy", dummify=True)
    with np.errstate(all="ignore"):
        values = g(half * positions, *(law[str(n)] for n in names)) / half
    values = np.broadcast_to(values, positions.shape)
    finite = np.isfinite(values)
    return Line("g", positions[finite].tolist(), values[finite].tolist())


def _pressures(
    module: Any, half: float, law: dict[str, float], corners: list[float]
) -> Iterator[Line]:
    load = float(module.load(half, half, **law))
    for part, turn, label, look in CONTACTS:
        state = module.contact(part * load, turn * part * load * half, **law)
        if not np.isfinite(state.a):
            continue
        angle = np.linspace(0, np.pi, SAMPLES)
        h = state.a + state.c
        positions = (state.c - state.a) / 2 - h / 2 * np.cos(angle)
        inside = [corner for corner in corners if -state.a < corner < state.c]
        close = [corner + h * np.r_[-CLOSE, CLOSE] for corner in inside]
        more = np.concatenate([*close, inside])
        positions = np.union1d(positions, more[(-state.a < more) & (more < state.c)])
        p = module.pressure(positions, state.a, state.c, **law)
        p[[0, -1]] = 0.0
        p[np.isin(positions, inside)] = np.inf
        known = ~np.isnan(p)
        x_drawn, p_drawn = positions[known] / half, 2 * half * p[known] / load
        yield Line(label, x_drawn, p_drawn, look)
