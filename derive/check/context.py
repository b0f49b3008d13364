"""Collect what is needed to read the equations of a claims file, and substitute their calls.

Context   the body, if there is one, and the variables
Meant     the meanings of the symbols of the source
Put       a printed equation with its calls as symbols, and the meanings of these symbols
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from sympy import Derivative, Expr, Integral, Limit, Symbol
from sympy.core.function import AppliedUndef
from sympy.logic.boolalg import Boolean

from derive.check.bodies import ProvenBody, placed
from derive.check.claim import Meaning
from derive.command.errors import UserError
from derive.reading.improper import (
    FROM_POLE,
    IMPROPER,
    PrincipalValue,
    ToInfinity,
    ordinary,
    proper,
)
from derive.reading.units import Call, Dimension, Units, parse_unit
from derive.sheet.formulas import FormulaSheet
from derive.symbols import E_star, M, P, e, f, x

PLACES = {"x": x, "s": Symbol("s", real=True), "xi": Symbol("xi", real=True)}
_UNITS = {E_star: parse_unit("Pa"), f: parse_unit("-")}
_CALLS = (AppliedUndef, Derivative, Limit, *IMPROPER)


@dataclass(frozen=True)
class Context:
    """The body of a claim, if there is one, and the variables with their units.

    units      units that the file declares
    inherited  units of the parameters of the file's body, if the claim has another one
    """

    body: ProvenBody | None
    variables: Mapping[str, Expr]
    units: Mapping[Symbol, Dimension]
    inherited: Mapping[Symbol, Dimension] = field(default_factory=dict)

    def followed(self, meant: "Meant") -> Units:
        """Return the known units."""
        known, calls = {**self.inherited, **_UNITS, **self.units}, dict[str, Call]()
        if self.sheet is not None:
            known |= {**self.sheet.geometry.dimensions, **_UNITS, **self.units}
            for place in PLACES.values():
                known.setdefault(place, parse_unit("m"))
            own = self.sheet.dimensions
            calls = {
                name: (tuple(own[each] for each in formula.arguments), parse_unit(formula.unit))
                for name, formula in self.sheet.items()
            }
        return Units(known, meant.written, calls)

    @property
    def sheet(self) -> FormulaSheet | None:
        """The formula sheet of the body, or None."""
        return self.body.sheet if self.body else None

    @cached_property
    def parameters(self) -> dict[str, Expr]:
        """The parameters of the body by name."""
        return self.body.parameters if self.body else {}

    @cached_property
    def arities(self) -> dict[str, int]:
        """The number of arguments of each formula of the body."""
        return {name: len(known.arguments) for name, known in (self.sheet or {}).items()}

    def put_in(self, expr: Any) -> Any:
        """Replace the calls of the body's formulas by the proven expressions."""
        while calls := expr.atoms(AppliedUndef):
            call = min(calls, key=lambda c: (len(str(c)), str(c)))
            assert self.body is not None
            known = self.body.sheet[call.func.__name__]
            formula = self.body.formula(known.name).xreplace({e: M / P})
            table = dict(zip(known.arguments, call.args, strict=True))
            expr = expr.xreplace({call: placed(formula, table)})
        expr = proper(expr)
        return expr.doit() if expr.has(Derivative, Limit) else expr

    def conditions(self, expr: Expr) -> Iterator[Boolean]:
        """Yield the conditions under which the formulas called in an expression are defined."""
        for call in sorted(expr.atoms(AppliedUndef), key=str):
            known = self.sheet[call.func.__name__]  # type: ignore[index]
            table = dict(zip(known.arguments, call.args, strict=True))
            for condition in known.conditions:
                yield self.put_in(condition.subs(table, simultaneous=True))
        for value in sorted(expr.atoms(PrincipalValue), key=str):
            for over in integrals(self.put_in(value)):
                if over.limits[-1][0].name.endswith(FROM_POLE):
                    yield over.limits[-1][2] > 0


@dataclass(frozen=True)
class Meant:
    """The meanings of the symbols of the source.

    written  meanings as in the file, with other symbols substituted and calls kept
    ours     meanings in terms of variables only
    wrong    the error in the formula of a symbol, or of one that it uses, by the symbol's name
    lacks    for a symbol whose formula uses one without a meaning, the name of that one
    needs    for each symbol, the names of all symbols that its definition uses
    """

    written: dict[Symbol, Expr]
    ours: dict[Symbol, Expr]
    wrong: dict[str, UserError] = field(default_factory=dict)
    lacks: dict[str, str] = field(default_factory=dict)
    needs: dict[str, set[str]] = field(default_factory=dict)

    def without(self, changed: Iterable[str]) -> "Meant":
        """Return the meanings that do not depend on the symbols that are redefined."""
        names = set(changed)
        kept = {n: needs for n, needs in self.needs.items() if n not in names and not needs & names}
        written, ours = (
            {symbol: expr for symbol, expr in table.items() if symbol.name in kept}
            for table in (self.written, self.ours)
        )
        return Meant(written, ours, needs=kept)


@dataclass(frozen=True)
class Put:
    """A printed equation's calls, each of which is represented by a symbol in the equation."""

    context: Context
    named: Mapping[Expr, Symbol]
    meaning: Meaning

    def stands_for(self, call: Expr, meaning: Meaning) -> Expr:
        """Return the expression for a call, with the meanings of its arguments substituted."""
        return self.context.put_in(call.xreplace(dict(meaning)))

    def called(self, meaning: Meaning) -> Meaning:
        """Return the expressions for all calls."""
        return {symbol: self.stands_for(call, meaning) for call, symbol in self.named.items()}

    def without_calls(self, side: Expr) -> Expr:
        """Replace calls by symbols, or by expressions if they depend on an integration variable."""
        for over in integrals(side):
            table = {call: self.stands_for(call, self.meaning) for call in calls_along(over)}
            inside = Integral(over.function.xreplace(table), *over.limits)
            side = side.xreplace({over: inside})
        return side.xreplace(dict(self.named))


def as_text(call: Expr) -> str:
    """Return a call, a derivative or a limit as a user would type it."""
    if isinstance(call, Derivative):
        (along, times) = call.variable_count[0]
        return f"diff({call.expr}, {along}" + (f", {times})" if times != 1 else ")")
    if isinstance(call, PrincipalValue):
        return f"pv({', '.join(map(str, call.args))})"
    if isinstance(call, ToInfinity):
        return f"integral({', '.join(map(str, call.args))}, oo)"
    if isinstance(call, Limit):
        return f"limit({', '.join(map(str, call.args[:3]))})"
    return str(call)


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
