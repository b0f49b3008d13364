"""Read the body and the variables of a claims file.

In:   the entry `body` and the table [variables].
Out:  Variables: the ranges and units of all variables, and the context of each body.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path
from typing import Any, TypeGuard

from sympy import Expr, Symbol

from derive.body.library import is_in_library, library
from derive.check.bodies import ProvenBody, of_library
from derive.check.claim import SCALE, Range
from derive.check.context import PLACES, Context
from derive.check.entries import Entries, Place
from derive.check.geometry_file import profile_of
from derive.check.lines import line_of
from derive.check.mistakes import Collected
from derive.command.errors import BadFormula, BadText, BadUnit, UserError
from derive.command.new_geometry import new_geometry
from derive.command.processes import Report, in_processes
from derive.command.wanted import TEXT_LIMITS, Wanted
from derive.reading.formula import usable
from derive.reading.units import Dimension, parse_unit
from derive.symbols import E_star, f

_FAR = 1e6
"""The bounds of a variable's range must be smaller than this in magnitude."""
_FROM_THE_START: Mapping[str, Expr] = {**PLACES, "E_star": E_star, "f": f}
_OF_A_VARIABLE = frozenset({"meaning", "low", "high", "unit"})
_OF_A_BODY = frozenset({"g", "units"})


@dataclass
class Variables:
    """The variables of a file.

    body      the body of the file, or None
    declared  the variables in [variables] by name
    ranges    the ranges of variables that have one
    units     the units that the file declares, also of symbols
    """

    body: ProvenBody | None = None
    declared: dict[str, Expr] = field(default_factory=dict)
    ranges: dict[Symbol, Range] = field(default_factory=dict)
    units: dict[Symbol, Dimension] = field(default_factory=dict)
    _contexts: dict[str, Context] = field(default_factory=dict)

    def of_body(self, given: object, place: Place) -> Context:
        """Return the context of a body that a file or a claim names or defines."""
        key = repr(given)
        if key not in self._contexts:
            body = _body(given, place)
            self._contexts[key] = self.file if body is self.body else self._context(body)
        return self._contexts[key]

    @cached_property
    def file(self) -> Context:
        """The context of the file's body; all variables must have been declared."""
        return self._context(self.body)

    def _context(self, body: ProvenBody | None) -> Context:
        """Return the context of a body; parameters of the file's body are always variables."""
        inherited = self.body.parameters if self.body else {}
        own = body.parameters if body else {}
        variables = {**_FROM_THE_START, **inherited, **self.declared, **own}
        units = self.body.sheet.geometry.dimensions if self.body else {}
        return Context(body, variables, self.units, units)

    def declare(self, name: str, said: object, place: Place) -> None:
        """Add a variable from its entry in [variables]."""
        demand_name(name, place)
        given: dict[str, Any] = said if isinstance(said, dict) else {}
        low, high = given.get("low"), given.get("high")
        if isinstance(said, str) or (given and low is high is None):
            self._add(name, given, SCALE, True, place)
            return
        if not (is_bound(low) and is_bound(high)) or low >= high:
            remedy = "write { low = 0.1, high = 0.9 }, or only its meaning as text"
            raise place.bad("there is no valid range", remedy)
        self._add(name, given, Range(float(low), float(high)), low >= 0, place)

    def _add(
        self, name: str, given: Mapping[str, Any], span: Range, positive: bool, place: Place
    ) -> None:
        """Add a variable with its range; variables of the theory keep their own symbols."""
        known = Symbol(name, positive=True) if positive else Symbol(name, real=True)
        symbol = self._context(self.body).variables.get(name, known)
        assert isinstance(symbol, Symbol)
        self.declared[name] = symbol
        self.say_unit(symbol, given, place)
        if span != SCALE or name in PLACES:
            self.ranges[symbol] = span

    def say_unit(self, symbol: Symbol, given: Mapping[str, Any], place: Place) -> None:
        """Add the unit of a variable or of a symbol, if its entry has one."""
        if "unit" not in given:
            return
        try:
            self.units[symbol] = parse_unit(given["unit"])
        except BadUnit as error:
            raise place.bad(error.message, "write a unit such as N/m") from error


def read_variables(file: Entries, text: str, errors: Collected) -> Variables:
    """Read the body and the variables of a file, and record the errors in them."""
    found = Variables()
    found.body = _body(file.data.get("body"), file.place)  # without it, all else seems wrong
    table = dict[str, Any]()
    with errors.noted():
        table = file.table("variables")
    for name, said in table.items():
        place = Place(file.place.file, line_of(text, "variables", name), f"variable {name!r}")
        if isinstance(said, dict):
            with errors.noted():
                Entries(place, said).demand_known(_OF_A_VARIABLE)
                Entries(place, said).demand_texts("meaning")
        with errors.noted():
            found.declare(name, said, place)
    return found


def demand_name(name: str, place: Place) -> None:
    """Refuse a name that a formula cannot hold."""
    if not usable(name):
        why = f"{name!r} is reserved or is not a valid name"
        raise place.bad(why, "use another name of letters, digits and _")


def is_bound(given: object) -> TypeGuard[float]:
    """Whether an entry may be an end of a range."""
    return type(given) in (int, float) and abs(given) < _FAR  # type: ignore[arg-type]


def _body(given: object, place: Place) -> ProvenBody | None:
    """Return a body of the library, of a geometry file or of a table with g; None for "none"."""
    if given is None or given == "none":
        return None
    here = place.inside("body")
    if isinstance(given, dict):
        entries = Entries(here, given)
        entries.demand_known(_OF_A_BODY)
        profile, units = entries.text("g"), entries.table("units")
        try:
            return _own_body(profile, tuple(sorted((n, str(unit)) for n, unit in units.items())))
        except BadText as error:
            at = str(here)
            raise BadFormula(at, profile, error.column, error.why, error.remedy) from error
        except UserError as error:
            raise here.bad(error.message, "correct g or the units") from error
    if isinstance(given, str) and given.endswith(".py"):
        try:
            profile, units = profile_of(Path(place.file).parent / given)
            return _own_body(profile, tuple(sorted(units.items())))
        except UserError as error:
            raise here.bad(error.message, "correct the geometry file, or write g here") from error
    if not isinstance(given, str) or not is_in_library(given):
        known = ", ".join(library())
        remedy = f"write one of {known}, a geometry file, or {{ g = 'x**2/(2*R)' }}"
        raise place.bad(f"body = {given!r} is not in the library", remedy)
    return of_library(given)


@cache
def _own_body(profile: str, units: tuple[tuple[str, str], ...]) -> ProvenBody:
    """Return a body whose profile is text in the claims file, which is never executed.

    It is first derived in another process, because SymPy can run without end or abort.
    """
    wanted = Wanted("own_body", profile, units=dict(units))
    in_processes(_derived, [wanted], lambda *_: None, 1, TEXT_LIMITS)
    return ProvenBody(new_geometry(wanted)[0])


def _derived(wanted: Wanted, report: Report) -> None:
    """Read and derive a body, without a result."""
    report("g(x)", "reading")
    geometry, _ = new_geometry(wanted)
    report("g(x)", "deriving")
    ProvenBody(geometry)
