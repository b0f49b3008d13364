"""How many arrays a function holds: by hand, and as tracemalloc sees it."""

import importlib
import re
import tracemalloc
from inspect import Parameter, getsource, signature
from typing import Any

import numpy as np
import pytest
from sympy import Expr, Symbol, sqrt

from derive.codegen.contract import CONTRACT
from derive.codegen.function import FunctionText
from derive.codegen.memory import BY_PARTS, LABORIOUS, PRESSURE_BY_PARTS, arrays_held
from derive.codegen.program import Program, Step
from derive.symbols import E_star, a, c, x
from generated import _arrays
from tests.benchmarks.speed import SCALARS, uncut
from tests.derive.bodies import sheet

COUNT = 50_000
"""Long enough for NumPy to compute in the memory of what nothing else refers to."""


@pytest.mark.parametrize(
    ("held", "code"),
    [
        (1, "return a * c"),
        (1, "return a * c + c"),  # the sum in the memory of the product
        (1, "return 2 * a / c - 1"),
        (2, "return a / (a + c)"),  # a quotient does not take the memory of its divisor
        (2, "return np.sqrt(a * c)"),
        (2, "return R * np.exp(a)**2"),
        (2, "return a - a * R"),
        (3, "h = a + c\nreturn Edges(np.sqrt(h), h * a)"),
        (3, "h = a + c\nexists = (h > LEAST) & (R > 0)\nreturn only_where(exists, np.exp(a * h))"),
        (2, "return Edges(*only_where(a > 0, a * c, a / c))"),
        (1, "scale = E_star / R\nreturn scale * a"),  # a number is no array
        (1, "h = a + c\nreturn only_where(h > 0, scaled(h, R))"),
        (2, "h = a + c\nreturn scaled(h, a)"),
        (1, "return maximum(a, 0.0)"),
        (2, "return maximum(a, R)"),
        (4, "u = a + 1\nv = c + 1\nreturn kink_logarithm(u, v, a)"),
        (4, "return select(a > 0, a * c, a / c)"),
        (2, "h = a + c\nreturn h.copy()"),
        (2, "h = a + c\nreturn +h"),
        (1, "# [m]\nh = -(a + c)  # width\nreturn h"),
    ],
)
def test_arrays_are_counted_as_by_hand(held: int, code: str) -> None:
    lines = code.splitlines()
    assert arrays_held(lines, ["a", "c"]) == held
    assert arrays_held([f"    {line}" for line in lines], ["a", "c"]) == held


@pytest.mark.parametrize(
    "code", ["h += a", "if a:\n    h = a", "return [v for v in a]", "a", "h = f(a)"]
)
def test_what_is_not_known_is_not_counted(code: str) -> None:
    with pytest.raises(NotImplementedError):
        arrays_held([code], ["a"])


EXPLICIT = ("tilt", "load", "moment", "pressure", "K_N", "L_N", "K_T", "L_T", "stick_margin")
FORMULAS = [
    *((body, name) for body in ("hertz", "wedge", "unequal_wedge", "quartic") for name in EXPLICIT),
    *((body, name) for body in ("hertz", "wedge") for name in ("contact", "contact_at_tilt")),
]


def _peak(body: str, name: str, *varying: str) -> float:
    """Arrays that a generated function holds at most.

    varying: the arguments that are arrays; without any, those by position.
    """
    function = getattr(importlib.import_module(f"generated.{body}"), name)
    near = np.random.default_rng(5).uniform(0.9, 1.1, COUNT)
    parameters = signature(function).parameters.items()
    varying = varying or tuple(n for n, p in parameters if p.kind is not Parameter.KEYWORD_ONLY)
    given: dict[str, Any] = {n: SCALARS[n] * (near if n in varying else 1) for n, _ in parameters}
    with uncut():
        function(**given)
        tracemalloc.start()
        try:
            before, _ = tracemalloc.get_traced_memory()
            kept = function(**given)
            _, peak = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
    del kept
    return (peak - before) / near.nbytes


