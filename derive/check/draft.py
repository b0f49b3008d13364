"""Draft a claims file from the displays of a paper.

No claim in the draft is judged before a user has accepted its reading and defined its symbols.
"""

import os
import re
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path

from sympy import Expr, Integral, Mul, Symbol, degree, denom, solve, together
from tomlkit import string

from derive.check.proposals import proposal
from derive.command.errors import BadClaimsFile, BadFormula
from derive.command.files import demand_writable, write_new
from derive.command.limit import LimitReached, within
from derive.reading.displays import LABEL, Display, displays, rows_of
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
from derive.reading.spellings import spellings, standing_alone, unclear_call
from derive.reading.statements import Statement, remarks, separate, statements

_SECONDS = 10.0
"""The time limit for reading one equation, in seconds."""
_SHOWN = 4
_LONGEST = 80
"""The largest number of words and characters of LaTeX that show where an error occurred."""
_NOTHING = '""'
_KNOWN = frozenset({"E_star", "f", "x", "s", "xi"})
"""Names that every claims file knows without a declaration."""
_NEW = "give the name of a new file with --draft"

_HEAD = """
# Define each symbol by a formula, such as P = { is = 'load(a, c)' }, or move it to [variables] if
# it is an independent variable.  Rename `proposal` to `is` if it is right.  Units are checked, so
# correct or delete those that are wrong.  Then run `derive check FILE --accept`, and finally
# `derive check FILE`, with this file.
# body = 'hertz'           # the body whose formulas may be called

[variables]                # drawn at random, such as R = 'radius'

[symbols]"""


@dataclass(frozen=True)
class _Part:
    """One statement of a display, as it is written to the claims file.

    label          the label of its row in the paper
    number, count  its number in the display, and how many there are
    understood     the equation as text; empty if it was not read
    require        the condition as text
    limit          the limit as text, such as x -> 0
    order          the order of the remainder in this limit; 0 if there is none
    why            the reason if it is not judged
    note           advice to the user
    """

    display: Display
    label: str
    number: int
    count: int
    why: str = ""
    understood: str = ""
    require: str = ""
    limit: str = ""
    order: float = 0
    note: str = ""

    def place(self, name: str) -> str:
        """Where it stands in a paper."""
        number = f"eq. ({self.display.number}), " if self.display.number else ""
        statement = f"statement {self.number}, " if self.count > 1 and self.number else ""
        return f"{number}{statement}{name}:{self.display.line}"


@dataclass
class Draft:
    """The content of a paper that was read.

    environments  the number of displays in the file
    source        the text of the paper
    spelled       the LaTeX of each symbol -> its name
    """

    name: str
    environments: int
    source: str
    spelled: dict[str, str] = field(default_factory=dict)
    parts: list[_Part] = field(default_factory=list)

    @property
    def unread(self) -> list[str]:
        """The location of every statement that could not be read or judged, with the reason."""
        return [f"{p.place(self.name)}: {p.why}" for p in self.parts if p.why]

    @property
    def notes(self) -> list[str]:
        """Advice on statements that were read, with their location."""
        return [f"{p.place(self.name)}: {p.note}" for p in self.parts if p.note]

    @property
    def understood(self) -> int:
        """The number of statements that were read."""
        return sum(bool(part.understood) for part in self.parts)

    @property
    def named(self) -> tuple[int, int]:
        """The number of symbols with a proposal, and the number of all symbols."""
        names = self._names()
        return sum(any(proposal(name, self.source)) for name in names), len(names)

    def _names(self) -> list[str]:
        return [n for n in dict.fromkeys(self.spelled.values()) if n not in _KNOWN]

    def drop_bound(self) -> None:
        """Drop the symbols that are bound by an integral, sum or limit."""
        texts = [t for p in self.parts for t in (p.understood, p.require, *p.limit.split("->"))]
        argued = {a for n in self.spelled.values() for a in n.partition("_at_")[2].split("_")}
        for spelled, name in list(self.spelled.items()):
            held = [text for text in texts if re.search(rf"\b{name}\b", text)]
            names = Names("", {n: Symbol(n) for n in self.spelled.values() if n != name}, {})
            is_open = name in argued or name in _KNOWN or not held
            if not is_open and not any(name in unknown(text, names) for text in held):
                del self.spelled[spelled]

    def text(self) -> str:
        """The text of the claims file."""
        lines = [f"title = {_text(self.name)}", *_HEAD.splitlines()]
        for name in self._names():
            known = proposal(name, self.source)
            given = zip(("proposal", "meaning", "unit"), known, strict=True)
            inside = ", ".join(f"{key} = {_text(text)}" for key, text in given if text)
            lines.append(f"{name} = {f'{{ {inside} }}' if inside else _NOTHING}")
        lines += ["", "[latex]"]
        lines += [
            f"{string(spelled).as_string()} = {string(name).as_string()}"
            for spelled, name in self.spelled.items()
        ]
        if self.unread:
            lines += ["", "# These statements were not read, or not completely:"]
            lines += [f"#   {_line(each)}" for each in self.unread]
        labels = Counter[str]()
        for part in self.parts:
            labels[part.label] += 1
            again = f" [{labels[part.label]}]" if labels[part.label] > 1 else ""
            entries = {
                "label": _text(part.label + again),
                "place": _text(part.place(self.name)),
                "says": _text(_line(", ".join(remarks(part.display.latex)))),
                "latex": _text(part.display.latex),
                "part": str(part.number or ""),
                "understood": _text(part.understood),
                "accepted": "false" if part.understood else "",
                "require": _text(part.require),
                "as": _text(part.limit),
                "order": f"{part.order:g}" if part.order and part.limit else "",
                "unchecked": _text(_line(part.why)),
            }
            lines += ["", *([f"# {_line(part.note)}"] if part.note else []), "[[claims]]"]
            lines += [f"{key} = {text}" for key, text in entries.items() if text not in ("", "''")]
        return "\n".join([*lines, ""])


