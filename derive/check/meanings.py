"""Read the symbols of a claims file, and express them in terms of the variables.

In:   the tables [symbols] and [latex], and the variables.
Out:  Meanings: the meaning of each symbol for a body and a claim, and the LaTeX of symbols.
"""

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from sympy import Symbol

from derive.check.claim import Meaning
from derive.check.context import PLACES, Context, Meant, Put, free, with_real_bound
from derive.check.entries import Entries, Place, TimeLimit
from derive.check.lines import line_of
from derive.check.mistakes import Collected
from derive.check.variables import Variables, demand_name
from derive.command.errors import UserError
from derive.reading.formula import Names, equation, formula, usable
from derive.reading.units import Units
from derive.symbols import E_star, f

_OF_A_SYMBOL = frozenset({"is", "meaning", "proposal", "unit"})


class Meanings:
    """The symbols of a file.

    symbols    the entries of [symbols] by name, without those that are variables
    spellings  the entries of [latex]
    """

    def __init__(self, file: Entries, text: str, variables: Variables, limit: TimeLimit) -> None:
        self.symbols: dict[str, Any] = {}
        self.spellings: dict[str, str] = {}
        self._file, self._text, self._variables, self._limit = file, text, variables, limit
        self._meant: dict[str, Meant] = {}
        self._followed: dict[int, Units] = {}

    def read(self, contexts: Iterable[Context], errors: Collected) -> None:
        """Read [symbols] and [latex], and record the errors in them.

        contexts: those of the file's body, and of the bodies of its claims.  A symbol whose formula
        cannot be read with any of them is an error.
        """
        with errors.noted():
            self.symbols = dict(self._file.table("symbols"))
        for name, said in list(self.symbols.items()):
            with errors.noted():
                self._read_symbol(name, said, errors)
        with errors.noted():
            self.spellings = self._read_spellings()
        tables = [self.of(context) for context in contexts]
        for name in self.symbols:
            if all(name in meant.wrong for meant in tables):
                errors.errors.append(tables[0].wrong[name])

    def _read_symbol(self, name: str, said: object, errors: Collected) -> None:
        """Check the entry of a symbol, and drop it if it is the entry of a variable."""
        variables = self._variables
        parameters = variables.body.parameters if variables.body else {}
        taken = {**parameters, **variables.declared}
        if variables.body is not None:
            taken |= {"E_star": E_star, "f": f}
        place = Place(self._file.place.file, line_of(self._text, "symbols", name))
        demand_symbol(name, said, place)
        if isinstance(said, dict):
            entries = Entries(place.inside(f"the symbol {name!r}"), said)
            with errors.noted():
                entries.demand_known(_OF_A_SYMBOL)
                entries.demand_texts("meaning", "proposal")
            symbol = taken.get(name, Symbol(name))
            if symbol not in variables.units and symbol not in parameters.values():
                variables.say_unit(symbol, said, entries.place)
        if name in taken and not (name in PLACES and _formula_of(said)):
            if _formula_of(said):
                what = "a variable" if name in variables.declared else "a parameter of the body"
                why = f"the symbol {name!r} is already {what}"
                raise place.bad(why, "remove the symbol, or rename one of them")
            del self.symbols[name]  # the symbol is that variable

    def _read_spellings(self) -> dict[str, str]:
        """Return the entries of [latex], whose names must be declared in the file or bound in a
        claim."""
        found = self._file.table("latex")
        for spelling, name in found.items():
            if not isinstance(name, str) or not usable(name):
                why = f"[latex] {spelling!r} = {name!r} is not a name"
                raise self._file.place.bad(why, "write a name of [symbols] or [variables]")
        return found

    def of(self, context: Context, own: Mapping[str, Any] = MappingProxyType({})) -> Meant:
        """Return the meanings of all symbols for a body and for a claim's own symbols."""
        key = repr((id(context), sorted(own.items(), key=str)))
        if key not in self._meant:
            self._meant[key] = Meant({}, {})
            if own and context is self._variables.file:
                self._meant[key] = self.of(context).without(own)
            symbols = {**self.symbols, **own}
            for name in symbols:
                self._define(name, symbols, context, self._meant[key], ())
        return self._meant[key]

    def _define(
        self,
        name: str,
        symbols: Mapping[str, Any],
        context: Context,
        meant: Meant,
        outer: tuple[str, ...],
    ) -> bool:
        """Add the meaning of a symbol and of those that it uses; return whether it has one."""
        symbol = Symbol(name)
        if symbol in meant.ours or name in meant.wrong:
            return symbol in meant.ours
        text = _formula_of(symbols[name])
        if not text:
            return False
        line = line_of(self._text, "symbols", name)
        place = Place(self._file.place.file, line, f"symbols: {name}")
        if name in outer:
            round_ = outer[outer.index(name) :]
            why = f"it has a circular definition through {', '.join(round_)}"
            error = place.bad(why, "define one of these symbols without the others")
            meant.wrong.update(dict.fromkeys(round_, error))
            return False
        others = {n: Symbol(n) for n in symbols if n != name}
        names = Names(str(place), {**context.variables, **others}, context.arities)
        try:
            found = self._limit.read(place, lambda: formula(text, names))
            for inner in sorted(free(found) & set(others.values()), key=str):
                if not self._define(inner.name, symbols, context, meant, (*outer, name)):
                    if inner.name in meant.wrong:
                        meant.wrong.setdefault(name, meant.wrong[inner.name])
                    meant.lacks[name] = meant.lacks.get(inner.name, inner.name)
                    return False
            found = with_real_bound(found, others.values() - meant.ours.keys())
            written = found.xreplace(meant.written)
            ours = self._limit.read(place, lambda: context.put_in(written))
        except UserError as error:
            meant.wrong[name] = error
            return False
        needed = {each.name for each in found.free_symbols}
        meant.needs[name] = needed.union(*(meant.needs.get(each, ()) for each in needed))
        meant.written[symbol], meant.ours[symbol] = written, ours
        return True

    def mismatch(
        self, text: str, place: Place, context: Context, meant: Meant, names: Names
    ) -> str:
        """Describe the units that do not fit in an equation, whether it is judged or not."""
        try:
            left, _, right = self._limit.read(place, lambda: equation(text, names, rough=True))
        except UserError:
            return ""
        return self._units(context, meant).mismatch(left, right)

    def units_of(
        self, symbols: Iterable[Symbol], context: Context, meant: Meant
    ) -> dict[Symbol, str]:
        """Return the units of variables and symbols, where they are known."""
        units = self._units(context, meant)
        found = {symbol: units.unit_of(symbol) for symbol in sorted(symbols, key=str)}
        return {symbol: unit for symbol, unit in found.items() if unit}

    def _units(self, context: Context, meant: Meant) -> Units:
        """Return what is known of the units with these meanings; each equation adds to it."""
        key = id(meant)
        if key not in self._followed:
            self._followed[key] = context.followed(meant)
        return self._followed[key]


def demand_symbol(name: str, said: object, place: Place) -> None:
    """Refuse the entry of a symbol if its name or its formula cannot be read."""
    demand_name(name, place)
    formula = said.get("is", "") if isinstance(said, dict) else said
    if type(formula) not in (str, int, float):
        why = f"the value of the symbol {name!r} is {formula!r}, which is not a string"
        raise place.bad(why, f'write {name} = "a formula"')


def changed(put: Put, other: Meant) -> Meaning:
    """Return the new meanings of the redefined symbols and of all calls in an equation."""
    replaced = {s: expr for s, expr in other.ours.items() if put.meaning.get(s) != expr}
    return {**replaced, **put.called(other.ours)}


def names_of(place: Place, context: Context, symbols: Iterable[str]) -> Names:
    """Return the names that an equation may hold: symbols, variables and formulas."""
    known = {**context.variables, **{name: Symbol(name) for name in symbols}}
    return Names(str(place), known, context.arities)


def _formula_of(said: object) -> str:
    """Return the formula of a symbol as text; empty if it is not defined yet."""
    text = said.get("is", "") if isinstance(said, dict) else said
    return str(text).strip()
