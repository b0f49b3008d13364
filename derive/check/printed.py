"""Read the equation of a claim that is given in LaTeX.

In:   the table of the claim, the names that it may hold, and the LaTeX of symbols.
Out:  a Reading: the equation as text, and whether the file accepts it.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from derive.check.mistakes import reason
from derive.check.schema import Entry, Place
from derive.command.errors import BadFormula
from derive.reading.formula import Names, equation, may_be_rounded
from derive.reading.latex import Latex
from derive.reading.lexer import plain
from derive.reading.statements import statements


@dataclass(frozen=True)
class Reading:
    """The reading of a claim's LaTeX.

    number      the number of the claim in the file, counted from 1
    understood  the equation as text; empty if the claim cannot be read
    why         the reason why the claim cannot be judged even if this reading is accepted
    """

    number: int
    entry: Entry
    understood: str
    why: str = ""

    @property
    def accepted(self) -> str:
        """The different reading that the file accepts, if there is one."""
        return self.entry.understood if self.entry.accepted else ""

    @property
    def to_accept(self) -> str:
        """The entry by which the file accepts the reading."""
        return f'understood = "{self.understood}"' if self.entry.accepted else "accepted = true"

    @property
    def shown(self) -> dict[str, str]:
        """What the user sees before accepting it."""
        told = {"LaTeX": self.entry.latex.strip(), "understood": self.understood}
        told |= {"in the file": self.accepted, **self.entry.beside, "unchecked": self.why}
        return {key: text for key, text in told.items() if text}

    @property
    def remedy(self) -> str:
        """What the file says of the reading, and what the user can do."""
        said = f"accepts {self.accepted}" if self.accepted else "does not accept it"
        why = f"the LaTeX was read as {self.understood}, but the file {said}"
        return f"{why}: use --accept, or write {self.to_accept}"


def open_reading(
    number: int, entry: Entry, place: Place, names: Names, spellings: Mapping[str, str]
) -> Reading | None:
    """Return the reading of a claim's LaTeX, or None if the file accepts it in some form."""
    spelled = {**{n: n for n in names.symbols}, **_usual(names), **spellings}
    understood, accepted = _understood(entry, place, spelled), entry.understood
    if entry.accepted:
        both = [equation(text, names, rough=True) for text in (accepted or understood, understood)]
        if accepted and both[0] == both[1]:
            return None
    why = ""
    try:
        equation(understood, names, may_be_rough(entry, understood))
    except BadFormula as fault:
        why = reason(fault, place)
    return Reading(number, entry, understood, why)


def may_be_rough(entry: Entry, text: str) -> bool:
    """Whether an equation may use ~, because it has a limit or a rounded constant."""
    return bool(entry.approach or entry.leading) or may_be_rounded(text)


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


def _usual(names: Names) -> dict[str, str]:
    r"""Return the usual LaTeX of names: a_{1} for a_1, \alpha for alpha, \alpha_0 for alpha_0."""
    found = {}
    for name in names.symbols:
        stem, _, index = name.partition("_")
        letter = stem if len(stem) == 1 else rf"\{stem}"
        if index:
            found[f"{letter}_{{{index}}}"] = name
            if len(index) == 1:
                found[f"{letter}_{index}"] = name
        else:
            found[letter] = name
    return found