def draft(path: Path, inline: bool = False) -> Draft:
    """Read a LaTeX file; raise BadClaimsFile if its displays cannot be found.

    inline: whether the relations in the text are read as well.
    """
    source = displays(path, inline)
    if not source.found:
        why = "the file has no displayed equations"
        raise BadClaimsFile(str(path), why, "give a paper in LaTeX")
    made = Draft(path.name, source.environments, source.text)
    known, alone = list[tuple[_Part, Statement | None]](), set[str]()
    for display in source.found:
        try:
            found, why = statements(path.name, display.latex), "it has no relation"
        except BadFormula as error:
            found, why = [], error.why
        labels = _labels(display, found)
        for number, (label, each) in enumerate(zip(labels, found, strict=False), 1):
            known.append((_Part(display, label, number, len(found), each.why), each))
            if not each.why:
                alone |= standing_alone(each.tokens)
                made.spelled.update(spellings(each.tokens) | spellings(each.condition))
        if not found:
            known.append((_Part(display, labels[0], 0, 1, why), None))
    made.parts = [_read(p, each, made.spelled, alone) if each else p for p, each in known]
    made.drop_bound()
    return made


def _read(part: _Part, statement: Statement, spelled: dict[str, str], alone: set[str]) -> _Part:
    """Read a statement and its condition; give the reason if it cannot be judged."""
    names = Names("", {n: Symbol(n) for n in spelled.values()}, {})
    reader = Latex("the draft", part.display.latex, spelled)
    part, unclear = _conditions(replace(part, order=statement.order), statement, reader, names)
    if part.why:
        return part
    if called := unclear_call(statement.tokens, spelled, alone):
        why = f"{called} is a function elsewhere, so it is unclear whether it is a factor here"
        return replace(part, why=f"{why}: write the claim as text")
    note = ""
    try:
        with within(_SECONDS):
            understood = reader.equation(statement.tokens)
            left, _, right = equation(understood, names, rough=statement.is_rough)
    except BadFormula as error:
        return replace(part, why=_told(error))
    except LimitReached:
        return replace(part, why=f"it could not be read within {_SECONDS:g} s")
    try:
        with within(_SECONDS):
            note = _pole(left, right)
    except LimitReached:
        pass
    if statement.is_rough and not (part.limit or unclear or may_be_rounded(understood)):
        unclear = "it is an approximation: add its limit, such as as = 'x -> 0', or write it with ="
    return replace(part, understood=understood, why=unclear, note=note)


