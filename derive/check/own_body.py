"""Provide the body that a claims file names or defines, without executing anything.

In:   the entry `body`: a name of the library, a table with g, or the name of a geometry file.
Out:  the ProvenBody, or None for "none".
"""

import ast
from functools import cache
from pathlib import Path

from derive.body.library import is_in_library, library
from derive.check.bodies import ProvenBody, of_library
from derive.check.schema import OwnBody, Place, record
from derive.command.errors import BadFormula, BadGeometryFile, BadText, UserError
from derive.command.files import Unreadable, bytes_of
from derive.command.new_geometry import new_geometry
from derive.command.processes import Report, in_processes
from derive.command.wanted import TEXT_LIMITS, Wanted

_LARGEST = 50_000
"""The largest size of a geometry file, in bytes."""


def body_of(given: object, place: Place) -> ProvenBody | None:
    """Return the body of a file or of a claim; raises UserError."""
    if given is None or given == "none":
        return None
    here = place.inside("body")
    if isinstance(given, dict):
        own = record(OwnBody, given, here)
        profile, units, remedy = own.g, own.units, "correct g or the units"
    elif isinstance(given, str) and is_in_library(given):
        return of_library(given)
    elif isinstance(given, str) and given.endswith(".py"):
        remedy = "correct the geometry file, or write g here"
        try:
            profile, units = profile_of(Path(place.file).parent / given)
        except UserError as error:
            raise here.bad(error.message, remedy) from error
    else:
        known = ", ".join(library())
        remedy = f"write one of {known}, a geometry file, or {{ g = 'x**2/(2*R)' }}"
        raise place.bad(f"body = {given!r} is not in the library", remedy)
    try:
        return _derived(profile, tuple(sorted((name, str(unit)) for name, unit in units.items())))
    except BadText as error:
        raise BadFormula(str(here), profile, error.column, error.why, error.remedy) from error
    except UserError as error:
        raise here.bad(error.message, remedy) from error


@cache
def _derived(profile: str, units: tuple[tuple[str, str], ...]) -> ProvenBody:
    """Return a body whose profile is text.

    It is first derived in another process, because SymPy can run without end or abort.
    """
    wanted = Wanted("own_body", profile, units=dict(units))
    in_processes(_derive, [wanted], lambda *_: None, 1, TEXT_LIMITS)
    return ProvenBody(new_geometry(wanted)[0])


def _derive(wanted: Wanted, report: Report) -> None:
    """Read and derive a body, without a result."""
    report("g(x)", "reading")
    geometry, _ = new_geometry(wanted)
    report("g(x)", "deriving")
    ProvenBody(geometry)


def profile_of(path: Path) -> tuple[str, dict[str, str]]:
    """Return g(x) as text, and the units of its parameters by name, from a geometry file.

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
        match statement:
            case ast.Assign([ast.Name(name), *_], ast.Call(ast.Name("parameter")) as call):
                units[name] = _unit(call, name, path)
            case ast.Assign(_, ast.Call(ast.Name("Geometry"), _, keywords)):
                profiles += [ast.unparse(each.value) for each in keywords if each.arg == "g"]
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
