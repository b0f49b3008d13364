"""The benchmark runs, and compares functions that compute the same thing."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import _arrays, wedge
from tests.benchmarks.alone import Alone
from tests.benchmarks.cases import CASES, CSE, FLOOR, GENERATED, PLAIN, Case
from tests.benchmarks.picture import draw
from tests.benchmarks.speed import (
    COMPILED,
    beside,
    curves,
    cut_or_not,
    measured,
    page,
    parts,
    printed_calls,
    uncut,
)
from tests.benchmarks.timing import Call, interleaved, peak_over_result, size_of, timed
from tests.paper_forms import FORMS

PRINTED = [(body, function) for body, functions in FORMS.items() for function in functions]


@pytest.mark.parametrize(("body", "function"), PRINTED)
def test_the_three_agree(body: str, function: str) -> None:
    """To the digits that the paper's form keeps in the bulk."""
    generated, plain, cse = (call() for call in printed_calls(body, function, 500))
    fields = list(FORMS[body][function])
    for i, field in enumerate(fields):
        ours = getattr(generated, field) if field else generated
        for theirs in (plain, cse):
            assert_allclose(ours, theirs[i] if len(fields) > 1 else theirs, rtol=1e-8)
        assert np.all(np.isfinite(ours))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_contenders_agree(case: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those written by hand run uncompiled, so that nothing needs numba."""
    monkeypatch.setattr("tests.benchmarks.by_hand.compiler", lambda: lambda function: function)
    data = case.data(12)
    found = {name: case.contenders[name](data)() for name in case.names()}
    ours = found.pop(GENERATED)
    ours = ours[:2] if isinstance(ours, tuple) else (ours,)
    assert all(np.all(np.isfinite(v)) for v in ours)
    found.pop(FLOOR)
    for name, theirs in found.items():
        if "order" in name:  # the series is another
            continue
        theirs = theirs if isinstance(theirs, list | tuple) or np.ndim(theirs) > 1 else (theirs,)
        for mine, other in zip(ours, theirs, strict=False):
            assert_allclose(other, mine, rtol=1e-7, err_msg=name)


def test_peak_memory_counts_the_result_and_what_is_held_beside_it() -> None:
    a = np.ones(100_000)
    assert peak_over_result(lambda: a + 1) == pytest.approx(1, abs=0.01)
    assert peak_over_result(lambda: np.sqrt(a + 1) * (a + 2)) == pytest.approx(2, abs=0.01)
    assert size_of((a, [a, a])) == 2_400_000


def test_memory_of_a_large_call_is_its_result() -> None:
    """Blocks hold a few arrays of their own length."""
    x = np.linspace(-0.9e-3, 1.4e-3, 1_000_000)

    def call() -> object:
        return wedge.pressure(x, 1e-3, 1.5e-3, E_star=75e9, phi=0.05)

    assert peak_over_result(call) < 1.1
    with uncut():
        assert peak_over_result(call) > 2


@pytest.fixture
def brief(monkeypatch: pytest.MonkeyPatch) -> None:
    """A measurement may be of few calls."""
    monkeypatch.setattr("tests.benchmarks.speed.AMONG_ITS_LIKE", 1e-4)


def test_blocks_are_switched_off_and_on_again(brief: None) -> None:
    held = _arrays.RESIDENT
    with uncut():
        assert held < 10**15 < _arrays.RESIDENT
    assert held == _arrays.RESIDENT
    assert all(min(pair) > 0 for row in cut_or_not((10,), 0.001).values() for pair in row.values())


def test_a_contender_is_alone_in_its_process(tmp_path: Path) -> None:
    """Neither the generated functions nor any that it is compared with."""
    files = [tmp_path / f"{case.name}.npz" for case in CASES]
    for case, file in zip(CASES, files, strict=True):
        np.savez(file, **case.data(3))
    others = {
        case.name: [n for n in case.names() if GENERATED not in n and n not in COMPILED]
        for case in CASES
    }
    text = f"""
import sys
from pathlib import Path
from tests.benchmarks.alone import built
for file, (case, others) in zip({[*map(str, files)]}, {others}.items()):
    for other in [*others, {FLOOR!r}]:
        built(case, other, Path(file))
print(*sys.modules)
"""
    ran = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    held = {name.partition(".")[0] for name in ran.stdout.split()}
    assert {"numpy", "sympy", "tests"} <= held
    assert not {"generated", "derive", "numba", "numexpr"} & held


@pytest.mark.slow
def test_contenders_are_timed_in_processes_of_their_own(
    brief: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tests.benchmarks.speed.MEMORY_AT", (100,))
    four = {name: CASES[0].contenders[name] for name in (GENERATED, PLAIN, CSE, FLOOR)}
    times, memory = curves(replace(CASES[0], contenders=four), (100,), 0.001)
    assert times.keys() == {GENERATED, PLAIN, CSE, FLOOR}
    assert all([*row] == [100] and row[100] > 0 for row in times.values())
    assert {name for name, row in memory.items() if row} == {GENERATED, PLAIN, CSE}
    assert min(memory[name][100] for name in (GENERATED, PLAIN, CSE)) >= 1


@pytest.mark.slow
def test_contenders_are_timed_beside_the_generated_functions(brief: None) -> None:
    few = replace(CASES[0], contenders={n: CASES[0].contenders[n] for n in (GENERATED, FLOOR)})
    found = beside(few, 100, 0.001)
    assert found.size == 100
    assert found.times.keys() == {GENERATED, FLOOR}
    assert min(found.times.values()) > 0


@pytest.mark.slow
def test_a_contender_that_fails_is_told(tmp_path: Path) -> None:
    """Its own message is on the standard error of both."""
    with pytest.raises(RuntimeError, match=r"generated of wedge\.pressure failed at its data"):
        Alone("wedge.pressure", GENERATED, tmp_path / "none").__enter__()
    file = tmp_path / "data.npz"
    np.savez(file, **CASES[0].data(3))
    with Alone("wedge.pressure", FLOOR, file) as floor:
        floor._process.kill()
        floor._process.wait()
        with pytest.raises(RuntimeError, match=r"one np\.log of wedge\.pressure failed at peak"):
            floor.peak()


def test_calls_are_timed_in_turn() -> None:
    order: list[str] = []
    times = interleaved({"a": lambda: order.append("a"), "b": lambda: order.append("b")}, 1e-6)
    assert [*times] == ["a", "b"]
    turns = [first for first, second in pairwise(order) if first != second]
    assert len(turns) >= 9


class Here:
    """A contender in this process."""

    def __init__(self, call: Call) -> None:
        self.timed, self.peak = partial(timed, call), partial(peak_over_result, call)


@contextmanager
def all_here(case: Case, size: int, beside: str = "") -> Iterator[dict[str, Here]]:
    data = case.data(size)
    yield {name: Here(case.contenders[name](data)) for name in case.names(size)}


@pytest.mark.slow
def test_the_page_holds_every_function(brief: None, monkeypatch: pytest.MonkeyPatch) -> None:
    """In this process alone, which is quicker."""
    monkeypatch.setattr("tests.benchmarks.speed.contenders", all_here)
    monkeypatch.setattr("tests.benchmarks.by_hand.compiler", lambda: lambda function: function)
    told: list[str] = []
    found = measured(10, 0.001, ("hertz",), told.append)
    assert len(told) == parts(("hertz",))
    text = page(found)
    for case in CASES:
        assert f"## {case.name}" in text
        assert found.curves[case.name].keys() >= {GENERATED, FLOOR}
        assert f"| {case.name} | 10 |" in text  # beside generated
    assert all(row.plain > 0 for row in found.printed)
    assert [*found.stages] == ["hertz"]


@pytest.mark.slow
def test_the_picture_is_the_same_for_the_same_figures(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    figures = {case.name: {GENERATED: {1: 1e-6, 10: 2e-6}} for case in CASES}
    for name in ("first.svg", "second.svg"):
        draw(figures, tmp_path / name)
    assert (tmp_path / "first.svg").read_bytes() == (tmp_path / "second.svg").read_bytes()
