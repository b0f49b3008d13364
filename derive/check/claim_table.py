"""Read one table [[claims]] of a claims file.

In:   the table, and the declarations of the file.
Out:  the Claim, which is unchecked with the reason if an entry is wrong or a meaning is missing.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import msgspec
from sympy import Expr, Integral, Limit, Rational, Symbol, false, true
from sympy.logic.boolalg import Boolean

from derive.check.claim import SIGNED, AsMeant, Bound, Claim, Convention, Meaning, Range, Rounded
from derive.check.context import (
    PLACES,
    Context,
    Meant,
    as_text,
    calls_along,
    calls_in,
    free,
    integrals,
    with_real_bound,
)
from derive.check.declarations import Declarations, formula_of
from derive.check.mistakes import reason
from derive.check.printed import Reading, equation_text, may_be_rough, not_accepted, waiting
from derive.check.schema import (
    AsExpected,
    AsPrinted,
    Place,
    Reinterpretation,
    Terms,
    record,
    records,
)
from derive.command.errors import NotAccepted, UserError
from derive.reading.formula import (
    Names,
    UnknownName,
    approach,
    condition,
    equation,
    rounded_in,
    unknown,
)
from derive.reading.improper import IMPROPER
from derive.reading.relation import Relation


@dataclass
class ClaimReader:
    """Reads the claims of a file in their order, because one may follow from others.

    readings  the claims in LaTeX that are not accepted yet or cannot be read
    mistakes  the errors in claims, each of which makes its claim unchecked
    """

    declared: Declarations
    readings: list[Reading] = field(default_factory=list)
    mistakes: list[UserError] = field(default_factory=list)
    _read: dict[str, tuple[Expr, Expr]] = field(default_factory=dict)

    def claim(self, number: int, given: Mapping[str, Any], place: Place) -> Claim:
        """Return a claim, which must have a label; `number` counts the claims from 1."""
        limit = self.declared.limit
        claim = Claim(_texts(given, place), seconds=limit.seconds)
        try:
            printed, terms, expected = records(given, place, AsPrinted, Terms, AsExpected)
            claim = replace(claim, expected=expected)
            context = limit.read(place, lambda: self._context(terms, place))
            claim = replace(claim, units=context.mismatch(claim.printed.text, place))
            return limit.read(
                place, lambda: self._claim(number, claim, printed, terms, place, context)
            )
        except UserError as error:
            self.mistakes.append(error)
            return self._unread(number, claim, reason(error, place))

    def _unread(self, number: int, claim: Claim, why: str) -> Claim:
        """Return an unchecked claim, and record that its LaTeX cannot be read."""
        printed = claim.printed
        if printed.latex:
            self.readings.append(Reading(number, printed.label, printed.latex, "", why=why))
        return replace(claim, unchecked=why)

    def _context(self, terms: Terms, place: Place) -> Context:
        is_allowed = terms.leading is not False
        place.demand(is_allowed, "leading = False is not allowed", "write leading = true")
        own = {name: formula_of(name, said, place) for name, said in terms.symbols.items()}
        return self.declared.context(place, terms.body, own)

    def _claim(
        self,
        number: int,
        claim: Claim,
        printed: AsPrinted,
        terms: Terms,
        place: Place,
        context: Context,
    ) -> Claim:
        """Return a claim; raise UserError if one of its entries is wrong."""
        if terms.unchecked:
            return replace(claim, unchecked=terms.unchecked)
        names = context.names(place)
        try:
            text = equation_text(printed, terms, place, names, self.declared.spellings)
            left, relation, right = equation(text, names, may_be_rough(terms, text))
        except NotAccepted as error:
            self.readings.append(waiting(number, printed, terms, place, error, names))
            claim = replace(claim, unchecked=not_accepted(printed, error))
            return claim.with_text(error.understood)
        except UnknownName as error:
            why = _lacking(unknown(error.given, names) or ["oo"], context.meant)
            is_told = bool(claim.printed.text)
            return replace(claim, unchecked=why) if is_told else self._unread(number, claim, why)
        undefined = {Symbol(name) for name in context.symbols} - context.meant.in_variables.keys()
        left, right = (with_real_bound(side, undefined) for side in (left, right))
        if terms.given is not None:
            context = self._following(terms.given, context, place.inside("given"))
            undefined = set()
        self._read[printed.label] = left, right
        through = _through(terms, left, names, place)
        sides = [side.xreplace({left: right}) for side in through] or [left, right]
        if lacking := [n for n in context.symbols if Symbol(n) in free(*sides) & undefined]:
            return replace(claim, unchecked=_lacking(lacking, context.meant))
        stated = _Equation(
            self.declared, terms, place, context, text, left, relation, right, through
        )
        expected = msgspec.structs.replace(claim.expected, against=stated.against(claim.expected))
        return replace(claim, meant=stated.meant(), expected=expected).with_text(text)

    def _following(self, given: Iterable[str], context: Context, place: Place) -> Context:
        """Return the context if other claims are true; symbols without meaning become variables."""
        table, known = dict[Symbol, Expr](), context.meant.in_variables
        for label in given:
            remedy = "give the label of an earlier claim that can be read"
            why = f"{label!r} is not the label of an earlier claim"
            place.demand(label in self._read, why, remedy)
            left, right = self._read[label]
            if not isinstance(left, Symbol):
                left, right = right, left
            is_definition = isinstance(left, Symbol) and not right.has(left)
            why = f"the claim {label!r} does not define a symbol"
            place.demand(is_definition, why, "give claims of the form symbol = ...")
            table[left] = right
        for symbol in map(Symbol, context.symbols):
            if symbol not in known:
                table.setdefault(symbol, Symbol(symbol.name, positive=True))
        known = {s: expr for s, expr in known.items() if s not in table}
        for _ in table:
            table = {s: expr.xreplace(table) for s, expr in table.items()}
        is_open = any(expr.free_symbols & table.keys() for expr in table.values())
        place.demand(not is_open, "the claims are circular", "remove one of them")
        found = {**known, **{s: expr.xreplace(known) for s, expr in table.items()}}
        return replace(context, meant=Meant(table, found))


@dataclass(frozen=True)
class _Equation:
    """The equation of a claim, as it was read; `through` is empty or has two sides."""

    declared: Declarations
    terms: Terms
    place: Place
    context: Context
    text: str
    left: Expr
    relation: Relation
    right: Expr
    through: tuple[Expr, ...]

    def meant(self) -> AsMeant:
        """Return the comparison that the equation stands for."""
        terms, context = self.terms, self.context
        left, right = self._without_calls(self.left), self._without_calls(self.right)
        compared = tuple(map(self._without_calls, self.through)) or (left, right)
        meaning = self._called(context.meant.in_variables)
        self._demand_bound(left, right, meaning)
        held = _variables(compared, meaning)
        self._demand_one_parameter(held)
        conditions, reached = self._conditions(held), self._reached()
        changed = (*reached.allowed.values(), *reached.beyond.values()) if reached else ()
        held = held.union(*(each.free_symbols for each in (*conditions, *changed)))
        places = {place: SIGNED for place in PLACES.values()}
        ranges = {**places, **self.declared.ranges, **self._ranges()}
        named = _names_in(self.left, self.right)
        is_equal = self.relation == Relation.LIKE and not (terms.approach or terms.leading)
        return AsMeant(
            left=left,
            right=right,
            relation=Relation.EQUAL if is_equal else self.relation,
            meaning=meaning,
            reached=reached,
            through=(compared[0], compared[1]) if self.through else None,
            toward=self._toward(),
            order=terms.order,
            conventions=self._conventions(),
            ranges={symbol: span for symbol, span in ranges.items() if symbol in held},
            conditions=conditions,
            cases=self._cases(),
            family=terms.family,
            defined=self._is_defined(),
            rounded=_rounded(self.text, self._names("")),
            swaps=self._swaps(named),
            unit_of=context.units_of(named | held),
        )

    def against(self, expected: AsExpected) -> str:
        """Describe what the claim is compared with."""
        sheet, claims = self.context.sheet, ", ".join(self.terms.given or ())
        told = f" and the formula sheet of {sheet.geometry.name}" if sheet else ""
        given = f", given {claims}" if claims else ""
        return expected.against or f"the formulas of {self.place.file}{told}{given}"

    def _names(self, key: str) -> Names:
        """Return the names that an entry may hold: those with a meaning."""
        place = self.place.inside(key) if key else self.place
        return self.context.names(place, [s.name for s in self.context.meant.in_variables])

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
            table = {call: self.context.in_variables(call) for call in calls_along(over)}
            inside = Integral(over.function.xreplace(table), *over.limits)
            side = side.xreplace({over: inside})
        return side.xreplace(self._calls)

    def _changed(self, symbols: Mapping[str, Any]) -> Meaning:
        """Return the meanings that change if some symbols of the claim are redefined."""
        said = {**self.terms.symbols, **symbols}
        own = {name: formula_of(name, formula, self.place) for name, formula in said.items()}
        other = self.declared.context(self.place, self.terms.body, own).meant.in_variables
        known, calls = self.context.meant.in_variables, set(self._calls.values())
        return {s: e for s, e in self._called(other).items() if s in calls or known.get(s) != e}

    # -------------------------------------------------------------- entries beside the equation

    def _toward(self) -> tuple[Expr, Expr] | None:
        """Return the expression that tends to an end, and this end, in our variables."""
        told, order = self.terms.approach, self.terms.order
        why = f"`order` = {order!r} is not a number, or `as` is missing"
        remedy = "give `order` as a number, together with `as`"
        self.place.demand(bool(told) or order is None, why, remedy)
        if not told:
            return None
        first, end = approach(told, self._names("as"))
        return self.context.in_variables(first), self.context.in_variables(end)

    def _conditions(self, held: set[Symbol]) -> tuple[Boolean, ...]:
        """Return the conditions of the formulas that are called, and those of the claim."""
        found, bound, meant = set[Boolean](), set[Symbol](), self.context.meant
        for side in (self.left, self.right):
            written = side.xreplace(meant.as_written)
            found |= set(self.context.conditions(written))
            bound |= {over.limits[-1][0] for over in integrals(written)}
            bound |= {each.args[1] for each in written.atoms(Limit)}
        require, names = self.terms.require, self._names("require")
        for text in [require] if isinstance(require, str) else require:
            found.add(condition(text, names).xreplace(meant.in_variables))
        remedy = "correct `require`, or the arguments of the formulas that are called"
        self.place.demand(false not in found, "its conditions are never satisfied", remedy)
        inside = bound - held
        kept = [each for each in found if each != true and not each.free_symbols & inside]
        return tuple(sorted(kept, key=str))

    def _ranges(self) -> dict[Symbol, Range]:
        """Return the ranges of variables in this claim."""
        found, place = dict[Symbol, Range](), self.place.inside("ranges")
        for name, (low, high) in self.terms.ranges.items():
            symbol: Any = self.context.variables.get(name)
            place.demand(isinstance(symbol, Symbol), f"{name!r} is not a variable", "declare it")
            why = f"[{low:g}, {high:g}] is not a range of {name}"
            remedy = "write the lower end first, and none below zero for a positive variable"
            place.demand(low < high and (low >= 0 or not symbol.is_positive), why, remedy)
            found[symbol] = Range(low, high)
        return found

    def _cases(self) -> tuple[Mapping[Symbol, str], ...]:
        """Return the points that the claim prescribes."""
        known, points = self.context.variables, self.terms.cases
        for name in {name for each in points for name in each}:
            is_variable = isinstance(known.get(name), Symbol)
            why, remedy = f"cases: {name} is not a variable", "give numbers to variables"
            self.place.demand(is_variable, why, f"{remedy}, such as [{{ l = 1 }}]")
        return tuple({known[n]: str(number) for n, number in each.items()} for each in points)

    def _swaps(self, named: set[Symbol]) -> tuple[Symbol, ...]:
        """Return the names that may have been confused, by default all names in the equation."""
        defined, chosen = self.context.meant.in_variables.keys(), self.terms.swaps
        if chosen is None:
            return (*(s for s in defined if s in named), *sorted(named - defined, key=str))
        symbols = {**self.context.variables, **{s.name: s for s in defined}}
        for name in chosen:
            is_symbol = isinstance(symbols.get(name), Symbol)
            self.place.demand(is_symbol, f"swaps: {name!r} is not a symbol", "declare it")
        return tuple(symbols[name] for name in chosen)

    def _reached(self) -> Bound | None:
        """Return the replacements by which a bound is judged on both sides."""
        allowed, beyond = self.terms.allowed, self.terms.beyond
        if allowed is beyond is None:
            return None
        why, remedy = "only one of `allowed` and `beyond` is given", "write both, as allowed = "
        self.place.demand(bool(allowed and beyond), why, f'{remedy}{{ sigma = "..." }}')
        return Bound(self._changed(allowed or {}), self._changed(beyond or {}))

    def _conventions(self) -> tuple[Convention, ...]:
        """Return the sign conventions under which the claim is tried."""
        place = self.place.inside("a convention")
        read = [record(Reinterpretation, each, place) for each in self.terms.conventions]
        return tuple(Convention(e.what, self._changed(e.symbols), e.contradicts) for e in read)

    def _is_defined(self) -> bool:
        """Whether one side is a symbol and the file defines it by the other side."""
        terms, meant = self.terms, self.context.meant
        if terms.given is not None or terms.through or terms.allowed:
            return False
        for one, other in ((self.left, self.right), (self.right, self.left)):
            if one in meant.in_variables:
                words = meant.uses[one.name] | {one.name}
                table = {s: expr for s, expr in meant.as_written.items() if s.name in words}
                if one.xreplace(table) == other.xreplace(table):
                    return True
        return False

    def _demand_bound(self, left: Expr, right: Expr, meaning: Meaning) -> None:
        """Refuse variables of integration, except positions, that are also used outside."""
        meant = (meaning[s] for s in left.free_symbols | right.free_symbols if s in meaning)
        bound = {over.limits[-1][0] for over in integrals(left, right, *meant)}
        bound -= set(PLACES.values())
        table = {s: expr for s, expr in meaning.items() if s not in bound}
        held = left.xreplace(table).free_symbols | right.xreplace(table).free_symbols
        for along in sorted(bound & (held | meaning.keys()), key=str):
            why = f"{along} is a variable of integration and also used outside"
            remedy = "integrate over another variable, such as s or xi, in the integrand too"
            raise self.place.bad(why, remedy)

    def _demand_one_parameter(self, held: set[Symbol]) -> None:
        """Reject a meaning for a parameter of the body that formulas of the body also contain."""
        meant, body = self.context.meant, self.context.body
        used = {symbol.name for symbol in free(self.left, self.right)}
        used = used.union(*(meant.uses.get(name, ()) for name in used))
        for name in sorted(used & {*(body.parameters if body else ()), "E_star", "f"}):
            given = meant.in_variables.get(Symbol(name))
            if given is not None and self.context.variables.get(name) in held - given.free_symbols:
                why = f"{name} is defined as {given}, but formulas of the body also contain {name}"
                raise self.place.bad(why, f"use {name} in the other symbols instead")


def _texts(given: Mapping[str, Any], place: Place) -> AsPrinted:
    """Return the texts of a claim; other entries may be wrong."""
    keys = ("label", "place", "says", "equation", "printed", "latex", "understood")
    texts = (given[key] if isinstance(given.get(key), str) else "" for key in keys)
    label, where, says, equation, printed, latex, understood = texts
    where, says, text = where or Path(place.file).name, says or label, understood or printed
    return AsPrinted(label, where, says, equation, text, latex)


def _through(terms: Terms, left: Expr, names: Names, place: Place) -> tuple[Expr, ...]:
    """Return both sides of the equation by which a definition is judged, or nothing."""
    if not terms.through:
        return ()
    why = "`through` is given, but the left side is not a symbol"
    place.demand(isinstance(left, Symbol), why, "write the claim in the form symbol = ...")
    first, relation, second = equation(terms.through, names)
    is_equation = relation == Relation.EQUAL and (first.has(left) or second.has(left))
    why = f"`through` is not an equation that contains {left}"
    place.demand(is_equation, why, "write one that is true if the claim is true")
    is_argument = any(call.has(left) for call in calls_in(first, second))
    why = f"`through` contains {left} as an argument of one of the body's formulas"
    place.demand(not is_argument, why, f"use {left} only outside such calls")
    return first, second


def _lacking(names: list[str], meant: Meant) -> str:
    """Return the reason why a claim cannot be judged if some symbols have no meaning."""
    if wrong := next((name for name in names if name in meant.wrong), ""):
        return f"the symbol {wrong} has no meaning in this claim: {reason(meant.wrong[wrong])}"
    names = [*dict.fromkeys(meant.missing.get(name, name) for name in names)]
    have, them = ("symbols {} have", "them") if len(names) > 1 else ("symbol {} has", "it")
    told = have.format(", ".join(names))
    return f"the {told} no meaning: define {them} in [symbols] or [variables]"


def _variables(sides: tuple[Expr, ...], meaning: Meaning) -> set[Symbol]:
    """Return the variables of both sides, except variables of integration inside the integrals."""
    symbols = set().union(*(side.free_symbols for side in sides))
    held = set().union(*(meaning.get(symbol, symbol).free_symbols for symbol in symbols))
    outside = set().union(*(side.xreplace(dict(meaning)).free_symbols for side in sides))
    return held - ({over.limits[-1][0] for over in integrals(*sides)} - outside)


def _names_in(*sides: Expr) -> set[Symbol]:
    """Return the names in an equation, except the variables of integrals and limits."""
    along = {over.limits[-1][0] for over in integrals(*sides)}
    along |= {each.args[1] for side in sides for each in side.atoms(Limit, *IMPROPER)}
    return set().union(*(side.atoms(Symbol) for side in sides)) - along


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
