"""Draft a claims file from the displays of a paper.

No claim in the draft is judged before a user has accepted its reading and defined its symbols.
"""

import re
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tomlkit
from sympy import Symbol
from tomlkit.items import Item

from derive.check.declarations import PLACES
from derive.check.meanings import NONE, Standard
from derive.check.mistakes import reason
from derive.command.errors import BadClaimsFile, BadFormula
from derive.command.limit import LimitReached, within
from derive.reading.displays import LABEL, Display, displays
from derive.reading.formula import (
    Names,
    approach,
    condition,
    equation,
    may_be_rounded,
    sides,
    unknown,
    usable,
)
from derive.reading.improper import typed
from derive.reading.latex import Latex
from derive.reading.lexer import Token, plain
from derive.reading.relation import Relation
from derive.reading.spellings import functions_in, spellings, unclear_call
from derive.reading.statements import Statement, remarks, statements
from derive.reading.substitution import substitution

_SECONDS = 10.0
"""The time limit for reading one equation, in seconds."""
_HEAD = """title = ""

# Four answers give the paper's letters their standard meanings: the body (`derive list`), whether
# the contact is symmetric, the elastic constants, and the letters that differ from ours.  A line
# of yours in [symbols] or [variables] beats a standard meaning.  Write a formula for each "" in
# [symbols], such as h = '(a + c)/2', or move the symbol to [variables].
{answers}

[variables]                # positive, unless they have a range, such as t = {{ low = 0, high = 1 }}

[symbols]

[latex]
"""
_EXAMPLE: dict[str, Any] = {
    "symmetric": True,
    "modulus": "E_star",
    "letters": {"m": "b", "f": r"\mu"},
}
"""The table [paper] that stands in the draft as a comment until the user answers."""
_DEFINES = (":=", r"\equiv", r"\coloneqq", r"\triangleq")


@dataclass
class Draft:
    """The content of a paper that was read.

    title         the title of the paper, or the name of its file
    environments  the number of displays in the file
    answers       the body and the table [paper]; empty if the user has not answered
    standard      the standard meanings that follow from the answers
    spelled       the LaTeX of each symbol -> its name
    defined       the definitions in the paper that may be meanings, each with its place
    claims        the entries of each claim in the file
    """

    title: str
    environments: int
    answers: tuple[str, dict[str, Any]] | tuple[()] = ()
    standard: Standard = NONE
    spelled: dict[str, str] = field(default_factory=dict)
    defined: dict[str, dict[str, str]] = field(default_factory=dict)
    claims: list[dict[str, Any]] = field(default_factory=list)

    @property
    def unread(self) -> list[str]:
        """The entries `unchecked` of claims, each with its place in the paper."""
        claims = (each for each in self.claims if "unchecked" in each)
        return [f"{each['place']}: {each['unchecked']}" for each in claims]

    @property
    def understood(self) -> int:
        """The number of statements that were read."""
        return sum("understood" in each for each in self.claims)

    @property
    def known(self) -> frozenset[str]:
        """The names that every claims file with these answers knows."""
        return frozenset({*PLACES, *self.standard.letters.values()})

    def meant(self) -> dict[str, str]:
        """The standard formulas of the paper's symbols."""
        return {n: entry.text for n, entry in self.standard.of({*self.spelled.values()}).items()}

    def open(self) -> dict[str, dict[str, str]]:
        """The symbols without a meaning, with what the paper says of each."""
        known = self.known | self.meant().keys()
        return {n: self.defined.get(n, {}) for n in self.spelled.values() if n not in known}

    def drop_unused(self, in_text: Collection[str]) -> None:
        """Keep the symbols of claims, and those of the text that definitions of others need.

        A symbol that is only bound by an integral, sum or limit is dropped.
        """
        nothing = Names("", {}, {})
        texts = [each.get(key, "") for each in self.claims for key in ("understood", "require")]
        texts += [side for each in self.claims for side in each.get("as", "").split("->")]
        free = {name for text in texts for name in unknown(text, nothing)}
        bound = {name for text in texts for name in re.findall(r"\w+", text)} - free - self.known
        printed = {name for latex, name in self.spelled.items() if latex not in in_text}
        bound -= {a for name in printed for a in name.partition("_at_")[2].split("_")}
        names = [name for name in printed if name not in bound]
        for name in names:
            used = unknown(self.defined.get(name, {}).get("proposal", ""), nothing)
            names += [each for each in used if each in self.spelled.values() and each not in names]
        self.spelled = {latex: name for latex, name in self.spelled.items() if name in names}

    def _answered(self) -> str:
        """The answers of the user as lines of the file, or an example as a comment."""
        body, paper = self.answers or ("hertz", _EXAMPLE)
        lines = [f"{key} = {_toml(entry).as_string()}" for key, entry in paper.items()]
        lines = [f"body = '{body}'", "[paper]", *lines]
        return "\n".join(lines if self.answers else (f"# {line}" for line in lines))

    def text(self) -> str:
        """The text of the claims file."""
        made = tomlkit.parse(_HEAD.format(answers=self._answered()))
        made["title"], symbols, latex = _toml(self.title), made["symbols"], made["latex"]
        for name, given in self.open().items():
            symbols[name] = _toml(given or "")
        for spelled, name in self.spelled.items():
            latex[spelled] = name
        if self.unread:
            for line in ("These statements were not read, or not completely:", *self.unread):
                latex.add(tomlkit.comment(line))
        claims = tomlkit.aot()
        for each in self.claims:
            claims.append(table := tomlkit.table())
            table.update({key: _toml(entry) for key, entry in each.items()})
        made["claims"] = claims
        return tomlkit.dumps(made)


