"""Draft a claims file from the displays of a paper.

No claim in the draft is judged before a user has accepted its reading and defined its symbols.
"""

import os
import re
from collections import Counter
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import tomlkit
from sympy import Expr, Integral, Mul, Symbol, degree, denom, solve, together

from derive.check.proposals import proposal
from derive.command.errors import BadClaimsFile, BadFormula
from derive.command.files import demand_writable, refused_as, write_new
from derive.command.limit import LimitReached, within
from derive.reading.displays import LABEL, Display, displays
from derive.reading.formula import (
    Names,
    UnknownName,
    approach,
    condition,
    equation,
    may_be_rounded,
    unknown,
)
from derive.reading.latex import Latex
from derive.reading.lexer import plain
from derive.reading.spellings import functions_in, spellings, unclear_call
from derive.reading.statements import Statement, remarks, statements
from derive.reading.substitution import substitution

_SECONDS = 10.0
"""The time limit for reading one equation, in seconds."""
_SHOWN = 4
_LONGEST = 80
"""The largest number of words and characters of LaTeX that show where an error occurred."""
_KNOWN = frozenset({"E_star", "f", "x", "s", "xi"})
"""Names that every claims file knows without a declaration."""
_unwritable = partial(BadClaimsFile, remedy="give the name of a new file with --draft")

_HEAD = """title = ""

# Define each symbol by a formula, such as P = { is = 'load(a, c)' }, or move it to [variables] if
# it is an independent variable.  Rename `proposal` to `is` if it is right.  Units are checked, so
# correct or delete those that are wrong.  Then run `derive check FILE --accept`, and finally
# `derive check FILE`, with this file.
# body = 'hertz'           # the body whose formulas may be called

[variables]                # drawn at random, such as R = 'radius'

[symbols]

[latex]
"""


@dataclass
class Draft:
    """The content of a paper that was read.

    environments  the number of displays in the file
    source        the text of the paper
    spelled       the LaTeX of each symbol -> its name
    claims        the entries of each claim in the file; a `note` becomes a comment
    """

    name: str
    environments: int
    source: str
    spelled: dict[str, str] = field(default_factory=dict)
    claims: list[dict[str, Any]] = field(default_factory=list)

    def told(self, key: str) -> list[str]:
        """All entries `unchecked` or `note` of claims, each with its place in the paper."""
        return [f"{each['place']}: {each[key]}" for each in self.claims if key in each]

    @property
    def understood(self) -> int:
        """The number of statements that were read."""
        return sum("understood" in each for each in self.claims)

    def names(self) -> dict[str, dict[str, str]]:
        """The symbols to be defined, with what is proposed for each."""
        keys, names = ("proposal", "meaning", "unit"), dict.fromkeys(self.spelled.values())
        found = {n: zip(keys, proposal(n, self.source), strict=True) for n in names}
        return {n: {k: t for k, t in each if t} for n, each in found.items() if n not in _KNOWN}

    def drop_bound(self) -> None:
        """Drop the symbols that are bound by an integral, sum or limit."""
        entries = [each.get(key, "") for each in self.claims for key in ("understood", "require")]
        entries += [side for each in self.claims for side in each.get("as", "").split("->")]
        held = {name for text in entries for name in re.findall(r"\w+", text)}
        free = {name for text in entries for name in unknown(text, Names("", {}, {}))}
        free |= {a for name in self.spelled.values() for a in name.partition("_at_")[2].split("_")}
        kept = free | _KNOWN | (set(self.spelled.values()) - held)
        self.spelled = {spelled: n for spelled, n in self.spelled.items() if n in kept}

    def text(self) -> str:
        """The text of the claims file."""
        made = tomlkit.parse(_HEAD)
        made["title"], symbols, latex = _toml(self.name), made["symbols"], made["latex"]
        for name, given in self.names().items():
            symbols[name] = tomlkit.inline_table() if given else ""
            for key, entry in given.items():
                symbols[name][key] = entry
        for spelled, name in self.spelled.items():
            latex[spelled] = name
        if unread := self.told("unchecked"):
            for line in ("These statements were not read, or not completely:", *unread):
                latex.add(tomlkit.comment(line))
        claims = tomlkit.aot()
        for each in self.claims:
            claims.append(table := tomlkit.table())
            for key, entry in each.items():
                if key == "note":
                    table.add(tomlkit.comment(entry))
                else:
                    table.add(key, _toml(entry))
        made["claims"] = claims
        return tomlkit.dumps(made)


