"""Draft a claims file from the displays of a paper.

No claim in the draft is judged before a user has accepted its reading and defined its symbols.
"""

import os
import re
from collections import Counter
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from sympy import Expr, Integral, Mul, Symbol, degree, denom, solve, together

from derive.check.lines import quoted
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
from derive.reading.spellings import (
    described,
    proposal,
    spellings,
    standing_alone,
    unclear_call,
    words_for,
)
from derive.reading.statements import Statement, remarks, statements

_SECONDS = 10.0
"""The time limit for reading one equation, in seconds."""
_KNOWN = frozenset({"E_star", "f", "x", "s", "xi"})
"""Names that every claims file knows without a declaration."""


_HEAD = """
# Define each symbol by a formula, such as P = { is = 'load(a, c)' }, or move it to [variables] if
# it is an independent variable.  Rename `proposal` to `is` if it is right.  Units are checked, so
# correct or delete those that are wrong.  Then run `derive check FILE --accept`, and finally
# `derive check FILE`, with this file.
# body = 'hertz'           # the body whose formulas may be called

[variables]                # drawn at random, such as R = 'radius'

[symbols]"""


@dataclass(frozen=True)
class _Read:
    """The reading of a statement.

    understood  the equation as text; empty if it was not read
    require     the condition as text
    limit       the limit as text, such as x -> 0
    order       the order of the remainder in this limit; 0 if there is none
    why         the reason if it is not judged
    note        advice to the user
    """

    understood: str = ""
    require: str = ""
    limit: str = ""
    order: float = 0
    why: str = ""
    note: str = ""


@dataclass(frozen=True)
class _Part:
    """One statement of a display, as it is written to the claims file."""

    display: Display
    number: int
    count: int
    read: _Read


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
        return [
            f"{self._place(p)}: {p.read.why}"
            for p in self.parts
            if not p.read.understood or p.read.why
        ]

    @property
    def notes(self) -> list[str]:
        """Advice on statements that were read, with their location."""
        return [f"{self._place(p)}: {p.read.note}" for p in self.parts if p.read.note]

    @cached_property
    def said(self) -> dict[str, str]:
        """The descriptions of symbols in the text."""
        return described(self.source)

    def drop_bound(self) -> None:
        """Drop the symbols that are bound by an integral, sum or limit."""
        read = [part.read for part in self.parts]
        texts = [text for r in read for text in (r.understood, r.require, *r.limit.split("->"))]
        argued = {a for n in self.spelled.values() for a in n.partition("_at_")[2].split("_")}
        for spelled, name in list(self.spelled.items()):
            held = [text for text in texts if re.search(rf"\b{name}\b", text)]
            names = Names("", {n: Symbol(n) for n in self.spelled.values() if n != name}, {})
            is_open = name in argued or name in _KNOWN or not held
            if not is_open and not any(name in unknown(text, names) for text in held):
                del self.spelled[spelled]

    @property
    def understood(self) -> int:
        """The number of statements that were read."""
        return sum(bool(part.read.understood) for part in self.parts)

    @property
    def named(self) -> tuple[int, int]:
        """The number of symbols with a proposal, and the number of all symbols."""
        names = self._names()
        return sum(bool(self._proposed(name)) for name in names), len(names)

    def _place(self, part: _Part) -> str:
        number = f"eq. ({part.display.number}), " if part.display.number else ""
        statement = f"statement {part.number}, " if part.count > 1 and part.number else ""
        return f"{number}{statement}{self.name}:{part.display.line}"

    def text(self) -> str:
        """The text of the claims file."""
        lines = [f"title = {_text(self.name)}", *_HEAD.splitlines()]
        lines += [f"{name} = {self._proposed(name) or _NOTHING}" for name in self._names()]
        lines += ["", "[latex]"]
        lines += [f"{quoted(spelled)} = {quoted(name)}" for spelled, name in self.spelled.items()]
        if self.unread:
            lines += ["", "# These statements were not read, or not completely:"]
            lines += [f"#   {_line(each)}" for each in self.unread]
        labels = Counter[str]()
        for part in self.parts:
            lines += ["", *self._claim(part, labels)]
        return "\n".join([*lines, ""])

    def _names(self) -> list[str]:
        return [n for n in dict.fromkeys(self.spelled.values()) if n not in _KNOWN]

    def _proposed(self, name: str) -> str:
        """The proposal for a symbol as a TOML table; empty if there is none."""
        spelled = [latex for latex, own in self.spelled.items() if own == name]
        words = next(filter(None, (words_for(latex, self.said) for latex in spelled)), "")
        known = proposal(name, words, self.source)
        given = {"proposal": known.formula, "meaning": known.meaning, "unit": known.unit}
        inside = ", ".join(f"{key} = {_text(text)}" for key, text in given.items() if text)
        return f"{{ {inside} }}" if inside else ""

    def _claim(self, part: _Part, labels: Counter[str]) -> list[str]:
        display, read = part.display, part.read
        label, number, count = self._row(part)
        label = _line(label) + ("" if count == 1 else f"/{number}")
        labels[label] += 1
        label += f" [{labels[label]}]" if labels[label] > 1 else ""
        lines = [
            *([f"# {_line(read.note)}"] if read.note else []),
            "[[claims]]",
            f"label = {_text(label)}",
            f"place = {_text(self._place(part))}",
        ]
        if words := _line(", ".join(remarks(display.latex))):
            lines.append(f"says = {_text(words)}")
        lines.append(f"latex = {_text(display.latex)}")
        if part.number:
            lines.append(f"part = {part.number}")
        if read.understood:
            lines += [f"understood = {_text(read.understood)}", "accepted = false"]
        if read.require:
            lines.append(f"require = {_text(read.require)}")
        if read.limit:
            lines.append(f"as = {_text(read.limit)}")
        if read.order and read.limit:
            lines.append(f"order = {read.order:g}")
        if read.why:
            lines.append(f"unchecked = {_text(_line(read.why))}")
        return lines

    def _row(self, part: _Part) -> tuple[str, int, int]:
        """Return the label of a statement's row, its number in the row, and their count."""
        display = part.display
        told = f"({display.number})" if display.number else f"line {display.line}"
        label, number, count = ", ".join(display.labels) or told, part.number, part.count
        if len(display.labels) < 2 or count == 1:
            return label, number, count
        ends = list[int]()
        rows = list(rows_of(display.latex))
        for _, end in rows:
            try:
                ends.append(len(statements(self.name, display.latex[:end])))
            except BadFormula:
                return label, number, count
        if ends[-1] != count or ends != sorted(ends):
            return label, number, count
        row = next(n for n, end in enumerate(ends) if number <= end)
        before = ends[row - 1] if row else 0
        own = re.search(LABEL, display.latex[slice(*rows[row])])
        line = display.line + display.latex[: rows[row][0]].count("\n")
        return own[1] if own else f"line {line}", number - before, ends[row] - before


