"""Draft a claims file from the displays of a paper.

No claim in the draft is judged before a user has accepted its reading and defined its symbols.
"""

import re
from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit
from msgspec import to_builtins
from sympy import Symbol
from tomlkit.items import Item

from derive.check.declarations import PLACES
from derive.check.meanings import NONE, Standard
from derive.check.mistakes import reason
from derive.check.schema import Answers
from derive.command.errors import BadClaimsFile, BadFormula
from derive.command.limit import LimitReached, within
from derive.reading.displays import LABEL, Display, displays
from derive.reading.formula import (
    Names,
    approach,
    condition,
    equation,
    rounded_in,
    sides,
    unknown,
    usable,
)
from derive.reading.improper import typed
from derive.reading.latex import Latex
from derive.reading.lexer import plain
from derive.reading.relation import Relation
from derive.reading.spellings import functions_in, spellings, unclear_call
from derive.reading.statements import Statement, remarks, statements
from derive.reading.substitution import substitution

_SECONDS = 10.0
"""The time limit for reading one equation, in seconds."""
_HEAD = """{title}
# Four answers give the paper's letters their standard meanings: the body (`derive list`), whether
# the contact is symmetric, the elastic constants, and the letters that differ from ours.  A line
# of yours in [symbols] or [variables] beats a standard meaning.  Write a formula for each "" in
# [symbols], such as h = '(a + c)/2', or move the symbol to [variables].
{answers}
[variables]                # positive, unless they have a range, such as t = {{ low = 0, high = 1 }}

[symbols]
{symbols}
[latex]
{latex}{unread}"""
_EXAMPLE = Answers(symmetric=True, letters={"m": "b", "f": r"\mu"})
"""The table [paper] that stands in the draft as a comment until the user answers."""
_DEFINES = (":=", r"\equiv", r"\coloneqq", r"\triangleq")


@dataclass(frozen=True)
class Draft:
    """The content of a paper that was read.

    environments  the number of displays in the file
    claims        the entries of each claim in the file
    unread        the entries `unchecked` of claims, each with its place in the paper
    meant         the standard formulas of the paper's symbols
    open          the symbols without a meaning, each with its definition in the paper and its place
    text          the text of the claims file
    """

    environments: int
    claims: list[dict[str, Any]]
    unread: list[str]
    meant: dict[str, str]
    open: dict[str, dict[str, str]]
    text: str

    @property
    def understood(self) -> int:
        """The number of statements that were read."""
        return sum("understood" in each for each in self.claims)


def draft_claims(path: Path, inline: bool = False, standard: Standard = NONE) -> Draft:
    """Read a LaTeX file; raise BadClaimsFile if its displays cannot be found.

    inline: whether the relations in the text are read as well
    standard: the meanings that follow from the user's answers
    """
    source = displays(path, inline)
    if not source.found:
        why = "the file has no displayed equations"
        raise BadClaimsFile(str(path), why, "give a paper in LaTeX")
    printed = [(each, _statements(path.name, each)) for each in source.found]
    read = [each for _, found in printed for each in found if not each.why]
    formulas = [formula for each in read for formula in (each.tokens, *each.conditions)]
    functions = functions_in(formulas)
    spelled = {own: n for each in formulas for own, n in spellings(each).items()}
    names = Names("", {name: Symbol(name) for name in spelled.values()}, {})
    claims, defined = list[dict[str, Any]](), dict[str, dict[str, str]]()
    used, seen = Counter[str](), set[str]()
    for display, found in printed:
        latex = Latex("the draft", display.latex, spelled)
        labels = [_label(display, each) for each in found]
        for part, (label, statement) in enumerate(zip(labels, found, strict=True), 1):
            entries, (name, formula) = _read(latex, statement, functions, names)
            place = _place(path.name, display, part if len(found) > 1 else 0)
            is_stated = display.is_defined or _is_stated(display.latex, statement)
            if name and name not in defined and (is_stated or name not in seen):
                defined[name] = {"proposal": formula, "meaning": place}
            seen.update(re.findall(r"[A-Za-z]\w*", entries.get("understood", "")))
            label += f"/{labels[:part].count(label)}" if labels.count(label) > 1 else ""
            used[label] += 1
            label += f" [{used[label]}]" if used[label] > 1 else ""
            says = _one_line(", ".join(remarks(display.latex)))
            claim: dict[str, Any] = {"label": label, "place": place, "says": says}
            claim |= {"latex": display.latex, "part": part if statement.tokens else 0}
            claims.append({key: e for key, e in claim.items() if e} | entries)
    known = {*PLACES, *standard.letters.values()}
    bound = _bound(claims, spelled.values()) - known
    spelled = {own: name for own, name in spelled.items() if name not in bound}
    meant = {n: entry.text for n, entry in standard.of({*spelled.values()}).items()}
    left = {n: defined.get(n, {}) for n in spelled.values() if n not in known | meant.keys()}
    unread = [f"{each['place']}: {each['unchecked']}" for each in claims if "unchecked" in each]
    told = ("These statements were not read, or not completely:", *unread) if unread else ()
    head = _HEAD.format(
        title=_toml({"title": source.title or path.name}),
        answers=_answered(standard),
        symbols=_toml({name: said or "" for name, said in left.items()}),
        latex=_toml(spelled),
        unread="".join(f"# {line}\n" for line in told),
    )
    text = "".join((head, *(f"\n[[claims]]\n{_toml(each)}" for each in claims)))
    return Draft(source.environments, claims, unread, meant, left, text)


