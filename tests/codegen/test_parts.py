"""Functions that are sums over the parts of a contact keep their digits beside a kink."""

from functools import cache
from inspect import signature
from random import Random

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from derive.codegen.module import module_text
from derive.proof.points import Point, holds, numeric
from derive.sheet.formulas import FormulaSheet
from derive.symbols import E_star, a, c, x
from tests.codegen.made import module_of
from tests.derive.bodies import assumed
from tests.derive.bodies import of_library as sheet_of

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("short_docstrings")]

BODIES = ("flat_rounded", "rounded_wedge", "two_radii", "wedge_parabola", "flat_sloped")

FORMULAS = {name: (name,) for name in ("tilt", "load", "moment", "pressure")}
FORMULAS |= {name: (f"{name}_left", f"{name}_right") for name in ("K_N", "L_N")}
"""Formulas of the functions that are sums over parts."""


@cache
def text_of(name: str) -> str:
    """The module of a body of the library, made afresh."""
    return module_text(assumed(sheet_of(name)), f"{name}.py")


def contacts(sheet: FormulaSheet, count: int = 8) -> list[Point]:
    """Contacts with edges, and places in them, by 1e-9 of their width and more beside kinks."""
    rng, found = Random(sheet.geometry.name), []
    while len(found) < count:
        h = 10 ** rng.uniform(-1, 1)
        point = {q.symbol: mpf(rng.uniform(0.2, 3)) for q in sheet.geometry.parameters}
        point |= {s: mpf(h * 10 ** rng.uniform(-6, 3)) for s in point if str(s) == "b"}
        places = [float(numeric(kink.position)(point)) for kink in sheet.geometry.slope.kinks]

        def beside(size: float, of: list[float] = places) -> float:
            return rng.choice(of) + rng.choice([-1, 1]) * size * 10 ** rng.uniform(-9, -1)

        left = rng.choice([beside(h), beside(h) - h, rng.choice(places) - h * rng.random()])
        point |= {E_star: mpf(1), a: mpf(-left), c: mpf(left + h)}
        point[x] = mpf(rng.choice([beside(h), left + h * rng.random()]))
        edges = [-point[a], point[c]]
        if not edges[0] < point[x] < edges[1]:
            continue
        gaps = [abs(edge - place) for edge in (*edges, point[x]) for place in places]
        gaps += [abs(point[x] - edge) for edge in edges]
        if min(gaps) > 0.9e-9 * h and holds(sheet["pressure"].conditions, point):
            found.append(point)
    return found


@pytest.mark.enough("wedge_parabola", "rounded_wedge")
@pytest.mark.parametrize("name", BODIES)
def test_digits_are_kept_beside_kinks(name: str) -> None:
    sheet = sheet_of(name)
    points = contacts(sheet)
    given = {str(s): np.array([float(point[s]) for point in points]) for s in points[0]}
    with module_of(text_of(name)) as module:
        functions = {called: getattr(module, called) for called in FORMULAS}
        computed = {
            called: function(**{key: given[key] for key in signature(function).parameters})
            for called, function in functions.items()
        }
    for called, formulas in FORMULAS.items():
        found = computed[called]
        for values, formula in zip(found if len(formulas) > 1 else [found], formulas, strict=True):
            compiled = numeric(sheet.flat(formula))
            for value, point in zip(values, points, strict=True):
                with mpmath.workdps(100):
                    true = compiled(point)
                    scale = abs(true)
                    if formula in ("tilt", "moment"):  # by symmetry these may vanish
                        scale += 1e-3 * abs(numeric(sheet.flat("load"))(point))
                    assert abs(mpf(float(value)) - true) <= 2e-13 * scale, (formula, point)


def test_the_parts_are_printed_with_their_definitions() -> None:
    """P = (E*/2) int g'' w ds is E* h**2/(16 R) times t - sin(t) cos(t) of either side's angle."""
    text = text_of("flat_rounded")
    for line in (
        "P = E_star*h**2*(segment(t_1) + segment(t_3))/(16*R)",
        "t_1 = edge_angle(a - b, b + c)",
        "t_3 = edge_angle(-b + c, a + b)",
        "edge_angle(A, B) = 2*atan2(sqrt(Max(0, A)), sqrt(Max(0, B)))",
        "segment(t) = t - sin(t)*cos(t)",
    ):
        assert f"    {line}\n" in text, line
