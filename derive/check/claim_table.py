"""Read one table [[claims]] of a claims file.

In:   the table, and the declarations of the file.
Out:  the Claim, which is unchecked with the reason if an entry is wrong or a meaning is missing.
"""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from msgspec.structs import replace as with_entries
from sympy import Expr, Symbol

from derive.check.claim import AsMeant, Claim
from derive.check.context import (
    Context,
    Meant,
    as_text,
    calls_in,
    free,
    with_real_bound,
)
from derive.check.declarations import Declarations
from derive.check.equation import Equation
from derive.check.mistakes import Collected, limited, reason
from derive.check.printed import Reading, may_be_rough, open_reading
from derive.check.schema import Entry, Place, decoded
from derive.command.errors import UserError
from derive.reading.formula import (
    Names,
    UnknownName,
    equation,
    unknown,
    usable,
)
from derive.reading.formula import sides as sides_of
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
    _read: dict[str, tuple[Relation, str, str]] = field(default_factory=dict)
    _made: dict[str, Claim] = field(default_factory=dict)

    def claim(self, number: int, given: Mapping[str, Any], place: Place) -> Claim:
        """Return a claim, which must have a label; `number` counts the claims from 1."""
        wrong, seconds = Collected(), self.declared.seconds
        entry = decoded(Entry, given, place, wrong.noted)
        where, says = entry.place or Path(place.file).name, entry.says or entry.label
        claim = Claim(
            with_entries(entry, place=where, says=says),
            text=entry.understood or entry.printed,
            at=f"{Path(place.file).name}:{place.line}" if place.line else "",
            seconds=seconds,
        )
        if wrong.errors:
            self.mistakes += wrong.errors
            why = "; ".join(reason(error, place) for error in wrong.errors)
            return self._unread(number, claim, why)
        try:
            context = limited(
                seconds, place, lambda: self.declared.context(place, entry.body, entry.symbols)
            )
            claim = replace(claim, units=context.mismatch(claim.text, place))
            made = limited(seconds, place, lambda: self._claim(number, claim, place, context))
        except UserError as error:
            self.mistakes.append(error)
            made = self._unread(number, claim, reason(error, place))
        self._made[claim.entry.label] = made
        return made

    def _unread(self, number: int, claim: Claim, why: str) -> Claim:
        """Return an unchecked claim, and record that its LaTeX cannot be read."""
        if claim.entry.latex:
            self.readings.append(Reading(number, claim.entry, "", why))
        return replace(claim, unchecked=why)

    def _redefined(self, entry: Entry, place: Place, changed: Mapping[str, Any]) -> Context:
        """Return the context with the symbols that the given claims define, and others changed."""
        given = self._given(entry.given or (), place.inside("given"))
        own = {**entry.symbols, **changed}
        known = {**self.declared.symbols, **own}
        own |= {name: formula for name, formula in given.items() if not known.get(name)}
        context = self.declared.context(place, entry.body, own, entry.given is not None)
        others = {name: formula for name, formula in given.items() if name not in own}
        return context.replaced(others, place.inside("given")) if others else context

    def _claim(self, number: int, claim: Claim, place: Place, context: Context) -> Claim:
        """Return a claim; raise UserError if one of its entries is wrong."""
        entry, names, own = claim.entry, context.names(place), context
        if entry.unchecked:
            return _unjudged(claim, context, names, entry.unchecked)
        is_one = bool(entry.printed) != bool(entry.latex)
        place.demand(is_one, "`printed` and `latex` exclude each other", "give exactly one of them")
        try:
            if entry.latex:
                reading = open_reading(number, entry, place, names, self.declared.spellings)
                if reading is not None:
                    self.readings.append(reading)
                    why = "; ".join(filter(None, (reading.remedy, reading.why)))
                    claim = replace(claim, text=reading.understood, to_accept=reading.to_accept)
                    return _unjudged(claim, context, names, why)
            left, relation, right = equation(claim.text, names, may_be_rough(entry, claim.text))
        except UnknownName as error:
            why = self._lacking(unknown(error.given, names) or ["oo"], context.meant)
            return replace(claim, unchecked=why) if claim.text else self._unread(number, claim, why)
        if entry.given is not None:
            context = self._redefined(entry, place, {})
            names = context.names(place)
            left, relation, right = equation(claim.text, names, may_be_rough(entry, claim.text))
        undefined = {Symbol(name) for name in context.symbols} - context.meant.in_variables.keys()
        left, right = (with_real_bound(side, undefined) for side in (left, right))
        self._read[entry.label] = relation, *sides_of(claim.text, names)
        through = _through(entry, left, names, place)
        sides = [side.xreplace({left: right}) for side in through] or [left, right]
        if lacking := [n for n in context.symbols if Symbol(n) in free(*sides) & undefined]:
            return _unjudged(claim, context, names, self._lacking(lacking, context.meant))
        stated = Equation(
            self.declared,
            entry,
            place,
            context,
            partial(self._redefined, entry, place),
            claim.text,
            left,
            relation,
            right,
            through,
            tuple(self._made[label] for label in entry.given or ()),
        )
        symbols, words = context.definitions(left, right, *through)
        made = replace(claim, meant=stated.meant(), symbols=symbols, words=words)
        made = replace(made, against=stated.against())
        return made.changed(alone=self._alone(number, claim, place, own)) if entry.given else made

    def _lacking(self, names: list[str], meant: Meant) -> str:
        """Return the reason why a claim cannot be judged if some symbols have no meaning."""
        if wrong := next((name for name in names if name in meant.wrong), ""):
            return f"the symbol {wrong} has no meaning in this claim: {reason(meant.wrong[wrong])}"
        names = [*dict.fromkeys(meant.missing.get(name, name) for name in names)]
        have, them = ("symbols {} have", "them") if len(names) > 1 else ("symbol {} has", "it")
        told = f"the {have.format(', '.join(names))} no meaning"
        why = self.declared.paper.reasons(names)
        return f"{told}: define {them} in [symbols] or [variables]{why}"

    def _alone(self, number: int, claim: Claim, place: Place, context: Context) -> Claim | None:
        """Return the claim without those given, if it can be judged by the file's own meanings."""
        entry = with_entries(claim.entry, given=None)
        try:
            made = self._claim(number, replace(claim, entry=entry), place, context)
        except UserError:
            return None
        return None if made.unchecked else made

    def _given(self, labels: Iterable[str], place: Place) -> dict[str, str]:
        """Return the formulas of the symbols that earlier claims define."""
        found = dict[str, str]()
        for label in labels:
            why = f"{label!r} is not the label of an earlier claim"
            remedy = "give the label of an earlier claim that can be read"
            place.demand(label in self._read, why, remedy)
            relation, *both = self._read[label]
            name, formula = both if usable(both[0]) else reversed(both)
            is_definition = relation == Relation.EQUAL and usable(name)
            why = f"the claim {label!r} does not define a symbol"
            place.demand(is_definition, why, "give claims of the form symbol = ...")
            own = self._made[label].entry
            why = f"the claim {label!r} has symbols, a body or cases of its own"
            is_general = not (own.symbols or own.cases or own.body is not None)
            place.demand(is_general, why, "state it without them, because others do not share them")
            found[name] = formula
        return found


def _unjudged(claim: Claim, context: Context, names: Names, why: str) -> Claim:
    """Return an unchecked claim with its equation as it was read, if that is possible."""
    with suppress(UserError):
        left, relation, right = equation(claim.text, names, rough=True)
        calls = {call: Symbol(as_text(call)) for call in calls_in(left, right)}
        meant = AsMeant(left.xreplace(calls), right.xreplace(calls), relation)
        symbols, words = context.definitions(left, right)
        claim = replace(claim, meant=meant, symbols=symbols, words=words)
    return replace(claim, unchecked=why)


def _through(entry: Entry, left: Expr, names: Names, place: Place) -> tuple[Expr, ...]:
    """Return both sides of the equation by which a definition is judged, or nothing."""
    if not entry.through:
        return ()
    first, relation, second = equation(entry.through, names)
    is_argument = any(call.has(left) for call in calls_in(first, second))
    is_equation = relation == Relation.EQUAL and (first.has(left) or second.has(left))
    why = f"`through` is not an equation that contains the symbol {left} outside of calls"
    remedy = "write one that is true if the claim is true, and the claim as symbol = ..."
    is_right = isinstance(left, Symbol) and is_equation and not is_argument
    place.demand(is_right, why, remedy)
    return first, second
