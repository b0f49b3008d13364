"""Read a statement of a paper into the entries of a claim.

In:   a statement of a display, and the LaTeX of symbols with their names.
Out:  the entries, of which `unchecked` says why it cannot be judged, and what it may define.
"""

from collections.abc import Collection
from typing import Any, NamedTuple

from sympy import Symbol

from derive.command.errors import BadFormula
from derive.command.limit import LimitReached, within
from derive.reading.formula import (
    Names,
    UnknownName,
    approach,
    condition,
    equation,
    may_be_rounded,
    sides,
)
from derive.reading.improper import typed
from derive.reading.latex import Latex
from derive.reading.lexer import plain
from derive.reading.spellings import unclear_call
from derive.reading.statements import Statement
from derive.reading.substitution import substitution

_SECONDS = 10.0
"""The time limit for reading one equation, in seconds."""
_SHOWN = 4
_LONGEST = 80
"""The largest number of words and characters of LaTeX that show where an error occurred."""


class Read(NamedTuple):
    """The entries of a claim; its sides as text, or the angle that it introduces and its value."""

    entries: dict[str, Any]
    sides: tuple[str, str] = ("", "")


def read(latex: Latex, statement: Statement, functions: Collection[str]) -> Read:
    """Read a statement and its conditions; give the reason if it cannot be judged.

    functions: the symbols that are printed as functions, and nowhere without parentheses
    """
    names, why = Names("", {n: Symbol(n) for n in latex.spellings.values()}, {}), statement.why
    found, both = dict[str, Any](), ("", "")
    if not why and (called := unclear_call(statement.tokens, functions)):
        why = f"{called} is a function elsewhere, so it is unclear whether it is a factor here"
        why += ": write the claim as text"
    try:
        with within(_SECONDS):
            if not why:
                understood = latex.read("equation", statement.tokens)
                left, relation, right = equation(understood, names, rough=statement.is_rough)
                found |= {"understood": understood, "accepted": False}
                if relation == "=":
                    angle = substitution(left, right)
                    both = (
                        (str(angle[0]), str(typed(angle[1]))) if angle else sides(understood, names)
                    )
    except BadFormula as error:
        why = reason(error)
    except LimitReached:
        why = "" if found else f"it could not be read within {_SECONDS:g} s"
    conditions, unclear = _conditions(statement, latex, names)
    found |= conditions
    is_exact = not statement.is_rough or may_be_rounded(found.get("understood", ""))
    if not (unclear or is_exact or "as" in conditions):
        unclear = "it is an approximation: add its limit, such as as = 'x -> 0', or write it with ="
    if why or unclear:
        found["unchecked"] = one_line(why or unclear)
    return Read(found, both)


def reason(error: BadFormula) -> str:
    """Return the reason for an error, with the LaTeX where it occurred."""
    if isinstance(error, UnknownName):
        return error.why
    shown = " ".join(error.given[error.column :].split()[:_SHOWN])[:_LONGEST]
    return f"{error.why}{f', at `{shown}`' if shown else ''}: {error.remedy}"


def one_line(text: str) -> str:
    """Return a text in one line, without control characters."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _conditions(statement: Statement, latex: Latex, names: Names) -> tuple[dict[str, Any], str]:
    """Return the entries for the conditions and the limit, and the reason if this fails."""
    told, limits, small = list[str](), list[str](), statement.small
    for each in statement.conditions:
        try:
            if any(token.type == "TO" for token in each):
                limits.append(latex.read("approach", each))
                approach(limits[-1], names)
            else:
                told.append(latex.read("conditions", each))
                condition(told[-1], names)
        except BadFormula:
            why = f"its condition {plain(each)} could not be read: write it in `require` or in `as`"
            return {}, why
    found: dict[str, Any] = {"require": " and ".join(told)} if told else {}
    if statement.order:
        limits.append(f"{latex.spellings.get(small, small)} -> 0")
    if len(set(limits)) > 1:
        return found, f"it holds in several limits, {', '.join(limits)}: put one in `as`"
    order = int(statement.order) if statement.order.is_integer() else statement.order
    entries = {"as": "".join(limits[:1]), "order": order}
    return found | {key: entry for key, entry in entries.items() if entry}, ""
