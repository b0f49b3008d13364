"""What docstrings of bound functions say: every argument, an example of each."""

import importlib
import inspect
from itertools import pairwise

import pytest

from derive.library import library, load_geometry
from generated.runtime.cycle import CYCLE, EXPLAINING, SOLVED
from generated.runtime.history.public import HISTORIES
from generated.runtime.words import EXAMPLES, MEANINGS, sentence
from tests.runtime.test_body import bound


@pytest.mark.parametrize("name", library())
def test_docstrings_tell_of_every_argument(name: str) -> None:
    own = {q.name: q for q in load_geometry(name).parameters}
    for function in bound(importlib.import_module(f"generated.{name}")).values():
        lines = function.__doc__.splitlines()
        told = {
            line.partition(" : ")[0]: below.strip()
            for line, below in pairwise(lines)
            if " : " in line and below.startswith("    ")
        }
        for argument, p in inspect.signature(function).parameters.items():
            assert argument in told
            if argument in own:
                meaning = f"{own[argument].meaning} [{own[argument].unit}]"
                assert told[argument] == sentence(meaning)
                assert p.kind is p.KEYWORD_ONLY and p.default is p.empty
        assert f"Derived from derive/geometries/{name}.py." in function.__doc__


def test_there_is_an_example_and_a_meaning_of_everything() -> None:
    functions = (*SOLVED, *CYCLE, *EXPLAINING, *HISTORIES)
    assert EXAMPLES.keys() == {function.__name__ for function in functions}
    for function in functions:
        assert {*[*inspect.signature(function).parameters][1:]} <= MEANINGS.keys()
