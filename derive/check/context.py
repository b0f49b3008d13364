"""Collect what is needed to read the equations of a claims file, and substitute their calls.

Context   the body, if there is one, the variables, and the symbols of the source
Meant     the meanings of these symbols
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from sympy import Derivative, Expr, Integer, Integral, Limit, Piecewise, Symbol, expand, true
from sympy.core.function import AppliedUndef
from sympy.logic.boolalg import Boolean

from derive.check.bodies import ProvenBody, placed
from derive.check.mistakes import limited
from derive.check.schema import Place
from derive.command.errors import UserError
from derive.reading.formula import Names, equation, formula
from derive.reading.improper import (
    FROM_POLE,
    IMPROPER,
    PrincipalValue,
    ordinary,
    proper,
    typed,
)
from derive.reading.units import Call, Dimension, Units, parse_unit
from derive.sheet.formulas import FormulaSheet
from derive.symbols import M, P, e, x

PLACES = {"x": x, "s": Symbol("s", real=True), "xi": Symbol("xi", real=True)}
_CALLS = (AppliedUndef, Derivative, Limit, *IMPROPER)


@dataclass(frozen=True)
class Meant:
    """The meanings of the symbols of the source.

    as_written    meanings as in the file, with other symbols substituted and calls kept
    in_variables  meanings in terms of variables only
    wrong         the error in the formula of a symbol, or of one that it uses, by its name
    missing       for a symbol whose formula uses one without a meaning, the name of that one
    uses          for each symbol, the names of all symbols that its definition uses
    """

    as_written: dict[Symbol, Expr] = field(default_factory=dict)
    in_variables: dict[Symbol, Expr] = field(default_factory=dict)
    wrong: dict[str, UserError] = field(default_factory=dict)
    missing: dict[str, str] = field(default_factory=dict)
    uses: dict[str, set[str]] = field(default_factory=dict)

    def without(self, changed: Iterable[str]) -> "Meant":
        """Return the meanings that do not depend on the symbols that are redefined."""
        names = set(changed)
        kept = {n: used for n, used in self.uses.items() if not (used | {n}) & names}
        as_written, in_variables = (
            {symbol: expr for symbol, expr in table.items() if symbol.name in kept}
            for table in (self.as_written, self.in_variables)
        )
        return Meant(as_written, in_variables, uses=kept)


@dataclass(frozen=True)
class Context:
    """What the equations of a claim may refer to.

    variables  the variables by name
    units      the units of variables and symbols, as far as they are declared
    symbols    the formula of each symbol of the source as text; empty if it has none
    place      the file
    seconds    the time limit for reading one formula
    own        the symbols of the body's formulas, each with the paper's symbol for it
    words      what the file says in words of symbols and variables
    """

    body: ProvenBody | None
    variables: Mapping[str, Expr]
    units: Mapping[Symbol, Dimension]
    symbols: Mapping[str, str]
    place: Place
    seconds: float
    own: Mapping[Symbol, Symbol] = field(default_factory=dict)
    meant: Meant = field(default_factory=Meant)
    words: Mapping[str, str] = field(default_factory=dict)

    @property
    def sheet(self) -> FormulaSheet | None:
        """The formula sheet of the body, or None."""
        return self.body.sheet if self.body else None

    def names(self, place: Place, symbols: Iterable[str] | None = None) -> Names:
        """Return the names that an equation may hold: symbols, by default all, and variables."""
        chosen = self.symbols if symbols is None else symbols
        arities = {name: len(known.arguments) for name, known in (self.sheet or {}).items()}
        meant = frozenset(name for name in chosen if self.symbols[name])
        return Names(
            str(place), {**self.variables, **{n: Symbol(n) for n in chosen}}, arities, meant
        )

    @cached_property
    def _renamed(self) -> dict[Symbol, Symbol]:
        """The symbols of the body's formulas for which the paper has another letter."""
        return {ours: theirs for ours, theirs in self.own.items() if ours != theirs}

    # -------------------------------------------------------------- meanings

    def define(self, name: str, outer: tuple[str, ...] = ()) -> bool:
        """Add the meaning of a symbol and of those that it uses; return whether it has one."""
        symbol, meant, text = Symbol(name), self.meant, self.symbols[name]
        if symbol in meant.in_variables or name in meant.wrong or not text:
            return symbol in meant.in_variables
        place = self.place.at("symbols", name, f"symbols: {name}")
        if name in outer:
            circle = outer[outer.index(name) :]
            why = f"it has a circular definition through {', '.join(circle)}"
            error = place.bad(why, "define one of these symbols without the others")
            meant.wrong.update(dict.fromkeys(circle, error))
            return False
        others = {Symbol(other) for other in self.symbols if other != name}
        names = self.names(place, [other for other in self.symbols if other != name])
        try:
            found = limited(self.seconds, place, lambda: formula(text, names))
            for inner in sorted(free(found) & others, key=str):
                if not self.define(inner.name, (*outer, name)):
                    if inner.name in meant.wrong:
                        meant.wrong.setdefault(name, meant.wrong[inner.name])
                    meant.missing[name] = meant.missing.get(inner.name, inner.name)
                    return False
            found = with_real_bound(found, others - meant.in_variables.keys())
            written = found.xreplace(meant.as_written)
            in_variables = limited(self.seconds, place, lambda: self.substitute(written))
        except UserError as error:
            meant.wrong[name] = error
            return False
        used = {each.name for each in found.free_symbols}
        meant.uses[name] = used.union(*(meant.uses.get(each, ()) for each in used))
        meant.as_written[symbol], meant.in_variables[symbol] = written, in_variables
        return True

    def replaced(self, formulas: Mapping[str, str], place: Place) -> "Context":
        """Return the context in which equations, but not other symbols, use other formulas."""
        names = self.names(place)
        table = {Symbol(name): formula(text, names) for name, text in formulas.items()}
        for _ in table:
            table = {symbol: expr.xreplace(table) for symbol, expr in table.items()}
        is_open = any(expr.free_symbols & table.keys() for expr in table.values())
        place.demand(not is_open, "the claims are circular", "remove one of them")
        written = {symbol: expr.xreplace(self.meant.as_written) for symbol, expr in table.items()}
        found = {symbol: self.substitute(expr) for symbol, expr in written.items()}
        as_written = {**self.meant.as_written, **written}
        in_variables = {**self.meant.in_variables, **found}
        meant = replace(self.meant, as_written=as_written, in_variables=in_variables)
        return replace(self, meant=meant, symbols={**self.symbols, **formulas})

    def definitions(self, *exprs: Expr) -> tuple[dict[str, str], dict[str, str]]:
        """Return the formulas, and the words, of names in expressions and of those they use."""
        names = {each.name for each in free(*exprs)}
        names = names.union(*(self.meant.uses.get(name, ()) for name in names))
        symbols, words = (
            {name: table[name] for name in table if name in names}
            for table in (self.symbols, self.words)
        )
        return symbols, words

    def substitute(self, expr: Any) -> Any:
        """Replace the calls of the body's formulas by the proven expressions."""
        while calls := expr.atoms(AppliedUndef):
            call = min(calls, key=lambda c: (len(str(c)), str(c)))
            assert self.body is not None
            known = self.body.sheet[call.func.__name__]
            formula = self.body.formula(known.name).xreplace({e: M / P})
            table = {**self._renamed, **dict(zip(known.arguments, call.args, strict=True))}
            expr = expr.xreplace({call: placed(formula, table)})
        expr = proper(expr)
        if any(each.has(Piecewise) for each in expr.atoms(Limit)):  # SymPy takes either branch
            why = "it has a limit of a formula with cases, which cannot be determined"
            raise self.place.bad(why, "write the formula on the side from which the limit is taken")
        if not expr.has(Derivative, Limit):
            return expr
        try:
            return expr.doit()
        except (AttributeError, NotImplementedError, TypeError, ValueError) as error:
            call = max(expr.atoms(Derivative, Limit), key=lambda each: len(str(each)))
            why = f"no value of {as_text(call)} was found"
            raise self.place.bad(why, "write its value") from error

    def in_variables(self, expr: Any) -> Any:
        """Replace the symbols of the source, and the calls, by their meanings."""
        return self.substitute(expr.xreplace(self.meant.in_variables))

    def conditions(self, expr: Expr) -> Iterator[Boolean]:
        """Yield the conditions under which the formulas called in an expression are defined.

        Those of a case of a formula apply where this case does.
        """
        every = expr.atoms(Piecewise)
        cases = {each for each in every if not any(o != each and o.has(each) for o in every)}
        for each in sorted(cases, key=str):
            others: Boolean = true
            for value, condition in each.args:
                taken = self.substitute(condition & others)
                yield from (~taken | needed for needed in self.conditions(value))
                others &= ~condition
        expr = expr.xreplace(dict.fromkeys(cases, Integer(0)))
        for call in sorted(expr.atoms(AppliedUndef), key=str):
            known = self.sheet[call.func.__name__]  # type: ignore[index]
            table = {**self._renamed, **dict(zip(known.arguments, call.args, strict=True))}
            for condition in known.conditions:
                if not (condition.has(x) and self._is_an_end(condition, table)):
                    yield self.substitute(condition.xreplace(table))
        for value in sorted(expr.atoms(PrincipalValue), key=str):
            for over in integrals(self.substitute(value)):
                if over.limits[-1][0].name.endswith(FROM_POLE):
                    yield over.limits[-1][2] > 0

    def _is_an_end(self, condition: Boolean, table: Mapping[Symbol, Expr]) -> bool:
        """Whether the position in a call is an end of the contact, up to which a formula holds."""
        distance = (condition.lhs - condition.rhs).xreplace(table)
        return bool(expand(self.substitute(distance)) == 0)

    # -------------------------------------------------------------- units

    @cached_property
    def _known_units(self) -> Units:
        """The known units with these meanings; each equation adds to them."""
        calls, own = dict[str, Call](), self.sheet.dimensions if self.sheet else {}
        for name, known in (self.sheet or {}).items():
            calls[name] = tuple(own[each] for each in known.arguments), parse_unit(known.unit)
        return Units(dict(self.units), self.meant.as_written, calls)

    def mismatch(self, text: str, place: Place) -> str:
        """Describe the units that do not fit in an equation, whether it is judged or not."""

        def found() -> str:
            left, _, right = equation(text, self.names(place), rough=True)
            return self._known_units.mismatch(left, right)

        try:
            return limited(self.seconds, place, found) if text else ""
        except UserError:
            return ""

    def units_of(self, meant: Mapping[Symbol, Expr]) -> dict[Symbol, str]:
        """Return the units of symbols that stand for expressions, where they are known."""
        found = {each: self._known_units.unit_of(meant[each]) for each in sorted(meant, key=str)}
        return {symbol: unit for symbol, unit in found.items() if unit}