def _told(error: BadFormula) -> str:
    """Return the reason for an error, with the LaTeX where it occurred."""
    if isinstance(error, UnknownName):
        return error.why
    shown = " ".join(error.given[error.column :].split()[:_SHOWN])[:_LONGEST]
    return f"{error.why}{f', at `{shown}`' if shown else ''}: {error.remedy}"


def _pole(left: Expr, right: Expr) -> str:
    """Describe an integral whose integrand may have a pole between its limits."""
    for over in sorted(left.atoms(Integral) | right.atoms(Integral), key=str):
        along, low, high = over.limits[0]
        for factor in Mul.make_args(denom(together(over.function))):
            if not (factor.is_polynomial(along) and degree(factor, along) == 1):
                continue
            pole = solve(factor, along)[0]
            inside = not pole.is_number or low.could_extract_minus_sign()
            if inside and pole not in (low, high):
                where = rf"\int may run over a pole at {along} = {pole}"
                return where + r": if a principal value is meant, write \fint for \int in `latex`"
    return ""


def _conditions(
    part: _Part, statement: Statement, reader: Latex, names: Names
) -> tuple[_Part, str]:
    """Add the condition and the limit to a part; return also the reason if this fails."""
    told, limits = list[str](), list[str]()
    for each in separate(statement.condition):
        try:
            if any(token.type == "TO" for token in each):
                limits.append(reader.approach(each))
                approach(limits[-1], names)
            else:
                told.append(reader.condition(each))
                condition(told[-1], names)
        except BadFormula:
            why = f"its condition {plain(each)} could not be read: write it in `require` or in `as`"
            return part, why
    small = reader.spellings.get(statement.small, statement.small)
    limit = limits[0] if limits else f"{small} -> 0" if statement.order else ""
    part = replace(part, require=" and ".join(told))
    if len(limits) > 1:
        return part, f"it holds in several limits, {', '.join(limits)}: put one in `as`"
    if statement.order and limit != f"{small} -> 0":
        return part, f"its remainder tends to zero with {small}, but its limit is {limit}"
    return replace(part, limit=limit), ""


def _labels(display: Display, found: list[Statement]) -> list[str]:
    """Return the label of each statement's row in the paper, with its number in the row."""
    number = f"({display.number})" if display.number else f"line {display.line}"
    rows, labels = list(rows_of(display.latex)), list[str]()
    if not found:
        return [_line(", ".join(display.labels) or number)]
    for each in found:
        label = ", ".join(display.labels) or number
        if len(display.labels) > 1 and len(found) > 1:
            start, end = next(row for row in rows if each.tokens[-1].at < row[1])
            own = LABEL.search(display.latex, start, end)
            line = display.line + display.latex.count("\n", 0, start)
            label = own[1] if own else f"line {line}"
        labels.append(_line(label))
    counts, numbers = Counter(labels), Counter[str]()
    for n, label in enumerate(labels):
        numbers[label] += 1
        labels[n] += f"/{numbers[label]}" if counts[label] > 1 else ""
    return labels


def demand_new(path: Path) -> None:
    """Raise BadClaimsFile if no new file can be written here; call this before a long task."""
    try:
        demand_writable(path)
    except OSError as error:
        raise _unwritable(path, error) from error
    if os.path.lexists(path):
        raise BadClaimsFile(str(path), "already exists", _NEW)


def write(made: Draft, path: Path) -> None:
    """Write a draft to a new file; raises BadClaimsFile."""
    demand_new(path)
    try:
        write_new(made.text().encode(), path)
    except OSError as error:
        raise _unwritable(path, error) from error


def _unwritable(path: Path, error: OSError) -> BadClaimsFile:
    return BadClaimsFile(str(path), f"the file cannot be written ({error.strerror})", _NEW)


def _line(text: str) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _text(text: str) -> str:
    """Write a text in TOML, as a literal string if possible."""
    text = "".join(c if c.isprintable() or c in "\n\t" else " " for c in text)
    if "'" not in text and "\n" not in text:
        return f"'{text}'"
    is_long = "\n" in text or "\\" in text
    if "'''" not in text and is_long and not text.endswith("'"):
        return f"'''\n{text}'''"
    return string(text).as_string()
