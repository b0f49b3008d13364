"""Read one table [[claims]] of a claims file.

In:   the entries of the table, the variables, and the meanings of the symbols.
Out:  the Claim, which is unchecked with the reason if an entry is wrong or a meaning is missing.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from sympy import Expr, Symbol

from derive.check import claim_options
from derive.check.claim import SIGNED, Bound, Claim, Convention, Meaning, Range
from derive.check.context import (
    PLACES,
    Context,
    Meant,
    Put,
    as_text,
    calls_in,
    free,
    integrals,
    with_real_bound,
)
from derive.check.entries import Entries, TimeLimit
from derive.check.meanings import Meanings, changed, demand_symbol, names_of
from derive.check.mistakes import reason
from derive.check.printed import Reading, may_be_rough, not_accepted, printed, waiting
from derive.check.variables import Variables
from derive.command.errors import NotAccepted, UserError
from derive.reading.formula import Names, UnknownName, equation, unknown
from derive.reading.relation import Relation

OF_A_CLAIM = (
    frozenset(("label", "place", "says", "printed", "latex", "understood", "expected", "symbols"))
    | {"part", "accepted"}
    | {"conventions", "unchecked", "require", "as", "order", "given", "body", "ranges", "through"}
    | {"allowed", "beyond", "leading", "swaps", "cases", "family", "equation", "against", "steps"}
    | {"consequence"}
)
"""The keys of a claim."""
_STRINGS = (
    *("place", "says", "printed", "latex", "understood", "unchecked", "as", "through"),
    *("family", "equation", "against", "consequence"),
)
"""Those that are strings, apart from the label."""
_OF_A_CONVENTION = frozenset({"what", "symbols", "contradicts"})


@dataclass(frozen=True)
class _Stated:
    """A claim whose equation has been read."""

    entries: Entries
    context: Context
    meant: Meant
    names: Names
    text: str
    left: Expr
    relation: Relation
    right: Expr
    through: tuple[Expr, Expr] | None


@dataclass
class ClaimReader:
    """Reads the claims of a file in their order, because one may follow from others.

    readings  the claims in LaTeX that are not accepted yet or cannot be read
    mistakes  the errors in claims, each of which makes its claim unchecked
    """

    variables: Variables
    meanings: Meanings
    limit: TimeLimit
    readings: list[Reading] = field(default_factory=list)
    mistakes: list[UserError] = field(default_factory=list)
    _read: dict[str, tuple[Expr, Expr]] = field(default_factory=dict)

    def claim(self, number: int, entries: Entries) -> Claim:
        """Return a claim, which must have a label; `number` counts the claims from 1."""
        given, label = entries.data, entries.text("label")
        common: dict[str, Any] = {
            "label": label,
            "place": str(given.get("place", Path(entries.place.file).name)),
            "says": str(given.get("says", label)),
            "latex": str(given.get("latex", "")),
            "equation": str(given.get("equation", "")),
            "family": str(given.get("family", "")),
            "consequence": str(given.get("consequence", "")),
            "seconds": self.limit.seconds,
        }
        told = str(given.get("understood", given.get("printed", "")))
        try:
            return self.limit.read(
                entries.place, lambda: self._claim(number, entries, told, common)
            )
        except UserError as error:
            self.mistakes.append(error)
            why = reason(error, entries.place)
            self._unread(number, entries, why)
            return Claim(unchecked=why, source=told, **common)

    def _claim(self, number: int, entries: Entries, told: str, common: dict[str, Any]) -> Claim:
        """Return a claim; raise UserError if one of its entries is wrong."""
        given, place = entries.data, entries.place
        entries.demand_known(OF_A_CLAIM)
        entries.demand_texts(*_STRINGS)
        _demand_flags(entries)
        common["steps"] = entries.texts("steps")
        common["expected"] = claim_options.expected(entries)
        context = self.variables.file
        if "body" in given:
            context = self.variables.of_body(given["body"], place)
        own = entries.table("symbols")
        for name in own:
            demand_symbol(name, own[name], place)
        symbols = {**self.meanings.symbols, **own}
        names = names_of(place, context, symbols)
        meant = self.meanings.of(context, own)
        if told:
            common["units"] = self.meanings.mismatch(told, place, context, meant, names)
        if "unchecked" in given:
            return Claim(unchecked=entries.text("unchecked"), source=told, **common)
        try:
            text = printed(entries, names, self.meanings.spellings)
            rough = may_be_rough(entries, text)
            left, relation, right = equation(text, names, rough)
        except NotAccepted as error:
            self.readings.append(waiting(number, entries, error, names))
            why = not_accepted(entries, error)
            return Claim(unchecked=why, source=error.understood, **common)
        except UnknownName as error:
            why = _lacking(unknown(error.given, names) or ["oo"], meant)
            if not told:
                self._unread(number, entries, why)
            return Claim(unchecked=why, source=told, **common)
        known = {Symbol(name) for name in symbols}
        left, right = (with_real_bound(side, known - meant.ours.keys()) for side in (left, right))
        if "given" in given:
            meant = self._follows(entries, symbols, meant)
        self._read[common["label"]] = left, right
        through = self._through(entries, left, names)
        sides = (left, right)
        if through is not None:
            sides = through[0].xreplace({left: right}), through[1].xreplace({left: right})
        open_ = free(*sides) & known - meant.ours.keys()
        if lacking := [name for name in symbols if Symbol(name) in open_]:
            return Claim(unchecked=_lacking(lacking, meant), source=told, **common)
        stated = _Stated(entries, context, meant, names, text, left, relation, right, through)
        return self._judged(stated, common)

    def _unread(self, number: int, entries: Entries, why: str) -> None:
        """Record that a claim in LaTeX cannot be read."""
        if "latex" in entries.data:
            label, latex = entries.text("label"), str(entries.data["latex"])
            self.readings.append(Reading(number, label, latex, understood="", why=why))

    def _judged(self, stated: _Stated, common: Mapping[str, Any]) -> Claim:
        """Return a claim that can be judged."""
        entries, context, meant = stated.entries, stated.context, stated.meant
        given, left, right = entries.data, stated.left, stated.right
        compared = stated.through or (left, right)
        calls = calls_in(left, right, *compared)
        put = Put(context, {call: Symbol(as_text(call)) for call in calls}, meant.ours)
        left, right = (put.without_calls(side) for side in (left, right))
        compared = put.without_calls(compared[0]), put.without_calls(compared[1])
        called = {**meant.ours, **put.called(meant.ours)}
        _demand_bound(entries, left, right, called)
        held = _variables(*compared, called) - _inside(*compared, called)
        _demand_one_parameter(stated, held)
        known = names_of(entries.place, context, [s.name for s in put.meaning])
        rounded = claim_options.rounded(stated.text, known)
        relation = stated.relation
        if relation == Relation.LIKE and not given.keys() & {"as", "leading"}:
            relation = Relation.EQUAL
        sides = stated.left, stated.right
        named = claim_options.names_in(*sides)
        conditions = claim_options.conditions(entries, sides, context, meant, held)
        held = held.union(*(each.free_symbols for each in conditions))
        reached = self._reached(entries, put)
        if reached is not None:
            replaced = (*reached.allowed.values(), *reached.beyond.values())
            held = held.union(*(expr.free_symbols for expr in replaced))
        ranges = self.variables.ranges | claim_options.ranges(entries, context)
        return Claim(
            left=left,
            right=right,
            relation=relation,
            reached=reached,
            meaning=called,
            against=self._against(entries, context),
            ranges=_places(held) | {s: r for s, r in ranges.items() if s in held},
            conditions=conditions,
            defined=_is_defined(stated),
            through=compared if stated.through else None,
            cases=claim_options.cases(entries, context),
            toward=claim_options.toward(entries, context, meant),
            order=claim_options.order(entries),
            rounded=rounded,
            conventions=self._conventions(entries, put),
            source=stated.text,
            reading=partial(claim_options.reading, known, put),
            swaps=claim_options.swaps(entries, named, context, meant),
            unit_of=self.meanings.units_of(named | held, context, meant),
            **common,
        )

    def _against(self, entries: Entries, context: Context) -> str:
        """Describe what a claim is compared with."""
        if "against" in entries.data:
            return str(entries.data["against"])
        sheet, claims = context.sheet, ", ".join(map(str, entries.data.get("given", ())))
        told = f" and the formula sheet of {sheet.geometry.name}" if sheet else ""
        return f"the formulas of {entries.place.file}{told}" + (
            f", given {claims}" if claims else ""
        )

    @staticmethod
    def _through(entries: Entries, left: Expr, names: Names) -> tuple[Expr, Expr] | None:
        """Return both sides of the equation by which a definition is judged."""
        if "through" not in entries.data:
            return None
        place = entries.place
        if not isinstance(left, Symbol):
            why = "`through` is given, but the left side is not a symbol"
            raise place.bad(why, "write the claim in the form symbol = ...")
        first, relation, second = equation(entries.text("through"), names)
        if relation != Relation.EQUAL or not (first.has(left) or second.has(left)):
            why = f"`through` is not an equation that contains {left}"
            raise place.bad(why, "write one that is true if the claim is true")
        if any(call.has(left) for call in calls_in(first, second)):
            why = f"`through` contains {left} as an argument of one of the body's formulas"
            raise place.bad(why, f"use {left} only outside such calls")
        return first, second

    def _reached(self, entries: Entries, put: Put) -> Bound | None:
        """Return the replacements by which a bound is judged on both sides."""
        if not entries.data.keys() & {"allowed", "beyond"}:
            return None
        tables = [entries.table(key) for key in ("allowed", "beyond")]
        if not all(tables):
            why = "only one of `allowed` and `beyond` is given"
            raise entries.place.bad(why, 'write both, as allowed = { sigma = "..." }')
        return Bound(*(self._changed(entries, table, put) for table in tables))

    def _conventions(self, entries: Entries, put: Put) -> tuple[Convention, ...]:
        """Return the sign conventions under which a claim is tried."""
        made = []
        for each in entries.tables("conventions", "[{ what = ... }]"):
            inner = Entries(entries.place.inside("a convention"), each)
            inner.demand_known(_OF_A_CONVENTION)
            what, against = inner.text("what"), inner.text("contradicts")
            made.append(
                Convention(what, self._changed(entries, inner.table("symbols"), put), against)
            )
        return tuple(made)

    def _changed(self, entries: Entries, symbols: Mapping[str, Any], put: Put) -> Meaning:
        """Return the meanings that change if some symbols of a claim are redefined."""
        for name, said in symbols.items():
            demand_symbol(name, said, entries.place)
        own = {**entries.table("symbols"), **symbols}
        return changed(put, self.meanings.of(put.context, own))

    def _follows(self, entries: Entries, symbols: Iterable[str], meant: Meant) -> Meant:
        """Return the meanings if other claims are true; symbols without one become variables."""
        place, table = entries.place.inside("given"), dict[Symbol, Expr]()
        for label in entries.texts("given"):
            if label not in self._read:
                remedy = "give the label of an earlier claim that can be read"
                raise place.bad(f"{label!r} is not the label of an earlier claim", remedy)
            left, right = self._read[label]
            if not isinstance(left, Symbol):
                left, right = right, left
            if not isinstance(left, Symbol) or right.has(left):
                why = f"the claim {label!r} does not define a symbol"
                raise place.bad(why, "give claims of the form symbol = ...")
            table[left] = right
        for name in symbols:
            if Symbol(name) not in meant.ours and Symbol(name) not in table:
                table[Symbol(name)] = Symbol(name, positive=True)
        ours = {s: e for s, e in meant.ours.items() if s not in table}
        for _ in table:
            table = {s: expr.xreplace(table) for s, expr in table.items()}
        if any(expr.free_symbols & table.keys() for expr in table.values()):
            raise place.bad("the claims are circular", "remove one of them")
        return Meant(table, {**ours, **{s: expr.xreplace(ours) for s, expr in table.items()}})


def _demand_flags(entries: Entries) -> None:
    """Refuse values of `accepted` and `leading` that mean nothing."""
    given = entries.data
    for key, allowed in (("accepted", (True, False)), ("leading", (True,))):
        if not any(given.get(key, True) is each for each in allowed):
            written = " or ".join(f"{key} = {str(each).lower()}" for each in allowed)
            raise entries.place.bad(f"{key} = {given[key]!r} is not allowed", f"write {written}")


def _lacking(names: list[str], meant: Meant) -> str:
    """Return the reason why a claim cannot be judged if some symbols have no meaning."""
    if wrong := next((name for name in names if name in meant.wrong), ""):
        return f"the symbol {wrong} has no meaning in this claim: {reason(meant.wrong[wrong])}"
    names = [*dict.fromkeys(meant.lacks.get(name, name) for name in names)]
    listed = ", ".join(names)
    if len(names) > 1:
        return f"the symbols {listed} have no meaning: define them in [symbols] or [variables]"
    return f"the symbol {listed} has no meaning: define it in [symbols] or [variables]"


def _is_defined(stated: _Stated) -> bool:
    """Whether one side is a symbol and the file defines it by the other side."""
    if stated.entries.data.keys() & {"given", "through", "allowed"}:
        return False
    meant = stated.meant
    for one, other in ((stated.left, stated.right), (stated.right, stated.left)):
        if one in meant.ours:
            words = meant.needs[one.name] | {one.name}
            table = {s: expr for s, expr in meant.written.items() if s.name in words}
            if one.xreplace(table) == other.xreplace(table):
                return True
    return False


def _demand_bound(entries: Entries, left: Expr, right: Expr, meaning: Meaning) -> None:
    """Refuse variables of integration, except positions, that are also used outside."""
    meant = (meaning[s] for s in left.free_symbols | right.free_symbols if s in meaning)
    bound = {over.limits[-1][0] for over in integrals(left, right, *meant)}
    bound -= set(PLACES.values())
    table = {s: expr for s, expr in meaning.items() if s not in bound}
    held = left.xreplace(table).free_symbols | right.xreplace(table).free_symbols
    for along in sorted(bound & (held | meaning.keys()), key=str):
        why = f"{along} is a variable of integration and also used outside"
        remedy = "integrate over another variable, such as s or xi, in the integrand too"
        raise entries.place.bad(why, remedy)


def _demand_one_parameter(stated: _Stated, held: set[Symbol]) -> None:
    """Reject a meaning for a parameter of the body that formulas of the body also contain."""
    context, meant = stated.context, stated.meant
    used = {symbol.name for symbol in free(stated.left, stated.right)}
    used = used.union(*(meant.needs.get(name, ()) for name in used))
    for name in sorted(used & {*context.parameters, "E_star", "f"}):
        ours = meant.ours.get(Symbol(name))
        if ours is not None and context.variables.get(name) in held - ours.free_symbols:
            why = f"{name} is defined as {ours}, but formulas of the body also contain {name}"
            raise stated.entries.place.bad(why, f"use {name} in the other symbols instead")


def _variables(left: Expr, right: Expr, meaning: Meaning) -> set[Symbol]:
    """Return the variables in both sides or in the meanings of their symbols."""
    held = left.free_symbols | right.free_symbols
    return set().union(*(meaning.get(symbol, symbol).free_symbols for symbol in held))


def _inside(left: Expr, right: Expr, meaning: Meaning) -> set[Symbol]:
    """Return the variables of integration on which neither side depends."""
    along = {over.limits[-1][0] for over in integrals(left, right)}
    table = dict(meaning)
    return along - left.xreplace(table).free_symbols - right.xreplace(table).free_symbols


def _places(held: set[Symbol]) -> dict[Symbol, Range]:
    """Return the default range of positions, which is symmetric about zero."""
    return {place: SIGNED for place in PLACES.values() if place in held}
