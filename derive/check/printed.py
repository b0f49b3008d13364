"""Read the equation of a claim from its text or from its LaTeX.

In:   the entries of a claim, the names that it may hold, and the LaTeX of symbols.
Out:  the equation as text.  NotAccepted is raised if the file does not accept the way in which the
      LaTeX was read; a Reading then shows it to the user.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from derive.check.mistakes import reason
from derive.check.schema import AsPrinted, Place, Terms
from derive.command.errors import BadFormula, NotAccepted
from derive.reading.formula import Names, equation, may_be_rounded
from derive.reading.latex import Latex
from derive.reading.lexer import plain
from derive.reading.statements import statements


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


def equation_text(
    printed: AsPrinted, terms: Terms, place: Place, names: Names, spellings: Mapping[str, str]
) -> str:
    """Return the printed equation as text; raises NotAccepted."""
    if bool(printed.text) == bool(printed.latex):
        raise place.bad("give exactly one of `printed` and `latex`", "give exactly one")
    if printed.text:
        return printed.text
    spelled = {**{n: n for n in names.symbols}, **_usual(names), **spellings}
    understood = _understood(printed, terms, place, spelled)
    if not printed.accepted:
        raise NotAccepted(str(place), understood, "")
    texts = (printed.understood or understood, understood)
    both = [equation(text, names, rough=True) for text in texts]
    if not printed.understood or both[0] != both[1]:
        raise NotAccepted(str(place), understood, printed.understood)
    return printed.understood


def may_be_rough(terms: Terms, text: str) -> bool:
    """Whether an equation may use ~, because it has a limit or a rounded constant."""
    return bool(terms.approach or terms.leading) or may_be_rounded(text)


def waiting(
    number: int, printed: AsPrinted, terms: Terms, place: Place, error: NotAccepted, names: Names
) -> Reading:
    """Return the reading that waits for the user, with the entries that the verdict depends on."""
    require = [terms.require] if isinstance(terms.require, str) else terms.require
    order = "" if terms.order is None else f"{terms.order:g}"
    told = {
        "as": terms.approach,
        "order": order,
        "require": " and ".join(require),
        "given": " and ".join(terms.given or ()),
    }
    beside = {key: text for key, text in told.items() if text}
    understood, why = error.understood, ""
    try:
        equation(understood, names, rough=may_be_rough(terms, understood))
    except BadFormula as fault:
        why = reason(fault, place)
    return Reading(number, printed.label, printed.latex, understood, error.accepted, beside, why)


def not_accepted(printed: AsPrinted, error: NotAccepted) -> str:
    """Return the reason why a claim waits for the user, and what the user can do."""
    said = f"the file accepts {error.accepted}" if error.accepted else "the file does not accept it"
    by_hand = f'understood = "{error.understood}"' if printed.accepted else "accepted = true"
    return f"the LaTeX was read as {error.understood}, but {said}: use --accept, or write {by_hand}"


def _understood(printed: AsPrinted, terms: Terms, place: Place, spelled: Mapping[str, str]) -> str:
    """Return the LaTeX of a claim, or one statement in its display, as text."""
    latex, part = printed.latex, printed.part
    reader = Latex(str(place), latex, spelled)
    if part is None:
        return reader.understood()
    found = statements(str(place), latex)
    if not 1 <= part <= len(found):
        why = f"part = {part!r} is not the number of a statement in this display"
        raise place.bad(why, f"write a number from 1 to {len(found)}")
    chosen = found[part - 1]
    if (chosen.condition or chosen.order) and not (terms.require or terms.approach):
        says = plain(chosen.condition) or rf"{chosen.small} \to 0"
        why = f"the display also says {says}, but neither `require` nor `as` is given"
        raise place.bad(why, "give the condition in `require`, or the limit in `as`")
    return reader.equation(chosen.tokens)


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