def draft_claims(path: Path, inline: bool = False) -> Draft:
    """Read a LaTeX file; raise BadClaimsFile if its displays cannot be found.

    inline: whether the relations in the text are read as well.
    """
    source = displays(path, inline)
    if not source.found:
        why = "the file has no displayed equations"
        raise BadClaimsFile(str(path), why, "give a paper in LaTeX")
    made = Draft(path.name, source.environments, source.text)
    known = [(each, _statements(path.name, each)) for each in source.found]
    readable = [each for _, found in known for each in found if not each.why]
    formulas = [tokens for each in readable for tokens in (each.tokens, *each.conditions)]
    functions = functions_in(formulas)
    for tokens in formulas:
        made.spelled |= spellings(tokens, functions)
    used = Counter[str]()
    for display, found in known:
        reader = Latex("the draft", display.latex, made.spelled)
        labels = [_label(display, each) for each in found]
        for part, (label, statement) in enumerate(zip(labels, found, strict=True), 1):
            label += f"/{labels[:part].count(label)}" if labels.count(label) > 1 else ""
            used[label] += 1
            label += f" [{used[label]}]" if used[label] > 1 else ""
            place = f"statement {part}, {path.name}" if len(found) > 1 else path.name
            entries = _printed(display, label, place, part if statement.tokens else 0)
            made.claims.append(entries | _entries(reader, statement, functions))
    made.drop_bound()
    return made


def _statements(name: str, display: Display) -> list[Statement]:
    """Return the statements of a display, or one that says why there are none."""
    try:
        return statements(name, display.latex) or [Statement([], why="it has no relation")]
    except BadFormula as error:
        return [Statement([], why=_told(error))]


def _label(display: Display, statement: Statement) -> str:
    """Return the label of a statement's row, or of its display."""
    end, number = statement.tokens[-1].at if statement.tokens else 0, display.number
    row = display.latex[:end].rpartition(r"\\")[2] + display.latex[end:].partition(r"\\")[0]
    own = f"({number})" if number else f"line {display.line}"
    return _line(", ".join(LABEL.findall(row) or display.labels) or own)


def _printed(display: Display, label: str, place: str, part: int) -> dict[str, Any]:
    """Return what is printed, and where."""
    found = {
        "label": label,
        "place": f"eq. ({display.number}), " * bool(display.number) + f"{place}:{display.line}",
        "says": _line(", ".join(remarks(display.latex))),
        "latex": display.latex,
        "part": part,
    }
    return {key: entry for key, entry in found.items() if entry}


def _entries(reader: Latex, statement: Statement, functions: set[str]) -> dict[str, Any]:
    """Read a statement and its conditions; give the reason if it cannot be judged."""
    names, why = Names("", {n: Symbol(n) for n in reader.spellings.values()}, {}), statement.why
    found = dict[str, Any]()
    if not why and (called := unclear_call(statement.tokens, functions)):
        why = f"{called} is a function elsewhere, so it is unclear whether it is a factor here"
        why += ": write the claim as text"
    try:
        with within(_SECONDS):
            if not why:
                understood = reader.read("equation", statement.tokens)
                left, _, right = equation(understood, names, rough=statement.is_rough)
                found |= {"understood": understood, "accepted": False}
                found |= _pole(left, right) or _substitution(left, right)
    except BadFormula as error:
        why = _told(error)
    except LimitReached:
        why = "" if found else f"it could not be read within {_SECONDS:g} s"
    conditions, unclear = _conditions(statement, reader, names)
    found |= conditions
    is_exact = not statement.is_rough or may_be_rounded(found.get("understood", ""))
    if not (unclear or is_exact or "as" in conditions):
        unclear = "it is an approximation: add its limit, such as as = 'x -> 0', or write it with ="
    return found | ({"unchecked": _line(why or unclear)} if why or unclear else {})


