"""Drafts a geometry file; all mistakes in its description are reported before it is written.

In:  a name, g(x) as text, and the units and meanings of the parameters.
Out: the Geometry and the text of the file that defines it.
"""

import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from sympy import Abs

from derive.body.geometry import Geometry, parameter, without_x
from derive.body.library import is_in_library
from derive.codegen.module import formatted
from derive.command.errors import BadName, BadOption, BadProfile, BadUnit, UserError
from derive.command.python_of import code_of
from derive.reading.lengths import units
from derive.reading.profile import parameters, read, tree_of, value
from derive.reading.tree import Tree
from derive.reading.words import refusal
from derive.symbols import RESERVED, x

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
    tree = tree_of(wanted.profile)
    names = tuple(parameters(tree))
    for option, given in (("--unit", wanted.units), ("--meaning", wanted.meanings)):
        _demand_known(option, given, names)
    for unit in wanted.units.values():
        _demand_plain(unit)
    if "x" not in tree.names():
        raise without_x(wanted.name, names)
    if (count := len(names)) > _MOST_PARAMETERS:
        why = f"has {count} parameters, and at most {_MOST_PARAMETERS} are allowed"
        raise BadProfile(wanted.name, why, "replace some of them by numbers")
    described = _described(wanted, tree)
    return Draft(_geometry(wanted, tree, described), _text(wanted, tree, described))


def _demand_known(option: str, given: Mapping[str, str], names: Sequence[str]) -> None:
    """Refuse an option for a name that is not a parameter of g(x)."""
    for name, text in given.items():
        if name not in names:
            raise BadOption(option, f"{name}={text}", _absent(name, names))


def _absent(name: str, names: Sequence[str]) -> str:
    known = f"its parameters are {', '.join(names)}" if names else "it has no parameters"
    return f"g(x) has no parameter {name!r}; {known}"


def _demand_plain(unit: str) -> None:
    """Refuse a unit that does not fit on a line of the file."""
    if not unit.isprintable() or len(unit) > _LONGEST_UNIT:
        why = f"it has more than {_LONGEST_UNIT} characters, or characters that cannot be printed"
        raise BadUnit(unit[:_LONGEST_UNIT], why)


_Described = Mapping[str, tuple[str, str]]
"""Meaning and unit of each parameter, in the order of the text."""


def _described(wanted: Wanted, tree: Tree) -> _Described:
    """The meaning and unit of each parameter; a parameter without influence is refused."""
    g = read(wanted.profile)
    units_of = units(g, wanted.units)
    names = parameters(tree)
    for name, column in names.items():
        if name not in units_of:
            raise refusal(wanted.profile, column, f"{name} cancels out of g(x)", "leave it out")
    return {name: (wanted.meanings.get(name, NEUTRAL), units_of[name]) for name in names}


def _geometry(wanted: Wanted, tree: Tree, described: _Described) -> Geometry:
    symbols = {
        name: parameter(name, meaning, unit=unit) for name, (meaning, unit) in described.items()
    }
    try:
        return Geometry(wanted.name, g=value(tree, symbols))
    except UserError:
        raise
    except Exception as error:
        why = "has too many terms" if isinstance(error, RecursionError) else "cannot be evaluated"
        raise _too_large(wanted.name, why) from error


def _too_large(name: str, why: str) -> BadProfile:
    remedy = "write it as polynomials in x on intervals, with Abs, Piecewise, Max, ..."
    return BadProfile(name, why, remedy)


def _text(wanted: Wanted, tree: Tree, described: _Described) -> str:
    """The text of the file, in the form of the files of the library."""
    try:
        profile, imported = code_of(tree)
    except RecursionError as error:
        raise _too_large(wanted.name, "has too many terms") from error
    imports = ", ".join(sorted(imported, key=lambda name: (name.islower(), name)))
    lines = [
        _docstring(wanted.title.strip() or _title(wanted)),
        "",
        *([f"from sympy import {imports}", ""] if imports else []),
        "from derive import Geometry, parameter, x"
        if described
        else "from derive import Geometry, x",
        "",
        *(
            f"{name} = parameter({name!r}, {meaning!r}, unit={unit!r})"
            for name, (meaning, unit) in described.items()
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
