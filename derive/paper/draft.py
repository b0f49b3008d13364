"""Draft a claims file from the displays of a paper.

No claim in the draft is judged before a user has accepted its reading and defined its symbols.
"""

import os
import re
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from sympy import Symbol

from derive.errors import BadClaimsFile, BadFormula
from derive.limit import LimitReached, within
from derive.paper.displays import Display, displays
from derive.paper.formula import Names, approach, condition, equation, may_be_rounded
from derive.paper.latex import Latex
from derive.paper.lines import quoted
from derive.paper.spellings import (
    described,
    proposal,
    spellings,
    standing_alone,
    unclear_call,
    words_for,
)
from derive.paper.statements import Statement, statements

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
    """The reading of a statement: its text, its condition, and the reason if it is not judged."""

    understood: str = ""
    require: str = ""
    limit: str = ""
    why: str = ""


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
    said          descriptions of symbols in the text
    spelled       the LaTeX of each symbol -> its name
    """

    name: str
    environments: int
    said: dict[str, str]
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
    def understood(self) -> int:
        """The number of statements that were read."""
        return sum(bool(part.read.understood) for part in self.parts)

    @property
    def displays_read(self) -> int:
        """The number of displays in which every statement was read."""
        lines = {part.display for part in self.parts}
        return len(lines - {part.display for part in self.parts if not part.read.understood})

    @property
    def named(self) -> tuple[int, int]:
        """The number of symbols with a proposal, and the number of all symbols."""
        names = self._names()
        return sum(bool(self._proposed(name)) for name in names), len(names)

    def _place(self, part: _Part) -> str:
        number = f"eq. ({part.display.number}), " if part.display.number else ""
        return f"{number}{self.name}:{part.display.line}"

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
        known = proposal(name)
        spelled = [latex for latex, own in self.spelled.items() if own == name]
        words = next(filter(None, (words_for(latex, self.said) for latex in spelled)), "")
        given = {
            "proposal": known.formula,
            "meaning": words or known.meaning,
            "unit": known.unit,
        }
        inside = ", ".join(f"{key} = {_text(text)}" for key, text in given.items() if text)
        return f"{{ {inside} }}" if inside else ""

    def _claim(self, part: _Part, labels: Counter[str]) -> list[str]:
        display, read = part.display, part.read
        own = part.count > 1 and len(display.labels) == part.count
        label = display.labels[part.number - 1] if own else ", ".join(display.labels)
        label = label or (f"({display.number})" if display.number else f"line {display.line}")
        label = _line(label) + ("" if own or part.count == 1 else f"/{part.number}")
        labels[label] += 1
        label += f" [{labels[label]}]" if labels[label] > 1 else ""
        lines = [
            "[[claims]]",
            f"label = {_text(label)}",
            f"place = {_text(self._place(part))}",
        ]
        if words := _words(display.latex):
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
        if read.why:
            lines.append(f"unchecked = {_text(_line(read.why))}")
        return lines


_NOTHING = '""'


def draft(path: Path, inline: bool = False) -> Draft:
    """Read a LaTeX file; raise BadClaimsFile if its displays cannot be found.

    inline: whether the relations in the text are read as well.
    """
    source = displays(path, inline)
    if not source.found:
        why = "the file has no displayed equations"
        raise BadClaimsFile(str(path), why, "give a paper in LaTeX")
    made = Draft(path.name, source.environments, described(source.text))
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
    return made


def _read(statement: Statement, spelled: dict[str, str], alone: set[str]) -> _Read:
    """Read a statement and its condition; give the reason if it cannot be judged."""
    if statement.why:
        return _Read(why=statement.why)
    if called := unclear_call(statement.latex, spelled, alone):
        why = f"{called} is a function elsewhere, so it is unclear whether it is a factor here"
        return _Read(why=f"{why}: write the claim as text")
    names = Names("", {n: Symbol(n) for n in spelled.values()}, {})
    try:
        with within(_SECONDS):
            understood = Latex("the draft", statement.latex, spelled).understood()
            equation(understood, names, rough=statement.is_rough)
    except BadFormula as error:
        return _Read(why=f"{error.why}: {error.remedy}")
    except LimitReached:
        return _Read(why=f"it could not be read within {_SECONDS:g} s")
    except RecursionError:
        return _Read(why="it is nested too deeply")
    require, limit, why = _conditions(statement.condition, spelled, names)
    if statement.is_rough and not limit and not why and not may_be_rounded(understood):
        why = "it is an approximation: add its limit, such as as = 'x -> 0', or write it with ="
    return _Read(understood, require, limit, why)


def _conditions(latex: str, spelled: dict[str, str], names: Names) -> tuple[str, str, str]:
    """Read the conditions and the limit; return both as text, and the reason if this fails."""
    if not latex.strip():
        return "", "", ""
    told, limit = list[str](), ""
    for part in re.split(r",|\\andword", latex):
        reading = Latex("the draft", part.strip(" ,.;"), spelled)
        try:
            if r"\to" in part:
                limit = reading.approach()
                approach(limit, names)
            else:
                told.append(reading.condition())
                condition(told[-1], names)
        except BadFormula:
            why = f"its condition {part.strip()} could not be read: write it as require"
            return "", "", why
    return " and ".join(told), limit, ""


def _words(latex: str) -> str:
    r"""Return the words in a display, without short ones such as \text{for}."""
    found = re.findall(r"\\(?:text|mbox|textrm)\s*\{([^{}]*)\}", latex)
    words = [" ".join(each.split()).strip(" ,.;") for each in found]
    return _line(", ".join(each for each in words if len(each) > _SHORT_WORD))


_SHORT_WORD = 9
"""Words with at most as many letters as `otherwise` are ignored."""


def write(made: Draft, path: Path) -> None:
    """Write a draft to a new file; raises BadClaimsFile."""
    try:
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    except OSError as error:
        why = f"the file cannot be written ({error.strerror})"
        raise BadClaimsFile(str(path), why, "name a new file with --draft") from error
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(made.text())


def _line(text: str) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _text(text: str) -> str:
    """Write a text in TOML, as a literal string if possible."""
    text = "".join(c if c.isprintable() or c in "\n\t" else " " for c in text)
    if "'" not in text and "\n" not in text:
        return f"'{text}'"
    if "'''" not in text and "\n" in text and not text.endswith("'"):
        return f"'''\n{text}'''"
    return quoted(text)