def _answered(standard: Standard) -> str:
    """The answers of the user as lines of the file, or an example as a comment."""
    answers = to_builtins(standard.answers or _EXAMPLE)
    lines = f"{_toml({'body': standard.body})}[paper]\n{_toml(answers)}"
    return lines if standard.answers else re.sub("(?m)^(?=.)", "# ", lines)


def _bound(claims: list[dict[str, Any]], printed: Collection[str]) -> set[str]:
    """Return the symbols that are only bound by integrals, sums and limits."""
    nothing = Names("", {}, {})
    texts = [each.get(key, "") for each in claims for key in ("understood", "require")]
    texts += [side for each in claims for side in each.get("as", "").split("->")]
    free = {name for text in texts for name in unknown(text, nothing)}
    free |= {part for name in printed for part in name.partition("_at_")[2].split("_")}
    return {name for text in texts for name in re.findall(r"\w+", text)} - free


# ------------------------------------------------------------------ one statement


def _read(
    latex: Latex, statement: Statement, functions: Collection[str], names: Names
) -> tuple[dict[str, Any], tuple[str, str]]:
    """Return the entries of a claim, and the symbol that it may define, with its formula.

    The entry `unchecked` says why the claim cannot be judged.  Symbol and formula are empty if the
    claim has a condition, or defines nothing.

    functions: the symbols that are printed as functions, and nowhere without parentheses
    """
    found, defined, why = dict[str, Any](), ("", ""), statement.why
    shown = (statement.tokens, *statement.conditions)
    if not why and (called := unclear_call(shown, functions)):
        why = f"{called} is a function elsewhere, so it is unclear whether it is a factor here"
        why += ": write the claim as text"
    try:
        with within(_SECONDS):
            if not why:
                understood = latex.read("equation", statement.tokens)
                left, relation, right = equation(understood, names, rough=statement.is_rough)
                found = {"understood": understood, "accepted": False}
                if relation == Relation.EQUAL:
                    defined = sides(understood, names)
                    if angle := substitution(left, right):
                        defined = str(angle[0]), str(typed(angle[1]))
    except BadFormula as error:
        why = reason(error)
    except LimitReached:
        why = "" if found else f"it could not be read within {_SECONDS:g} s"
    conditions, unclear = _conditions(latex, statement, names)
    found |= conditions
    is_exact = not statement.is_rough or rounded_in(found.get("understood", ""))
    if not (unclear or is_exact or "as" in conditions):
        unclear = "it is an approximation: add its limit, such as as = 'x -> 0', or write it with ="
    if why or unclear:
        found["unchecked"] = _one_line(why or unclear)
    name, formula = defined
    is_definition = usable(name) and name not in re.findall(r"\w+", formula)
    is_definition = is_definition and not found.keys() & {"require", "as", "unchecked"}
    return found, defined if is_definition else ("", "")


def _conditions(latex: Latex, statement: Statement, names: Names) -> tuple[dict[str, Any], str]:
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


def _statements(name: str, display: Display) -> list[Statement]:
    """Return the statements of a display, or one that says why there are none."""
    try:
        return statements(name, display.latex) or [Statement([], why="it has no relation")]
    except BadFormula as error:
        return [Statement([], why=reason(error))]


def _is_stated(latex: str, statement: Statement) -> bool:
    r"""Whether a statement is printed with := or \equiv, or after the word where."""
    start = statement.tokens[0].at if statement.tokens else 0
    is_sign = any(latex.startswith(_DEFINES, t.at) for t in statement.tokens if not t.depth)
    return is_sign or re.search(r"\bwhere\b[^=]*$", latex[:start]) is not None


def _label(display: Display, statement: Statement) -> str:
    """Return the label of a statement's row, or of its display."""
    end, number = statement.tokens[-1].at if statement.tokens else 0, display.number
    row = display.latex[:end].rpartition(r"\\")[2] + display.latex[end:].partition(r"\\")[0]
    own = f"({number})" if number else f"line {display.line}"
    return _one_line(", ".join(LABEL.findall(row) or display.labels) or own)


def _place(name: str, display: Display, part: int) -> str:
    """Return the place of a display in the paper, or of one of its statements."""
    equation = f"eq. ({display.number})" if display.number else ""
    statement = f"statement {part}" if part else ""
    return ", ".join(filter(None, (equation, statement, f"{name}:{display.line}")))


def _one_line(text: str) -> str:
    """Return a text in one line, without control characters."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _toml(entries: Mapping[str, Any]) -> str:
    """Return lines of TOML; text is literal if possible, so that LaTeX stays legible."""
    return tomlkit.dumps({key: _item(entry) for key, entry in entries.items()})


def _item(entry: Any) -> Item:
    if isinstance(entry, dict):
        table = tomlkit.inline_table()
        table.update({key: _item(inner) for key, inner in entry.items()})
        return table
    if not isinstance(entry, str):
        return tomlkit.item(entry)
    text = "".join(c if c.isprintable() or c in "\n\t" else " " for c in entry)
    is_long, quote = "'" in text or "\n" in text, "'''"
    is_literal = not is_long or not (quote in text or text.endswith("'"))
    return tomlkit.string(text, literal=is_literal, multiline=is_literal and is_long)
