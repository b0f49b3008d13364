"""Read what a claims file declares for all claims: its body, variables, symbols and spellings.

In:   the decoded file.
Out:  Declarations: the ranges of variables, and the context of each claim.
"""

import re
from collections.abc import Mapping
from contextlib import suppress
from types import MappingProxyType
from typing import Any

from sympy import Expr, Symbol

from derive.check.bodies import ProvenBody, body_of
from derive.check.claim import SCALE, Range
from derive.check.context import PLACES, Context, Meant
from derive.check.meanings import NONE, Standard, standard
from derive.check.mistakes import Collected
from derive.check.schema import (
    Answers,
    ClaimsFile,
    DefinedSymbol,
    Formula,
    Place,
    Variable,
    decoded,
)
from derive.command.errors import BadUnit, UserError
from derive.reading.formula import usable
from derive.reading.units import Dimension, parse_unit
from derive.symbols import E_star, f

_PREDEFINED = {"E_star": E_star, "f": f}


class Declarations:
    """The declarations of a file.

    place      the file
    seconds    the time limit for reading one formula, and for a verdict
    body       the file's body, or None
    paper      the standard meanings of letters, of which there are none without a table [paper]
    variables  the entries of variables that are declared because of [paper]
    standard   the entries of symbols that have their standard meaning
    proposals  the entries of symbols without a meaning for which there is a proposal
    declared   the variables in [variables] by name
    ranges     the ranges of variables that have one
    units      the units of variables and symbols, as far as the file declares them
    symbols    the formulas in [symbols] by name, without those that are variables
    words      what is said in words of variables and symbols
    spellings  the entries of [latex]
    """

    def __init__(self, file: ClaimsFile, place: Place, errors: Collected) -> None:
        self.place, self.seconds = place, file.seconds
        self.body = body_of(file.body, place)  # without it, all else seems wrong
        self.declared, self.ranges = dict[str, Symbol](), dict[Symbol, Range]()
        self.units, self.symbols = dict[Symbol, Dimension](), dict[str, str]()
        self.words = dict[str, str]()
        self.spellings = file.latex
        self._contexts = dict[tuple[object, ...], Context]()
        self.paper = self._paper(file.paper)
        given = {*file.variables, *(n for n, said in file.symbols.items() if not _is_open(said))}
        self.variables = {n: said for n, said in self.paper.variables.items() if n not in given}
        used = {*re.findall(r"[A-Za-z]\w*", f"{file.latex} {file.symbols} {file.claims}")}
        own = {name: said for name, said in file.symbols.items() if isinstance(said, dict)}
        self.standard = {
            name: entry | own.get(name, {}) | {"is": entry["is"]}
            for name, entry in self.paper.of(used, given).items()
        }
        for name, said in (self.variables | file.variables).items():
            with errors.noted():
                self._declare(name, said)
        for name, said in (file.symbols | self.standard).items():
            with errors.noted():
                self._define(name, said)
        proposed = {n: said for n, said in own.items() if said.get("proposal")}
        self.proposals = {n: said for n, said in proposed.items() if not self.symbols.get(n)}
        with errors.noted():
            for spelling, name in file.latex.items():
                why = f"[latex] {spelling!r} = {name!r} is not a name"
                is_name = isinstance(name, str) and usable(name)
                place.demand(is_name, why, "write a name of [symbols] or [variables]")
        for body in (None, *(each.get("body") for each in file.claims if isinstance(each, dict))):
            with suppress(UserError):  # which makes the claim unchecked
                self.context(place, body)
        wrong, *others = [context.meant.wrong for context in self._contexts.values()]
        for name in self.symbols:
            if name in wrong and all(name in other for other in others):
                errors.errors.append(wrong[name])

    def _paper(self, given: Mapping[str, Any] | None) -> Standard:
        """Return the standard meanings of the paper's letters."""
        if given is None:
            return NONE
        place = self.place.at("paper", 1, "[paper]")
        if self.body is None:
            raise place.bad("it needs a body", "write body = 'hertz' above it")
        return standard(decoded(Answers, given, place), self.body.sheet.geometry, place)

    def _declare(self, name: str, said: object) -> None:
        """Add a variable with its range; variables of the theory keep their own symbols."""
        place = self.place.at("variables", name, f"variable {name!r}")
        demand_name(name, place)
        entry = decoded(Variable, said if isinstance(said, dict) else {"meaning": said}, place)
        span = SCALE
        if entry.low is not None and entry.high is not None:
            span = Range(entry.low, entry.high)
        is_positive = span is SCALE or span.low >= 0
        known = Symbol(name, positive=True) if is_positive else Symbol(name, real=True)
        if name not in self.paper.variables:
            known = self._variables(self.body).get(name, known)
        symbol = self.declared[name] = known
        self._add_unit(symbol, entry.unit, place)
        self.words |= {name: entry.meaning} if entry.meaning else {}
        if span is not SCALE or name in PLACES:
            self.ranges[symbol] = span

    def _define(self, name: str, said: object) -> None:
        """Add the formula of a symbol, unless it is the entry of a variable."""
        place = self.place.at("symbols", name, f"symbol {name!r}")
        demand_name(name, place)
        entry = decoded(DefinedSymbol, said if isinstance(said, dict) else {"is": said}, place)
        formula = text_of(entry)
        self.words |= {name: entry.meaning} if entry.meaning else {}
        own = _by_name(self._own(self.body)) if self.body else {}
        taken = {**own, **self.declared}
        symbol = taken.get(name, Symbol(name))
        if symbol not in self.units and symbol not in own.values():
            self._add_unit(symbol, entry.unit, place)
        if name not in taken or (name in PLACES and formula):
            self.symbols[name] = formula
        elif formula:
            what = "a variable" if name in self.declared else "a parameter of the body"
            why = f"it is already {what}"
            raise place.bad(why, "remove the symbol, or rename one of them")

    def _add_unit(self, symbol: Symbol, unit: str | None, place: Place) -> None:
        if unit is None:
            return
        try:
            self.units[symbol] = parse_unit(unit)
        except BadUnit as error:
            raise place.bad(error.message, "write a unit such as N/m") from error

    def context(
        self,
        place: Place,
        given: object = None,
        own: Mapping[str, Formula] = MappingProxyType({}),
        free: bool = False,
    ) -> Context:
        """Return the context of a claim with its own body, if it gives one, and own symbols.

        free: whether symbols without a meaning are positive variables
        """
        body = self.body if given is None else body_of(given, place)
        for name in own:
            demand_name(name, place)
        texts = {name: text_of(formula) for name, formula in own.items()}
        key = (id(body), free, *sorted(texts.items()))
        if key not in self._contexts:
            variables, units = self._variables(body), self._units(body)
            symbols = {**self.symbols, **texts}
            for name in [n for n, formula in symbols.items() if free and not formula]:
                del symbols[name]
                variables[name] = Symbol(name, positive=True)
                if Symbol(name) in units:
                    units[variables[name]] = units[Symbol(name)]
            known = self.context(place, given).meant.without(own) if own else Meant()
            own_symbols = self._own(body)
            made = Context(
                body,
                variables,
                units,
                symbols,
                self.place,
                self.seconds,
                own_symbols,
                known,
                self.words,
            )
            for name in made.symbols:
                made.define(name)
            self._contexts[key] = made
        return self._contexts[key]

    def _own(self, body: ProvenBody | None) -> dict[Symbol, Symbol]:
        """Return the symbols of the formulas of a body, each with the paper's symbol for it."""
        letters, found = self.paper.letters, {**_PREDEFINED, **(body.parameters if body else {})}
        return {ours: Symbol(letters.get(n, n), positive=True) for n, ours in found.items()}

    def _variables(self, body: ProvenBody | None) -> dict[str, Expr]:
        """Return all variables; parameters of the file's body are always among them."""
        inherited, own = (_by_name(self._own(each)) for each in (self.body, body))
        return {**PLACES, **inherited, **self.declared, **own}

    def _units(self, body: ProvenBody | None) -> dict[Symbol, Dimension]:
        """Return the known units; positions are in metres if there is a body."""
        found = {place: parse_unit("m") for place in PLACES.values() if body}
        for each in (self.body, body):
            own = self._own(each)
            known = {E_star: parse_unit("Pa"), f: parse_unit("-")}
            known |= each.sheet.geometry.dimensions if each else {}
            found |= {own.get(symbol, symbol): unit for symbol, unit in known.items()}
        return {**found, **self.units}


def _by_name(symbols: Mapping[Symbol, Symbol]) -> dict[str, Symbol]:
    return {theirs.name: theirs for theirs in symbols.values()}


def _is_open(said: object) -> bool:
    """Whether an entry of [symbols] gives no formula."""
    return said == "" or (isinstance(said, dict) and not said.get("is"))


def demand_name(name: str, place: Place) -> None:
    """Refuse a name that a formula cannot hold."""
    why = f"{name!r} is reserved or is not a valid name"
    place.demand(usable(name), why, "use another name of letters, digits and _")


def text_of(said: Formula) -> str:
    """Return the formula of a symbol as text, which is empty if it is not defined yet."""
    return str(said.formula if isinstance(said, DefinedSymbol) else said).strip()
