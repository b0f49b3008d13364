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
    assert Program({"": x + y}).flat() == {"": x + y}


def test_a_flat_logarithm_asks_nothing_of_its_lengths() -> None:
    """SymPy takes a + x times a quotient that may not be finite for no real number."""
    a, c = symbols("a c", real=True)
    share, other = (Kept(2 * Max(0, edge - t) / (a + c)) for edge in (c, a))
    left, right = a * share + x * share, c * other - x * other
    flat = Program({"": kink_logarithm(left, right, t - x)}).flat()[""].doit()
    at = {a: 3, c: 2, x: 1, t: Rational(1, 2)}  # left 12/5, right 1
    assert abs(flat.subs(at).evalf() - log(1 + 2 * (sqrt(Rational(12, 5)) + 1)).evalf()) < 1e-12


def test_steps_that_are_needed_come_after_those_they_need() -> None:
    """Whatever the order given; ordering changes no output and no step."""
    ordered = CIRCLE.ordered()
    assert [step.symbol for step in ordered.steps] == [s, t]
    assert set(ordered.steps) < set(CIRCLE.steps)
    assert ordered.outputs == CIRCLE.outputs and ordered.flat() == CIRCLE.flat()
    assert ordered == ordered.ordered() == Program(CIRCLE.outputs, CIRCLE.steps[::-1]).ordered()
    assert Program({"": x}, CIRCLE.steps).ordered().steps == ()


def test_a_change_reaches_outputs_and_steps() -> None:
    turned = CIRCLE.mapped(lambda expr: expr.subs(y, 3))
    assert turned.flat() == {"height": sqrt(x**2 + 9) + 3, "width": 2 * x**2 + 18}
    assert CIRCLE.flat()["width"].has(y)


def test_a_new_step_takes_its_expression_s_place_in_outputs_and_steps() -> None:
    """A later one may use an earlier one, and one that nothing holds is no harm."""
    new = Step(s, x + y, "sum")
    program = Program({"": sin(x + y) + cos(x + y)}).with_steps(new)
    assert program.outputs[""] == sin(s) + cos(s)
    assert program.flat()[""] == sin(x + y) + cos(x + y)
    program = Program({"": t}, (Step(t, sin(x + y), ""),)).with_steps(new)
    assert program.steps[0].expr == sin(s)
    assert program.flat() == {"": sin(x + y)}
    program = Program({"": sin(x + y) ** 2}).with_steps(new, Step(t, sin(s), "its sine"))
    assert program.outputs[""] == t**2
    assert program.flat() == {"": sin(x + y) ** 2}
    program = Program({"": x}).with_steps(new)
    assert program.flat() == {"": x} and program.ordered().steps == ()


@pytest.mark.parametrize("taken", [["s"], ["t"], ["s", "t"], ["s", "t", "r", "unheard_of"]])
def test_a_renamed_program_computes_the_same(taken: list[str]) -> None:
    renamed = CIRCLE.renamed(taken)
    assert renamed.flat() == CIRCLE.flat()
    assert {str(step.symbol) for step in renamed.steps}.isdisjoint(taken)


def test_renaming_leaves_other_steps_alone() -> None:
    assert CIRCLE.renamed(["x", "y", "phi"]) == CIRCLE
    kept = {str(step.symbol) for step in CIRCLE.renamed(["s"]).steps}
    assert {"t", "r"} < kept


def test_renaming_evades_a_new_name_that_is_taken_as_well_and_the_other_steps() -> None:
    """Two parameters s and s_ leave neither name to a step."""
    s_ = Symbol("s_", positive=True)
    program = Program({"": s * s_}, (Step(s, x**2, ""),))
    other = Program({"": s * s_}, (Step(s, x**2, ""), Step(s_, y**2, "")))
    with at_most(20):
        renamed = program.renamed(["s", "s_"])
        assert {str(step.symbol) for step in renamed.steps}.isdisjoint({"s", "s_"})
        assert renamed.flat() == {"": x**2 * s_}
        renamed = other.renamed(["s"])
        assert len({step.symbol for step in renamed.steps}) == 2
        assert renamed.flat() == {"": x**2 * y**2}
