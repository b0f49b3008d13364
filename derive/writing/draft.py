"""Drafts a geometry file; all mistakes in its description are reported before it is written.

In:  a name, g(x) as text, and the units and meanings of the parameters.
Out: the Geometry and the text of the file that defines it.
"""

import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from sympy import Abs

from derive.codegen.module import formatted
from derive.errors import BadName, BadOption, BadProfile, BadUnit, UserError
from derive.geometry import Geometry, parameter, without_x
from derive.library import is_in_library
from derive.symbols import RESERVED, x
from derive.writing.grammar import Name, Node, parse
from derive.writing.lengths import units
from derive.writing.meaning import Meaning, names, read, walk
from derive.writing.python import Python
from derive.writing.vocabulary import refusal

NEUTRAL = "parameter of the profile"
"""The meaning of a parameter for which none is given."""

_MOST_PARAMETERS = 40
"""The largest number of parameters of a body."""

_LONGEST_UNIT = 60
_TITLE_WIDTH = 80

_MODULES = sys.stdlib_module_names | {
    *("derive", "generated", "numpy", "numba", "sympy", "mpmath", "click", "rich", "ruff"),
}
"""Modules that a file with the same name would hide."""


@dataclass(frozen=True)
class Wanted:
    """A user's description of a new geometry.

    units, meanings: those of the parameters, by name; both are optional

    Raises BadName.
    """

    name: str
    profile: str
    title: str = ""
    units: Mapping[str, str] = field(default_factory=dict)
    meanings: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        Geometry(self.name, g=Abs(x))  # raises BadName if the name is not allowed
        if self.name in RESERVED:
            raise BadName("geometry", self.name, "is reserved by the theory")
        if self.name in _MODULES:
            raise BadName("geometry", self.name, "would hide the Python module of that name")
        if is_in_library(self.name):
            raise BadName("geometry", self.name, "is already in the library")


@dataclass(frozen=True)
class Draft:
    """A geometry, and the text of the file that defines it."""

    geometry: Geometry
    text: str


def draft(wanted: Wanted) -> Draft:
    """The geometry that is described, and the text of its file.

    Raises BadText, BadOption, BadUnit, OpenUnits, and the exceptions of Geometry.

    >>> print(draft(Wanted("cylinder", "x**2/(2*R)")).text)
    \"""Profile g(x) = x**2/(2*R).\"""
    <BLANKLINE>
    from derive import Geometry, parameter, x
    <BLANKLINE>
    R = parameter("R", "parameter of the profile", unit="m")
    geometry = Geometry("cylinder", g=x**2 / (2 * R))
    <BLANKLINE>
    """
    tree = parse(wanted.profile)
    for option, given in (("--unit", wanted.units), ("--meaning", wanted.meanings)):
        _demand_known(option, given, tuple(names(tree)))
    for unit in wanted.units.values():
        _demand_plain(unit)
    if "x" not in (node.name for node in walk(tree) if isinstance(node, Name)):
        raise without_x(wanted.name, names(tree))
    if (count := len(names(tree))) > _MOST_PARAMETERS:
        why = f"has {count} parameters, and at most {_MOST_PARAMETERS} are allowed"
        raise BadProfile(wanted.name, why, "replace some of them by numbers")
    parameters = _parameters(wanted, tree)
    return Draft(_geometry(wanted, tree, parameters), _text(wanted, tree, parameters))


def _demand_known(option: str, given: Mapping[str, str], parameters: Sequence[str]) -> None:
    """Refuse an option for a name that is not a parameter of g(x)."""
    for name, text in given.items():
        if name not in parameters:
            raise BadOption(option, f"{name}={text}", _absent(name, parameters))


def _absent(name: str, parameters: Sequence[str]) -> str:
    known = f"its parameters are {', '.join(parameters)}" if parameters else "it has no parameters"
    return f"g(x) has no parameter {name!r}; {known}"


def _demand_plain(unit: str) -> None:
    """Refuse a unit that should not be passed to Python's parser."""
    if not unit.isprintable() or len(unit) > _LONGEST_UNIT:
        why = f"it has more than {_LONGEST_UNIT} characters, or characters that cannot be printed"
        raise BadUnit(unit[:_LONGEST_UNIT], why)


Parameters = Mapping[str, tuple[str, str]]
"""Meaning and unit of each parameter, in the order of the text."""


def _parameters(wanted: Wanted, tree: Node) -> Parameters:
    """The meaning and unit of each parameter; a parameter without influence is refused."""
    g = read(wanted.profile)
    units_of = units(g, wanted.units)
    for name, column in names(tree).items():
        if name not in units_of:
            raise refusal(wanted.profile, column, f"{name} cancels out of g(x)", "leave it out")
    return {name: (wanted.meanings.get(name, NEUTRAL), units_of[name]) for name in names(tree)}


def _geometry(wanted: Wanted, tree: Node, parameters: Parameters) -> Geometry:
    symbols = {
        name: parameter(name, meaning, unit=unit) for name, (meaning, unit) in parameters.items()
    }
    try:
        return Geometry(wanted.name, g=Meaning(wanted.profile, symbols).value(tree))
    except UserError:
        raise
    except Exception as error:
        raise BadProfile(
            wanted.name,
            "has too many terms" if isinstance(error, RecursionError) else "cannot be evaluated",
            "write it as polynomials in x on intervals, with Abs, Piecewise, Max, ...",
        ) from error


def _text(wanted: Wanted, tree: Node, parameters: Parameters) -> str:
    """The text of the file, in the form of the files of the library."""
    python = Python()
    profile = python.write(tree).text
    imports = ", ".join(sorted(python.imports, key=lambda name: (name.islower(), name)))
    lines = [
        _docstring(wanted.title.strip() or _title(wanted)),
        "",
        *([f"from sympy import {imports}", ""] if imports else []),
        "from derive import Geometry, parameter, x"
        if parameters
        else "from derive import Geometry, x",
        "",
        *(
            f"{name} = parameter({name!r}, {meaning!r}, unit={unit!r})"
            for name, (meaning, unit) in parameters.items()
        ),
        f"geometry = Geometry({wanted.name!r}, g={profile})",
    ]
    return formatted("\n".join(lines) + "\n")


def _title(wanted: Wanted) -> str:
    formula = " ".join(wanted.profile.split())
    if len(formula) > _TITLE_WIDTH:
        return f"Profile {wanted.name}."
    return f"Profile g(x) = {formula}."


def _docstring(title: str) -> str:
    """A title as a docstring of one line, whatever characters it contains."""
    plain = "".join(_plain(character) for character in title)
    return '"""' + re.sub('"(?="|$)', r"\"", plain) + '"""'


def _plain(character: str) -> str:
    shown = character.isprintable() and character != "\\"
    return character if shown else repr(character)[1:-1]