def as_text(expr: Expr) -> str:
    """Return an expression as a user would type it."""
    return str(typed(expr))


def integrals(*exprs: Expr) -> list[Integral]:
    """Return all integrals in the expressions, in a fixed order."""
    return sorted({over for expr in exprs for over in expr.atoms(Integral)}, key=str)


def free(*exprs: Expr) -> set[Symbol]:
    """Return the symbols that are not only variables of integration, of a sum or of a limit."""
    return set().union(*(ordinary(expr).free_symbols for expr in exprs))


def with_real_bound(expr: Expr, symbols: Iterable[Symbol]) -> Expr:
    """Make those symbols real that are only variables of integration in an expression."""
    bound = set(symbols) & expr.atoms(Symbol) - free(expr)
    return expr.xreplace({symbol: Symbol(symbol.name, real=True) for symbol in bound})


def calls_in(*exprs: Expr) -> list[Expr]:
    """Return the outermost calls, derivatives, limits and improper integrals."""
    calls = {call for expr in exprs for call in expr.atoms(*_CALLS)}
    inner = {call for one in calls for call in one.atoms(*_CALLS) - {one}}
    return sorted(calls - inner, key=str)


def calls_along(over: Integral) -> list[Expr]:
    """Return the calls under an integral that depend on the variable of integration."""
    along = {limit[0] for limit in over.limits}
    return [call for call in calls_in(over.function) if call.free_symbols & along]
