"""A program is its outputs, however they are cut into steps."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from sympy import Max, Rational, Symbol, cos, log, sin, sqrt, symbols

from derive.codegen.program import Kept, Program, Step
from derive.theory.segments import kink_logarithm

x, y = symbols("x y", real=True)
r, s, t = symbols("r s t", positive=True)

CIRCLE = Program(
    {"height": t + y, "width": 2 * s},
    (Step(t, sqrt(s), "root"), Step(r, x * y, "never needed"), Step(s, x**2 + y**2, "square")),
)
"""Steps out of order, one of them without use."""


@contextmanager
def at_most(seconds: int) -> Iterator[None]:
    """Fail rather than hang."""

    def give_up(*_: object) -> None:
        pytest.fail(f"not done after {seconds} s")

    before = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def test_a_flat_program_holds_no_step() -> None:
    assert CIRCLE.flat() == {"height": sqrt(x**2 + y**2) + y, "width": 2 * x**2 + 2 * y**2}


def test_a_program_without_steps_is_flat() -> None:
    assert Program({"": x + y}).flat() == {"": x + y}


def test_a_flat_logarithm_asks_nothing_of_its_lengths() -> None:
    """SymPy takes a + x times a quotient that may not be finite for no real number."""
    a, c = symbols("a c", real=True)
    share, other = (Kept(2 * Max(0, edge - t) / (a + c)) for edge in (c, a))
    left, right = a * share + x * share, c * other - x * other
    flat = Program({"": kink_logarithm(left, right, t - x)}).flat()[""].doit()
    at = {a: 3, c: 2, x: 1, t: Rational(1, 2)}  # left 12/5, right 1
    assert abs(flat.subs(at).evalf() - log(1 + 2 * (sqrt(Rational(12, 5)) + 1)).evalf()) < 1e-12


def test_steps_come_after_those_they_need() -> None:
    assert [step.symbol for step in CIRCLE.ordered().steps] == [s, t]


def test_only_steps_that_some_output_needs_remain() -> None:
    assert Program({"": x}, CIRCLE.steps).ordered().steps == ()


def test_ordering_changes_no_output_and_no_step() -> None:
    ordered = CIRCLE.ordered()
    assert ordered.outputs == CIRCLE.outputs
    assert ordered.flat() == CIRCLE.flat()
    assert set(ordered.steps) < set(CIRCLE.steps)
    assert ordered.ordered() == ordered


def test_the_order_does_not_depend_on_the_order_given() -> None:
    backwards = Program(CIRCLE.outputs, CIRCLE.steps[::-1])
    assert backwards.ordered() == CIRCLE.ordered()


def test_a_change_reaches_outputs_and_steps() -> None:
    turned = CIRCLE.mapped(lambda expr: expr.subs(y, 3))
    assert turned.flat() == {"height": sqrt(x**2 + 9) + 3, "width": 2 * x**2 + 18}
    assert CIRCLE.flat()["width"].has(y)


def test_a_new_step_takes_its_expression_s_place() -> None:
    program = Program({"": sin(x + y) + cos(x + y)}).with_steps(Step(s, x + y, "sum"))
    assert program.outputs[""] == sin(s) + cos(s)
    assert program.flat()[""] == sin(x + y) + cos(x + y)


def test_a_new_step_takes_its_place_in_steps_too() -> None:
    program = Program({"": t}, (Step(t, sin(x + y), ""),)).with_steps(Step(s, x + y, "sum"))
    assert program.steps[0].expr == sin(s)
    assert program.flat() == {"": sin(x + y)}


def test_a_later_new_step_may_use_an_earlier_one() -> None:
    program = Program({"": sin(x + y) ** 2})
    program = program.with_steps(Step(s, x + y, "sum"), Step(t, sin(s), "its sine"))
    assert program.outputs[""] == t**2
    assert program.flat() == {"": sin(x + y) ** 2}


def test_a_new_step_that_nothing_holds_is_no_harm() -> None:
    program = Program({"": x}).with_steps(Step(s, x + y, "sum"))
    assert program.flat() == {"": x}
    assert program.ordered().steps == ()


@pytest.mark.parametrize("taken", [["s"], ["t"], ["s", "t"], ["s", "t", "r", "unheard_of"]])
def test_a_renamed_program_computes_the_same(taken: list[str]) -> None:
    renamed = CIRCLE.renamed(taken)
    assert renamed.flat() == CIRCLE.flat()
    assert {str(step.symbol) for step in renamed.steps}.isdisjoint(taken)


def test_renaming_leaves_other_steps_alone() -> None:
    assert CIRCLE.renamed(["x", "y", "phi"]) == CIRCLE
    kept = {str(step.symbol) for step in CIRCLE.renamed(["s"]).steps}
    assert {"t", "r"} < kept


def test_renaming_evades_a_new_name_that_is_taken_as_well() -> None:
    """Two parameters s and s_ leave neither name to a step."""
    s_ = Symbol("s_", positive=True)
    program = Program({"": s * s_}, (Step(s, x**2, ""),))
    with at_most(20):
        renamed = program.renamed(["s", "s_"])
        assert {str(step.symbol) for step in renamed.steps}.isdisjoint({"s", "s_"})
        assert renamed.flat() == {"": x**2 * s_}


def test_renaming_evades_the_other_steps() -> None:
    s_ = Symbol("s_", positive=True)
    program = Program({"": s * s_}, (Step(s, x**2, ""), Step(s_, y**2, "")))
    with at_most(20):
        renamed = program.renamed(["s"])
        assert len({step.symbol for step in renamed.steps}) == 2
        assert renamed.flat() == {"": x**2 * y**2}
