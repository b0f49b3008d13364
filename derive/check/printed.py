"""Read the equation of a claim from its text or from its LaTeX.

In:   the entries of a claim, the names that it may hold, and the LaTeX of symbols.
Out:  the equation as text.  NotAccepted is raised if the file does not accept the way in which the
      LaTeX was read; a Reading then shows it to the user.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from derive.check.entries import Entries
from derive.check.mistakes import reason
from derive.command.errors import BadFormula, NotAccepted
from derive.reading.formula import Names, equation, may_be_rounded
from derive.reading.latex import Latex
from derive.reading.lexer import plain
from derive.reading.statements import statements

_BESIDE = ("as", "order", "require", "given")
"""The entries that are shown with a reading, because the verdict depends on them."""


@dataclass(frozen=True)
class Reading:
    """The reading of a claim's LaTeX that the file does not accept yet.

    number      the number of the claim in the file, counted from 1
    understood  the equation as text; empty if the claim cannot be read
    accepted    the different reading that the file accepts; empty if there is none
    beside      the entries of the claim that its verdict depends on, such as `as` and `require`
    why         the reason why the claim cannot be judged even if this reading is accepted
    """

    number: int
    label: str
    latex: str
    understood: str
    accepted: str = ""
    beside: Mapping[str, str] = field(default_factory=dict)
    why: str = ""


def printed(claim: Entries, names: Names, spellings: Mapping[str, str]) -> str:
    """Return the printed equation as text; raises NotAccepted."""
    given, place = claim.data, claim.place
    if ("printed" in given) == ("latex" in given):
        raise place.bad("give exactly one of `printed` and `latex`", "give exactly one")
    if "printed" in given:
        return claim.text("printed")
    spelled = {**{n: n for n in names.symbols}, **_usual(names), **spellings}
    understood = _understood(claim, spelled)
    accepted = str(given.get("understood", ""))
    if given.get("accepted") is False:
        raise NotAccepted(str(place), understood, "")
    both = [equation(text, names, rough=True) for text in (accepted or understood, understood)]
    if not accepted or both[0] != both[1]:
        raise NotAccepted(str(place), understood, accepted)
    return accepted


def may_be_rough(claim: Entries, text: str) -> bool:
    """Whether an equation may use ~, because it has a limit or a rounded constant."""
    return bool(claim.data.keys() & {"as", "leading"}) or may_be_rounded(text)


def waiting(number: int, claim: Entries, error: NotAccepted, names: Names) -> Reading:
    """Return the reading that waits for the user."""
    given = claim.data
    beside = {key: _shown(given[key]) for key in _BESIDE if key in given}
    understood, why = error.understood, ""
    try:
        equation(understood, names, rough=may_be_rough(claim, understood))
    except BadFormula as fault:
        why = reason(fault, claim.place)
    label, latex = claim.text("label"), claim.text("latex")
    return Reading(number, label, latex, understood, error.accepted, beside, why)


def not_accepted(claim: Entries, error: NotAccepted) -> str:
    """Return the reason why a claim waits for the user, and what the user can do."""
    said = f"the file accepts {error.accepted}" if error.accepted else "the file does not accept it"
    by_hand = f'understood = "{error.understood}"'
    if claim.data.get("accepted") is False:
        by_hand = "accepted = true"
    return f"the LaTeX was read as {error.understood}, but {said}: use --accept, or write {by_hand}"


def _understood(claim: Entries, spelled: Mapping[str, str]) -> str:
    """Return the LaTeX of a claim, or one statement in its display, as text."""
    latex = claim.text("latex")
    reader = Latex(str(claim.place), latex, spelled)
    if "part" not in claim.data:
        return reader.understood()
    found, part = statements(str(claim.place), latex), claim.data["part"]
    if type(part) is not int or not 1 <= part <= len(found):
        why = f"part = {part!r} is not the number of a statement in this display"
        raise claim.place.bad(why, f"write a number from 1 to {len(found)}")
    printed = found[part - 1]
    if (printed.condition or printed.order) and not claim.data.keys() & {"require", "as"}:
        says = plain(printed.condition) or rf"{printed.small} \to 0"
        why = f"the display also says {says}, but neither `require` nor `as` is given"
        raise claim.place.bad(why, "give the condition in `require`, or the limit in `as`")
    return reader.equation(printed.tokens)


def _shown(entry: object) -> str:
    return " and ".join(map(str, entry)) if isinstance(entry, list) else str(entry)


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