def _told(error: BadFormula) -> str:
    """Return the reason for an error, with the LaTeX where it occurred."""
    if isinstance(error, UnknownName):
        return error.why
    shown = " ".join(error.given[error.column :].split()[:_SHOWN])[:_LONGEST]
    return f"{error.why}{f', at `{shown}`' if shown else ''}: {error.remedy}"


def _pole(left: Expr, right: Expr) -> dict[str, str]:
    """Note an integral whose integrand may have a pole between its limits."""
    for over in sorted(left.atoms(Integral) | right.atoms(Integral), key=str):
        along, low, high = over.limits[0]
        for factor in Mul.make_args(denom(together(over.function))):
            if not (factor.is_polynomial(along) and degree(factor, along) == 1):
                continue
            pole = solve(factor, along)[0]
            inside = not pole.is_number or low.could_extract_minus_sign()
            if inside and pole not in (low, high):
                note = rf"\int may run over a pole at {along} = {pole}: if a principal value is "
                return {"note": note + r"meant, write \fint for \int in `latex`"}
    return {}


def _substitution(left: Expr, right: Expr) -> dict[str, str]:
    """Note an equation that introduces an angle, with the line that defines it."""
    if not (found := substitution(left, right)):
        return {}
    angle, value = found
    line = f"{angle} = {{ is = '{value}' }}"
    return {"note": f"if this substitution defines {angle}, write {line} under [symbols]"}


def _conditions(statement: Statement, reader: Latex, names: Names) -> tuple[dict[str, Any], str]:
    """Return the entries for the conditions and the limit, and the reason if this fails."""
    told, limits, small = list[str](), list[str](), statement.small
    for each in statement.conditions:
        try:
            if any(token.type == "TO" for token in each):
                limits.append(reader.read("approach", each))
                approach(limits[-1], names)
            else:
                told.append(reader.read("conditions", each))
                condition(told[-1], names)
        except BadFormula:
            why = f"its condition {plain(each)} could not be read: write it in `require` or in `as`"
            return {}, why
    found: dict[str, Any] = {"require": " and ".join(told)} if told else {}
    if statement.order:
        limits.append(f"{reader.spellings.get(small, small)} -> 0")
    if len(set(limits)) > 1:
        return found, f"it holds in several limits, {', '.join(limits)}: put one in `as`"
    order = int(statement.order) if statement.order.is_integer() else statement.order
    entries = {"as": "".join(limits[:1]), "order": order}
    return found | {key: entry for key, entry in entries.items() if entry}, ""


def demand_new(path: Path) -> None:
    """Raise BadClaimsFile if no new file can be written here; call this before a long task."""
    with refused_as(_unwritable, path):
        demand_writable(path)
    if os.path.lexists(path):
        raise _unwritable(str(path), "already exists")


def write(made: Draft, path: Path) -> None:
    """Write a draft to a new file; raises BadClaimsFile."""
    with refused_as(_unwritable, path):
        write_new(made.text().encode(), path)


def _line(text: str) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _toml(entry: Any) -> Any:
    """Write a text as a literal string if possible, so that LaTeX stays legible."""
    if not isinstance(entry, str):
        return entry
    text = "".join(c if c.isprintable() or c in "\n\t" else " " for c in entry)
    if "'" not in text and "\n" not in text:
        return tomlkit.string(text, literal=True)
    if "'''" in text or text.endswith("'"):
        return tomlkit.string(text)
    return tomlkit.string(text, literal=True, multiline=True)
