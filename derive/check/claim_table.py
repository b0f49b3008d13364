"""Read one table [[claims]] of a claims file.

In:   the table, and the declarations of the file.
Out:  the Claim, which is unchecked with the reason if an entry is wrong or a meaning is missing.
"""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

from msgspec.structs import replace as with_entries
from sympy import Expr, Symbol

from derive.check.bodies import body_of
from derive.check.claim import AsMeant, Claim
from derive.check.context import Context, as_text, calls_in, free, with_real_bound
from derive.check.declarations import Declarations, demand_name
from derive.check.equation import Equation
from derive.check.mistakes import Collected, limited, reason
from derive.check.schema import Entry, Formula, Place, decoded
from derive.command.errors import BadFormula, UserError
from derive.reading.formula import (
    Names,
    UnknownName,
    equation,
    rounded_in,
    unknown,
    usable,
)
from derive.reading.formula import sides as sides_of
from derive.reading.latex import Latex
from derive.reading.lexer import plain
from derive.reading.relation import Relation
from derive.reading.statements import statements


@dataclass
class ClaimReader:
    """Reads the claims of a file in their order, because one may follow from others.

    mistakes  the errors in claims, each of which makes its claim unchecked
    """

    declared: Declarations
    mistakes: list[UserError] = field(default_factory=list)
    _defined: dict[str, tuple[str, str]] = field(default_factory=dict)
    _made: dict[str, Claim] = field(default_factory=dict)
    _contexts: dict[tuple[object, ...], Context] = field(default_factory=dict)

    def claim(self, given: Mapping[str, Any], place: Place) -> Claim:
        """Return a claim, which must have a label."""
        wrong, seconds = Collected(), self.declared.seconds
        entry = decoded(Entry, given, place, wrong.noted)
        where, says = entry.place or Path(place.file).name, entry.says or entry.label
        claim = Claim(
            with_entries(entry, place=where, says=says),
            text=entry.understood or entry.printed,
            at=f"{Path(place.file).name}:{place.line}" if place.line else "",
            seconds=seconds,
        )
        if not wrong:
            with wrong.noted():
                own = entry.symbols
                context = limited(seconds, place, lambda: self._context(place, entry.body, own))
                claim = replace(claim, units=context.mismatch(claim.text, place))
                claim = limited(seconds, place, lambda: self._claim(claim, place, context))
        if wrong:
            why = "; ".join(reason(error, place) for error in wrong)
            claim = replace(claim, unchecked=why)
        self.mistakes += wrong
        self._made[entry.label] = claim
        return claim

    def wrong_symbols(self, bodies: Iterable[object]) -> list[UserError]:
        """Return the errors in symbols that have no meaning with the file's body or another one."""
        place = self.declared.place
        found, others = self._context(place).wrong, list[Mapping[str, UserError]]()
        for body in bodies:
            with suppress(UserError):  # which makes the claim unchecked
                others.append(self._context(place, body).wrong)
        return [error for name, error in found.items() if all(name in each for each in others)]

    def _context(
        self, place: Place, given: object = None, own: Mapping[str, Formula] = MappingProxyType({})
    ) -> Context:
        """Return the context of a claim with its own body, if it gives one, and own symbols."""
        body = self.declared.body if given is None else body_of(given, place)
        for name in own:
            demand_name(name, place)
        texts, file = {name: str(text).strip() for name, text in own.items()}, self.declared
        key = body, *sorted(texts.items())
        if own and key not in self._contexts:
            self._contexts[key] = self._context(place, given).replaced(texts)
        elif key not in self._contexts:
            self._contexts[key] = Context(file, body, file.symbols, file.variables_with(body))
        return self._contexts[key]

    def _redefined(self, entry: Entry, place: Place, changed: Mapping[str, Formula]) -> Context:
        """Return the context with the symbols that the given claims define, and others changed."""
        own = {**entry.symbols, **changed}
        context = self._context(place, entry.body, own)
        if entry.given is None:
            return context
        known = {name for name, text in context.symbols.items() if text}
        given = self._given(entry.given, place.inside("given"))
        given = {name: text for name, text in given.items() if name not in known & own.keys()}
        return context.replaced(given, known, is_open=True)

    def _claim(self, claim: Claim, place: Place, context: Context) -> Claim:
        """Return a claim; raise UserError if one of its entries is wrong."""
        entry, names, own = claim.entry, context.names(place), context
        if entry.unchecked:
            return _unjudged(claim, context, names, entry.unchecked)
        is_one = bool(entry.printed) != bool(entry.latex)
        place.demand(is_one, "`printed` and `latex` exclude each other", "give exactly one of them")
        try:
            if entry.latex:
                claim = _as_read(claim, place, names, self.declared.spellings)
            if claim.to_accept:
                return _unjudged(claim, context, names, claim.unchecked)
            left, relation, right = equation(claim.text, names, _may_be_rough(entry, claim.text))
            if entry.given is not None:
                context = self._redefined(entry, place, {})
                names = context.names(place)
                left, relation, right = equation(claim.text, names, rough=True)
        except UnknownName as error:
            lacking = unknown(error.given, names) or ["oo"]
            return replace(claim, unchecked=context.lack(lacking))
        undefined = {Symbol(name) for name in context.symbols} - context.meaning.keys()
        left, right = (with_real_bound(side, undefined) for side in (left, right))
        both = sides_of(claim.text, names)
        name, formula = both if usable(both[0]) else reversed(both)
        is_general = not (entry.symbols or entry.cases or entry.body is not None)
        if is_general and relation == Relation.EQUAL and usable(name):
            self._defined[entry.label] = name, formula
        through = _through(entry, left, names, place)
        sides = [side.xreplace({left: right}) for side in through] or [left, right]
        if lacking := [n for n in context.symbols if Symbol(n) in free(*sides) & undefined]:
            return _unjudged(claim, context, names, context.lack(lacking))
        redefined = partial(self._redefined, entry, place)
        read = left, relation, right, through
        stated = Equation(entry, claim.text, place, context, redefined, *read)
        made = context.described(claim, left, right, *through)
        file, sheet = f"the formulas of {Path(place.file).name}", context.sheet
        named = f"{file} and the formula sheet of {sheet.geometry.name}" if sheet else file
        against = entry.against or named
        made = replace(made, meant=stated.meant(), against=against)
        if not entry.given:
            return made
        given = tuple(self._made[label] for label in entry.given)
        return made.changed(given=given, alone=self._alone(claim, place, own))

    def _alone(self, claim: Claim, place: Place, context: Context) -> Claim | None:
        """Return the claim without those given, if it can be judged by the file's own meanings."""
        entry = with_entries(claim.entry, given=None)
        try:
            made = self._claim(replace(claim, entry=entry), place, context)
        except UserError:
            return None
        return None if made.unchecked else made

    def _given(self, labels: list[str], place: Place) -> dict[str, str]:
        """Return the formulas of the symbols that earlier claims define."""
        for label in labels:
            why = f"{label!r} is not the label of an earlier claim of the form symbol = ..."
            remedy = "give one that can be read and has no symbols, body or cases of its own"
            place.demand(label in self._defined, why, remedy)
        return dict(self._defined[label] for label in labels)