def draft_claims(
    path: Path,
    inline: bool = False,
    answers: tuple[str, dict[str, Any]] | tuple[()] = (),
    standard: Standard = NONE,
) -> Draft:
    """Read a LaTeX file; raise BadClaimsFile if its displays cannot be found.

    inline: whether the relations in the text are read as well
    answers, standard: the user's answers, and the meanings that follow from them
    """
    source = displays(path, inline)
    if all(each.is_aside for each in source.found):
        why = "the file has no displayed equations"
        raise BadClaimsFile(str(path), why, "give a paper in LaTeX")
    made = Draft(source.title or path.name, source.environments, answers, standard)
    known = [(each, _statements(path.name, each)) for each in source.found]
    shown, asides = list[list[Token]](), list[list[Token]]()
    for display, statement in ((d, each) for d, found in known for each in found if not each.why):
        formulas = asides if display.is_aside else shown
        formulas += [statement.tokens, *statement.conditions]
    functions = functions_in(shown)
    spelled = _spelled(shown, functions)
    made.spelled = _spelled(asides, functions) | spelled
    names = Names("", {name: Symbol(name) for name in made.spelled.values()}, {})
    used, seen = Counter[str](), set[str]()
    for display, found in known:
        latex = Latex("the draft", display.latex, made.spelled if display.is_aside else spelled)
        labels = [_label(display, each) for each in found]
        for part, (label, statement) in enumerate(zip(labels, found, strict=True), 1):
            read, (name, formula) = _read(latex, statement, functions, names)
            place = _place(path.name, display, part if len(found) > 1 else 0)
            is_stated = display.is_defined or _is_stated(display.latex, statement)
            if name and name not in made.defined and (is_stated or name not in seen):
                made.defined[name] = {"proposal": formula, "meaning": place}
            seen.update(re.findall(r"[A-Za-z]\w*", read.get("understood", "")))
            if display.is_aside:
                continue
            label += f"/{labels[:part].count(label)}" if labels.count(label) > 1 else ""
            used[label] += 1
            label += f" [{used[label]}]" if used[label] > 1 else ""
            says = _one_line(", ".join(remarks(display.latex)))
            printed: dict[str, Any] = {"label": label, "place": place, "says": says}
            printed |= {"latex": display.latex, "part": part if statement.tokens else 0}
            made.claims.append({key: e for key, e in printed.items() if e} | read)
    made.drop_unused(made.spelled.keys() - spelled.keys())
    return made


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
    if not why and (called := unclear_call(statement.tokens, functions)):
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
    is_exact = not statement.is_rough or may_be_rounded(found.get("understood", ""))
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


def _spelled(formulas: list[list[Token]], functions: Collection[str]) -> dict[str, str]:
    """Return a name for the LaTeX of every symbol in formulas."""
    return {latex: n for each in formulas for latex, n in spellings(each, functions).items()}


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


def _toml(entry: Any) -> Item:
    """Return an entry for TOML; text is literal if possible, so that LaTeX stays legible."""
    if isinstance(entry, dict):
        table = tomlkit.inline_table()
        table.update({key: _toml(inner) for key, inner in entry.items()})
        return table
    if not isinstance(entry, str):
        return tomlkit.item(entry)
    text = "".join(c if c.isprintable() or c in "\n\t" else " " for c in entry)
    if "'" not in text and "\n" not in text:
        return tomlkit.string(text, literal=True)
    if "'''" in text or text.endswith("'"):
        return tomlkit.string(text)
    return tomlkit.string(text, literal=True, multiline=True)