_NOTHING = '""'


def draft(path: Path, inline: bool = False) -> Draft:
    """Read a LaTeX file; raise BadClaimsFile if its displays cannot be found.

    inline: whether the relations in the text are read as well.
    """
    source = displays(path, inline)
    if not source.found:
        why = "the file has no displayed equations"
        raise BadClaimsFile(str(path), why, "give a paper in LaTeX")
    made = Draft(path.name, source.environments, source.text)
    known = list[tuple[Display, list[Statement], str]]()
    for display in source.found:
        try:
            known.append((display, statements(path.name, display.latex), ""))
        except (BadFormula, RecursionError) as error:
            known.append((display, [], getattr(error, "why", "it is nested too deeply")))
    alone = set[str]()
    for _, each, _ in known:
        for statement in each:
            if not statement.why:
                alone |= standing_alone(statement.latex)
                made.spelled.update(spellings(statement.latex))
                made.spelled.update(spellings(statement.condition))
    for display, each, why in known:
        if not each:
            read = _Read(why=why or "it has no relation")
            made.parts.append(_Part(display, 0, 1, read))
        for number, statement in enumerate(each, 1):
            made.parts.append(
                _Part(display, number, len(each), _read(statement, made.spelled, alone))
            )
    made.drop_bound()
    return made


def _read(statement: Statement, spelled: dict[str, str], alone: set[str]) -> _Read:
    """Read a statement and its condition; give the reason if it cannot be judged."""
    names = Names("", {n: Symbol(n) for n in spelled.values()}, {})
    require, limit, unclear = _conditions(statement, spelled, names)
    read = _Read("", require, limit, statement.order, statement.why)
    if statement.why:
        return read
    if called := unclear_call(statement.latex, spelled, alone):
        why = f"{called} is a function elsewhere, so it is unclear whether it is a factor here"
        return replace(read, why=f"{why}: write the claim as text")
    try:
        with within(_SECONDS):
            understood = Latex("the draft", statement.latex, spelled).understood()
            left, _, right = equation(understood, names, rough=statement.is_rough)
    except BadFormula as error:
        return replace(read, why=_told(error))
    except LimitReached:
        return replace(read, why=f"it could not be read within {_SECONDS:g} s")
    except RecursionError:
        return replace(read, why="it is nested too deeply")
    why = unclear
    if statement.is_rough and not limit and not why and not may_be_rounded(understood):
        why = "it is an approximation: add its limit, such as as = 'x -> 0', or write it with ="
    try:
        with within(_SECONDS):
            note = _pole(left, right)
    except LimitReached:
        note = ""
    return replace(read, understood=understood, why=why, note=note)


def _told(error: BadFormula) -> str:
    """Return the reason for an error, with the LaTeX where it occurred."""
    if isinstance(error, UnknownName):
        return error.why
    here = error.given[error.column :].split()
    shown = "".join(f" {each}" for each in here[:_SHOWN]).strip()
    return f"{error.why}{f', at `{shown}`' if shown else ''}: {error.remedy}"


_SHOWN = 4
"""The number of words of LaTeX that show where an error occurred."""


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
    statement: Statement, spelled: dict[str, str], names: Names
) -> tuple[str, str, str]:
    """Read the conditions and the limit; return both as text, and the reason if this fails."""
    told, limits, joint = list[str](), list[str](), r" \orword "
    parts = [statement.condition]
    if joint not in statement.condition:
        parts = re.split(r",|\\andword", statement.condition)
    for part in filter(None, (each.strip(" ,.;") for each in parts)):
        reading = Latex("the draft", part, spelled)
        try:
            if r"\to" in part:
                limits.append(reading.approach())
                approach(limits[-1], names)
            else:
                told.append(reading.condition())
                condition(told[-1], names)
        except BadFormula:
            why = f"its condition {part} could not be read: write it in `require` or in `as`"
            return "", "", why
    require, limit = " and ".join(told), "".join(limits[:1])
    small = spelled.get(statement.small, statement.small)
    if len(limits) > 1:
        return require, "", f"it holds in several limits, {', '.join(limits)}: put one in `as`"
    if statement.order and limit != f"{small} -> 0":
        return require, "", f"its remainder tends to zero with {small}, but its limit is {limit}"
    return require, limit, ""


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


_NEW = "give the name of a new file with --draft"


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
    return quoted(text)
