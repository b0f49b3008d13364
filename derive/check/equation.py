"""What the equation of a claim is compared with, and where.

In:   an equation as it was read, the entries beside it, and the context of the claim.
Out:  the comparison that the equation stands for, in the variables of the file.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from sympy import Expr, Integral, Rational, Symbol, false, true
from sympy.core.function import AppliedUndef
from sympy.logic.boolalg import Boolean

from derive.check.claim import SIGNED, AsMeant, Basis, Meaning, Range, Rounded
from derive.check.context import (
    Context,
    as_text,
    bound,
    calls_in,
    free,
    integrals,
)
from derive.check.declarations import PLACES
from derive.check.schema import Entry, Formula, Place
from derive.reading.formula import Names, approach, condition, equation, rounded_in
from derive.reading.improper import IMPROPER
from derive.reading.relation import Relation


@dataclass(frozen=True)
class Equation:
    """The equation of a claim, as it was read; `through` is empty or has two sides."""

    entry: Entry
    text: str
    place: Place
    context: Context
    redefined: Callable[[Mapping[str, Any]], Context]
    left: Expr
    relation: Relation
    right: Expr
    through: tuple[Expr, ...]

    def meant(self) -> AsMeant:
        """Return the comparison that the equation stands for."""
        entry, context = self.entry, self.context
        left, right = self._without_calls(self.left), self._without_calls(self.right)
        compared = tuple(map(self._without_calls, self.through)) or (left, right)
        meaning = self._called(context.meaning)
        self._demand_bound(left, right, meaning)
        held = _variables(compared, meaning)
        self._demand_one_parameter(held)
        conditions, reached = self._conditions(held), self._reached()
        changed = [expr for entries in reached or () for expr in entries.values()]
        held = held.union(*(each.free_symbols for each in (*conditions, *changed)))
        places = {place: SIGNED for place in PLACES.values()}
        ranges = {**places, **context.file.ranges, **self._ranges()}
        ends = tuple(map(context.in_variables, self._approached))
        told = (self.left, self.right, *self._approached)
        inside = {each.args[1] for expr in told for each in expr.atoms(*IMPROPER)} | bound(*told)
        named = set().union(*(expr.atoms(Symbol) for expr in told)) - inside
        calls = {symbol: call for call, symbol in self._calls.items()}
        is_equal = self.relation == Relation.LIKE and not (entry.approach or entry.leading)
        return AsMeant(
            left=left,
            right=right,
            relation=Relation.EQUAL if is_equal else self.relation,
            meaning=meaning,
            reached=reached,
            through=(compared[0], compared[1]) if self.through else None,
            toward=(ends[0], ends[1]) if ends else None,
            conventions=tuple((e, self._changed(e.symbols)) for e in entry.conventions),
            ranges={symbol: span for symbol, span in ranges.items() if symbol in held},
            conditions=conditions,
            cases=self._cases(held),
            basis=self._basis,
            called=self._called_sides,
            rounded=_rounded(self.text, self._names()),
            swaps=self._swaps(named),
            unit_of=context.units_of({**{s: s for s in named | held}, **calls}),
        )

    def _names(self, key: str = "") -> Names:
        """Return the names that an entry may hold: those with a meaning."""
        place = self.place.inside(key) if key else self.place
        return self.context.names(place, [s.name for s in self.context.meaning])

    def _symbol(self, key: str, name: str, known: Mapping[str, Expr]) -> Symbol:
        """Return the symbol of a name in an entry."""
        found = known.get(name)
        if not isinstance(found, Symbol):
            why = f"{key}: {name!r} is not a variable"
            raise self.place.bad(why, "use a name of [variables]")
        return found

    @cached_property
    def _called_sides(self) -> tuple[Expr, ...]:
        """The sides to compare in our variables, with the body's formulas as functions."""
        written = self.context.written
        sides = [side.xreplace({self.left: self.right}) for side in self.through]
        return tuple(side.xreplace(written) for side in sides or (self.left, self.right))

    @property
    def _basis(self) -> Basis:
        """What the verdict rests on if it rests on everything that takes part."""
        if self.entry.given:
            return Basis.GIVEN
        if any(side.has(AppliedUndef) for side in self._called_sides):
            return Basis.BOTH if self._own_parameters else Basis.BODY
        used = free(self.left, self.right, *self.through) & self.context.written.keys()
        return Basis.DEFINITIONS if used else Basis.MATHEMATICS

    # -------------------------------------------------------------- calls

    @cached_property
    def _calls(self) -> dict[Expr, Symbol]:
        """The calls in the equation, each of which is represented by a symbol."""
        calls = calls_in(self.left, self.right, *self.through)
        return {call: Symbol(as_text(call)) for call in calls}

    def _called(self, meaning: Meaning) -> Meaning:
        """Return meanings of symbols together with those of all calls."""
        table, put_in = dict(meaning), self.context.substitute
        return table | {
            symbol: put_in(call.xreplace(table)) for call, symbol in self._calls.items()
        }

    def _without_calls(self, side: Expr) -> Expr:
        """Replace calls by symbols, or by expressions if they depend on an integration variable."""
        for over in integrals(side):
            along = {limit[0] for limit in over.limits}
            calls = [call for call in calls_in(over.function) if call.free_symbols & along]
            table = {call: self.context.in_variables(call) for call in calls}
            side = side.xreplace({over: Integral(over.function.xreplace(table), *over.limits)})
        return side.xreplace(self._calls)

    def _changed(self, symbols: Mapping[str, Formula]) -> Meaning:
        """Return the meanings that change if some symbols of the claim are redefined."""
        other = self.redefined(symbols).meaning
        known, calls = self.context.meaning, set(self._calls.values())
        return {s: e for s, e in self._called(other).items() if s in calls or known.get(s) != e}

    # -------------------------------------------------------------- entries beside the equation

    @cached_property
    def _approached(self) -> tuple[Expr, ...]:
        """The expression that tends to an end, and this end, if the claim is about a limit."""
        told, order = self.entry.approach, self.entry.order
        why = f"`order` = {order!r} is not a number, or `as` is missing"
        remedy = "give `order` as a number, together with `as`"
        self.place.demand(bool(told) or order is None, why, remedy)
        return approach(told, self._names("as")) if told else ()

    def _conditions(self, held: set[Symbol]) -> tuple[Boolean, ...]:
        """Return the conditions of the formulas that are called, and those of the claim."""
        meaning, names = self.context.meaning, self._names("require")
        written = [side.xreplace(self.context.written) for side in (self.left, self.right)]
        found = {each for side in written for each in self.context.conditions(side)}
        for text in self.entry.requirements:
            why = f"require: {text!r} is an equation and not a condition"
            remedy = "use `symbols` or `ranges` for a value, or write <, <=, > or >="
            self.place.demand(not re.search("(?<![<>=!])=(?!=)", text), why, remedy)
            found.add(condition(text, names).xreplace(meaning))
        for text in self.context.file.paper.conditions:
            inside = condition(text, names).xreplace(meaning)
            found |= {inside} if inside.free_symbols <= held else set()
        remedy = "correct `require`, or the arguments of the formulas that are called"
        self.place.demand(false not in found, "its conditions are never satisfied", remedy)
        inside = bound(*written) - held
        kept = [each for each in found if each != true and not each.free_symbols & inside]
        return tuple(sorted(kept, key=str))

    def _ranges(self) -> dict[Symbol, Range]:
        """Return the ranges of variables in this claim."""
        found = dict[Symbol, Range]()
        for name, (low, high) in self.entry.ranges.items():
            symbol = self._symbol("ranges", name, self.context.variables)
            why = f"ranges: [{low:g}, {high:g}] is not a range of {name}"
            remedy = "write the lower end first, and none below zero for a positive variable"
            self.place.demand(low < high and (low >= 0 or not symbol.is_positive), why, remedy)
            found[symbol] = Range(low, high)
        return found

    def _cases(self, held: set[Symbol]) -> tuple[Mapping[Symbol, str], ...]:
        """Return the points that the claim prescribes."""
        cases, known = list[Mapping[Symbol, str]](), self.context.variables
        for each in self.entry.cases:
            point = {self._symbol("cases", name, known): str(n) for name, n in each.items()}
            missing = ", ".join(sorted(s.name for s in held - point.keys()))
            remedy = "give every variable of the claim a value in each case"
            self.place.demand(not missing, f"cases: {missing} has no value", remedy)
            cases.append(point)
        return tuple(cases)

    def _swaps(self, named: set[Symbol]) -> tuple[Symbol, ...]:
        """Return the names that may have been confused, by default all names in the equation."""
        defined = self.context.meaning.keys()
        if self.entry.swaps is None:
            return (*(s for s in defined if s in named), *sorted(named - defined, key=str))
        known = {**self.context.variables, **{s.name: s for s in defined}}
        return tuple(self._symbol("swaps", name, known) for name in self.entry.swaps)

    def _reached(self) -> tuple[Meaning, Meaning] | None:
        """Return the replacements by which a bound is judged on both sides."""
        allowed, beyond = self.entry.allowed, self.entry.beyond
        if allowed is beyond is None:
            return None
        why, remedy = "only one of `allowed` and `beyond` is given", "write both, as allowed = "
        self.place.demand(bool(allowed and beyond), why, f'{remedy}{{ sigma = "..." }}')
        return self._changed(allowed or {}), self._changed(beyond or {})

    def _demand_bound(self, left: Expr, right: Expr, meaning: Meaning) -> None:
        """Refuse variables of integration, except positions, that are also used outside."""
        meant = (meaning[s] for s in left.free_symbols | right.free_symbols if s in meaning)
        inside = bound(left, right, *meant) - {*PLACES.values()}
        table = {s: expr for s, expr in meaning.items() if s not in inside}
        held = left.xreplace(table).free_symbols | right.xreplace(table).free_symbols
        for along in sorted(inside & (held | meaning.keys()), key=str):
            why = f"{along} is a variable of integration and also used outside"
            remedy = "integrate over another variable, such as s or xi, in the integrand too"
            raise self.place.bad(why, remedy)

    @property
    def _own_parameters(self) -> dict[str, Expr]:
        """Parameters of the body that the equation uses with a meaning of its own."""
        context = self.context
        used = context.used(each.name for each in free(self.left, self.right))
        known = used & {each.name for each in context.own.values()} & context.defined.keys()
        return {name: context.defined[name].in_variables for name in sorted(known)}

    def _demand_one_parameter(self, held: set[Symbol]) -> None:
        """Reject a meaning for a parameter of the body that formulas of the body also contain."""
        for name, given in self._own_parameters.items():
            if self.context.variables.get(name) in held - given.free_symbols:
                given = as_text(given)
                why = f"{name} is defined as {given}, but formulas of the body also contain {name}"
                raise self.place.bad(why, f"use {name} in the other symbols instead")


def _variables(sides: tuple[Expr, ...], meaning: Meaning) -> set[Symbol]:
    """Return the variables of both sides, except variables of integration inside the integrals."""
    symbols = set().union(*(side.free_symbols for side in sides))
    held = set().union(*(meaning.get(symbol, symbol).free_symbols for symbol in symbols))
    outside = set().union(*(side.xreplace(dict(meaning)).free_symbols for side in sides))
    return held - (bound(*sides) - outside)


def _rounded(text: str, names: Names) -> Rounded | None:
    """Return the rounded constant that is a factor of a side, if there is exactly one."""
    found = rounded_in(text)
    if len(found) != 1:
        return None
    (one,) = found
    constant = Symbol("constant", positive=True)
    replaced = f"{text[: one.start()]}constant{text[one.end() :]}"
    known = Names(names.where, {**names.symbols, "constant": constant}, names.calls)
    left, _, right = equation(replaced, known, rough=True)
    power = (right / left).as_independent(constant)[1].as_base_exp()
    if power[0] != constant or power[1] not in (1, -1):
        return None
    half = Rational(5, 10 ** (len(one[0].partition(".")[2]) + 1))
    return Rounded(Rational(one[0]), half, int(power[1]))