def _told(body: str, name: str) -> int:
    """What the function's decorator says."""
    function = getattr(importlib.import_module(f"generated.{body}"), name)
    found = re.match(r"@elementwise\(arrays=(\d+)[,)]", getsource(function))
    assert found
    return int(found[1])


def _told_bare(body: str, name: str) -> list[str]:
    """Arguments which alone leave it nothing to hold but its results, as its decorator says."""
    source = getsource(getattr(importlib.import_module(f"generated.{body}"), name))
    return re.findall(r"\"(\w+)\"", source.splitlines()[0])


@pytest.mark.parametrize(("body", "name"), FORMULAS)
def test_a_formula_holds_what_is_counted(body: str, name: str) -> None:
    """Flags, an eighth of an array each, are held besides."""
    assert _told(body, name) <= _peak(body, name) < _told(body, name) + 0.9


@pytest.mark.parametrize("body", ["wedge", "two_radii", "hyperbola"])
@pytest.mark.parametrize("name", ["K_T", "L_T"])
def test_shear_alone_leaves_nothing_to_hold_but_both_results(body: str, name: str) -> None:
    """dQ/pi is one of them; what the tension gives is subtracted from it, not it from that."""
    assert _told_bare(body, name) == ["dQ"]
    assert _peak(body, name, "dQ") < 2.1
    assert min(_peak(body, name, other) for other in ("a", "c", "dsigma")) > 2.9


@pytest.mark.parametrize(
    ("body", "name"),
    [("wedge", "K_N"), ("hertz", "contact"), ("hertz", "load"), ("quartic", "K_N")],
)
def test_elsewhere_blocks_save_something(body: str, name: str) -> None:
    assert _told_bare(body, name) == []


@pytest.mark.parametrize("body", ["flat_rounded", "rounded_wedge", "two_radii"])
@pytest.mark.parametrize(
    ("name", "many"),
    [
        *((name, LABORIOUS) for name in ("contact", "contact_at_tilt")),
        *((name, BY_PARTS) for name in ("tilt", "load", "moment", "K_N", "L_N")),
        ("pressure", PRESSURE_BY_PARTS),
    ],
)
def test_a_block_of_what_is_laborious_stays_in_the_heap(body: str, name: str, many: int) -> None:
    """Blocks hold half of what the heap keeps, by what the function is taken for."""
    assert _told(body, name) == many
    assert 0.5 * many < _peak(body, name) < 2 * many


@pytest.mark.slow
@pytest.mark.enough("contact")
@pytest.mark.parametrize("name", ["contact", "contact_at_tilt"])
def test_what_is_integrated_holds_three_times_as_many_at_most(name: str) -> None:
    assert _told("hyperbola", name) == LABORIOUS
    assert _peak("hyperbola", name) < 3 * LABORIOUS


@pytest.mark.parametrize("many", [LABORIOUS, BY_PARTS, PRESSURE_BY_PARTS])
def test_blocks_of_what_is_laborious_are_the_longer_ones(many: int) -> None:
    assert many > _arrays.FEW
    assert many * _arrays.BLOCK < _arrays.RESIDENT // 2


# ------------------------------------------------------------------ whose memory is used up

t = Symbol("t")
ROOT_OF_X = Step(t, sqrt(x**2 + c**2), "")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("value", "step", "line"),
    [
        (E_star * t, ROOT_OF_X, "return only_where(exists, scaled_at_last(t, E_star))"),
        (E_star * t, Step(t, x, ""), "return only_where(exists, t * E_star)"),  # the caller's
        (t, ROOT_OF_X, "return only_where(exists, t)"),
        (sqrt(t), Step(t, E_star * (a + x), ""), "t = scaled(a + x, E_star)"),
        (sqrt(t), Step(t, a + x, ""), "t = a + x"),
        (sqrt(t), Step(t, E_star * sqrt(x), ""), "t = E_star * np.sqrt(x)"),
    ],
)
def test_only_what_a_formula_has_made_itself_is_used_up(value: Expr, step: Step, line: str) -> None:
    pressure = next(function for function in CONTRACT if function.name == "pressure")
    made = FunctionText(sheet("wedge"), pressure, "")
    made.program = Program({"": value}, (step,))
    assert f"    {line}" in made.text.splitlines()
