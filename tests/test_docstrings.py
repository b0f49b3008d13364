"""Docstrings of all public functions and classes: sections for arguments, results and errors."""

import importlib
import inspect
import re
from collections.abc import Iterator
from typing import Any

import pytest

from derive.body.library import library

HOMES = ("derive", "derive.plot", "generated.edge", *(f"generated.{name}" for name in library()))


def public() -> Iterator[tuple[str, Any]]:
    """All public functions and classes, by the name of their module and their own."""
    for home in HOMES:
        module = importlib.import_module(home)
        for name in module.__all__:
            if callable(each := getattr(module, name)) and not hasattr(each, "free_symbols"):
                yield f"{home}.{name}", each


PUBLIC = dict(public())


def sections(docstring: str) -> dict[str, str]:
    """The text of every section of a numpydoc docstring, by its title; the first has none."""
    title, *rest = re.split(r"^([A-Z]\w+)\n-{3,}$", docstring, flags=re.M)
    return {"": title, **dict(zip(rest[::2], rest[1::2], strict=True))}


def entries(section: str) -> set[str]:
    """The names that a section describes."""
    heads = re.findall(r"^(?!\s)([^:\n]+?)(?: : .*|\n {4}\S.*)$", section, re.M)
    return {name for head in heads for name in head.split(", ")}


def returns_nothing(each: Any) -> bool:
    return inspect.signature(each).return_annotation is None


@pytest.mark.parametrize("name", PUBLIC)
def test_a_docstring_describes_every_argument_and_the_result(name: str) -> None:
    each = PUBLIC[name]
    docstring = inspect.getdoc(each) or ""
    found = sections(docstring)
    assert found[""].strip().splitlines()[0].endswith("."), docstring
    if inspect.isclass(each) and issubclass(each, Warning):
        return
    if "Attributes" in found:
        fields = getattr(each, "_fields", None) or each.__members__
        assert {*fields} == entries(found["Attributes"])
        return
    given = inspect.signature(each).parameters.values()
    stars = {inspect.Parameter.VAR_KEYWORD: "**", inspect.Parameter.VAR_POSITIONAL: "*"}
    asked = {f"{stars.get(p.kind, '')}{p.name}" for p in given}
    assert asked == entries(found.get("Parameters", ""))
    if not (inspect.isclass(each) or returns_nothing(each)):
        assert found["Returns"].strip()
    if name.startswith(("generated.wedge", "generated.edge")) and not inspect.isclass(each):
        assert ">>>" in found["Examples"]
        assert entries(found.get("Raises", "")) <= {"TypeError", "ValueError"}
