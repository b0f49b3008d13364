"""Read g(x) and the units of its parameters from a geometry file without executing the file.

In:  the path of a Python file as written by `derive new`.
Out: the text of g(x), and the unit of each parameter.
"""

import ast
from pathlib import Path

from derive.command.errors import BadGeometryFile
from derive.command.files import Unreadable, bytes_of

_LARGEST = 50_000
"""The largest size of a geometry file, in bytes."""


def profile_of(path: Path) -> tuple[str, dict[str, str]]:
    """Return g(x) as text, and the units of its parameters by name.

    Raises BadGeometryFile if the file cannot be read without executing it.
    """
    try:
        tree = ast.parse(bytes_of(path, _LARGEST))
    except Unreadable as error:
        raise BadGeometryFile(str(path), str(error)) from error
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise BadGeometryFile(str(path), "the file is not valid Python") from error
    units, profiles = dict[str, str](), list[str]()
    for statement in tree.body:
        if not isinstance(statement, ast.Assign) or not isinstance(statement.value, ast.Call):
            continue
        call, target = statement.value, statement.targets[0]
        if ast.unparse(call.func) == "parameter" and isinstance(target, ast.Name):
            units[target.id] = _unit(call, target.id, path)
        elif ast.unparse(call.func) == "Geometry":
            profiles += [ast.unparse(k.value) for k in call.keywords if k.arg == "g"]
    if len(profiles) != 1:
        why = "the file does not have exactly one `geometry = Geometry(name, g=...)`"
        raise BadGeometryFile(str(path), why)
    return profiles[0], units


def _unit(call: ast.Call, name: str, path: Path) -> str:
    """Return the unit given by `name = parameter("name", "meaning", unit="m")`."""
    try:
        given = [ast.literal_eval(argument) for argument in call.args]
        named = {k.arg: ast.literal_eval(k.value) for k in call.keywords}
    except ValueError as error:
        why = f"the arguments of the parameter {name!r} are not all literals"
        raise BadGeometryFile(str(path), why) from error
    if [*given, named.get("name")][0] != name:
        why = f"the parameter {name!r} is assigned to a Python variable of another name"
        raise BadGeometryFile(str(path), why)
    return str(named.get("unit", "m"))
