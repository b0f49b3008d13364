"""Read what a claims file declares for all claims: its body, variables, symbols and spellings.

In:   the decoded file.
Out:  Declarations: the variables with their ranges and units, and the formulas of the symbols.
"""

import re
from collections.abc import Mapping
from typing import Any

from msgspec.structs import replace as with_entries
from sympy import Expr, Symbol

from derive.check.bodies import ProvenBody, body_of
from derive.check.claim import SCALE, Range
from derive.check.meanings import NONE, Standard, standard
from derive.check.mistakes import Collected
from derive.check.schema import (
    Answers,
    ClaimsFile,
    DefinedSymbol,
    Place,
    Record,
    Variable,
    decoded,
)
from derive.command.errors import BadUnit
from derive.reading.formula import usable
from derive.reading.units import Dimension, parse_unit
from derive.symbols import E_star, f, x

PLACES = {"x": x, "s": Symbol("s", real=True), "xi": Symbol("xi", real=True)}
_PREDEFINED = {E_star: parse_unit("Pa"), f: parse_unit("-")}


class Declarations:
    """The declarations of a file.

    place      the file
    seconds    the time limit for reading one formula, and for a verdict
    body       the file's body, or None
    paper      the standard meanings of letters, of which there are none without a table [paper]
    variables  the variables that are declared because of [paper]
    standard   the symbols that have their standard meaning
    proposals  the symbols without a meaning for which there is a proposal
    declared   the variables in [variables] by name
    ranges     the ranges of variables that have one
    units      the units of variables and symbols, as far as the file declares them
    symbols    the formulas in [symbols] by name, without those that are variables
    words      what is said in words of variables and symbols
    spellings  the entries of [latex]
    """

    def __init__(self, file: ClaimsFile, place: Place, errors: Collected) -> None:
        self.place, self.seconds, self.spellings = place, file.seconds, file.latex
        self.body = body_of(file.body, place)  # without it, all else seems wrong
        self.paper = self._paper(file.paper)
        variables = self._decoded(Variable, "variable", file.variables, "meaning", errors)
        symbols = self._decoded(DefinedSymbol, "symbol", file.symbols, "is", errors)
        given = {*file.variables, *(name for name, entry in symbols.items() if entry.text)}
        self.variables = {n: e for n, e in self.paper.variables.items() if n not in given}
        used = {*re.findall(r"[A-Za-z]\w*", f"{file.latex} {file.symbols} {file.claims}")}
        self.standard = {
            name: _completed(symbols.get(name, entry), entry)
            for name, entry in self.paper.of(used, given).items()
        }
        self.declared, self.ranges = dict[str, Symbol](), dict[Symbol, Range]()
        self.units, self.symbols = dict[Symbol, Dimension](), dict[str, str]()
        variables, symbols = self.variables | variables, symbols | self.standard
        for name, variable in variables.items():
            with errors.noted():
                self._declare(name, variable)
        for name, symbol in symbols.items():
            with errors.noted():
                self._define(name, symbol)
        self.proposals = {
            n: e for n, e in symbols.items() if e.proposal and not self.symbols.get(n)
        }
        entries = (*variables.items(), *symbols.items())
        self.words = {name: entry.meaning for name, entry in entries if entry.meaning}
        for spelling, name in file.latex.items():
            with errors.noted():
                demand_name(name, place.at("latex", spelling, f"spelling {spelling!r}"))

    def _paper(self, given: Mapping[str, Any] | None) -> Standard:
        """Return the standard meanings of the paper's letters."""
        if given is None:
            return NONE
        place = self.place.at("paper", 1, "[paper]")
        if self.body is None:
            raise place.bad("it needs a body", "write body = 'hertz' above it")
        return standard(decoded(Answers, given, place), self.body.sheet.geometry, place)

    def _at(self, what: str, name: str) -> Place:
        return self.place.at(f"{what}s", name, f"{what} {name!r}")

    def _decoded(
        self, kind: type[Record], what: str, table: Mapping[str, Any], key: str, errors: Collected
    ) -> dict[str, Record]:
        """Return the entries of a table; one that is no table is its entry `key`."""
        found = dict[str, Record]()
        for name, said in table.items():
            with errors.noted():
                place = self._at(what, name)
                demand_name(name, place)
                found[name] = decoded(kind, said if isinstance(said, dict) else {key: said}, place)
        return found

    def _declare(self, name: str, entry: Variable) -> None:
        """Add a variable with its range; variables of the theory keep their own symbols."""
        is_real = entry.low is not None and entry.low < 0
        known = Symbol(name, real=True) if is_real else Symbol(name, positive=True)
        if name not in self.paper.variables:
            known = self.variables_with(self.body).get(name, known)
        self.declared[name] = known
        self._add_unit(known, entry.unit, self._at("variable", name))
        if entry.low is not None and entry.high is not None:
            self.ranges[known] = Range(entry.low, entry.high)
        elif name in PLACES:
            self.ranges[known] = SCALE

    def _define(self, name: str, entry: DefinedSymbol) -> None:
        """Add the formula of a symbol, unless it is the entry of a variable."""
        place, own = self._at("symbol", name), self._named(self.body) if self.body else {}
        taken = {**own, **self.declared}
        symbol = taken.get(name, Symbol(name))
        if symbol not in self.units and symbol not in own.values():
            self._add_unit(symbol, entry.unit, place)
        if name not in taken or (name in PLACES and entry.text):
            self.symbols[name] = entry.text
        elif entry.text:
            what = "a variable" if name in self.declared else "a parameter of the body"
            raise place.bad(f"it is already {what}", "remove the symbol, or rename one of them")

    def _add_unit(self, symbol: Symbol, unit: str | None, place: Place) -> None:
        if unit is None:
            return
        try:
            self.units[symbol] = parse_unit(unit)
        except BadUnit as error:
            raise place.bad(error.message, "write a unit such as N/m") from error

    # -------------------------------------------------------------- with a body

    def letters_of(self, body: ProvenBody | None) -> dict[Symbol, Symbol]:
        """Return the symbols of the formulas of a body, each with the paper's symbol for it."""
        own = [each.symbol for each in body.sheet.geometry.parameters] if body else []
        names = {
            ours: self.paper.letters.get(ours.name, ours.name) for ours in (*_PREDEFINED, *own)
        }
        return {ours: Symbol(name, positive=True) for ours, name in names.items()}

    def _named(self, body: ProvenBody | None) -> dict[str, Symbol]:
        return {theirs.name: theirs for theirs in self.letters_of(body).values()}

    def variables_with(self, body: ProvenBody | None) -> dict[str, Expr]:
        """Return all variables; parameters of the file's body are always among them."""
        return {**PLACES, **self._named(self.body), **self.declared, **self._named(body)}

    def units_with(self, body: ProvenBody | None) -> dict[Symbol, Dimension]:
        """Return the known units; positions are in metres if there is a body."""
        found = {place: parse_unit("m") for place in PLACES.values() if body}
        for each in (self.body, body):
            own, known = self.letters_of(each), each.sheet.geometry.dimensions if each else {}
            found |= {own.get(s, s): unit for s, unit in (_PREDEFINED | known).items()}
        return {**found, **self.units}


def demand_name(name: str, place: Place) -> None:
    """Refuse a name that a formula cannot hold."""
    why = f"{name!r} is reserved or is not a valid name"
    place.demand(usable(name), why, "use another name of letters, digits and _")


def _completed(entry: DefinedSymbol, standard: DefinedSymbol) -> DefinedSymbol:
    """Return an entry of the file with what it leaves out of the standard meaning."""
    meaning, unit = entry.meaning or standard.meaning, entry.unit or standard.unit
    return with_entries(entry, formula=standard.formula, meaning=meaning, unit=unit)
