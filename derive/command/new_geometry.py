"""A new geometry from g(x) given as text; all mistakes are reported before its file is written.

SymPy can take very long for a short text, so that this is done in a process with limits.
"""

import ast
import sys
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

from sympy import Abs, Rational
from sympy.printing.str import StrPrinter

from derive.body.geometry import Geometry, Parameter, parameter, without_x
from derive.body.library import is_in_library
from derive.codegen.module import formatted
from derive.command.errors import BadName, BadProfile, BadUnit, UserError
from derive.command.options import bad_option
from derive.command.processes import Bounds, Report, in_processes, silent
from derive.reading.profile import OF_PROFILES, read
from derive.reading.text import parse
from derive.reading.units import units_of_profile
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


TEXT_LIMITS = Bounds(seconds=60, gigabytes=2)
"""The limits for the text of one g(x); each body of the library takes about a second."""


@dataclass(frozen=True)
class Wanted:
    """A user's description of a new geometry.

    units, meanings: those of the parameters, by name; both are optional
    """

    name: str
    profile: str
    title: str = ""
    units: Mapping[str, str] = field(default_factory=dict)
    meanings: Mapping[str, str] = field(default_factory=dict)


def in_limited_process(wanted: Wanted) -> tuple[Geometry, str]:
    """The same as `new_geometry`; also raises RanAway if a process exceeds TEXT_LIMITS."""
    (made,) = in_processes(new_geometry, [wanted], silent, 1, TEXT_LIMITS)
    return made


def new_geometry(wanted: Wanted, report: Report = silent) -> tuple[Geometry, str]:
    """The geometry that is described, and the text of the file that defines it.

    Raises BadName, BadText, BadOption, BadUnit, OpenUnits, and the exceptions of Geometry.

    >>> print(new_geometry(Wanted("cylinder", "x**2/(2*R)"))[1])
    \"""Profile g(x) = x**2/(2*R).\"""
    <BLANKLINE>
    from derive import Geometry, parameter, x
    <BLANKLINE>
    R = parameter("R", "parameter of the profile", unit="m")
    geometry = Geometry("cylinder", g=x**2 / (2 * R))
    <BLANKLINE>
    """
    report(f"g of {wanted.name!r}", "reading g(x)")
    _demand_name(wanted.name)
    names = parse(wanted.profile, OF_PROFILES).names()
    has_x = names.pop("x", None) is not None
    for option, given in (("--unit", wanted.units), ("--meaning", wanted.meanings)):
        for name, text in given.items():
            if name not in names:
                raise bad_option(option, f"{name}={text}", _absent(name, names))
    for unit in wanted.units.values():
        if not unit.isprintable() or len(unit) > _LONGEST_UNIT:
            why = (
                f"it has more than {_LONGEST_UNIT} characters, or characters that cannot be printed"
            )
            raise BadUnit(repr(unit[:_LONGEST_UNIT]), why)
    if not has_x:
        raise without_x(wanted.name, names)
    if (count := len(names)) > _MOST_PARAMETERS:
        why = f"has {count} parameters, and at most {_MOST_PARAMETERS} are allowed"
        raise BadProfile(wanted.name, why, "replace some of them by numbers")
    symbols = _symbols(wanted, names)
    try:
        geometry = Geometry(wanted.name, g=read(wanted.profile, symbols))
        return geometry, _text(wanted, geometry, symbols.values())
    except UserError:
        raise
    except Exception as error:
        why = "has too many terms" if isinstance(error, RecursionError) else "cannot be evaluated"
        remedy = "write it as polynomials in x on intervals, with Abs, Piecewise, Max, ..."
        raise BadProfile(wanted.name, why, remedy) from error


def _demand_name(name: str) -> None:
    """Raise BadName for a name that a new geometry cannot have."""
    Geometry(name, g=Abs(x))
    if name in RESERVED:
        raise BadName("geometry", name, "is reserved by the theory")
    if name in _MODULES:
        raise BadName("geometry", name, "would hide the Python module of that name")
    if is_in_library(name):
        raise BadName("geometry", name, "is already in the library")


def _absent(name: str, names: Iterable[str]) -> str:
    known = f"its parameters are {', '.join(names)}" if names else "it has no parameters"
    return f"g(x) has no parameter {name!r}; {known}"


def _symbols(wanted: Wanted, names: Mapping[str, int]) -> dict[str, Parameter]:
    """The parameters, in the order of the text; one without influence is refused.

    names: the column of each parameter in the text
    """
    units = units_of_profile(read(wanted.profile), wanted.units)
    for name, column in names.items():
        if name not in units:
            raise refusal(wanted.profile, column, f"{name} cancels out of g(x)", "leave it out")
    meanings = {name: wanted.meanings.get(name, NEUTRAL) for name in names}
    return {name: parameter(name, meanings[name], unit=units[name]) for name in names}


class _Exact(StrPrinter):
    """Prints an expression as Python code, in which a quotient of integers is exact."""

    def _print_Rational(self, expr: Rational) -> str:
        return f"Rational({expr.p}, {expr.q})"


def _text(wanted: Wanted, geometry: Geometry, symbols: Collection[Parameter]) -> str:
    """The text of the file, in the form of the files of the library."""
    profile = _Exact().doprint(geometry.g)
    names = {node.id for node in ast.walk(ast.parse(profile)) if isinstance(node, ast.Name)}
    imported = names - {"x", *(symbol.name for symbol in symbols)}
    imports = ", ".join(sorted(imported, key=lambda name: (name.islower(), name)))
    lines = [
        _docstring(wanted.title.strip() or _title(wanted)),
        "",
        *([f"from sympy import {imports}", ""] if imports else []),
        f"from derive import Geometry, {'parameter, ' if symbols else ''}x",
        "",
        *(f"{s.name} = parameter({s.name!r}, {s.meaning!r}, unit={s.unit!r})" for s in symbols),
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
    is_plain = title.isprintable() and not {*title} & {"\\", '"'}
    return f'"""{title}"""' if is_plain else repr(title)