def _unjudged(claim: Claim, context: Context, names: Names, why: str) -> Claim:
    """Return an unchecked claim with its equation as it was read, if that is possible."""
    with suppress(UserError):
        left, relation, right = equation(claim.text, names, rough=True)
        calls = {call: Symbol(as_text(call)) for call in calls_in(left, right)}
        meant = AsMeant(left.xreplace(calls), right.xreplace(calls), relation)
        claim = replace(context.described(claim, left, right), meant=meant)
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


# ------------------------------------------------------------------ a claim in LaTeX


def _as_read(claim: Claim, place: Place, names: Names, spellings: Mapping[str, str]) -> Claim:
    """Return a claim with the reading of its LaTeX.

    It is unchecked unless the file accepts this reading or another text for the same equation.
    """
    entry = claim.entry
    spelled = {latex: name for name in names.symbols for latex in (name, *_usual(name))}
    spelled |= spellings
    understood = _understood(entry, place, spelled)
    accepted = entry.understood if entry.accepted else ""
    if entry.accepted:
        read = equation(understood, names, rough=True)
        if accepted and equation(accepted, names, rough=True) == read:
            return claim
    obstacle = ""
    try:
        equation(understood, names, _may_be_rough(entry, understood))
    except BadFormula as fault:
        obstacle = reason(fault, place)
    to_accept = f'understood = "{understood}"' if entry.accepted else "accepted = true"
    said = f"accepts {accepted}" if accepted else "does not accept it"
    why = f"the LaTeX was read as {understood}, but the file {said}"
    why = f"{why}: use --accept, or write {to_accept}{'; ' * bool(obstacle)}{obstacle}"
    return replace(claim, text=understood, to_accept=to_accept, obstacle=obstacle, unchecked=why)


def _may_be_rough(entry: Entry, text: str) -> bool:
    """Whether an equation may use ~, because it has a limit or a rounded constant."""
    return bool(entry.approach or entry.leading or rounded_in(text))


def _understood(entry: Entry, place: Place, spelled: Mapping[str, str]) -> str:
    """Return the LaTeX of a claim, or one statement in its display, as text."""
    latex, part = entry.latex, entry.part
    found = statements(str(place), latex)
    if part is None and len(found) != 1:
        why = f"the LaTeX has {len(found)} statements"
        raise place.bad(why, "give the number of one of them as `part`")
    part = part or 1
    if not 1 <= part <= len(found):
        why = f"part = {part!r} is not the number of a statement in this display"
        raise place.bad(why, f"write a number from 1 to {len(found)}")
    chosen = found[part - 1]
    if (chosen.conditions or chosen.order) and not (entry.require or entry.approach):
        says = ", ".join(map(plain, chosen.conditions)) or rf"{chosen.small} \to 0"
        why = f"the display also says {says}, but neither `require` nor `as` is given"
        raise place.bad(why, "give the condition in `require`, or the limit in `as`")
    return Latex(str(place), latex, spelled).read("equation", chosen.tokens)


def _usual(name: str) -> list[str]:
    r"""Return the usual LaTeX of a name: a_1 and a_{1} for a_1, \alpha for alpha."""
    stem, _, index = name.partition("_")
    letter = stem if len(stem) == 1 else rf"\{stem}"
    short = [f"{letter}_{index}"] if len(index) == 1 else []
    return [f"{letter}_{{{index}}}", *short] if index else [letter]
