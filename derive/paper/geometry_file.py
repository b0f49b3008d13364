"""A geometry file as data: g(x) and the units of its parameters, of which nothing is executed.

In:  the path of a Python file as `derive new` writes it.
Out: the text of g(x), and each parameter's unit.
"""

import ast
from pathlib import Path

from derive.errors import BadGeometryFile
from derive.files import Unreadable, bytes_of

_LARGEST = 50_000
"""Bytes of a geometry file."""


def profile_of(path: Path) -> tuple[str, dict[str, str]]:
    """g(x) as text, and the units of its parameters by name.

    Raises BadGeometryFile for what cannot be read without running it.
    """
    try:
        tree = ast.parse(bytes_of(path, _LARGEST))
    except Unreadable as error:
        raise BadGeometryFile(str(path), str(error)) from error
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise BadGeometryFile(str(path), "is no Python") from error
    units, profiles = dict[str, str](), list[str]()
    for statement in tree.body:
        if not isinstance(statement, ast.Assign) or not isinstance(statement.value, ast.Call):
            continue
        called, target = statement.value, statement.targets[0]
        if ast.unparse(called.func) == "parameter" and isinstance(target, ast.Name):
            units[target.id] = _unit(called, target.id, path)
        elif ast.unparse(called.func) == "Geometry":
            profiles += [ast.unparse(k.value) for k in called.keywords if k.arg == "g"]
    if len(profiles) != 1:
        raise BadGeometryFile(str(path), "has not one `geometry = Geometry(name, g=...)`")
    return profiles[0], units


def _unit(called: ast.Call, name: str, path: Path) -> str:
    """The unit of `name = parameter("name", "meaning", unit="m")`."""
    try:
        given = [ast.literal_eval(argument) for argument in called.args]
        named = {k.arg: ast.literal_eval(k.value) for k in called.keywords}
    except ValueError as error:
        raise BadGeometryFile(str(path), f"computes the words of parameter {name!r}") from error
    if [*given, named.get("name")][0] != name:
        raise BadGeometryFile(str(path), f"calls the parameter {name!r} otherwise in Python")
    return str(named.get("unit", "m"))
