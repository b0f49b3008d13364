"""Collect what is needed to read the equations of a claims file, and substitute their calls.

Context   the body, if there is one, the variables, and the symbols of the source
Defined   the meaning of one of these symbols
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

from sympy import Derivative, Expr, Integral, Limit, Piecewise, Symbol, expand, true
from sympy.core.function import AppliedUndef
from sympy.logic.boolalg import Boolean

from derive.check.bodies import ProvenBody, placed
from derive.check.claim import Claim
from derive.check.declarations import Declarations
from derive.check.mistakes import limited, reason
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
from derive.reading.units import Call, Units, parse_unit
from derive.sheet.formulas import Formula, FormulaSheet
from derive.symbols import M, P, e, x

_CALLS = (AppliedUndef, Derivative, Limit, *IMPROPER)


class Defined(NamedTuple):
    """The meaning of a symbol of the source.

    written       as in the file, with other symbols substituted and calls kept
    in_variables  in terms of variables only
    uses          the names of all symbols and variables in the definition
    """

    written: Expr
    in_variables: Expr
    uses: frozenset[str]


@dataclass(frozen=True)
class Context:
    """What the equations of a claim may refer to.

    file       what the file declares
    body       the body whose formulas may be called, or None
    symbols    the formula of each symbol of the source as text; empty if it has none
    variables  the variables by name
    defined    the symbols with a meaning
    lacking    for each other symbol, the name of the first that lacks a meaning of its own
    wrong      the error in the formula of such a symbol, if it has one
    """

    file: Declarations
    body: ProvenBody | None
    symbols: Mapping[str, str]
    variables: Mapping[str, Expr]
    defined: dict[str, Defined] = field(default_factory=dict)
    lacking: dict[str, str] = field(default_factory=dict)
    wrong: dict[str, UserError] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in self.symbols:
            self._define(name)

    @property
    def sheet(self) -> FormulaSheet | None:
        """The formula sheet of the body, or None."""
        return self.body.sheet if self.body else None

    @cached_property
    def own(self) -> dict[Symbol, Symbol]:
        """The symbols of the body's formulas, each with the paper's symbol for it."""
        return self.file.letters_of(self.body)

    @property
    def meaning(self) -> dict[Symbol, Expr]:
        """The meanings of the symbols in terms of variables only."""
        return {Symbol(name): known.in_variables for name, known in self.defined.items()}

    @property
    def written(self) -> dict[Symbol, Expr]:
        """The meanings of the symbols with the calls kept."""
        return {Symbol(name): known.written for name, known in self.defined.items()}

    def names(self, place: Place, symbols: Iterable[str] | None = None) -> Names:
        """Return the names that an equation may hold: symbols, by default all, and variables."""
        chosen = self.symbols if symbols is None else symbols
        arities = {name: len(known.arguments) for name, known in (self.sheet or {}).items()}
        meant = frozenset(name for name in chosen if self.symbols[name])
        return Names(
            str(place), {**self.variables, **{n: Symbol(n) for n in chosen}}, arities, meant
        )

    def replaced(
        self, formulas: Mapping[str, str], only_here: Collection[str] = (), is_open: bool = False
    ) -> "Context":
        """Return the context with other formulas of symbols.

        only_here  names whose other formulas are not used by other symbols
        is_open    whether symbols without a meaning are positive variables
        """
        inner = formulas.keys() - {*only_here}
        kept = {
            name: known
            for name, known in self.defined.items()
            if name not in formulas and known.uses.isdisjoint(inner)
        }
        symbols, variables = {**self.symbols, **formulas}, dict(self.variables)
        for name in [name for name, text in symbols.items() if is_open and not text]:
            variables[name] = Symbol(symbols.pop(name) or name, positive=True)
        return Context(self.file, self.body, symbols, variables, kept)

    # -------------------------------------------------------------- meanings

    def _define(self, name: str, outer: tuple[str, ...] = ()) -> str:
        """Add the meaning of a symbol and of those that it uses.

        Return the name of the symbol that lacks a meaning, or an empty text if none does.
        """
        if name not in self.defined and name not in self.lacking:
            try:
                lacking = self._read(name, outer) if self.symbols[name] else name
            except UserError as error:
                self.wrong[name], lacking = error, name
            if lacking:
                self.lacking.setdefault(name, lacking)
        return self.lacking.get(name, "")

    def _read(self, name: str, outer: tuple[str, ...]) -> str:
        place, seconds = self.file.place.at("symbols", name, f"symbols: {name}"), self.file.seconds
        if name in outer:
            why = f"it has a circular definition through {', '.join(outer[outer.index(name) :])}"
            raise place.bad(why, "define one of these symbols without the others")
        others = {Symbol(other) for other in self.symbols if other != name}
        names = self.names(place, [other.name for other in others])
        found = limited(seconds, place, lambda: formula(self.symbols[name], names))
        for inner in sorted(free(found) & others, key=str):
            if lacking := self._define(inner.name, (*outer, name)):
                return lacking
        found = with_real_bound(found, others - self.meaning.keys())
        written = found.xreplace(self.written)
        in_variables = limited(seconds, place, lambda: self.substitute(written))
        uses = self.used(each.name for each in found.free_symbols)
        self.defined[name] = Defined(written, in_variables, uses)
        return ""

    def used(self, names: Iterable[str]) -> frozenset[str]:
        """Return names, and those that their definitions use."""
        names = frozenset(names)
        return names.union(*(self.defined[name].uses for name in names & self.defined.keys()))

    def lack(self, names: Iterable[str]) -> str:
        """Say that symbols have no meaning, and why, or what the user can do."""
        lacking = [*dict.fromkeys(self.lacking.get(name, name) for name in names)]
        if wrong := next((name for name in lacking if name in self.wrong), ""):
            return f"the symbol {wrong} has no meaning in this claim: {reason(self.wrong[wrong])}"
        have, them = ("symbols {} have", "them") if len(lacking) > 1 else ("symbol {} has", "it")
        told = f"the {have.format(', '.join(lacking))} no meaning"
        why = self.file.paper.reasons(lacking)
        return f"{told}: define {them} in [symbols] or [variables]{why}"

    def described(self, claim: Claim, *exprs: Expr) -> Claim:
        """Return a claim with the formulas, and the words, of names that its equation uses."""
        names, tables = self.used(s.name for s in free(*exprs)), (self.symbols, self.file.words)
        symbols, words = ({n: table[n] for n in table if n in names} for table in tables)
        return replace(claim, symbols=symbols, words=words)

    # -------------------------------------------------------------- calls

    def _called(self, call: Expr) -> tuple[Formula, dict[Symbol, Expr]]:
        """Return the formula that is called, and what stands for each of its symbols."""
        known = self.sheet[call.func.__name__]  # type: ignore[index]
        return known, {**self.own, **dict(zip(known.arguments, call.args, strict=True))}

    def substitute(self, expr: Any) -> Any:
        """Replace the calls of the body's formulas by the proven expressions."""
        while calls := expr.atoms(AppliedUndef):
            call = min(calls, key=lambda c: (len(str(c)), str(c)))
            assert self.body is not None
            known, table = self._called(call)
            proven = self.body.formula(known.name).xreplace({e: M / P})
            expr = expr.xreplace({call: placed(proven, table)})
        expr = proper(expr)
        if any(each.has(Piecewise) for each in expr.atoms(Limit)):  # SymPy takes either branch
            why = "it has a limit of a formula with cases, which cannot be determined"
            remedy = "write the formula on the side from which the limit is taken"
            raise self.file.place.bad(why, remedy)
        if not expr.has(Derivative, Limit):
            return expr
        try:
            return expr.doit()
        except (AttributeError, NotImplementedError, TypeError, ValueError) as error:
            call = max(expr.atoms(Derivative, Limit), key=lambda each: len(str(each)))
            why = f"no value of {as_text(call)} was found"
            raise self.file.place.bad(why, "write its value") from error

    def in_variables(self, expr: Any) -> Any:
        """Replace the symbols of the source, and the calls, by their meanings."""
        return self.substitute(expr.xreplace(self.meaning))

    def conditions(self, expr: Expr) -> Iterator[Boolean]:
        """Yield the conditions under which the formulas called in an expression are defined.

        Those of a case of a formula apply where this case does.
        """
        if isinstance(expr, Piecewise):
            others: Boolean = true
            for value, condition in expr.args:
                taken = self.substitute(condition & others)
                yield from (~taken | needed for needed in self.conditions(value))
                others &= ~condition
            return
        if isinstance(expr, AppliedUndef):
            known, table = self._called(expr)
            for condition in known.conditions:
                if not (condition.has(x) and self._is_an_end(condition, table)):
                    yield self.substitute(condition.xreplace(table))
        if isinstance(expr, PrincipalValue):
            for over in integrals(self.substitute(expr)):
                if over.limits[-1][0].name.endswith(FROM_POLE):
                    yield over.limits[-1][2] > 0
        for part in expr.args:
            yield from self.conditions(part)

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
        units = self.file.units_with(self.body)
        named = {Symbol(name): variable for name, variable in self.variables.items()}
        units |= {named[symbol]: unit for symbol, unit in units.items() if symbol in named}
        return Units(units, self.written, calls)

    def mismatch(self, text: str, place: Place) -> str:
        """Describe the units that do not fit in an equation, whether it is judged or not."""

        def found() -> str:
            left, _, right = equation(text, self.names(place), rough=True)
            return self._known_units.mismatch(left, right)

        try:
            return limited(self.file.seconds, place, found) if text else ""
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


def bound(*exprs: Expr) -> set[Symbol]:
    """Return the variables of integrals and limits, of nested integrals that of the outer one."""
    inside = {each.args[1] for expr in exprs for each in expr.atoms(Limit)}
    return inside | {over.limits[-1][0] for over in integrals(*exprs)}


def free(*exprs: Expr) -> set[Symbol]:
    """Return the symbols that are not only variables of integration, of a sum or of a limit."""
    return set().union(*(ordinary(expr).free_symbols for expr in exprs))


def with_real_bound(expr: Expr, symbols: Iterable[Symbol]) -> Expr:
    """Make those symbols real that are only variables of integration in an expression."""
    inside = set(symbols) & expr.atoms(Symbol) - free(expr)
    return expr.xreplace({symbol: Symbol(symbol.name, real=True) for symbol in inside})


def calls_in(*exprs: Expr) -> list[Expr]:
    """Return the outermost calls, derivatives, limits and improper integrals."""
    calls = {call for expr in exprs for call in expr.atoms(*_CALLS)}
    inner = {call for one in calls for call in one.atoms(*_CALLS) - {one}}
    return sorted(calls - inner, key=str)
